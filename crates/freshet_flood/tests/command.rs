//! The command `freshet-flood`, run as a user runs it.

#![expect(clippy::unwrap_used, reason = "a test ends where something is wrong")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use approx::assert_relative_eq;
use freshet_flood::esri_ascii::EsriGrid;
use freshet_flood::flow_map::{Defaults, FlowMap};
use freshet_hydro::grid::Grid;
use glam::{Vec2, dvec2, uvec2};

/// A canal from west to east, 12 m wide and 2 m deep, in a terrain of 40 m × 20 m whose south-west corner is at
/// (1000, 2000) on the map.
fn canal(name: &str) -> PathBuf {
    let grid = Grid::from_fn(uvec2(40, 20), 1.0, |cell| match cell.y {
        4..16 => -1.0,
        _ => 3.0,
    });
    let corner = dvec2(1000.0, 2000.0);
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    EsriGrid { corner, grid: grid.unwrap() }.write(&path).unwrap();
    path
}

fn flow(terrain: &Path, arguments: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_freshet-flood"));
    command.arg("flow").arg(terrain).arg("--output").arg(terrain.with_extension("png"));
    command.args(arguments.split_whitespace()).output().unwrap()
}

fn read_map(terrain: &Path) -> FlowMap {
    FlowMap::read(terrain.with_extension("png"), Defaults::default()).unwrap()
}

#[test]
fn a_canal_becomes_a_flow_map_and_a_table() {
    let terrain = canal("canal.asc");
    let output = flow(&terrain, "--level 1 --inflow -20,-9:-20,9 --outflow 20,-9:20,9 --discharge 24");
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && output.stderr.is_empty());
    for line in ["terrain     40 × 20 cells, 40 × 20 m", "reach area  480 m²", "mean speed  1.00 m/s"] {
        assert!(table.contains(line), "{table}");
    }
    // Manning: S = (u n / d^⅔)² = 3.57e-4, times 40 m.
    assert!(table.contains("head drop   0.014 m"), "{table}");
    assert_eq!(table.matches(" 24.000 ").count(), 10, "{table}");

    let map = read_map(&terrain);
    assert_eq!((map.level, map.velocity.cell_size()), (Some(1.0), 1.0));
    for (cell, velocity) in map.velocity.iter() {
        let expected = if (4..16).contains(&cell.y) { 1.0 } else { 0.0 };
        assert_relative_eq!(velocity.x, expected, epsilon = 1e-4);
        assert_relative_eq!(velocity.y, 0.0, epsilon = 1e-4);
    }
}

#[test]
fn sections_may_be_in_map_coordinates() {
    let terrain = canal("canal_on_the_map.asc");
    let sections = "--inflow 1035,2000:1035,2020 --outflow 1010,2000:1010,2020 --map-coordinates";
    let output = flow(&terrain, &format!("--level 1 --discharge 12 --manning 0.05 {sections}"));
    assert!(output.status.success());
    let velocity = read_map(&terrain).velocity;
    assert_relative_eq!(velocity.sample(Vec2::ZERO).x, -0.5, epsilon = 1e-4);
    assert_eq!(velocity.get(uvec2(36, 10)), Some(&Vec2::ZERO));
}

#[test]
fn errors_go_to_stderr_and_name_things() {
    let terrain = canal("canal_with_errors.asc");
    let valid = "--inflow -20,-9:-20,9 --outflow 20,-9:20,9";
    for (arguments, code, expected) in [
        (format!("--level 1 --discharge -3 {valid}"), 1, "canal_with_errors.asc"),
        (
            format!("--level 1 --discharge -3 {valid}"),
            1,
            "the discharge must be a finite number of m³/s above zero, not -3",
        ),
        (format!("--level -5 --discharge 3 {valid}"), 1, "under the water level of -5 m"),
        (
            "--level 1 --discharge 3 --inflow -30,0:-30,9 --outflow 20,-9:20,9".into(),
            1,
            "the inflow section from (-30, 0) to (-30, 9) crosses no water",
        ),
        ("--level 1 --discharge 3 --inflow -30,0 --outflow 20,-9:20,9".into(), 2, "expected two points X,Z:X,Z"),
    ] {
        let output = flow(&terrain, &arguments);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{message}");
        assert!(message.contains(expected), "{message}");
        assert!(output.stdout.is_empty());
    }
    let missing = terrain.with_file_name("no_such.asc");
    let output = flow(&missing, &format!("--level 1 --discharge 3 {valid}"));
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8(output.stderr).unwrap().contains("no_such.asc: No such file"));
}

fn info(path: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_freshet-flood")).arg("info").arg(path).args(arguments).output().unwrap()
}

