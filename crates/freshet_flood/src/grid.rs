//! `freshet-flood grid`: a flood at one time as an ESRI ASCII grid.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::Args;
use freshet_flood::arrival::{ArrivalBuilder, ArrivalOptions};
use freshet_flood::duration::{self, clock};
use freshet_flood::esri_ascii::EsriGrid;
use freshet_flood::interpolation::{Interval, quantity_at};
use freshet_flood::maps::FloodMaps;
use freshet_flood::step::{Quantity, Step};
use freshet_flood::steps::Steps;
use freshet_hydro::grid::Grid;

use crate::source::StepArguments;

const EXAMPLES: &str = "\
Examples:
  freshet-flood grid flood.inc --at 1.5h > depth.asc
  freshet-flood grid steps/ --interval 30min --at 100min --quantity speed
  freshet-flood grid flood/ --at 5400 --quantity level

Between steps the front moves: a cell is wet when the water has reached it. At a step the model's own numbers are printed,
or those of the converted flood, which err by half of its precision.";

/// Prints a flood at one time as an ESRI ASCII grid.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// A converted flood, a folder of rasters, or an incremental file.
    path: PathBuf,
    /// Time since the beginning of the data, as in 1.5h, 90min or 5400 (seconds).
    #[arg(long, value_name = "TIME", value_parser = duration::time, allow_hyphen_values = true)]
    at: f64,
    /// What is printed: depth (m), speed (m/s), level (m), east or north (m/s).
    #[arg(long, default_value = "depth")]
    quantity: Quantity,
    #[command(flatten)]
    source: StepArguments,
}

/// The text of the grid.
pub fn run(arguments: &Arguments) -> Result<String> {
    let Arguments { path, at, quantity, source } = arguments;
    let (corner, grid) = if FloodMaps::is_in(path) {
        let maps = FloodMaps::open(path)?;
        check_time(*at, maps.times().first().copied(), maps.times().last().copied())?;
        (maps.georeference().corner, maps.quantity_at(*quantity, *at)?)
    } else {
        let steps = source.open(path)?;
        (steps.georeference().corner, of_steps(&steps, *quantity, *at)?)
    };
    Ok(EsriGrid { corner, grid }.to_string())
}

fn check_time(at: f64, first: Option<f64>, last: Option<f64>) -> Result<()> {
    let (Some(first), Some(last)) = (first, last) else { bail!("there is no step") };
    if !(first..=last).contains(&at) {
        bail!("the flood runs from {} to {}: there is nothing at {}", clock(first), clock(last), clock(at));
    }
    Ok(())
}

/// The quantity at a time, from the model's own steps. All of them are read, for they all tell when the water comes.
fn of_steps(steps: &Steps, quantity: Quantity, at: f64) -> Result<Grid<f32>> {
    let options = ArrivalOptions::default();
    let mut arrival = ArrivalBuilder::new(options)?;
    let (mut first, mut last) = (None, None);
    let (mut before, mut after): (Option<Step>, Option<Step>) = (None, None);
    for step in steps.iter() {
        let step = step?;
        first = first.or(Some(step.time));
        last = Some(step.time);
        if step.get(Quantity::Depth).is_some() {
            arrival.add(&step)?;
        }
        if step.time <= at {
            before = Some(step);
        } else if after.is_none() {
            after = Some(step);
        }
    }
    check_time(at, first, last)?;
    let missing = || format!("{} tells no {quantity}", steps.path().display());
    let before = before.context("there is no step")?;
    let Some(after) = after.filter(|_| before.time < at) else {
        return before.get(quantity).cloned().with_context(missing);
    };
    let depth = |step: &Step| {
        let depth = step.get(Quantity::Depth).map(|depth| (step.time, depth.clone()));
        depth.with_context(|| format!("{} tells no depth, so not where the water is", steps.path().display()))
    };
    let interval = Interval::new(depth(&before)?, depth(&after)?, Some(&arrival.finish()?), options.threshold);
    let depth = interval.depth_at(at);
    if quantity == Quantity::Depth {
        return Ok(depth);
    }
    let dry = if quantity == Quantity::Level { f32::NAN } else { 0.0 };
    quantity_at(&interval, (&before, &after), quantity, (at, &depth), dry).with_context(missing)
}
