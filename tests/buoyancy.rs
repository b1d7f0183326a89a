//! Floating bodies in Rapier against Archimedes: drafts, drift, sleep, and what a game may do to them.

use bevy::{prelude::*, time::TimeUpdateStrategy, transform::TransformPlugin};
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use core::{f32::consts::PI, time::Duration};
use freshet_hydro::waves::WATER_DENSITY;

/// Steps per second.
pub const RATE: f32 = 60.0;

/// Level of the water, m: not the origin's, so that a forgotten level shows.
pub const LEVEL: f32 = 3.0;

/// An app that only floats bodies, 60 fixed steps of physics a second, one an update.
pub fn app() -> App {
    let step = Duration::from_secs_f32(1.0 / RATE);
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default()))
        .init_asset::<Mesh>()
        .insert_resource(TimestepMode::Fixed { dt: 1.0 / RATE, substeps: 1 })
        .insert_resource(Time::<Fixed>::from_duration(step))
        .insert_resource(TimeUpdateStrategy::ManualDuration(step))
        .add_plugins((RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule(), WaterPlugin));
    app.finish();
    app.cleanup();
    app.update();
    app
}

/// An app with still, deep water at [`LEVEL`].
pub fn still_water() -> (App, Entity) {
    let mut app = app();
    let water = (Water::new(Vec2::splat(1000.0)), WaterWaves::still(), Transform::from_xyz(0.0, LEVEL, 0.0));
    let water = app.world_mut().spawn(water).id();
    (app, water)
}

pub fn run(app: &mut App, seconds: f32) {
    for _ in 0..(seconds * RATE) as u32 {
        app.update();
    }
}

/// A dynamic body let go with its origin `above` the water.
pub fn body(collider: Collider, floating: Floating, above: f32) -> impl Bundle {
    (RigidBody::Dynamic, collider, floating, Velocity::zero(), Transform::from_xyz(0.0, LEVEL + above, 0.0))
}

pub fn read<T: Component + Clone>(app: &App, entity: Entity) -> T {
    app.world().get::<T>(entity).unwrap().clone()
}

/// Lets the solver's body of `entity` be looked at.
pub fn solver_body<T>(
    app: &mut App,
    entity: Entity,
    look: impl FnOnce(&bevy_rapier3d::rapier::prelude::RigidBody) -> T,
) -> T {
    let handle = app.world().get::<RapierRigidBodyHandle>(entity).unwrap().0;
    let set = app.world_mut().query::<&RapierRigidBodySet>().single(app.world()).unwrap();
    look(set.bodies.get(handle).unwrap())
}

pub fn is_asleep(app: &mut App, entity: Entity) -> bool {
    solver_body(app, entity, |body| body.is_sleeping())
}

pub fn assert_near(found: f32, exact: f32, share: f32, what: &str) {
    assert!((found - exact).abs() <= share * exact.abs(), "{what}: {found} instead of {exact}");
}

/// Draft of a sphere of `radius` and relative density `s`.
pub fn sphere_draft(radius: f32, s: f32) -> f32 {
    radius * (1.0 + 2.0 * (((1.0 - 2.0 * s).acos() + 4.0 * PI) / 3.0).cos())
}

#[test]
fn spheres_rest_at_their_draft() {
    for density in [250.0, 500.0, 750.0] {
        let (mut app, _) = still_water();
        let sphere = app.world_mut().spawn(body(Collider::ball(0.5), Floating::with_density(density), 0.8)).id();
        run(&mut app, 60.0);
        let exact = sphere_draft(0.5, density / WATER_DENSITY);
        let draft = LEVEL - (read::<Transform>(&app, sphere).translation.y - 0.5);
        let speed = read::<Velocity>(&app, sphere).linear;
        println!("sphere {density}: draft {draft} m, exact {exact} m, velocity {speed} m/s");
        assert_near(draft, exact, 0.005, "draft");
        assert_near(read::<Buoyancy>(&app, sphere).draft, draft, 1e-3, "reported draft");
        assert!(speed.length() < 1e-3);
    }
}

#[test]
fn upright_cubes_rest_at_their_draft() {
    for density in [250.0, 500.0, 750.0] {
        let (mut app, _) = still_water();
        let cube = body(Collider::cuboid(0.5, 0.5, 0.5), Floating::with_density(density), 0.8);
        let cube = app.world_mut().spawn((cube, LockedAxes::ROTATION_LOCKED)).id();
        run(&mut app, 60.0);
        let draft = LEVEL - (read::<Transform>(&app, cube).translation.y - 0.5);
        println!("cube {density}: draft {draft} m, exact {} m", density / WATER_DENSITY);
        assert_near(draft, density / WATER_DENSITY, 0.005, "draft");
    }
}

