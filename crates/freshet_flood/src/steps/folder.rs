//! Steps as rasters of a folder.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use super::names::{Name, Number};
use super::times::Table;
use super::{Options, StepsError, Times};
use crate::georeference::Georeference;
use crate::raster::Raster;
use crate::step::{Quantity, Step};

/// Rasters in order of time, all of the same cells.
#[derive(Debug)]
pub(super) struct Folder {
    georeference: Georeference,
    times: Vec<f64>,
    steps: Vec<Files>,
    left_out: Vec<PathBuf>,
}

/// The files of one step.
pub(super) type Files = BTreeMap<Quantity, PathBuf>;

/// A file with the step and the quantity that its name tells.
struct Found {
    path: PathBuf,
    name: Name,
    quantity: Option<Quantity>,
}

impl Folder {
    pub(super) fn open(path: &Path, options: &Options) -> Result<Self, StepsError> {
        let mut found = rasters(path, options)?;
        if found.is_empty() {
            return Err(StepsError::Empty(path.into()));
        }
        if found.iter().all(|file| file.quantity.is_none()) {
            take_for_depth(path, &mut found)?;
        }
        let (steps, left_out) = sorted(found)?;
        Self::new(path, steps, left_out, options)
    }

    /// One raster as the only step.
    pub(super) fn of_file(path: &Path, options: &Options) -> Result<Self, StepsError> {
        let name = Name::of_raster(path);
        let quantity = name.and_then(|name| name.quantity(&options.series)).unwrap_or(Quantity::Depth);
        let files = Files::from([(quantity, path.into())]);
        Self::new(path, vec![files], Vec::new(), options)
    }

    fn new(path: &Path, steps: Vec<Files>, left_out: Vec<PathBuf>, options: &Options) -> Result<Self, StepsError> {
        let times = times(path, &steps, &options.times)?;
        let mut files = steps.iter().flat_map(Files::values);
        let first = files.next().ok_or_else(|| StepsError::Empty(path.into()))?;
        let georeference = Georeference::read(first)?;
        let folder = Self { georeference, times, left_out, steps: Vec::new() };
        for file in files {
            folder.check(first, file, Georeference::read(file)?)?;
        }
        Ok(Self { steps, ..folder })
    }

    pub(super) fn georeference(&self) -> Georeference {
        self.georeference
    }

    pub(super) fn quantities(&self) -> Vec<Quantity> {
        let quantities: BTreeSet<Quantity> = self.steps.iter().flat_map(Files::keys).copied().collect();
        quantities.into_iter().collect()
    }

    pub(super) fn times(&self) -> &[f64] {
        &self.times
    }

    pub(super) fn left_out(&self) -> &[PathBuf] {
        &self.left_out
    }

    /// Reads the files of a step.
    pub(super) fn at(&self, index: usize) -> Option<Result<Step, StepsError>> {
        let (time, files) = (*self.times.get(index)?, self.steps.get(index)?);
        Some(self.read(time, files))
    }

    fn read(&self, time: f64, files: &Files) -> Result<Step, StepsError> {
        let mut step = Step::new(time);
        for (&quantity, file) in files {
            let raster = Raster::read(file)?;
            // The file may be another one than when the folder was opened.
            let first = self.steps.first().and_then(|files| files.values().next()).unwrap_or(file);
            self.check(first, file, raster.georeference)?;
            step = step.with(quantity, raster.grid);
        }
        Ok(step)
    }

    fn check(&self, first: &Path, file: &Path, found: Georeference) -> Result<(), StepsError> {
        if self.georeference.is_same(&found) {
            return Ok(());
        }
        let (first, second, expected) = (first.into(), file.into(), self.georeference);
        Err(StepsError::Different { first, expected, second, found })
    }
}

/// The rasters of a folder, not of those in it, in order of their names.
fn rasters(path: &Path, options: &Options) -> Result<Vec<Found>, StepsError> {
    let io = |source| StepsError::Io { path: path.into(), source };
    let mut found = Vec::new();
    for entry in fs::read_dir(path).map_err(io)? {
        let path = entry.map_err(io)?.path();
        if let Some(name) = Name::of_raster(&path).filter(|_| path.is_file()) {
            // Without a number, no step.
            let quantity = name.quantity(&options.series).filter(|_| !name.numbers.is_empty());
            found.push(Found { path, name, quantity });
        }
    }
    found.sort_by(|first, second| first.path.cmp(&second.path));
    Ok(found)
}

/// Takes files of unknown names for depths, if all are of one series.
fn take_for_depth(folder: &Path, found: &mut [Found]) -> Result<(), StepsError> {
    let is_alone = found.len() == 1;
    let candidates = || found.iter().filter(|file| is_alone || !file.name.numbers.is_empty());
    let series: BTreeSet<String> = candidates().map(|file| file.name.series()).collect();
    if series.len() != 1 {
        let all: BTreeSet<String> = found.iter().map(|file| file.name.series()).collect();
        return Err(StepsError::Unknown { path: folder.into(), series: all.into_iter().collect() });
    }
    for file in found.iter_mut().filter(|file| series.contains(&file.name.series())) {
        file.quantity = Some(Quantity::Depth);
    }
    Ok(())
}

/// The files by step, and those that are no step.
fn sorted(found: Vec<Found>) -> Result<(Vec<Files>, Vec<PathBuf>), StepsError> {
    let mut steps: BTreeMap<Vec<Number>, Files> = BTreeMap::new();
    let mut left_out = Vec::new();
    for Found { path, name, quantity } in found {
        let Some(quantity) = quantity else {
            left_out.push(path);
            continue;
        };
        let files = steps.entry(name.numbers).or_default();
        if let Some(first) = files.insert(quantity, path.clone()) {
            return Err(StepsError::Twice { first, second: path, quantity });
        }
    }
    Ok((steps.into_values().collect(), left_out))
}

/// The time of each step in seconds.
fn times(path: &Path, steps: &[Files], times: &Times) -> Result<Vec<f64>, StepsError> {
    match times {
        Times::OfFile if steps.len() > 1 => Err(StepsError::NoTimes { path: path.into(), count: steps.len() }),
        Times::OfFile => Ok(vec![0.0; steps.len()]),
        Times::Every(interval) if interval.is_finite() && *interval > 0.0 => {
            Ok((0..steps.len()).map(|index| index as f64 * interval).collect())
        }
        Times::Every(interval) => Err(StepsError::Interval(*interval)),
        Times::Table(table) => Table::read(table)?.times(steps),
    }
}
