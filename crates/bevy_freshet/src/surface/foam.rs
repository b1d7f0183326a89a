//! The tile of foam.
use super::tile;
use bevy::{prelude::*, render::render_resource::TextureFormat};
use std::f32::consts::{SQRT_2, TAU};

/// Texels along one side of the tile.
const SIZE: usize = 512;

/// Patterns ([`WaterFoam::pattern_size`](crate::body::WaterFoam::pattern_size)) across the tile: so many that none sees it repeat.
pub(super) const PATTERNS: f32 = 4.0;

/// Cells of bubbles across the tile and the weight of each scale: froth is made of large and small bubbles.
const SCALES: [(usize, f32); 3] = [(20, 1.0), (48, 0.7), (116, 0.4)];

/// Waves of the patches across the tile, fewest and most, and how many of them.
const PATCHES: (f32, f32, usize) = (2.0, 7.0, 40);

/// How soon foam covers a place, as two standard normal variates: one that follows the walls between bubbles (red, its
/// square green), and one that gathers them to patches (blue, its square alpha).
///
/// Where the variate is above `−Φ⁻¹(d)` there is foam of mean cover `d`: thin foam is a lace along the walls between
/// bubbles, dense foam is closed but for their middles. A normal variate stays one when others are mixed in with weights
/// whose squares sum to one (Heitz and Neyret 2018), so the cover stays right while foam drifts.
pub(super) fn foam_tile() -> Image {
    let (bubbles, patches) = (normal(&froth()), normal(&patches()));
    let texels = bubbles.into_iter().zip(patches).map(|(a, b)| [a, a * a, b, b * b]).collect();
    tile::repeating("water_foam", TextureFormat::Rgba16Float, SIZE, texels)
}

/// A sum of long waves in all directions.
fn patches() -> Vec<f32> {
    let mut random = fastrand::Rng::with_seed(0x9A7C);
    let mut sum = vec![0.0; SIZE * SIZE];
    let (fewest, most, count) = PATCHES;
    for _ in 0..count {
        let waves = fewest * (most / fewest).powf(random.f32());
        let vector = (Vec2::from_angle(random.f32() * TAU) * waves).round();
        let phase = random.f32() * TAU;
        for (i, value) in sum.iter_mut().enumerate() {
            let place = vec2((i % SIZE) as f32, (i / SIZE) as f32) / SIZE as f32;
            *value += (vector.dot(place) * TAU + phase).sin() / waves;
        }
    }
    sum
}

/// Nearness to the walls between bubbles, summed over scales.
fn froth() -> Vec<f32> {
    let mut random = fastrand::Rng::with_seed(0xF0A3);
    let mut sum = vec![0.0; SIZE * SIZE];
    for (cells, weight) in SCALES {
        let centers: Vec<Vec2> = (0..cells * cells).map(|_| vec2(random.f32(), random.f32())).collect();
        for (i, value) in sum.iter_mut().enumerate() {
            let place = vec2((i % SIZE) as f32, (i / SIZE) as f32) * (cells as f32 / SIZE as f32);
            *value -= weight * wall_distance(place, cells, &centers);
        }
    }
    sum
}

/// Difference of the distances from `place` to the two nearest centres (Worley 1996), one centre in each of `cells`²
/// cells that repeat; in cells.
fn wall_distance(place: Vec2, cells: usize, centers: &[Vec2]) -> f32 {
    let home = place.floor().as_ivec2();
    let (mut nearest, mut second) = (f32::MAX, f32::MAX);
    for z in -1..=1 {
        for x in -1..=1 {
            let cell = home + ivec2(x, z);
            let wrapped = cell.rem_euclid(IVec2::splat(cells as i32));
            let center = cell.as_vec2() + centers[wrapped.y as usize * cells + wrapped.x as usize];
            let distance = place.distance_squared(center);
            second = second.min(distance.max(nearest));
            nearest = nearest.min(distance);
        }
    }
    second.sqrt() - nearest.sqrt()
}

