//! The water around a body, looked up once a step on a lattice over its footprint.

use super::{
    body::Body,
    floating::{BuoyancyModel, Floating},
    solid::bounds,
};
use crate::query::{WaterQuery, WaterSample};
use bevy::prelude::*;
use bevy_rapier3d::{
    plugin::context::{RapierContextEntityLink, RapierRigidBodySet},
    prelude::RapierRigidBodyHandle,
};
use freshet_hydro::{
    load::{Surface, SurfaceLattice},
    waves::WaveField,
};

/// Places along each side of the lattice under a hull: waves longer than 4/3 of it are seen, shorter than 2/3 not.
const PLACES: usize = 4;

/// What is known of the water around a body.
#[derive(Default)]
pub(super) struct Footprint {
    pub lattice: SurfaceLattice,
    /// Waves that the lattice can carry: a body does not feel shorter ones, which push it up here and down there.
    waves: WaveField,
    /// Height of the body's lowest point, m.
    pub lowest: f32,
    /// The water that the body is in or over; none where all is dry.
    pub water: Option<Entity>,
}

/// The surface as the hull wants it, if the sample is sound.
fn surface_of(sample: &WaterSample) -> Option<Surface> {
    let slope = -sample.normal.xz() / sample.normal.y;
    let sound = sample.height.is_finite() && slope.is_finite() && sample.velocity.is_finite();
    sound.then_some(Surface { height: sample.height, slope, velocity: sample.velocity })
}

/// Looks up the water around every floating body, asleep or not: that is how sleepers learn that the water moved.
pub(super) fn sample_water(
    mut bodies: Query<(&Floating, &RapierRigidBodyHandle, &RapierContextEntityLink, &mut Body)>,
    contexts: Query<&RapierRigidBodySet>,
    water: WaterQuery,
) {
    // Bodies do not know of each other here: the order in which threads take them changes nothing.
    bodies.par_iter_mut().for_each(|(floating, handle, link, mut state)| {
        let state = &mut *state;
        let Some(body) = contexts.get(link.0).ok().and_then(|set| set.bodies.get(handle.0)) else { return };
        if state.form.is_none() || !body.is_enabled() {
            return;
        }
        let aabb = bounds(&state.solids, body.position());
        let corners = [aabb.mins.xz(), aabb.maxs.xz()];
        let places = match floating.model {
            BuoyancyModel::Voxels { per_axis } => per_axis.clamp(2, 16) as usize,
            _ => PLACES,
        };
        // Where waters lie above one another the keel under the middle tells which one the body is in: all of it, as far as that reaches, and
        // beyond only what else reaches up to the keel. What lies far below the brim of a pond is not in it.
        let keel = |at: Vec2| vec3(at.x, aabb.mins.y, at.y);
        let mut own = water.water_at(keel(corners[0].midpoint(corners[1])));
        let Footprint { lattice, waves, lowest, .. } = &mut state.footprint;
        *lowest = aabb.mins.y;
        let step = (corners[1] - corners[0]) / (places - 1) as f32;
        let carry = |own: Entity, waves: &mut WaveField| water.waves_carried_by(own, step, waves);
        if let Some(own) = own {
            carry(own, waves);
        }
        lattice.look_up(corners, places, |places, surfaces| {
            let found = own.map_or_else(Default::default, |own| water.samples_of(own, waves, places));
            for ((place, surface), found) in places.iter().zip(surfaces).zip(found) {
                let reaches = |other: &WaterSample| own.is_none() || other.height > aabb.mins.y;
                let found = found.or_else(|| water.sample(keel(*place)).filter(reaches));
                if let (None, Some(found)) = (own, &found) {
                    own = Some(found.water);
                    carry(found.water, waves);
                }
                *surface = found.as_ref().and_then(surface_of).map(|found| Surface {
                    velocity: if floating.current { found.velocity } else { Vec3::ZERO },
                    ..found
                });
            }
        });
        state.footprint.water = own.filter(|_| !state.footprint.lattice.is_dry());
    });
}
