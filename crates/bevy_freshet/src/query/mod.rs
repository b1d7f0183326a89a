//! Heights, normals, velocities and depths of the water for physics and gameplay.
mod raycast;

pub use raycast::WaterHit;

use crate::body::ResolvedWater;
use bevy::{ecs::system::SystemParam, prelude::*};

/// The water at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaterSample {
    /// The entity with the [`Water`](crate::body::Water).
    pub water: Entity,
    /// World height of the surface, m.
    pub height: f32,
    /// Upward unit normal of the surface.
    pub normal: Vec3,
    /// Velocity of the water at the surface, m/s: current and waves.
    pub velocity: Vec3,
    /// Depth of the water column, m, > 0; infinite without a bed.
    pub depth: f32,
    /// Thickness of the ice, m; 0 on open water.
    pub ice: f32,
    /// How long ago the state was simulated from which this was carried on, s; 0 if the water is not simulated.
    pub age: f32,
}

/// Answers where the water is: the same surface that is drawn, at the clock of the schedule that asks (the fixed clock
/// in `FixedUpdate`, the virtual clock in `Update`).
///
/// Costs one Gerstner sum per iteration of the search for the particle above a place.
#[derive(SystemParam)]
pub struct WaterQuery<'w, 's> {
    waters: Query<'w, 's, (Entity, &'static ResolvedWater)>,
}

impl WaterQuery<'_, '_> {
    /// The water at `position` (world, m): `None` outside all waters and on dry land.
    ///
    /// Where several waters lie above one another it is the lowest one whose surface is above the position, else the
    /// highest one below it: a swimmer in the lake under a hanging pond is in the lake.
    pub fn sample(&self, position: Vec3) -> Option<WaterSample> {
        self.waters.iter().filter_map(|(entity, water)| sample(entity, water, position.xz())).min_by(|a, b| {
            let rank = |sample: &WaterSample| {
                let above = sample.height - position.y;
                (above < 0.0, above.abs())
            };
            let ((a_below, a_distance), (b_below, b_distance)) = (rank(a), rank(b));
            a_below.cmp(&b_below).then(a_distance.total_cmp(&b_distance)).then(a.water.cmp(&b.water))
        })
    }
}

/// `water` at world xz, if it is there.
fn sample(entity: Entity, water: &ResolvedWater, place: Vec2) -> Option<WaterSample> {
    let local = water.local_from_world.transform_point2(place);
    if !water.covers(local) {
        return None;
    }
    let (rest, elevation) = water.surface(local);
    let fade = water.fade(rest);
    let height = water.level + elevation;
    let depth = water.ground_depth(local) + elevation;
    if depth <= 0.0 {
        return None;
    }
    let to_world = |v: Vec3| {
        let turned = water.world_from_local.transform_vector2(v.xz());
        vec3(turned.x, v.y, turned.y)
    };
    let current = water.current(local);
    let flowing = water.simulated_at(rest).unwrap_or_default();
    // The surface of flowing water moves with it: w = ∂η/∂t + u·∇η.
    let rises = flowing.rising + current.dot(flowing.slope);
    let velocity = vec3(current.x, rises, current.y) + water.waves.velocity(rest, fade);
    let normal = water.waves.normal(rest, fade);
    let tilted = normal - vec3(flowing.slope.x, 0.0, flowing.slope.y) * normal.y;
    Some(WaterSample {
        water: entity,
        height,
        normal: to_world(tilted.normalize()),
        velocity: to_world(velocity),
        depth,
        ice: water.ice_thickness(local),
        age: water.simulated.as_ref().map_or(0.0, |simulated| simulated.age),
    })
}
