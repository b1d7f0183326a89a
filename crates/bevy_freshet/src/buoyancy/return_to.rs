//! Sensors that put floating bodies back where the river begins.

use super::floating::Floating;
use bevy::{
    math::{Isometry3d, ops},
    prelude::*,
};
use bevy_rapier3d::{
    parry::math::Pose,
    plugin::context::{RapierContextColliders, RapierContextEntityLink, RapierContextSimulation, RapierRigidBodySet},
    prelude::{Collider, RapierRigidBodyHandle, Sensor, TransformInterpolation},
};
use core::f32::consts::TAU;

/// Returns every [`Floating`] body that touches this sensor to a start, at rest: the end of a river that never runs
/// out of boats.
///
/// Beside a Rapier `Collider`, which becomes a `Sensor`. Other bodies pass.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[require(Sensor, Transform)]
pub struct ReturnTo {
    /// Pose in the world in which bodies start again. Default the origin, unturned.
    pub start: Isometry3d,
    /// Radius of the disc around the start on which bodies are spread, m, ≥ 0, default 0. The places repeat after 16
    /// and depend on nothing but how many bodies have returned; choose some four times the size of a body, so that
    /// none starts inside another.
    pub spread: f32,
    /// How many bodies have been returned so far.
    pub returned: u32,
}

impl ReturnTo {
    /// Returns bodies to `position` in the world, m, unturned.
    pub fn new(position: Vec3) -> Self {
        Self { start: Isometry3d::from_translation(position), spread: 0.0, returned: 0 }
    }

    /// Spreads them over a disc of `radius` m.
    pub fn with_spread(self, radius: f32) -> Self {
        Self { spread: radius, ..self }
    }

    /// Pose for the next body. Places lie on Vogel's spiral, in which no two are near each other: the i-th at a
    /// distance ∝ √i and an angle of i golden angles (Vogel, *A better way to construct the sunflower head*, 1979).
    fn next_pose(&mut self) -> Isometry3d {
        const PLACES: u32 = 16;
        const GOLDEN_ANGLE: f32 = TAU * 0.381_966;
        let place = (self.returned % PLACES) as f32;
        self.returned = self.returned.wrapping_add(1);
        let spread = if self.spread.is_finite() { self.spread.max(0.0) } else { 0.0 };
        let radius = spread * ops::sqrt(place / (PLACES - 1) as f32);
        let (sin, cos) = ops::sin_cos(place * GOLDEN_ANGLE);
        let offset = Vec3::new(radius * cos, 0.0, radius * sin);
        Isometry3d::new(Vec3::from(self.start.translation) + offset, self.start.rotation)
    }
}

impl Default for ReturnTo {
    fn default() -> Self {
        Self::new(Vec3::ZERO)
    }
}

/// Moves the bodies that touch a sensor, in the solver; its writeback moves their `Transform`.
pub(super) fn return_bodies(
    mut sensors: Query<(Entity, &mut ReturnTo, &RapierContextEntityLink), With<Collider>>,
    mut contexts: Query<(&RapierContextSimulation, &RapierContextColliders, &mut RapierRigidBodySet)>,
    mut floating: Query<(&RapierRigidBodyHandle, Option<&mut TransformInterpolation>), With<Floating>>,
) {
    for (sensor, mut target, link) in &mut sensors {
        let Ok((simulation, colliders, mut set)) = contexts.get_mut(link.0) else { continue };
        let mut arrived: Vec<Entity> = simulation
            .intersection_pairs_with(colliders, sensor)
            .filter(|(.., touching)| *touching)
            .map(|(a, b, _)| if a == sensor { b } else { a })
            .filter_map(|collider| colliders.collider_parent(&set, collider))
            .collect();
        // A body with several colliders arrives once; the order of the pairs is the solver's own.
        arrived.sort();
        arrived.dedup();
        for entity in arrived {
            let Ok((handle, interpolation)) = floating.get_mut(entity) else { continue };
            let Some(body) = set.bodies.get_mut(handle.0) else { continue };
            let pose = target.next_pose();
            body.set_position(Pose::from_parts(pose.translation.into(), pose.rotation), true);
            body.set_linvel(Vec3::ZERO, true);
            body.set_angvel(Vec3::ZERO, true);
            if let Some(mut interpolation) = interpolation {
                // No streak from the end to the start.
                *interpolation = TransformInterpolation::default();
            }
        }
    }
}
