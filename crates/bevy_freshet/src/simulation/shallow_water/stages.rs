//! The pipelines of the stages.
use super::{
    numbers::{GpuClock, GpuEdge, GpuLeaving, GpuPush, GpuRaised, GpuShallow},
    played::played_layout,
};
use bevy::{
    asset::{AssetServer, load_embedded_asset},
    prelude::*,
    render::render_resource::{
        BindGroupLayoutDescriptor, BindGroupLayoutEntries, CachedComputePipelineId, ComputePipelineDescriptor,
        PipelineCache, ShaderStages, ShaderType, StorageTextureAccess, TextureFormat, TextureSampleType,
        binding_types::{
            storage_buffer_read_only_sized, storage_buffer_sized, texture_2d, texture_storage_2d, uniform_buffer,
        },
    },
    shader::{Shader, ShaderDefVal},
};

/// Invocations of a workgroup of the step, side by side and one below the other: as many as a graphics card has lanes, and a
/// domain of 64 columns leaves none of them idle.
pub(super) const GROUP: UVec2 = UVec2::new(16, 2);
/// Columns that an invocation goes down.
pub(super) const COLUMNS: u32 = 4;
/// Rows that an invocation goes down.
pub(super) const ROWS: u32 = 16;

/// All stages; they bind the same, but for `push`, `raise` and `coarsen`.
#[derive(Resource)]
pub(super) struct Stages {
    pub layout: BindGroupLayoutDescriptor,
    pub begin: CachedComputePipelineId,
    /// Without and with point sources, each without and with walls.
    pub steps: [[Step; 2]; 2],
    pub push: CachedComputePipelineId,
    pub push_layout: BindGroupLayoutDescriptor,
    pub raise: CachedComputePipelineId,
    pub raise_layout: BindGroupLayoutDescriptor,
    /// Without and with walls; binds the pictures as well.
    pub show: [CachedComputePipelineId; 2],
    pub pictures: BindGroupLayoutDescriptor,
    /// The same pictures of a flood that is played back.
    pub show_played: CachedComputePipelineId,
    pub played_layout: BindGroupLayoutDescriptor,
    pub coarsen: CachedComputePipelineId,
    pub coarsen_layout: BindGroupLayoutDescriptor,
}

/// The two stages of a step.
pub(super) struct Step {
    pub step: CachedComputePipelineId,
    pub border: CachedComputePipelineId,
}

impl Stages {
    /// Whether every pipeline has been made.
    pub fn are_ready(&self, cache: &PipelineCache) -> bool {
        let steps = self.steps.iter().flatten().flat_map(|step| [step.step, step.border]);
        steps
            .chain(self.show)
            .chain([self.begin, self.push, self.raise, self.coarsen])
            .all(|stage| cache.get_compute_pipeline(stage).is_some())
    }
}

