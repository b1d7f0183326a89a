//! Steps of a flood: folders in any order and of any format, files of all steps, their times, and what can be wrong.

#![expect(clippy::unwrap_used, reason = "a test ends where something is wrong")]

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::GzEncoder;
use freshet_flood::step::{Quantity, Step};
use freshet_flood::steps::{Options, Steps, StepsError, Times};
use glam::{dvec2, uvec2};
use proptest::prelude::*;
use tiff::encoder::TiffEncoder;
use tiff::encoder::colortype::Gray32Float;
use tiff::tags::Tag;

/// A new folder for a test.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("steps").join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

/// Two cells of 2 m from (10, 20), of one value.
fn grid(value: impl std::fmt::Display) -> String {
    format!("ncols 2\nnrows 1\nxllcorner 10\nyllcorner 20\ncellsize 2\n{value} {value}\n")
}

fn packed(text: &str) -> Vec<u8> {
    let mut packer = GzEncoder::new(Vec::new(), Compression::default());
    packer.write_all(text.as_bytes()).unwrap();
    packer.finish().unwrap()
}

/// The same two cells as a GeoTIFF file.
fn write_geotiff(path: &Path, value: f32) {
    let mut file = fs::File::create(path).unwrap();
    let mut encoder = TiffEncoder::new(&mut file).unwrap();
    let mut image = encoder.new_image::<Gray32Float>(2, 1).unwrap();
    image.encoder().write_tag(Tag::ModelPixelScaleTag, &[2.0, 2.0, 0.0][..]).unwrap();
    image.encoder().write_tag(Tag::ModelTiepointTag, &[0.0, 0.0, 0.0, 10.0, 22.0, 0.0][..]).unwrap();
    image.write_data(&[value, value]).unwrap();
}

/// A folder with grids of these names, each with its place in the list as value.
fn grids(name: &str, files: &[&str]) -> PathBuf {
    let path = folder(name);
    for (value, file) in files.iter().enumerate() {
        fs::write(path.join(file), grid(value)).unwrap();
    }
    path
}

fn every(seconds: f64) -> Options {
    Options { times: Times::Every(seconds), ..Options::default() }
}

fn all(steps: &Steps) -> Vec<Step> {
    steps.iter().collect::<Result<_, _>>().unwrap()
}

/// Times, and the value of the first cell.
fn values(path: &Path, quantity: Quantity, options: &Options) -> Vec<(f64, f32)> {
    let steps = Steps::open(path, options).unwrap();
    let value = |step: &Step| step.get(quantity).map_or(f32::NAN, |raster| raster.values()[0]);
    all(&steps).iter().map(|step| (step.time, value(step))).collect()
}

fn message(path: &Path, options: &Options) -> String {
    Steps::open(path, options).and_then(|steps| steps.iter().collect::<Result<Vec<_>, _>>()).unwrap_err().to_string()
}

#[test]
fn steps_come_in_the_order_of_their_numbers() {
    let path = grids("order", &["dm0010.asc", "dm2.asc", "DM0001.ASC", "dm100.txt"]);
    let expected = [(0.0, 2.0), (30.0, 1.0), (60.0, 0.0), (90.0, 3.0)];
    assert_eq!(values(&path, Quantity::Depth, &every(30.0)), expected);
    let path = grids("hours", &["depth_2h00.asc", "depth_10h00.asc", "depth_1h30.asc"]);
    assert_eq!(values(&path, Quantity::Depth, &every(1.0)), [(0.0, 2.0), (1.0, 0.0), (2.0, 1.0)]);
}

#[test]
fn formats_may_be_mixed_and_each_step_is_at_hand() {
    let path = folder("mixed");
    fs::write(path.join("dm0.asc"), grid(1.5)).unwrap();
    fs::write(path.join("dm1.asc.gz"), packed(&grid(2.5))).unwrap();
    write_geotiff(&path.join("dm2.tif"), 3.5);
    fs::write(path.join("dm2.prj"), "what GIS programs put beside it").unwrap();
    let steps = Steps::open(&path, &every(60.0)).unwrap();
    assert_eq!((steps.count(), steps.times()), (Some(3), Some(&[0.0, 60.0, 120.0][..])));
    let place = steps.georeference();
    assert_eq!((place.corner, place.cell_size, place.size), (dvec2(10.0, 20.0), 2.0, uvec2(2, 1)));
    assert!(steps.left_out().is_empty());
    assert_eq!(values(&path, Quantity::Depth, &every(60.0)), [(0.0, 1.5), (60.0, 2.5), (120.0, 3.5)]);
    for (index, step) in all(&steps).into_iter().enumerate().rev() {
        assert_eq!(steps.at(index).unwrap().unwrap(), step);
    }
    assert!(steps.at(3).is_none());
}

