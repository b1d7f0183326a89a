//! Floating bodies and simulated water: the room that they take up, and what they give back.
use crate::{
    simulated::{all_at, at, basin, run, server},
    waves::LEVEL,
};
use bevy::prelude::*;
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use freshet_hydro::waves::{GRAVITY, WATER_DENSITY};

/// A basin of 20 m × 20 m, 2 m deep, in cells of 0.25 m.
fn tank() -> impl Bundle {
    basin(WaterSimulation { cell_size: 0.25, ..default() })
}

/// The same with more water around it, so that waves leave.
fn pond(settings: WaterSimulation) -> impl Bundle {
    let sides = [DomainSide::West, DomainSide::East, DomainSide::North, DomainSide::South];
    let parts = sides.map(|side| WaterEdge::all(side, Edge::Still(0.0.into()))).to_vec();
    (basin(WaterSimulation { cell_size: 0.25, ..settings }), WaterEdges { parts, ..default() })
}

fn body(collider: Collider, density: f32, at: Vec3) -> impl Bundle {
    let pose = Transform::from_translation(at + LEVEL * Vec3::Y);
    (RigidBody::Dynamic, collider, Floating::with_density(density), Velocity::zero(), pose)
}

/// Volume below the surface of the tank, whatever is in it, m³.
fn volume_below_surface(app: &mut App) -> f64 {
    let places = (0..80 * 80).map(|i| vec2((i % 80) as f32 - 39.5, (i / 80) as f32 - 39.5) * 0.25).collect();
    all_at(app, places).iter().map(|sample| f64::from(sample.unwrap().depth) * 0.0625).sum()
}

fn submerged_volume(app: &mut App) -> f64 {
    let mut bodies = app.world_mut().query::<&Buoyancy>();
    bodies.iter(app.world()).map(|buoyancy| f64::from(buoyancy.submerged_volume)).sum()
}

fn levels(app: &mut App, places: &[Vec2]) -> Vec<f32> {
    all_at(app, places.to_vec()).iter().map(|sample| sample.unwrap().height - LEVEL).collect()
}

#[test]
fn what_bodies_displace_is_under_the_surface_too() {
    let mut app = server();
    // A rough bed, as waves would go to and fro for long.
    app.world_mut().spawn(basin(WaterSimulation { cell_size: 0.25, manning: 0.5, ..default() }));
    run(&mut app, 0.1);
    let water = volume_below_surface(&mut app);
    let bodies = [
        app.world_mut().spawn(body(Collider::cuboid(0.8, 0.5, 0.6), 400.0, vec3(2.0, 1.5, -3.0))).id(),
        app.world_mut().spawn(body(Collider::ball(0.7), 700.0, vec3(-4.0, 3.0, 1.0))).id(),
        app.world_mut().spawn(body(Collider::cylinder(0.4, 0.5), 2000.0, vec3(0.0, 1.0, 5.0))).id(),
    ];
    let mut worst = 0.0_f64;
    for second in 0..30 {
        run(&mut app, 1.0);
        // What is said of a body is as it was seen a step ago.
        let all = volume_below_surface(&mut app) - submerged_volume(&mut app);
        if second > 20 {
            worst = worst.max((all / water - 1.0).abs());
        }
    }
    let raised = volume_below_surface(&mut app) / water - 1.0;
    for body in bodies {
        app.world_mut().despawn(body);
    }
    run(&mut app, 0.1);
    let after = volume_below_surface(&mut app) / water - 1.0;
    println!("water and bodies: {worst:.1e} off; bodies raise it by {raised:.1e}, and leave {after:.1e}");
    assert!(raised > 2e-3 && worst < 1e-5 && after.abs() < 1e-7);
}

#[test]
fn a_body_lies_as_deep_in_simulated_water_and_leaves_it_still() {
    let mut app = server();
    app.world_mut().spawn(pond(default()));
    let crate_ = body(Collider::cuboid(0.8, 0.4, 0.6), 500.0, vec3(0.3, 0.1, -0.4));
    let crate_ = app.world_mut().spawn(crate_).id();
    run(&mut app, 40.0);
    let buoyancy = *app.world().get::<Buoyancy>(crate_).unwrap();
    let exact = 0.8 * 500.0 / WATER_DENSITY;
    let places: Vec<_> = (0..64).map(|i| vec2((i % 8) as f32 - 3.5, (i / 8) as f32 - 3.5) * 0.6).collect();
    let levels = levels(&mut app, &places);
    let off = levels.iter().map(|level| level.abs()).fold(0.0, f32::max);
    let speed = all_at(&mut app, places).iter().map(|sample| sample.unwrap().velocity.length()).fold(0.0, f32::max);
    println!("draft {} m of {exact} m; level within {off:.1e} m, {speed:.1e} m/s", buoyancy.draft);
    assert!((buoyancy.draft / exact - 1.0).abs() < 0.005);
    assert!(off < 1e-4 && speed < 1e-3);
}

