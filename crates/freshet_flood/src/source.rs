//! Options that tell how the steps of a flood are to be found.

use std::path::{Path, PathBuf};

use clap::Args;
use freshet_flood::duration;
use freshet_flood::step::Quantity;
use freshet_flood::steps::{Options, Steps, StepsError, Times};

/// How steps are found. Incremental files tell it themselves.
#[derive(Args)]
pub struct StepArguments {
    /// Time between the steps of a folder, as in 30min, 1.5h or 90 (seconds).
    #[arg(long, value_parser = duration::seconds, conflicts_with = "times")]
    interval: Option<f64>,
    /// Times of the steps of a folder: a CSV table of file or step number, and time.
    #[arg(long, value_name = "CSV")]
    times: Option<PathBuf>,
    /// Files whose names begin with PREFIX are of QUANTITY: depth, speed, level, east or north.
    #[arg(long, value_name = "PREFIX=QUANTITY", value_parser = series)]
    series: Vec<(String, Quantity)>,
}

impl StepArguments {
    /// Finds the steps of a folder or file.
    ///
    /// # Errors
    /// [`StepsError`] as of [`Steps::open`].
    pub fn open(&self, path: &Path) -> Result<Steps, StepsError> {
        let times = match (self.interval, &self.times) {
            (Some(interval), _) => Times::Every(interval),
            (_, Some(table)) => Times::Table(table.clone()),
            _ => Times::OfFile,
        };
        self.open_with(path, times)
    }

    /// The same with other times.
    ///
    /// # Errors
    /// [`StepsError`] as of [`Steps::open`].
    pub fn open_with(&self, path: &Path, times: Times) -> Result<Steps, StepsError> {
        Steps::open(path, &Options { times, series: self.series.clone() })
    }
}

fn series(text: &str) -> Result<(String, Quantity), String> {
    let (prefix, quantity) = text.split_once('=').ok_or("expected PREFIX=QUANTITY, as in dm=depth")?;
    let quantity: Quantity = quantity.parse().map_err(|error| format!("{error}"))?;
    Ok((prefix.into(), quantity))
}
