//! What is told of bodies that go into the water and out of it, against free fall.
use crate::buoyancy::{LEVEL, RATE, assert_near, body, is_asleep, read, run, still_water};
use bevy::prelude::*;
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use core::f32::consts::PI;
use std::collections::HashMap;

/// All that has been told, in order.
#[derive(Resource, Default)]
struct Told {
    entered: Vec<Passage>,
    left: Vec<Passage>,
    submerged: Vec<Passage>,
    splashes: Vec<Splash>,
}

fn listen(
    mut told: ResMut<Told>,
    mut entered: MessageReader<Entered>,
    mut left: MessageReader<Left>,
    mut submerged: MessageReader<Submerged>,
    mut splashes: MessageReader<Splash>,
) {
    told.entered.extend(entered.read().map(|it| it.0));
    told.left.extend(left.read().map(|it| it.0));
    told.submerged.extend(submerged.read().map(|it| it.0));
    told.splashes.extend(splashes.read());
}

impl Told {
    /// Of which bodies each was told.
    fn bodies(&self) -> [Vec<Entity>; 4] {
        let [entered, left, submerged] =
            [&self.entered, &self.left, &self.submerged].map(|told| told.iter().map(|passage| passage.body).collect());
        [entered, left, submerged, self.splashes.iter().map(|splash| splash.body).collect()]
    }

    /// How many of each.
    fn counts(&self) -> [usize; 4] {
        self.bodies().map(|bodies| bodies.len())
    }
}

fn listening() -> (App, Entity) {
    let (mut app, water) = still_water();
    app.init_resource::<Told>().add_systems(FixedPostUpdate, listen);
    // Water and poses that have just been spawned are where they are to be from the second step on.
    run(&mut app, 0.1);
    (app, water)
}

fn told(app: &App) -> &Told {
    app.world().resource()
}

const RADIUS: f32 = 0.25;
const VOLUME: f32 = 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS;

/// A ball whose lowest point is `height` over the water, off the origin.
fn ball(app: &mut App, density: f32, height: f32) -> Entity {
    let ball = body(Collider::ball(RADIUS), Floating::with_density(density), height + RADIUS);
    let ball = app.world_mut().spawn(ball).id();
    let mut pose = app.world_mut().get_mut::<Transform>(ball).unwrap();
    (pose.translation.x, pose.translation.z) = (3.0, -2.0);
    ball
}

/// Stones and wooden balls from several heights: one entry and one splash at the speed of free fall, where the ball came down.
#[test]
fn a_fall_is_one_entry_and_one_splash() {
    for (density, height) in [(500.0, 0.5), (500.0, 1.0), (500.0, 5.0), (2500.0, 0.3), (2500.0, 1.0), (2500.0, 7.0)] {
        let (mut app, water) = listening();
        let ball = ball(&mut app, density, height);
        let mut deepest = 0.0_f32;
        let falling = (2.0 * height / 9.81).sqrt();
        for _ in 0..((falling + 0.5) * RATE) as u32 {
            app.update();
            deepest = deepest.max(read::<Buoyancy>(&app, ball).submerged_volume);
        }
        let speed = (2.0 * 9.81 * height).sqrt();
        let told = told(&app);
        println!("{density} kg/m³ from {height} m, {speed} m/s: {:?} {:?}", told.counts(), told.splashes);
        let ([entered], [splash]) = (&told.entered[..], &told.splashes[..]) else { panic!("{:?}", told.counts()) };
        assert_eq!([entered.body, splash.body, entered.water, splash.water], [ball, ball, water, water]);
        assert_near(entered.speed, speed, 0.02, "speed at entry");
        assert_near(splash.speed, speed, 0.02, "speed of the splash");
        assert_near(entered.volume, VOLUME, 1e-3, "volume of the hull");
        assert!(splash.place.abs_diff_eq(vec3(3.0, LEVEL, -2.0), 2e-3), "{}", splash.place);
        assert!(splash.normal.abs_diff_eq(Vec3::Y, 1e-4));
        assert!(splash.volume <= 1.0001 * deepest && splash.volume > 0.8 * deepest, "{} of {deepest}", splash.volume);
        if density > 1000.0 {
            assert_eq!(told.submerged.len(), 1);
            assert_near(splash.volume, VOLUME, 2e-3, "volume of the splash");
        }
    }
}

/// From the dry to deep under within one step.
#[test]
fn a_shot_through_the_surface_is_told_in_one_step() {
    let (mut app, _) = listening();
    let ball = ball(&mut app, 2000.0, 0.2);
    *app.world_mut().get_mut::<Velocity>(ball).unwrap() = Velocity::linear(Vec3::NEG_Y * 90.0);
    for _ in 0..3 {
        assert_eq!(told(&app).counts(), [0; 4]);
        app.update();
        if !told(&app).entered.is_empty() {
            break;
        }
    }
    assert_eq!(told(&app).counts(), [1, 0, 1, 1]);
    assert_near(told(&app).entered[0].speed, 90.0, 0.02, "speed at entry");
    assert_near(told(&app).splashes[0].speed, 90.0, 0.02, "speed of the splash");
    assert_near(told(&app).splashes[0].volume, VOLUME, 2e-3, "volume of the splash");
}

