//! Bodies that bob, fall and come to rest.
use super::{Body, SLICK, STILL, WEIGHT, run, shapes};
use freshet_hydro::{
    hull::Hull,
    waves::{GRAVITY, WATER_DENSITY},
};
use glam::{EulerRot, Quat, Vec3, vec3};
use std::f32::consts::PI;

/// Time between the first and the last rising zero crossing over their number.
fn period(values: &[f32], dt: f32) -> f32 {
    let crossings: Vec<f32> = values
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0] < 0.0 && pair[1] >= 0.0)
        .map(|(k, pair)| (k as f32 + pair[0] / (pair[0] - pair[1])) * dt)
        .collect();
    (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f32
}

/// T = 2π √((m + a)/(ρ g A)) and 2π √((I + a′)/(m g GM)), with the added mass that the hull has.
#[test]
fn boxes_heave_and_roll_with_the_periods_of_naval_architecture() {
    println!("beam m  load  heave s  theory   off %   roll s  theory   off %");
    for (beam, s) in [(1.5, 0.3), (2.0, 0.3), (2.0, 0.5), (2.0, 0.7), (3.0, 0.5), (4.0, 0.4)] {
        let height = 0.8;
        let make = || {
            let hull = Hull::cuboid(vec3(0.5 * beam, 0.5 * height, 3.0)).expect("a hull");
            let mut body = Body::new(hull, s * WATER_DENSITY, height * (0.5 - s));
            body.drag = SLICK;
            body
        };
        let dt = 1.0 / 120.0;
        let rest = make().load(STILL);
        let mass = make().mass;
        let heave_theory = 2.0 * PI * ((mass + rest.added_mass.linear.y_axis.y) / (WEIGHT * beam * 6.0)).sqrt();
        let depth = s * height;
        let metacentre = 0.5 * depth + beam * beam / (12.0 * depth) - 0.5 * height;
        let inertia = make().inertia().z_axis.z + rest.added_mass.angular.z_axis.z;
        let roll_theory = 2.0 * PI * (inertia / (mass * GRAVITY * metacentre)).sqrt();
        let mut heaving = make();
        heaving.centre.y += 0.01;
        let mut rolling = make();
        rolling.rotation = Quat::from_rotation_z(0.02);
        let (mut heights, mut angles) = (Vec::new(), Vec::new());
        for _ in 0..(20.0 / dt) as usize {
            heaving.submerged = 1.0;
            rolling.submerged = 1.0;
            heaving.step(STILL, dt);
            rolling.step(STILL, dt);
            heights.push(heaving.centre.y - height * (0.5 - s));
            angles.push(rolling.rotation.to_scaled_axis().z);
        }
        let (heave, roll) = (period(&heights, dt), period(&angles, dt));
        let off = [heave / heave_theory, roll / roll_theory].map(|ratio| 100.0 * (ratio - 1.0));
        println!(
            "{beam:>5}  {s:>5}  {heave:>7.4}  {heave_theory:>7.4}  {:>5.2}  {roll:>7.4}  {roll_theory:>7.4}  {:>5.2}",
            off[0], off[1]
        );
        assert!(off[0].abs() < 3.0 && off[1].abs() < 3.0, "{off:?}");
    }
}

/// The energy of a body that bobs in still water does not rise by more than 0.5 % of what it loses: added mass changes with the pose,
/// and what that does to the motion is left out.
#[test]
fn bobbing_bodies_never_gain_energy() {
    for density in [100.0, 500.0, 900.0] {
        for (name, hull) in shapes() {
            let mut body = Body::new(hull, density, 0.2);
            body.rotation = Quat::from_euler(EulerRot::XYZ, 0.3, 0.2, 0.4);
            let mut next = body.clone();
            next.step(STILL, 1.0 / 60.0);
            let first = body.energy(&next.motion);
            let (mut least, mut gained) = (first, 0.0_f64);
            for _ in 0..1200 {
                body = next.clone();
                next.step(STILL, 1.0 / 60.0);
                let energy = body.energy(&next.motion);
                gained = gained.max(energy - least);
                least = least.min(energy);
            }
            let swing = (first - least).max(1e-9);
            println!(
                "{name} of {density}: loses {swing:.1} J in 20 s, gains {:.3} % of it at most",
                100.0 * gained / swing
            );
            assert!(gained < 5e-3 * swing, "{name} gains {gained} J");
        }
    }
}

/// Light and heavy, small and large, in fast and in slow steps: they stay at the surface.
#[test]
fn bodies_of_every_size_come_to_rest() {
    for (name, hull) in shapes() {
        for (density, size, rate) in [
            (5.0, 0.02, 60.0),
            (5.0, 0.02, 20.0),
            (100.0, 1.0, 60.0),
            (500.0, 1.0, 20.0),
            (900.0, 30.0, 20.0),
            (5.0, 200.0, 20.0),
            (900.0, 200.0, 60.0),
        ] {
            let hull = hull.clone().scaled(Vec3::splat(size)).expect("a hull");
            let mut body = Body::new(hull, density, 2.0 * size);
            body.rotation = Quat::from_euler(EulerRot::XYZ, 0.4, 0.2, 0.7);
            run(&mut body, STILL, 30.0 * size.max(1.0).sqrt(), rate);
            let (height, speed) = (body.centre.y.abs() / size, body.motion.linear.length() / (GRAVITY * size).sqrt());
            println!("{name} of {density} kg/m³ × {size} at {rate} Hz: height {height:.3}, speed {speed:.1e} √(g L)");
            assert!(height < 1.0 && speed < 0.02, "{name}");
        }
    }
}

/// A body dropped from 100 m enters without being thrown back, and loses speed only.
#[test]
fn a_fall_from_a_hundred_metres_ends_in_the_water() {
    for (name, hull) in shapes() {
        for rate in [60.0, 20.0] {
            let mut body = Body::new(hull.clone(), 300.0, 100.0);
            body.submerged = 0.0;
            let mut highest_after = f32::NEG_INFINITY;
            let mut has_entered = false;
            for _ in 0..(40.0 * rate) as usize {
                body.step(STILL, 1.0 / rate);
                has_entered |= body.centre.y < 0.0;
                if has_entered {
                    highest_after = highest_after.max(body.centre.y);
                }
                assert!(body.motion.linear.length() < 46.0 && body.centre.is_finite(), "{name}");
            }
            println!(
                "{name} at {rate} Hz: rises to {highest_after:.2} m after its fall, then rests at {:.3} m",
                body.centre.y
            );
            assert!(has_entered && highest_after < 2.0 && body.centre.y.abs() < 1.0, "{name}: {highest_after}");
        }
    }
}

/// A cork of 2 cm and a beach ball of 10 kg/m³ lie still.
#[test]
fn light_things_do_not_jitter() {
    for (name, hull, density) in [
        ("cork", Hull::cylinder(0.01, 0.008).expect("a hull"), 200.0),
        ("beach ball", Hull::ball(0.2).expect("a hull"), 10.0),
    ] {
        let mut body = Body::new(hull, density, 0.01);
        body.rotation = Quat::from_rotation_z(0.3);
        run(&mut body, STILL, 10.0, 60.0);
        let mut sum = 0.0;
        for _ in 0..60 {
            body.step(STILL, 1.0 / 60.0);
            sum += body.motion.linear.y.powi(2);
        }
        let jitter = (sum / 60.0).sqrt();
        println!("{name}: {jitter:.2e} m/s RMS after 10 s");
        assert!(jitter < 1e-3, "{name}: {jitter}");
    }
}
