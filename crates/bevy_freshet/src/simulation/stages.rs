//! The pipelines of the stages and what they bind.
use super::{numbers::GpuNumbers, tiles::TILE};
use crate::{body::WaterWaves, surface::GpuSurface};
use bevy::{
    asset::{AssetServer, load_embedded_asset},
    prelude::*,
    render::render_resource::{
        BindGroupLayoutDescriptor, BindGroupLayoutEntries, BindGroupLayoutEntryBuilder, CachedComputePipelineId,
        ComputePipelineDescriptor, PipelineCache, ShaderStages, ShaderType, StorageTextureAccess, TextureFormat,
        TextureSampleType,
        binding_types::{
            storage_buffer_read_only_sized, storage_buffer_sized, texture_2d, texture_storage_2d, uniform_buffer,
        },
    },
    shader::{Shader, ShaderDefVal},
};

/// A stage: its pipeline and the layout of its own bindings, which begin with the numbers.
pub(super) struct Stage {
    pub layout: BindGroupLayoutDescriptor,
    pub pipeline: CachedComputePipelineId,
}

/// All stages.
#[derive(Resource)]
pub(super) struct Stages {
    /// Bindings 0, 8, 9, 14, 16 and 17 of the surface's material: its numbers, bed, current, order of freezing and the
    /// simulated water.
    pub water: BindGroupLayoutDescriptor,
    pub ground: Stage,
    pub bodies: Stage,
    pub stream: Stage,
    pub shift: Stage,
    pub deposit: Stage,
    pub carry_x: Stage,
    pub carry_z: Stage,
    pub rings: Stage,
    /// For foam, and for foam and dye.
    pub transport: [Stage; 2],
    pub compose: Stage,
}

impl Stages {
    /// Whether every pipeline has been made.
    pub fn are_ready(&self, cache: &PipelineCache) -> bool {
        let before = [&self.ground, &self.bodies, &self.stream, &self.shift, &self.deposit];
        let steps = [&self.carry_x, &self.carry_z, &self.rings, &self.compose];
        before
            .into_iter()
            .chain(steps)
            .chain(&self.transport)
            .all(|stage| cache.get_compute_pipeline(stage.pipeline).is_some())
    }
}

/// What a stage binds after the numbers.
#[derive(Clone, Copy)]
enum Bound {
    Read,
    Write,
    Picture,
}

/// Makes the pipelines; again after a lost device.
pub(super) fn create_stages(mut commands: Commands, assets: Res<AssetServer>, cache: Res<PipelineCache>) {
    use Bound::{Picture, Read, Write};
    let water = water_layout();
    let stage = |label, shader, entry, bound: &[Bound]| new_stage(&cache, label, shader, entry, bound, None, None);
    let on_water =
        |label, shader, bound: &[Bound]| new_stage(&cache, label, shader, "main", bound, Some(water.clone()), None);
    let transport = |define| {
        let shader = load_embedded_asset!(&*assets, "transport.wgsl");
        new_stage(&cache, "water_transport", shader, "main", &[Read, Read, Write], None, define)
    };
    let carry = load_embedded_asset!(&*assets, "carry.wgsl");
    commands.insert_resource(Stages {
        ground: on_water("water_ground", load_embedded_asset!(&*assets, "ground.wgsl"), &[Write, Write]),
        bodies: stage("water_bodies", load_embedded_asset!(&*assets, "bodies.wgsl"), "main", &[Read, Write]),
        stream: on_water("water_stream", load_embedded_asset!(&*assets, "stream.wgsl"), &[Read, Read, Write]),
        shift: stage(
            "water_shift",
            load_embedded_asset!(&*assets, "shift.wgsl"),
            "main",
            &[Read, Read, Write, Read, Write],
        ),
        deposit: stage(
            "water_deposit",
            load_embedded_asset!(&*assets, "deposit.wgsl"),
            "main",
            &[Read, Read, Read, Read, Write, Write],
        ),
        carry_x: stage("water_carry_x", carry.clone(), "along_x", &[Read, Read, Read, Write]),
        carry_z: stage("water_carry_z", carry, "along_z", &[Read, Read, Read, Write]),
        rings: stage("water_rings", load_embedded_asset!(&*assets, "rings.wgsl"), "main", &[Read, Read, Write]),
        transport: [None, Some("DYE")].map(transport),
        compose: stage(
            "water_compose",
            load_embedded_asset!(&*assets, "compose.wgsl"),
            "main",
            &[Read, Read, Read, Read, Picture, Picture],
        ),
        water,
    });
}

fn water_layout() -> BindGroupLayoutDescriptor {
    let grid = texture_2d(TextureSampleType::Float { filterable: false });
    let surface = storage_buffer_read_only_sized(false, Some(GpuSurface::min_size()));
    let entries = BindGroupLayoutEntries::with_indices(
        ShaderStages::COMPUTE,
        ((0, surface), (8, grid), (9, grid), (14, grid), (16, grid), (17, grid)),
    );
    BindGroupLayoutDescriptor::new("water_below", &entries)
}

fn new_stage(
    cache: &PipelineCache,
    label: &'static str,
    shader: Handle<Shader>,
    entry: &'static str,
    bound: &[Bound],
    water: Option<BindGroupLayoutDescriptor>,
    define: Option<&str>,
) -> Stage {
    let kinds = core::iter::once(uniform_buffer::<GpuNumbers>(false)).chain(bound.iter().copied().map(binding));
    let entries: Vec<_> = kinds.enumerate().map(|(n, entry)| entry.build(n as u32, ShaderStages::COMPUTE)).collect();
    let layout = BindGroupLayoutDescriptor::new(label, &entries);
    let pipeline = cache.queue_compute_pipeline(ComputePipelineDescriptor {
        label: Some(label.into()),
        layout: core::iter::once(layout.clone()).chain(water).collect(),
        shader,
        shader_defs: [
            ShaderDefVal::UInt("GROUP".into(), TILE),
            ShaderDefVal::UInt("MATERIAL_BIND_GROUP".into(), 1),
            ShaderDefVal::UInt("MAX_WAVES".into(), WaterWaves::MAX as u32),
        ]
        .into_iter()
        .chain(define.map(ShaderDefVal::from))
        .collect(),
        entry_point: Some(entry.into()),
        ..default()
    });
    Stage { layout, pipeline }
}

fn binding(bound: Bound) -> BindGroupLayoutEntryBuilder {
    match bound {
        Bound::Read => storage_buffer_read_only_sized(false, None),
        Bound::Write => storage_buffer_sized(false, None),
        Bound::Picture => texture_storage_2d(TextureFormat::Rgba16Float, StorageTextureAccess::WriteOnly),
    }
}
