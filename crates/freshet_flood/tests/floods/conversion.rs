//! Floods converted, and read again.

use std::fs;
use std::path::{Path, PathBuf};

use crate::known::{WET, flood, ring};
use freshet_flood::arrival::ArrivalOptions;
use freshet_flood::conversion::{ConversionError, Crop, Options, Part, Progress, convert};
use freshet_flood::esri_ascii::EsriGrid;
use freshet_flood::maps::{FILE, FloodMaps, Map, MapsError};
use freshet_flood::raster::Raster;
use freshet_flood::step::{Quantity, Step};
use freshet_flood::steps::{self, Steps, Times};
use freshet_hydro::grid::Grid;
use glam::{DVec2, Vec3, dvec2, uvec2, vec2};
use tempfile::TempDir;

const CORNER: DVec2 = dvec2(105_000.0, 530_000.0);

/// Writes depths, speeds, and east and north velocities of a ring that spreads, and the terrain under it.
fn write_ring(folder: &Path) -> Vec<Step> {
    let steps = flood(uvec2(60, 50), 6, 60.0, ring(vec2(30.0, 20.0), 0.06));
    let write = |name: String, grid: &Grid<f32>| {
        EsriGrid { corner: CORNER, grid: grid.clone() }.write(folder.join(name)).unwrap();
    };
    for (index, step) in steps.iter().enumerate() {
        let depth = step.get(Quantity::Depth).unwrap();
        write(format!("dm{index:04}.asc"), depth);
        write(format!("c{index:04}.asc"), &depth.map(|depth| if *depth >= WET { 0.5 + 0.1 * depth } else { f32::NAN }));
    }
    let terrain = Grid::from_fn(uvec2(60, 50), 5.0, |cell| 2.0 - 0.1 * cell.y as f32).unwrap();
    write("terrain.asc".into(), &terrain);
    steps
}

fn every(seconds: f64) -> steps::Options {
    steps::Options { times: Times::Every(seconds), ..Default::default() }
}

fn converted(folder: &Path, options: &Options) -> FloodMaps {
    let (steps, terrain) =
        (Steps::open(folder, &every(60.0)).unwrap(), Raster::read(folder.join("terrain.asc")).unwrap());
    let out = folder.join("out");
    convert(&steps, Some(("terrain.asc", &terrain)), options, &out, |_| {}).unwrap();
    FloodMaps::open(out).unwrap()
}

#[test]
fn steps_come_back_within_the_precision_and_the_front_moves_between_them() {
    let folder = TempDir::new().unwrap();
    let steps = write_ring(folder.path());
    for precision in [0.001, 0.013, 0.5] {
        let options = Options { crop: Crop::All, precision, ..Options::default() };
        let maps = converted(folder.path(), &options);
        assert_eq!(maps.times(), [0.0, 60.0, 120.0, 180.0, 240.0, 300.0]);
        assert_eq!((maps.georeference().corner, maps.georeference().size), (CORNER, uvec2(60, 50)));
        let mut wet_before = 0;
        for (index, step) in steps.iter().enumerate() {
            let (expected, found) = (step.get(Quantity::Depth).unwrap(), maps.depth_at(step.time).unwrap());
            assert!(found == maps.depth(index).unwrap());
            for (expected, found) in expected.values().iter().zip(found.values()) {
                assert!(f64::from((expected - found).abs()) <= precision / 2.0 + 1e-6, "{expected} {found}");
                assert!((*expected == 0.0) == (*found == 0.0) && (*expected >= WET) == (*found >= WET));
            }
            // A third of an interval later more is wet, and all of it at the next step too.
            let later = maps.depth_at(step.time + 20.0).unwrap();
            let wet = later.values().iter().filter(|depth| **depth >= WET).count();
            assert!(wet > wet_before || index == 0 || index == 5);
            wet_before = wet;
            let next = maps.depth((index + 1).min(5)).unwrap();
            for (later, next) in later.values().iter().zip(next.values()) {
                assert!(*later < WET || *next >= WET);
            }
        }
        assert!(maps.depth_at(-5.0).unwrap() == maps.depth(0).unwrap());
        assert!(maps.depth_at(9e9).unwrap() == maps.depth(5).unwrap());
    }
}

