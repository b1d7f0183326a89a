//! What a game says about a floating body, and what it can read back.

use super::body::Body;
use crate::interaction::DisturbsWater;
use bevy::prelude::*;
use freshet_hydro::hull::HullDrag;

/// A rigid body that floats, sinks, and is carried by the current.
///
/// Beside a dynamic Rapier `RigidBody`. Its hull is the union of the body's colliders (its own and its children's,
/// sensors excepted, of any closed shape, scaled as Rapier scales them), or, without a collider, the closed mesh of
/// its `Mesh3d`, with its sealed cavities. Shapes without an inside (half-spaces, height fields, polylines) are refused with a warning; an open
/// triangle mesh floats as its convex hull, with a warning. Fixed and kinematic bodies are not moved by the water, but
/// take up room in simulated water and push it. The water answers the body's meshes, as it is [`DisturbsWater`] as well.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[require(Buoyancy, Body, DisturbsWater)]
pub struct Floating {
    /// How heavy the body is. Default 500 kg/m³.
    pub weight: Weight,
    /// How the water's push is found. Default [`BuoyancyModel::Hull`].
    pub model: BuoyancyModel,
    /// Most triangles of the hull, 12…20000, default 400. Round shapes have some 300; finer meshes are simplified, with their volume
    /// and centre. Parts that overlap keep theirs.
    pub max_triangles: u32,
    /// Centre of mass in the body's frame, m; that of the homogeneous hull if there is none. Default none. The inertia about it is that of
    /// the homogeneous hull. Not for [`Weight::Rapier`], which has both its own.
    pub center_of_mass: Option<Vec3>,
    /// Whether currents and waves carry the body. Default true; without it the water around the body counts as still.
    pub current: bool,
    /// Factor on skin friction, 0…100, default 1. See [`HullDrag::friction`].
    pub friction: f32,
    /// Pressure coefficient of faces that the water meets squarely, 0…100, default 1.05. See [`HullDrag::bluff`].
    pub bluff_drag: f32,
    /// Pressure coefficient of faces that it passes, 0…100, default 0.72. See [`HullDrag::fair`].
    pub fair_drag: f32,
    /// How soon the body comes to rest at the surface, by the waves that it sends out, 0…10, default 0.67. See [`HullDrag::radiation`].
    pub radiation: f32,
}

/// How the water's push on a [`Floating`] body is found.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Default, Clone, Debug, PartialEq)]
pub enum BuoyancyModel {
    /// Pressure integrated over the hull, cut by the surface triangle by triangle: exact.
    #[default]
    Hull,
    /// Cells along each axis of the bounding box, 1…16, as in \[AT15\] but each with the volume of its part of the hull. Drafts of a
    /// sphere are right within 1 % with 4.
    Voxels {
        /// Cells along each axis.
        per_axis: u32,
    },
    /// Points scattered over the hull, each with the same share of its volume, as in \[S22\].
    Samples {
        /// Least distance between points, m, > 0.
        spacing: f32,
    },
}

/// The mass of a [`Floating`] body.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Clone, Debug, PartialEq)]
pub enum Weight {
    /// Homogeneous, of this density in kg/m³, 1…30000. Water has 998; a body of less floats. That of a hollow body is its mass over all
    /// that it encloses.
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
        let drag = HullDrag::default();
        Self {
            weight: Weight::Density(500.0),
            model: BuoyancyModel::Hull,
            max_triangles: 400,
            center_of_mass: None,
            current: true,
            friction: drag.friction,
            bluff_drag: drag.bluff,
            fair_drag: drag.fair,
            radiation: drag.radiation,
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
