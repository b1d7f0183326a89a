//! Water that is simulated: felt and drawn as it is simulated, on either backend.
use crate::{
    said::complaints,
    stage::{SIZE, Stage, still_water},
    waves::{LEVEL, heights},
};
use bevy::{ecs::system::RunSystemOnce, prelude::*, time::TimeUpdateStrategy, transform::TransformPlugin};
use bevy_freshet::prelude::*;
use std::time::Duration;

/// A server: no renderer and no window; a frame is a fixed step of 1/60 s.
pub fn server() -> App {
    let step = Duration::from_secs_f64(1.0 / 60.0);
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default()))
        .init_asset::<Mesh>()
        .insert_resource(Time::<Fixed>::from_duration(step))
        .insert_resource(TimeUpdateStrategy::ManualDuration(step));
    #[cfg(feature = "rapier")]
    app.insert_resource(bevy_rapier3d::prelude::TimestepMode::Fixed { dt: 1.0 / 60.0, substeps: 1 }).add_plugins(
        bevy_rapier3d::prelude::RapierPhysicsPlugin::<bevy_rapier3d::prelude::NoUserData>::default()
            .in_fixed_schedule(),
    );
    app.add_plugins(WaterPlugin);
    app.finish();
    app.cleanup();
    app
}

pub fn run(app: &mut App, seconds: f32) {
    for _ in 0..(seconds * 60.0) as u32 {
        app.update();
    }
}

pub fn at(app: &mut App, x: f32, z: f32) -> Option<WaterSample> {
    all_at(app, vec![vec2(x, z)])[0]
}

/// The water at world places.
pub fn all_at(app: &mut App, places: Vec<Vec2>) -> Vec<Option<WaterSample>> {
    let sample = |water: &WaterQuery, place: &Vec2| water.sample(vec3(place.x, LEVEL, place.y));
    let system = move |water: WaterQuery| places.iter().map(|place| sample(&water, place)).collect::<Vec<_>>();
    app.world_mut().run_system_once(system).unwrap()
}

/// A basin of 20 m × 20 m whose ground lies 2 m under the still level.
pub fn basin(settings: WaterSimulation) -> impl Bundle {
    (Water::new(Vec2::splat(20.0)), WaterWaves::still(), settings, Transform::from_xyz(0.0, LEVEL, 0.0))
}

#[test]
fn a_spring_fills_a_dry_basin_on_a_server() {
    let mut app = server();
    let source = WaterSource { at: vec2(3.0, -2.0), radius: 2.0, rate: 4.0.into() };
    let settings = WaterSimulation { start: SimulationStart::Dry, speed: 20.0, ..default() };
    let water = app.world_mut().spawn((basin(settings), WaterSources { sources: vec![source] })).id();
    run(&mut app, 0.1);
    assert_eq!(at(&mut app, -9.0, 9.0), None, "it begins dry");
    run(&mut app, 4.9);
    // 100 s of 4 m³/s on 400 m²; the clock begins a frame or two after the app.
    let sample = at(&mut app, -9.0, 9.0).unwrap();
    assert_eq!((sample.water, sample.age), (water, 0.0));
    assert!((sample.depth - 1.0).abs() < 0.02, "{sample:?}");
    assert!((sample.height - (LEVEL - 1.0)).abs() < 0.02, "{sample:?}");
}

#[cfg(feature = "rapier")]
#[test]
fn a_ball_floats_at_the_simulated_level_and_is_carried() {
    use bevy_rapier3d::prelude::*;
    let mut app = server();
    let start = SimulationStart::Column { at: vec2(-10.0, 0.0), half_size: vec2(10.0, 20.0), level: 0.0 };
    app.world_mut().spawn(basin(WaterSimulation { start, ..default() }));
    let ball = (RigidBody::Dynamic, Collider::ball(0.3), Floating::with_density(500.0));
    let ball = app.world_mut().spawn((ball, Transform::from_xyz(-1.5, LEVEL, 0.0))).id();
    let place = |app: &App| app.world().get::<Transform>(ball).unwrap().translation;
    run(&mut app, 1.0);
    assert!(place(&app).x > -1.0, "the water that falls takes it along: {}", place(&app));
    run(&mut app, 60.0);
    // Half of the basin was 2 m deep: all of it is 1 m deep now, and half of the ball is under water.
    let found = place(&app);
    assert!((found.y - (LEVEL - 1.0)).abs() < 0.1, "{found}");
}