#[test]
fn everything_is_there_and_means_what_the_manifest_says() {
    let folder = TempDir::new().unwrap();
    let steps = write_ring(folder.path());
    let maps = converted(folder.path(), &Options::default());
    // The greatest ring has a radius of 17.8 cells around (30, 20), and one cell more lies around it.
    assert_eq!((maps.manifest().window.origin, maps.georeference().size), (uvec2(12, 2), uvec2(37, 37)));
    assert_eq!(maps.georeference().corner, CORNER + dvec2(12.0, 50.0 - 2.0 - 37.0) * 5.0);
    let at = |grid: &Grid<f32>| *grid.get(uvec2(30 - 12 + 10, 20 - 2)).unwrap();
    // Ten cells from the source the water arrives after 10.2 / 0.06 s and is 0.8 m deep in the end.
    let terrain = maps.terrain().unwrap();
    assert!((at(&terrain) - 0.0).abs() < 1e-3);
    // The land falls by 0.1 m a cell of 5 m to the south.
    let normal = *maps.normals().unwrap().get(uvec2(5, 5)).unwrap();
    assert!(normal.abs_diff_eq(Vec3::new(0.0, 1.0, 0.02).normalize(), 1e-4), "{normal}");
    let arrival = maps.arrival().unwrap();
    assert!((at(&arrival.after) - 170.0).abs() < 20.0, "{}", at(&arrival.after));
    assert!(arrival.after.values()[0].is_nan());
    assert!((at(&maps.map(Map::MaximumDepth).unwrap()) - 0.8).abs() < 1e-3);
    assert!((at(&maps.map(Map::MaximumSpeed).unwrap()) - 0.58).abs() < 1e-3);
    assert!((at(&maps.map(Map::Hazard).unwrap()) - (0.8 * 1.08 + 1.0)).abs() < 1e-3);
    let duration = at(&maps.map(Map::Duration).unwrap());
    assert!((duration - (300.0 - at(&arrival.after))).abs() < 0.1, "{duration}");
    assert!((at(&maps.quantity(5, Quantity::Speed).unwrap()) - 0.58).abs() < 1e-3);
    assert!((at(&maps.quantity_at(Quantity::Speed, 270.0).unwrap()) - 0.565).abs() < 0.02);
    assert!((at(&maps.quantity(5, Quantity::Level).unwrap()) - 0.8).abs() < 1e-3);
    assert!(maps.quantity(5, Quantity::Level).unwrap().values()[0].is_nan());
    let flow = maps.flow().unwrap().velocity;
    let current = *flow.get(uvec2(28, 18)).unwrap();
    assert!(current.x > 0.4 && current.y.abs() < 0.05, "{current}");
    assert_eq!(maps.step(2).unwrap().time, steps[2].time);
    assert!(matches!(maps.step(6), Err(MapsError::NoStep(6, 6))));
    assert!(matches!(maps.quantity(0, Quantity::East), Err(MapsError::Missing { .. })));
    assert_eq!((maps.step_before(-1.0), maps.step_before(60.0), maps.step_before(1e9)), (0, 1, 5));
}

#[test]
fn the_volume_stays_within_two_percent() {
    let folder = TempDir::new().unwrap();
    let steps = write_ring(folder.path());
    let maps = converted(folder.path(), &Options { precision: 0.005, ..Options::default() });
    let volume = |grid: &Grid<f32>| grid.values().iter().map(|depth| f64::from(*depth)).sum::<f64>();
    for (index, step) in steps.iter().enumerate().skip(1) {
        let (expected, found) = (volume(step.get(Quantity::Depth).unwrap()), volume(&maps.depth(index).unwrap()));
        assert!((found / expected - 1.0).abs() < 0.02, "step {index}: {expected} {found}");
    }
}

#[test]
fn parts_may_be_left_out() {
    let folder = TempDir::new().unwrap();
    write_ring(folder.path());
    let maps = converted(folder.path(), &Options { parts: vec![Part::Depth], ..Options::default() });
    assert!(matches!(maps.arrival(), Err(MapsError::Missing { .. })));
    assert!(maps.depth_at(90.0).is_ok());
    let maps = converted(folder.path(), &Options { parts: vec![Part::Arrival, Part::Flow], ..Options::default() });
    assert_eq!(maps.times().len(), 6);
    let message = maps.depth_at(90.0).unwrap_err().to_string();
    assert!(message.contains("converted without depth"), "{message}");
}

