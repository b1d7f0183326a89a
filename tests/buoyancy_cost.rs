//! What floating bodies cost beside the solver's own step.
use crate::buoyancy::{LEVEL, app, body, run};
use bevy::prelude::*;
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use std::time::Instant;

/// When the part of a step that is being timed began, and how long each part took in all, s.
#[derive(Resource, Default)]
struct Stopwatch {
    began: Option<Instant>,
    parts: [f64; PARTS.len()],
}

/// What Rapier's plugin does before its solver's step, the water, and so on.
const PARTS: [&str; 5] = ["Rapier: reading", "water", "forces", "Rapier: solver", "Rapier: writing"];

impl Stopwatch {
    fn start(mut watch: ResMut<Self>) {
        watch.began = Some(Instant::now());
    }

    fn lap<const PART: usize>(mut watch: ResMut<Self>) {
        let now = Instant::now();
        let took = watch.began.replace(now).map_or(0.0, |began| (now - began).as_secs_f64());
        watch.parts[PART] += took;
    }
}

/// What floating crates cost beside the solver, on waves, alone and side by side, and in simulated water, with which they exchange room and
/// forces. `cargo test … what_bodies_cost -- --ignored --nocapture`.
#[test]
#[ignore = "measures"]
fn what_bodies_cost() {
    println!("µs per crate\n| crates | apart | water | {} |\n|---|---|---|---|---|---|---|---|", PARTS.join(" | "));
    let waves = [(1, 1.6), (10, 1.6), (100, 1.6), (1000, 1.6), (2000, 1.6), (100, 1.0), (1000, 1.0)];
    let rows = waves.map(|row| (row, false)).into_iter().chain([((100, 1.6), true), ((1000, 1.6), true)]);
    for ((count, apart), simulated) in rows {
        let mut app = app();
        let pose = Transform::from_xyz(0.0, LEVEL, 0.0);
        match simulated {
            true => {
                let simulation = WaterSimulation { cell_size: 0.5, ..default() };
                app.world_mut().spawn((Water::new(Vec2::splat(120.0)), WaterWaves::still(), simulation, pose))
            }
            false => {
                app.world_mut().spawn((Water::new(Vec2::splat(4000.0)), WaterWaves::wind(8.0, 2000.0, Vec2::X), pose))
            }
        };
        app.init_resource::<Stopwatch>().add_systems(
            FixedUpdate,
            (
                Stopwatch::start.before(PhysicsSet::SyncBackend),
                Stopwatch::lap::<0>.after(PhysicsSet::SyncBackend).before(WaterSystems::Sample),
                Stopwatch::lap::<1>.after(WaterSystems::Sample).before(WaterSystems::Force),
                Stopwatch::lap::<2>.after(WaterSystems::Force).before(PhysicsSet::StepSimulation),
                Stopwatch::lap::<3>.after(PhysicsSet::StepSimulation).before(PhysicsSet::Writeback),
                Stopwatch::lap::<4>.after(PhysicsSet::Writeback),
            ),
        );
        for k in 0..count {
            let wooden = body(Collider::cuboid(0.5, 0.5, 0.5), Floating::with_density(400.0), 0.0);
            let wooden = app.world_mut().spawn(wooden).id();
            let place = apart * Vec3::new((k % 50) as f32 - 25.0, 0.0, (k / 50) as f32 - 20.0);
            app.world_mut().get_mut::<Transform>(wooden).unwrap().translation = place.with_y(LEVEL);
        }
        run(&mut app, 1.0);
        *app.world_mut().resource_mut::<Stopwatch>() = Stopwatch::default();
        run(&mut app, 2.0);
        let parts = app.world().resource::<Stopwatch>().parts;
        let row = parts.map(|seconds| format!("{:.2}", 1e6 * seconds / (120 * count) as f64)).join(" | ");
        let water = if simulated { "simulated" } else { "waves" };
        println!("| {count} | {apart} m | {water} | {row} |");
    }
}
