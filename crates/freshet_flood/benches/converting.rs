//! What converting a flood costs: seconds against cells, steps and the radius of the arrival map, and the memory it takes.
//!
//! `cargo bench -p freshet_flood --bench converting`, or with the number of threads: `… -- 1`. Steps are generated as ESRI
//! ASCII grids of millimetres in a temporary folder, about 60 MB for each 10⁷ cells.

use std::error::Error;
use std::fs;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::time::Instant;

use freshet_flood::arrival::{ArrivalBuilder, ArrivalOptions};
use freshet_flood::conversion::{Options, convert};
use freshet_flood::interpolation::Interval;
use freshet_flood::raster::Raster;
use freshet_flood::step::{Quantity, Step};
use freshet_flood::steps::{self, Steps, Times};
use freshet_flood::waterline::USUAL_THRESHOLD;
use freshet_hydro::grid::Grid;
use freshet_hydro::noise::fractal_noise;
use glam::{UVec2, uvec2};

/// Half an hour, as in the flood of Petten.
const INTERVAL: f64 = 1800.0;
/// The raster of the flood of Petten: 48 steps of 5 m cells.
const PETTEN: UVec2 = uvec2(886, 1386);

/// Elevations of rolling land that falls to the east, m.
fn bed(size: UVec2) -> Vec<f32> {
    let cells = (0..size.y).flat_map(|y| (0..size.x).map(move |x| uvec2(x, y).as_vec2()));
    cells
        .map(|cell| 1.5 * fractal_noise(cell / 90.0, UVec2::splat(4096), 4, 1) - 2.0 * cell.x / size.x as f32)
        .collect()
}

/// Depths of a level that sinks away from a breach in the west and rises with time, m.
fn depths(bed: &[f32], size: UVec2, share: f32) -> Vec<f32> {
    let breach = uvec2(0, size.y / 2).as_vec2();
    let cells = (0..size.y).flat_map(|y| (0..size.x).map(move |x| uvec2(x, y).as_vec2()));
    let reach = size.max_element() as f32 * share;
    let depth = |(cell, bed): (glam::Vec2, &f32)| {
        let behind = 1.0 - cell.distance(breach) / reach.max(1.0);
        (0.5 + 1.5 * share + 0.4 * behind.min(0.0) * 40.0 - bed - 1.0).clamp(0.0, 4.0)
    };
    cells.zip(bed).map(depth).collect()
}

fn write(path: &Path, size: UVec2, values: &[f32]) -> Result<(), Box<dyn Error>> {
    let mut file = BufWriter::new(fs::File::create(path)?);
    writeln!(file, "NCOLS {}\nNROWS {}\nXLLCORNER 105000\nYLLCORNER 530000", size.x, size.y)?;
    writeln!(file, "CELLSIZE 5\nNODATA_VALUE -9999")?;
    for row in values.chunks(size.x as usize) {
        for value in row {
            // A dry cell is without data, as models write it.
            if *value == 0.0 { write!(file, "-9999 ")? } else { write!(file, "{value:.3} ")? }
        }
        writeln!(file)?;
    }
    Ok(file.flush()?)
}

/// The most memory that the process has had, MB; 0 where the system does not tell.
fn memory() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok());
    kilobytes.unwrap_or_default() / 1e3
}

fn conversion(size: UVec2, count: usize) -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let bed = bed(size);
    write(&folder.path().join("terrain.asc"), size, &bed)?;
    fs::create_dir(folder.path().join("steps"))?;
    for index in 0..count {
        let depths = depths(&bed, size, index as f32 / count as f32);
        write(&folder.path().join(format!("steps/dm{index:04}.asc")), size, &depths)?;
    }
    drop(bed);
    let start = Instant::now();
    let options = steps::Options { times: Times::Every(INTERVAL), ..Default::default() };
    let steps = Steps::open(folder.path().join("steps"), &options)?;
    let terrain = Raster::read(folder.path().join("terrain.asc"))?;
    let summary =
        convert(&steps, Some(("terrain.asc", &terrain)), &Options::default(), &folder.path().join("out"), |_| {})?;
    let seconds = start.elapsed().as_secs_f64();
    let cells = f64::from(size.x) * f64::from(size.y);
    println!(
        "{:>10} cells {:>3} steps {:>6.2} s {:>6.1} ns a cell and step, {:>5.0} MB at most so far, {:>2.0} % wet, {:.1} MB written",
        cells,
        count,
        seconds,
        seconds * 1e9 / cells / count as f64,
        memory(),
        100.0 * summary.wet_cells as f64 / cells,
        summary.bytes as f64 / 1e6
    );
    Ok(())
}

/// Seconds to finish an arrival map at a radius.
fn arrival(size: UVec2, radius: u32) -> Result<f64, Box<dyn Error>> {
    let mut builder = ArrivalBuilder::new(ArrivalOptions { radius, ..ArrivalOptions::default() })?;
    let bed = bed(size);
    for index in 0..8 {
        let depths = Grid::new(size, 5.0, depths(&bed, size, index as f32 / 8.0))?;
        builder.add(&Step::new(f64::from(index)).with(Quantity::Depth, depths))?;
    }
    let start = Instant::now();
    builder.finish()?;
    Ok(start.elapsed().as_secs_f64())
}

/// Seconds to prepare what happens between two steps, and to draw one instant of it.
fn interval(size: UVec2) -> Result<(f64, f64), Box<dyn Error>> {
    let bed = bed(size);
    let [before, after] = [0.4, 0.5].map(|share| Grid::new(size, 5.0, depths(&bed, size, share)));
    let start = Instant::now();
    let interval = Interval::new((0.0, before?), (1.0, after?), None, USUAL_THRESHOLD);
    let prepared = start.elapsed().as_secs_f64();
    interval.depth_at(0.5);
    Ok((prepared, start.elapsed().as_secs_f64() - prepared))
}

fn main() -> Result<(), Box<dyn Error>> {
    let threads = std::env::args().filter_map(|argument| argument.parse().ok()).next().unwrap_or(0);
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    for size in [uvec2(400, 300), PETTEN] {
        for count in [12, 24, 48] {
            conversion(size, count)?;
        }
    }
    for (size, count) in
        [(uvec2(1000, 1000), 6), (uvec2(2000, 1000), 6), (uvec2(2500, 2000), 6), (uvec2(4000, 2500), 6)]
    {
        conversion(size, count)?;
    }
    let (seven, fourteen) = (arrival(PETTEN, 7)?, arrival(PETTEN, 14)?);
    println!(
        "arrival map of {PETTEN}: radius 7 {seven:.2} s, radius 14 {fourteen:.2} s, {:.2} times",
        fourteen / seven
    );
    for size in [PETTEN, uvec2(4000, 2500)] {
        let (prepared, drawn) = interval(size)?;
        println!("interval of {size}: {:.0} ms to prepare, {:.0} ms to draw", prepared * 1e3, drawn * 1e3);
    }
    Ok(())
}
