//! The real flood in assets/flood with steps left out: the front moves to where it was.

use std::path::Path;

use freshet_flood::step::Quantity;
use freshet_flood::steps::{Options, Steps};
use freshet_hydro::grid::Grid;
use glam::uvec2;

#[test]
fn the_front_beats_blending_and_the_nearest_step_on_a_real_flood() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/flood/flood.inc.gz");
    let steps = Steps::open(file, &Options::default()).unwrap();
    let depth = |step: freshet_flood::step::Step| step.get(Quantity::Depth).unwrap().map(|depth| depth.max(0.0));
    let steps: Vec<Grid<f32>> = steps.iter().map(|step| depth(step.unwrap())).collect();
    for every in [2, 3, 4] {
        let rows = crate::leave_one_out::scores(&steps, every).unwrap();
        let ours = &rows[4];
        // Twelve classes tell the rise of the water badly: with its depths in full a third to two thirds are missed less.
        for (way, row) in crate::leave_one_out::WAYS.iter().zip(&rows).take(3) {
            assert!(ours.all.f1() > row.all.f1() && ours.steps.len() == 24 / every * (every - 1), "{way}, {every}");
            let missed = |row: &crate::leave_one_out::Row| 1.0 - row.later.f1();
            assert!(missed(ours) < 0.85 * missed(row), "{way}, {every}: {} {}", missed(ours), missed(row));
            assert!(ours.turning.f1() > row.turning.f1() + 0.05, "{way}, {every}");
            assert!(ours.later.error() < 1.05 * row.later.error(), "{way}, {every}");
        }
    }
}

#[test]
fn a_tide_on_a_beach_comes_and_goes_in_time() {
    // An uneven beach, and a tide that rises and falls by 1 m in 13 steps.
    let bed = |x: f32, y: f32| 0.05 * x + 0.15 * (0.3 * x + 0.5 * y).sin();
    let level = |step: u32| 2.0 + (step as f32 / 13.0 * std::f32::consts::TAU).sin();
    let depth = |step: u32| {
        Grid::from_fn(uvec2(80, 40), 5.0, |cell| (level(step) - bed(cell.x as f32, cell.y as f32)).max(0.0)).unwrap()
    };
    let steps: Vec<Grid<f32>> = (0..41).map(depth).collect();
    let rows = crate::leave_one_out::scores(&steps, 2).unwrap();
    for row in &rows[..3] {
        assert!(rows[4].later.f1() > row.later.f1() && rows[4].turning.f1() > row.turning.f1() + 0.1, "{rows:?}");
    }
}