/// A cube of half density is unstable upright: it tips, and still displaces its own mass.
#[test]
fn a_free_cube_tips_over_and_displaces_its_mass() {
    let (mut app, _) = still_water();
    let cube = body(Collider::cuboid(0.5, 0.5, 0.5), Floating::with_density(500.0), 0.2);
    let cube = app.world_mut().spawn(cube).id();
    app.world_mut().get_mut::<Transform>(cube).unwrap().rotation = Quat::from_rotation_z(0.05);
    run(&mut app, 40.0);
    let up = read::<Transform>(&app, cube).rotation.inverse() * Vec3::Y;
    let tilt = up.abs().max_element().acos().to_degrees();
    let submerged = read::<Buoyancy>(&app, cube).submerged_volume;
    println!("free cube: tilt {tilt}°, submerged {submerged} m³");
    assert!(tilt > 20.0, "still upright: {tilt}°");
    assert_near(submerged, 500.0 / WATER_DENSITY, 0.01, "submerged volume");
}

/// Speed after 20 s in a stream of 1 m/s, and the highest on the way.
fn drift(half: f32, density: f32, axes: LockedAxes) -> (f32, f32) {
    let (mut app, water) = still_water();
    app.world_mut().entity_mut(water).insert(WaterFlow::uniform(Vec2::X));
    let cube = body(Collider::cuboid(half, half, half), Floating::with_density(density), 0.0);
    let cube = app.world_mut().spawn((cube, axes)).id();
    let mut highest = 0.0_f32;
    for _ in 0..(60.0 * RATE) as u32 {
        app.update();
        highest = highest.max(read::<Velocity>(&app, cube).linear.x);
    }
    (read::<Velocity>(&app, cube).linear.x, highest)
}

/// A cube that cannot roll never outruns the stream. A free one tips over on its way, and its centre swings by less
/// than 10 %.
#[test]
fn a_stream_carries_bodies_at_its_speed() {
    for (half, density) in [(0.5, 500.0), (0.05, 100.0), (1.0, 900.0), (0.01, 20.0)] {
        for (axes, limit) in [(LockedAxes::ROTATION_LOCKED, 1.0001), (LockedAxes::empty(), 1.1)] {
            let (speed, highest) = drift(half, density, axes);
            println!("cube of {} m, {density} kg/m³, {axes:?}: {speed} m/s, at most {highest} m/s", 2.0 * half);
            assert_near(speed, 1.0, 0.05, "speed");
            assert!(highest < limit, "overshoot: {highest}");
        }
    }
}

/// Slower than Rapier's own threshold for sleep: it must not freeze in the current.
#[test]
fn a_slow_current_carries_too() {
    let (mut app, water) = still_water();
    app.world_mut().entity_mut(water).insert(WaterFlow::uniform(Vec2::new(0.0, 0.03)));
    let body = app.world_mut().spawn(body(Collider::ball(0.2), Floating::default(), 0.0)).id();
    run(&mut app, 30.0);
    assert_near(read::<Velocity>(&app, body).linear.z, 0.03, 0.1, "speed");
}

#[test]
fn without_water_a_body_falls() {
    let (mut app, water) = still_water();
    let ball = app.world_mut().spawn(body(Collider::ball(0.5), Floating::default(), 0.0)).id();
    run(&mut app, 10.0);
    assert!(is_asleep(&mut app, ball));
    app.world_mut().despawn(water);
    run(&mut app, 1.0);
    assert_near(read::<Velocity>(&app, ball).linear.y, -9.81, 0.05, "speed after a second");
    assert_eq!(read::<Buoyancy>(&app, ball).force, Vec3::ZERO);
}

#[test]
fn removing_floating_ends_the_force() {
    let (mut app, _) = still_water();
    let ball = app.world_mut().spawn(body(Collider::ball(0.5), Floating::default(), 0.3)).id();
    run(&mut app, 1.0);
    app.world_mut().entity_mut(ball).remove::<Floating>();
    run(&mut app, 0.1);
    let before = read::<Velocity>(&app, ball).linear.y;
    run(&mut app, 0.5);
    assert_near(read::<Velocity>(&app, ball).linear.y - before, -4.905, 0.01, "fall");
}

