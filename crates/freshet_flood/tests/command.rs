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