#[test]
fn a_gate_that_opens_lets_the_water_through() {
    let mut app = server();
    let start = SimulationStart::Column { at: vec2(-10.0, 0.0), half_size: vec2(10.0, 20.0), level: -1.0 };
    let wall = WaterWall { from: vec2(0.0, -10.0), to: vec2(0.0, 10.0), crest: bevy_freshet::body::CLOSED };
    let walls = WaterWalls { walls: vec![wall] };
    let water = app.world_mut().spawn((basin(WaterSimulation { start, ..default() }), walls)).id();
    run(&mut app, 5.0);
    assert_eq!(at(&mut app, 0.6, 0.0), None, "nothing leaks");
    assert!((at(&mut app, -0.6, 0.0).unwrap().depth - 1.0).abs() < 1e-5);
    app.world_mut().get_mut::<WaterWalls>(water).unwrap().walls[0].crest = -1.6;
    run(&mut app, 120.0);
    // Down to the crest on one side, and what flowed over it on the other.
    let (left, right) = (at(&mut app, -6.0, 0.0).unwrap().depth, at(&mut app, 6.0, 0.0).unwrap().depth);
    assert!((left + right - 1.0).abs() < 0.01 && left > 0.4 && right > 0.3, "{left} {right}");
}

/// Level before and behind a crate (m over the still level) that is towed to the south over a basin turned by 30°, and the largest
/// level anywhere.
fn towed(push: f32, speed: f32) -> [f32; 3] {
    let mut app = server();
    let turn = Quat::from_rotation_y(30_f32.to_radians());
    let water = basin(WaterSimulation { cell_size: 0.5, push, ..default() });
    let water = app.world_mut().spawn(water).id();
    app.world_mut().get_mut::<Transform>(water).unwrap().rotation = turn;
    let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(Cuboid::new(2.0, 2.0, 2.0));
    let body = app.world_mut().spawn((Mesh3d(mesh), DisturbsWater, Transform::from_xyz(0.0, LEVEL, -2.7 * speed))).id();
    for _ in 0..240 {
        app.world_mut().get_mut::<Transform>(body).unwrap().translation.z += speed / 60.0;
        run(&mut app, 1.01 / 60.0);
    }
    let z = app.world().get::<Transform>(body).unwrap().translation.z;
    let places = [1.8, -1.8].map(|offset| at(&mut app, 0.0, z + offset).unwrap().height - LEVEL);
    let highest = (0..144).map(|i| vec2((i % 12) as f32 - 5.5, (i / 12) as f32 - 5.5));
    let highest =
        highest.map(|place| (at(&mut app, place.x, place.y).unwrap().height - LEVEL).abs()).fold(0.0, f32::max);
    [places[0], places[1], highest]
}

#[test]
fn a_body_pushes_the_water_before_it() {
    let [bow, stern, _] = towed(1.0, 1.5);
    assert!(bow > 0.006 && stern < -0.006, "bow {bow} m, stern {stern} m");
    let [bow, stern, _] = towed(1.0, -1.5);
    assert!(bow < -0.006 && stern > 0.006, "the other way: {bow} m, {stern} m");
    for (push, speed) in [(0.0, 1.5), (1.0, 0.0)] {
        let [.., highest] = towed(push, speed);
        assert!(highest < 1e-6, "push {push}, speed {speed}: {highest} m");
    }
}