/// The game's force keeps its value and has its full effect: the drift settles where drag equals it.
#[test]
fn a_games_own_force_is_untouched() {
    let (mut app, _) = still_water();
    let own = ExternalForce { force: Vec3::new(40.0, 0.0, 0.0), torque: Vec3::ZERO };
    let ball = app
        .world_mut()
        .spawn((body(Collider::ball(0.5), Floating::default(), 0.0), own, LockedAxes::ROTATION_LOCKED))
        .id();
    run(&mut app, 30.0);
    assert_eq!(read::<ExternalForce>(&app, ball), own);
    assert_eq!(solver_body(&mut app, ball, |body| body.user_force()), own.force);
    let drag = read::<Buoyancy>(&app, ball).force.x;
    assert_near(drag, -40.0, 0.01, "drag");
    let drifting = read::<Velocity>(&app, ball).linear.x;
    assert!(drifting > 0.05);

    let before = read::<Transform>(&app, ball).translation.x;
    app.world_mut().get_mut::<ExternalForce>(ball).unwrap().force = Vec3::ZERO;
    run(&mut app, 20.0);
    assert!(read::<Velocity>(&app, ball).linear.x.abs() < 0.1 * drifting);
    assert!(read::<Transform>(&app, ball).translation.x > before);
}

#[test]
fn bodies_sleep_in_still_water_and_wake_with_it() {
    let (mut app, water) = still_water();
    let ball = app.world_mut().spawn(body(Collider::ball(0.3), Floating::default(), 0.2)).id();
    run(&mut app, 30.0);
    assert!(is_asleep(&mut app, ball));
    let rest = read::<Transform>(&app, ball);
    run(&mut app, 5.0);
    assert!(is_asleep(&mut app, ball));
    assert_eq!(read::<Transform>(&app, ball), rest);

    app.world_mut().entity_mut(water).insert(WaterFlow::uniform(Vec2::new(0.5, 0.0)));
    run(&mut app, 10.0);
    assert!(!is_asleep(&mut app, ball));
    assert_near(read::<Velocity>(&app, ball).linear.x, 0.5, 0.05, "speed");

    app.world_mut().entity_mut(water).remove::<WaterFlow>();
    run(&mut app, 120.0);
    assert!(is_asleep(&mut app, ball), "{:?}", read::<Velocity>(&app, ball));
    app.world_mut().get_mut::<Transform>(water).unwrap().translation.y += 0.5;
    run(&mut app, 30.0);
    let raised = read::<Transform>(&app, ball).translation.y - rest.translation.y;
    assert_near(raised, 0.5, 0.01, "rise");
}

/// A unit sphere scaled by its entity, by its parent, and made as large as that, all float alike.
#[test]
fn scaled_and_parented_bodies_float_alike() {
    let (mut app, _) = still_water();
    let floating = Floating::with_density(300.0);
    let plain = app.world_mut().spawn(body(Collider::ball(0.5), floating, 0.0)).id();
    let scaled = app.world_mut().spawn(body(Collider::ball(1.0), floating, 0.0)).id();
    *app.world_mut().get_mut::<Transform>(scaled).unwrap() =
        Transform::from_xyz(10.0, LEVEL, 0.0).with_scale(Vec3::splat(0.5));
    let parent = app.world_mut().spawn(Transform::from_xyz(-10.0, 1.0, 0.0).with_scale(Vec3::splat(0.5))).id();
    let child = app.world_mut().spawn((body(Collider::ball(1.0), floating, 0.0), ChildOf(parent))).id();
    run(&mut app, 20.0);
    let [plain, scaled, child] = [plain, scaled, child].map(|entity| {
        let volume = read::<Buoyancy>(&app, entity).volume;
        assert_near(volume, 4.0 / 3.0 * PI * 0.125, 1e-3, "volume");
        read::<GlobalTransform>(&app, entity).translation().y
    });
    assert_near(LEVEL - plain + 0.5, sphere_draft(0.5, 300.0 / WATER_DENSITY), 0.05, "draft");
    assert!((scaled - plain).abs() < 1e-3 && (child - plain).abs() < 2e-3, "{plain} {scaled} {child}");
}

