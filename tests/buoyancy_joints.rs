//! Floating bodies on ropes, springs and hinges, against statics.
use crate::buoyancy::{LEVEL, app, assert_near, body, is_asleep, read, run, still_water};
use bevy::prelude::*;
use bevy_freshet::{body::Wave, prelude::*};
use bevy_rapier3d::prelude::*;
use freshet_hydro::{
    hull::{VISCOSITY, friction_coefficient},
    waves::WATER_DENSITY,
};

/// A stream of this speed along x, m/s.
fn stream(speed: f32) -> App {
    let (mut app, water) = still_water();
    app.world_mut().entity_mut(water).insert(WaterFlow::uniform(Vec2::X * speed));
    app
}

/// A point that stays where it is, `above` the water.
fn anchor(app: &mut App, above: f32) -> Entity {
    app.world_mut().spawn((RigidBody::Fixed, Transform::from_xyz(0.0, LEVEL + above, 0.0))).id()
}

/// Where the body is from the point `above` the water, m.
fn arm(app: &App, entity: Entity, above: f32) -> Vec3 {
    read::<Transform>(app, entity).translation - Vec3::Y * (LEVEL + above)
}

/// The water's force and the weight of a body of `mass` (kg), N.
fn pull(app: &App, entity: Entity, mass: f32) -> Vec3 {
    read::<Buoyancy>(app, entity).force - Vec3::Y * (9.81 * mass)
}

/// A submerged cube as heavy as water on a spring, as far down the stream as its drag stretches that: ½ ρ c A u² with c = 1.05, and
/// friction on four sides.
#[test]
fn a_spring_is_stretched_by_the_drag() {
    const STIFFNESS: f32 = 80.0;
    for speed in [0.5, 1.0, 1.5] {
        let mut app = stream(speed);
        let anchor = anchor(&mut app, -5.0);
        let cube = body(Collider::cuboid(0.25, 0.25, 0.25), Floating::with_density(WATER_DENSITY), -5.0);
        let spring = SpringJointBuilder::new(1.0, STIFFNESS, 60.0);
        let joint = ImpulseJoint::new(anchor, spring);
        let cube = app.world_mut().spawn((cube, joint, LockedAxes::ROTATION_LOCKED)).id();
        app.world_mut().get_mut::<Transform>(cube).unwrap().translation.x = 1.0;
        run(&mut app, 60.0);
        let arm = arm(&app, cube, -5.0);
        let tension = STIFFNESS * (arm.length() - 1.0);
        let coefficient = 1.05 + 4.0 * friction_coefficient(speed * 0.5 / VISCOSITY);
        let drag = 0.5 * WATER_DENSITY * coefficient * 0.25 * speed * speed;
        println!("{speed} m/s: {arm}, tension {tension} N, drag {drag} N");
        assert_near(tension, drag, 0.05, "tension");
        assert!(arm.y.abs() < 0.02 && arm.z.abs() < 1e-3 && read::<Velocity>(&app, cube).linear.length() < 1e-2);
    }
}

/// A ball that a rope holds under water pulls it with all of its buoyancy, and a stone on the bed lies there with all of its weight in water.
#[test]
fn what_is_held_feels_all_of_the_water() {
    let mut app = stream(0.0);
    let anchor = anchor(&mut app, -8.0);
    let ball = body(Collider::ball(0.5), Floating::with_density(50.0), -6.0);
    let ball = app.world_mut().spawn((ball, ImpulseJoint::new(anchor, RopeJointBuilder::new(2.0)))).id();
    let floor = (RigidBody::Fixed, Collider::cuboid(5.0, 0.5, 5.0), Transform::from_xyz(20.0, LEVEL - 8.5, 0.0));
    app.world_mut().spawn(floor);
    let stone = body(Collider::cuboid(0.3, 0.3, 0.3), Floating::with_density(2600.0), -7.69);
    let stone = app.world_mut().spawn(stone).id();
    app.world_mut().get_mut::<Transform>(stone).unwrap().translation.x = 20.0;
    for body in [ball, stone] {
        app.world_mut().entity_mut(body).insert(Sleeping::disabled());
    }
    run(&mut app, 20.0);
    for body in [ball, stone] {
        let buoyancy = read::<Buoyancy>(&app, body);
        assert_near(buoyancy.force.y, WATER_DENSITY * 9.81 * buoyancy.volume, 0.01, "push");
    }
    assert_near(read::<Transform>(&app, ball).translation.y, LEVEL - 6.0, 0.01, "height");
}

