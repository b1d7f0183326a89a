//! The tile of fine ripples.
use super::tile;
use bevy::{prelude::*, render::render_resource::TextureFormat};
use core::f32::consts::TAU;

/// Texels along one side of the tile.
const SIZE: usize = 256;
/// Shortest ripple, in texels: four samples a wave.
const SHORTEST: f32 = 4.0;
/// Number of wave trains.
const TRAINS: usize = 160;

/// Slopes of a random sea that tiles: red and green ∂h/∂x and ∂h/∂z with a mean square slope of 1 together, blue the mean
/// square slope.
pub(super) fn detail_tile() -> Image {
    tile::repeating("water_detail", TextureFormat::Rgba16Float, SIZE, slopes())
}

/// A sum of sines whose wave vectors fit the tile, with directions all around and equal slope per octave.
fn slopes() -> Vec<[f32; 4]> {
    let mut random = fastrand::Rng::with_seed(0x0F2E_54E7);
    let mut sum = vec![Vec2::ZERO; SIZE * SIZE];
    let most = SIZE as f32 / SHORTEST;
    for _ in 0..TRAINS {
        // Equal numbers per octave between 4 waves a tile and the shortest ripple.
        let waves = 4.0 * (most / 4.0).powf(random.f32());
        let vector = (Vec2::from_angle(random.f32() * TAU) * waves).round();
        if vector == Vec2::ZERO {
            continue;
        }
        let phase = random.f32() * TAU;
        let direction = vector.normalize();
        for (i, slope) in sum.iter_mut().enumerate() {
            let place = vec2((i % SIZE) as f32, (i / SIZE) as f32) / SIZE as f32;
            *slope += direction * (vector.dot(place) * TAU + phase).sin();
        }
    }
    let mean_square = sum.iter().map(|s| s.length_squared()).sum::<f32>() / sum.len() as f32;
    let factor = mean_square.sqrt().recip();
    sum.iter().map(|s| *s * factor).map(|s| [s.x, s.y, s.length_squared(), 1.0]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slope_energy_survives_every_mip_level() {
        let mut level = slopes();
        let mut size = SIZE;
        while size > 1 {
            let mean_square = level.iter().map(|t| t[2]).sum::<f32>() / level.len() as f32;
            assert!((mean_square - 1.0).abs() < 1e-3, "{mean_square} at {size}");
            level = tile::halved(&level, size);
            size /= 2;
        }
        // Seen from afar the water is level, and all its slope has become variance.
        assert!(level[0][0].abs() < 0.02 && level[0][1].abs() < 0.02);
    }
}