#[test]
fn a_body_that_drifts_with_a_uniform_current_pushes_nothing() {
    let mut app = server();
    let flow = WaterFlow::uniform(Vec2::X);
    app.world_mut().spawn((basin(WaterSimulation { cell_size: 0.5, ..default() }), flow));
    let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(Cuboid::new(2.0, 2.0, 2.0));
    let body = app.world_mut().spawn((Mesh3d(mesh), DisturbsWater, Transform::from_xyz(-4.0, LEVEL, 0.0))).id();
    for frame in 0..300 {
        // Before it is followed it has no speed.
        let x = -4.0 + frame as f32 / 60.0;
        app.world_mut().get_mut::<Transform>(body).unwrap().translation.x = x;
        run(&mut app, 1.01 / 60.0);
    }
    let off = (at(&mut app, 1.0, 0.0).unwrap().velocity.x - 1.0).abs();
    assert!(off < 0.01, "{off} m/s");
}

#[test]
fn a_water_that_grows_around_its_simulated_part_streams_into_it() {
    let mut app = server();
    let map = freshet_hydro::grid::Grid::from_fn(uvec2(160, 24), 1.0, |_| vec2(0.8, 0.0)).unwrap();
    let settings = WaterSimulation { area: Some(Rect::new(-40.0, -10.0, 0.0, 10.0)), ..default() };
    let pose = Transform::from_xyz(0.0, LEVEL, 0.0);
    let water = (Water::new(vec2(80.0, 20.0)), WaterWaves::still(), settings, pose, WaterFlow::from_map(map));
    let water = app.world_mut().spawn(water).id();
    run(&mut app, 1.0);
    app.world_mut().get_mut::<Water>(water).unwrap().size.x = 120.0;
    run(&mut app, 60.0);
    // What was the water's own side is a rim now: 0.8 m/s through 20 m × 2 m, once the still water within has got going.
    let state = app.world().get::<SimulationState>(water).unwrap();
    let entered = -state.balance.left[0] / state.time;
    assert!((entered / 32.0 - 1.0).abs() < 0.1, "{entered} m³/s");
}

#[test]
fn a_part_of_a_water_flows_with_the_water_around_it() {
    let mut app = server();
    let map = freshet_hydro::grid::Grid::from_fn(uvec2(80, 24), 1.0, |_| vec2(0.8, 0.0)).unwrap();
    let map = WaterFlow::from_map(map);
    let area = Some(Rect::new(-12.0, -10.0, 12.0, 10.0));
    let settings = WaterSimulation { cell_size: 0.5, area, blend: 3.0, ..default() };
    let pose = Transform::from_xyz(0.0, LEVEL, 0.0);
    app.world_mut().spawn((Water::new(vec2(80.0, 20.0)), WaterWaves::still(), settings, pose, map));
    run(&mut app, 60.0);
    let samples: Vec<_> = (-300..=300).map(|i| at(&mut app, 0.1 * i as f32, 0.3).unwrap()).collect();
    let level = |sample: &WaterSample| sample.height - LEVEL;
    let steepest = samples.windows(2).map(|pair| (pair[1].height - pair[0].height).abs()).fold(0.0, f32::max);
    let highest = samples.iter().map(|sample| level(sample).abs()).fold(0.0, f32::max);
    let off = samples.iter().map(|sample| (sample.velocity.x - 0.8).abs()).fold(0.0, f32::max);
    println!("level within {highest} m, {steepest} m in 0.1 m, speed within {off} m/s");
    assert!(highest < 0.03 && steepest < 2e-3 && off < 0.06);
    // Outside it is the water of the map.
    assert_eq!((level(&samples[0]), samples[0].velocity.x), (0.0, 0.8));
    // It is simulated within.
    assert!(samples[300].velocity.x != 0.8 && level(&samples[300]) != 0.0);
}

#[test]
fn time_that_stands_still_stops_the_water() {
    let mut app = server();
    let start = SimulationStart::Column { at: vec2(-10.0, 0.0), half_size: vec2(10.0, 20.0), level: 0.0 };
    app.world_mut().spawn(basin(WaterSimulation { start, ..default() }));
    run(&mut app, 0.5);
    app.world_mut().resource_mut::<Time<Virtual>>().pause();
    run(&mut app, 0.1);
    let before = at(&mut app, 1.0, 0.0);
    run(&mut app, 1.0);
    assert!(before.is_some() && at(&mut app, 1.0, 0.0) == before);
}

