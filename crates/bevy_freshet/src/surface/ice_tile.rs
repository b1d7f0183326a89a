//! The tile of snow relief and cracks.
use bevy::{
    asset::RenderAssetUsages,
    image::Image,
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
    tasks::{AsyncComputeTaskPool, Task, block_on},
};
use core::f32::consts::TAU;
use freshet_hydro::noise::fractal_noise;

/// Texels along one side of the tile.
const SIZE: usize = 512;
/// Largest slope that a texel holds, heights (0…1) per tile: what 8 bits stand for. `ice.wgsl` has it as `STEEPEST`.
const STEEPEST: f32 = 48.0;
/// Cracks that begin somewhere in the tile; branches come on top.
const CRACKS: usize = 11;

/// The tile, which takes too long to be made within a frame.
#[derive(Default)]
pub(super) enum IceTile {
    /// No water can freeze yet.
    #[default]
    Unwanted,
    Making(Task<Image>),
    Made(Handle<Image>),
}

impl IceTile {
    /// Begins to make the tile in the background: a water may freeze.
    pub fn want(&mut self) {
        if matches!(self, Self::Unwanted) {
            *self = Self::Making(AsyncComputeTaskPool::get().spawn(async { ice_tile() }));
        }
    }

    /// The tile; waits for it if it is not there yet.
    pub fn get(&mut self, images: &mut Assets<Image>) -> Handle<Image> {
        let image = match core::mem::take(self) {
            Self::Made(handle) => handle,
            Self::Making(task) => images.add(block_on(task)),
            Self::Unwanted => images.add(ice_tile()),
        };
        *self = Self::Made(image.clone());
        image
    }
}

/// Everything that ice needs of a pattern in four bytes: red and green the slope of the relief, blue cracks, alpha the
/// relief's height, all heights equally common. It repeats, and has all its mip levels.
fn ice_tile() -> Image {
    let mut level = texels();
    let mut data = Vec::new();
    let mut size = SIZE;
    loop {
        data.extend(level.iter().flat_map(|texel| texel.to_array()).map(|c| (c * 255.0 + 0.5) as u8));
        if size == 1 {
            break;
        }
        level = halved(&level, size);
        size /= 2;
    }
    let extent = Extent3d { width: SIZE as u32, height: SIZE as u32, depth_or_array_layers: 1 };
    let format = TextureFormat::Rgba8Unorm;
    let mut image = Image::new_uninit(extent, TextureDimension::D2, format, RenderAssetUsages::default());
    image.texture_descriptor.label = Some("water_ice");
    image.texture_descriptor.mip_level_count = SIZE.ilog2() + 1;
    image.data = Some(data);
    image
}

fn texels() -> Vec<Vec4> {
    let heights = heights();
    let cracks = cracks();
    let at = |x: usize, y: usize| heights[(y % SIZE) * SIZE + x % SIZE];
    (0..SIZE * SIZE)
        .map(|i| {
            let (x, y) = (i % SIZE, i / SIZE);
            let east = at(x + 1, y) - at(x + SIZE - 1, y);
            let south = at(x, y + 1) - at(x, y + SIZE - 1);
            let slope = vec2(east, south) * (0.5 * SIZE as f32 / STEEPEST);
            let coded = (slope * 0.5 + 0.5).clamp(Vec2::ZERO, Vec2::ONE);
            coded.extend(cracks[i]).extend(heights[i])
        })
        .collect()
}

/// Drifts of snow, 0…1: noise whose ridges lie across the wind, with all heights equally common.
fn heights() -> Vec<f32> {
    let place = |i: usize| vec2((i % SIZE) as f32, (i / SIZE) as f32) / SIZE as f32;
    let noise: Vec<f32> = (0..SIZE * SIZE)
        .map(|i| {
            let p = place(i);
            // Bent, so that the drifts are no straight waves.
            let bend = fractal_noise(p * 2.0, UVec2::splat(2), 2, 11);
            fractal_noise(p * vec2(3.0, 5.0) + vec2(0.6, 0.9) * bend, uvec2(3, 5), 6, 5)
        })
        .collect();
    let mut order: Vec<u32> = (0..noise.len() as u32).collect();
    order.sort_unstable_by(|&a, &b| noise[a as usize].total_cmp(&noise[b as usize]));
    let mut ranks = vec![0.0; noise.len()];
    for (rank, &i) in order.iter().enumerate() {
        ranks[i as usize] = rank as f32 / (noise.len() - 1) as f32;
    }
    ranks
}

