//! Radiance of the cloudless sky, by day and in twilight.
//!
//! By day it is the model of Hošek & Wilkie (2012), *An Analytic Model for Full Spectral Sky-Dome Radiance*. That model
//! ends where the sun touches the horizon; below, its last shape gives way to a plain description of dusk, and both follow
//! the measured illuminance of twilight. Radiance is linear sRGB whose luminance is in cd/m².

use super::sun::{self, luminance};
use bevy::math::{FloatExt, Vec3, ops};
use hw_skymodel::rgb::{Error, SkyParams, SkyState};
use std::f32::consts::{PI, TAU};

/// cd/m² per unit of the model's RGB radiance: 683 lm/W, the luminous efficacy that defines the candela.
///
/// Checked against the clear sky of the IESNA (RP-21, 1984), which gives level ground 0.8 + 15.5 √(sin h) klx without sun:
/// at turbidity 2 and h from 20° to 90° the two differ by less than 12 %.
const EFFICACY: f32 = 683.0;

/// How far down the sky the haze of the horizon reaches: sine of the angle at which 1 − 1/e of the ground shows.
const HAZE_SINE: f32 = 0.06;

/// Sine of the lowest altitude at which the model is asked.
const LOWEST_SINE: f32 = 0.025;

/// Share of the haze that is coarse dust and droplets. They throw light a few degrees around the sun, a glare that the
/// fitted model leaves out; 0.06 gives about 10⁵ cd/m² two degrees from a high sun.
const COARSE_HAZE: f32 = 0.06;

/// The cloudless sky for one position of the sun.
#[derive(Clone, Debug)]
pub(super) struct ClearSky {
    /// Unit vector to the sun.
    pub sun_direction: Vec3,
    /// Illuminance of a surface that faces the sun, in lux per channel; 0 when the disc has set.
    pub sun_illuminance: Vec3,
    /// Illuminance of level ground by the sky alone, in lux per channel.
    pub sky_illuminance: Vec3,
    /// Radiance of level ground under sun and sky, in cd/m² per channel.
    pub ground: Vec3,
    model: HosekWilkie,
    day_scale: f32,
    dusk: Dusk,
    dusk_scale: f32,
    aureole: Vec3,
}

impl ClearSky {
    /// Prepares the sky for a sun at `elevation` and `azimuth` (radians), turbidity 1…10 and ground albedo 0…1.
    ///
    /// # Errors
    /// Turbidity or albedo out of the model's range.
    pub fn new(elevation: f32, azimuth: f32, turbidity: f32, ground_albedo: Vec3) -> Result<Self, Error> {
        let sun_direction = sun::direction(elevation, azimuth);
        let mut sky = Self {
            sun_direction,
            sun_illuminance: sun::beam(elevation, turbidity) * sun::visible_share(elevation),
            sky_illuminance: Vec3::ZERO,
            ground: Vec3::ZERO,
            model: HosekWilkie::new(elevation, azimuth, turbidity, ground_albedo)?,
            day_scale: EFFICACY * low_sun_correction(elevation),
            dusk: Dusk::new(elevation, azimuth),
            dusk_scale: 0.0,
            aureole: Vec3::ZERO,
        };
        sky.aureole = sky.sun_illuminance * sun::haze_depth(elevation, turbidity).min(Vec3::ONE) * COARSE_HAZE;
        if elevation < 0.0 {
            sky.calibrate_twilight(elevation);
        }
        sky.sky_illuminance = illuminance(|d| sky.above(d));
        let lit = sky.sky_illuminance + sky.sun_illuminance * sun_direction.y.max(0.0);
        sky.ground = ground_albedo * lit / PI;
        Ok(sky)
    }

    /// Scales both shapes so that level ground is lit as measured, and shifts from day to dusk within 5°.
    fn calibrate_twilight(&mut self, elevation: f32) {
        let day = |d| self.model.radiance(d) * self.low_sun_tint(d);
        let horizon = luminance(illuminance(day)) * self.day_scale;
        let target = horizon * sun::ground_illuminance(elevation) / sun::ground_illuminance(0.0);
        let dusk = smoothstep(0.0, 5.0, -elevation.to_degrees());
        self.day_scale *= (1.0 - dusk) * target / horizon;
        self.dusk_scale = dusk * target / luminance(illuminance(|d| self.dusk.radiance(d)));
    }

