//! The boat of the example: what its forces make of it on still water.
#[path = "../examples/common/boat.rs"]
mod example;

use crate::buoyancy::{LEVEL, app};
use bevy::prelude::*;
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use core::f32::consts::TAU;
use example::{Helm, boat, drive};

/// The boat on a lake, and what it does from step to step.
struct Trial {
    app: App,
    boat: Entity,
}

/// The boat at a time.
#[derive(Clone, Copy)]
struct Moment {
    place: Vec3,
    /// Where the bow points, rad, more is to port.
    heading: f32,
    /// To starboard, rad.
    heel: f32,
    /// Bow up, rad.
    trim: f32,
    velocity: Vec3,
    /// Of the water, N.
    force: Vec3,
    submerged: f32,
}

impl Trial {
    fn new() -> Self {
        let mut app = app();
        app.add_systems(FixedUpdate, drive.before(PhysicsSet::SyncBackend));
        let world = app.world_mut();
        world.spawn((Water::new(Vec2::splat(2000.0)), WaterWaves::still(), Transform::from_xyz(0.0, LEVEL, 0.0)));
        let boat = world.spawn(boat(Transform::from_xyz(0.0, LEVEL + 0.2, 0.0))).id();
        Self { app, boat }
    }

    /// One step of 1/60 s with this helm.
    fn step(&mut self, throttle: f32, rudder: f32) -> Moment {
        *self.app.world_mut().get_mut::<Helm>(self.boat).unwrap() = Helm { throttle, rudder };
        self.app.update();
        let boat = self.app.world().entity(self.boat);
        let (pose, water) = (boat.get::<Transform>().unwrap(), boat.get::<Buoyancy>().unwrap());
        let (heading, trim, roll) = pose.rotation.to_euler(EulerRot::YXZ);
        Moment {
            place: pose.translation - Vec3::Y * LEVEL,
            heading,
            heel: -roll,
            trim,
            velocity: boat.get::<Velocity>().unwrap().linear,
            force: water.force,
            submerged: water.submerged_volume / water.volume,
        }
    }

    fn run(&mut self, seconds: f32, throttle: f32, rudder: f32) -> Vec<Moment> {
        (0..(60.0 * seconds) as u32).map(|_| self.step(throttle, rudder)).collect()
    }
}

#[test]
fn table() {
    let mut trial = Trial::new();
    for (seconds, throttle, rudder) in [(10.0, 0.0, 0.0), (20.0, 1.0, 0.0), (20.0, 1.0, 1.0)] {
        for m in trial.run(seconds, throttle, rudder).iter().step_by(60) {
            println!(
                "place {:7.2} heading {:7.1} heel {:6.1} trim {:6.1} speed {:5.2} force {:9.1} submerged {:.3}",
                m.place, m.heading.to_degrees(), m.heel.to_degrees(), m.trim.to_degrees(), m.velocity.length(), m.force, m.submerged
            );
        }
    }
    let _ = TAU;
}
