//! What floating bodies and simulated water do to each other: bodies take up room, and what resists them is pushed along.
//!
//! Before the water is looked up, [`displace`] cuts every hull into columns on the cells of the water that it was in, and puts them in.
//! The surface that a column ends at is the plane through the corners of the body's footprint: they lie at its rim or outside, so that no
//! column feeds on the level that it has raised itself, and waves much shorter than the body leave it as it is. After the forces are
//! known, [`return_forces`] gives the water the opposite of them; that of the pressure it has already got, but for rounding (see
//! [`Displaced`](freshet_hydro::shallow_water::Displaced)).
use super::{body::Body, floating::Floating};
use crate::{
    body::{ResolvedWater, WaterSimulation},
    interaction::BodyMotion,
    report::Reported,
    simulation::Simulated,
};
use bevy::{
    ecs::query::QueryData,
    math::{Affine2, Affine3A},
    prelude::*,
};
use bevy_rapier3d::{
    plugin::context::{RapierContextEntityLink, RapierRigidBodySet},
    prelude::RapierRigidBodyHandle,
};
use freshet_hydro::{
    grid::Raster,
    hull::{Columns, Hull, SurfacePlane},
    shallow_water::Displaced,
    waves::WATER_DENSITY,
};

/// Time, s, within which a body that appears in the water makes room for itself.
const APPEARING: f32 = 0.25;

/// Cells that a body spans at least for its rings to be those of the simulation.
const RESOLVED: f32 = 4.0;

/// A body's part in the exchange.
#[derive(Default)]
pub(super) struct Exchanging {
    /// The simulated water that it is in.
    water: Option<Entity>,
    columns: Columns,
    /// Cells with the displaced volume per area, m.
    depths: Vec<(UVec2, f32)>,
    /// The same, spread as the water has it.
    own: Vec<Displaced>,
    /// Share of its columns that the water has made room for.
    share: f32,
    before: Option<Whereabouts>,
    /// What the water does to the body; if it sleeps, what it did when it went to sleep.
    pub felt: Option<Exerted>,
}

/// Forces of the water on a body, N.
#[derive(Clone, Copy)]
pub(super) struct Exerted {
    pub pressure: Vec3,
    /// All but the pressure.
    pub resistance: Vec3,
}

/// Where a body is, in which water, and when.
#[derive(Clone, Copy)]
struct Whereabouts {
    water: Entity,
    /// Time that the water has simulated, s.
    time: f64,
    /// World, m.
    place: Vec3,
}

impl Whereabouts {
    /// Whether a body that moves by at most `way` (m) goes on from `before`, in a water that has not begun anew.
    fn follows(&self, before: &Self, way: f32) -> bool {
        before.water == self.water && before.time <= self.time && before.place.distance(self.place) <= way
    }
}

/// Local (x, height over the still level, z) from world.
fn local_from_world(water: &ResolvedWater) -> Affine3A {
    let Affine2 { matrix2: turn, translation } = water.local_from_world;
    let (x, z) = (turn.x_axis, turn.y_axis);
    Affine3A::from_cols(
        vec3(x.x, 0.0, x.y).into(),
        Vec3::Y.into(),
        vec3(z.x, 0.0, z.y).into(),
        vec3(translation.x, -water.level, translation.y).into(),
    )
}

/// A plane of the world, seen from the water.
fn local_plane(plane: &SurfacePlane, water: &ResolvedWater) -> SurfacePlane {
    let origin = water.world_from_local.transform_point2(Vec2::ZERO);
    SurfacePlane {
        height: plane.at(origin) - water.level,
        slope: water.world_from_local.matrix2.transpose() * plane.slope,
    }
}

impl Exchanging {
    /// Cuts the hull, whose pose is `body` in the frame of the water, into columns below `surface`.
    fn cut(&mut self, hull: &Hull, body: Affine3A, surface: &SurfacePlane, raster: &Raster) {
        self.columns.rasterise(hull, body, surface, raster);
        let per_area = 1.0 / (raster.cell * raster.cell);
        self.depths.clear();
        self.depths.extend(self.columns.cells().map(|(cell, volume)| (cell, volume * per_area)));
    }