/// The values replaced by those of a standard normal distribution in the same order.
fn normal(values: &[f32]) -> Vec<f32> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]).then(a.cmp(&b)));
    let mut variates = vec![0.0; values.len()];
    for (rank, index) in order.into_iter().enumerate() {
        variates[index] = quantile((rank as f32 + 0.5) / values.len() as f32);
    }
    variates
}

/// Φ⁻¹, after Winitzki's (2008) approximation of the inverse error function: off by less than 0.008
/// where the tile has values.
fn quantile(share: f32) -> f32 {
    const A: f32 = 0.147;
    let x = 2.0 * share - 1.0;
    let log = (1.0 - x * x).ln();
    let half = 2.0 / (std::f32::consts::PI * A) + 0.5 * log;
    SQRT_2 * ((half * half - log / A).sqrt() - half).sqrt().copysign(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_variates_are_standard_normal() {
        for variates in [normal(&froth()), normal(&patches())] {
            let count = variates.len() as f32;
            let mean = variates.iter().sum::<f32>() / count;
            let variance = variates.iter().map(|v| v * v).sum::<f32>() / count - mean * mean;
            assert!(mean.abs() < 1e-3 && (variance - 1.0).abs() < 0.01, "{mean} {variance}");
            let above = variates.iter().filter(|&&v| v > 1.2816).count() as f32 / count;
            assert!((above - 0.1).abs() < 0.002, "{above}");
        }
    }

    /// Thin foam lies along walls, the middle of a bubble is covered last.
    #[test]
    fn walls_come_before_middles() {
        let centers = [vec2(0.5, 0.5); 9];
        assert!(wall_distance(vec2(1.0, 1.5), 3, &centers) < 1e-6);
        assert!((wall_distance(vec2(1.5, 1.5), 3, &centers) - 1.0).abs() < 1e-6);
    }

    /// The inverse of the deviation of a mean of four values `step` tiles apart.
    fn widened(variates: &[f32], step: Vec2) -> f32 {
        let texel = |along: f32| (along * SIZE as f32).round().rem_euclid(SIZE as f32) as usize % SIZE;
        let at = |place: Vec2| variates[texel(place.y) * SIZE + texel(place.x)];
        let mean = |place: Vec2| (0..4).map(|n| at(place + step * (n as f32 - 1.5))).sum::<f32>() / 4.0;
        let places = (0..64 * 64).map(|i| vec2((i % 64) as f32, (i / 64) as f32) / 64.0);
        (places.map(|place| mean(place).powi(2)).sum::<f32>() / (64.0 * 64.0)).sqrt().recip()
    }

    #[test]
    fn samples_in_a_row_deviate_as_the_shader_takes_them_to() {
        let smoothstep = |t: f32| t * t * (3.0 - 2.0 * t);
        let wgsl = include_str!("foam.wgsl");
        assert!(wgsl.contains("(1.0 + min(length(streak) / 0.014, 1.0))"));
        let bubbles = |length: f32| 1.0 + (length / 0.014).min(1.0);
        assert!(wgsl.contains("(1.0 + 1.25 * smoothstep(0.0, 0.16, length(band)))"));
        let patches = |length: f32| 1.0 + 1.25 * smoothstep((length / 0.16).min(1.0));
        // Bubbles are smaller than patches.
        for (variates, unit, assumed) in [
            (normal(&froth()), PATTERNS.recip(), &bubbles as &dyn Fn(f32) -> f32),
            (normal(&super::patches()), 1.0, &patches),
        ] {
            for length in [0.01, 0.02, 0.04, 0.06, 0.08, 0.1, 0.12, 0.16, 0.2, 0.22].map(|length| length * unit) {
                let turns = (0..8).map(|turn| Vec2::from_angle(turn as f32 * 0.8) * length);
                let measured = turns.map(|step| widened(&variates, step)).sum::<f32>() / 8.0;
                let error = assumed(length) / measured - 1.0;
                assert!(error.abs() < 0.1, "{length}: {measured}, assumed {}", assumed(length));
            }
        }
    }
}
