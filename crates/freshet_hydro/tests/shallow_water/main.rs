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

cases::every_case!(on_the_cpu);

#[test]
fn the_volume_of_a_shaken_basin_is_kept_for_100_000_steps() {
    let mut steps = 0;
    cases::volume::in_a_basin_that_is_shaken(&mut |water, duration| steps += water.advance(duration, u32::MAX).steps);
    println!("{steps} steps");
    assert!(steps >= 100_000);
}
