//! Pictures of patterns that repeat, with means at every mip level.
use bevy::{
    asset::RenderAssetUsages,
    image::{ImageAddressMode, ImageSampler, ImageSamplerDescriptor},
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};
use half::f16;

/// A square picture of `size` texels (a power of two) that repeats, of the first `N` channels of each texel.
///
/// Each mip level holds the means of the one above it. Where one channel is a quantity and another its square, mean
/// square minus square of the mean is the variance that a level hides.
pub(super) fn repeating<const N: usize>(
    label: &'static str,
    format: TextureFormat,
    mut size: usize,
    texels: Vec<[f32; N]>,
) -> Image {
    let extent = Extent3d { width: size as u32, height: size as u32, depth_or_array_layers: 1 };
    let mut image = Image::new_uninit(extent, TextureDimension::D2, format, RenderAssetUsages::default());
    image.texture_descriptor.label = Some(label);
    image.texture_descriptor.mip_level_count = size.ilog2() + 1;
    let mut level = texels;
    let mut data = Vec::new();
    loop {
        data.extend(level.iter().flatten().flat_map(|&channel| f16::from_f32(channel).to_le_bytes()));
        if size == 1 {
            break;
        }
        level = halved(&level, size);
        size /= 2;
    }
    image.data = Some(data);
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        ..ImageSamplerDescriptor::linear()
    });
    image
}

/// The next mip level of a picture of `size`² texels: means over 2 × 2.
pub(super) fn halved<const N: usize>(level: &[[f32; N]], size: usize) -> Vec<[f32; N]> {
    let half = size / 2;
    (0..half * half)
        .map(|i| 2 * (i / half) * size + 2 * (i % half))
        .map(|i| [i, i + 1, i + size, i + size + 1].map(|i| level[i]))
        .map(|corners| core::array::from_fn(|c| 0.25 * corners.iter().map(|texel| texel[c]).sum::<f32>()))
        .collect()
}
