//! What resists bodies, against its formulas.
use super::{Body, SLICK, STILL, run, shapes};
use freshet_hydro::{
    hull::{Hull, HullDrag, VISCOSITY, friction_coefficient},
    load::{BodyState, Fluid, Motion, Surface},
    waves::{GRAVITY, WATER_DENSITY},
};
use glam::{Vec3, vec3};
use std::f32::consts::PI;

/// √(2 |m − ρ V| g/(ρ C_d A)), with the 0.47 of a ball.
#[test]
fn balls_sink_and_rise_at_their_terminal_velocity() {
    for density in [2000.0, 500.0] {
        for radius in [0.05, 0.3] {
            let mut body = Body::new(Hull::ball(radius).expect("a hull"), density, -500.0);
            run(&mut body, STILL, 20.0, 60.0);
            let net = (density - WATER_DENSITY).abs() * body.hull.volume() * GRAVITY;
            let terminal = (2.0 * net / (WATER_DENSITY * 0.47 * PI * radius * radius)).sqrt();
            let speed = body.motion.linear.y.abs();
            println!("density {density}, radius {radius} m: {speed:.4} m/s, {terminal:.4} m/s expected");
            assert!((speed / terminal - 1.0).abs() < 0.05, "{speed} {terminal}");
        }
    }
}

#[test]
fn a_stream_carries_bodies_at_its_speed() {
    for (name, hull) in shapes() {
        let mut body = Body::new(hull, 400.0, 0.0);
        let stream = Surface { velocity: vec3(1.5, 0.0, 0.0), ..STILL };
        run(&mut body, stream, 60.0, 60.0);
        println!("{name}: {} m/s after a minute", body.motion.linear.x);
        assert!((body.motion.linear.x / 1.5 - 1.0).abs() < 0.01, "{name}");
    }
}

/// A plank towed along its length, deep under water: skin friction on its four long sides, pressure on its ends.
#[test]
fn a_towed_plank_is_resisted_as_its_formula_says() {
    let half = vec3(0.05, 0.15, 3.0);
    for speed in [0.5, 2.0, 6.0] {
        let mut body = Body::new(Hull::cuboid(half).expect("a hull"), 500.0, -50.0);
        body.motion.linear = Vec3::Z * speed;
        let load = body.load(STILL);
        let resistance = -(load.stream + load.resistance.times(&body.motion) * -1.0).force.z;
        let sides = 8.0 * half.z * (half.x + half.y);
        let length = body.hull.length();
        let friction = 0.5 * WATER_DENSITY * friction_coefficient(speed * length / VISCOSITY) * sides * speed * speed;
        let form = 0.5 * WATER_DENSITY * 1.05 * 4.0 * half.x * half.y * speed * speed;
        println!("{speed} m/s: {resistance:.3} N, friction {friction:.3} N and form {form:.3} N");
        assert!((resistance / (friction + form) - 1.0).abs() < 1e-3);
    }
}

/// Logarithmic decrement of a half-submerged ball that bobs by a millimetre: as a share of critical damping.
#[test]
fn the_heave_of_a_ball_dies_out_by_its_radiation() {
    let mut body = Body::new(Hull::ball(0.5).expect("a hull"), 0.5 * WATER_DENSITY, 0.001);
    body.drag = HullDrag { radiation: HullDrag::default().radiation, ..SLICK };
    let mut crests = Vec::new();
    let [mut before, mut last] = [0.0, body.centre.y];
    for _ in 0..1200 {
        body.submerged = 1.0;
        body.step(STILL, 1.0 / 120.0);
        if last > before && last > body.centre.y {
            crests.push(last);
        }
        (before, last) = (last, body.centre.y);
    }
    let decrement = (crests[0] / crests[2]).ln() / 2.0;
    let share = decrement / (4.0 * PI * PI + decrement * decrement).sqrt();
    println!("heave of a ball: {share:.4} of critical damping");
    assert!((0.05..0.2).contains(&share), "{share}");
}

/// A ball that spins has nothing but its skin to resist it: ∫ ½ ρ C_f |ω × r|² r sin θ dA = ½ ρ C_f ω² π² · ¾ R⁵.
#[test]
fn a_spinning_ball_is_resisted_by_its_skin() {
    let (radius, turn) = (0.3_f32, 2.0_f32);
    let mut body = Body::new(Hull::ball(radius).expect("a hull"), 900.0, -20.0);
    body.motion.angular = Vec3::Y * turn;
    let load = body.load(STILL);
    let torque = load.resistance.times(&body.motion).torque;
    let speed = 0.5 * body.hull.length() * turn;
    let coefficient = friction_coefficient(speed * body.hull.length() / VISCOSITY);
    let skin = 0.5 * WATER_DENSITY * coefficient * turn * turn * 0.75 * PI * PI * radius.powi(5);
    println!("a ball that spins: {} N m, {skin} N m by its skin", torque.y);
    assert!((torque.y / skin - 1.0).abs() < 0.1 && torque.x.abs() + torque.z.abs() < 0.01 * torque.y);
}

/// Without gravity nothing floats, and yet the water is there.
#[test]
fn water_resists_without_gravity() {
    let body = Body::new(Hull::ball(0.5).expect("a hull"), 500.0, -2.0);
    let motion = Motion { linear: Vec3::X, angular: Vec3::ZERO };
    let state = BodyState { pose: body.pose(), centre: body.centre, motion };
    let fluid = Fluid { gravity: 0.0, ..Fluid::default() };
    let load = body.hull.load(&state, &fluid, &body.drag, &mut Vec::new(), |_| Some(STILL));
    assert_eq!(load.pressure.force, Vec3::ZERO);
    assert!((load.submerged_volume / body.hull.volume() - 1.0).abs() < 1e-5);
    let force = load.resistance.times(&motion).force.x;
    let drag = 0.5 * WATER_DENSITY * 0.47 * PI * 0.25;
    assert!((force / drag - 1.0).abs() < 0.05, "{force} {drag}");
}
