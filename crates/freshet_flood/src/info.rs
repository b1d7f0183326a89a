//! `freshet-flood info`: what a raster or a flood is.

use std::fmt::Write;
use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use freshet_flood::duration::clock;
use freshet_flood::georeference::Georeference;
use freshet_flood::incremental::{Dialect, Header};
use freshet_flood::raster::{Format, Raster};
use freshet_flood::step::{Quantity, Step};
use freshet_flood::steps::{Steps, StepsError, Times};

use crate::source::StepArguments;

const EXAMPLES: &str = "\
Examples:
  freshet-flood info terrain.asc
  freshet-flood info flood.inc
  freshet-flood info steps/ --interval 30min
  freshet-flood info steps/ --times times.csv --series diepte=depth";

/// Reads a raster, an incremental file or a folder of rasters to its end and tells what it holds.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// An ESRI ASCII grid, a GeoTIFF or an incremental file, or a folder of rasters.
    path: PathBuf,
    #[command(flatten)]
    source: StepArguments,
}

/// Describes the file or folder.
pub fn run(arguments: &Arguments) -> Result<String> {
    let path = &arguments.path;
    let mut text = String::new();
    if !path.is_dir() {
        let format = Format::of(path)?;
        if format != Format::Incremental {
            describe_raster(&mut text, format, &Raster::read(path)?)?;
            return Ok(text);
        }
    }
    let (steps, has_times) = open(arguments)?;
    match steps.header() {
        Some(header) => describe_header(&mut text, header)?,
        None => writeln!(text, "format   folder of rasters")?,
    }
    describe_place(&mut text, &steps.georeference())?;
    for file in steps.left_out() {
        writeln!(text, "left out {}", file.display())?;
    }
    if !has_times {
        writeln!(text, "times    unknown: --interval or --times gives them")?;
    }
    describe_steps(&mut text, &steps, has_times)?;
    Ok(text)
}

/// The steps, and whether their times are known.
fn open(Arguments { path, source }: &Arguments) -> Result<(Steps, bool), StepsError> {
    match source.open(path) {
        // They are counted instead.
        Err(StepsError::NoTimes { .. }) => source.open_with(path, Times::Every(1.0)).map(|steps| (steps, false)),
        steps => steps.map(|steps| (steps, true)),
    }
}

fn describe_raster(text: &mut String, format: Format, raster: &Raster) -> std::fmt::Result {
    let format = if format == Format::GeoTiff { "GeoTIFF" } else { "ESRI ASCII grid" };
    writeln!(text, "format   {format}")?;
    describe_place(text, &raster.georeference)?;
    let Summary { cells, above_zero, least, most, .. } = Summary::new(raster.grid.values());
    writeln!(text, "data     in {cells} of {} cells, above zero in {above_zero}", raster.grid.values().len())?;
    if cells > 0 {
        writeln!(text, "values   {least} to {most}")?;
    }
    Ok(())
}

fn describe_header(text: &mut String, header: &Header) -> std::fmt::Result {
    let program = if header.dialect == Dialect::Sobek { "Sobek" } else { "Delft-FLS" };
    writeln!(text, "format   incremental file of {program}")?;
    if let Some(start) = &header.start {
        writeln!(text, "start    {start}")?;
    }
    for (quantity, classes) in header.quantities.iter().zip(&header.classes) {
        // Class 0 is 0 in every file.
        let values = classes.iter().skip(1).filter(|value| !value.is_nan());
        let values: Vec<String> = values.map(f32::to_string).collect();
        if !values.is_empty() {
            let quantity = quantity.map_or("unknown", Quantity::name);
            writeln!(text, "classes  of {quantity}: {}", values.join(" "))?;
        }
    }
    Ok(())
}

fn describe_place(text: &mut String, georeference: &Georeference) -> std::fmt::Result {
    let Georeference { corner, cell_size, size } = georeference;
    let end = corner + size.as_dvec2() * *cell_size;
    writeln!(text, "size     {} × {} cells of {cell_size}", size.x, size.y)?;
    writeln!(text, "place    ({}, {}) to ({}, {})", corner.x, corner.y, end.x, end.y)
}

/// A table with a row for each step and quantity.
fn describe_steps(text: &mut String, steps: &Steps, has_times: bool) -> Result<()> {
    let cell_area = steps.georeference().cell_size.powi(2);
    let time = if has_times { "time" } else { "step" };
    let (mut count, mut last) = (0, 0.0);
    let mut rows = String::new();
    for step in steps.iter() {
        let step: Step = step?;
        for quantity in Quantity::ALL {
            let Some(raster) = step.get(quantity) else { continue };
            let summary = Summary::new(raster.values());
            let Summary { cells, above_zero, .. } = summary;
            let time = if has_times { clock(step.time) } else { step.time.to_string() };
            write!(rows, "{time:>10}  {quantity:8} {cells:>9} {above_zero:>9} {}", summary.range())?;
            if quantity == Quantity::Depth {
                write!(rows, " {:>14.0}", summary.sum * cell_area)?;
            }
            writeln!(rows)?;
        }
        count += 1;
        last = step.time;
    }
    let until = if has_times { format!(", the last at {}", clock(last)) } else { String::new() };
    writeln!(text, "steps    {count}{until}")?;
    write!(text, "{time:>10}  quantity     cells   above 0      least       most      volume m³\n{rows}")?;
    Ok(())
}

/// What the values of a raster are.
struct Summary {
    /// How many have data.
    cells: usize,
    above_zero: usize,
    least: f32,
    most: f32,
    sum: f64,
}

impl Summary {
    fn new(values: &[f32]) -> Self {
        let start = Self { cells: 0, above_zero: 0, least: f32::INFINITY, most: f32::NEG_INFINITY, sum: 0.0 };
        values.iter().filter(|value| !value.is_nan()).fold(start, |summary, &value| Self {
            cells: summary.cells + 1,
            above_zero: summary.above_zero + usize::from(value > 0.0),
            least: summary.least.min(value),
            most: summary.most.max(value),
            sum: summary.sum + f64::from(value),
        })
    }

    fn range(&self) -> String {
        if self.cells == 0 {
            return format!("{:>10} {:>10}", "–", "–");
        }
        format!("{:>10.3} {:>10.3}", self.least, self.most)
    }
}