/// Makes the pipelines; again after a lost device.
pub(super) fn create_stages(mut commands: Commands, assets: Res<AssetServer>, cache: Res<PipelineCache>) {
    let layout = layout();
    let stage = |label: &'static str, shader: &Handle<Shader>, entry: &'static str, defines: &[&str]| {
        let defines = defines.iter().copied().map(ShaderDefVal::from);
        let number = |name: &str, value| ShaderDefVal::UInt(name.into(), value);
        let numbers = [number("GROUP_X", GROUP.x), number("GROUP_Z", GROUP.y), number("ROWS", ROWS)];
        cache.queue_compute_pipeline(ComputePipelineDescriptor {
            label: Some(label.into()),
            layout: vec![layout.clone()],
            shader: shader.clone(),
            shader_defs: numbers.into_iter().chain(defines).collect(),
            entry_point: Some(entry.into()),
            ..default()
        })
    };
    let step = load_embedded_asset!(&*assets, "step.wgsl");
    let border = load_embedded_asset!(&*assets, "border.wgsl");
    let pair = |defines: &[&str]| Step {
        step: stage("water_shallow_step", &step, "main", defines),
        border: stage("water_shallow_border", &border, "main", defines),
    };
    let pictures = pictures_layout();
    let shader = load_embedded_asset!(&*assets, "show.wgsl");
    let show = |input: &BindGroupLayoutDescriptor, defines: &[&str]| {
        cache.queue_compute_pipeline(ComputePipelineDescriptor {
            label: Some("water_shallow_show".into()),
            layout: vec![input.clone(), pictures.clone()],
            shader: shader.clone(),
            shader_defs: defines.iter().copied().map(ShaderDefVal::from).collect(),
            entry_point: Some("main".into()),
            ..default()
        })
    };
    let played_layout = played_layout();
    let (push_layout, raise_layout, coarsen_layout) = (push_layout(), raise_layout(), coarsen_layout());
    let lone = |label: &'static str, layout: &BindGroupLayoutDescriptor, shader: Handle<Shader>| {
        cache.queue_compute_pipeline(ComputePipelineDescriptor {
            label: Some(label.into()),
            layout: vec![layout.clone()],
            shader,
            entry_point: Some("main".into()),
            ..default()
        })
    };
    let push = lone("water_shallow_push", &push_layout, load_embedded_asset!(&*assets, "push.wgsl"));
    let raise = lone("water_shallow_raise", &raise_layout, load_embedded_asset!(&*assets, "raise.wgsl"));
    let coarsen = lone("water_shallow_coarsen", &coarsen_layout, load_embedded_asset!(&*assets, "coarsen.wgsl"));
    commands.insert_resource(Stages {
        begin: stage("water_shallow_begin", &step, "begin", &[]),
        steps: [[pair(&[]), pair(&["WALLS"])], [pair(&["SOURCES"]), pair(&["SOURCES", "WALLS"])]],
        push,
        push_layout,
        raise,
        raise_layout,
        show: [show(&layout, &[]), show(&layout, &["WALLS"])],
        show_played: show(&played_layout, &["PLAYED"]),
        played_layout,
        pictures,
        coarsen,
        coarsen_layout,
        layout,
    });
}

fn pictures_layout() -> BindGroupLayoutDescriptor {
    let picture = |format| texture_storage_2d(format, StorageTextureAccess::WriteOnly);
    let entries = BindGroupLayoutEntries::sequential(
        ShaderStages::COMPUTE,
        (picture(TextureFormat::Rgba32Float), picture(TextureFormat::Rgba16Float)),
    );
    BindGroupLayoutDescriptor::new("water_shallow_pictures", &entries)
}

fn coarsen_layout() -> BindGroupLayoutDescriptor {
    let texels = texture_2d(TextureSampleType::Float { filterable: false });
    let picture = |format| texture_storage_2d(format, StorageTextureAccess::WriteOnly);
    let entries = BindGroupLayoutEntries::sequential(
        ShaderStages::COMPUTE,
        (texels, texels, picture(TextureFormat::Rgba32Float), picture(TextureFormat::Rgba16Float)),
    );
    BindGroupLayoutDescriptor::new("water_shallow_coarsen", &entries)
}

fn push_layout() -> BindGroupLayoutDescriptor {
    let entries = BindGroupLayoutEntries::sequential(
        ShaderStages::COMPUTE,
        (
            uniform_buffer::<UVec4>(false),
            storage_buffer_sized(false, Some(GpuClock::min_size())),
            storage_buffer_sized(false, Some(Vec4::min_size())),
            storage_buffer_read_only_sized(false, Some(GpuPush::min_size())),
        ),
    );
    BindGroupLayoutDescriptor::new("water_shallow_push", &entries)
}

fn raise_layout() -> BindGroupLayoutDescriptor {
    let entries = BindGroupLayoutEntries::sequential(
        ShaderStages::COMPUTE,
        (
            storage_buffer_sized(false, Some(f32::min_size())),
            storage_buffer_read_only_sized(false, Some(GpuRaised::min_size())),
        ),
    );
    BindGroupLayoutDescriptor::new("water_shallow_raise", &entries)
}

fn layout() -> BindGroupLayoutDescriptor {
    let read = |size| storage_buffer_read_only_sized(false, Some(size));
    let write = |size| storage_buffer_sized(false, Some(size));
    let entries = BindGroupLayoutEntries::sequential(
        ShaderStages::COMPUTE,
        (
            uniform_buffer::<GpuShallow>(false),
            uniform_buffer::<UVec4>(false),
            write(GpuClock::min_size()),
            read(Vec4::min_size()),
            write(Vec4::min_size()),
            read(f32::min_size()),
            read(GpuEdge::min_size()),
            write(GpuLeaving::min_size()),
            read(Vec4::min_size()),
            write(Vec2::min_size()),
        ),
    );
    BindGroupLayoutDescriptor::new("water_shallow", &entries)
}
