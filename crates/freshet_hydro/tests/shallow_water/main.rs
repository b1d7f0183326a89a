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

#[test]
fn edges_reflect() {
    cases::edges::reflect(&mut run);
}
#[test]
fn edges_a_ring_leaves() {
    cases::edges::a_ring_leaves(&mut run);
}

#[test]
fn edges_a_tide_is_followed() {
    cases::edges::a_tide_is_followed(&mut run);
}

#[test]
fn edges_a_discharge_enters_dry_land() {
    cases::edges::a_discharge_enters_dry_land(&mut run);
}

#[test]
fn edges_no_more_is_taken_than_there_is() {
    cases::edges::no_more_is_taken_than_there_is(&mut run);
}

#[test]
fn edges_a_part_of_a_side() {
    cases::edges::a_part_of_a_side(&mut run);
}

#[test]
fn walls_a_closed_wall_leaks_nothing() {
    cases::walls::a_closed_wall_leaks_nothing(&mut run);
}

#[test]
fn walls_a_weir_holds_what_is_below_its_crest() {
    cases::walls::a_weir_holds_what_is_below_its_crest(&mut run);
}

#[test]
fn walls_weir_law() {
    cases::walls::weir_law(&mut run);
}

#[test]
fn walls_an_open_gate_leaves_no_trace() {
    cases::walls::an_open_gate_leaves_no_trace(&mut run);
}

#[test]
fn walls_a_moving_bed_keeps_the_volume() {
    cases::walls::a_moving_bed_keeps_the_volume(&mut run);
}

