//! The waves of a water, seen and felt alike.
use bevy::prelude::*;
use core::f32::consts::TAU;

/// One wave train of [`WaterWaves`].
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Clone, Debug, PartialEq)]
pub struct Wave {
    /// Direction of travel in the water's local xz; need not be normalised.
    pub direction: Vec2,
    /// Distance between crests, m, > 0.
    pub wavelength: f32,
    /// Wavenumber × amplitude, 0…1: 0 is flat, 1 has cusps at its crests.
    pub steepness: f32,
    /// Phase at the origin at time zero, rad.
    pub phase: f32,
}

/// Gerstner waves on the water: the drawn surface and [`WaterQuery`](crate::query::WaterQuery) use the same ones.
///
/// Each train travels with the speed of its dispersion relation, `ω² = (g k + (σ/ρ) k³) tanh(k d)`.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug)]
pub struct WaterWaves {
    /// The trains, at most [`WaterWaves::MAX`]; further ones are ignored with a warning. Their steepnesses should sum to
    /// less than 1, else the surface folds over itself; they are scaled down with a warning.
    pub trains: Vec<Wave>,
    /// Depth for the dispersion relation, m, > 0. Default infinite: deep water.
    pub depth: f32,
    /// Depth below which the waves fade towards the shore, m, ≥ 0. Default 0.8; 0 switches the fading off. Acts where
    /// a [`WaterBed`](crate::body::WaterBed) is.
    pub fade_depth: f32,
}

impl WaterWaves {
    /// Most trains that a water can have.
    pub const MAX: usize = 8;

    /// No waves: a mirror, but for the fine ripples of [`WaterSurface`](crate::surface::WaterSurface).
    pub const fn still() -> Self {
        Self { trains: Vec::new(), depth: f32::INFINITY, fade_depth: 0.8 }
    }

    /// Waves as a steady wind of `speed` (m/s, 10 m above the water, 0…30) raises them over a short `fetch` (m), blowing
    /// towards `direction` (local xz).
    ///
    /// Peak frequency and height after JONSWAP (Hasselmann et al. 1973): `f_p = 3.5 (g/U) X̃^−0.33` and
    /// `H_s = 0.0016 (U²/g) X̃^½` with `X̃ = g X/U²`. The trains spread over an octave and ± 60° around the peak and
    /// carry the energy of `H_s`.
    pub fn wind(speed: f32, fetch: f32, direction: Vec2) -> Self {
        let g = freshet_hydro::waves::GRAVITY;
        let (speed, fetch) = (speed.clamp(0.0, 30.0), fetch.max(1.0));
        if speed < 0.1 {
            return Self::still();
        }
        let fetch = g * fetch / (speed * speed);
        let peak = TAU * 3.5 * (g / speed) * fetch.powf(-0.33);
        let significant_height = 0.0016 * (speed * speed / g) * fetch.sqrt();
        // Relative frequency, angle to the wind (rad) and share of the energy of each train.
        let spread: [(f32, f32, f32); 7] = [
            (0.92, 0.35, 0.18),
            (1.0, -0.12, 0.24),
            (1.13, 0.62, 0.16),
            (1.27, -0.55, 0.15),
            (1.45, 0.21, 0.12),
            (1.68, -0.93, 0.09),
            (1.93, 0.88, 0.06),
        ];
        let wind = direction.normalize_or(Vec2::X);
        let trains = spread.iter().enumerate().map(|(i, &(frequency, angle, energy))| {
            let wavenumber = (peak * frequency).powi(2) / g;
            // H_s² = 16 m₀ and each train holds A²/2 of m₀.
            let amplitude = significant_height * (energy / 8.0).sqrt();
            Wave {
                direction: Vec2::from_angle(angle).rotate(wind),
                wavelength: TAU / wavenumber,
                steepness: wavenumber * amplitude,
                phase: i as f32 * 2.4,
            }
        });
        Self { trains: trains.collect(), ..Self::still() }
    }

    /// The same trains with `factor` (≥ 0) times their height: 0.5 is the sea after the wind has dropped.
    pub fn scaled(mut self, factor: f32) -> Self {
        for train in &mut self.trains {
            train.steepness *= factor;
        }
        self
    }
}

impl Default for WaterWaves {
    /// A breeze of 3 m/s over 200 m: waves of about 0.8 m length and 4 cm height.
    fn default() -> Self {
        Self::wind(3.0, 200.0, Vec2::new(1.0, 0.35))
    }
}
