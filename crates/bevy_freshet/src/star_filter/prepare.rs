//! Textures and numbers of every camera's passes.
use super::{
    StarFilter,
    pipeline::{FORMAT, GpuPass, Stage, StarPipeline},
};
use bevy::{
    math::ops,
    prelude::*,
    render::{
        camera::ExtractedCamera,
        render_resource::{
            CachedRenderPipelineId, DynamicUniformBuffer, Extent3d, PipelineCache, SpecializedRenderPipelines,
            TextureDescriptor, TextureDimension, TextureUsages, TextureView,
        },
        renderer::{RenderDevice, RenderQueue},
        texture::TextureCache,
        view::ExtractedView,
    },
};
use core::f32::consts::TAU;

/// The numbers of all passes of all cameras.
#[derive(Resource, Default)]
pub(super) struct StarUniforms(pub DynamicUniformBuffer<GpuPass>);

/// Textures of half resolution, and where the numbers of each pass begin.
#[derive(Component)]
pub struct StarPasses {
    /// What is brighter than the threshold.
    pub bright: TextureView,
    /// Two textures between which an arm goes to and fro while it grows.
    pub arm: [TextureView; 2],
    /// All arms.
    pub stars: TextureView,
    pub bright_offset: u32,
    /// For every arm its passes, the nearest first.
    pub arm_offsets: Vec<Vec<u32>>,
    pub composite_offset: u32,
}

#[derive(Component)]
pub struct StarPipelines {
    pub bright: CachedRenderPipelineId,
    pub streak: CachedRenderPipelineId,
    pub composite: CachedRenderPipelineId,
}

pub(super) fn prepare_star_pipelines(
    mut commands: Commands,
    cache: Res<PipelineCache>,
    pipeline: Res<StarPipeline>,
    mut pipelines: ResMut<SpecializedRenderPipelines<StarPipeline>>,
    views: Query<(Entity, &ExtractedView), With<StarFilter>>,
) {
    for (entity, view) in &views {
        let mut id = |stage| pipelines.specialize(&cache, &pipeline, stage);
        commands.entity(entity).insert(StarPipelines {
            bright: id(Stage::Bright),
            streak: id(Stage::Streak),
            composite: id(Stage::Composite(view.target_format)),
        });
    }
}

pub(super) fn prepare_star_passes(
    mut commands: Commands,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut uniforms: ResMut<StarUniforms>,
    mut textures: ResMut<TextureCache>,
    views: Query<(Entity, &ExtractedCamera, &StarFilter)>,
) {
    uniforms.0.clear();
    for (entity, camera, filter) in &views {
        let Some(extent) = camera.physical_viewport_size else { continue };
        let origin = camera.viewport.as_ref().map_or(UVec2::ZERO, |viewport| viewport.physical_position);
        let half = extent.map(|pixels| pixels.div_ceil(2).max(1));
        let mut texture = |label| {
            let descriptor = TextureDescriptor {
                label: Some(label),
                size: Extent3d { width: half.x, height: half.y, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: TextureDimension::D2,
                format: FORMAT,
                usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            };
            textures.get(&device, descriptor).default_view
        };
        let frame = GpuPass {
            origin: origin.as_vec2(),
            extent: extent.as_vec2(),
            threshold: filter.threshold,
            limit: filter.limit,
            gain: filter.intensity,
            ..default()
        };
        let mut push = |pass: &GpuPass| uniforms.0.push(pass);
        commands.entity(entity).insert(StarPasses {
            bright: texture("star_filter_bright"),
            arm: [texture("star_filter_arm"), texture("star_filter_arm")],
            stars: texture("star_filter_stars"),
            bright_offset: push(&frame),
            composite_offset: push(&frame),
            arm_offsets: arms(filter, half.as_vec2()).map(|passes| passes.iter().map(&mut push).collect()).collect(),
        });
    }
    uniforms.0.write_buffer(&device, &queue);
}

/// Taps of a pass.
const TAPS: i32 = 4;
/// Most passes of an arm: it ends after 4⁴ texels.
const MOST_PASSES: i32 = 4;

/// The passes of every arm on textures of `size` texels.
///
/// Pass p smears by taps of 4ᵖ texels, weighted by a^(4ᵖ s), s = 0…3. Together these are the weights aᵏ for k from 0 to
/// 4ᴾ − 1, where aⁿ = 1 % after n texels. Each pass is divided by the sum of its weights, so it keeps the light; the last one is
/// divided by the number of arms too, as these are added.
fn arms(filter: &StarFilter, size: Vec2) -> impl Iterator<Item = Vec<GpuPass>> {
    let texels = (filter.length * size.y).max(1.0);
    let passes = (1..MOST_PASSES).find(|p| TAPS.pow(*p as u32) as f32 >= texels).unwrap_or(MOST_PASSES);
    let StarFilter { arms, angle, .. } = *filter;
    (0..arms).map(move |arm| {
        let (sin, cos) = ops::sin_cos(angle + arm as f32 * TAU / arms as f32);
        let pass = |p: i32| {
            let stride = TAPS.pow(p as u32) as f32;
            let decay = ops::powf(0.01, stride / texels);
            let sum: f32 = (0..TAPS).map(|s| decay.powi(s)).sum();
            let share = if p + 1 == passes { 1.0 / arms as f32 } else { 1.0 };
            // Rows count downwards.
            GpuPass { step: vec2(cos, -sin) * stride / size, decay, gain: share / sum, ..default() }
        };
        (0..passes).map(pass).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arms_keep_the_light_and_fall_to_a_hundredth_at_their_length() {
        for length in [0.005, 0.03, 0.1, 0.5] {
            let filter = StarFilter { length, arms: 5, ..default() };
            let size = vec2(480.0, 270.0);
            let mut total = 0.0;
            for passes in arms(&filter, size) {
                // The weights of one pass after the other, unrolled.
                let mut weights = vec![1.0_f32];
                for pass in &passes {
                    let tap = |s: i32| pass.gain * pass.decay.powi(s);
                    weights = (0..TAPS).flat_map(|s| weights.iter().map(move |w| w * tap(s))).collect();
                }
                total += weights.iter().sum::<f32>();
                let end = (length * size.y).max(1.0);
                if let Some(weight) = weights.get(end.round() as usize) {
                    let expected = 0.01_f32.powf(end.round() / end);
                    assert!((weight / weights[0] / expected - 1.0).abs() < 1e-3, "{length}");
                }
            }
            assert!((total - 1.0).abs() < 1e-4, "{length}: {total}");
        }
    }
}
