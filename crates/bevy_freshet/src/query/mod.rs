//! Heights, normals, velocities and depths of the water for physics and gameplay.
mod heights;
mod raycast;
mod swim;

pub use raycast::WaterHit;
pub use swim::Submersion;

use crate::body::ResolvedWater;
use bevy::{ecs::system::SystemParam, prelude::*};
use freshet_hydro::waves::{Particle, WaveField};

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
    /// highest one below it: a swimmer in the lake under a hanging pond is in the lake. A water whose bed lies more than half a metre above
    /// the position counts only where there is no other: whoever falls from under the pond falls into the lake. A water without a
    /// bed has no bottom.
    pub fn sample(&self, position: Vec3) -> Option<WaterSample> {
        let place = [position.xz()];
        let samples =
            self.waters.iter().filter_map(|(entity, water)| samples(entity, water, &water.waves, &place)[0].take());
        samples.min_by(|a, b| {
            let ((a_rank, a_distance), (b_rank, b_distance)) = (rank(a, position.y), rank(b, position.y));
            a_rank.cmp(&b_rank).then(a_distance.total_cmp(&b_distance)).then(a.water.cmp(&b.water))
        })
    }

    /// The water that [`WaterQuery::sample`] finds; where there is but one, whether it is dry there or not.
    #[cfg(feature = "rapier")]
    pub(crate) fn water_at(&self, position: Vec3) -> Option<Entity> {
        let covers = |water: &ResolvedWater| water.covers(water.local_from_world.transform_point2(position.xz()));
        let mut around = self.waters.iter().filter(|(_, water)| covers(water));
        let first = around.next()?;
        match around.next() {
            None => Some(first.0),
            Some(_) => self.sample(position).map(|sample| sample.water),
        }
    }

    /// The waves of `water` that a lattice of these steps along the world's x and z (m) can carry.
    #[cfg(feature = "rapier")]
    pub(crate) fn waves_carried_by(&self, water: Entity, step: Vec2, carried: &mut WaveField) {
        if let Ok((_, water)) = self.waters.get(water) {
            let steps = [vec2(step.x, 0.0), vec2(0.0, step.y)];
            water.waves.carried_by(steps.map(|step| water.local_from_world.transform_vector2(step)), carried);
        }
    }

    /// The `water` with these of its `waves` at up to [`AT_ONCE`] places of the world (xz, m), where it is there.
    #[cfg(feature = "rapier")]
    pub(crate) fn samples_of(&self, water: Entity, waves: &WaveField, places: &[Vec2]) -> Samples {
        let Ok((entity, water)) = self.waters.get(water) else { return default() };
        samples(entity, water, waves, places)
    }
}

/// How many places are looked up at the cost of little more than one.
pub(crate) const AT_ONCE: usize = WaveField::AT_ONCE;

/// The water at several places.
pub(crate) type Samples = [Option<WaterSample>; AT_ONCE];

/// Thickness of the ground that belongs to the water over it, m: bodies sink in a little, and beds are coarser than terrain.
const GROUND: f32 = 0.5;

/// How near a water is to a position at `height`, among all at its place: first whether it is in the water, over it or under its bed,
/// then the distance to its surface, m.
fn rank(sample: &WaterSample, height: f32) -> (u8, f32) {
    let above = sample.height - height;
    let rank = match above {
        ..0.0 => 1,
        _ if above - sample.depth > GROUND => 2,
        _ => 0,
    };
    (rank, above.abs())
}

/// The surface of a water at a place.
struct Found {
    /// The particle of its waves that is there now.
    particle: Particle,
    /// Height over the still water's, m.
    elevation: f32,
    /// Depth of the column, m.
    depth: f32,
}

/// The surface of `water` with these `waves` at up to [`AT_ONCE`] local `places` of its rectangle, where that is not dry.
fn find(water: &ResolvedWater, waves: &WaveField, places: &[Vec2]) -> [Option<Found>; AT_ONCE] {
    let particles = water.particles_of(waves, places);
    std::array::from_fn(|index| {
        let (place, particle) = (*places.get(index)?, particles[index]);
        let elevation = water.elevation(&particle);
        let depth = water.ground_depth(place) + elevation;
        (depth > 0.0).then_some(Found { particle, elevation, depth })
    })
}

/// `water` with these `waves` at up to [`AT_ONCE`] places of the world (xz, m), where it is there.
fn samples(entity: Entity, water: &ResolvedWater, waves: &WaveField, places: &[Vec2]) -> Samples {
    let mut local = [Vec2::ZERO; AT_ONCE];
    let local = &mut local[..places.len()];
    local.iter_mut().zip(places).for_each(|(local, place)| *local = water.local_from_world.transform_point2(*place));
    if !local.iter().any(|place| water.covers(*place)) {
        return default();
    }
    let found = find(water, waves, local);
    let mut samples = Samples::default();
    for ((sample, found), place) in samples.iter_mut().zip(found).zip(local) {
        *sample = found.filter(|_| water.covers(*place)).map(|found| sample_of(entity, water, *place, &found));
    }
    samples
}

/// What is known of `water` at local `place`.
fn sample_of(entity: Entity, water: &ResolvedWater, place: Vec2, found: &Found) -> WaterSample {
    let Found { particle, elevation, depth } = found;
    let current = water.current(place);
    let flowing = water.simulated_at(particle.rest).unwrap_or_default();
    // The surface of flowing water moves with it: w = ∂η/∂t + u·∇η.
    let rises = flowing.rising + current.dot(flowing.slope);
    let velocity = vec3(current.x, rises, current.y) + particle.velocity;
    let tilted = particle.normal - vec3(flowing.slope.x, 0.0, flowing.slope.y) * particle.normal.y;
    WaterSample {
        water: entity,
        height: water.level + elevation,
        normal: water.direction_to_world(tilted.normalize()),
        velocity: water.direction_to_world(velocity),
        depth: *depth,
        ice: water.ice_thickness(place),
        age: water.simulated.as_ref().map_or(0.0, |simulated| simulated.age),
    }
}
