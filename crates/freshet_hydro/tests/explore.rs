use freshet_hydro::{grid::Grid, shallow_water::ShallowWater};
use glam::*;
#[test]
fn explore() {
    // triad
    let n = 1<<24; let b = vec![1.0f32; n]; let c = vec![2.0f32; n]; let mut a = vec![0.0f32; n];
    for _ in 0..3 { let t = std::time::Instant::now(); for i in 0..n { a[i] = b[i] + 3.0 * c[i]; } let s = t.elapsed().as_secs_f64(); println!("triad {:.1} GB/s {}", 12.0*n as f64/s/1e9, a[5]); }
    for threads in [1, 2] {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    for size in [64u32, 128, 256, 512, 1024, 2048] {
        let bed = Grid::from_fn(uvec2(size, size), 1.0, |c| -5.0 + 0.01 * (c.x as f32) + (c.y as f32 * 0.3).sin()*0.2).unwrap();
        let mut w = ShallowWater::new(&bed).unwrap();
        w.set_manning(0.03).unwrap();
        w.set_water(|at, bed| ((2.0*(-at.length_squared()/400.0).exp() - bed).max(0.0), Vec2::ZERO)).unwrap();
        let steps = ((1u64<<24) / (size as u64*size as u64)).max(4);
        pool.install(|| {
        for _ in 0..2 { w.step(1e9); }
        let t = std::time::Instant::now();
        for _ in 0..steps { w.step(1e9); }
        let s = t.elapsed().as_secs_f64();
        println!("threads {threads} {size}: {:.1} M cell-steps/s, {:.1} ns", (steps as f64 * size as f64*size as f64)/s/1e6, s*1e9/(steps as f64 * size as f64*size as f64));
        });
    }}
}
