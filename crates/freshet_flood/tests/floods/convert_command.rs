//! `freshet-flood convert` and `freshet-flood grid`, run as a user runs them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::known::{flood, ring};
use freshet_flood::esri_ascii::EsriGrid;
use freshet_flood::maps::{FloodMaps, Map};
use freshet_flood::step::Quantity;
use freshet_hydro::grid::Grid;
use glam::{DVec2, dvec2, uvec2, vec2};
use tempfile::TempDir;

const CORNER: DVec2 = dvec2(1000.0, 2000.0);

/// A folder with steps and their terrain.
struct Case {
    folder: TempDir,
}

impl Case {
    /// Five steps of a ring that spreads over 30 × 20 cells of 5 m.
    fn new() -> Self {
        let case = Self { folder: TempDir::new().unwrap() };
        fs::create_dir(case.path("steps")).unwrap();
        let steps = flood(uvec2(30, 20), 5, 60.0, ring(vec2(12.0, 9.0), 0.02));
        // The order in which files are written must not matter, nor may leading zeros.
        for index in [3, 0, 4, 1, 2] {
            case.write(&format!("steps/dm{index}.asc"), CORNER, steps[index].get(Quantity::Depth).unwrap());
        }
        case.write("terrain.asc", CORNER, &Grid::from_fn(uvec2(30, 20), 5.0, |cell| cell.x as f32).unwrap());
        case
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, corner: DVec2, grid: &Grid<f32>) {
        EsriGrid { corner, grid: grid.clone() }.write(self.path(name)).unwrap();
    }

    /// Runs the command in the folder.
    fn run(&self, arguments: &str) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_freshet-flood"));
        command.current_dir(self.folder.path()).args(arguments.split_whitespace()).output().unwrap()
    }

    fn convert(&self, more: &str) -> Output {
        self.run(&format!("convert --terrain terrain.asc --steps steps --interval 1min --out out {more}"))
    }

    /// Converting fails with a message, and leaves nothing, also no hidden folder.
    fn fails(&self, more: &str, expected: &str) {
        let before = self.names();
        let output = self.convert(more);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{message}");
        assert!(message.contains(expected) && output.stdout.is_empty(), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
        assert_eq!(self.names(), before);
    }

    fn names(&self) -> Vec<String> {
        names(self.folder.path())
    }
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn text(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).unwrap()
}

#[test]
fn a_folder_of_steps_becomes_maps_and_a_summary() {
    let case = Case::new();
    let summary = text(&case.convert(""));
    for line in [
        "model    30 × 20 cells of 5 m",
        "maps     11 × 11 cells from column 7, row 4",
        "steps    5 from 0:00:00 to 0:04:00",
        "volume   0 m³ at 0:00:00, ",
        "wet      69 cells, 1725 m² in the end",
        "front    last new cell at 0:0",
        "written  out with 0.0 MB",
    ] {
        assert!(summary.contains(line), "{line}: {summary}");
    }
    let expected = [
        "arrival.png",
        "depth",
        "duration.png",
        "flood.ron",
        "flow.png",
        "hazard.png",
        "maximum_depth.png",
        "normals.png",
        "terrain.png",
    ];
    assert_eq!(names(&case.path("out")), expected);
    assert_eq!(names(&case.path("out/depth")).len(), 5);
    let maps = FloodMaps::open(case.path("out")).unwrap();
    assert_eq!(maps.georeference().corner, CORNER + dvec2(7.0, 20.0 - 4.0 - 11.0) * 5.0);
    assert_eq!(maps.times(), [0.0, 60.0, 120.0, 180.0, 240.0]);
}

