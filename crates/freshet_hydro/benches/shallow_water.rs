//! What a step of the shallow water costs: cell-steps per second on one core and on all, beside the memory's bound in the
//! same run. `cargo bench -p freshet_hydro`.
use freshet_hydro::{grid::Grid, shallow_water::ShallowWater};
use glam::{UVec2, Vec2};
use rayon::{ThreadPool, ThreadPoolBuilder, prelude::*};
use std::time::Instant;

/// Bytes that a step reads and writes for a cell: depth, carry, two discharges and the bed; the first four again.
const BYTES: f64 = 20.0 + 16.0;
/// Cell-steps of a measurement.
const WORK: u64 = 1 << 25;
/// Measurements of which the best counts.
const RUNS: u32 = 3;

fn main() {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let pools = [1, cores].map(|threads| ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool"));
    let bounds = pools.each_ref().map(triad);
    println!("triad: {:.1} GB/s on one core, {:.1} GB/s on {cores}; {BYTES} bytes per cell-step", bounds[0], bounds[1]);
    println!("| cells | one core, M cell-steps/s | ns per cell | of the bound | {cores} cores | of one |");
    println!("|---|---|---|---|---|---|");
    for side in [64, 128, 256, 512, 1024, 2048] {
        let [one, all] = pools.each_ref().map(|pool| steps_per_second(pool, side));
        let bound = bounds[0] * 1e9 / BYTES;
        println!(
            "| {side}² | {:.1} | {:.2} | {:.1} % | {:.1} | {:.2} |",
            one / 1e6,
            1e9 / one,
            100.0 * one / bound,
            all / 1e6,
            all / one
        );
    }
}

/// GB/s of a = b + s c over arrays that no cache holds (McCalpin 1995).
fn triad(pool: &ThreadPool) -> f64 {
    const COUNT: usize = 1 << 25;
    let (b, c) = (vec![1.0_f32; COUNT], vec![2.0_f32; COUNT]);
    let mut a = vec![0.0_f32; COUNT];
    let part = COUNT / pool.current_num_threads();
    let mut best = f64::INFINITY;
    for _ in 0..2 * RUNS {
        let start = Instant::now();
        pool.install(|| {
            let parts = a.par_chunks_mut(part).zip(b.par_chunks(part)).zip(c.par_chunks(part));
            parts.for_each(|((a, b), c)| {
                for ((a, b), c) in a.iter_mut().zip(b).zip(c) {
                    *a = b + 3.0 * c;
                }
            });
        });
        best = best.min(start.elapsed().as_secs_f64());
    }
    assert_eq!(std::hint::black_box(&a)[COUNT / 2], 7.0);
    12.0 * COUNT as f64 / best / 1e9
}

/// Cell-steps per second of a lake of side² cells, all wet, with a wave on it and friction.
fn steps_per_second(pool: &ThreadPool, side: u32) -> f64 {
    let bed =
        Grid::from_fn(UVec2::splat(side), 1.0, |cell| 0.01 * cell.x as f32 - 0.2 * (0.3 * cell.y as f32).sin() - 25.0);
    let mut water = ShallowWater::new(&bed.expect("a valid shape")).expect("a finite bed");
    water.set_manning(0.03).expect("a sane roughness");
    water.set_water(|at, bed| (2.0 * (-at.length_squared() / 400.0).exp() - bed, Vec2::ZERO)).expect("a sane state");
    let cells = u64::from(side) * u64::from(side);
    let steps = (WORK / cells).max(4);
    pool.install(|| {
        let mut best = f64::INFINITY;
        for _ in 0..RUNS {
            let start = Instant::now();
            for _ in 0..steps {
                water.step(1e9);
            }
            best = best.min(start.elapsed().as_secs_f64());
        }
        (cells * steps) as f64 / best
    })
}
