//! Cube maps as images for the GPU.

use super::cubemap::Cubemap;
use bevy::{
    asset::RenderAssetUsages,
    image::{Image, ImageSampler, ImageSamplerDescriptor},
    math::Vec3,
    render::render_resource::{
        Extent3d, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureViewDescriptor,
        TextureViewDimension,
    },
};
use half::f16;

/// Packs the levels of a cube map, each half the size of the one before, as `Rgba16Float`; values are times `scale`.
pub(super) fn cube_image(label: &'static str, levels: &[Cubemap], scale: f32) -> Image {
    let size = levels.first().map_or(1, |base| base.size as u32);
    let mut data = Vec::new();
    for face in 0..6 {
        for level in levels {
            let texels = level.size * level.size;
            for texel in &level.texels[face * texels..(face + 1) * texels] {
                push_half(&mut data, *texel * scale);
            }
        }
    }
    Image {
        data: Some(data),
        texture_descriptor: TextureDescriptor {
            label: Some(label),
            size: Extent3d { width: size, height: size, depth_or_array_layers: 6 },
            mip_level_count: levels.len() as u32,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: TextureFormat::Rgba16Float,
            // Without COPY_DST a repainted image becomes a new texture. With it Bevy would write the bytes into the old
            // one as if there were a single level (bevy_render/src/texture/gpu_image.rs:84).
            usage: TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        texture_view_descriptor: Some(TextureViewDescriptor {
            label: Some(label),
            dimension: Some(TextureViewDimension::Cube),
            ..TextureViewDescriptor::default()
        }),
        sampler: ImageSampler::Descriptor(ImageSamplerDescriptor::linear()),
        asset_usage: RenderAssetUsages::RENDER_WORLD,
        ..Image::default()
    }
}

/// Appends a texel; one too bright for 16-bit floats, such as the middle of the solar disc, keeps its hue.
fn push_half(data: &mut Vec<u8>, color: Vec3) {
    let largest = f16::MAX.to_f32();
    let color = color * (largest / color.max_element()).min(1.0);
    for value in [color.x, color.y, color.z, 1.0] {
        data.extend(f16::from_f32(value.max(0.0)).to_le_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_holds_all_levels_of_all_faces() {
        let levels = [4, 2, 1].map(|size| Cubemap::from_fn(size, |_, _| Vec3::ONE));
        let image = cube_image("test", &levels, 0.5);
        let bytes = image.data.unwrap();
        assert_eq!(bytes.len(), 6 * (16 + 4 + 1) * 8);
        assert_eq!(bytes[..8], [0x00, 0x38, 0x00, 0x38, 0x00, 0x38, 0x00, 0x3C]);
    }
}
