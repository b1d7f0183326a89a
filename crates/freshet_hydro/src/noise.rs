//! Smooth random numbers over the plane.
use glam::{IVec2, UVec2, Vec2};

/// Gradient noise (Perlin 1985, with the fade of 2002) at `point`, within −1…1, with features of size 1.
///
/// Repeats after `period` along x and y (≥ 1 each); `seed` chooses one of many.
pub fn gradient_noise(point: Vec2, period: UVec2, seed: u32) -> f32 {
    let cell = point.floor();
    let p = point - cell;
    let corner = |x: i32, y: i32| {
        let at = (cell.as_ivec2() + IVec2::new(x, y)).rem_euclid(period.as_ivec2()).as_uvec2();
        let offset = p - Vec2::new(x as f32, y as f32);
        gradient(at, seed).dot(offset)
    };
    let fade = p * p * p * (p * (p * 6.0 - 15.0) + 10.0);
    let north = lerp(corner(0, 0), corner(1, 0), fade.x);
    let south = lerp(corner(0, 1), corner(1, 1), fade.x);
    // The sum reaches ±1/√2 at most.
    lerp(north, south, fade.y) * core::f32::consts::SQRT_2
}

/// `octaves` (≥ 1) layers of [`gradient_noise`], each twice as fine and of half the height, within −1…1.
pub fn fractal_noise(point: Vec2, period: UVec2, octaves: u32, seed: u32) -> f32 {
    let (mut sum, mut all) = (0.0, 0.0);
    for octave in 0..octaves {
        let (fineness, height) = (1u32 << octave, 0.5_f32.powi(octave as i32));
        sum += height * gradient_noise(point * fineness as f32, period * fineness, seed.wrapping_add(octave));
        all += height;
    }
    sum / all
}

/// A unit vector for a lattice point, one of eight: three layers hide that there are no more.
fn gradient(at: UVec2, seed: u32) -> Vec2 {
    const D: f32 = core::f32::consts::FRAC_1_SQRT_2;
    const DIRECTIONS: [(f32, f32); 8] =
        [(1.0, 0.0), (D, D), (0.0, 1.0), (-D, D), (-1.0, 0.0), (-D, -D), (0.0, -1.0), (D, -D)];
    DIRECTIONS[(hash(at, seed) >> 29) as usize].into()
}

/// Mixes the bits of two coordinates and a seed (multiply and xor-shift, after Ellis's lowbias32, 2018).
fn hash(at: UVec2, seed: u32) -> u32 {
    let mut x = at.x.wrapping_mul(0x9E37_79B9) ^ at.y.wrapping_mul(0x85EB_CA6B) ^ seed.wrapping_mul(0xC2B2_AE35);
    x = (x ^ (x >> 16)).wrapping_mul(0x7FEB_352D);
    x = (x ^ (x >> 15)).wrapping_mul(0x846C_A68B);
    x ^ (x >> 16)
}

fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{uvec2, vec2};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn noise_repeats_is_bounded_and_smooth(x in -40.0_f32..40.0, y in -40.0_f32..40.0, seed in 0_u32..99) {
            let (point, period) = (vec2(x, y), uvec2(5, 3));
            let here = fractal_noise(point, period, 3, seed);
            prop_assert!(here.abs() <= 1.0);
            let again = fractal_noise(point + vec2(5.0, -3.0), period, 3, seed);
            prop_assert!((here - again).abs() < 2e-3, "{here} {again}");
            let near = fractal_noise(point + vec2(1e-3, 0.0), period, 3, seed);
            prop_assert!((here - near).abs() < 1e-2);
        }
    }

    #[test]
    fn noise_has_no_preferred_sign_and_varies() {
        let place = |i: u32| vec2((i % 64) as f32, (i / 64) as f32) * 0.37;
        let values: Vec<f32> = (0..4096).map(|i| gradient_noise(place(i), UVec2::splat(4096), 7)).collect();
        let mean = values.iter().sum::<f32>() / 4096.0;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f32>() / 4096.0;
        assert!(mean.abs() < 0.03 && (0.03..0.3).contains(&variance), "mean {mean}, variance {variance}");
    }
}