    /// Leaves of the columns what the water has made room for: within [`APPEARING`] all of a body that is suddenly there, and at once
    /// that of one which comes from outside. The body is `now` there, `dt` (s) later, and may have moved by `way` (m).
    fn appear(&mut self, now: Whereabouts, way: f32, dt: f32) {
        if !self.before.replace(now).is_some_and(|before| now.follows(&before, way)) {
            self.share = 0.0;
        }
        self.share = if self.depths.is_empty() { 1.0 } else { (self.share + dt / APPEARING).min(1.0) };
        self.depths.iter_mut().for_each(|(_, depth)| *depth *= self.share);
    }

    /// Adds what is left of the columns to those of all bodies; `surface` is local.
    fn add_to(&mut self, simulated: &mut Simulated, surface: &SurfacePlane) {
        let mut displacement = std::mem::take(&mut simulated.exchange.displacement);
        let columns = self.depths.iter().copied();
        let own = displacement.add(columns, |cell| simulated.room(cell, |place| surface.at(place)));
        self.own.clear();
        self.own.extend_from_slice(own);
        simulated.exchange.displacement = displacement;
    }
}

/// A water that bodies act on.
#[derive(QueryData)]
#[query_data(mutable)]
pub(super) struct Waters {
    entity: Entity,
    simulated: &'static mut Simulated,
    resolved: &'static mut ResolvedWater,
    settings: &'static WaterSimulation,
}

impl WatersItem<'_, '_> {
    /// Whether the water's clock runs: if it stands still, the water keeps the bodies that it has.
    fn runs(&self, reported: &mut Reported) -> bool {
        !self.settings.paused && self.settings.usable_speed(self.entity, reported) > 0.0
    }

    /// Whether bodies act on it.
    fn is_moved(&self, reported: &mut Reported) -> bool {
        self.runs(reported) && self.settings.usable_push(self.entity, reported) > 0.0
    }
}

/// Puts all bodies into the simulated waters that they are in.
pub(super) fn displace(
    mut bodies: Query<(&RapierRigidBodyHandle, &RapierContextEntityLink, &mut Body, &mut BodyMotion), With<Floating>>,
    contexts: Query<&RapierRigidBodySet>,
    mut waters: Query<Waters>,
    mut reported: ResMut<Reported>,
    time: Res<Time>,
) {
    let mut any = false;
    for mut water in &mut waters {
        any |= water.runs(&mut reported) && water.simulated.take_bodies_out();
    }
    for (handle, link, mut state, mut motion) in &mut bodies {
        state.exchanging.water = None;
        (motion.exchanges_with, motion.is_resolved) = (None, false);
        let body = contexts.get(link.0).ok().and_then(|set| set.bodies.get(handle.0));
        let Some(body) = body.filter(|body| any && body.is_enabled()) else { continue };
        let Body { form: Some(form), footprint, exchanging, .. } = &mut *state else { continue };
        let (Some(entity), Some(surface)) = (footprint.water, footprint.lattice.plane()) else { continue };
        let Some(mut water) = waters.get_mut(entity).ok().filter(|water| water.is_moved(&mut reported)) else {
            continue;
        };
        let Some(raster) = water.simulated.raster() else { continue };
        let (pose, place) =
            (Affine3A::from_rotation_translation(*body.rotation(), body.translation()), body.translation());
        let surface = local_plane(&surface, &water.resolved);
        exchanging.cut(&form.hull, local_from_world(&water.resolved) * pose, &surface, &raster);
        let (dt, now) = (time.delta_secs(), Whereabouts { water: entity, time: water.simulated.time(), place });
        exchanging.appear(now, raster.cell + 2.0 * dt * body.linvel().length(), dt);
        exchanging.add_to(&mut water.simulated, &surface);
        exchanging.water = Some(entity);
        motion.exchanges_with = Some(entity);
        motion.is_resolved = form.hull.length() >= RESOLVED * raster.cell;
    }
    for mut water in &mut waters {
        if water.runs(&mut reported) {
            water.simulated.put_bodies_in(&mut water.resolved);
        }
    }
}