#[test]
fn options_choose_what_is_converted() {
    let case = Case::new();
    fs::write(case.path("times.csv"), "file,time\ndm0,0\ndm1,1min\ndm2,2min\ndm3,3min\ndm4,1h\n").unwrap();
    let options = "--terrain terrain.asc --steps steps --times times.csv --out out --quiet --threads 1";
    let more = "--only arrival,depth --radius 3 --precision 0.01 --crop 1050,2030,1080,2065 --threshold 0.05";
    assert_eq!(text(&case.run(&format!("convert {options} {more}"))), "");
    assert_eq!(names(&case.path("out")), ["arrival.png", "depth", "flood.ron"]);
    let maps = FloodMaps::open(case.path("out")).unwrap();
    assert_eq!(maps.times(), [0.0, 60.0, 120.0, 180.0, 3600.0]);
    assert_eq!((maps.georeference().size, maps.georeference().corner), (uvec2(6, 7), dvec2(1050.0, 2030.0)));
    assert_eq!((maps.manifest().arrival.radius, maps.threshold()), (3, 0.05));
    let all = text(&case.convert("--crop none --only arrival"));
    assert!(all.contains("maps     30 × 20 cells from column 0, row 0"), "{all}");
    for (wrong, expected) in [
        ("--only rain", "expected terrain, arrival, depth, velocity, flow, maxima"),
        ("--crop 5,5,1,1", "west < east"),
        ("--radius many", "invalid"),
    ] {
        let output = case.convert(wrong);
        assert_eq!(output.status.code(), Some(2));
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.contains(expected), "{message}");
    }
    let help = text(&case.run("convert --help")) + &text(&case.run("grid --help"));
    assert_eq!(help.matches("Examples:").count(), 2);
}

#[test]
fn grids_are_the_models_own_at_steps_and_agree_with_the_maps_between() {
    let case = Case::new();
    text(&case.convert("--quiet --crop none"));
    let grid = |arguments: &str| EsriGrid::parse(text(&case.run(&format!("grid {arguments}"))).as_bytes()).unwrap();
    let step = EsriGrid::read(case.path("steps/dm3.asc")).unwrap();
    assert!(grid("steps --interval 60s --at 3min") == step);
    for time in ["180", "190s", "3.5min", "0.06h"] {
        let (raw, maps) = (grid(&format!("steps --interval 1min --at {time}")), grid(&format!("out --at {time}")));
        assert_eq!(raw.corner, maps.corner);
        let mut moved = 0;
        for ((raw, maps), step) in raw.grid.values().iter().zip(maps.grid.values()).zip(step.grid.values()) {
            // Arrivals are rounded up by less than 4 ms, within which little water comes.
            assert!((raw - maps).abs() < 2e-3, "{raw} {maps}");
            moved += usize::from(raw != step);
        }
        assert_eq!(moved == 0, time == "180");
    }
    let level = grid("out --at 200s --quantity level").grid;
    assert!((level.get(uvec2(12, 9)).unwrap() - 12.4).abs() < 0.02);
    for (arguments, expected) in [
        ("out --at -30min", "the flood runs from 0:00:00 to 0:04:00: there is nothing at -0:30:00"),
        ("out --at 1h", "the flood runs from 0:00:00 to 0:04:00: there is nothing at 1:00:00"),
        ("out --at 1min --quantity speed", "converted without speed"),
        ("steps --interval 1min --at 90s --quantity speed", "steps tells no speed"),
        ("steps --at 90s", "expected an interval"),
    ] {
        let output = case.run(&format!("grid {arguments}"));
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(1) && message.contains(expected), "{message}");
    }
}

#[test]
fn terrains_with_other_cells_are_resampled_and_the_summary_says_so() {
    let case = Case::new();
    let fine = Grid::from_fn(uvec2(90, 60), 2.0, |cell| 0.4 * cell.x as f32).unwrap();
    case.write("terrain.asc", CORNER - 10.0, &fine);
    assert!(text(&case.convert("--crop none")).contains("resampled bilinearly"));
    let terrain = FloodMaps::open(case.path("out")).unwrap().map(Map::Terrain).unwrap();
    // The plane rises by 0.2 a metre and is 0 at the centre of its first cell, 1 m from its corner.
    assert!((terrain.get(uvec2(4, 3)).unwrap() - 0.2 * (10.0 + 22.5 - 1.0)).abs() < 1e-3);
}

#[test]
fn a_bad_step_stops_before_anything_is_written() {
    let case = Case::new();
    let last = case.path("steps/dm4.asc");
    let good = fs::read_to_string(&last).unwrap();
    let last_line = good.trim_end().rfind('\n').unwrap();
    for (bad, expected) in [
        (String::new(), "dm4.asc"),
        (good[..last_line + 9].into(), "dm4.asc"),
        (good.replace("NCOLS 30", "NCOLS 20").replace("NROWS 20", "NROWS 30"), "20 × 30 cells"),
        (good.replace("XLLCORNER 1000", "XLLCORNER 1005"), "from (1005, 2000)"),
        (good.replace("NCOLS 30", "NCOLS 30000").replace("NROWS 20", "NROWS 30000"), "30000 × 30000 cells"),
        (good.replacen(" 0 ", " water ", 1), "water"),
    ] {
        fs::write(&last, bad).unwrap();
        case.fails("", expected);
    }
    // Without data is dry.
    fs::write(&last, good.replacen(" 0 ", " nan ", 1)).unwrap();
    let output = case.convert("");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() || message.contains("dm4.asc"), "{message}");
}

