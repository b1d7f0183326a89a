//! Two hundred bodies of all kinds in a rough river: nothing is lost, nothing explodes, nobody complains.
use crate::{
    said::complaints,
    simulated::{run, server},
    waves::LEVEL,
};
use bevy::prelude::*;
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;

const LENGTH: f32 = 120.0;
const WIDTH: f32 = 30.0;
const DEPTH: f32 = 3.0;

/// A simulated river that flows to the east in waves, over ground and between banks of which bodies bounce.
fn river(world: &mut World) {
    let (inflow, outflow) = (Edge::Discharge(120.0.into()), Edge::Level(0.0.into()));
    let parts = vec![WaterEdge::all(DomainSide::West, inflow), WaterEdge::all(DomainSide::East, outflow)];
    let settings = WaterSimulation { cell_size: 1.0, ground: -DEPTH, ..default() };
    let waves = WaterWaves::wind(10.0, 3000.0, vec2(1.0, 0.3));
    let pose = Transform::from_xyz(0.0, LEVEL, 0.0);
    world.spawn((Water::new(vec2(LENGTH, WIDTH)), waves, settings, WaterEdges { parts, ..default() }, pose));
    let mut wall = |half: Vec3, at: Vec3| {
        world.spawn((RigidBody::Fixed, Collider::cuboid(half.x, half.y, half.z), Transform::from_translation(at)));
    };
    // Wider than the river: what is thrown out lies beside it.
    wall(vec3(2000.0, 50.0, 2000.0), vec3(0.0, LEVEL - DEPTH - 50.0, 0.0));
    for side in [-1.0, 1.0] {
        wall(vec3(LENGTH, 100.0, 5.0), vec3(0.0, LEVEL, side * (0.5 * WIDTH + 4.5)));
        wall(vec3(5.0, 100.0, WIDTH), vec3(side * (0.5 * LENGTH + 4.5), LEVEL, 0.0));
    }
}

/// A body of one of eight shapes, of 4 cm to 3 m, of 20 to 3000 kg/m³, in one of three models.
fn spawn(world: &mut World, i: u32, height: f32) -> Entity {
    let size = [0.02, 0.1, 0.3, 0.5, 1.0][(i % 5) as usize];
    let shape = match i % 8 {
        0 => Collider::ball(size),
        1 => Collider::cuboid(size, 0.5 * size, 1.5 * size),
        2 => Collider::cylinder(size, 0.4 * size),
        3 => Collider::cone(size, size),
        4 => Collider::capsule_y(size, 0.5 * size),
        5 => Collider::round_cuboid(size, size, 0.3 * size, 0.1 * size),
        6 => Collider::compound(vec![
            (Vec3::ZERO, Quat::IDENTITY, Collider::cuboid(size, 0.2 * size, 0.2 * size)),
            (Vec3::Y * 0.5 * size, Quat::IDENTITY, Collider::ball(0.5 * size)),
        ]),
        _ => Collider::cuboid(1.5 * size, 0.1 * size, size),
    };
    let model = match i % 7 {
        0 => BuoyancyModel::Voxels { per_axis: 4 },
        1 => BuoyancyModel::Samples { spacing: 0.4 * size },
        _ => BuoyancyModel::Hull,
    };
    let density = [20.0, 200.0, 600.0, 950.0, 3000.0][(i / 5 % 5) as usize];
    let floating = Floating { model, ..Floating::with_density(density) };
    let (x, z) = ((i * 37 % 100) as f32 - 50.0, (i * 53 % 23) as f32 - 11.0);
    let scale = Vec3::splat(if i.is_multiple_of(9) { 1.6 } else { 1.0 });
    let pose = Transform::from_xyz(x, LEVEL + height, z).with_scale(scale);
    world.spawn((RigidBody::Dynamic, shape, floating, Velocity::zero(), Ccd::enabled(), pose)).id()
}

/// What happens to bodies once a second: one is shot into the water, one scaled, one replaced, and what has come far, or out of the
/// river, goes back.
fn disturb(world: &mut World, bodies: &mut [Entity], second: u32) {
    let count = bodies.len() as u32;
    let chosen = |k: u32| ((second * 7 + k * 31) % count) as usize;
    let way = vec3(0.3, -1.0, 0.1 * (second % 5) as f32).normalize();
    world.get_mut::<Velocity>(bodies[chosen(0)]).unwrap().linear = 120.0 * way;
    world.get_mut::<Transform>(bodies[chosen(1)]).unwrap().scale = Vec3::splat(0.6 + 0.1 * (second % 9) as f32);
    world.despawn(bodies[chosen(2)]);
    bodies[chosen(2)] = spawn(world, second + 3, 5.0);
    for &body in bodies.iter() {
        let mut pose = world.get_mut::<Transform>(body).unwrap();
        if pose.translation.x > 0.4 * LENGTH || pose.translation.abs().xz().cmpgt(0.5 * vec2(LENGTH, WIDTH)).any() {
            pose.translation = vec3(-0.4 * LENGTH, LEVEL + 6.0, pose.translation.z.clamp(-0.4 * WIDTH, 0.4 * WIDTH));
        }
    }
}

fn survive(seconds: u32) {
    let mut app = server();
    river(app.world_mut());
    let mut bodies: Vec<_> = (0..200).map(|i| spawn(app.world_mut(), i, 1.0 + 0.05 * i as f32)).collect();
    let (mut fastest, mut lowest) = (0.0_f32, f32::INFINITY);
    let said = complaints(&mut app, |app| {
        for second in 0..seconds {
            disturb(app.world_mut(), &mut bodies, second);
            run(app, 1.01);
            for &body in &bodies {
                let (pose, velocity) =
                    (app.world().get::<Transform>(body).unwrap(), app.world().get::<Velocity>(body).unwrap());
                let is_sound = pose.is_finite() && velocity.linear.is_finite() && velocity.angular.is_finite();
                assert!(is_sound, "{body} after {second} s: {pose:?}, {velocity:?}");
                fastest = fastest.max(velocity.linear.length());
                lowest = lowest.min(pose.translation.y - LEVEL);
                let depth = LEVEL - pose.translation.y;
                assert!(depth < DEPTH + 0.1, "{body} is lost through the bed after {second} s: {pose:?}, {velocity:?}");
            }
        }
    });
    let mut states = app.world_mut().query::<&SimulationState>();
    let state = states.single(app.world()).unwrap();
    println!(
        "{seconds} s: up to {fastest:.1} m/s, down to {lowest:.2} m; {:.1e} of the water",
        state.error() / state.volume
    );
    println!("{said:#?}");
    assert_eq!(said, Vec::<String>::new());
    assert!(fastest < 121.0 && state.error().abs() < 1e-6 * state.volume);
}

#[test]
fn two_hundred_bodies_live_in_a_rough_river() {
    survive(15);
}

#[test]
#[ignore = "takes minutes"]
fn two_hundred_bodies_live_for_ten_minutes_in_a_rough_river() {
    survive(600);
}