#[test]
fn what_cannot_be_simulated_is_said_once() {
    let mut app = server();
    let said = complaints(&mut app, |app| {
        let settings = WaterSimulation { cell_size: f32::NAN, manning: -1.0, max_steps: 0, push: -1.0, ..default() };
        let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(Cuboid::default());
        app.world_mut().spawn((Mesh3d(mesh), DisturbsWater, Transform::from_xyz(0.0, LEVEL, 0.0)));
        let edge = WaterEdge::all(DomainSide::West, Edge::Level(f32::NAN.into()));
        let source = WaterSource { at: Vec2::NAN, radius: 1.0, rate: 1.0.into() };
        app.world_mut().spawn((
            basin(settings),
            WaterEdges { parts: vec![edge], ..default() },
            WaterSources { sources: vec![source] },
        ));
        run(app, 0.5);
    });
    for field in ["cell_size", "manning", "max_steps", "push", "WaterEdges", "WaterSources"] {
        assert_eq!(said.iter().filter(|line| line.contains(field)).count(), 1, "{field} in {said:#?}");
    }
    assert!((at(&mut app, 0.0, 0.0).unwrap().depth - 2.0).abs() < 1e-5, "the rest is simulated");
}

/// Samples of a column that has fallen for two seconds in a water at `pose` over `bed`, at places of the water, with velocities
/// turned back into it.
fn fallen(pose: Transform, bed: (WaterBed, Transform)) -> Vec<WaterSample> {
    let mut app = server();
    app.world_mut().spawn(bed);
    let start = SimulationStart::Column { at: vec2(-6.0, -3.0), half_size: vec2(5.0, 5.0), level: 0.0 };
    let settings = WaterSimulation { start, cell_size: 0.5, ..default() };
    app.world_mut().spawn((Water::new(Vec2::splat(20.0)), WaterWaves::still(), settings, pose));
    run(&mut app, 2.0);
    let places = (0..400).map(|i| vec3((i % 20) as f32 - 9.3, 0.0, (i / 20) as f32 - 9.6));
    let samples = all_at(&mut app, places.map(|place| pose.transform_point(place).xz()).collect());
    let turned_back =
        |sample: WaterSample| WaterSample { velocity: pose.rotation.inverse() * sample.velocity, ..sample };
    samples.into_iter().flatten().map(turned_back).collect()
}

/// The most by which heights (m) and velocities (m/s) differ, and their means.
fn apart(a: &[WaterSample], b: &[WaterSample]) -> [Vec2; 2] {
    assert!(a.len() == b.len() && a.len() > 200, "{} {}", a.len(), b.len());
    let pairs = a.iter().zip(b);
    let off = pairs.map(|(a, b)| vec2((a.height - b.height).abs(), a.velocity.distance(b.velocity)));
    [off.clone().fold(Vec2::ZERO, Vec2::max), off.sum::<Vec2>() / a.len() as f32]
}

#[test]
fn a_water_that_is_turned_and_moved_flows_as_it_did() {
    let ground = |at: Vec2| 0.3 * (0.4 * at.x).sin() * (0.3 * at.y).cos() - 1.2;
    let bed = |turn: Quat| {
        WaterBed::from_fn(UVec2::splat(140), 0.25, |at| ground((turn * vec3(at.x, 0.0, at.y)).xz())).unwrap()
    };
    let still = Transform::from_xyz(0.0, LEVEL, 0.0);
    let turn = Quat::from_rotation_y(30_f32.to_radians());
    let turned = Transform::from_xyz(120.0, LEVEL, -45.0).with_rotation(turn);
    let unturned = fallen(still, (bed(Quat::IDENTITY), still));
    let [most, mean] = apart(&unturned, &fallen(turned, (bed(Quat::IDENTITY), turned)));
    println!("with its bed: {most} at most, {mean} on average");
    assert!(most.x < 5e-6 && most.y < 3e-5);
    // The same ground on a grid that is not turned: its cells of 0.25 m are straight between their middles, by which ground with a
    // curvature of 0.3 · 0.4² per metre is off by 0.4 mm. The level, which gravity smooths, is off by less.
    let upright = Transform::from_translation(turned.translation);
    let [most, mean] = apart(&unturned, &fallen(turned, (bed(turn.inverse()), upright)));
    println!("over its bed: {most} at most, {mean} on average");
    assert!(most.x < 1e-4 && most.y < 1e-3);
}