#[test]
fn what_is_thrown_out_leaves_and_enters_again() {
    let (mut app, water) = listening();
    let ball = ball(&mut app, 500.0, -RADIUS);
    run(&mut app, 2.0);
    assert_eq!(told(&app).counts(), [1, 0, 0, 0], "{:?}", told(&app).splashes);
    assert_eq!(told(&app).entered[0].speed, 0.0, "it began in the water");
    app.world_mut().get_mut::<Velocity>(ball).unwrap().linear.y = 8.0;
    run(&mut app, 0.3);
    assert_eq!(told(&app).counts(), [1, 1, 0, 0]);
    assert!(told(&app).left[0].speed < -3.0, "out of the water");
    run(&mut app, 3.0);
    assert_eq!(told(&app).counts()[..2], [2, 1]);
    assert_eq!(told(&app).splashes.len(), 1);

    app.world_mut().despawn(water);
    run(&mut app, 1.0);
    assert_eq!(told(&app).counts()[..2], [2, 2], "without water it is out of it");
    assert_eq!(told(&app).left[1].water, water);
}

/// Spawns corks of many weights and sizes at the surface of waves.
fn corks(app: &mut App, water: Entity, waves: WaterWaves) {
    app.world_mut().entity_mut(water).insert(waves);
    for (i, density) in [30.0, 100.0, 240.0, 500.0, 700.0].into_iter().enumerate() {
        for (j, half) in [0.05, 0.15, 0.4].into_iter().enumerate() {
            let cork = body(Collider::cuboid(half, half, half), Floating::with_density(density), 0.0);
            let cork = app.world_mut().spawn(cork).id();
            let mut pose = app.world_mut().get_mut::<Transform>(cork).unwrap();
            (pose.translation.x, pose.translation.z) = (4.0 * i as f32, 4.0 * j as f32);
        }
    }
}

/// Corks in a breeze for 20 s: they bob, and that is no news.
#[test]
fn bobbing_is_silent() {
    let (mut app, water) = listening();
    corks(&mut app, water, WaterWaves::default());
    run(&mut app, 5.0);
    let settled = told(&app).counts();
    assert_eq!(settled[0] - settled[1], 15, "light ones jump when they are let go");
    run(&mut app, 20.0);
    assert_eq!(told(&app).counts(), settled, "{:?}", told(&app).splashes);
}

/// On steep waves corks are dunked and leap; never twice within a fifth of a second, and none is lost count of.
#[test]
fn nothing_flickers_on_steep_waves() {
    let (mut app, water) = listening();
    corks(&mut app, water, WaterWaves::wind(6.0, 300.0, Vec2::X).scaled(1.5));
    let mut last = HashMap::new();
    let (mut before, mut soonest) = ([0; 4], u32::MAX);
    for step in 0..(20.0 * RATE) as u32 {
        app.update();
        for (kind, bodies) in told(&app).bodies().into_iter().enumerate() {
            for &body in &bodies[before[kind]..] {
                let earlier = last.insert((kind, body), step);
                soonest = earlier.map_or(soonest, |earlier| soonest.min(step - earlier));
            }
        }
        before = told(&app).counts();
    }
    println!("{before:?}, the soonest after {soonest} steps");
    assert!(soonest >= 9 && before[3] > 15);
    assert!((0..=15).contains(&(before[0] - before[1])));
}

#[test]
fn rest_lowering_and_putting_are_silent() {
    let (mut app, _) = listening();
    let resting = ball(&mut app, 500.0, -RADIUS);
    let lowered = body(Collider::cuboid(0.5, 0.5, 0.5), Floating::with_density(500.0), 0.7);
    let lowered = app.world_mut().spawn((lowered, Damping { linear_damping: 20.0, angular_damping: 0.0 })).id();
    run(&mut app, 30.0);
    assert!(is_asleep(&mut app, resting));
    assert_eq!(told(&app).counts(), [2, 0, 0, 0], "{:?}", told(&app).splashes);
    let entered = told(&app).entered.iter().find(|entered| entered.body == lowered).unwrap();
    assert!((0.4..0.7).contains(&entered.speed), "g over the damping, about: {}", entered.speed);

    // Other colliders are another hull in the same water.
    app.world_mut().entity_mut(resting).insert(Collider::cuboid(0.3, 0.3, 0.3));
    run(&mut app, 1.0);
    // Falling fast, and put deep under water by the game.
    let put = ball(&mut app, 2000.0, 20.0);
    run(&mut app, 1.0);
    app.world_mut().get_mut::<Transform>(put).unwrap().translation.y = LEVEL - 5.0;
    run(&mut app, 0.1);
    assert_eq!(told(&app).counts(), [3, 0, 1, 0]);
    assert_eq!(told(&app).entered[2].speed, 0.0);
    app.world_mut().despawn(put);
    app.world_mut().entity_mut(resting).remove::<Floating>();
    run(&mut app, 1.0);
    assert_eq!(told(&app).counts(), [3, 0, 1, 0], "what is gone ends without a word");
}

/// A plank that falls on one of its ends splashes on that side.
#[test]
fn a_slam_is_told_where_it_happens() {
    for tilt in [-0.5, 0.5] {
        let (mut app, _) = listening();
        let plank = body(Collider::cuboid(2.0, 0.1, 0.4), Floating::with_density(400.0), 1.4);
        let plank = app.world_mut().spawn(plank).id();
        app.world_mut().get_mut::<Transform>(plank).unwrap().rotation = Quat::from_rotation_z(tilt);
        run(&mut app, 3.0);
        let splashes = &told(&app).splashes;
        println!("{splashes:?}");
        assert!((1..=2).contains(&splashes.len()));
        assert!((-2.0..-0.2).contains(&(splashes[0].place.x * tilt.signum())), "{}", splashes[0].place);
        assert!(splashes[0].speed > 1.0 && (0.02..0.64).contains(&splashes[0].volume));
    }
}