#[test]
fn any_number_of_threads_writes_the_same_bytes() {
    let folder = TempDir::new().unwrap();
    write_ring(folder.path());
    let bytes = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| converted(folder.path(), &Options::default()));
        files(&folder.path().join("out")).into_iter().map(|file| fs::read(file).unwrap()).collect::<Vec<_>>()
    };
    let one = bytes(1);
    assert!(one.len() > 12);
    assert!(one == bytes(2) && one == bytes(3));
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() { files.extend(self::files(&path)) } else { files.push(path) }
    }
    files.sort();
    files
}

#[test]
fn levels_over_the_terrain_are_depths() {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, value: fn(u32) -> f32| {
        let grid = Grid::from_fn(uvec2(9, 3), 5.0, |cell| value(cell.x)).unwrap();
        EsriGrid { corner: CORNER, grid }.write(folder.path().join(name)).unwrap();
    };
    write("terrain.asc", |x| 0.1 * x as f32);
    write("h0000.asc", |x| if x < 3 { 0.3 } else { f32::NAN });
    write("h0001.asc", |x| if x < 6 { 0.6 } else { f32::NAN });
    let steps = Steps::open(folder.path(), &every(60.0)).unwrap();
    let terrain = Raster::read(folder.path().join("terrain.asc")).unwrap();
    let out = folder.path().join("out");
    let none = convert(&steps, None, &Options::default(), &out, |_| {});
    assert!(matches!(none, Err(ConversionError::NoTerrain(_))) && !out.exists());
    convert(&steps, Some(("terrain.asc", &terrain)), &Options::default(), &out, |_| {}).unwrap();
    let maps = FloodMaps::open(&out).unwrap();
    assert!((maps.depth(1).unwrap().values()[4] - 0.2).abs() <= 0.001);
    assert!((maps.quantity(1, Quantity::Level).unwrap().values()[4] - 0.6).abs() <= 0.001);
}

