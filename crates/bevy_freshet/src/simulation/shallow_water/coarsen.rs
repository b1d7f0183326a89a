//! Coarser levels of the pictures, whoever has drawn the finest.
use super::{ShallowFrame, stages::Stages};
use bevy::{
    prelude::*,
    render::{
        render_asset::RenderAssets,
        render_resource::{
            BindGroup, BindGroupEntries, ComputePassDescriptor, PipelineCache, TextureView, TextureViewDescriptor,
        },
        renderer::{RenderContext, RenderDevice},
        texture::GpuImage,
    },
};

/// Levels to be made in this frame, of all waters, each after the one that it is made from.
#[derive(Resource, Default)]
pub(super) struct Levels(Vec<Level>);

struct Level {
    group: BindGroup,
    workgroups: UVec2,
}

/// One level of a picture.
pub(super) fn level_of(picture: &GpuImage, level: u32) -> TextureView {
    picture.texture.create_view(&TextureViewDescriptor {
        label: Some("water_simulated_level"),
        base_mip_level: level,
        mip_level_count: Some(1),
        ..default()
    })
}

/// Plans the levels of all pictures.
pub(super) fn plan_levels(
    mut levels: ResMut<Levels>,
    stages: Res<Stages>,
    cache: Res<PipelineCache>,
    device: Res<RenderDevice>,
    images: Res<RenderAssets<GpuImage>>,
    waters: Query<&ShallowFrame>,
) {
    levels.0.clear();
    let layout = cache.get_bind_group_layout(&stages.coarsen_layout);
    for frame in &waters {
        let [Some(cells), Some(slopes)] = frame.pictures.map(|picture| images.get(picture)) else { continue };
        for level in 1..cells.texture.mip_level_count() {
            let views = [(cells, level - 1), (slopes, level - 1), (cells, level), (slopes, level)];
            let [finer, finer_slopes, coarser, coarser_slopes] = views.map(|(picture, level)| level_of(picture, level));
            let entries = BindGroupEntries::sequential((&finer, &finer_slopes, &coarser, &coarser_slopes));
            let group = device.create_bind_group("water_shallow_coarsen", &layout, &entries);
            let size = (cells.texture_descriptor.size.width >> level, cells.texture_descriptor.size.height >> level);
            levels.0.push(Level { group, workgroups: uvec2(size.0.div_ceil(8), size.1.div_ceil(8)) });
        }
    }
}

/// Makes the levels.
pub(super) fn run_levels(
    mut context: RenderContext,
    levels: Res<Levels>,
    stages: Res<Stages>,
    cache: Res<PipelineCache>,
) {
    let Some(pipeline) = cache.get_compute_pipeline(stages.coarsen).filter(|_| !levels.0.is_empty()) else { return };
    let descriptor = ComputePassDescriptor { label: Some("water_shallow_coarsen"), ..default() };
    let mut pass = context.command_encoder().begin_compute_pass(&descriptor);
    pass.set_pipeline(pipeline);
    for level in &levels.0 {
        pass.set_bind_group(0, &level.group, &[]);
        pass.dispatch_workgroups(level.workgroups.x, level.workgroups.y, 1);
    }
}
