//! Dams that break.
use super::super::analytic::{dam_break, shock_speed};
use super::{Run, land, place, still};

/// A channel of 1 m in 400 cells, the dam in the middle, 1 m of water left of it, t = 0.06 s: the mean error of depth
/// stays below that of ANUGA's scheme DE1 with four triangles per cell (0.085 %).
pub fn ritter_and_stoker(run: Run) {
    println!("dam break, 400 cells, along | depth right (m) | mean |Δh| / h_l (%) | shock off by (cells)");
    for along_z in [false, true] {
        for right in [0.0, 0.1] {
            let (columns, rows) = if along_z { (4, 400) } else { (400, 4) };
            let mut water = land(columns, rows, 1.0 / 400.0, |_, _| 0.0);
            let along = |at: [f64; 2]| at[usize::from(along_z)];
            water
                .set_water(|at, _| still(if at[usize::from(along_z)] < 0.0 { 1.0 } else { right }))
                .expect("a sane depth");
            run(&mut water, 0.06);
            let exact = |index| dam_break(1.0, right, along(place(&water, index)), 0.06).0;
            let error = |index: usize| (f64::from(water.depths()[index]) - exact(index)).abs();
            let count = water.depths().len();
            let mean = (0..count).map(error).sum::<f64>() / count as f64;
            let shock = if right > 0.0 { shock_offset(&water, right, along) } else { 0.0 };
            println!("{} | {right} | {:.4} | {shock:.2}", if along_z { "z" } else { "x" }, 100.0 * mean);
            assert!(mean < 0.00085, "{mean}");
            assert!(shock.abs() < 2.0, "{shock}");
        }
    }
}

/// By how many cells the shock is ahead of the exact one.
fn shock_offset(water: &super::ShallowWater, right: f64, along: impl Fn([f64; 2]) -> f64) -> f64 {
    let plateau = dam_break(1.0, right, 0.1, 0.06).0;
    let half = (0.5 * (plateau + right)) as f32;
    let found = (0..water.depths().len())
        .filter(|&index| water.depths()[index] > half)
        .map(|index| along(place(water, index)))
        .fold(f64::NEG_INFINITY, f64::max);
    let side = f64::from(water.cell_size());
    (found + 0.5 * side - shock_speed(1.0, right) * 0.06) / side
}