/// A column that has fallen over a ridge for a second, and a camera that sees its heights from above.
fn falling(backend: SimulationBackend, area: Option<Rect>) -> (Stage, Entity) {
    let mut stage = unseen(backend, area);
    let camera = stage.camera_above(vec3(0.0, LEVEL, 0.0), 6.0);
    (stage, camera)
}

/// The same without a camera.
fn unseen(backend: SimulationBackend, area: Option<Rect>) -> Stage {
    let mut stage = Stage::new();
    stage.app.insert_resource(Time::<Fixed>::from_hz(60.0));
    let bed = WaterBed::from_fn(uvec2(60, 60), 0.2, |at| 0.5 * (-(at.x - 1.0).powi(2)).exp() - 1.0).unwrap();
    stage.spawn((bed, Transform::from_xyz(0.0, LEVEL, 0.0)));
    let (water, waves, surface, optics) = still_water(Vec2::splat(12.0));
    let surface = WaterSurface { view: SurfaceView::Height, cell: 0.05, cells: 256, mesh_error: 0.0, ..surface };
    let start = SimulationStart::Column { at: vec2(-4.0, 0.0), half_size: vec2(3.0, 9.0), level: 0.6 };
    let settings = WaterSimulation { cell_size: 0.2, start, backend, area, blend: 1.0, ..default() };
    stage.spawn((water, waves, surface, optics, settings, Transform::from_xyz(0.0, LEVEL, 0.0)));
    stage.settle();
    stage.run(1.2);
    stage
}

#[test]
fn the_height_that_is_drawn_is_the_height_that_is_asked_for_on_both_backends() {
    let [cpu, gpu] = [SimulationBackend::Cpu, SimulationBackend::Gpu].map(|backend| {
        let (mut stage, camera) = falling(backend, None);
        let samples = heights(&mut stage, camera, Vec2::ZERO);
        let (lowest, highest) =
            samples.iter().fold((0.0_f32, -9.0_f32), |(low, high), sample| (low.min(sample.1), high.max(sample.1)));
        assert!(highest - lowest > 0.1, "the water moves: {lowest}…{highest}");
        for (place, drawn, queried) in &samples {
            // Between the vertices, 0.05 m apart, the mesh is straight.
            assert!((drawn - queried).abs() < 4e-3, "{backend:?} {place}: drawn {drawn}, queried {queried}");
        }
        samples
    });
    // The backends begin to run a frame or two apart.
    let off = cpu.iter().zip(&gpu).map(|(a, b)| (a.2 - b.2).abs()).sum::<f32>() / cpu.len() as f32;
    assert!(off < 0.02, "backends differ by {off} m");
}

/// Around its middle the mesh is finer than the simulation and further out coarser: vertices that are worked on together look
/// their heights up in different levels of the picture.
#[test]
fn coarser_levels_lie_where_the_finest_does() {
    for backend in [SimulationBackend::Cpu, SimulationBackend::Gpu] {
        let (mut stage, camera) = falling(backend, None);
        let world = stage.app.world_mut();
        let mut surfaces = world.query::<&mut WaterSurface>();
        let mut surface = surfaces.single_mut(world).unwrap();
        (surface.cell, surface.cells) = (0.1, 16);
        stage.settle();
        let samples = heights(&mut stage, camera, Vec2::ZERO);
        let off = samples.iter().map(|(_, drawn, queried)| (drawn - queried).abs()).fold(0.0, f32::max);
        println!("{backend:?}: drawn {off} m off where the mesh is up to 0.4 m coarse");
        assert!(off < 0.06, "{backend:?}: {off} m");
    }
}

