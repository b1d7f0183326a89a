//! Textures of the terrain, with levels of detail of their own.
use bevy::{
    asset::RenderAssetUsages,
    image::{ImageFilterMode, ImageSampler, ImageSamplerDescriptor},
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
    tasks::ComputeTaskPool,
};

/// A pixel of 32 bits.
pub trait Pixel: Copy + Send + Sync {
    const FORMAT: TextureFormat;
    /// The mean of four.
    fn mean(pixels: [Self; 4]) -> Self;
    fn bytes(self) -> [u8; 4];
}

/// Colours: red, green, blue, opacity; sRGB.
impl Pixel for [u8; 4] {
    const FORMAT: TextureFormat = TextureFormat::Rgba8UnormSrgb;

    fn mean(pixels: [Self; 4]) -> Self {
        core::array::from_fn(|channel| (pixels.iter().map(|pixel| u32::from(pixel[channel])).sum::<u32>() / 4) as u8)
    }

    fn bytes(self) -> [u8; 4] {
        self
    }
}

/// A value for each place of a raster, row by row, computed by all threads.
pub fn by_row<T: Send + 'static>(size: UVec2, value: impl Fn(UVec2) -> T + Sync) -> Vec<T> {
    // A few parts for each thread, so that none waits long for another.
    let rows = size.y.div_ceil(64).max(1);
    let value = &value;
    let parts = ComputeTaskPool::get().scope(|scope| {
        for first in (0..size.y).step_by(rows as usize) {
            scope.spawn(async move {
                let rows = first..(first + rows).min(size.y);
                rows.flat_map(|y| (0..size.x).map(move |x| value(uvec2(x, y)))).collect::<Vec<T>>()
            });
        }
    });
    parts.into_iter().flatten().collect()
}

/// A smooth texture of `pixels`, row by row, with all of its levels.
pub fn smooth<P: Pixel>(size: UVec2, pixels: Vec<P>) -> Image {
    let levels = 32 - size.max_element().leading_zeros();
    let mut bytes: Vec<u8> = Vec::with_capacity(pixels.len() * 4 / 3 * 4 + 64);
    let (mut size_of_level, mut level) = (size, pixels);
    for _ in 0..levels {
        bytes.extend(level.iter().flat_map(|pixel| pixel.bytes()));
        (size_of_level, level) = halved(size_of_level, &level);
    }
    let mut image = Image::new_uninit(extent(size), TextureDimension::D2, P::FORMAT, RenderAssetUsages::RENDER_WORLD);
    image.texture_descriptor.mip_level_count = levels;
    image.data = Some(bytes);
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        mag_filter: ImageFilterMode::Linear,
        min_filter: ImageFilterMode::Linear,
        mipmap_filter: ImageFilterMode::Linear,
        // Land is seen from the side.
        anisotropy_clamp: 8,
        ..default()
    });
    image
}

/// A texture of hard cells.
pub fn cells(size: UVec2, pixels: &[[u8; 4]]) -> Image {
    let format = <[u8; 4]>::FORMAT;
    let mut image = Image::new(
        extent(size),
        TextureDimension::D2,
        pixels.as_flattened().to_vec(),
        format,
        RenderAssetUsages::RENDER_WORLD,
    );
    image.sampler = ImageSampler::nearest();
    image
}

fn extent(size: UVec2) -> Extent3d {
    Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 }
}

/// Half the columns and rows, at least one of each.
fn halved<P: Pixel>(size: UVec2, pixels: &[P]) -> (UVec2, Vec<P>) {
    let half = (size / 2).max(UVec2::ONE);
    let last = size - 1;
    let at = |x: u32, y: u32| pixels[y.min(last.y) as usize * size.x as usize + x.min(last.x) as usize];
    let mut level = Vec::with_capacity(half.element_product() as usize);
    for (x, y) in (0..half.y).flat_map(|y| (0..half.x).map(move |x| (2 * x, 2 * y))) {
        level.push(P::mean([at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)]));
    }
    (half, level)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_go_down_to_one_pixel_and_keep_the_mean() {
        let pixels = (0..40).map(|index| if index % 2 == 0 { [200, 0, 8, 255] } else { [100, 0, 8, 255] }).collect();
        let image = smooth(uvec2(8, 5), pixels);
        // 8 × 5, 4 × 2, 2 × 1 and one pixel.
        assert_eq!(image.texture_descriptor.mip_level_count, 4);
        let data = image.data.unwrap();
        assert_eq!(data.len(), 4 * (40 + 8 + 2 + 1));
        assert_eq!(data[data.len() - 4..], [150, 0, 8, 255]);
    }
}
