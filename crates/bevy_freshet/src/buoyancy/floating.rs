//! What a game says about a floating body, and what it can read back.

use super::hull::Hull;
use crate::interaction::DisturbsWater;
use bevy::prelude::*;
use freshet_hydro::voxels::Drag;

/// A rigid body that floats, sinks, and is carried by the current.
///
/// Beside a dynamic Rapier `RigidBody`. Its hull is the union of the body's colliders (its own and its children's,
/// sensors excepted, of any closed shape, scaled as Rapier scales them), or, without a collider, the closed mesh of
/// its `Mesh3d`. Shapes without an inside (half-spaces, height fields, polylines) are refused with a warning; an open
/// triangle mesh floats as its convex hull, with a warning. Fixed and kinematic bodies are left alone. The water answers
/// the body's meshes, as it is [`DisturbsWater`] as well.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[require(Buoyancy, Hull, DisturbsWater)]
pub struct Floating {
    /// How heavy the body is. Default 500 kg/m³.
    pub weight: Weight,
    /// Cells along each axis of the hull's bounding box, 1…16, default 4. Drafts of a sphere are then right within 1 %
    /// and the water is looked up at 4 × 4 places; take more for bodies longer than the waves.
    pub cells_per_axis: u32,
    /// How soon the body comes to rest, as a share of critical damping, 0…10, default 0.25: after some three swings.
    /// See [`Drag::damping`].
    pub damping: f32,
    /// Drag coefficient C_d of the body against water that passes it, 0…100, default 0.8. See [`Drag::coefficient`].
    pub drag_coefficient: f32,
}

/// The mass of a [`Floating`] body.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Clone, Debug, PartialEq)]
pub enum Weight {
    /// Homogeneous, of this density in kg/m³, 1…30000. Water has 998; a body of less floats.
    ///
    /// Mass, centre and inertia in the solver become those of the hull: this overrides what the body's colliders
    /// (`ColliderMassProperties`) and `AdditionalMassProperties` say.
    Density(f32),
    /// Homogeneous, of this mass in kg, 10⁻⁶…10¹². Overrides like [`Weight::Density`].
    Mass(f32),
    /// As Rapier has it, from `ColliderMassProperties` and `AdditionalMassProperties`: for hulls with ballast.
    Rapier,
}

impl Floating {
    /// A homogeneous body of `density`, in kg/m³.
    pub fn with_density(density: f32) -> Self {
        Self { weight: Weight::Density(density), ..Self::default() }
    }

    /// A homogeneous body of `mass`, in kg, whatever its volume.
    pub fn with_mass(mass: f32) -> Self {
        Self { weight: Weight::Mass(mass), ..Self::default() }
    }

    /// A body that keeps the mass, centre of mass and inertia that Rapier gives it.
    pub fn with_rapier_mass() -> Self {
        Self { weight: Weight::Rapier, ..Self::default() }
    }
}

impl Default for Floating {
    fn default() -> Self {
        let drag = Drag::default();
        Self {
            weight: Weight::Density(500.0),
            cells_per_axis: 4,
            damping: drag.damping,
            drag_coefficient: drag.coefficient,
        }
    }
}

/// What the water did to a [`Floating`] body in the last step. Read only; stays as it was while the body sleeps.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct Buoyancy {
    /// Volume of the whole hull, m³; 0 until it is built.
    pub volume: f32,
    /// Volume under water, m³.
    pub submerged_volume: f32,
    /// Depth of the body's lowest point below the surface over its centre of mass, m; 0 in the dry.
    pub draft: f32,
    /// Force of the water in the world, N.
    pub force: Vec3,
    /// Torque of the water about the centre of mass in the world, N·m.
    pub torque: Vec3,
    /// Mean velocity of the water around the submerged part, m/s.
    pub water_velocity: Vec3,
}
