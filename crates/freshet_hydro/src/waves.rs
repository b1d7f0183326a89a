//! Gerstner waves on water of finite depth with surface tension.
//!
//! A wave train of wavenumber `k = |k|` moves a particle that rests at `x₀` to
//!
//! ```text
//! x = x₀ − Σ f k̂ᵢ Aᵢ sin θᵢ        y = Σ f Aᵢ cos θᵢ        θᵢ = kᵢ·x₀ − ωᵢ t + φᵢ
//! ```
//!
//! (Gerstner 1802; M06 eq. for the ocean), with `ω² = (g k + (σ/ρ) k³) tanh(k d)` (Airy 1845). The factor `f` is
//! [`shallow_fade`], the same for all trains of one place. The surface shader's `waves.wgsl` holds the same equations.
mod heights;
mod particles;
mod search;
mod sums;

pub use heights::HeightSearch;
pub use particles::{INVERSION_TOLERANCE, Particle};

use core::f32::consts::TAU;
use glam::{Vec2, Vec3};

/// Standard acceleration of gravity, m/s².
pub const GRAVITY: f32 = 9.81;
/// Density of fresh water at 20 °C, kg/m³.
pub const WATER_DENSITY: f32 = 998.2;
/// Surface tension of clean water against air at 20 °C, N/m (IAPWS 1994).
pub const SURFACE_TENSION: f32 = 0.0728;

/// Angular frequency, rad/s, of a small wave of `wavenumber` (rad/m) on water of `depth` (m, may be infinite).
///
/// `ω² = (g k + (σ/ρ) k³) tanh(k d)`.
pub fn angular_frequency(wavenumber: f32, depth: f32) -> f32 {
    let k = f64::from(wavenumber);
    let tension = f64::from(SURFACE_TENSION / WATER_DENSITY);
    libm::sqrt((f64::from(GRAVITY) * k + tension * k * k * k) * libm::tanh(k * f64::from(depth))) as f32
}

/// Share of the waves' height that is left at `depth` (m): 0 on dry land, 1 from `fade_depth` (m) on, smooth between.
///
/// A `fade_depth` of zero switches the fading off.
pub fn shallow_fade(depth: f32, fade_depth: f32) -> f32 {
    if fade_depth <= 0.0 {
        return 1.0;
    }
    let t = (depth / fade_depth).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The most that [`shallow_fade`] rises while the depth grows by `fade_depth`.
pub const STEEPEST_FADE: f32 = 1.5;

/// One wave train, as a user describes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Direction of travel in xz; need not be normalised.
    pub direction: Vec2,
    /// Distance between crests, m, > 0.
    pub wavelength: f32,
    /// Wavenumber × amplitude, 0…1: 0 is flat, 1 has cusps at its crests.
    pub steepness: f32,
    /// Phase at the origin at time zero, rad.
    pub phase: f32,
}

/// One wave train at one instant, ready to be summed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaveTrain {
    /// Wave vector in xz, rad/m.
    pub wave_vector: Vec2,
    /// Its direction, of length 1.
    pub direction: Vec2,
    /// Amplitude, m.
    pub amplitude: f32,
    /// Angular frequency, rad/s.
    pub angular_frequency: f32,
    /// `φ − ω t`, reduced to one turn, rad.
    pub phase: f32,
}

impl WaveTrain {
    /// The train of `wave` on water of `depth` (m) at `time` (s). The phase is reduced in double precision, so that
    /// it stays exact for days.
    pub fn at(wave: &Wave, depth: f32, time: f64) -> Self {
        let wavenumber = TAU / wave.wavelength;
        let angular_frequency = angular_frequency(wavenumber, depth);
        let phase = (f64::from(wave.phase) - f64::from(angular_frequency) * time) % core::f64::consts::TAU;
        let direction = wave.direction.normalize_or(Vec2::X);
        Self {
            wave_vector: direction * wavenumber,
            direction,
            amplitude: wave.steepness / wavenumber,
            angular_frequency,
            phase: phase as f32,
        }
    }

    fn sin_cos(&self, rest: Vec2) -> (f32, f32) {
        libm::sincosf(self.wave_vector.dot(rest) + self.phase)
    }
}

/// All wave trains of a water at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WaveField {
    /// The trains; their order is the order of summation.
    pub trains: Vec<WaveTrain>,
}

impl WaveField {
    /// The field of `waves` on water of `depth` (m) at `time` (s).
    pub fn at(waves: &[Wave], depth: f32, time: f64) -> Self {
        Self { trains: waves.iter().map(|wave| WaveTrain::at(wave, depth, time)).collect() }
    }