/// A crack on its way through the ice.
struct Crack {
    place: Vec2,
    /// Angle to x, rad.
    heading: f32,
    /// Opacity, 0…1.
    strength: f32,
    /// Way left, texels.
    length: f32,
}

/// Long cracks that wind a little, turn now and then, and branch.
fn cracks() -> Vec<f32> {
    let mut random = fastrand::Rng::with_seed(0x1CE_C4AC);
    let mut opacity = vec![0.0_f32; SIZE * SIZE];
    let mut growing: Vec<Crack> = (0..CRACKS)
        .map(|_| Crack {
            place: vec2(random.f32(), random.f32()) * SIZE as f32,
            heading: random.f32() * TAU,
            strength: 0.5 + 0.5 * random.f32(),
            length: SIZE as f32 * (0.4 + random.f32()),
        })
        .collect();
    while let Some(mut crack) = growing.pop() {
        let whole = crack.length;
        while crack.length > 0.0 {
            // It thins out towards its end.
            splat(&mut opacity, crack.place, crack.strength * (crack.length / whole).sqrt());
            crack.heading += (random.f32() - 0.5) * 0.16;
            if random.f32() < 0.012 {
                crack.heading += (random.f32() - 0.5) * 1.2;
            }
            if random.f32() < 0.008 && crack.strength > 0.3 {
                let turn = (0.5 + 0.5 * random.f32()) * if random.bool() { 1.0 } else { -1.0 };
                let (heading, strength) = (crack.heading + turn, crack.strength * 0.7);
                growing.push(Crack { heading, strength, length: crack.length * 0.5, ..crack });
            }
            crack.place += Vec2::from_angle(crack.heading) * 0.5;
            crack.length -= 0.5;
        }
    }
    opacity
}

/// Draws a dot of about two texels with soft edges.
fn splat(opacity: &mut [f32], place: Vec2, strength: f32) {
    let center = place.floor();
    for dy in -1..=1 {
        for dx in -1..=1 {
            let texel = center + vec2(dx as f32, dy as f32);
            let distance = (texel + 0.5).distance(place);
            let wrapped = texel.rem_euclid(Vec2::splat(SIZE as f32)).as_uvec2();
            let value = &mut opacity[wrapped.y as usize * SIZE + wrapped.x as usize];
            *value = value.max(strength * (1.4 - distance).clamp(0.0, 1.0));
        }
    }
}

fn halved(level: &[Vec4], size: usize) -> Vec<Vec4> {
    let half = size / 2;
    let texel = |x: usize, y: usize| level[y * size + x];
    (0..half * half)
        .map(|i| (2 * (i % half), 2 * (i / half)))
        .map(|(x, y)| (texel(x, y) + texel(x + 1, y) + texel(x, y + 1) + texel(x + 1, y + 1)) * 0.25)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shader_knows_the_steepest_slope() {
        assert!(include_str!("ice.wgsl").contains(&format!("const STEEPEST: f32 = {STEEPEST:?};")));
    }

    #[test]
    fn slopes_fit_into_their_bytes_and_average_to_level() {
        let texels = texels();
        let clipped = texels.iter().filter(|t| t.x <= 0.0 || t.x >= 1.0 || t.y <= 0.0 || t.y >= 1.0).count();
        assert!(clipped < texels.len() / 500, "{clipped} slopes are too steep");
        let mean = texels.iter().sum::<Vec4>() / texels.len() as f32;
        assert!((mean.xy() - 0.5).abs().max_element() < 1e-3 && (mean.w - 0.5).abs() < 1e-3, "{mean}");
        assert!((0.005..0.1).contains(&mean.z), "cracks cover {}", mean.z);
    }

    /// How long the tile is made in the background.
    #[test]
    #[ignore = "a measurement: run it with --ignored --nocapture"]
    fn the_tile_takes() {
        let start = std::time::Instant::now();
        let size = ice_tile().data.map_or(0, |data| data.len());
        println!("{:.0} ms for {size} bytes", start.elapsed().as_secs_f64() * 1e3);
    }
}
