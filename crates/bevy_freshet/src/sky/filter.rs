//! Blurring a cube map for Bevy's image-based light.
//!
//! `environment_map.wgsl` expects in `specular_map` the radiance averaged over the GGX lobe of perceptual roughness
//! level / (levels − 1), and in `diffuse_map` irradiance / π, so that a white surface under an even sky has its radiance.

use super::cubemap::Cubemap;
use bevy::math::{Vec3, ops};
use std::f32::consts::{PI, TAU};

/// Texels along an edge of a face of the diffuse map; irradiance changes slowly.
const DIFFUSE_SIZE: usize = 16;
/// The same of the radiance that is summed for it.
const DIFFUSE_SOURCE_SIZE: usize = 32;

/// Halves a map down to one texel a face. The size must be a power of two; the first level is the map itself.
pub(super) fn pyramid(base: Cubemap) -> Vec<Cubemap> {
    let mut levels = vec![base];
    while let Some(last) = levels.last()
        && last.size > 1
    {
        levels.push(last.halved());
    }
    levels
}

/// One level per roughness from 0 to 1, made from the plain pyramid.
pub(super) fn specular(pyramid: &[Cubemap]) -> Vec<Cubemap> {
    let last = (pyramid.len() - 1).max(1) as f32;
    let blur = |(level, plain): (usize, &Cubemap)| match level {
        0 => plain.clone(),
        _ => blurred(pyramid, level, level as f32 / last),
    };
    pyramid.iter().enumerate().map(blur).collect()
}

/// ∫ L cos θ dω / π around every direction.
pub(super) fn diffuse(pyramid: &[Cubemap]) -> Cubemap {
    let small = |map: &&Cubemap| map.size <= DIFFUSE_SOURCE_SIZE;
    let source = pyramid.iter().find(small).unwrap_or(&pyramid[0]);
    let light = |(index, radiance): (usize, &Vec3)| {
        let solid_angle = Cubemap::solid_angle(source.size, index);
        (Cubemap::direction(source.size, index), *radiance * solid_angle)
    };
    let lights: Vec<(Vec3, Vec3)> = source.texels.iter().enumerate().map(light).collect();
    Cubemap::from_fn(DIFFUSE_SIZE, |_, normal| {
        let sum: Vec3 = lights.iter().map(|(direction, power)| *power * direction.dot(normal).max(0.0)).sum();
        sum / PI
    })
}

/// A direction of the lobe around +z, its weight, and the level of the pyramid whose texels are as wide as its share.
struct Sample {
    direction: Vec3,
    weight: f32,
    level: usize,
}

fn blurred(pyramid: &[Cubemap], level: usize, roughness: f32) -> Cubemap {
    let samples = lobe(pyramid, level, roughness);
    let total: f32 = samples.iter().map(|s| s.weight).sum();
    Cubemap::from_fn(pyramid[level].size, |_, normal| {
        let (right, up) = normal.any_orthonormal_pair();
        let seen = |s: &Sample| {
            let d = s.direction;
            pyramid[s.level].sample(right * d.x + up * d.y + normal * d.z) * s.weight
        };
        samples.iter().map(seen).sum::<Vec3>() / total
    })
}

/// Importance samples of GGX seen head-on (Karis 2013, *Real Shading in Unreal Engine 4*), each read from a blurred level
/// so that few suffice (Křivánek & Colbert 2008, *Real-Time Shading with Filtered Importance Sampling*).
fn lobe(pyramid: &[Cubemap], level: usize, roughness: f32) -> Vec<Sample> {
    let count = 24 + 8 * level as u32;
    let alpha2 = ops::powf(roughness, 4.0);
    let texel = 4.0 * PI / (6 * pyramid[0].size * pyramid[0].size) as f32;
    let sample = |i: u32| {
        // Hammersley points: an even step and the bits of the index mirrored.
        let (u, v) = ((i as f32 + 0.5) / count as f32, i.reverse_bits() as f32 / u32::MAX as f32);
        let cos2 = (1.0 - u) / (1.0 + (alpha2 - 1.0) * u);
        let half =
            Vec3::new(ops::cos(TAU * v), ops::sin(TAU * v), 0.0) * ops::sqrt(1.0 - cos2) + Vec3::Z * ops::sqrt(cos2);
        let direction = 2.0 * half.z * half - Vec3::Z;
        let spread = 1.0 + (alpha2 - 1.0) * cos2;
        let density = alpha2 / (PI * spread * spread) / 4.0;
        let share = 1.0 / (count as f32 * density.max(1e-6));
        // One level more than the share asks for hides the single samples of a bright spot (same source).
        let wanted = (0.5 * ops::log2(share / texel) + 1.0).max(level as f32 - 1.0).round() as usize;
        Sample { direction, weight: direction.z, level: wanted.min(pyramid.len() - 1) }
    };
    (0..count).map(sample).filter(|s| s.weight > 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bright_half() -> Vec<Cubemap> {
        pyramid(Cubemap::from_fn(64, |_, d| Vec3::new(d.y.max(0.0), 1.0, f32::from(d.x > 0.0))))
    }

    #[test]
    fn an_even_sky_stays_as_it_is() {
        let pyramid = pyramid(Cubemap::from_fn(32, |_, _| Vec3::splat(3.0)));
        for map in specular(&pyramid).iter().chain([&diffuse(&pyramid)]) {
            assert!(map.texels.iter().all(|t| t.distance(Vec3::splat(3.0)) < 0.02));
        }
    }

    #[test]
    fn diffuse_is_irradiance_over_pi() {
        let pyramid = bright_half();
        let diffuse = diffuse(&pyramid);
        for normal in [Vec3::Y, Vec3::NEG_Y, Vec3::X, Vec3::new(0.6, 0.5, -0.6).normalize()] {
            let expected = pyramid[0].integrate(|d| d.dot(normal).max(0.0)) / PI;
            let found = diffuse.sample(normal);
            assert!(found.distance(expected) < 0.015 * expected.length(), "{normal}: {found} for {expected}");
        }
        // Analytic: a sky of radiance cos θ lights level ground with 2π/3.
        assert!((diffuse.sample(Vec3::Y).x - 2.0 / 3.0).abs() < 0.01);
    }

    #[test]
    fn rougher_levels_are_softer_and_lose_no_light() {
        let levels = specular(&bright_half());
        let contrast = |map: &Cubemap| map.sample(Vec3::new(1.0, 0.0, 0.2)).z - map.sample(Vec3::new(-1.0, 0.0, 0.2)).z;
        for pair in levels.windows(2).take(5) {
            assert!(contrast(&pair[1]) <= contrast(&pair[0]) + 0.02);
            let mean = |map: &Cubemap| map.integrate(|_| 1.0).z / (4.0 * PI);
            assert!((mean(&pair[0]) - mean(&pair[1])).abs() < 0.02);
        }
    }
}