#[test]
fn the_ring_of_a_crate_arrives_at_the_speed_of_long_waves() {
    let mut app = server();
    app.world_mut().spawn(pond(WaterSimulation { ground: -0.6, ..default() }));
    app.world_mut().spawn(body(Collider::cuboid(0.7, 0.2, 0.7), 150.0, vec3(0.0, 0.25, 0.0)));
    let gauges = [vec2(3.5, 0.0), vec2(7.5, 0.0)];
    let mut heights = vec![Vec::new(); 2];
    for _ in 0..300 {
        run(&mut app, 1.01 / 60.0);
        for (heights, level) in heights.iter_mut().zip(levels(&mut app, &gauges)) {
            heights.push(level);
        }
    }
    // When the front has a third of the height of its crest.
    let arrival = |heights: &[f32]| {
        let crest = heights[..240].iter().copied().fold(0.0, f32::max);
        heights.iter().position(|height| *height > 0.33 * crest).unwrap() as f32 / 60.0
    };
    let speed = 4.0 / (arrival(&heights[1]) - arrival(&heights[0]));
    let expected = (GRAVITY * 0.6).sqrt();
    println!("the ring travels at {speed:.2} m/s, √(g d) is {expected:.2} m/s");
    assert!((speed / expected - 1.0).abs() < 0.06);
}

/// Poses of two bodies that fall into one another's waves, and levels beside them, in a scene that is mirrored along x if `sign` is −1.
fn mirrored(sign: f32) -> (Vec<Vec3>, Vec<f32>) {
    let mut app = server();
    app.world_mut().spawn(tank());
    let crate_ = body(Collider::cuboid(0.6, 0.3, 0.6), 400.0, vec3(sign * 1.5, 0.6, 0.5));
    let crate_ = app.world_mut().spawn(crate_).id();
    let ball = body(Collider::ball(0.5), 300.0, vec3(sign * -1.5, 1.2, 0.0));
    let ball = app.world_mut().spawn(ball).id();
    run(&mut app, 4.0);
    let mirror = vec3(sign, 1.0, 1.0);
    let poses = [crate_, ball].map(|body| app.world().get::<Transform>(body).unwrap().translation * mirror);
    let gauges: Vec<_> = (0..9).map(|i| vec2(sign * (i as f32 - 4.0), 2.0)).collect();
    (poses.to_vec(), levels(&mut app, &gauges))
}

#[test]
fn mirrored_scenes_move_as_mirror_images_and_the_same_scene_moves_the_same() {
    let (one, other) = (mirrored(1.0), mirrored(-1.0));
    let apart = one.0.iter().zip(&other.0).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    let levels = one.1.iter().zip(&other.1).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    println!("mirror images: bodies {apart:.1e} m apart, levels {levels:.1e} m");
    assert!(apart < 2e-3 && levels < 1e-3);
    assert_eq!(one, mirrored(1.0), "not the same in another run");
}

#[test]
fn a_ferry_that_is_driven_raises_the_water_before_it() {
    let ferry = |speed: f32| {
        let mut app = server();
        app.world_mut().spawn(pond(default()));
        let ferry = (
            RigidBody::KinematicVelocityBased,
            Collider::cuboid(1.0, 0.6, 0.8),
            Floating::default(),
            Velocity::linear(speed * Vec3::X),
            Transform::from_xyz(-2.0 * speed, LEVEL, 0.0),
        );
        app.world_mut().spawn(ferry);
        run(&mut app, if speed == 0.0 { 20.0 } else { 4.0 });
        levels(&mut app, &[vec2(2.0 * speed + 1.6, 0.0), vec2(2.0 * speed - 1.6, 0.0)])
    };
    let [there, back, standing] = [1.5, -1.5, 0.0].map(ferry);
    println!("bow and stern {there:?}, the other way {back:?}, standing {standing:?} m");
    assert!(there[0] > 0.01 && there[1] < 0.0);
    assert!((there[0] - back[1]).abs() < 2e-3 && (there[1] - back[0]).abs() < 2e-3);
    assert!(standing.iter().all(|level| level.abs() < 0.002));
}

#[test]
fn a_body_that_appears_in_the_water_does_not_leap_out() {
    let mut app = server();
    app.world_mut().spawn(tank());
    let afloat = body(Collider::cuboid(0.8, 0.4, 0.6), 500.0, Vec3::ZERO);
    let afloat = app.world_mut().spawn(afloat).id();
    let mut highest = 0.0_f32;
    for _ in 0..120 {
        run(&mut app, 1.01 / 60.0);
        highest = highest.max(app.world().get::<Transform>(afloat).unwrap().translation.y - LEVEL);
    }
    println!("it rises by {highest} m");
    assert!(highest < 0.05 && at(&mut app, 5.0, 5.0).is_some());
}