/// Behind a wall the water stands higher than before it, drawn and asked for, as near to it as the mesh can show.
#[test]
fn the_water_does_not_lean_over_a_wall() {
    for backend in [SimulationBackend::Cpu, SimulationBackend::Gpu] {
        let mut stage = Stage::new();
        stage.app.insert_resource(Time::<Fixed>::from_hz(60.0));
        let (water, waves, surface, optics) = still_water(Vec2::splat(12.0));
        let surface = WaterSurface { view: SurfaceView::Height, cell: 0.05, cells: 256, mesh_error: 0.0, ..surface };
        let settings = WaterSimulation { cell_size: 0.4, backend, ground: -1.0, ..default() };
        let spring = WaterSource { at: vec2(-3.0, 0.0), radius: 2.5, rate: 18.0.into() };
        let wall = WaterWall { from: vec2(0.0, -6.0), to: vec2(0.0, 6.0), crest: bevy_freshet::body::CLOSED };
        let around = (WaterSources { sources: vec![spring] }, WaterWalls { walls: vec![wall] });
        stage.spawn((water, waves, surface, optics, settings, around, Transform::from_xyz(0.0, LEVEL, 0.0)));
        stage.settle();
        stage.run(1.5);
        let camera = stage.camera_above(vec3(0.0, LEVEL, 0.0), 6.0);
        let samples = heights(&mut stage, camera, Vec2::ZERO);
        // The mesh goes from one side to the other within a cell, 0.05 m.
        let beside = |from: f32, to: f32| samples.iter().filter(move |(at, ..)| (from..to).contains(&at.x));
        for (place, drawn, queried) in beside(-9.0, -0.06).chain(beside(0.06, 9.0)) {
            assert!((drawn - queried).abs() < 4e-3, "{backend:?} {place}: drawn {drawn}, queried {queried}");
        }
        let highest = beside(0.06, 0.2).map(|sample| sample.1.abs()).fold(0.0, f32::max);
        let lowest = beside(-0.2, -0.06).map(|sample| sample.1).fold(f32::INFINITY, f32::min);
        println!("{backend:?}: at least {lowest} m behind the wall, at most {highest} m before it");
        assert!(lowest > 0.1 && highest < 1e-5);
    }
}

/// Cells of the mesh are twice as large as those of the simulation: its last vertex before the bank and its first one on it
/// are far from the waterline.
#[test]
fn a_bank_is_not_climbed_where_the_mesh_is_coarse() {
    let backends = [SimulationBackend::Cpu, SimulationBackend::Gpu];
    for (backend, shore) in backends.into_iter().flat_map(|backend| [0.0, 0.4].map(|shore| (backend, shore))) {
        let mut stage = Stage::new();
        let (water, waves, surface, optics) = still_water(Vec2::splat(12.0));
        let surface = WaterSurface { view: SurfaceView::Height, cell: 0.8, cells: 64, mesh_error: 0.0, ..surface };
        let settings = WaterSimulation { cell_size: 0.4, backend, start: SimulationStart::Still, ..default() };
        let bed = WaterBed::from_fn(uvec2(60, 60), 0.2, |at| if at.x < shore { -1.0 } else { 2.0 });
        stage.spawn((bed.unwrap(), Transform::from_xyz(0.0, LEVEL, 0.0)));
        stage.spawn((water, waves, surface, optics, settings, Transform::from_xyz(0.0, LEVEL, 0.0)));
        stage.settle();
        let camera = stage.camera_above(vec3(0.0, LEVEL, 0.0), 6.0);
        let picture = stage.picture(camera);
        // The water's pixels of the 0.6 m before the bank.
        let pixel = 6.0 / SIZE.x as f32;
        let near =
            picture.pixels().filter(|(at, _)| (-0.6..-0.02).contains(&((at.x as f32 + 0.5) * pixel - 3.0 - shore)));
        let off = near.map(|(_, split)| (split.x + split.y / 64.0).abs()).fold(0.0, f32::max);
        println!("{backend:?}, shore at {shore} m: the water before it is drawn {off} m off");
        assert!(off < 1e-5);
    }
}

