//! Layout and pipelines of the passes.
use bevy::{
    asset::load_embedded_asset,
    core_pipeline::FullscreenShader,
    prelude::*,
    render::{
        render_resource::{
            BindGroupLayoutDescriptor, BindGroupLayoutEntries, BlendComponent, BlendFactor, BlendOperation, BlendState,
            ColorTargetState, ColorWrites, FilterMode, FragmentState, RenderPipelineDescriptor, Sampler,
            SamplerBindingType, SamplerDescriptor, ShaderStages, ShaderType, SpecializedRenderPipeline, TextureFormat,
            TextureSampleType,
            binding_types::{sampler, texture_2d, uniform_buffer},
        },
        renderer::RenderDevice,
    },
};

/// Format of everything between the picture and the picture.
pub(super) const FORMAT: TextureFormat = TextureFormat::Rgba16Float;

/// The Rust twin of `Pass` in `star_filter.wgsl`, where each member is explained.
#[derive(ShaderType, Clone, Debug, Default, PartialEq)]
#[cfg_attr(test, derive(Reflect))]
pub(super) struct GpuPass {
    pub origin: Vec2,
    pub extent: Vec2,
    pub step: Vec2,
    pub decay: f32,
    pub gain: f32,
    pub threshold: f32,
    pub limit: f32,
}

/// What a pass does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Stage {
    /// Keeps what is brighter than the threshold.
    Bright,
    /// Smears along an arm.
    Streak,
    /// Adds the stars to a picture of this format.
    Composite(TextureFormat),
}

#[derive(Resource)]
pub(super) struct StarPipeline {
    pub layout: BindGroupLayoutDescriptor,
    pub sampler: Sampler,
    fullscreen: FullscreenShader,
    shader: Handle<Shader>,
}

pub(super) fn init_star_pipeline(
    mut commands: Commands,
    device: Res<RenderDevice>,
    fullscreen: Res<FullscreenShader>,
    assets: Res<AssetServer>,
) {
    let entries = BindGroupLayoutEntries::sequential(
        ShaderStages::FRAGMENT,
        (
            texture_2d(TextureSampleType::Float { filterable: true }),
            sampler(SamplerBindingType::Filtering),
            uniform_buffer::<GpuPass>(true),
        ),
    );
    commands.insert_resource(StarPipeline {
        layout: BindGroupLayoutDescriptor::new("star_filter", &entries),
        sampler: device.create_sampler(&SamplerDescriptor {
            label: Some("star_filter"),
            min_filter: FilterMode::Linear,
            mag_filter: FilterMode::Linear,
            ..default()
        }),
        fullscreen: fullscreen.clone(),
        shader: load_embedded_asset!(&*assets, "star_filter.wgsl"),
    });
}

impl SpecializedRenderPipeline for StarPipeline {
    type Key = Stage;

    fn specialize(&self, stage: Stage) -> RenderPipelineDescriptor {
        let (entry_point, format) = match stage {
            Stage::Bright => ("bright", FORMAT),
            Stage::Streak => ("streak", FORMAT),
            Stage::Composite(format) => ("composite", format),
        };
        let keep = BlendComponent {
            src_factor: BlendFactor::Zero,
            dst_factor: BlendFactor::One,
            operation: BlendOperation::Add,
        };
        let add = BlendComponent { src_factor: BlendFactor::One, ..keep };
        RenderPipelineDescriptor {
            label: Some(format!("star_filter_{entry_point}").into()),
            layout: vec![self.layout.clone()],
            vertex: self.fullscreen.to_vertex_state(),
            fragment: Some(FragmentState {
                shader: self.shader.clone(),
                entry_point: Some(entry_point.into()),
                targets: vec![Some(ColorTargetState {
                    format,
                    // Every pass adds: to a cleared texture, to the arms drawn so far, or to the picture.
                    blend: Some(BlendState { color: add, alpha: keep }),
                    write_mask: ColorWrites::ALL,
                })],
                ..default()
            }),
            ..default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shader_reads_what_is_written() {
        crate::layout::assert_same_layout::<GpuPass, _>(include_str!("star_filter.wgsl"), "Pass");
    }
}