/// A buoy on a rope from the bed lies where the rope pulls against drag and buoyancy: along the sum of all other forces.
#[test]
fn a_buoy_lies_along_the_pull_of_its_rope() {
    for (speed, length) in [(0.5, 6.0), (1.5, 6.0), (1.5, 4.2)] {
        let mut app = stream(speed);
        let anchor = anchor(&mut app, -4.0);
        let buoy = body(Collider::ball(0.5), Floating::with_density(200.0), 0.0);
        let joint = ImpulseJoint::new(anchor, RopeJointBuilder::new(length));
        let buoy = app.world_mut().spawn((buoy, joint)).id();
        run(&mut app, 60.0);
        let (arm, pull) = (arm(&app, buoy, -4.0), pull(&app, buoy, 200.0 * read::<Buoyancy>(&app, buoy).volume));
        println!("{speed} m/s, {length} m: at {arm}, pulled by {pull} N");
        assert_near(arm.length(), length, 0.01, "length of the rope");
        assert_near(arm.x / arm.y, pull.x / pull.y, 0.05, "slope of the rope");
        assert!(pull.x > 5.0 && read::<Velocity>(&app, buoy).linear.length() < 0.05);
    }
}

/// A spar that turns on the bed leans downstream until the water and its weight have no torque about its foot.
#[test]
fn a_spar_on_a_ball_joint_leans_until_torques_balance() {
    let mut app = stream(0.8);
    let anchor = anchor(&mut app, -6.0);
    let spar = body(Collider::cylinder(1.0, 0.2), Floating::with_density(500.0), -4.99);
    let foot = SphericalJointBuilder::new().local_anchor2(Vec3::NEG_Y);
    let spar = app.world_mut().spawn((
        spar,
        ImpulseJoint::new(anchor, foot),
        Damping { linear_damping: 0.0, angular_damping: 0.5 },
    ));
    let spar = spar.id();
    run(&mut app, 60.0);
    let (arm, buoyancy) = (arm(&app, spar, -6.0), read::<Buoyancy>(&app, spar));
    let pull = pull(&app, spar, 500.0 * buoyancy.volume);
    let rest = arm.cross(pull) + buoyancy.torque;
    let lever = arm.x * pull.y;
    println!("leans by {:.1}°, torque {rest} N·m of {lever} N·m", (arm.x / arm.y).atan().to_degrees());
    assert_near(arm.length(), 1.0, 0.01, "length of the spar");
    assert!(arm.x > 0.05 && rest.z.abs() < 0.05 * lever.abs(), "{rest} of {lever}");
}

/// Two rafts on a hinge: both float at their draft, stay joined on waves, and go to sleep when these are gone.
#[test]
fn hinged_rafts_stay_joined_and_sleep() {
    let mut app = app();
    let swell = Wave { direction: Vec2::X, wavelength: 7.0, steepness: 0.2, phase: 0.0 };
    let waves = WaterWaves { trains: vec![swell], ..WaterWaves::still() };
    let water = (Water::new(Vec2::splat(400.0)), waves, Transform::from_xyz(0.0, LEVEL, 0.0));
    let water = app.world_mut().spawn(water).id();
    let half = vec3(1.0, 0.2, 1.0);
    let [left, right] = [-1.05, 1.05].map(|x| {
        let raft = app.world_mut().spawn(body(Collider::cuboid(half.x, half.y, half.z), Floating::default(), 0.0)).id();
        app.world_mut().get_mut::<Transform>(raft).unwrap().translation.x = x;
        raft
    });
    let hinge = RevoluteJointBuilder::new(Vec3::Z).local_anchor1(Vec3::X * 1.05).local_anchor2(Vec3::NEG_X * 1.05);
    app.world_mut().entity_mut(right).insert(ImpulseJoint::new(left, hinge));
    let apart = |app: &App| {
        let end = |raft, x: f32| read::<Transform>(app, raft).transform_point(Vec3::X * x);
        end(left, 1.05).distance(end(right, -1.05))
    };
    let (mut furthest, mut steepest) = (0.0_f32, 0.0_f32);
    for _ in 0..600 {
        app.update();
        furthest = furthest.max(apart(&app));
        let turned = read::<Transform>(&app, left).rotation.angle_between(read::<Transform>(&app, right).rotation);
        steepest = steepest.max(turned);
    }
    println!("they were at most {furthest} m apart, bent by {:.1}°", steepest.to_degrees());
    assert!(furthest < 0.01 && steepest > 0.02);

    app.world_mut().entity_mut(water).insert(WaterWaves::still());
    run(&mut app, 90.0);
    for raft in [left, right] {
        let draft = LEVEL + half.y - read::<Transform>(&app, raft).translation.y;
        assert_near(draft, 0.4 * 500.0 / WATER_DENSITY, 0.02, "draft");
        assert!(is_asleep(&mut app, raft), "{:?}", read::<Velocity>(&app, raft));
    }
}
