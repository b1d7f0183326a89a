//! What floating bodies and simulated water do to each other: bodies take up room, and what resists them is pushed along.
//!
//! Before the water is looked up, [`displace`] cuts every hull into columns on the cells of the water that it was in, and puts them in.
//! The surface that a column ends at is the plane through the corners of the body's footprint: it lies outside the body, so that no
//! column feeds on the level that it has raised itself, and waves much shorter than the body leave it as it is. After the forces are
//! known, [`return_forces`] gives the water the opposite of them; that of the pressure it has already got, but for rounding (see
//! [`Displaced`](freshet_hydro::shallow_water::Displaced)).
use super::{body::Body, floating::Floating};
use crate::{
    body::{ResolvedWater, WaterSimulation},
    interaction::BodyMotion,
    simulation::{Raster, Simulated},
};
use bevy::{
    math::{Affine2, Affine3A},
    prelude::*,
};
use bevy_rapier3d::{
    plugin::context::{RapierContextEntityLink, RapierRigidBodySet},
    prelude::RapierRigidBodyHandle,
    rapier::prelude::RigidBody,
};
use freshet_hydro::{
    hull::{ColumnRaster, Columns, Hull, SurfacePlane},
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
    pub water: Option<Entity>,
    columns: Columns,
    /// Cells with the displaced volume per area, m.
    depths: Vec<(UVec2, f32)>,
    /// Share of its columns that the water has made room for.
    share: f32,
    /// Where the body was in which water, and the time of that, s.
    before: Option<(Entity, f64, Vec3)>,
    /// The same, spread as the water has it.
    own: Vec<Displaced>,
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
    /// Cuts the body where the solver has it.
    fn cut(
        &mut self,
        hull: &Hull,
        body: &RigidBody,
        surface: &SurfacePlane,
        water: &ResolvedWater,
        raster: ColumnRaster,
    ) {
        let world_from_body = Affine3A::from_rotation_translation(*body.rotation(), body.translation());
        let from_body = local_from_world(water) * world_from_body;
        self.columns.rasterise(hull, from_body, &local_plane(surface, water), &raster);
    }

    /// Makes room within [`APPEARING`] for a body that is suddenly there, and at once for one that comes from outside: `now` is
    /// the water with its time (s) and the body's place in it, and `way` how far (m) it may have moved.
    fn appear(&mut self, now: (Entity, f64, Vec3), way: f32, dt: f32, cell: f32) {
        let is_dry = self.columns.volume() <= 0.0;
        let goes_on =
            |before: (Entity, f64, Vec3)| before.0 == now.0 && before.1 <= now.1 && before.2.distance(now.2) <= way;
        if !self.before.replace(now).is_some_and(goes_on) {
            self.share = 0.0;
        }
        self.share = if is_dry { 1.0 } else { (self.share + dt / APPEARING).min(1.0) };
        let per_area = self.share / (cell * cell);
        self.depths.clear();
        self.depths.extend(self.columns.cells().map(|(cell, volume)| (cell, volume * per_area)));
    }
}

/// Whether the water's clock runs.
fn runs(settings: &WaterSimulation) -> bool {
    !settings.paused && settings.speed > 0.0
}

/// Whether bodies act on the water.
fn acts(settings: &WaterSimulation) -> bool {
    runs(settings) && settings.push > 0.0
}

/// Puts all bodies into the simulated waters that they are in.
pub(super) fn displace(
    mut bodies: Query<(&RapierRigidBodyHandle, &RapierContextEntityLink, &mut Body, &mut BodyMotion), With<Floating>>,
    contexts: Query<&RapierRigidBodySet>,
    mut waters: Query<(&mut Simulated, &mut ResolvedWater, &WaterSimulation)>,
    time: Res<Time>,
) {
    let mut any = false;
    // Water that stands still keeps the bodies that it has.
    for (mut simulated, ..) in waters.iter_mut().filter(|water| runs(water.2)) {
        any |= simulated.take_bodies_out();
    }
    for (handle, link, mut state, mut motion) in &mut bodies {
        state.exchanging.water = None;
        (motion.exchanges_with, motion.is_resolved) = (None, false);
        let body = contexts.get(link.0).ok().and_then(|set| set.bodies.get(handle.0));
        let Some(body) = body.filter(|body| any && body.is_enabled()) else { continue };
        let Body { form: Some(form), footprint, exchanging, .. } = &mut *state else { continue };
        let (Some(entity), Some(surface)) = (footprint.water, footprint.plane()) else { continue };
        let Ok((mut simulated, water, settings)) = waters.get_mut(entity) else { continue };
        let Some(Raster { origin, cell, size }) = simulated.raster().filter(|_| acts(settings)) else { continue };
        let raster = ColumnRaster { origin, cell, size };
        exchanging.cut(&form.hull, body, &surface, &water, raster);
        let now = (entity, simulated.time(), body.translation());
        let way = cell + 2.0 * time.delta_secs() * body.linvel().length();
        exchanging.appear(now, way, time.delta_secs(), cell);
        exchanging.water = Some(entity);
        motion.exchanges_with = Some(entity);
        motion.is_resolved = form.hull.length() >= RESOLVED * raster.cell;
        let level = local_plane(&surface, &water);
        let mut displacement = std::mem::take(&mut simulated.exchange.displacement);
        let columns = exchanging.depths.iter().copied();
        let own = displacement.add(columns, |cell| simulated.room(cell, |place| level.at(place)));
        exchanging.own.clear();
        exchanging.own.extend_from_slice(own);
        simulated.exchange.displacement = displacement;
    }
    for (mut simulated, mut water, _) in waters.iter_mut().filter(|water| runs(water.2)) {
        simulated.put_bodies_in(&mut water);
    }
}

/// Hands the waters what their bodies feel of them, the other way round.
///
/// The raised bed pushes the water as the scheme sums it, the pressure the body as its hull does: the difference goes to the water, so
/// that what one of them gains the other loses. Not where waves ride on the water, whose pressure has no answer: there up to a tenth of
/// the momentum of the pressure is made or lost.
pub(super) fn return_forces(
    bodies: Query<&Body, (With<Floating>, With<RapierRigidBodyHandle>)>,
    mut waters: Query<(&mut Simulated, &ResolvedWater, &WaterSimulation)>,
    time: Res<Time>,
) {
    for state in &bodies {
        let exchanging = &state.exchanging;
        let (Some(entity), Some(felt)) = (exchanging.water, exchanging.felt) else { continue };
        let Ok((mut simulated, water, settings)) = waters.get_mut(entity) else { continue };
        if !acts(settings) {
            continue;
        }
        let factor = if settings.push.is_finite() { settings.push.clamp(0.0, 10.0) } else { 1.0 };
        let local = |force: Vec3| water.local_from_world.transform_vector2(force.xz());
        // In water that runs faster than its bodies a force acts for longer.
        let per_density = 1.0 / (WATER_DENSITY * settings.speed);
        let mut force = -factor * per_density * local(felt.resistance);
        if water.waves.trains.is_empty() {
            let pressed = -per_density * local(felt.pressure);
            let dt = time.delta_secs_f64() * f64::from(settings.speed);
            force += pressed - simulated.reaction(&exchanging.own, dt);
        }
        simulated.push_back(force, &exchanging.depths);
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