#[test]
fn a_part_of_a_water_is_drawn_as_it_is_asked_for() {
    let area = Some(Rect::new(-9.0, -1.0, 1.5, 9.0));
    let (mut stage, camera) = falling(SimulationBackend::Cpu, area);
    let samples = heights(&mut stage, camera, Vec2::ZERO);
    let within = samples.iter().filter(|(place, ..)| place.x < 0.5 && place.y > 0.0).count();
    let beyond = samples.iter().filter(|(place, ..)| place.x > 1.5 || place.y < -1.0).count();
    assert!(within > 20 && beyond > 20, "{within} {beyond}");
    for (place, drawn, queried) in &samples {
        assert!((drawn - queried).abs() < 4e-3, "{place}: drawn {drawn}, queried {queried}");
    }
}

#[test]
fn a_bed_that_is_poisoned_does_not_poison_the_water() {
    for backend in [SimulationBackend::Cpu, SimulationBackend::Gpu] {
        let mut stage = unseen(backend, None);
        let world = stage.app.world_mut();
        let mut states = world.query::<&SimulationState>();
        let before = *states.single(world).unwrap();
        let poisons = [(-1.5, f32::NAN), (0.0, f32::INFINITY), (1.5, f32::NEG_INFINITY)];
        let bed = WaterBed::from_fn(uvec2(60, 60), 0.2, |at| {
            let poison = poisons.into_iter().find(|(x, _)| at.distance(vec2(*x, 0.5)) < 0.15);
            poison.map_or(0.5 * (-(at.x - 1.0).powi(2)).exp() - 1.0, |(_, poison)| poison)
        });
        let mut beds = world.query::<&mut WaterBed>();
        *beds.single_mut(world).unwrap() = bed.unwrap();
        stage.run(1.0);
        let camera = stage.camera_above(vec3(0.0, LEVEL, 0.0), 6.0);
        assert!(stage.picture(camera).pixels().all(|(_, radiance)| radiance.is_finite()), "{backend:?}");
        let after = *states.single(stage.app.world()).unwrap();
        println!("{backend:?}: {} m³ of {} m³", after.volume, before.volume);
        assert!((after.volume - before.volume).abs() < 1e-6 * before.volume && after.time > before.time + 0.5);
        let places = (0..400).map(|i| vec2(0.25 * (i % 20) as f32 - 2.4, 0.25 * (i / 20) as f32 - 2.4));
        let samples: Vec<_> = all_at(&mut stage.app, places.collect()).into_iter().flatten().collect();
        assert!(samples.len() > 300, "{backend:?}: {} of 400 places are wet", samples.len());
        for sample in samples {
            let is_finite = sample.velocity.is_finite() && sample.normal.is_finite() && sample.depth < 2.0;
            assert!(is_finite && (sample.height - LEVEL).abs() < 1.0, "{backend:?}: {sample:?}");
        }
    }
}

#[test]
fn a_bed_beyond_all_bounds_is_refused_and_the_water_stays_on_the_one_before() {
    let mut app = server();
    let bed =
        |highest: f32| WaterBed::from_fn(uvec2(30, 30), 1.0, |at| if at.x > 8.0 { highest } else { -2.0 }).unwrap();
    let ground = app.world_mut().spawn((bed(-2.0), Transform::from_xyz(0.0, LEVEL, 0.0))).id();
    let water = app.world_mut().spawn(basin(WaterSimulation::default())).id();
    run(&mut app, 0.1);
    let said = complaints(&mut app, |app| {
        *app.world_mut().get_mut::<WaterBed>(ground).unwrap() = bed(f32::MAX);
        run(app, 0.5);
    });
    let [line] = said.as_slice() else { panic!("one complaint was expected: {said:#?}") };
    assert!(line.contains(&format!(" {water}: WaterBed is refused")), "{line}");
    let state = *app.world().get::<SimulationState>(water).unwrap();
    assert!(state.time > 0.5 && state.volume == 800.0, "{state:?}");
    assert!((at(&mut app, 0.0, 0.0).unwrap().height - LEVEL).abs() < 1e-6);
}
