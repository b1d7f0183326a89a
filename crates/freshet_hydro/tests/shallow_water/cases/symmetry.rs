//! No direction is preferred, and no size of cells.
use super::{Run, ShallowWater, land, still};
use core::f64::consts::TAU;
use freshet_hydro::waves::GRAVITY;

/// Side of the square in which a round dam breaks, m.
const EXTENT: f64 = 40.0;

/// A round dam that breaks in the middle of a square: turned by 90° and mirrored, the water is the same up to
/// round-off, and the mean error against 512² cells falls with the cells' side.
pub fn a_round_dam(run: Run) {
    let reference = after_round_dam(run, 512);
    println!("round dam: cells | differs when turned (m) | mirrored (m) | mean |Δh| (m) | order");
    let mut before = f64::INFINITY;
    for count in [64_u32, 128, 256] {
        let depths = after_round_dam(run, count);
        let n = count as usize;
        let turned = largest_difference(&depths, |column, row| (n - 1 - column) * n + row);
        let mirrored = largest_difference(&depths, |column, row| row * n + n - 1 - column);
        let error = mean_error(&depths, &reference, n, 512);
        let order = (before / error).log2();
        println!("{count}² | {turned:.1e} | {mirrored:.1e} | {error:.5} | {order:.2}");
        assert!(turned <= 4e-6 && mirrored <= 4e-6, "{turned} {mirrored}");
        assert!(order > 1.0, "{order}");
        before = error;
    }
}

/// Depths on `count`² cells when 2 m of water within a circle have fallen onto 0.5 m around for 2.5 s.
fn after_round_dam(run: Run, count: u32) -> Vec<f64> {
    let mut water = land(count, count, EXTENT as f32 / count as f32, |_, _| 0.0);
    let side = EXTENT / f64::from(count);
    water
        .set_water(|at, _| still(0.5 + 1.5 * share_inside(f64::from(at.x), f64::from(at.y), side)))
        .expect("a sane depth");
    run(&mut water, 2.5);
    water.depths().iter().map(|&depth| f64::from(depth)).collect()
}

/// Share of a cell around (x, z) within the circle, by 8 × 8 points.
fn share_inside(x: f64, z: f64, side: f64) -> f64 {
    let offset = |k: u32| ((f64::from(k) + 0.5) / 8.0 - 0.5) * side;
    let inside = |i: u32| (0..8).filter(|&j| (x + offset(i)).hypot(z + offset(j)) < 8.0).count();
    (0..8).map(inside).sum::<usize>() as f64 / 64.0
}

/// Largest difference to the cell that a (column, row) goes to.
fn largest_difference(depths: &[f64], to: impl Fn(usize, usize) -> usize) -> f64 {
    let n = depths.len().isqrt();
    (0..depths.len()).map(|index| (depths[index] - depths[to(index % n, index / n)]).abs()).fold(0.0, f64::max)
}

/// Mean difference to the means of `fine`² cells.
fn mean_error(depths: &[f64], reference: &[f64], n: usize, fine: usize) -> f64 {
    let times = fine / n;
    let mut exact = vec![0.0; n * n];
    for (index, value) in reference.iter().enumerate() {
        exact[index / fine / times * n + index % fine / times] += value / (times * times) as f64;
    }
    depths.iter().zip(&exact).map(|(a, b)| (a - b).abs()).sum::<f64>() / depths.len() as f64
}

/// A flood down a valley with a rough and uneven bed reaches a place at the same time on 64, 128 and 256 cells, and so
/// does a small wave.
pub fn times_do_not_depend_on_the_grid(run: Run) {
    println!("cells | flood of 0.02, 0.1 m arrives (s) | small wave's speed (m/s) of {:.4}", small_celerity());
    let found = [64_u32, 128, 256].map(|count| {
        let arrivals = arrivals(run, count);
        let speed = small_wave_speed(run, count);
        println!("{count} | {arrivals:.2?} | {speed:.4}");
        (arrivals, speed)
    });
    for (arrivals, speed) in &found {
        for (arrival, finest) in arrivals.iter().zip(&found[2].0) {
            assert!((arrival / finest - 1.0).abs() <= 0.02, "{arrival} {finest}");
        }
        assert!((speed / small_celerity() - 1.0).abs() <= 0.005, "{speed}");
    }
}

/// When the flood after the break of a dam is 0.02 and 0.1 m deep, 430 m below the dam, s.
fn arrivals(run: Run, count: u32) -> [f64; 2] {
    let side = 640.0 / f64::from(count);
    let bed =
        |x: f64, z: f64| 0.2 * (TAU * x / 97.0).sin() * (TAU * z / 130.0).cos() + 0.004 * z * z / 10.0 - 0.005 * x;
    let mut water = land(count, count / 8, side as f32, bed);
    water.set_manning(0.03).expect("a sane roughness");
    water.set_water(|at, bed| still(if at.x < -240.0 { f64::from((5.0 - bed).max(0.0)) } else { 0.0 })).expect("sane");
    let mut before = 0.0;
    let mut arrivals = [f64::NAN; 2];
    for turn in 0..600 {
        let depth = depth_at(&water, 190.0);
        for (arrival, threshold) in arrivals.iter_mut().zip([0.02, 0.1]) {
            if before < threshold && depth >= threshold && arrival.is_nan() {
                *arrival = 0.25 * (f64::from(turn) - (depth - threshold) / (depth - before));
            }
        }
        before = depth;
        run(&mut water, 0.25);
    }
    arrivals
}

/// Depth between the cells around (x, 0), m.
fn depth_at(water: &ShallowWater, x: f64) -> f64 {
    let (columns, rows) = (water.size().x as usize, water.size().y as usize);
    let at = x / f64::from(water.cell_size()) + columns as f64 / 2.0 - 0.5;
    let (column, share) = (at as usize, at.fract());
    let depth = |column: usize| {
        let index = |row: usize| row * columns + column;
        0.5 * f64::from(water.depths()[index(rows / 2 - 1)] + water.depths()[index(rows / 2)])
    };
    (1.0 - share) * depth(column) + share * depth(column + 1)
}

/// √(g h) of the small wave, m/s.
fn small_celerity() -> f64 {
    (f64::from(GRAVITY) * 5.0).sqrt()
}

/// Speed of the middle of a rise of 1 cm in 5 m of water, whose length is a tenth of the channel, m/s.
fn small_wave_speed(run: Run, count: u32) -> f64 {
    let mut water = land(count, 3, 640.0 / count as f32, |_, _| -5.0);
    let pulse = |at: glam::Vec2, _| {
        let rise = 0.01 * (-0.5 * (f64::from(at.x + 160.0) / 25.0).powi(2)).exp();
        ((5.0 + rise) as f32, glam::Vec2::new((rise * small_celerity() / 5.0) as f32, 0.0))
    };
    water.set_water(pulse).expect("a sane wave");
    let middle = |water: &ShallowWater| {
        let rise = |column: usize| f64::from(water.depths()[column]) - 5.0;
        let weights: Vec<f64> = (0..count as usize).map(|column| rise(column).max(0.002) - 0.002).collect();
        let moment = |(column, weight): (usize, &f64)| weight * super::place(water, column)[0];
        weights.iter().enumerate().map(moment).sum::<f64>() / weights.iter().sum::<f64>()
    };
    let from = middle(&water);
    run(&mut water, 40.0);
    (middle(&water) - from) / 40.0
}
