//! The material of the surface.
use bevy::{
    asset::{AssetPath, embedded_path},
    mesh::MeshVertexBufferLayoutRef,
    pbr::{MaterialPipeline, MaterialPipelineKey},
    prelude::*,
    render::{
        render_resource::{AsBindGroup, RenderPipelineDescriptor, SpecializedMeshPipelineError},
        storage::ShaderBuffer,
    },
    shader::{ShaderDefVal, ShaderRef},
};

/// Textures and numbers of one water in one view; the numbers change every frame and live in a buffer, so that the bind
/// group stays.
#[derive(Asset, AsBindGroup, TypePath, Clone, Debug, PartialEq)]
pub(crate) struct SurfaceMaterial {
    #[storage(0, read_only)]
    pub surface: Handle<ShaderBuffer>,
    #[texture(1)]
    #[sampler(2)]
    pub mirror: Option<Handle<Image>>,
    #[texture(3, dimension = "cube")]
    #[sampler(4)]
    pub sky: Option<Handle<Image>>,
    #[texture(5, dimension = "cube")]
    pub sky_light: Option<Handle<Image>>,
    #[texture(6)]
    #[sampler(7)]
    pub detail: Handle<Image>,
    #[texture(8, sample_type = "float", filterable = false)]
    pub bed: Option<Handle<Image>>,
    #[texture(9, sample_type = "float", filterable = false)]
    pub flow: Option<Handle<Image>>,
    #[texture(10)]
    #[sampler(11)]
    pub field_rings: Option<Handle<Image>>,
    #[texture(12)]
    pub field_matter: Option<Handle<Image>>,
    #[texture(13)]
    pub foam: Handle<Image>,
    #[texture(14, sample_type = "float", filterable = false)]
    pub ice_order: Option<Handle<Image>>,
    #[texture(15)]
    pub ice_tile: Option<Handle<Image>>,
    #[texture(16, sample_type = "float", filterable = false)]
    pub simulated: Option<Handle<Image>>,
    #[texture(17, sample_type = "float", filterable = false)]
    pub simulated_slopes: Option<Handle<Image>>,
}

impl SurfaceMaterial {
    /// Whether one of `images` is among the textures.
    pub fn uses(&self, images: &[AssetId<Image>]) -> bool {
        let textures =
            [&self.mirror, &self.sky, &self.sky_light, &self.bed, &self.flow, &self.field_rings, &self.field_matter];
        textures.into_iter().flatten().any(|texture| images.contains(&texture.id()))
    }
}

fn shader() -> ShaderRef {
    ShaderRef::Path(AssetPath::from_path_buf(embedded_path!("surface.wgsl")).with_source("embedded"))
}

impl Material for SurfaceMaterial {
    fn vertex_shader() -> ShaderRef {
        shader()
    }

    fn fragment_shader() -> ShaderRef {
        shader()
    }

    /// The water is opaque to the pipeline and mixes what is behind it itself.
    fn reads_view_transmission_texture(&self) -> bool {
        true
    }

    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }

    fn specialize(
        _pipeline: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _layout: &MeshVertexBufferLayoutRef,
        _key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        descriptor.label = Some("water_surface".into());
        // The surface is seen from below as well.
        descriptor.primitive.cull_mode = None;
        let waves = ShaderDefVal::UInt("MAX_WAVES".into(), crate::body::WaterWaves::MAX as u32);
        descriptor.vertex.shader_defs.push(waves.clone());
        if let Some(fragment) = &mut descriptor.fragment {
            fragment.shader_defs.push(waves);
        }
        Ok(())
    }
}
