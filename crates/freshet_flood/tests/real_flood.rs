//! The project's real flood in assets/flood, as an incremental file and as grids.

use std::path::{Path, PathBuf};

use freshet_flood::raster::Raster;
use freshet_flood::step::Quantity;
use freshet_flood::steps::{Options, Steps, Times};
use glam::uvec2;

/// Time between the steps, s.
const INTERVAL: f64 = 120.0;

fn flood(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/flood").join(file)
}

#[test]
fn the_incremental_file_has_every_step_over_the_terrain() {
    let terrain = Raster::read(flood("terrain.asc.gz")).unwrap();
    let steps = Steps::open(flood("flood.inc.gz"), &Options::default()).unwrap();
    assert!(steps.georeference().is_same(&terrain.georeference));
    assert_eq!(steps.georeference().size, uvec2(150, 226));
    let times: Vec<f64> = steps.iter().map(|step| step.unwrap().time).collect();
    assert_eq!(times.len(), 25);
    for (index, time) in times.into_iter().enumerate() {
        // The file gives hours with six decimals.
        assert!((time - index as f64 * INTERVAL).abs() <= 0.5e-6 * 3600.0 * 1.001, "{time}");
    }
}

#[test]
fn the_depths_of_the_grids_lie_in_the_classes_of_the_incremental_file() {
    let steps = Steps::open(flood("flood.inc.gz"), &Options::default()).unwrap();
    let classes = &steps.header().unwrap().classes[0];
    for index in [4, 12, 24] {
        let step = steps.at(index).unwrap().unwrap();
        let classified = step.get(Quantity::Depth).unwrap();
        let exact = Raster::read(flood(&format!("dm{index:04}.asc.gz"))).unwrap().grid;
        let mut wet = 0;
        for (classified, exact) in classified.values().iter().zip(exact.values()) {
            // Cells that dry up again are of class 0 in the one, and without data in the other.
            if exact.is_nan() {
                assert!(classified.is_nan() || *classified == 0.0);
                continue;
            }
            wet += 1;
            let above = classes.iter().copied().find(|class| class > classified).unwrap_or(f32::INFINITY);
            assert!((*classified..=above).contains(exact), "{exact} in {classified} to {above}");
        }
        assert!(wet > 1000);
    }
}

#[test]
fn the_grids_hold_the_water_that_came_in() {
    let steps = Steps::open(flood(""), &Options { times: Times::Every(INTERVAL), ..Options::default() }).unwrap();
    assert_eq!(steps.left_out().len(), 1);
    let last = steps.at(2).unwrap().unwrap();
    let depths = last.get(Quantity::Depth).unwrap();
    let volume: f64 =
        depths.values().iter().filter(|depth| !depth.is_nan()).map(|depth| f64::from(*depth) * 16.0).sum();
    // 60 m³/s for 48 minutes.
    assert!((volume / 172_800.0 - 1.0).abs() < 0.001, "{volume}");
}
