//! Where the sun stands and how much of its light the air lets through.
//!
//! Symbols: h elevation of the sun's centre as seen (refraction included), m relative optical air mass,
//! τ optical depth of the vertical air column, λ wavelength in µm, T Linke-like turbidity as in Preetham et al. (1999).

use bevy::math::{Vec3, ops};
use std::f32::consts::{FRAC_PI_2, PI};

/// Illuminance of sunlight above the atmosphere, in lux (Darula, Kittler & Gueymard 2005: 133.1 klx).
const SOLAR_ILLUMINANCE: f32 = 133_100.0;

/// Colour of that light in linear sRGB with luminance 1: chromaticity x 0.323, y 0.333 of the extraterrestrial spectrum.
const SOLAR_COLOR: Vec3 = Vec3::new(1.097, 0.977, 0.944);

/// Mean angular radius of the solar disc, in radians (16′).
pub(super) const SOLAR_RADIUS: f32 = 0.004_65;

/// Luminance of linear sRGB (ITU-R BT.709).
pub(super) fn luminance(color: Vec3) -> f32 {
    color.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

/// Unit vector to the sun; azimuth 0 is north (−z) and grows clockwise, to east (+x). Angles in radians.
pub(super) fn direction(elevation: f32, azimuth: f32) -> Vec3 {
    let ((sin_h, cos_h), (sin_a, cos_a)) = (ops::sin_cos(elevation), ops::sin_cos(azimuth));
    Vec3::new(cos_h * sin_a, sin_h, -cos_h * cos_a)
}

/// Relative optical air mass, 1 at the zenith and 38 at the horizon (Kasten & Young 1989, eq. 3). Held below the horizon.
fn air_mass(elevation: f32) -> f32 {
    let h = elevation.clamp(0.0, FRAC_PI_2);
    1.0 / (ops::sin(h) + 0.505_72 * ops::powf(h.to_degrees() + 6.079_95, -1.6364))
}

/// Dominant wavelengths of the linear sRGB primaries, in µm.
const WAVELENGTH: [f32; 3] = [0.611, 0.549, 0.464];

/// λ raised to a power, per channel.
fn wavelength_power(exponent: f32) -> Vec3 {
    Vec3::from_array(WAVELENGTH.map(|l| ops::powf(l, exponent)))
}

/// Vertical optical depth of the haze: β λ^−1.3 with Ångström's β = 0.04608 T − 0.04586 (Preetham, Shirley & Smits 1999,
/// appendix A.1).
fn aerosol_depth(turbidity: f32) -> Vec3 {
    (0.046_08 * turbidity - 0.045_86).max(0.0) * wavelength_power(-1.3)
}

/// Vertical optical depth of the whole air: Rayleigh 0.008735 λ^−4.08, haze, and 0.35 cm of ozone in the Chappuis band,
/// whose absorption per cm is read from the table of the same source.
fn optical_depth(turbidity: f32) -> Vec3 {
    const OZONE: Vec3 = Vec3::new(0.118, 0.087, 0.008);
    0.008_735 * wavelength_power(-4.08) + aerosol_depth(turbidity) + 0.35 * OZONE
}

/// Optical depth of the haze along the way to the sun, per linear sRGB channel.
pub(super) fn haze_depth(elevation: f32, turbidity: f32) -> Vec3 {
    aerosol_depth(turbidity) * air_mass(elevation)
}

/// Phase function of Henyey & Greenstein (1941), per steradian: g = 0 scatters evenly, g near 1 straight on.
pub(super) fn henyey_greenstein(g: f32, cosine: f32) -> f32 {
    let d = 1.0 + g * g - 2.0 * g * cosine;
    (1.0 - g * g) / (4.0 * PI * d * ops::sqrt(d))
}

/// Illuminance per linear sRGB channel, in lux, on a surface that faces the sun: its luminance-weighted sum is the
/// illuminance in the usual sense. It does not yet ask how much of the disc is above the horizon.
pub(super) fn beam(elevation: f32, turbidity: f32) -> Vec3 {
    SOLAR_ILLUMINANCE * SOLAR_COLOR * transmittance(elevation, turbidity)
}

/// Share of the light from beyond the atmosphere that reaches the ground, per linear sRGB channel.
pub(super) fn transmittance(elevation: f32, turbidity: f32) -> Vec3 {
    let depth = optical_depth(turbidity) * -air_mass(elevation);
    Vec3::from_array(depth.to_array().map(ops::exp))
}

/// The share of the solar disc above the horizon, 0…1: the area of a circle beyond a chord.
pub(super) fn visible_share(elevation: f32) -> f32 {
    let x = (elevation / SOLAR_RADIUS).clamp(-1.0, 1.0);
    0.5 + (x * ops::sqrt(1.0 - x * x) + ops::asin(x)) / PI
}

/// Radiance of the disc for a given illuminance: E / Ω, in cd/m² per channel.
pub(super) fn disc_radiance(illuminance: Vec3) -> Vec3 {
    illuminance / (PI * SOLAR_RADIUS * SOLAR_RADIUS)
}

/// Illuminance of level ground by sun and clear sky together, in lux, for any elevation.
///
/// Piecewise cubics for log₁₀ E in x = h / 90° (Seidelmann 1992, *Explanatory Supplement to the Astronomical Almanac*,
/// natural illumination; also US Naval Observatory Circular 171, 1987). Below −18° the light of a moonless night stays.
pub(super) fn ground_illuminance(elevation: f32) -> f32 {
    const SEGMENTS: [(f32, [f32; 4]); 6] = [
        (20.0, [3.74, 3.97, -4.07, 1.47]),
        (5.0, [3.05, 13.28, -45.98, 64.33]),
        (-0.8, [2.88, 22.26, -207.64, 1034.30]),
        (-5.0, [2.88, 21.81, -258.11, -858.36]),
        (-12.0, [2.70, 12.17, -431.69, -1899.83]),
        (-18.0, [13.84, 262.72, 1447.42, 2797.93]),
    ];
    let degrees = elevation.to_degrees().clamp(-18.0, 90.0);
    let x = degrees / 90.0;
    let lowest = SEGMENTS[SEGMENTS.len() - 1].1;
    let [a, b, c, d] = SEGMENTS.iter().find(|(from, _)| degrees >= *from).map_or(lowest, |(_, l)| *l);
    ops::powf(10.0, a + x * (b + x * (c + x * d)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn elevations() -> impl Iterator<Item = f32> {
        (0..=90).map(|degrees| (degrees as f32).to_radians())
    }

    #[test]
    fn azimuth_runs_clockwise_from_north() {
        assert!(direction(0.0, 0.0).distance(Vec3::NEG_Z) < 1e-6);
        assert!(direction(0.0, FRAC_PI_2).distance(Vec3::X) < 1e-6);
        assert!(direction(FRAC_PI_2, 1.0).distance(Vec3::Y) < 1e-6);
    }

    #[test]
    fn air_mass_has_its_tabulated_values() {
        // Kasten & Young 1989, table II: 37.92 at 0°, 10.31 at 5°, 1.994 at 30°, 1 at 90°.
        for (degrees, expected) in [(0.0, 37.92_f32), (5.0, 10.31), (30.0, 1.994), (90.0, 1.0)] {
            let found = air_mass(f32::to_radians(degrees));
            assert!((found / expected - 1.0).abs() < 2e-3, "{degrees}°: {found}");
        }
    }

    #[test]
    fn a_lower_sun_is_redder_and_dimmer() {
        let light: Vec<Vec3> = elevations().map(|h| beam(h, 2.5)).collect();
        for pair in light.windows(2) {
            let [low, high] = [pair[0], pair[1]];
            assert!(luminance(low) < luminance(high));
            assert!(low.x / low.y > high.x / high.y && low.y / low.z > high.y / high.z);
        }
    }

    #[test]
    fn sunlight_near_noon_is_about_a_hundred_kilolux() {
        let noon = luminance(beam(FRAC_PI_2, 2.0));
        assert!((90_000.0..115_000.0).contains(&noon), "{noon}");
    }

    #[test]
    fn twilight_has_its_known_marks_and_no_jumps() {
        // Civil twilight ends at 3.4 lx, nautical at 8 mlx (same source).
        assert!((ground_illuminance(-6_f32.to_radians()) - 3.4).abs() < 0.3);
        assert!((ground_illuminance(-12_f32.to_radians()) - 8e-3).abs() < 1e-3);
        let mut last = ground_illuminance(-0.5);
        for step in -1800..=9000 {
            let now = ground_illuminance((step as f32 / 100.0).to_radians());
            assert!(now >= last * 0.98 && now < last * 1.1, "{step}");
            last = now;
        }
    }

    #[test]
    fn the_disc_sets_smoothly() {
        assert_eq!(visible_share(0.1), 1.0);
        assert!((visible_share(0.0) - 0.5).abs() < 1e-6);
        assert_eq!(visible_share(-0.1), 0.0);
    }
}