#[test]
fn names_tell_quantities() {
    let files = ["dm01.asc", "c01.asc", "h_01.asc", "u01.asc", "v01.asc", "salt01.asc", "terrain.asc"];
    let path = grids("quantities", &files);
    let steps = Steps::open(&path, &Options::default()).unwrap();
    let left_out: Vec<_> = steps.left_out().iter().map(|path| path.file_name().unwrap()).collect();
    assert_eq!(left_out, ["salt01.asc", "terrain.asc"]);
    assert_eq!(steps.quantities(), Quantity::ALL);
    let step = &all(&steps)[0];
    assert_eq!(step.time, 0.0);
    for (value, quantity) in Quantity::ALL.into_iter().enumerate() {
        assert_eq!(step.get(quantity).unwrap().values(), [value as f32; 2]);
    }
    // As Sobek names them: domain, quantity, step. Maxima are no step.
    let sobek = ["dm1d0001.asc", "dm1c0001.asc", "dm1h0001.asc", "dm1u0001.asc", "dm1v0001.asc", "dm1maxd0.asc"];
    let steps = Steps::open(grids("sobek", &sobek), &Options::default()).unwrap();
    assert!(steps.left_out()[0].ends_with("dm1maxd0.asc") && steps.left_out().len() == 1);
    let step = &all(&steps)[0];
    for (value, quantity) in Quantity::ALL.into_iter().enumerate() {
        assert_eq!(step.get(quantity).unwrap().values(), [value as f32; 2]);
    }
}

#[test]
fn a_step_may_lack_a_quantity_of_the_others() {
    let path = grids("lacking", &["dm0.asc", "dm1.asc", "c1.asc"]);
    let steps = all(&Steps::open(&path, &every(1.0)).unwrap());
    assert_eq!(steps.iter().map(|step| step.get(Quantity::Speed).is_some()).collect::<Vec<_>>(), [false, true]);
}

#[test]
fn one_unknown_name_is_depth_and_options_tell_others() {
    let path = grids("unknown", &["run7_001.asc", "run7_002.asc"]);
    assert_eq!(values(&path, Quantity::Depth, &every(1.0)), [(0.0, 0.0), (1.0, 1.0)]);
    let series = vec![("run7".into(), Quantity::Level)];
    assert_eq!(values(&path, Quantity::Level, &Options { series, ..every(1.0) }), [(0.0, 0.0), (1.0, 1.0)]);
    let alone = grids("alone", &["flood.asc"]);
    assert_eq!(values(&alone, Quantity::Depth, &Options::default()), [(0.0, 0.0)]);

    let path = grids("two_unknown", &["a1.asc", "b1.asc"]);
    assert!(message(&path, &every(1.0)).ends_with("two_unknown: which quantities are these files of? a#, b#"));
    let series = vec![("A".into(), Quantity::Depth), ("b".into(), Quantity::Speed)];
    let steps = Steps::open(&path, &Options { series, ..every(1.0) }).unwrap();
    assert_eq!(all(&steps)[0].get(Quantity::Speed).unwrap().values(), [1.0; 2]);
    // What is said goes before what is known, and the longer beginning before the shorter.
    let path = grids("said", &["c1.asc", "cold1.asc"]);
    let series = vec![("c".into(), Quantity::Depth), ("cold".into(), Quantity::Level)];
    let step = &all(&Steps::open(&path, &Options { series, ..every(1.0) }).unwrap())[0];
    assert_eq!(step.get(Quantity::Depth).unwrap().values(), [0.0; 2]);
    assert_eq!(step.get(Quantity::Level).unwrap().values(), [1.0; 2]);
}

