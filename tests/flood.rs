//! Floods that are played back: asked, felt and drawn as their data says.
use crate::{
    said::complaints,
    simulated::{run, server},
    stage::{SIZE, Stage},
};
use bevy::{ecs::system::RunSystemOnce, prelude::*};
use bevy_freshet::{flood::FloodMaps, prelude::*, surface::SurfaceView};
use freshet_flood::{
    conversion::{Crop, Options, convert},
    esri_ascii::EsriGrid,
    raster::Raster,
    steps::{self, Steps, Times},
};
use freshet_hydro::grid::Grid;
use std::{path::Path, sync::Arc};
use tempfile::TempDir;

/// Columns and rows of the plain, of 2 m.
const PLAIN: UVec2 = UVec2::new(60, 40);
/// Column of the dike that closes the plain.
const DIKE: u32 = 45;

/// A plain at 1 m with a dike of one cell, over which water of 1.5 m comes from the west at 0.5 m/s: 10 columns a minute.
fn plain(folder: &Path, count: u32) -> Arc<FloodMaps> {
    let write = |name: String, value: &dyn Fn(UVec2) -> f32| {
        let grid = Grid::from_fn(PLAIN, 2.0, value).unwrap();
        EsriGrid { corner: default(), grid }.write(folder.join(name)).unwrap();
    };
    for step in 0..count {
        let is_wet = move |cell: UVec2| cell.x < (10 + 10 * step).min(DIKE);
        write(format!("dm{step:04}.asc"), &|cell| if is_wet(cell) { 1.5 } else { 0.0 });
        write(format!("u{step:04}.asc"), &|cell| if is_wet(cell) { 0.5 } else { 0.0 });
        write(format!("v{step:04}.asc"), &|_| 0.0);
    }
    write("terrain.asc".into(), &|cell| if cell.x == DIKE { 4.0 } else { 1.0 });
    let steps = Steps::open(folder, &steps::Options { times: Times::Every(60.0), ..default() }).unwrap();
    let terrain = Raster::read(folder.join("terrain.asc")).unwrap();
    let (out, options) = (folder.join("out"), Options { crop: Crop::All, ..default() });
    convert(&steps, Some(("terrain.asc", &terrain)), &options, &out, |_| {}).unwrap();
    Arc::new(FloodMaps::open(out).unwrap())
}

/// The real flood of the examples.
fn real() -> Arc<FloodMaps> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/flood/played");
    Arc::new(FloodMaps::open(folder).unwrap())
}

/// A server on which a flood stands still.
fn shown(maps: &Arc<FloodMaps>) -> (App, Entity) {
    let mut app = server();
    app.world_mut().spawn(Flood::bed(maps).unwrap());
    let water = app.world_mut().spawn(Flood::water(maps)).id();
    change(&mut app, water, |flood| (flood.playing, flood.waits) = (false, true));
    (app, water)
}

fn change(app: &mut App, water: Entity, change: impl FnOnce(&mut Flood)) {
    change(&mut app.world_mut().get_mut::<Flood>(water).unwrap());
}

/// Shows the flood at a time.
fn seek(app: &mut App, water: Entity, time: f64) {
    change(app, water, |flood| flood.time = time);
    run(app, 1.01 / 60.0);
}

fn time(app: &App, water: Entity) -> f64 {
    app.world().get::<Flood>(water).unwrap().time
}

/// The water at the middle of every cell, and the middle.
fn cells(app: &mut App, grid: &Grid<f32>) -> Vec<Option<WaterSample>> {
    let places: Vec<Vec2> = grid.cells().map(|cell| grid.position(cell)).collect();
    let all = move |water: WaterQuery| {
        places.iter().map(|place| water.sample(vec3(place.x, 0.0, place.y))).collect::<Vec<_>>()
    };
    app.world_mut().run_system_once(all).unwrap()
}