/// No settings, shapes or scales make a panic or a number that is none.
#[test]
fn bad_input_is_survived() {
    let (mut app, _) = still_water();
    crate::said::run_on_this_thread(&mut app);
    let mut bodies = Vec::new();
    for density in [0.0, -1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MIN_POSITIVE] {
        let ball = || Collider::ball(0.3);
        bodies.push(app.world_mut().spawn(body(ball(), Floating::with_density(density), 0.0)).id());
        bodies.push(app.world_mut().spawn(body(ball(), Floating::with_mass(density), 0.0)).id());
        for model in
            [BuoyancyModel::Hull, BuoyancyModel::Voxels { per_axis: 0 }, BuoyancyModel::Samples { spacing: density }]
        {
            let [friction, bluff_drag, fair_drag, radiation] = [density; 4];
            let center_of_mass = Some(Vec3::splat(density));
            let drags = Floating { friction, bluff_drag, fair_drag, radiation, ..default() };
            let odd = Floating { model, max_triangles: 0, center_of_mass, ..drags };
            bodies.push(app.world_mut().spawn(body(ball(), odd, 0.0)).id());
        }
    }
    for scale in [Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0), Vec3::splat(1e-6), Vec3::new(-1.0, 1.0, 1.0)] {
        let cube = app.world_mut().spawn(body(Collider::cuboid(0.5, 0.5, 0.5), Floating::default(), 0.0)).id();
        app.world_mut().get_mut::<Transform>(cube).unwrap().scale = scale;
        bodies.push(cube);
    }
    let flat = Collider::trimesh(vec![Vec3::ZERO, Vec3::X, Vec3::Z], vec![[0, 1, 2]]).unwrap();
    for shape in [Collider::halfspace(Vec3::Y).unwrap(), flat] {
        let entity = app.world_mut().spawn(body(shape, Floating::default(), 50.0)).id();
        app.world_mut().entity_mut(entity).insert(CollisionGroups::new(Group::NONE, Group::NONE));
        bodies.push(entity);
    }
    bodies.push(app.world_mut().spawn((RigidBody::Dynamic, Floating::default(), Transform::default())).id());
    let weightless = body(Collider::ball(0.3), Floating::with_rapier_mass(), 0.0);
    bodies.push(app.world_mut().spawn((weightless, ColliderMassProperties::Density(0.0))).id());
    for entity in bodies.clone() {
        app.world_mut().entity_mut(entity).insert(CollisionGroups::new(Group::NONE, Group::NONE));
    }
    run(&mut app, 5.0);
    for entity in bodies {
        assert!(read::<Transform>(&app, entity).translation.is_finite());
        assert!(read::<Buoyancy>(&app, entity).force.is_finite());
    }
}

/// Fixed and kinematic bodies stay where they are, and one that turns dynamic begins to float.
#[test]
fn only_dynamic_bodies_float() {
    let (mut app, _) = still_water();
    let [fixed, kinematic] = [RigidBody::Fixed, RigidBody::KinematicVelocityBased].map(|kind| {
        let entity = app.world_mut().spawn(body(Collider::ball(0.2), Floating::default(), -1.0)).id();
        app.world_mut().entity_mut(entity).insert((kind, CollisionGroups::new(Group::NONE, Group::NONE)));
        entity
    });
    run(&mut app, 2.0);
    assert_eq!(read::<Transform>(&app, fixed).translation.y, LEVEL - 1.0);
    assert_eq!(read::<Transform>(&app, kinematic).translation.y, LEVEL - 1.0);
    app.world_mut().entity_mut(fixed).insert(RigidBody::Dynamic);
    run(&mut app, 20.0);
    assert_near(read::<Transform>(&app, fixed).translation.y, LEVEL, 0.01, "height");
}

#[test]
fn fifty_bodies_come_and_go_every_frame() {
    let (mut app, _) = still_water();
    let mut bodies = Vec::<Entity>::new();
    for frame in 0..120 {
        for entity in bodies.drain(..) {
            app.world_mut().despawn(entity);
        }
        for i in 0..50 {
            let at = Vec3::new((i % 10) as f32, LEVEL, (i / 10) as f32 + 0.01 * frame as f32);
            let bundle =
                (RigidBody::Dynamic, Collider::ball(0.2), Floating::default(), Transform::from_translation(at));
            bodies.push(app.world_mut().spawn(bundle).id());
        }
        app.update();
    }
    assert_eq!(app.world_mut().query::<&Floating>().iter(app.world()).count(), 50);
    let set = app.world_mut().query::<&RapierRigidBodySet>().single(app.world()).unwrap();
    assert_eq!(set.bodies.len(), 50);
}

