//! What the water does to a floating body, whichever model of the body says it, and how a body moves by it.
//!
//! * A [`Load`] holds pressure, resistance, added mass and stiffness of a body in a given pose and motion;
//! * [`Load::over_step`] turns them into the constant force and torque of a time step that can never overshoot.

mod lattice;
mod spatial;
mod step;

pub use lattice::SurfaceLattice;
pub use spatial::Spatial;
pub use step::Inertia;

use crate::waves::{GRAVITY, WATER_DENSITY};
use glam::{Mat3, Quat, Vec2, Vec3};
use std::ops::{Add, Mul, Neg, Sub};

/// Where a body is: world from body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// Position of the body frame's origin in the world, in m.
    pub position: Vec3,
    /// Rotation from the body's frame to the world's, of unit length.
    pub rotation: Quat,
}

/// How a body moves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// Velocity of the centre of mass in the world, in m/s.
    pub linear: Vec3,
    /// Angular velocity in the world, in rad/s.
    pub angular: Vec3,
}

/// A body as the water meets it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BodyState {
    /// Where its frame is.
    pub pose: Pose,
    /// Its centre of mass in the world, in m.
    pub centre: Vec3,
    /// How it moves.
    pub motion: Motion,
}

impl BodyState {
    /// Turns directions of the body's frame into the world's.
    pub fn world_from_body(&self) -> Mat3 {
        Mat3::from_quat(self.pose.rotation)
    }

    /// The origin of the body's frame from its centre of mass, in the world, m. What is seen from there is as exact a kilometre from the
    /// world's origin as near it.
    pub fn origin(&self) -> Vec3 {
        self.pose.position - self.centre
    }

    /// How fast water of this velocity passes the point of the body at `arm` (m) from its centre of mass, m/s.
    pub fn passed_by(&self, water: Vec3, arm: Vec3) -> Vec3 {
        water - self.motion.linear - self.motion.angular.cross(arm)
    }
}

/// The water surface above or below a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Surface {
    /// Height η of the surface, in m.
    pub height: f32,
    /// Slope (∂η/∂x, ∂η/∂z) of the surface, without unit.
    pub slope: Vec2,
    /// Velocity of the water, current and waves together, in m/s.
    pub velocity: Vec3,
}

/// A force and a torque about the centre of mass, in the world.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wrench {
    /// Force, in N.
    pub force: Vec3,
    /// Torque about the centre of mass, in N·m.
    pub torque: Vec3,
}

impl Wrench {
    /// Neither force nor torque.
    pub const ZERO: Self = Self { force: Vec3::ZERO, torque: Vec3::ZERO };

    /// Adds `force` (N) acting at `arm` (m) from the centre of mass.
    pub fn add_at(&mut self, force: Vec3, arm: Vec3) {
        self.force += force;
        self.torque += arm.cross(force);
    }

    /// Whether no component is infinite or not a number.
    pub fn is_finite(&self) -> bool {
        self.force.is_finite() && self.torque.is_finite()
    }
}

impl Mul<f32> for Wrench {
    type Output = Self;

    fn mul(self, factor: f32) -> Self {
        Self { force: self.force * factor, torque: self.torque * factor }
    }
}

impl Add for Wrench {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, torque: self.torque + other.torque }
    }
}

impl Neg for Wrench {
    type Output = Self;

    fn neg(self) -> Self {
        Self { force: -self.force, torque: -self.torque }
    }
}

impl Sub for Wrench {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

/// The liquid and the gravity that acts on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fluid {
    /// Density ρ, in kg/m³, positive. Default [`WATER_DENSITY`]; sea water has 1025.
    pub density: f32,
    /// Gravity g, in m/s², not negative. Default [`GRAVITY`].
    pub gravity: f32,
}

impl Default for Fluid {
    fn default() -> Self {
        Self { density: WATER_DENSITY, gravity: GRAVITY }
    }
}

/// What the water does to a body: constant forces, and what depends on the body's motion.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Load {
    /// Pressure of the water at rest around the body: Archimedes' push and its lever.
    pub pressure: Wrench,
    /// Force of the moving water on a body held still.
    pub stream: Wrench,
    /// Resistance to the body's own motion: force per velocity.
    pub resistance: Spatial,
    /// Mass of water that has to be moved with the body; none for models that do not know it.
    pub added_mass: Spatial,
    /// How much of the added mass has come to the body since the step before, 0…1: that water is at rest in the stream, and is set in
    /// motion at once. 0 for a body that rises out of the water.
    pub entering: f32,
    /// Change of the pressure with the body's place: force per displacement; none for models that do not know it.
    pub stiffness: Spatial,
    /// Volume under water, in m³.
    pub submerged_volume: f32,
    /// Area in which the surface cuts the body, in m².
    pub waterplane_area: f32,
    /// Area of the body's surface under water, in m²; 0 for models that do not know it.
    pub wetted_area: f32,
    /// Mean velocity of the water around the submerged part, in m/s.
    pub water_velocity: Vec3,
}