#[test]
fn depth_and_height_are_those_of_the_data_at_steps_and_between() {
    let maps = real();
    let (mut app, water) = shown(&maps);
    let terrain = maps.terrain().unwrap();
    for time in [240.0, 960.0, 2880.0, 300.0, 1111.0] {
        seek(&mut app, water, time);
        let depth = maps.depth_at(time).unwrap();
        let found = cells(&mut app, &depth);
        let mut wet = 0;
        for ((found, depth), ground) in found.iter().zip(depth.values()).zip(terrain.values()) {
            if *depth < maps.threshold() {
                assert!(found.is_none(), "{time} s: {found:?} where it is dry");
                continue;
            }
            let found = found.unwrap();
            assert!((found.depth - depth).abs() < 2e-3, "{time} s: {found:?} for {depth} m");
            assert!((found.height - (ground + depth)).abs() < 2e-3, "{time} s: {found:?} for {ground} m + {depth} m");
            wet += 1;
        }
        assert!(wet > 300, "{time} s: {wet} cells");
    }
}

#[test]
fn nothing_leaks_through_a_thin_dike_or_climbs_it() {
    let folder = TempDir::new().unwrap();
    let maps = plain(folder.path(), 6);
    let (mut app, water) = shown(&maps);
    for time in [0.0, 90.0, 200.0, 300.0] {
        seek(&mut app, water, time);
        let depth = maps.depth_at(time).unwrap();
        // Eight places in every cell, along the middle.
        let row = (0..8 * PLAIN.x).map(|eighth| (eighth as f32 + 0.5) / 4.0 - PLAIN.x as f32);
        let places: Vec<Vec2> = row.map(|x| vec2(x, 1.0)).collect();
        let asked = places.clone();
        let sample = move |water: WaterQuery| {
            asked.iter().map(|place| water.sample(vec3(place.x, 0.0, place.y))).collect::<Vec<_>>()
        };
        for (place, found) in places.iter().zip(app.world_mut().run_system_once(sample).unwrap()) {
            let column = (place.x / 2.0 + PLAIN.x as f32 / 2.0) as u32;
            assert!(column < DIKE || found.is_none(), "{time} s, column {column}: {found:?}");
            if let Some(found) = found {
                assert!(found.height < 2.501, "{time} s, column {column}: {found:?}");
            }
        }
        assert!(depth.values().iter().any(|depth| *depth > 1.0));
    }
}

#[test]
fn it_plays_pauses_seeks_steps_and_loops() {
    let folder = TempDir::new().unwrap();
    let maps = plain(folder.path(), 4);
    let (mut app, water) = shown(&maps);
    change(&mut app, water, |flood| (flood.playing, flood.speed) = (true, 30.0));
    run(&mut app, 2.01);
    let played = time(&app, water);
    assert!((played - 60.0).abs() < 1.1, "{played} s");
    change(&mut app, water, |flood| flood.playing = false);
    run(&mut app, 1.0);
    assert_eq!(time(&app, water), played);
    // At its end it stops.
    change(&mut app, water, |flood| (flood.playing, flood.time) = (true, 179.0));
    run(&mut app, 1.0);
    assert_eq!(time(&app, water), 180.0);
    assert!(!app.world().get::<Flood>(water).unwrap().playing);
    // Or begins anew, forwards and backwards.
    for (speed, start) in [(30.0, 170.0), (-30.0, 10.0)] {
        change(&mut app, water, |flood| {
            (flood.playing, flood.looping, flood.speed, flood.time) = (true, true, speed, start);
        });
        run(&mut app, 1.01);
        let expected = (start + f64::from(speed)).rem_euclid(180.0);
        assert!((time(&app, water) - expected).abs() < 1.1, "{} s for {expected} s", time(&app, water));
    }
    change(&mut app, water, |flood| (flood.time, flood.looping) = (70.0, false));
    for (count, expected) in [(1, 120.0), (1, 180.0), (1, 180.0), (-2, 60.0), (-1, 0.0), (-1, 0.0)] {
        change(&mut app, water, |flood| flood.step(count));
        assert_eq!(time(&app, water), expected);
    }
    change(&mut app, water, |flood| flood.time = 70.0);
    change(&mut app, water, |flood| flood.step(-1));
    assert_eq!(time(&app, water), 60.0);
}