#[test]
fn sensors_return_bodies_to_the_start() {
    let (mut app, water) = still_water();
    app.world_mut().entity_mut(water).insert(WaterFlow::uniform(Vec2::X));
    let start = Vec3::new(-5.0, LEVEL + 0.5, 2.0);
    let gate =
        (Collider::cuboid(0.5, 5.0, 50.0), ReturnTo::new(start).with_spread(1.0), Transform::from_xyz(5.0, LEVEL, 0.0));
    let gate = app.world_mut().spawn(gate).id();
    let ball = app.world_mut().spawn(body(Collider::ball(0.3), Floating::default(), 0.0)).id();
    let stone =
        app.world_mut().spawn((RigidBody::Dynamic, Collider::ball(0.1), Transform::from_xyz(5.0, LEVEL, 9.0))).id();
    let mut furthest = f32::NEG_INFINITY;
    for _ in 0..(60.0 * RATE) as u32 {
        app.update();
        furthest = furthest.max(read::<Transform>(&app, ball).translation.x);
    }
    let returned = read::<ReturnTo>(&app, gate).returned;
    println!("{returned} returns, at most x = {furthest} m");
    assert!((4..=8).contains(&returned));
    assert!(furthest < 4.8);
    assert!(read::<Transform>(&app, stone).translation.y < -100.0, "what does not float passes");
}

/// Positions, bit for bit, of bodies in a stream after ten seconds.
fn trace() -> Vec<[u32; 3]> {
    let (mut app, water) = still_water();
    app.world_mut().entity_mut(water).insert((WaterFlow::uniform(Vec2::new(0.7, 0.2)), WaterWaves::default()));
    let bodies: Vec<Entity> = (0..12)
        .map(|i| {
            let collider = if i % 2 == 0 { Collider::ball(0.3) } else { Collider::cuboid(0.3, 0.2, 0.5) };
            let entity =
                app.world_mut().spawn(body(collider, Floating::with_density(200.0 + 50.0 * i as f32), 0.5)).id();
            app.world_mut().get_mut::<Transform>(entity).unwrap().translation.x = 0.8 * i as f32;
            entity
        })
        .collect();
    run(&mut app, 10.0);
    bodies.iter().map(|entity| read::<Transform>(&app, *entity).translation.to_array().map(f32::to_bits)).collect()
}

#[test]
fn the_same_run_gives_the_same_bits() {
    assert_eq!(trace(), trace());
}

/// Light bodies in rough water at 20 steps a second: nothing flies away.
#[test]
fn light_bodies_stay_on_rough_water_at_long_steps() {
    let (mut app, water) = still_water();
    let step = Duration::from_secs_f32(0.05);
    app.insert_resource(TimestepMode::Fixed { dt: 0.05, substeps: 1 })
        .insert_resource(Time::<Fixed>::from_duration(step))
        .insert_resource(TimeUpdateStrategy::ManualDuration(step));
    app.world_mut().entity_mut(water).insert(WaterWaves::wind(8.0, 500.0, Vec2::X));
    let bodies: Vec<Entity> = (0..9)
        .map(|i| {
            let size = [0.02, 0.1, 0.5][i / 3];
            let floating = Floating::with_density([5.0, 50.0, 300.0][i % 3]);
            let entity = app.world_mut().spawn(body(Collider::cuboid(size, size, size), floating, 0.0)).id();
            app.world_mut().get_mut::<Transform>(entity).unwrap().translation.z = 3.0 * i as f32;
            entity
        })
        .collect();
    let (mut highest, mut fastest) = (0.0_f32, 0.0_f32);
    for _ in 0..600 {
        app.update();
        for body in &bodies {
            highest = highest.max(read::<Transform>(&app, *body).translation.y - LEVEL);
            fastest = fastest.max(read::<Velocity>(&app, *body).linear.length());
        }
    }
    println!("at most {highest} m above the level and {fastest} m/s fast");
    assert!(highest < 1.5 && fastest < 5.0);
}

/// No two systems of a fixed step may run in either order.
#[test]
fn the_order_of_systems_is_decided() {
    use bevy::ecs::schedule::{LogLevel, ScheduleBuildSettings};
    let (mut app, _) = still_water();
    app.edit_schedule(FixedUpdate, |schedule| {
        schedule.set_build_settings(ScheduleBuildSettings { ambiguity_detection: LogLevel::Error, ..default() });
    });
    app.add_systems(FixedUpdate, || {});
    run(&mut app, 0.1);
}