#[test]
fn a_table_tells_times() {
    let path = grids("table", &["dm0003.asc", "dm0007.asc", "dm0010.asc", "c0003.asc"]);
    for table in [
        "dm0003.asc,0\ndm0007.asc,90\ndm0010.asc,5400\n",
        "file,time\r\nDM0007,90s\r\n\r\ndm0010,1.5h\r\nc0003,0\r\n",
        "\u{feff}step;time\n3;0\n\"7\";1,5 min\n0010;1,5h\n99;100\n",
        "10,90min\n7,1.5min\n3,0",
    ] {
        let file = path.join("times.csv");
        fs::write(&file, table).unwrap();
        let options = Options { times: Times::Table(file), ..Options::default() };
        let expected = [(0.0, 0.0), (90.0, 1.0), (5400.0, 2.0)];
        assert_eq!(values(&path, Quantity::Depth, &options), expected, "{table:?}");
    }
    for (table, expected) in [
        ("3,0\n7,90\n", "times.csv: expected a time for "),
        ("3,0\n7,90\n10,90\n", "times.csv: expected times that grow, found 90 s for "),
        (
            "3,0\n7,soon\n",
            "times.csv, line 2, column 3: expected a time such as 90, 90s, 30min, 1.5h or 1d, found “7,soon”",
        ),
        (
            "3,0\n7\n",
            "times.csv, line 2, column 1: expected a file or step and its time, with a comma between, found “7”",
        ),
    ] {
        let file = path.join("times.csv");
        fs::write(&file, table).unwrap();
        let message = message(&path, &Options { times: Times::Table(file), ..Options::default() });
        assert!(message.contains(expected), "{message}");
    }
    let options = Options { times: Times::Table(path.join("no_such.csv")), ..Options::default() };
    assert!(message(&path, &options).contains("no_such.csv: No such file"));
}

const INCREMENTAL: &str = "MAIN DIMENSIONS MMAX NMAX\n2 1\nGRID DX X0 Y0\n2 11 21\n\
    CLASSES OF INCREMENTAL FILE H\n0.5\n1\nENDCLASSES\n0.0 0 1\n1 1 1\n0.5 0 1\n1 1 2\n";

#[test]
fn an_incremental_file_is_all_steps_packed_or_not() {
    let folder = folder("incremental");
    for (file, bytes) in
        [("flood.inc", INCREMENTAL.into()), ("packed.inc", packed(INCREMENTAL)), ("flood.txt", INCREMENTAL.into())]
    {
        let path = folder.join(file);
        fs::write(&path, bytes).unwrap();
        let steps = Steps::open(&path, &Options::default()).unwrap();
        assert_eq!((steps.count(), steps.times(), steps.path()), (None, None, path.as_path()));
        assert_eq!(steps.header().unwrap().classes, [[0.0, 0.5, 1.0]]);
        assert_eq!(steps.quantities(), [Quantity::Depth]);
        assert_eq!(steps.georeference().corner, dvec2(10.0, 20.0));
        assert_eq!(values(&path, Quantity::Depth, &Options::default()), [(0.0, 0.5), (1800.0, 1.0)]);
        assert_eq!(steps.at(1).unwrap().unwrap().time, 1800.0);
        assert!(steps.at(2).is_none());
        assert!(message(&path, &every(60.0)).contains("expected no interval and no table of times"));
    }
    // Errors further down come with the steps, with the file's name.
    let path = folder.join("torn.inc");
    fs::write(&path, format!("{INCREMENTAL}2 1")).unwrap();
    let steps = Steps::open(&path, &Options::default()).unwrap();
    let found: Vec<_> = steps.iter().collect();
    assert!(found.len() == 2 && found[0].is_ok());
    assert!(found[1].as_ref().unwrap_err().to_string().contains("torn.inc, line 13, column 1: expected three or four"));
    fs::remove_file(&path).unwrap();
    assert!(steps.iter().next().unwrap().unwrap_err().to_string().contains("torn.inc: No such file"));
}

#[test]
fn one_raster_is_one_step_at_time_zero_whatever_its_name() {
    let folder = folder("one");
    let path = folder.join("really_a_grid.inc");
    fs::write(&path, grid(3).replace("2\n3 3", "2\nNODATA_value -9999\n3 -9999")).unwrap();
    let steps = Steps::open(&path, &Options::default()).unwrap();
    assert_eq!((steps.count(), steps.times()), (Some(1), Some(&[0.0][..])));
    assert_eq!(values(&path, Quantity::Depth, &Options::default()), [(0.0, 3.0)]);
    let path = folder.join("level.tif");
    write_geotiff(&path, 4.0);
    assert_eq!(values(&path, Quantity::Level, &Options::default()), [(0.0, 4.0)]);
}