/// What `info` prints, with single blanks.
fn told(path: &Path, arguments: &[&str]) -> String {
    let output = info(path, arguments);
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ") + "\n").collect()
}

#[test]
fn info_tells_what_a_raster_is() {
    let text = told(&canal("info.asc"), &[]);
    let expected = "format ESRI ASCII grid\nsize 40 × 20 cells of 1\nplace (1000, 2000) to (1040, 2020)\n\
                    data in 800 of 800 cells, above zero in 320\nvalues -1 to 3\n";
    assert_eq!(text, expected);
}

const INCREMENTAL: &str = "\
INC1.0
MAIN DIMENSIONS MMAX NMAX
2 1
GRID DX DY X0 Y0
2 2 11 21
START TIME T0: 2011.01.01 00:00:00
CLASSES OF INCREMENTAL FILE H C
0.5 -999
1 0.25
ENDCLASSES
0.0 0 1 1
1 1 1
0.5 0 1 1
1 1 2
2 1 0
0.5 0 2 1
1 1 2
";

#[test]
fn info_tells_what_an_incremental_file_is() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("info.inc");
    std::fs::write(&path, INCREMENTAL).unwrap();
    let expected = "format incremental file of Sobek\nstart 2011.01.01 00:00:00\n\
                    classes of depth: 0.5 1\nclasses of speed: 0.25\n\
                    size 2 × 1 cells of 2\nplace (10, 20) to (14, 22)\nsteps 2, the last at 0:30:00\n\
                    time quantity cells above 0 least most volume m³\n\
                    0:00:00 depth 1 1 0.500 0.500 2\n\
                    0:30:00 depth 2 1 0.000 1.000 4\n\
                    0:30:00 speed 1 1 0.250 0.250\n";
    assert_eq!(told(&path, &[]), expected);
}

#[test]
fn info_tells_what_a_folder_holds() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("info");
    std::fs::create_dir_all(&folder).unwrap();
    for (file, value) in [("tiefe2", 0.5), ("tiefe10", 1.5), ("salz2", 9.0)] {
        let grid = Grid::new(uvec2(2, 1), 2.0, vec![value, f32::NAN]).unwrap();
        EsriGrid { corner: dvec2(0.0, 0.0), grid }.write(folder.join(file).with_extension("asc")).unwrap();
    }
    let text = told(&folder, &["--series", "tiefe=depth", "--interval", "1.5h"]);
    assert!(text.contains("left out ") && text.contains("salz2.asc\n"), "{text}");
    assert!(text.contains("steps 2, the last at 1:30:00\n"), "{text}");
    assert!(text.contains("0:00:00 depth 1 1 0.500 0.500 2\n1:30:00 depth 1 1 1.500 1.500 6\n"), "{text}");
    let text = told(&folder, &["--series", "tiefe=depth"]);
    assert!(text.contains("times unknown: --interval or --times gives them\nsteps 2\nstep quantity"), "{text}");
    assert!(text.contains("0 depth 1 1 0.500 0.500 2\n1 depth 1 1 1.500"), "{text}");
    let table = folder.join("times.csv");
    std::fs::write(&table, "step,time\n2,1min\n10,2min\n").unwrap();
    let text = told(&folder, &["--series", "tiefe=depth", "--times", table.to_str().unwrap()]);
    assert!(text.contains("0:02:00 depth"), "{text}");
}

#[test]
fn info_fails_with_one_for_bad_data_and_two_for_bad_usage() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let torn = folder.join("info_torn.inc");
    std::fs::write(&torn, format!("{INCREMENTAL}2 1")).unwrap();
    let torn = torn.as_path();
    for (path, arguments, code, expected) in [
        (torn, vec![], 1, "info_torn.inc, line 18, column 1: expected three or four numbers on a line, found 2"),
        (&folder.join("no_such.asc"), vec![], 1, "no_such.asc: No such file"),
        (torn, vec!["--interval", "soon"], 2, "expected a duration such as 90, 90s, 30min, 1.5h or 1d, found “soon”"),
        (torn, vec!["--series", "dm"], 2, "expected PREFIX=QUANTITY"),
        (torn, vec!["--series", "dm=mud"], 2, "expected depth, speed, level, east or north, found “mud”"),
        (torn, vec!["--interval", "1h", "--times", "times.csv"], 2, "cannot be used with"),
    ] {
        let output = info(path, &arguments);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{message}");
        assert!(message.contains(expected), "{message}");
        assert_eq!(message.matches("expected three or four").count(), usize::from(expected.contains("three or four")));
        assert!(output.stdout.is_empty());
    }
    let help = String::from_utf8(info(torn, &["--help"]).stdout).unwrap();
    assert!(help.contains("freshet-flood info flood.inc"), "{help}");
}