#[test]
fn folders_that_are_no_flood_say_why() {
    let folder = TempDir::new().unwrap();
    write_ring(folder.path());
    let maps = converted(folder.path(), &Options::default());
    let out = maps.folder().to_path_buf();
    let text = fs::read_to_string(out.join(FILE)).unwrap();
    let message = |text: String| {
        fs::write(out.join(FILE), text).unwrap();
        FloodMaps::open(&out).unwrap_err().to_string()
    };
    for (from, to, expected) in [
        ("version: 1", "version: 7, later: ()", "expected version 1, found 7"),
        ("version: 1", "version: one", "flood.ron"),
        ("time: 60.0", "time: 0.0", "expected times that increase"),
        ("terrain.png", "../terrain.png", "files inside the folder"),
        ("cell_size: 5.0", "cell_size: -5.0", "a cell size above zero"),
        ("maps: {", "maps: ", "flood.ron"),
    ] {
        assert!(text.contains(from));
        let message = message(text.replace(from, to));
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn pictures_that_are_gone_or_wrong_say_so() {
    let folder = TempDir::new().unwrap();
    write_ring(folder.path());
    let maps = converted(folder.path(), &Options::default());
    let depth = |index: usize| maps.folder().join(format!("depth/{index:04}.png"));
    fs::remove_file(depth(1)).unwrap();
    fs::copy(maps.folder().join("normals.png"), depth(2)).unwrap();
    fs::write(depth(3), fs::read(depth(4)).unwrap().split_at(99).0).unwrap();
    for (index, expected) in [(1, "depth/0001.png: No such file"), (2, "expected 16-bit grey"), (3, "depth/0003.png: ")]
    {
        let message = maps.depth(index).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
    let text = fs::read_to_string(maps.folder().join(FILE)).unwrap();
    let [from, to] = ["size: (37, 37),\n    ),\n    window", "size: (37, 36),\n    ),\n    window"];
    assert!(text.contains(from));
    fs::write(maps.folder().join(FILE), text.replace(from, to)).unwrap();
    let message = FloodMaps::open(maps.folder()).unwrap().depth(0).unwrap_err().to_string();
    assert!(message.contains("expected 37 × 36 pixels, found 37 × 37"), "{message}");
}

#[test]
fn options_out_of_range_are_refused() {
    let folder = TempDir::new().unwrap();
    write_ring(folder.path());
    let steps = Steps::open(folder.path(), &every(60.0)).unwrap();
    let out = folder.path().join("out");
    let message = |options: Options| convert(&steps, None, &options, &out, |_| {}).unwrap_err().to_string();
    for (options, expected) in [
        (Options { precision: 0.0, ..Options::default() }, "precision must be"),
        (Options { precision: 1e-5, ..Options::default() }, "a depth of 1.8"),
        (
            Options { crop: Crop::Rectangle(dvec2(0.0, 0.0), dvec2(9.0, 9.0)), ..Options::default() },
            "outside the steps",
        ),
        (
            Options { arrival: ArrivalOptions { radius: 999, ..ArrivalOptions::default() }, ..Options::default() },
            "radius must be 0 to 100 cells, not 999",
        ),
        (
            Options { arrival: ArrivalOptions { threshold: 50.0, ..ArrivalOptions::default() }, ..Options::default() },
            "no cell of any step is 50 m deep or more",
        ),
    ] {
        let message = message(options);
        assert!(message.contains(expected), "{message}");
    }
    assert!(!out.exists());
}

#[test]
fn files_that_change_while_they_are_read_are_noticed() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let change: [(&str, fn(&Path)); 3] = [
        ("dm0003.asc: No such file", |path| fs::remove_file(path).unwrap()),
        ("dm0003.asc", |path| fs::write(path, "").unwrap()),
        ("40 × 50 cells", |path| {
            let grid = Grid::from_fn(uvec2(40, 50), 5.0, |_| 1.0).unwrap();
            EsriGrid { corner: CORNER, grid }.write(path).unwrap();
        }),
    ];
    for (expected, change) in change {
        write_ring(folder.path());
        let steps = Steps::open(folder.path(), &every(60.0)).unwrap();
        let changed = convert(&steps, None, &Options::default(), &out, |progress| {
            if progress == Progress::Maps(6) {
                change(&folder.path().join("dm0003.asc"));
            }
        });
        let message = changed.unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
        assert!(!out.exists() && files(folder.path()).len() <= 13);
    }
}

#[test]
fn the_real_flood_is_converted_whole() {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/flood");
    let steps = Steps::open(assets.join("flood.inc.gz"), &steps::Options::default()).unwrap();
    let terrain = Raster::read(assets.join("terrain.asc.gz")).unwrap();
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let summary = convert(&steps, Some(("terrain.asc.gz", &terrain)), &Options::default(), &out, |_| {}).unwrap();
    let maps = FloodMaps::open(&out).unwrap();
    assert_eq!((maps.times().len(), summary.steps.len()), (25, 25));
    let window = maps.manifest().window;
    for (index, (step, amount)) in steps.iter().zip(&summary.steps).enumerate() {
        let step = step.unwrap();
        let expected = window.of(step.get(Quantity::Depth).unwrap());
        let found = maps.depth_at(step.time).unwrap();
        for (expected, found) in expected.values().iter().zip(found.values()) {
            // No data is dry.
            assert!((expected.max(0.0) - found).abs() <= 0.0005 + 1e-6, "{index}: {expected} {found}");
        }
        let volume = found.values().iter().map(|depth| f64::from(*depth)).sum::<f64>() * 16.0;
        assert!((volume - amount.volume).abs() <= 0.02 * amount.volume, "{index}: {volume} {amount:?}");
    }
    // Water springs up near the north end. Elsewhere it does so only in pools that a film thinner than the threshold feeds.
    let arrival = &maps.arrival().unwrap().after;
    let mut springs = crate::known::springs(maps.arrival().unwrap());
    springs.sort_by(|a, b| arrival.get(*a).unwrap().total_cmp(arrival.get(*b).unwrap()));
    assert!(springs[0].as_vec2().distance(vec2(66.0, 24.0)) < 8.0 && springs.len() < 10, "{springs:?}");
    for spring in springs {
        // The step before the water came, if it did not come just at a step.
        let index = maps.step_before(f64::from(*arrival.get(spring).unwrap()) - 0.1);
        let before = maps.depth(index).unwrap();
        assert!(crate::known::around(spring, before.size()).all(|cell| *before.get(cell).unwrap() < WET), "{spring}");
    }
}