#[test]
fn steps_are_read_in_the_background() {
    let maps = real();
    let (mut app, water) = shown(&maps);
    change(&mut app, water, |flood| (flood.waits, flood.time) = (false, 2400.0));
    let depth = maps.depth_at(2400.0).unwrap();
    // Nothing is there at first, and soon everything is, though no frame waits for it.
    for _ in 0..1000 {
        run(&mut app, 1.01 / 60.0);
        if cells(&mut app, &depth).iter().any(Option::is_some) {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let wet = cells(&mut app, &depth).iter().filter(|found| found.is_some()).count();
    assert_eq!(wet, depth.values().iter().filter(|depth| **depth >= maps.threshold()).count());
}

#[test]
fn a_flood_of_one_step_stands() {
    let folder = TempDir::new().unwrap();
    let maps = plain(folder.path(), 2);
    let mut manifest = maps.manifest().clone();
    manifest.steps.truncate(1);
    std::fs::write(maps.folder().join("flood.ron"), ron::to_string(&manifest).unwrap()).unwrap();
    let maps = Arc::new(FloodMaps::open(maps.folder()).unwrap());
    let (mut app, water) = shown(&maps);
    change(&mut app, water, |flood| flood.playing = true);
    run(&mut app, 0.5);
    assert_eq!(time(&app, water), 0.0);
    let depth = maps.depth(0).unwrap();
    let wet = cells(&mut app, &depth).iter().flatten().filter(|found| (found.depth - 1.5).abs() < 2e-3).count();
    assert_eq!(wet, 400);
}

#[test]
fn what_cannot_be_read_is_said_once() {
    let folder = TempDir::new().unwrap();
    assert!(FloodMaps::open(folder.path()).unwrap_err().to_string().contains("flood.ron"));
    let maps = plain(folder.path(), 4);
    std::fs::remove_file(folder.path().join("out/depth/0002.png")).unwrap();
    let (mut app, water) = shown(&maps);
    let said = complaints(&mut app, |app| {
        seek(app, water, 30.0);
        let depth = maps.depth_at(30.0).unwrap();
        assert!(cells(app, &depth).iter().any(Option::is_some));
        for time in [100.0, 110.0, 170.0, 30.0, 100.0, f64::NAN, f64::INFINITY] {
            seek(app, water, time);
        }
    });
    assert_eq!(said.iter().filter(|line| line.contains("0002.png")).count(), 1, "{said:#?}");
    assert!(said.len() <= 2, "the time that is no number is the other: {said:#?}");
    // It is passed over.
    change(&mut app, water, |flood| (flood.playing, flood.time, flood.waits) = (true, 0.0, false));
    for _ in 0..2000 {
        run(&mut app, 1.01 / 60.0);
        if time(&app, water) >= 180.0 {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert_eq!(time(&app, water), 180.0);
}

#[test]
fn beside_a_simulation_nothing_is_played_and_without_a_flood_the_water_is_still() {
    let folder = TempDir::new().unwrap();
    let maps = plain(folder.path(), 2);
    let (mut app, water) = shown(&maps);
    seek(&mut app, water, 30.0);
    let depth = maps.depth(0).unwrap();
    let wet = |app: &mut App| cells(app, &depth).iter().flatten().count();
    assert!(wet(&mut app) > 400);
    let said = complaints(&mut app, |app| {
        app.world_mut().entity_mut(water).insert(WaterSimulation { start: SimulationStart::Dry, ..default() });
        run(app, 0.1);
        assert_eq!(wet(app), 0);
    });
    assert_eq!(said.len(), 1, "{said:#?}");
    app.world_mut().entity_mut(water).remove::<WaterSimulation>();
    run(&mut app, 0.1);
    assert!(wet(&mut app) > 400, "it is played again");
    app.world_mut().entity_mut(water).remove::<Flood>();
    run(&mut app, 0.1);
    // The still level is that of the terrain's zero.
    assert_eq!(wet(&mut app), 0);
}

#[cfg(feature = "rapier")]
#[test]
fn a_crate_floats_at_its_draft_and_drifts_with_the_current() {
    use bevy_rapier3d::prelude::*;
    let folder = TempDir::new().unwrap();
    let maps = plain(folder.path(), 4);
    let (mut app, water) = shown(&maps);
    seek(&mut app, water, 180.0);
    let crate_ = (RigidBody::Dynamic, Collider::cuboid(0.5, 0.3, 0.5), Floating::with_density(400.0));
    let crate_ = app.world_mut().spawn((crate_, Transform::from_xyz(-40.0, 2.5, 0.0))).id();
    run(&mut app, 20.0);
    let start = app.world().get::<Transform>(crate_).unwrap().translation;
    // 40 % of it is under water, whose level is 2.5 m.
    assert!((start.y - 2.56).abs() < 0.02, "{start}");
    assert!((app.world().get::<Buoyancy>(crate_).unwrap().draft - 0.24).abs() < 0.03);
    run(&mut app, 10.0);
    let way = app.world().get::<Transform>(crate_).unwrap().translation - start;
    assert!((way.x - 5.0).abs() < 0.5 && way.z.abs() < 0.2, "{way}");
}

/// Which pixels show water.
fn wet_pixels(stage: &mut Stage, camera: Entity) -> Vec<bool> {
    stage.picture(camera).pixels().map(|(_, color)| color.max_element() > 0.05).collect()
}

#[test]
fn the_front_is_drawn_where_it_is() {
    let maps = real();
    let mut stage = Stage::new();
    // The ground is black, and hides the water that goes on beneath it.
    stage.spawn((Flood::bed(&maps).unwrap(), BedShading::default()));
    let water = stage.spawn(Flood::water(&maps));
    stage.app.world_mut().get_mut::<WaterSurface>(water).unwrap().view = SurfaceView::Edge;
    change(&mut stage.app, water, |flood| (flood.playing, flood.waits, flood.time) = (false, true, 1100.0));
    let camera = stage.camera_above(vec3(125.0, 10.0, -90.0), 64.0);
    let drawn = wet_pixels(&mut stage, camera);
    let place = |index: usize| {
        let pixel = vec2((index % SIZE.x as usize) as f32, (index / SIZE.x as usize) as f32) + 0.5;
        (pixel - SIZE.as_vec2() / 2.0) * (64.0 / SIZE.x as f32) + vec2(125.0, -90.0)
    };
    let places: Vec<Vec2> = (0..drawn.len()).map(place).collect();
    let asked = move |water: WaterQuery| {
        let depth = |place: &Vec2| water.sample(vec3(place.x, 0.0, place.y)).map_or(0.0, |found| found.depth);
        places.iter().map(depth).collect::<Vec<f32>>()
    };
    let felt = stage.app.world_mut().run_system_once(asked).unwrap();
    // The ground is drawn in triangles, which may hide a film of water.
    let [wet, deep] = [0.0, 0.06].map(|least| felt.iter().map(|depth| *depth > least).collect::<Vec<_>>());
    let count = |pixels: &[bool]| pixels.iter().filter(|pixel| **pixel).count();
    assert!(count(&deep) > 10_000 && count(&wet) < felt.len() - 5000, "{} deep, {} wet", count(&deep), count(&wet));
    // What is drawn is wet, and what is deep is drawn, within two pixels.
    let near = |pixels: &[bool], index: usize| {
        let (x, y) = ((index % SIZE.x as usize) as i32, (index / SIZE.x as usize) as i32);
        (0..25).map(|k| (x + k % 5 - 2, y + k / 5 - 2)).any(|(x, y)| {
            let is_inside = (0..SIZE.x as i32).contains(&x) && (0..SIZE.y as i32).contains(&y);
            is_inside && pixels[(y * SIZE.x as i32 + x) as usize]
        })
    };
    let off = (0..felt.len()).filter(|&at| (drawn[at] && !near(&wet, at)) || (deep[at] && !near(&drawn, at))).count();
    println!("{} pixels are wet, {} deep, {} drawn, {off} off", count(&wet), count(&deep), count(&drawn));
    assert_eq!(off, 0);
}
