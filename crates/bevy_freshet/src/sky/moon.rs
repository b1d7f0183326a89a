//! The moon: where it stands, and how its light compares with the sun's.
//!
//! Moonlight is sunlight, a little redder and fainter by a factor that only the phase decides. So everything that air and
//! clouds do to the sun's light they do to the moon's, scaled by [`Moon::light`].

use super::sun;
use bevy::{
    math::{Vec3, ops},
    reflect::{Reflect, std_traits::ReflectDefault},
};
use std::f32::consts::PI;

/// Mean angular radius of the moon's disc, in radians (15.5′).
pub(super) const LUNAR_RADIUS: f32 = 0.004_52;

/// Visual magnitude of the sun (Allen 1976).
const SOLAR_MAGNITUDE: f32 = -26.74;

/// Colour of moonlight relative to sunlight in linear sRGB, at the same luminance: the lunar soil reflects more red than blue,
/// so that its colour index B − V is 0.92 where the sun's is 0.65 (Allen 1976).
const SOIL: Vec3 = Vec3::new(1.080, 0.991, 0.813);

/// The moon of a [`Sky`](super::Sky).
///
/// Its place is independent of the sun's, and so is its phase: only the bright limb always faces the sun.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub struct Moon {
    /// Angle of the moon's centre above the horizon, in radians, −π/2…π/2. Default: 0.61 (35°).
    pub elevation: f32,
    /// Bearing of the moon in radians: 0 is north (−z), growing clockwise to east (+x). Any value. Default: 2.4 (137°).
    pub azimuth: f32,
    /// Phase angle in radians, 0…π: 0 is full, π/2 half, π new. Default: 0.
    pub phase: f32,
}

impl Default for Moon {
    fn default() -> Self {
        Self { elevation: 0.61, azimuth: 2.4, phase: 0.0 }
    }
}

impl Moon {
    /// A full moon at an elevation and an azimuth, both in **degrees**.
    pub fn full(elevation_degrees: f32, azimuth_degrees: f32) -> Self {
        Self { elevation: elevation_degrees.to_radians(), azimuth: azimuth_degrees.to_radians(), phase: 0.0 }
    }

    /// Unit vector from the scene to the moon.
    pub fn direction(&self) -> Vec3 {
        sun::direction(self.elevation, self.azimuth)
    }

    /// Share of the disc that is lit, 0…1: (1 + cos α)/2.
    pub fn lit_share(&self) -> f32 {
        0.5 + 0.5 * ops::cos(self.phase)
    }

    /// Moonlight as a share of sunlight under the same elevation, per linear sRGB channel: 1 : 400 000 when full.
    ///
    /// V(α) = −12.73 + 0.026 |α| + 4·10⁻⁹ α⁴, α in degrees (Allen 1976; Krisciunas & Schaefer 1991, eq. 9).
    pub(super) fn light(&self) -> Vec3 {
        let degrees = self.phase.to_degrees();
        let magnitude = -12.73 + 0.026 * degrees + 4e-9 * degrees.powi(4);
        SOIL * ops::powf(10.0, 0.4 * (SOLAR_MAGNITUDE - magnitude))
    }

    /// Radiance of the lit part of the disc for a given illuminance, in cd/m² per channel.
    pub(super) fn disc_radiance(&self, illuminance: Vec3) -> Vec3 {
        illuminance / (PI * LUNAR_RADIUS * LUNAR_RADIUS * self.lit_share().max(1e-3))
    }

    /// Whether the sun, in the direction `to_sun`, lights what is seen of the moon in `direction`.
    ///
    /// A point of the disc at x towards the bright limb, in radii, and y across has the normal (x, y, √(1 − x² − y²)), the
    /// last towards the eye; the sun shines from (sin α, 0, cos α).
    pub(super) fn is_lit(&self, direction: Vec3, to_sun: Vec3) -> bool {
        let center = self.direction();
        let limb = to_sun.reject_from(center).normalize_or(center.any_orthonormal_vector());
        let place = (direction - center * direction.dot(center)) / LUNAR_RADIUS;
        let depth = ops::sqrt((1.0 - place.length_squared()).max(0.0));
        let (sin, cos) = ops::sin_cos(self.phase);
        place.length_squared() <= 1.0 && place.dot(limb) * sin + depth * cos > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::{
        super::{clear::ClearSky, sun::luminance},
        *,
    };

    #[test]
    fn a_full_moon_in_the_zenith_gives_a_quarter_of_a_lux() {
        let lit = ClearSky::new(0.5 * PI, 0.0, 2.0, Vec3::splat(0.15)).unwrap();
        let moon = Moon { elevation: 0.5 * PI, ..Moon::default() };
        let ground = luminance((lit.sun_illuminance + lit.sky_illuminance) * moon.light());
        assert!((0.2..0.32).contains(&ground), "{ground} lx");
    }

    #[test]
    fn a_half_moon_is_a_tenth_as_bright() {
        // Ten times, not twice: the soil throws light back where it comes from (Allen 1976 gives 2.7 magnitudes).
        let [full, half] = [0.0, 0.5 * PI].map(|phase| luminance(Moon { phase, ..Moon::default() }.light()));
        assert!((full / half / 10.0 - 1.0).abs() < 0.35, "{}", full / half);
    }

    #[test]
    fn the_lit_share_of_the_disc_is_that_of_its_phase() {
        let to_sun = sun::direction(-0.4, 0.3);
        for phase in [0.0, 0.7, 0.5 * PI, 2.5, PI] {
            let moon = Moon { phase, ..Moon::default() };
            let (right, up) = moon.direction().any_orthonormal_pair();
            let at = |i: i32, j: i32| {
                let offset = (right * i as f32 + up * j as f32) * (LUNAR_RADIUS / 50.0);
                (moon.direction() + offset).normalize()
            };
            let all = (-50..=50).flat_map(|i| (-50..=50).map(move |j| (i, j)));
            let (mut lit, mut disc) = (0.0, 0.0);
            for (i, j) in all.filter(|(i, j)| i * i + j * j < 2500) {
                disc += 1.0;
                lit += f32::from(u8::from(moon.is_lit(at(i, j), to_sun)));
            }
            assert!((lit / disc - moon.lit_share()).abs() < 0.03, "{phase}: {}", lit / disc);
        }
    }
}
