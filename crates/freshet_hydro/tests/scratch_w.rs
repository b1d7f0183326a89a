use freshet_hydro::{shallow_water::*, grid::Grid};
use glam::*;
#[test]
fn tiny() {
    let mut w = ShallowWater::new(&Grid::new(uvec2(8, 8), 1.0, vec![0.0; 64]).unwrap()).unwrap();
    w.set_water(|a, _| (1.0 + 0.01 * a.x, Vec2::ZERO)).unwrap();
    for d in [0.01, 1.0/60.0, 1.0/120.0, 0.1, 0.25, 0.3, 1.0, 0.05] {
        let mut c = [0; 2];
        for _ in 0..100 { let a = w.advance(d, 1000); c[0] += a.steps; c[1] = a.steps;}
        println!("{d}: 100 advances took {} steps", c[0]);
    }
    let mut w2 = w.clone();
    let mut dts = vec![];
    let mut left = 0.01; while left > 0.01*1e-9 { let t = w2.step(left); left -= t; dts.push(t); }
    println!("{dts:?}");
}
