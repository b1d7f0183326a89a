//! How fast the error falls with the size of the cells.
use super::{Run, ShallowWater, bed_grid};
use core::f64::consts::TAU;
use glam::Vec2;

/// Side of the square that repeats, m.
const EXTENT: f64 = 100.0;
/// Time of the comparison, s: a wave crosses half of the square, and is far from breaking.
const DURATION: f64 = 5.0;

/// A smooth wave of 0.2 m in 10 m of water over a smooth bed, both repeating along x and z: from grid to grid the mean
/// error of depth against that of 512² cells falls at least as the cells' side to the power of 1.8.
pub fn of_a_smooth_wave(run: Run) {
    let reference = after(run, 512);
    println!("cells | mean |Δh| (m) | order");
    let mut before = f64::INFINITY;
    for count in [32_u32, 64, 128] {
        let found = after(run, count);
        let exact = averaged(&reference, 512, count);
        let error = found.iter().zip(&exact).map(|(a, b)| (a - b).abs()).sum::<f64>() / found.len() as f64;
        let order = (before / error).log2();
        println!("{count}² | {error:.2e} | {order:.2}");
        assert!(order >= 1.8, "{order}");
        before = error;
    }
}

/// Depths when the wave has run for a while on `count`² cells.
fn after(run: Run, count: u32) -> Vec<f64> {
    let mut water = wave(count);
    run(&mut water, DURATION);
    water.depths().iter().map(|&depth| f64::from(depth)).collect()
}

/// The wave at its start. Depth, bed and discharge are averages over cells, to the fifth order.
fn wave(count: u32) -> ShallowWater {
    let side = EXTENT / f64::from(count);
    let bed = |x: f64, z: f64| 1.5 * (TAU * x / EXTENT).sin() * (TAU * z / EXTENT).cos() - 10.0;
    let rise = |x: f64, z: f64| 0.2 * (TAU * (x + z) / EXTENT).sin() + 0.1 * (TAU * (x - 2.0 * z) / EXTENT).cos();
    let depth = move |x: f64, z: f64| rise(x, z) - bed(x, z);
    let speed = move |x: f64, z: f64| 0.5 + 0.2 * (TAU * (x + z) / EXTENT).sin();
    let grid = bed_grid(count, count, side as f32, |x, z| mean(x, z, side, &bed));
    let mut water = ShallowWater::new(&grid).expect("a finite bed");
    water.set_periodic(true, true);
    let initial = |at: Vec2, _| {
        let (x, z) = (f64::from(at.x), f64::from(at.y));
        let volume = mean(x, z, side, &depth);
        let discharge = mean(x, z, side, &|x, z| depth(x, z) * speed(x, z));
        (volume as f32, Vec2::new((discharge / volume) as f32, 0.0))
    };
    water.set_water(initial).expect("a sane state");
    water
}

/// Mean of a function over the cell of this `side` around (x, z), by Gauss's rule of 3 × 3 points.
fn mean(x: f64, z: f64, side: f64, value: &impl Fn(f64, f64) -> f64) -> f64 {
    let half = 0.5 * side * 0.6_f64.sqrt();
    let points = [(-half, 5.0 / 18.0), (0.0, 8.0 / 18.0), (half, 5.0 / 18.0)];
    points.iter().map(|(a, p)| points.iter().map(|(b, q)| p * q * value(x + a, z + b)).sum::<f64>()).sum()
}

/// Means of the `fine`² cells over each of `count`² cells.
fn averaged(values: &[f64], fine: u32, count: u32) -> Vec<f64> {
    let (fine, count) = (fine as usize, count as usize);
    let times = fine / count;
    let mut sums = vec![0.0; count * count];
    for (index, value) in values.iter().enumerate() {
        sums[index / fine / times * count + index % fine / times] += value / (times * times) as f64;
    }
    sums
}