#[test]
fn what_is_wrong_with_a_folder_is_said_before_any_step_is_read() {
    let opened = |path: &Path, options: &Options| Steps::open(path, options).unwrap_err();
    let empty = folder("empty");
    fs::write(empty.join("readme.md"), "no raster").unwrap();
    fs::create_dir(empty.join("dm1.asc")).unwrap();
    assert!(matches!(opened(&empty, &every(1.0)), StepsError::Empty(_)));
    assert!(opened(&empty.join("no_such"), &every(1.0)).to_string().contains("no_such: No such file"));

    let path = grids("no_times", &["dm0.asc", "dm1.asc"]);
    let error = opened(&path, &Options::default()).to_string();
    assert!(error.contains("expected an interval or a table of times for the 2 steps"), "{error}");
    for interval in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(opened(&path, &every(interval)), StepsError::Interval(_)));
    }
    let error = opened(&grids("twice", &["dm1.asc", "dm01.txt"]), &every(1.0)).to_string();
    assert!(
        error.contains("dm01.txt") && error.contains("dm1.asc") && error.ends_with("are both depth of one step"),
        "{error}"
    );

    for (from, to, expected) in [
        ("ncols 2\nnrows 1", "ncols 1\nnrows 2", "dm1.asc has 1 × 2 cells of 2 from (10, 20), but "),
        ("xllcorner 10", "xllcorner 10.5", "dm1.asc has 2 × 1 cells of 2 from (10.5, 20), but "),
        ("cellsize 2", "cellsize 2.1", "dm1.asc has 2 × 1 cells of 2.1 from (10, 20), but "),
    ] {
        fs::write(path.join("dm1.asc"), grid(1).replace(from, to)).unwrap();
        let error = opened(&path, &every(1.0));
        assert!(matches!(error, StepsError::Different { .. }));
        let error = error.to_string();
        assert!(error.contains(expected) && error.contains("dm0.asc has 2 × 1 cells of 2 from (10, 20)"), "{error}");
    }
    // What writers round is no difference.
    fs::write(path.join("dm1.asc"), grid(1).replace("xllcorner 10", "xllcorner 10.0000001")).unwrap();
    Steps::open(&path, &every(1.0)).unwrap();
    fs::write(path.join("dm1.asc"), "").unwrap();
    let error = opened(&path, &every(1.0)).to_string();
    assert!(
        error.ends_with("dm1.asc: expected an ESRI ASCII grid, a GeoTIFF or an incremental file, found an empty file"),
        "{error}"
    );
    fs::write(path.join("dm1.asc"), "hello").unwrap();
    assert!(opened(&path, &every(1.0)).to_string().ends_with("found “hello”"));
    fs::write(path.join("dm1.asc"), INCREMENTAL).unwrap();
    assert!(
        opened(&path, &every(1.0))
            .to_string()
            .ends_with("expected one raster, found an incremental file, which holds many")
    );
}

#[test]
fn files_that_change_while_they_are_read_are_named() {
    let path = grids("changing", &["dm0.asc", "dm1.asc", "dm2.asc"]);
    let steps = Steps::open(&path, &every(1.0)).unwrap();
    fs::remove_file(path.join("dm1.asc")).unwrap();
    fs::write(path.join("dm2.asc"), grid(2).trim_end().trim_end_matches('2')).unwrap();
    let found: Vec<_> = steps.iter().map(|step| step.map_err(|error| error.to_string())).collect();
    assert!(found[0].is_ok());
    assert!(found[1].as_ref().unwrap_err().contains("dm1.asc: No such file"));
    assert!(
        found[2]
            .as_ref()
            .unwrap_err()
            .contains("dm2.asc, line 6, column 3: expected 2 values (2 columns × 1 rows), found the end")
    );
    fs::write(path.join("dm2.asc"), grid(2).replace("xllcorner 10", "xllcorner 0")).unwrap();
    assert!(steps.at(2).unwrap().unwrap_err().to_string().contains("dm2.asc has 2 × 1 cells of 2 from (0, 20), but "));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]

    #[test]
    fn any_numbers_in_any_order_come_sorted(
        numbers in prop::collection::btree_set(0_u64..2000, 1..12),
        zeros in 0_usize..6,
    ) {
        let path = folder("any_numbers");
        for number in &numbers {
            fs::write(path.join(format!("dm{number:0zeros$}.asc")), grid(number)).unwrap();
        }
        let found = values(&path, Quantity::Depth, &every(1.0));
        let found: Vec<u64> = found.iter().map(|(_, value)| *value as u64).collect();
        prop_assert_eq!(found, numbers.into_iter().collect::<Vec<_>>());
    }
}
