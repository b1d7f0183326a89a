//! The material of the ground.
use bevy::{
    asset::{AssetPath, embedded_path},
    pbr::{ExtendedMaterial, MaterialExtension},
    prelude::*,
    render::render_resource::{AsBindGroup, ShaderType},
    shader::ShaderRef,
};

/// Bevy's standard material with the ground's layers for its colour, roughness and normal.
pub(super) type BedMaterial = ExtendedMaterial<StandardMaterial, BedExtension>;

/// The layers of the ground.
#[derive(Asset, AsBindGroup, TypePath, Clone, Debug, Default)]
pub(super) struct BedExtension {
    #[uniform(100)]
    pub bed: GpuBed,
    #[texture(101)]
    #[sampler(102)]
    pub mud: Option<Handle<Image>>,
    #[texture(103)]
    pub sand: Option<Handle<Image>>,
    #[texture(104)]
    pub grass: Option<Handle<Image>>,
}

/// The Rust twin of `Bed` in `bed.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default)]
#[cfg_attr(test, derive(Reflect))]
pub(super) struct GpuBed {
    /// World height of the water, m.
    pub level: f32,
    /// Size of a tile, m.
    pub tile: f32,
    /// Height of the textures' relief, m.
    pub relief: f32,
}

impl MaterialExtension for BedExtension {
    fn fragment_shader() -> ShaderRef {
        ShaderRef::Path(AssetPath::from_path_buf(embedded_path!("bed.wgsl")).with_source("embedded"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shader_reads_what_is_written() {
        crate::layout::assert_same_layout::<GpuBed, _>(include_str!("bed.wgsl"), "Bed");
    }
}
