//! Sums over all wave trains at eight particles at once, train by train, as the shader has them.
use super::WaveTrain;
use crate::lanes::{Lanes, Vectors};

/// A symmetric 2 × 2 matrix in xz for each particle.
#[derive(Clone, Copy)]
pub(super) struct Symmetric {
    xx: Lanes,
    xz: Lanes,
    zz: Lanes,
}

impl Symmetric {
    #[inline(always)]
    pub fn determinant(self) -> Lanes {
        self.xx * self.zz - self.xz * self.xz
    }

    /// The solution x of `self` x = `right`, times the determinant.
    #[inline(always)]
    pub fn adjugate_mul(self, right: [Lanes; 2]) -> [Lanes; 2] {
        [self.zz * right[0] - self.xz * right[1], self.xx * right[1] - self.xz * right[0]]
    }

    /// ∂x/∂x₀ = 1 − f Σ k̂k̂ᵀ k A cos θ from what Σ is.
    #[inline(always)]
    fn of_stretch(fade: Lanes, sum: Self) -> Self {
        let one = Lanes::splat(1.0);
        Self { xx: one - fade * sum.xx, xz: -(fade * sum.xz), zz: one - fade * sum.zz }
    }

    /// Adds what a train stretches.
    #[inline(always)]
    fn add(&mut self, train: &WaveTrain, cos: Lanes) {
        let (stretch, along) = (train.wave_vector * train.amplitude, train.direction);
        self.xx += cos * (stretch.x * along.x);
        self.xz += cos * (stretch.x * along.y);
        self.zz += cos * (stretch.y * along.y);
    }
}

const UNSTRETCHED: Symmetric = Symmetric { xx: Lanes::ZERO, xz: Lanes::ZERO, zz: Lanes::ZERO };

#[inline(always)]
fn sin_cos(train: &WaveTrain, rest: [Lanes; 2]) -> (Lanes, Lanes) {
    (rest[0] * train.wave_vector.x + rest[1] * train.wave_vector.y + Lanes::splat(train.phase)).sin_cos()
}

#[inline(always)]
fn displacement_of(train: &WaveTrain, sin: Lanes, cos: Lanes) -> Vectors {
    let aside = train.direction * -train.amplitude;
    Vectors { x: sin * aside.x, y: cos * train.amplitude, z: sin * aside.y }
}

/// Displacement of the particles that rest at `rest` (xz, m), m, and ∂x/∂x₀ of its horizontal part.
#[inline(always)]
pub(super) fn displacement(trains: &[WaveTrain], rest: [Lanes; 2], fade: Lanes) -> (Vectors, Symmetric) {
    let (mut moved, mut stretch) = (Vectors::ZERO, UNSTRETCHED);
    for train in trains {
        let (sin, cos) = sin_cos(train, rest);
        moved += displacement_of(train, sin, cos);
        stretch.add(train, cos);
    }
    (moved * fade, Symmetric::of_stretch(fade, stretch))
}

/// What moves at the surface.
pub(super) struct Motion {
    /// m.
    pub displacement: Vectors,
    /// m/s.
    pub velocity: Vectors,
    /// ∂y/∂x₀.
    pub slope: [Lanes; 2],
    /// ∂x/∂x₀.
    pub stretch: Symmetric,
}

/// The motion of the particles that rest at `rest` (xz, m).
#[inline(always)]
pub(super) fn motion(trains: &[WaveTrain], rest: [Lanes; 2], fade: Lanes) -> Motion {
    let (mut moved, mut velocity, mut stretch) = (Vectors::ZERO, Vectors::ZERO, UNSTRETCHED);
    let mut slope = [Lanes::ZERO; 2];
    for train in trains {
        let (sin, cos) = sin_cos(train, rest);
        moved += displacement_of(train, sin, cos);
        let speed = train.amplitude * train.angular_frequency;
        let (along, steep) = (train.direction * speed, train.wave_vector * -train.amplitude);
        velocity += Vectors { x: cos * along.x, y: sin * speed, z: cos * along.y };
        slope[0] += sin * steep.x;
        slope[1] += sin * steep.y;
        stretch.add(train, cos);
    }
    Motion {
        displacement: moved * fade,
        velocity: velocity * fade,
        slope: slope.map(|slope| slope * fade),
        stretch: Symmetric::of_stretch(fade, stretch),
    }
}
