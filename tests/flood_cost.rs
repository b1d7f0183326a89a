//! What floods of many cells cost while they are played.
use crate::{simulated::server, stage::Stage};
use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_freshet::{
    flood::{FloodMaps, FloodState},
    prelude::*,
};
use freshet_flood::{
    conversion::{Options, convert},
    esri_ascii::EsriGrid,
    raster::Raster,
    steps::{self, Steps, Times},
};
use freshet_hydro::grid::Grid;
use std::{
    path::Path,
    sync::Arc,
    time::{Duration, Instant},
};
use tempfile::TempDir;

/// Seconds of the data from one step to the next.
const STEP: f64 = 300.0;

/// A valley of `side` × `side` cells, down which a front of water goes in four steps.
fn valley(folder: &Path, side: u32) -> Arc<FloodMaps> {
    let bed = |cell: UVec2| {
        let (x, z) = (cell.x as f32 / side as f32 - 0.5, cell.y as f32 / side as f32);
        40.0 * x.abs() - 10.0 * z + 0.3 * (40.0 * x).sin() * (53.0 * z).sin()
    };
    let write = |name: String, value: &dyn Fn(UVec2) -> f32| {
        let grid = Grid::from_fn(UVec2::splat(side), 5.0, value).unwrap();
        EsriGrid { corner: default(), grid }.write(folder.join(name)).unwrap();
    };
    for step in 0..4 {
        let depth = |cell: UVec2| {
            let z = cell.y as f32 / side as f32;
            let level = (5.0 - 10.0 * z).min(5.0 + 120.0 * (0.25 * (step + 1) as f32 - z));
            let depth = level - bed(cell);
            if depth > 0.02 { (100.0 * depth).round() / 100.0 } else { 0.0 }
        };
        write(format!("dm{step}.asc"), &depth);
    }
    write("terrain.asc".into(), &bed);
    let steps = Steps::open(folder, &steps::Options { times: Times::Every(STEP), ..default() }).unwrap();
    let terrain = Raster::read(folder.join("terrain.asc")).unwrap();
    let out = folder.join("out");
    convert(&steps, Some(("terrain.asc", &terrain)), &Options::default(), &out, |_| {}).unwrap();
    Arc::new(FloodMaps::open(out).unwrap())
}

/// Milliseconds of the frames in which the flood is played at 60 Hz, sorted; and of how many frames the water was late.
fn play(app: &mut App, maps: &Arc<FloodMaps>) -> (Vec<f64>, u32) {
    app.world_mut().spawn(Flood::bed(maps).unwrap());
    let mut flood = Flood::new(maps.clone());
    (flood.playing, flood.speed) = (false, 60.0);
    let water = app.world_mut().spawn(Flood::water(maps)).insert(flood).id();
    let frame = Duration::from_secs_f64(1.0 / 60.0);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(frame));
    let (mut spent, mut late) = (Vec::new(), 0);
    loop {
        let start = Instant::now();
        app.update();
        let took = start.elapsed();
        std::thread::sleep(frame.saturating_sub(took));
        let world = app.world_mut();
        let is_late = world.get::<FloodState>(water).is_none_or(FloodState::is_late);
        let mut flood = world.get_mut::<Flood>(water).unwrap();
        if !flood.playing {
            if spent.is_empty() {
                // It begins when its first part is there.
                flood.playing = !is_late;
                continue;
            }
            spent.sort_by(f64::total_cmp);
            return (spent, late);
        }
        spent.push(1e3 * took.as_secs_f64());
        late += u32::from(is_late);
    }
}

#[test]
#[ignore = "measures"]
fn what_large_floods_cost() {
    println!(
        "ms a frame at 60 Hz, over three intervals of five seconds\n| cells | drawn | median | 99 % | most | late frames |\n|---|---|---|---|---|---|"
    );
    for side in [316, 1000, 3162] {
        let folder = TempDir::new().unwrap();
        let maps = valley(folder.path(), side);
        // Drawing ten million cells takes a software renderer a second.
        for is_drawn in [false, true].into_iter().filter(|is_drawn| !is_drawn || side <= 1000) {
            let (spent, late) = match is_drawn {
                false => play(&mut server(), &maps),
                true => {
                    let mut stage = Stage::new();
                    stage.settle();
                    play(&mut stage.app, &maps)
                }
            };
            assert!(is_drawn || late == 0, "{late} frames of {side}² are late");
            let at = |share: f64| spent[((spent.len() - 1) as f64 * share) as usize];
            println!(
                "| {side}² | {is_drawn} | {:.2} | {:.2} | {:.2} | {late} of {} |",
                at(0.5),
                at(0.99),
                at(1.0),
                spent.len()
            );
        }
    }
}
