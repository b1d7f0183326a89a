#[path = "shallow_water/analytic.rs"]
mod analytic;
#[path = "shallow_water/cases/mod.rs"]
mod cases;
use freshet_hydro::{shallow_water::*, grid::Grid};
use glam::*;
fn tilted(level: &Grid<f32>, turn: usize) -> Grid<f32> {
    let direction = Vec2::from_angle(2.4 * turn as f32) * (1.5 / 128.0);
    Grid::from_fn(level.size(), level.cell_size(), |cell| {
        level.get(cell).expect("a cell of the grid") + direction.dot(level.position(cell))
    })
    .expect("a valid shape")
}
#[test]
fn speeds() {
  for manning in [0.0, 0.03] {
    let level_bed = cases::terrain::bed();
    let mut water = cases::terrain::land();
    water.fill(1.0).unwrap();
    water.set_manning(manning).unwrap();
    let mut hist = vec![0usize; 12];
    let mut top: Vec<(f32, f32, usize, usize)> = vec![];
    for turn in 0..30 {
        water.set_bed(&tilted(&level_bed, turn)).expect("a finite bed");
        let mut worst = (0.0f32, 0.0f32, 0usize, 0usize);
        let mut t = 0.0; let mut s = 0;
        while t < 60.0 {
            t += water.step(60.0 - t); s += 1;
            let f = water.fastest_signal();
            let b = (f as usize / 5).min(11); hist[b] += 1;
            if f > worst.0 {
                let i = (0..4096).max_by(|&a, &b| water.velocity(a).abs().max_element().total_cmp(&water.velocity(b).abs().max_element())).unwrap();
                worst = (f, water.depths()[i], i, s);
            }
        }
        top.push(worst);
    }
    println!("manning {manning} hist of fastest per 5 m/s: {hist:?}");
    for t in &top { println!("{t:?}"); }
  }
}
