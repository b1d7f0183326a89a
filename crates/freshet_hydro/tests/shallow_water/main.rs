//! The shallow-water solver against analytic solutions, on the CPU.

mod analytic;
mod cases;

use freshet_hydro::shallow_water::ShallowWater;

/// Simulates on the CPU.
fn run(water: &mut ShallowWater, duration: f64) {
    let advance = water.advance(duration, u32::MAX);
    assert_eq!(advance.left, 0.0);
}

#[test]
fn ritter_and_stoker() {
    cases::dam_break::ritter_and_stoker(&mut run);
}

#[test]
fn thacker() {
    cases::basin::planar(&mut run);
}

#[test]
fn rest() {
    cases::rest::over_bumps(&mut run);
}