    /// Radiance in a direction, in cd/m² per channel, without the solar disc. Below the horizon its haze fades into ground.
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        if direction.y >= 0.0 {
            return self.above(direction);
        }
        let level = Vec3::new(direction.x, 0.0, direction.z).normalize_or(Vec3::X);
        self.ground.lerp(self.above(level), ops::exp(direction.y / HAZE_SINE))
    }

    /// What the model lacks under a sun lower than 14°: the ozone that keeps the zenith blue (Hulburt 1953) and the red
    /// of the horizon around the sun, which its three channels render as yellow. Tuned by eye; luminance about kept.
    fn low_sun_tint(&self, direction: Vec3) -> Vec3 {
        const ZENITH: Vec3 = Vec3::new(0.82, 0.94, 1.30);
        const HORIZON: Vec3 = Vec3::new(1.38, 0.90, 0.68);
        let low = 1.0 - smoothstep(0.0, 14.0, ops::asin(self.sun_direction.y.max(0.0)).to_degrees());
        let facing = 0.5 + 0.5 * direction.dot(self.model.sun);
        let near = ops::exp(-direction.y / 0.25) * (0.25 + 0.75 * facing);
        Vec3::ONE.lerp(ZENITH.lerp(HORIZON, near), low)
    }

    fn above(&self, direction: Vec3) -> Vec3 {
        let mut radiance = self.aureole * sun::henyey_greenstein(0.975, direction.dot(self.sun_direction));
        if self.day_scale > 0.0 {
            radiance += self.model.radiance(direction) * self.day_scale * self.low_sun_tint(direction);
        }
        if self.dusk_scale > 0.0 {
            radiance += self.dusk.radiance(direction) * self.dusk_scale;
        }
        radiance
    }
}

/// The model is too bright for a sun below 10°: together with the beam it lights the ground three times too much at sunset.
///
/// A straight line brings the sum back to the measured [`sun::ground_illuminance`] within a quarter.
fn low_sun_correction(elevation: f32) -> f32 {
    0.32_f32.lerp(1.0, (elevation.to_degrees() / 10.0).clamp(0.0, 1.0))
}

/// Illuminance of level ground, ∫ L cos θ dω over the upper hemisphere, in lux per channel for L in cd/m².
fn illuminance(radiance: impl Fn(Vec3) -> Vec3) -> Vec3 {
    const RINGS: usize = 24;
    const SECTORS: usize = 48;
    let mut sum = Vec3::ZERO;
    for ring in 0..RINGS {
        // Equal steps of sin²θ carry equal projected solid angle.
        let sine = ops::sqrt((ring as f32 + 0.5) / RINGS as f32);
        for sector in 0..SECTORS {
            let (z, x) = ops::sin_cos((sector as f32 + 0.5) * TAU / SECTORS as f32);
            sum += radiance(Vec3::new(sine * x, ops::sqrt(1.0 - sine * sine), sine * z));
        }
    }
    sum * PI / (RINGS * SECTORS) as f32
}

/// Hošek & Wilkie's distribution, the three channels evaluated together.
#[derive(Clone, Debug)]
struct HosekWilkie {
    sun: Vec3,
    /// Coefficients A…I of the paper's equation 8 in the order of the published data sets, each for three channels.
    p: [Vec3; 9],
    mean: Vec3,
}

impl HosekWilkie {
    fn new(elevation: f32, azimuth: f32, turbidity: f32, albedo: Vec3) -> Result<Self, Error> {
        let elevation = elevation.max(0.0);
        let (p, mean) = SkyState::new(&SkyParams { elevation, turbidity, albedo: albedo.to_array() })?.raw();
        Ok(Self {
            sun: sun::direction(elevation, azimuth),
            p: std::array::from_fn(|i| Vec3::new(p[i], p[9 + i], p[18 + i])),
            mean: Vec3::from_array(mean),
        })
    }

    /// Equation 8 for a direction at or above the horizon; γ is the angle to the sun, θ that to the zenith.
    fn radiance(&self, direction: Vec3) -> Vec3 {
        let exp = |v: Vec3| Vec3::new(ops::exp(v.x), ops::exp(v.y), ops::exp(v.z));
        let p = &self.p;
        // The last degree above the horizon is where the fit runs away in colour.
        let cos_theta = direction.y.max(LOWEST_SINE);
        let cos_gamma = direction.dot(self.sun).clamp(-1.0, 1.0);
        let base = 1.0 + p[8] * p[8] - 2.0 * cos_gamma * p[8];
        let mie = (1.0 + cos_gamma * cos_gamma) / (base * base.map(ops::sqrt));
        let gradient = 1.0 + p[0] * exp(p[1] / (cos_theta + 0.01));
        let glow = p[2] + p[3] * exp(p[4] * ops::acos(cos_gamma)) + p[5] * cos_gamma * cos_gamma + p[6] * mie;
        (self.mean * gradient * (glow + p[7] * ops::sqrt(cos_theta))).max(Vec3::ZERO)
    }
}

/// Colours of the sky after sunset, of any scale; a description after photographs, not a model.
#[derive(Clone, Debug)]
struct Dusk {
    /// Horizontal unit vector towards the sun.
    towards: Vec3,
    /// Degrees of the sun below the horizon.
    depth: f32,
}

impl Dusk {
    fn new(elevation: f32, azimuth: f32) -> Self {
        Self { towards: sun::direction(0.0, azimuth), depth: (-elevation.to_degrees()).max(0.0) }
    }

