//! The pipelines of the stages.
use super::numbers::{GpuClock, GpuEdge, GpuLeaving, GpuShallow};
use bevy::{
    asset::{AssetServer, load_embedded_asset},
    prelude::*,
    render::render_resource::{
        BindGroupLayoutDescriptor, BindGroupLayoutEntries, CachedComputePipelineId, ComputePipelineDescriptor,
        PipelineCache, ShaderStages, ShaderType,
        binding_types::{storage_buffer_read_only_sized, storage_buffer_sized, uniform_buffer},
    },
    shader::ShaderDefVal,
};

/// Invocations of a workgroup of the step, side by side in a row.
pub(super) const GROUP: u32 = 64;
/// Rows that an invocation goes down.
pub(super) const ROWS: u32 = 16;

/// All stages; they bind the same.
#[derive(Resource)]
pub(super) struct Stages {
    pub layout: BindGroupLayoutDescriptor,
    pub begin: CachedComputePipelineId,
    pub edges: CachedComputePipelineId,
    pub step: CachedComputePipelineId,
}

impl Stages {
    /// Whether every pipeline has been made.
    pub fn are_ready(&self, cache: &PipelineCache) -> bool {
        [self.begin, self.edges, self.step].into_iter().all(|stage| cache.get_compute_pipeline(stage).is_some())
    }
}

/// Makes the pipelines; again after a lost device.
pub(super) fn create_stages(mut commands: Commands, assets: Res<AssetServer>, cache: Res<PipelineCache>) {
    let layout = layout();
    let stage = |label: &'static str, shader, entry: &'static str| {
        cache.queue_compute_pipeline(ComputePipelineDescriptor {
            label: Some(label.into()),
            layout: vec![layout.clone()],
            shader,
            shader_defs: vec![
                ShaderDefVal::UInt("GROUP".into(), GROUP),
                ShaderDefVal::UInt("ROWS".into(), ROWS),
            ],
            entry_point: Some(entry.into()),
            ..default()
        })
    };
    let edges = load_embedded_asset!(&*assets, "edges.wgsl");
    commands.insert_resource(Stages {
        begin: stage("water_shallow_begin", edges.clone(), "begin"),
        edges: stage("water_shallow_edges", edges, "main"),
        step: stage("water_shallow_step", load_embedded_asset!(&*assets, "step.wgsl"), "main"),
        layout,
    });
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
