//! Matrices between motions and forces.
use super::{Motion, Wrench};
use glam::{Mat3, Vec3};
use std::ops::{Add, Mul};

/// A symmetric 6 × 6 matrix that turns a motion (velocity and angular velocity about the centre of mass) into a force and a torque:
/// a resistance, an inertia, or, per displacement and small turn, a stiffness. In SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spatial {
    /// Force per velocity.
    pub linear: Mat3,
    /// Torque per velocity; its transpose is force per angular velocity.
    pub coupling: Mat3,
    /// Torque per angular velocity.
    pub angular: Mat3,
}

impl Default for Spatial {
    /// Zero. (The default of a matrix is the identity.)
    fn default() -> Self {
        Self::ZERO
    }
}

impl Spatial {
    /// No force whatever the motion.
    pub const ZERO: Self = Self { linear: Mat3::ZERO, coupling: Mat3::ZERO, angular: Mat3::ZERO };

    /// Adds a point at `arm` from the centre of mass that answers its velocity v + ω × r with the force `b` (v + ω × r).
    pub fn add_at(&mut self, b: Mat3, arm: Vec3) {
        let cross = cross_matrix(arm);
        self.linear += b;
        self.coupling += cross * b;
        self.angular += cross * b * cross.transpose();
    }

    /// Adds a point at `arm` that answers only its velocity along `normal` (of unit length): `k` n (n · (v + ω × r)).
    pub fn add_along(&mut self, k: f32, normal: Vec3, arm: Vec3) {
        let lever = arm.cross(normal);
        let (scaled, turned) = (normal * k, lever * k);
        self.linear += Mat3::from_cols(scaled * normal.x, scaled * normal.y, scaled * normal.z);
        self.coupling += Mat3::from_cols(turned * normal.x, turned * normal.y, turned * normal.z);
        self.angular += Mat3::from_cols(turned * lever.x, turned * lever.y, turned * lever.z);
    }

    /// The force and torque that answer `motion`.
    pub fn times(&self, motion: &Motion) -> Wrench {
        Wrench {
            force: self.linear * motion.linear + self.coupling.transpose() * motion.angular,
            torque: self.coupling * motion.linear + self.angular * motion.angular,
        }
    }
}

impl Add for Spatial {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            linear: self.linear + other.linear,
            coupling: self.coupling + other.coupling,
            angular: self.angular + other.angular,
        }
    }
}

impl Mul<f32> for Spatial {
    type Output = Self;

    fn mul(self, factor: f32) -> Self {
        Self { linear: self.linear * factor, coupling: self.coupling * factor, angular: self.angular * factor }
    }
}

/// The matrix \[r\] with \[r\] v = r × v.
fn cross_matrix(r: Vec3) -> Mat3 {
    Mat3::from_cols(Vec3::new(0.0, r.z, -r.y), Vec3::new(-r.z, 0.0, r.x), Vec3::new(r.y, -r.x, 0.0))
}