#[test]
fn floods_that_are_none_are_refused() {
    let case = Case::new();
    case.fails("--radius 101", "radius must be 0 to 100 cells");
    case.fails("--threshold 9", "no cell of any step is 9 m deep or more: there is no flood");
    case.fails("--crop 0,0,10,10", "outside the steps");
    case.fails("--precision 0.000001", "needs a precision of 7.8e-6 m or coarser");
    let small = Grid::from_fn(uvec2(29, 20), 5.0, |_| 1.0).unwrap();
    case.write("terrain.asc", CORNER, &small);
    case.fails("", "does not cover the steps");
    fs::write(case.path("terrain.asc"), "").unwrap();
    case.fails("", "terrain.asc");
    case.write("terrain.asc", CORNER, &Grid::from_fn(uvec2(30, 20), 5.0, |_| 1.0).unwrap());
    let dry = Grid::from_fn(uvec2(30, 20), 5.0, |_| 0.0).unwrap();
    for index in 1..5 {
        fs::remove_file(case.path(&format!("steps/dm{index}.asc"))).unwrap();
    }
    case.fails("", "no cell of any step is 0.02 m deep or more");
    case.write("steps/dm0.asc", CORNER, &dry.map(|_| 1.0));
    case.fails("", "expected at least two steps, found one");
    fs::remove_file(case.path("steps/dm0.asc")).unwrap();
    case.fails("", "steps: expected rasters");
    fs::remove_dir(case.path("steps")).unwrap();
    case.fails("", "steps: ");
}

#[test]
fn what_is_in_the_way_stays() {
    let case = Case::new();
    text(&case.convert("--quiet --only arrival"));
    // A flood is replaced by a new one, and only by a whole one.
    text(&case.convert("--quiet --only depth"));
    assert_eq!(names(&case.path("out")), ["depth", "flood.ron"]);
    let good = fs::read(case.path("steps/dm2.asc")).unwrap();
    fs::write(case.path("steps/dm2.asc"), "").unwrap();
    case.fails("", "dm2.asc");
    assert_eq!(names(&case.path("out")), ["depth", "flood.ron"]);
    fs::write(case.path("steps/dm2.asc"), good).unwrap();
    // What else lies in its folder is not lost with it.
    fs::write(case.path("out/notes.txt"), "mine").unwrap();
    case.fails("", "notes.txt: is in the way");
    assert_eq!(fs::read_to_string(case.path("out/notes.txt")).unwrap(), "mine");
    fs::remove_file(case.path("out/notes.txt")).unwrap();
    fs::remove_file(case.path("out/flood.ron")).unwrap();
    case.fails("", "out: is in the way and belongs to no flood");
    fs::remove_dir_all(case.path("out")).unwrap();
    fs::write(case.path("out"), "a file").unwrap();
    case.fails("", "out: is in the way and belongs to no flood");
    let output = case.run("convert --steps steps --interval 1min --out out/flood");
    assert_eq!(output.status.code(), Some(1));
    let output = case.run("convert --steps steps --interval 1min --out no/such/folder");
    assert!(String::from_utf8(output.stderr).unwrap().contains("no/such: "));
    assert_eq!(case.names(), ["out", "steps", "terrain.asc"]);
}

/// A disk that takes no more than 512 bytes of a file stands for a full one.
#[cfg(unix)]
#[test]
fn a_disk_that_is_full_leaves_nothing() {
    let case = Case::new();
    let script =
        "trap '' XFSZ; ulimit -f 1; exec \"$0\" convert --terrain terrain.asc --steps steps --interval 1min --out out";
    let mut shell = Command::new("sh");
    shell.current_dir(case.folder.path()).args(["-c", script, env!("CARGO_BIN_EXE_freshet-flood")]);
    let output = shell.output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("Error: out/") && message.contains(": File too large"), "{message}");
    assert_eq!(case.names(), ["steps", "terrain.asc"]);
}