    /// Velocity, m/s, of the water `below` (m, 0…`depth`) the particle that rests at `rest`, in a column of `depth` (m, > 0, may be
    /// infinite).
    ///
    /// Of each train's velocity at the surface cosh k(h − d)/cosh k h is left to and fro, and sinh k(h − d)/sinh k h up and down
    /// (Airy 1845): e^(−k d) of both in deep water.
    pub fn velocity_below(&self, rest: Vec2, fade: f32, below: f32, depth: f32) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for train in &self.trains {
            let (sin, cos) = train.sin_cos(rest);
            let speed = train.amplitude * train.angular_frequency;
            let wavenumber = train.wave_vector.length();
            let decay = libm::expf(-wavenumber * below);
            let (here, all) = (-2.0 * wavenumber * (depth - below).max(0.0), -2.0 * wavenumber * depth);
            let level = decay * (1.0 + libm::expf(here)) / (1.0 + libm::expf(all));
            let upright = if all < 0.0 { decay * libm::expm1f(here) / libm::expm1f(all) } else { 0.0 };
            let horizontal = train.direction * (speed * cos * level);
            sum += Vec3::new(horizontal.x, speed * sin * upright, horizontal.y);
        }
        sum * fade
    }

    /// Bound of how far a search is from its goal at the end, m, if displacements differ by at most `contraction` per distance.
    fn unfinished(&self, contraction: f32) -> f32 {
        libm::powf(contraction, search::LEAST_CONTRACTIONS as f32) * self.total_amplitude()
    }

    /// Replaces `carried` by the waves that a lattice of these two `steps` (xz, m) can carry: all of a train that has four samples a wave
    /// along both of them, nothing of one that has but two along one, smooth between. What is shorter would be seen at random. Allocates
    /// only if `carried` has no room.
    pub fn carried_by(&self, steps: [Vec2; 2], carried: &mut Self) {
        let share = |train: &WaveTrain| {
            let turned = steps.map(|step| train.wave_vector.dot(step).abs());
            let samples = TAU / turned[0].max(turned[1]).max(f32::MIN_POSITIVE);
            let t = (0.5 * (samples - 2.0)).clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        };
        let scaled = |train: &WaveTrain| WaveTrain { amplitude: share(train) * train.amplitude, ..*train };
        carried.trains.clear();
        carried.trains.extend(self.trains.iter().map(scaled).filter(|train| train.amplitude > 0.0));
    }

    /// Sum of `k A` of all trains: from 1 on the surface can fold over itself.
    pub fn total_steepness(&self) -> f32 {
        self.trains.iter().map(|train| train.wave_vector.length() * train.amplitude).sum()
    }

    /// Sum of the amplitudes, m: no crest is higher, no trough deeper.
    pub fn total_amplitude(&self) -> f32 {
        self.trains.iter().map(|train| train.amplitude).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use glam::Vec3Swizzles;

    fn sea() -> Vec<Wave> {
        [(4.0, 0.25, 0.3), (2.3, 0.2, 1.2), (1.1, 0.15, 2.9), (0.6, 0.1, -0.8)]
            .map(|(wavelength, steepness, angle)| Wave {
                direction: Vec2::from_angle(angle),
                wavelength,
                steepness,
                phase: angle * 3.0,
            })
            .to_vec()
    }

    #[test]
    fn slowest_wave_is_where_theory_puts_it() {
        // (4 g σ/ρ)^¼ = 0.2313 m/s at λ = 1.713 cm.
        let speed = |wavelength: f32| angular_frequency(TAU / wavelength, f32::INFINITY) * wavelength / TAU;
        assert_relative_eq!(speed(0.01713), 0.2313, epsilon = 1e-4);
        assert!(speed(0.012) > speed(0.01713) && speed(0.025) > speed(0.01713));
    }

    #[test]
    fn long_waves_travel_with_the_shallow_water_speed() {
        let (depth, wavelength) = (0.5, 50.0);
        let speed = angular_frequency(TAU / wavelength, depth) * wavelength / TAU;
        assert_relative_eq!(speed, (GRAVITY * depth).sqrt(), max_relative = 0.002);
    }

    #[test]
    fn crests_move_with_the_phase_speed() {
        let wave = Wave { direction: Vec2::X, wavelength: 3.0, steepness: 0.2, phase: 0.0 };
        let speed = angular_frequency(TAU / 3.0, 2.0) * 3.0 / TAU;
        for time in [0.0, 0.7, 12.3, 86_400.0] {
            let field = WaveField::at(&[wave], 2.0, time);
            // A crest stands over the resting particle c·t, modulo the wavelength.
            let crest = ((f64::from(speed) * time) % 3.0) as f32;
            let moved = field.particle(Vec2::new(crest, 5.0), 1.0).displacement;
            assert_relative_eq!(moved.y, 0.2 * 3.0 / TAU, max_relative = 1e-3);
        }
    }

    #[test]
    fn inversion_finds_the_particle_above_a_place() {
        let field = WaveField::at(&sea(), 3.0, 17.2);
        for i in 0..1000 {
            let place = Vec2::new((i % 40) as f32 * 0.31, (i / 40) as f32 * 0.27);
            let found = field.particle_above(place, |_| 1.0);
            assert!((found.rest + found.displacement.xz()).distance(place) < 1.1 * INVERSION_TOLERANCE);
        }
    }

    /// Sums of cosines that nearly fold, some of them in one direction, and far from the origin.
    #[test]
    fn steep_waves_are_searched_to_the_end() {
        for (count, steepness, far) in [(1, 0.95, 0.0), (3, 0.95, 0.0), (12, 0.9, 0.0), (12, 0.9, 3000.0)] {
            let waves: Vec<_> = (0..count)
                .map(|i| Wave {
                    direction: Vec2::from_angle(0.2 * i as f32),
                    wavelength: 7.0 * 0.8_f32.powi(i),
                    steepness: steepness / count as f32,
                    phase: i as f32,
                })
                .collect();
            let field = WaveField::at(&waves, 5.0, 3.0);
            for i in 0..2000 {
                let place = Vec2::new(far + i as f32 * 0.013, far - i as f32 * 0.007);
                let found = field.particle_above(place, |_| 1.0);
                let beside = (found.rest + found.displacement.xz()).distance(place);
                assert!(beside <= INVERSION_TOLERANCE.max(1e-6 * far), "{beside} m beside {place}");
            }
        }
    }

    #[test]
    fn normal_is_the_gradient_of_the_height() {
        let field = WaveField::at(&sea(), 3.0, 4.0);
        let height = |place| field.particle_above(place, |_| 1.0).displacement.y;
        let h = 0.01;
        for i in 0..50 {
            let place = Vec2::new(i as f32 * 0.37, i as f32 * 0.11);
            let slope = Vec2::new(
                (height(place + Vec2::X * h) - height(place - Vec2::X * h)) / (2.0 * h),
                (height(place + Vec2::Y * h) - height(place - Vec2::Y * h)) / (2.0 * h),
            );
            let normal = field.particle_above(place, |_| 1.0).normal;
            assert_relative_eq!(-normal.x / normal.y, slope.x, epsilon = 0.02);
            assert_relative_eq!(-normal.z / normal.y, slope.y, epsilon = 0.02);
        }
    }

    #[test]
    fn velocity_is_the_rate_of_the_displacement() {
        let (dt, rest) = (1e-3, Vec2::new(0.4, 2.0));
        let before = WaveField::at(&sea(), 3.0, 9.0 - dt).particle(rest, 1.0).displacement;
        let after = WaveField::at(&sea(), 3.0, 9.0 + dt).particle(rest, 1.0).displacement;
        let velocity = WaveField::at(&sea(), 3.0, 9.0).particle(rest, 1.0).velocity;
        assert!(((after - before) / (2.0 * dt as f32)).distance(velocity) < 2e-3);
    }

    /// In deep water e^(−k d); over a bed nothing goes up and down at it, and the flow has neither sources nor eddies.
    #[test]
    fn velocity_below_is_that_of_airy() {
        let wave = Wave { direction: Vec2::X, wavelength: 4.0, steepness: 0.1, phase: 0.4 };
        let (field, k) = (WaveField::at(&[wave], 1.5, 2.0), TAU / 4.0);
        let rest = Vec2::new(0.7, 0.0);
        let surface = field.particle(rest, 0.8).velocity;
        assert!(field.velocity_below(rest, 0.8, 0.0, 1.5).abs_diff_eq(surface, 1e-6));
        let deep = field.velocity_below(rest, 0.8, 0.9, f32::INFINITY);
        assert!(deep.abs_diff_eq(surface * (-k * 0.9).exp(), 1e-6), "{deep}");
        let bottom = field.velocity_below(rest, 0.8, 1.5, 1.5);
        assert!(bottom.y.abs() < 1e-6 && bottom.x.abs() > 0.1 * surface.x.abs(), "{bottom}");
        assert_relative_eq!(bottom.x, surface.x / (k * 1.5).cosh(), max_relative = 1e-4);
        let middle = field.velocity_below(rest, 0.8, 0.6, 1.5);
        assert_relative_eq!(middle.y, surface.y * (k * 0.9).sinh() / (k * 1.5).sinh(), max_relative = 1e-4);
        assert!(field.velocity_below(rest, 0.8, 0.0, 0.0).is_finite());
    }

    #[test]
    fn samples_carry_waves_of_four_samples_and_none_of_two() {
        let waves: Vec<_> = [0.9, 2.0, 3.0, 4.0, 9.0]
            .map(|wavelength| Wave { direction: Vec2::X, wavelength, steepness: 0.1, phase: 0.0 })
            .to_vec();
        let (field, mut carried) = (WaveField::at(&waves, 5.0, 1.0), WaveField::default());
        field.carried_by([Vec2::X, 50.0 * Vec2::Y], &mut carried);
        assert_eq!(carried.trains[1..], field.trains[3..]);
        assert_relative_eq!(carried.trains[0].amplitude, 0.5 * field.trains[2].amplitude, max_relative = 1e-5);
        field.carried_by([Vec2::ZERO; 2], &mut carried);
        assert_eq!(carried, field);
    }

    #[test]
    fn waves_die_on_the_shore() {
        assert_eq!(shallow_fade(-0.1, 0.5), 0.0);
        assert_eq!(shallow_fade(0.25, 0.5), 0.5);
        assert_eq!(shallow_fade(7.0, 0.5), 1.0);
        assert_eq!(shallow_fade(0.0, 0.0), 1.0);
    }
}
