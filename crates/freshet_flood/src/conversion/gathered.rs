//! The first reading of the steps: what they amount to, and whether they can be converted.

use std::path::PathBuf;

use freshet_hydro::grid::Grid;
use glam::Vec2;

use super::{Amount, ConversionError, Crop, Options, Progress};
use crate::arrival::{ArrivalBuilder, ArrivalMap};
use crate::current::CurrentBuilder;
use crate::maps::deepest;
use crate::maxima::{Maxima, MaximaBuilder};
use crate::raster::Raster;
use crate::step::{Quantity, Step};
use crate::steps::Steps;
use crate::terrain::{Resampling, on_raster};
use crate::window::Window;

/// Steps and the terrain under them.
pub(super) struct Source<'a> {
    pub steps: &'a Steps,
    /// Name, elevations on the cells of the steps, and how they came there.
    pub bed: Option<(&'a str, Grid<f32>, Resampling)>,
}

impl<'a> Source<'a> {
    pub fn new(steps: &'a Steps, terrain: Option<(&'a str, &Raster)>) -> Result<Self, ConversionError> {
        let bed = match terrain {
            None => None,
            Some((name, terrain)) => {
                let (grid, how) = on_raster(&terrain.grid, &terrain.georeference, &steps.georeference())?;
                Some((name, grid, how))
            }
        };
        Ok(Self { steps, bed })
    }

    pub fn path(&self) -> PathBuf {
        self.steps.path().into()
    }

    /// The steps, with depths.
    pub fn iter(&self) -> impl Iterator<Item = Result<Step, ConversionError>> {
        self.steps.iter().map(|step| self.with_depth(step?))
    }

    /// The step with the depth of its level over the terrain, if it has none.
    fn with_depth(&self, step: Step) -> Result<Step, ConversionError> {
        if step.get(Quantity::Depth).is_some() {
            return Ok(step);
        }
        let Some(level) = step.get(Quantity::Level) else { return Ok(step) };
        let (_, bed, _) = self.bed.as_ref().ok_or_else(|| ConversionError::NoTerrain(self.path()))?;
        let mut depth = level.clone();
        for (depth, bed) in depth.values_mut().iter_mut().zip(bed.values()) {
            *depth = (*depth - bed).max(0.0);
        }
        Ok(step.with(Quantity::Depth, depth))
    }
}

/// What the first reading tells.
pub(super) struct Gathered {
    pub arrival: ArrivalMap,
    pub maxima: Maxima,
    pub current: Grid<Vec2>,
    pub amounts: Vec<Amount>,
    pub window: Window,
}

impl Gathered {
    pub fn read(
        source: &Source,
        options: &Options,
        progress: &mut impl FnMut(Progress),
    ) -> Result<Self, ConversionError> {
        let wrong = |error| ConversionError::Arrival { path: source.path(), source: error };
        let threshold = options.arrival.threshold;
        let mut arrival = ArrivalBuilder::new(options.arrival).map_err(wrong)?;
        let mut maxima = MaximaBuilder::new(threshold);
        let mut current = CurrentBuilder::new(threshold);
        let mut amounts = Vec::new();
        for step in source.iter() {
            let step = step?;
            arrival.add(&step).map_err(wrong)?;
            maxima.add(&step);
            current.add(&step);
            amounts.extend(step.get(Quantity::Depth).map(|depth| Amount::of(step.time, depth, threshold)));
            progress(Progress::Read(amounts.len()));
        }
        let arrival = arrival.finish().map_err(wrong)?;
        let all_dry = || ConversionError::AllDry { path: source.path(), threshold };
        let wet = Window::of_cells(&arrival.after, |after| !after.is_nan()).ok_or_else(all_dry)?;
        if amounts.len() < 2 {
            return Err(ConversionError::OneStep(source.path()));
        }
        let georeference = source.steps.georeference();
        let window = match options.crop {
            Crop::Wet => wet.grown(1, georeference.size),
            Crop::All => Window::all(georeference.size),
            Crop::Rectangle(from, to) => Window::of_map(&georeference, from, to).ok_or(ConversionError::Outside)?,
        };
        let maxima = maxima.finish(&arrival).ok_or_else(all_dry)?;
        let current = current.finish(&arrival, &maxima.depth);
        check_depths(&maxima.depth, options)?;
        Ok(Self { arrival, maxima, current, amounts, window })
    }
}

fn check_depths(depths: &Grid<f32>, options: &Options) -> Result<(), ConversionError> {
    let depth = depths.values().iter().copied().fold(0.0, f32::max);
    if f64::from(depth) <= deepest(options.precision, options.arrival.threshold) {
        return Ok(());
    }
    // A little more, so that the number can be printed with two digits and taken as it stands.
    Err(ConversionError::TooDeep { depth, needed: 1.06 * f64::from(depth) / f64::from(u16::MAX) })
}
