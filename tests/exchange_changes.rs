//! Bodies in simulated water while something changes: the water stops, begins anew, gets other cells or runs faster, or the body goes. On
//! either backend.
use crate::{
    running::state,
    simulated::{all_at, basin, run, server},
    stage::Stage,
    waves::LEVEL,
};
use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use freshet_hydro::waves::WATER_DENSITY;
use std::time::Duration;

const HALF: Vec3 = vec3(0.8, 0.4, 0.6);
const DENSITY: f32 = 500.0;

/// A basin of 20 m × 20 m, 2 m deep, with a bed so rough that it is soon at rest, and a crate that lies in it.
struct Scene {
    app: App,
    water: Entity,
    body: Entity,
    backend: SimulationBackend,
}

impl Scene {
    fn on(backend: SimulationBackend) -> Self {
        let mut app = match backend {
            SimulationBackend::Gpu => rendering(),
            _ => server(),
        };
        let settings = WaterSimulation { cell_size: 0.25, manning: 0.5, backend, ..default() };
        let water = app.world_mut().spawn(basin(settings)).id();
        let body = (
            RigidBody::Dynamic,
            Collider::cuboid(HALF.x, HALF.y, HALF.z),
            Floating::with_density(DENSITY),
            Velocity::zero(),
            Transform::from_xyz(0.3, LEVEL, -0.4),
        );
        let body = app.world_mut().spawn(body).id();
        run(&mut app, 6.0);
        assert_eq!(state(&app, water).backend, backend);
        Self { app, water, body, backend }
    }

    fn settings(&mut self) -> Mut<'_, WaterSimulation> {
        self.app.world_mut().get_mut::<WaterSimulation>(self.water).unwrap()
    }

    /// Volume below the surface, whatever is in it, over what was there in the beginning, m³.
    fn raised(&mut self) -> f32 {
        let places = (0..80 * 80).map(|i| vec2((i % 80) as f32 - 39.5, (i / 80) as f32 - 39.5) * 0.25).collect();
        let depths = all_at(&mut self.app, places);
        let volume: f64 =
            depths.iter().map(|sample| sample.map_or(0.0, |sample| f64::from(sample.depth) * 0.0625)).sum();
        (volume - 800.0) as f32
    }

    /// Whether the crate floats about as deep as at rest, and the water has made room for just what is under water of it.
    fn check(&mut self, when: &str) {
        let buoyancy = *self.app.world().get::<Buoyancy>(self.body).unwrap();
        let (draft, under_water) = (2.0 * HALF.y * DENSITY / WATER_DENSITY, buoyancy.submerged_volume);
        let (raised, backend) = (self.raised(), self.backend);
        println!(
            "{backend:?}, {when}: draft {:.4} of {draft:.4} m, room {raised:.4} of {under_water:.4} m³",
            buoyancy.draft
        );
        // It still bobs on the waves that the change has made.
        assert!((buoyancy.draft / draft - 1.0).abs() < 0.3, "{when}");
        // What is said of a body is as it was seen a step ago; the water on the GPU, as many frames ago as its state took to come back.
        let most = if backend == SimulationBackend::Gpu { 0.15 } else { 0.04 };
        assert!((raised / under_water - 1.0).abs() < most, "{when}");
    }

    /// Whether the water has closed over where the crate was.
    fn check_gone(&mut self, when: &str) {
        let raised = self.raised();
        println!("{:?}, {when}: room {raised:.1e} m³", self.backend);
        assert!(raised.abs() < 0.005, "{when}: {raised} m³");
    }
}

/// An app that renders, with physics; a frame is a fixed step of 1/60 s.
fn rendering() -> App {
    let step = Duration::from_secs_f64(1.0 / 60.0);
    let mut stage = Stage::with(|app| {
        app.add_plugins((RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule(), WaterPlugin))
            .insert_resource(TimestepMode::Fixed { dt: 1.0 / 60.0, substeps: 1 })
            .insert_resource(Time::<Fixed>::from_duration(step));
    });
    stage.settle();
    stage.app.insert_resource(TimeUpdateStrategy::ManualDuration(step));
    stage.app
}

fn on_both(test: impl Fn(Scene)) {
    for backend in [SimulationBackend::Cpu, SimulationBackend::Gpu] {
        test(Scene::on(backend));
    }
}

#[test]
fn water_that_is_paused_keeps_its_bodies_and_lets_go_of_them_later() {
    on_both(|mut scene| {
        scene.check("at rest");
        scene.settings().paused = true;
        run(&mut scene.app, 0.5);
        let before = scene.raised();
        run(&mut scene.app, 2.0);
        assert_eq!(scene.raised(), before);
        scene.settings().paused = false;
        run(&mut scene.app, 3.0);
        scene.check("running again");
        scene.settings().paused = true;
        run(&mut scene.app, 0.5);
        scene.app.world_mut().despawn(scene.body);
        run(&mut scene.app, 0.5);
        scene.settings().paused = false;
        run(&mut scene.app, 1.0);
        scene.check_gone("gone while it was paused");
    });
}

#[test]
fn water_that_begins_anew_or_gets_other_cells_makes_room_again() {
    on_both(|mut scene| {
        scene.app.world_mut().trigger(ResetSimulation(scene.water));
        run(&mut scene.app, 8.0);
        scene.check("begun anew");
        scene.settings().cell_size = 0.5;
        run(&mut scene.app, 8.0);
        scene.check("in cells of twice the size");
    });
}

#[test]
fn water_that_runs_faster_than_its_bodies_holds_them_as_well() {
    on_both(|mut scene| {
        for speed in [3.0, 0.5] {
            scene.settings().speed = speed;
            run(&mut scene.app, 6.0);
            scene.check(&format!("at {speed} times the speed"));
        }
    });
}

#[test]
fn water_closes_over_bodies_that_no_longer_float() {
    type Change = fn(&mut EntityWorldMut);
    let changes: [(&str, Change); 4] = [
        ("without Floating", |body| _ = body.remove::<Floating>()),
        // A collider that is left behind is never joined to a body again by Rapier.
        ("without RigidBody", |body| _ = body.remove::<(RigidBody, Collider)>()),
        ("disabled", |body| _ = body.insert(RigidBodyDisabled)),
        ("despawned", |_| ()),
    ];
    on_both(|mut scene| {
        for (when, change) in changes {
            let pose = *scene.app.world().get::<Transform>(scene.body).unwrap();
            match when {
                "despawned" => _ = scene.app.world_mut().despawn(scene.body),
                _ => change(&mut scene.app.world_mut().entity_mut(scene.body)),
            }
            run(&mut scene.app, 0.5);
            scene.check_gone(when);
            if when != "despawned" {
                let mut body = scene.app.world_mut().entity_mut(scene.body);
                body.remove::<RigidBodyDisabled>().insert((
                    (RigidBody::Dynamic, Collider::cuboid(HALF.x, HALF.y, HALF.z)),
                    Floating::with_density(DENSITY),
                    Velocity::zero(),
                    pose,
                ));
                run(&mut scene.app, 6.0);
                scene.check(&format!("{when} and back"));
            }
        }
    });
}
