//! What floating bodies cost beside the solver's own step.
use crate::buoyancy::{LEVEL, app, body, run};
use bevy::prelude::*;
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use std::time::Instant;

/// When parts of a step began and ended, and how long they took in all, s.
#[derive(Resource, Default)]
struct Stopwatch {
    began: Option<Instant>,
    water: f64,
    forces: f64,
    solver: f64,
}

impl Stopwatch {
    fn start(mut watch: ResMut<Self>) {
        watch.began = Some(Instant::now());
    }

    fn lap(&mut self) -> f64 {
        let now = Instant::now();
        self.began.replace(now).map_or(0.0, |began| (now - began).as_secs_f64())
    }
}

/// What floating crates cost beside the solver's own step, on waves. `cargo test … what_bodies_cost -- --ignored --nocapture`.
#[test]
#[ignore = "measures"]
fn what_bodies_cost() {
    println!("| crates | water, µs per crate | forces, µs per crate | solver, µs per crate |\n|---|---|---|---|");
    for count in [1, 10, 100, 1000, 2000] {
        let mut app = app();
        let water = (Water::new(Vec2::splat(4000.0)), WaterWaves::default(), Transform::from_xyz(0.0, LEVEL, 0.0));
        app.world_mut().spawn(water);
        app.init_resource::<Stopwatch>().add_systems(
            FixedUpdate,
            (
                Stopwatch::start.after(PhysicsSet::SyncBackend).before(WaterSystems::Sample),
                (|mut watch: ResMut<Stopwatch>| watch.water += watch.lap())
                    .after(WaterSystems::Sample)
                    .before(WaterSystems::Force),
                (|mut watch: ResMut<Stopwatch>| watch.forces += watch.lap())
                    .after(WaterSystems::Force)
                    .before(PhysicsSet::StepSimulation),
                (|mut watch: ResMut<Stopwatch>| watch.solver += watch.lap())
                    .after(PhysicsSet::StepSimulation)
                    .before(PhysicsSet::Writeback),
            ),
        );
        for k in 0..count {
            let wooden = body(Collider::cuboid(0.5, 0.5, 0.5), Floating::with_density(400.0), 0.0);
            let wooden = app.world_mut().spawn(wooden).id();
            let place = Vec3::new(1.6 * (k % 50) as f32 - 40.0, LEVEL, 1.6 * (k / 50) as f32 - 32.0);
            app.world_mut().get_mut::<Transform>(wooden).unwrap().translation = place;
        }
        run(&mut app, 1.0);
        *app.world_mut().resource_mut::<Stopwatch>() = Stopwatch::default();
        run(&mut app, 2.0);
        let watch = app.world().resource::<Stopwatch>();
        let per_crate = |seconds: f64| 1e6 * seconds / (120 * count) as f64;
        let [water, forces, solver] = [watch.water, watch.forces, watch.solver].map(per_crate);
        println!("| {count} | {water:.2} | {forces:.2} | {solver:.2} |");
    }
}
