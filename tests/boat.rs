//! The boat of the example: what its forces make of it on still water.
#[path = "../examples/common/boat.rs"]
mod example;

use crate::buoyancy::{LEVEL, app};
use bevy::prelude::*;
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use example::{Helm, THRUST, boat, drive, script};

/// The boat on a lake.
struct Trial {
    app: App,
    boat: Entity,
}

/// The boat at a time.
#[derive(Clone, Copy, Debug)]
struct Moment {
    /// From the middle of the water, m.
    place: Vec3,
    /// Where the bow points, rad; more is to port.
    heading: f32,
    /// To starboard, rad.
    heel: f32,
    /// With the bow up, rad.
    trim: f32,
    velocity: Vec3,
    /// Of the water against the way of the boat, N.
    resistance: f32,
    /// Share of the hull under water.
    submerged: f32,
}

impl Trial {
    fn new() -> Self {
        let mut app = app();
        app.add_systems(FixedUpdate, drive.before(PhysicsSet::SyncBackend));
        let world = app.world_mut();
        world.spawn((Water::new(Vec2::splat(2000.0)), WaterWaves::still(), Transform::from_xyz(0.0, LEVEL, 0.0)));
        let boat = world.spawn(boat(Transform::from_xyz(0.0, LEVEL + 0.1, 0.0))).id();
        Self { app, boat }
    }

    /// One step of 1/60 s with this helm.
    fn step(&mut self, helm: Helm) -> Moment {
        *self.app.world_mut().get_mut::<Helm>(self.boat).unwrap() = helm;
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
            resistance: water.force.dot(*pose.back()),
            submerged: water.submerged_volume / water.volume,
        }
    }

    fn run(&mut self, seconds: f32, throttle: f32, rudder: f32) -> Vec<Moment> {
        (0..(60.0 * seconds) as u32).map(|_| self.step(Helm { throttle, rudder })).collect()
    }
}

fn last(moments: &[Moment]) -> Moment {
    *moments.last().unwrap()
}

#[test]
fn at_rest_it_lies_upright_and_level() {
    let now = last(&Trial::new().run(15.0, 0.0, 0.0));
    println!("{now:?}");
    assert!(now.heel.abs() < 0.5_f32.to_radians() && now.trim.abs() < 2.0_f32.to_radians(), "{now:?}");
    assert!(now.velocity.length() < 0.05 && (0.1..0.5).contains(&now.submerged), "{now:?}");
}

/// At full ahead its speed comes to rest where the water resists by the thrust.
#[test]
fn it_runs_as_fast_as_thrust_equals_resistance() {
    let mut trial = Trial::new();
    let (before, now) = (last(&trial.run(20.0, 1.0, 0.0)), last(&trial.run(5.0, 1.0, 0.0)));
    println!("{now:?}");
    assert!((now.velocity.length() / before.velocity.length() - 1.0).abs() < 0.01, "{before:?} {now:?}");
    assert!((4.0..12.0).contains(&now.velocity.length()), "{now:?}");
    // Trimmed by a few degrees, part of the weight acts along the keel.
    let along = now.resistance / THRUST - 1.0 + 950.0 * 9.81 * now.trim.sin() / THRUST;
    assert!(along.abs() < 0.03, "{now:?}: {along}");
}

#[test]
fn it_turns_the_way_of_the_rudder_and_stays_afloat() {
    for rudder in [-1.0_f32, 1.0] {
        let mut trial = Trial::new();
        let start = last(&trial.run(8.0, 1.0, 0.0));
        let turn = trial.run(30.0, 1.0, rudder);
        // A turn to starboard takes the heading down. In a second it is well under way.
        assert!(rudder * (turn[59].heading - start.heading) < -0.1, "{:?}", turn[59]);
        assert!(rudder * (turn[240].place.x - start.place.x) > 1.0, "{:?}", turn[240]);
        let heel = turn.iter().map(|moment| moment.heel.abs()).fold(0.0, f32::max).to_degrees();
        println!("rudder {rudder}: heel up to {heel}°, at last {:?}", last(&turn));
        assert!(heel < 25.0);
        for moment in turn {
            assert!(moment.submerged < 0.4 && moment.place.y > -0.3 && moment.velocity.is_finite(), "{moment:?}");
        }
    }
}

/// The hull's triangles are no mirror images of each other: that is worth some per cent.
#[test]
fn the_mirrored_rudder_takes_the_mirrored_way() {
    let path = |rudder: f32| {
        let mut trial = Trial::new();
        trial.run(4.0, 1.0, 0.0);
        trial.run(8.0, 1.0, rudder)
    };
    let (port, starboard) = (path(-1.0), path(1.0));
    let way: f32 = starboard.windows(2).map(|pair| pair[0].place.distance(pair[1].place)).sum();
    let off = |(a, b): (&Moment, &Moment)| a.place.distance(b.place * vec3(-1.0, 1.0, 1.0));
    let most = port.iter().zip(&starboard).map(off).fold(0.0, f32::max);
    println!("up to {most} m off on a way of {way} m");
    assert!(most < 0.03 * way, "{most} m off on a way of {way} m");
}

/// The picture of the example repeats.
#[test]
fn the_script_is_a_function_of_time() {
    let run = || {
        let mut trial = Trial::new();
        let moments = (0..600).map(|step| trial.step(script(step as f32 / 60.0)));
        moments.map(|moment| moment.place.to_array().map(f32::to_bits)).collect::<Vec<_>>()
    };
    assert!(run() == run());
}

/// A propeller in the air pushes nothing.
#[test]
fn on_the_beach_the_propeller_has_no_effect() {
    let mut trial = Trial::new();
    let water = trial.app.world_mut().query_filtered::<Entity, With<Water>>().single(trial.app.world()).unwrap();
    trial.app.world_mut().despawn(water);
    trial.run(0.5, 1.0, 1.0);
    assert_eq!(*trial.app.world().get::<ExternalForce>(trial.boat).unwrap(), ExternalForce::default());
}
