//! Entities whose meshes disturb the water, and how they move.
use bevy::{math::Affine3A, prelude::*};

/// Lets the meshes of an entity and its descendants disturb the water: ships and crates, but also piers and the blades
/// of a stirrer.
///
/// Beside the `Transform` of the entity; [`Floating`](crate::buoyancy::Floating) (feature `rapier`) brings it along. The
/// meshes should be closed and keep their data in the main world (`RenderAssetUsages::default()`). All of them move as
/// one: a part that turns by itself, such as a paddle wheel, gets a `DisturbsWater` of its own. A moving `Transform` is
/// enough, no physics is needed.
///
/// Remove it from a body that shall leave no trace; one that floats in simulated water still takes up room in it.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[require(Transform, BodyMotion)]
pub struct DisturbsWater;

/// Faster motion, m/s, or rad/s, is a teleport and counts as none.
const TELEPORT: f32 = 50.0;

/// Time, s, over which velocities are averaged. Bodies move in the steps of physics, of which a frame may have none or two.
const SMOOTHING: f32 = 0.05;

/// Velocity of a body: at its origin and its change in space, which holds rotation and change of scale alike.
#[derive(Component, Clone, Debug)]
pub(crate) struct BodyMotion {
    last: Option<Affine3A>,
    velocity: Vec3,
    /// ∂v/∂x, 1/s.
    gradient: Mat3,
    /// The water that the body is cut by, and the local centroid (xz, m) of the section.
    pub section: Option<(Entity, Vec2)>,
    /// The simulated water that the body exchanges volume and momentum with by its hull.
    pub exchanges_with: Option<Entity>,
    /// Whether that water's cells are so fine that its rings are theirs.
    pub is_resolved: bool,
}

impl Default for BodyMotion {
    fn default() -> Self {
        Self {
            last: None,
            velocity: Vec3::ZERO,
            gradient: Mat3::ZERO,
            section: None,
            exchanges_with: None,
            is_resolved: false,
        }
    }
}

impl BodyMotion {
    /// World velocity, m/s, of the body at world `point`.
    pub fn at(&self, point: Vec3) -> Vec3 {
        let origin = self.last.map_or(point, |pose| pose.translation.into());
        self.velocity + self.gradient * (point - origin)
    }

    /// Goes to `pose` within `dt` seconds.
    fn move_to(&mut self, pose: Affine3A, dt: f32) {
        let last = self.last.replace(pose);
        if dt <= 0.0 {
            return;
        }
        // With x' = A x the point that is at x' was at A_last A⁻¹ x', so it moved by (1 − A_last A⁻¹) x'.
        let (velocity, gradient) = last.map_or((Vec3::ZERO, Mat3::ZERO), |last| {
            let velocity = Vec3::from(pose.translation - last.translation) / dt;
            let gradient = (Mat3::IDENTITY - Mat3::from(last.matrix3 * pose.matrix3.inverse())) * (1.0 / dt);
            (velocity, gradient)
        });
        let fastest = gradient.to_cols_array().into_iter().fold(velocity.length(), |a, b| a.max(b.abs()));
        // What is not a number is a teleport too.
        let (velocity, gradient) = if fastest < TELEPORT && velocity.is_finite() && gradient.is_finite() {
            (velocity, gradient)
        } else {
            (self.velocity, self.gradient) = (Vec3::ZERO, Mat3::ZERO);
            (Vec3::ZERO, Mat3::ZERO)
        };
        let share = 1.0 - ops::exp(-dt / SMOOTHING);
        self.velocity += (velocity - self.velocity) * share;
        self.gradient += (gradient - self.gradient) * share;
    }
}

/// Follows the poses of all bodies.
pub(super) fn track_motion(time: Res<Time>, mut bodies: Query<(&GlobalTransform, &mut BodyMotion)>) {
    for (pose, mut motion) in &mut bodies {
        motion.move_to(pose.affine(), time.delta_secs());
    }
}