    /// Blue dome, twilight arch over the sun, and opposite it the Belt of Venus above the rising shadow of the Earth.
    fn radiance(&self, direction: Vec3) -> Vec3 {
        let altitude = ops::asin(direction.y.clamp(0.0, 1.0)).to_degrees();
        let level = Vec3::new(direction.x, 0.0, direction.z).normalize_or_zero();
        let facing = 0.5 + 0.5 * level.dot(self.towards);
        // The zenith loses light faster than the arch: about a factor of ten while the sun sinks from 3° to 9°.
        let night = smoothstep(7.0, 17.0, self.depth);
        let arch = (1.0 - night) * ops::exp((0.30 * self.depth).min(2.4));
        let height = |scale: f32| ops::exp(-altitude / scale);

        let dome = Vec3::new(0.13, 0.22, 0.50).lerp(Vec3::new(0.30, 0.39, 0.56), height(16.0));
        let ember = Vec3::new(1.00, 0.30, 0.05) * (height(4.5) * ops::powf(facing, 5.0));
        let gold = Vec3::new(0.85, 0.46, 0.19) * (height(8.0) * ops::powf(facing, 3.0));
        let violet = Vec3::new(0.30, 0.21, 0.36) * (height(20.0) * facing * facing);
        let offset = (altitude - 5.0 - 1.6 * self.depth) / 5.0;
        let pink = 1.0 - smoothstep(4.0, 8.0, self.depth);
        let belt = Vec3::new(0.34, 0.17, 0.20) * (ops::exp(-offset * offset) * (1.0 - facing) * pink);
        let shadow = 1.0 - 0.35 * (1.0 - facing) * (1.0 - smoothstep(0.0, 4.0 + 1.6 * self.depth, altitude));
        let moonless = Vec3::new(0.40, 0.52, 0.95) * (1.0 + 0.5 * height(20.0));
        (dome * shadow + belt + (0.6 * ember + 0.5 * gold + 0.4 * violet) * arch).lerp(moonless, night)
    }
}

/// Hermite step from 0 at `low` to 1 at `high`.
pub(super) fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALBEDO: Vec3 = Vec3::splat(0.15);

    fn sky(degrees: f32) -> ClearSky {
        ClearSky::new(degrees.to_radians(), 1.0, 2.5, ALBEDO).unwrap()
    }

    fn ground_illuminance(sky: &ClearSky) -> f32 {
        luminance(sky.sky_illuminance + sky.sun_illuminance * sky.sun_direction.y.max(0.0))
    }

    #[test]
    fn three_channels_at_once_equal_the_crate() {
        use hw_skymodel::rgb::Channel;
        let (elevation, azimuth) = (0.4, 2.0);
        let model = HosekWilkie::new(elevation, azimuth, 3.0, ALBEDO).unwrap();
        let reference = SkyState::new(&SkyParams { elevation, turbidity: 3.0, albedo: ALBEDO.to_array() }).unwrap();
        for direction in [Vec3::new(0.2, 0.9, 0.3), Vec3::new(-0.7, 0.1, 0.7), Vec3::new(0.5, 0.5, 0.6)] {
            let d = direction.normalize();
            let (theta, gamma) = (d.y.acos(), d.dot(model.sun).acos());
            let expected = [Channel::R, Channel::G, Channel::B].map(|c| reference.radiance(theta, gamma, c));
            assert!(model.radiance(d).distance(Vec3::from_array(expected)) < 1e-3);
        }
    }

    #[test]
    fn daylight_agrees_with_the_iesna_clear_sky() {
        for degrees in [20.0, 35.0, 50.0, 70.0_f32] {
            let sky = ClearSky::new(degrees.to_radians(), 0.0, 2.0, ALBEDO).unwrap();
            let expected = 800.0 + 15_500.0 * degrees.to_radians().sin().sqrt();
            let ratio = luminance(sky.sky_illuminance) / expected;
            assert!((0.88..1.15).contains(&ratio), "{degrees}°: {ratio}");
        }
    }

    #[test]
    fn sun_and_sky_light_the_ground_as_measured() {
        for degrees in [-17.0, -10.0, -4.0, -1.0, 1.0, 3.0, 6.0, 10.0, 20.0, 45.0, 80.0] {
            let expected = sun::ground_illuminance(f32::to_radians(degrees));
            let ratio = ground_illuminance(&sky(degrees)) / expected;
            assert!((0.7..1.45).contains(&ratio), "{degrees}°: {ratio}");
        }
    }

    #[test]
    fn the_ground_brightens_with_every_step_of_the_sun() {
        let mut last = 0.0;
        for half_degrees in -36..=180 {
            let now = ground_illuminance(&sky(half_degrees as f32 / 2.0));
            // Near the zenith the fit of the model wavers by a thousandth.
            assert!(now > 0.998 * last, "{half_degrees}: {last} then {now}");
            last = now;
        }
    }

    #[test]
    fn radiance_is_finite_and_not_negative_everywhere() {
        for degrees in [-90.0, -18.0, -5.0, -0.1, 0.0, 0.1, 45.0, 90.0] {
            for turbidity in [1.0, 10.0] {
                let sky = ClearSky::new(f32::to_radians(degrees), 3.0, turbidity, Vec3::ONE).unwrap();
                for direction in [Vec3::Y, Vec3::NEG_Y, Vec3::X, sky.sun_direction, -sky.sun_direction] {
                    let l = sky.radiance(direction);
                    assert!(l.is_finite() && l.min_element() >= 0.0, "{degrees}° {direction}: {l}");
                }
            }
        }
    }
}
