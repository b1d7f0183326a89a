//! A field of stars: not those of our sky, but as many of each brightness.

use super::cubemap::Cubemap;
use bevy::math::{Vec3, ops};
use std::f32::consts::TAU;

/// Illuminance by a star of magnitude 0 above the atmosphere, in lux (Schaefer 1993).
const ZERO_MAGNITUDE: f32 = 2.54e-6;

/// Stars of the whole sphere that are drawn: those to magnitude 6.5, the faintest that one sees.
const COUNT: usize = 8_500;

/// A star.
#[derive(Clone, Copy, Debug)]
pub(super) struct Star {
    /// Unit vector to it.
    pub direction: Vec3,
    /// Illuminance above the atmosphere, in lux per linear sRGB channel.
    pub illuminance: Vec3,
}

/// The stars of a seed, the brightest first.
///
/// N(m) = 4.8 · 10^(m/2) are brighter than magnitude m: fitted to the counts of the Bright Star Catalogue (Hoffleit & Warren
/// 1991), 15 to magnitude 1, 171 to 3, 1602 to 5, 8400 to 6.5, within 15 %. Places and colours are random.
pub(super) fn stars(seed: u32) -> impl Iterator<Item = Star> {
    let mut random = fastrand::Rng::with_seed(u64::from(seed) ^ 0x57A2);
    (0..COUNT).map(move |i| {
        let magnitude = 2.0 * ops::log10((i as f32 + 0.5) / 4.8);
        let height = 2.0 * random.f32() - 1.0;
        let (sin, cos) = ops::sin_cos(TAU * random.f32());
        let level = ops::sqrt(1.0 - height * height);
        // From orange giants over white to blue; luminance 1.
        let warmth = random.f32();
        let color = Vec3::new(0.82, 0.99, 1.62).lerp(Vec3::new(1.35, 0.95, 0.48), warmth * warmth);
        Star {
            direction: Vec3::new(level * cos, height, level * sin),
            illuminance: color * (ZERO_MAGNITUDE * ops::powf(10.0, -0.4 * magnitude)),
        }
    })
}

/// Adds the stars above the horizon to `radiance` (cd/m² per channel), each to the texel that it stands in. `through(texel,
/// direction)` is the share of the light that air and clouds let through.
pub(super) fn add_stars(radiance: &mut Cubemap, seed: u32, through: impl Fn(usize, Vec3) -> Vec3) {
    let size = radiance.size;
    for star in stars(seed).filter(|star| star.direction.y > 0.0) {
        let texel = Cubemap::texel_towards(size, star.direction);
        radiance.texels[texel] += star.illuminance * through(texel, star.direction) / Cubemap::solid_angle(size, texel);
    }
}

#[cfg(test)]
mod tests {
    use super::{super::sun::luminance, *};

    #[test]
    fn stars_are_as_many_as_in_the_catalogue() {
        for (magnitude, known) in [(1.0, 15.0), (3.0, 171.0), (5.0, 1602.0), (6.49, 8400.0_f32)] {
            let limit = ZERO_MAGNITUDE * 10.0_f32.powf(-0.4 * magnitude);
            let found = stars(3).filter(|star| luminance(star.illuminance) > limit).count() as f32;
            assert!((found / known - 1.0).abs() < 0.16, "{magnitude}: {found}");
        }
    }

    #[test]
    fn stars_keep_their_light_in_the_map() {
        for size in [16, 64] {
            let mut map = Cubemap::from_fn(size, |_, _| Vec3::ZERO);
            add_stars(&mut map, 5, |_, _| Vec3::ONE);
            let painted = map.integrate(|_| 1.0);
            let expected: Vec3 = stars(5).filter(|s| s.direction.y > 0.0).map(|star| star.illuminance).sum();
            assert!((painted / expected - 1.0).abs().max_element() < 1e-3, "{painted} {expected}");
        }
    }

    #[test]
    fn stars_are_spread_evenly_and_differ_with_the_seed() {
        let mean: Vec3 = stars(9).map(|star| star.direction).sum::<Vec3>() / COUNT as f32;
        assert!(mean.length() < 0.03, "{mean}");
        assert_ne!(stars(1).next().unwrap().direction, stars(2).next().unwrap().direction);
    }
}
