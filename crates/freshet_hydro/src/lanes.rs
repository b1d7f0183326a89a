//! Eight numbers at once: plain arrays, whose loops the compiler turns into vector instructions.
use std::f32::consts::{FRAC_2_PI, FRAC_PI_2};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// How many numbers are worked on at once.
pub(crate) const LANES: usize = 8;

/// Eight numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lanes(pub [f32; LANES]);

impl Lanes {
    pub const ZERO: Self = Self([0.0; LANES]);

    #[inline(always)]
    pub fn splat(value: f32) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f32) -> f32) -> Self {
        let mut result = self.0;
        for value in &mut result {
            *value = f(*value);
        }
        Self(result)
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        let mut result = self.0;
        for (value, other) in result.iter_mut().zip(other.0) {
            *value = f(*value, other);
        }
        Self(result)
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.map(f32::sqrt)
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        self.map(f32::abs)
    }

    /// At least `least`; that also in place of NaN.
    #[inline(always)]
    pub fn at_least(self, least: f32) -> Self {
        self.map(|value| if value > least { value } else { least })
    }

    /// Sine and cosine of angles in rad, within 1.5e-7 up to 10⁴ rad and 1e-6 up to 10⁵ rad.
    ///
    /// The nearest multiple of π/2 is taken away in three parts (Cody and Waite 1980), and what is left, at most π/4, goes through the
    /// polynomials of Moshier's Cephes library. The sums are the same on every machine, which those of a library that contracts
    /// a·b + c where it can are not.
    #[inline(always)]
    pub fn sin_cos(self) -> (Self, Self) {
        let (mut sin, mut cos) = (self, self);
        for (sin, cos) in sin.0.iter_mut().zip(&mut cos.0) {
            // Adding it leaves no digits behind the point, and the last ones before it are the quadrant.
            const ROUNDING: f32 = 1.5 * (1 << 23) as f32;
            let shifted = *sin * FRAC_2_PI + ROUNDING;
            let (turns, quadrant) = (shifted - ROUNDING, shifted.to_bits());
            let x = ((*sin - turns * 1.570_312_5) - turns * 4.837_513e-4) - turns * 7.549_79e-8;
            // Where all digits are gone the result is any number, but still that of some angle.
            let x = x.clamp(-FRAC_PI_2, FRAC_PI_2);
            let z = x * x;
            let odd = x + x * z * (z * (z * -1.951_529_6e-4 + 8.332_161e-3) - 0.166_666_55);
            let even = (1.0 - 0.5 * z) + z * z * (z * (z * 2.443_315_7e-5 - 1.388_731_6e-3) + 4.166_664_6e-2);
            let (s, c) = if quadrant & 1 == 0 { (odd, even) } else { (even, odd) };
            *sin = f32::from_bits(s.to_bits() ^ ((quadrant & 2) << 30));
            *cos = f32::from_bits(c.to_bits() ^ ((quadrant.wrapping_add(1) & 2) << 30));
        }
        (sin, cos)
    }

    #[inline(always)]
    pub fn sum(self) -> f32 {
        let [a, b, c, d, e, f, g, h] = self.0;
        ((a + b) + (c + d)) + ((e + f) + (g + h))
    }
}

impl Add for Lanes {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Lanes {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul for Lanes {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl Mul<f32> for Lanes {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f32) -> Self {
        self.map(|value| value * factor)
    }
}

impl Div for Lanes {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
}

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|value| -value)
    }
}

/// Eight vectors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Vectors {
    pub x: Lanes,
    pub y: Lanes,
    pub z: Lanes,
}

impl Vectors {
    pub const ZERO: Self = Self { x: Lanes::ZERO, y: Lanes::ZERO, z: Lanes::ZERO };

    #[inline(always)]
    pub fn splat(value: glam::Vec3) -> Self {
        Self { x: Lanes::splat(value.x), y: Lanes::splat(value.y), z: Lanes::splat(value.z) }
    }

    #[inline(always)]
    pub fn set(&mut self, lane: usize, value: glam::Vec3) {
        (self.x.0[lane], self.y.0[lane], self.z.0[lane]) = (value.x, value.y, value.z);
    }

    #[inline(always)]
    pub fn dot(self, other: Self) -> Lanes {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    pub fn sum(self) -> glam::Vec3 {
        glam::Vec3::new(self.x.sum(), self.y.sum(), self.z.sum())
    }
}

impl Add for Vectors {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl AddAssign for Vectors {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Vectors {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl Mul<Lanes> for Vectors {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: Lanes) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_are_those_of_double_precision() {
        for k in 0..200_000 {
            let magnitude = 10.0_f32.powf(-4.0 + 8.9 * (k as f32 / 2e5));
            let angles = std::array::from_fn(|lane| magnitude * (1.0 - 0.3 * lane as f32));
            let (sin, cos) = Lanes(angles).sin_cos();
            for (lane, angle) in angles.iter().enumerate() {
                let (s, c) = f64::from(*angle).sin_cos();
                let error = (f64::from(sin.0[lane]) - s).abs().max((f64::from(cos.0[lane]) - c).abs());
                assert!(error < if angle.abs() < 1e4 { 1.5e-7 } else { 1e-6 }, "{error:e} off at {angle}");
            }
        }
        for angle in [2e7, 5e7, -1e9, 1e30, f32::MAX] {
            let (sin, cos) = Lanes::splat(angle).sin_cos();
            assert!(sin.0[0].abs() < 1.1 && cos.0[0].abs() < 1.1, "{angle}: {}, {}", sin.0[0], cos.0[0]);
        }
        let (sin, cos) = Lanes::splat(f32::INFINITY).sin_cos();
        assert!(sin.0[0].is_nan() && cos.0[0].is_nan());
    }
}
