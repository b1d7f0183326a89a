//! The shallow-water solver against analytic solutions, on the CPU.

mod analytic;
mod cases;

use freshet_hydro::shallow_water::ShallowWater;

static STEPS: std::sync::atomic::AtomicU32 = std::sync::atomic::AtomicU32::new(0);
/// Simulates on the CPU.
fn run(water: &mut ShallowWater, duration: f64) {
    let advance = water.advance(duration, u32::MAX);
    assert_eq!(advance.left, 0.0);
    STEPS.fetch_add(advance.steps, std::sync::atomic::Ordering::Relaxed);
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

#[test]
fn steady() {
    cases::steady::over_a_bump(&mut run);
}

#[test]
fn order() {
    cases::order::of_a_smooth_wave(&mut run);
}

#[test]
fn volume() {
    cases::volume::in_a_basin_that_is_shaken(&mut run);
}

#[test]
fn balance() {
    cases::volume::with_inflow_tide_and_rain(&mut run);
}
