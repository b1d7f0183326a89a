//! The shallow-water solver on the CPU: against analytic solutions, and what only a CPU can show.

mod analytic;
mod cases;
mod determinism;
mod hostile;
mod properties;

use freshet_hydro::shallow_water::ShallowWater;

/// Simulates on the CPU.
fn run(water: &mut ShallowWater, duration: f64) {
    let advance = water.advance(duration, u32::MAX);
    assert_eq!(advance.left, 0.0);
}

/// Makes a test of every case, on the CPU.
macro_rules! on_the_cpu {
    ($($module:ident { $($(#[$attribute:meta])* $case:ident)* })*) => {
        $(mod $module {
            $(#[test]
            $(#[$attribute])*
            fn $case() {
                crate::cases::$module::$case(&mut crate::run);
            })*
        })*
    };
}

on_the_cpu! {
    basin { planar }
    dam_break { ritter_and_stoker }
    edges {
        reflect
        a_ring_leaves
        a_tide_is_followed
        a_discharge_enters_dry_land
        no_more_is_taken_than_there_is
        a_part_of_a_side
    }
    order { of_a_smooth_wave }
    rest { over_bumps over_terrain }
    steady {
        over_a_bump
        a_jump_stands_still_on_any_grid
        a_jump_stays_straight
        uniform
        a_sheet_on_a_slope
        uniform_to_an_open_edge
    }
    symmetry { a_round_dam times_do_not_depend_on_the_grid }
    volume { with_inflow_tide_and_rain a_poisoned_cell_infects_nobody }
    walls {
        a_closed_wall_leaks_nothing
        a_weir_holds_what_is_below_its_crest
        flow_over_a_weir
        flow_over_a_dike
        an_open_gate_leaves_no_trace
        a_moving_bed_keeps_the_volume
    }
}

#[test]
fn the_volume_of_a_shaken_basin_is_kept_for_100_000_steps() {
    let mut steps = 0;
    cases::volume::in_a_basin_that_is_shaken(&mut |water, duration| steps += water.advance(duration, u32::MAX).steps);
    println!("{steps} steps");
    assert!(steps >= 100_000);
}