/// Hands the waters what their bodies feel of them, the other way round.
///
/// The raised bed pushes the water as the scheme sums it, the pressure the body as its hull does: the difference goes to the water, so
/// that what one of them gains the other loses. Not where waves ride on the water, whose pressure has no answer: there up to a tenth of
/// the momentum of the pressure is made or lost.
pub(super) fn return_forces(
    bodies: Query<&Body, (With<Floating>, With<RapierRigidBodyHandle>)>,
    mut waters: Query<Waters>,
    mut reported: ResMut<Reported>,
    time: Res<Time>,
) {
    for state in &bodies {
        let exchanging = &state.exchanging;
        let (Some(entity), Some(felt)) = (exchanging.water, exchanging.felt) else { continue };
        let Some(mut water) = waters.get_mut(entity).ok().filter(|water| water.is_moved(&mut reported)) else {
            continue;
        };
        let speed = water.settings.usable_speed(entity, &mut reported);
        let factor = water.settings.usable_push(entity, &mut reported);
        // In water that runs faster than its bodies a force acts for longer.
        let per_density = 1.0 / (WATER_DENSITY * speed);
        let from_world = water.resolved.local_from_world;
        let answer = |force: Vec3| -per_density * from_world.transform_vector2(force.xz());
        let mut force = factor * answer(felt.resistance);
        if water.resolved.waves.trains.is_empty() {
            let dt = time.delta_secs_f64() * f64::from(speed);
            force += answer(felt.pressure) - water.simulated.reaction(&exchanging.own, dt);
        }
        water.simulated.push_back(force, &exchanging.depths);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prelude::*;
    use bevy::{time::TimeUpdateStrategy, transform::TransformPlugin};
    use bevy_rapier3d::prelude::*;
    use std::time::Duration;

    /// Momentum of all bodies along x, and of the water a step later, when it has got what they lost, kg·m/s.
    fn momentum(app: &mut App) -> f32 {
        let mut sets = app.world_mut().query::<&RapierRigidBodySet>();
        let set = sets.single(app.world()).expect("a world");
        let bodies: f32 = set.bodies.iter().map(|(_, body)| body.mass() * body.linvel().x).sum();
        app.update();
        let mut waters = app.world_mut().query::<&Simulated>();
        let water = waters.single(app.world()).expect("a water").momentum();
        WATER_DENSITY * water.x as f32 + bodies
    }

    #[test]
    fn what_a_body_loses_the_water_gains() {
        let step = Duration::from_secs_f64(1.0 / 60.0);
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default()))
            .init_asset::<Mesh>()
            .insert_resource(Time::<Fixed>::from_duration(step))
            .insert_resource(TimeUpdateStrategy::ManualDuration(step))
            .insert_resource(TimestepMode::Fixed { dt: 1.0 / 60.0, substeps: 1 })
            .add_plugins((RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule(), WaterPlugin));
        app.finish();
        app.cleanup();
        let settings = WaterSimulation { cell_size: 0.25, manning: 0.0, ..default() };
        app.world_mut().spawn((Water::new(Vec2::splat(40.0)), WaterWaves::still(), settings));
        let body = (
            bevy_rapier3d::prelude::RigidBody::Dynamic,
            Collider::cuboid(1.0, 0.4, 0.8),
            Floating::with_density(500.0),
            Velocity::zero(),
            Transform::default(),
        );
        let body = app.world_mut().spawn(body).id();
        (0..600).for_each(|_| app.update());
        let before = momentum(&mut app);
        let given = 1.5 * 500.0 * 2.0 * 0.8 * 1.6;
        app.world_mut().get_mut::<Velocity>(body).expect("a body").linear.x = 1.5;
        for second in 1..=3 {
            (0..60).for_each(|_| app.update());
            let gone = 1.0 - (momentum(&mut app) - before) / given;
            let left = app.world().get::<Velocity>(body).expect("a body").linear.x / 1.5;
            println!("after {second} s the body has {left:.3} of its momentum, and {gone:.4} is gone");
            assert!(left < 0.6 && gone.abs() < 1e-3);
        }
    }
}
