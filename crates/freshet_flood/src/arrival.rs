//! Arrival maps: when the water first reaches each cell of a flood.
//!
//! A model tells at which step a cell is first wet: i, say, so that the water comes in (t₍ᵢ₋₁₎, tᵢ]. An arrival map says when
//! in between, so that a flood shown at any time has a front that moves. Symbols: a arrival, t times of the steps, d depth.
//!
//! 1. **Front.** Between two steps the front runs evenly from the water before to the water after. Every cell's time is then
//!    spread over the water it is connected with by a Gaussian, cut off at its bounds again and again, so that fronts are
//!    smooth from step to step. J11 gets that by a flood fill that adds Gaussian after Gaussian; this does not depend on the
//!    order of visits, and knows fronts that run farther in a step than the Gaussian reaches.
//! 2. **Level.** Within the same bounds the depths tell when the water's level passes the cell's bed (`waterline`): creeks
//!    are wet before banks. a = w · level + (1 − w) · front, or the front alone where the level tells nothing.
//! 3. **Downstream.** What would be wet before everything around it, without water springing up there, is raised: the wet
//!    area at any time can be reached from its sources.
//!
//! All of it is the same for any number of threads, and takes time in proportion to the number of cells; the Gaussian also
//! in proportion to its radius squared.

mod diffusion;
mod downstream;
mod way;

use freshet_hydro::grid::Grid;
use glam::UVec2;
use rayon::prelude::*;
use thiserror::Error;

use crate::step::{Quantity, Step};
use crate::waterline::{Pools, USUAL_THRESHOLD, wettings};
use diffusion::Bounded;

/// Marks cells that are never wet.
const NEVER: u32 = u32::MAX;

/// The greatest radius of the Gaussian in cells: beyond it one map of a city takes minutes.
pub const MOST_RADIUS: u32 = 100;

/// How an arrival map is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArrivalOptions {
    /// Three standard deviations of the Gaussian, in cells, 0…[`MOST_RADIUS`]; 14 by default. More makes fronts rounder
    /// and more even, and takes time in proportion to its square.
    pub radius: u32,
    /// Depth in metres from which on a cell is wet, above 0; 0.02 by default.
    pub threshold: f32,
    /// Share w of the level in the time between two steps, 0…1; 0.7 by default. On a real flood with steps left out 0.6 to 0.8
    /// do about equally well, and less worse. 0 is the front alone.
    pub level_share: f32,
}

impl Default for ArrivalOptions {
    fn default() -> Self {
        Self { radius: 14, threshold: USUAL_THRESHOLD, level_share: 0.7 }
    }
}

/// Why steps do not make an arrival map.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ArrivalError {
    /// An option is out of its range.
    #[error("the {name} must be {expected}, not {found}")]
    Option {
        /// The option.
        name: &'static str,
        /// What is allowed.
        expected: &'static str,
        /// What was given.
        found: f32,
    },
    /// There is no step.
    #[error("a flood needs at least one step")]
    NoSteps,
    /// A step has no depths.
    #[error("the step at {0} s has no depths")]
    NoDepth(f64),
    /// A step has another shape than the first one.
    #[error("the step at {time} s has {} × {} cells, the first one {} × {}", .found.x, .found.y, .expected.x, .expected.y)]
    Size {
        /// Its time, s.
        time: f64,
        /// Its columns and rows.
        found: UVec2,
        /// Those of the first step.
        expected: UVec2,
    },
    /// A step is not later than the one before it.
    #[error("the step at {found} s follows one at {before} s: times must increase")]
    Time {
        /// Its time, s.
        found: f64,
        /// That of the step before it, s.
        before: f64,
    },
}

/// When water first reaches each cell.
#[derive(Clone, Debug, PartialEq)]
pub struct ArrivalMap {
    /// Time of the first step, s since the beginning of the data.
    pub start: f64,
    /// Seconds from `start` until the cell is wet: 0 where it is wet at the first step, NaN where it never is.
    pub after: Grid<f32>,
}

/// Makes an arrival map of steps that come one at a time.
///
/// It holds one raster of depths and two of what is known of the first wetting.
#[derive(Clone, Debug)]
pub struct ArrivalBuilder {
    options: ArrivalOptions,
    times: Vec<f64>,
    depth: Option<Grid<f32>>,
    /// The step at which each cell is first wet, or [`NEVER`].
    first: Vec<u32>,
    /// When the level passes the cell, as a share of the interval before that step; NaN if it tells nothing.
    share: Vec<f32>,
}

impl ArrivalBuilder {
    /// A map that has seen no step yet.
    ///
    /// # Errors
    /// [`ArrivalError::Option`] if an option is out of its range.
    pub fn new(options: ArrivalOptions) -> Result<Self, ArrivalError> {
        let ArrivalOptions { radius, threshold, level_share } = options;
        let checks = [
            ("radius", "0 to 100 cells", radius as f32, radius <= MOST_RADIUS),
            ("threshold", "a finite depth above 0 m", threshold, threshold.is_finite() && threshold > 0.0),
            ("share of the level", "0 to 1", level_share, (0.0..=1.0).contains(&level_share)),
        ];
        match checks.into_iter().find(|(.., is_right)| !is_right) {
            Some((name, expected, found, _)) => Err(ArrivalError::Option { name, expected, found }),
            None => Ok(Self { options, times: Vec::new(), depth: None, first: Vec::new(), share: Vec::new() }),
        }
    }

    /// Takes the next step.
    ///
    /// # Errors
    /// [`ArrivalError`] if it has no depths, another shape than the first step, or is not later than the last one. The
    /// builder is as before then.
    pub fn add(&mut self, step: &Step) -> Result<(), ArrivalError> {
        let depth = step.get(Quantity::Depth).ok_or(ArrivalError::NoDepth(step.time))?;
        let last = self.times.last().copied().unwrap_or(f64::NEG_INFINITY);
        if step.time.is_nan() || step.time <= last {
            return Err(ArrivalError::Time { found: step.time, before: last });
        }
        let index = self.times.len() as u32;
        let threshold = self.options.threshold;
        match self.depth.as_ref() {
            None => {
                let first = |depth: &f32| if *depth >= threshold { 0 } else { NEVER };
                self.first = depth.values().par_iter().map(first).collect();
                self.share = vec![f32::NAN; depth.values().len()];
            }
            Some(before) if before.size() != depth.size() => {
                let (found, expected) = (depth.size(), before.size());
                return Err(ArrivalError::Size { time: step.time, found, expected });
            }
            Some(before) => {
                for wetting in wettings(before.values(), depth.values(), depth.size(), threshold, Pools::Unknown) {
                    if self.first[wetting.place] == NEVER {
                        self.first[wetting.place] = index;
                        self.share[wetting.place] = wetting.share;
                    }
                }
            }
        }
        self.times.push(step.time);
        self.depth = Some(depth.clone());
        Ok(())
    }

    /// The map of all steps so far.
    ///
    /// # Errors
    /// [`ArrivalError::NoSteps`] if there was none.
    pub fn finish(self) -> Result<ArrivalMap, ArrivalError> {
        let (Some(depth), Some(start)) = (&self.depth, self.times.first().copied()) else {
            return Err(ArrivalError::NoSteps);
        };
        let size = depth.size();
        let bounds = self.bounds(start, size);
        let front = diffusion::diffused(&bounds, size, diffusion::passes(self.options.radius));
        let cells = bounds.par_iter().zip(&front).zip(&self.share);
        let mut times: Vec<f32> = cells.map(|((bounds, front), share)| self.arrival(bounds, *front, *share)).collect();
        downstream::run_downstream(&mut times, &self.first, size);
        let mut times = times.into_iter();
        Ok(ArrivalMap { start, after: depth.map(|_| times.next().unwrap_or(f32::NAN)) })
    }

    /// What the steps alone tell of each cell: its bounds, and how far between them the front is there if it runs evenly, in
    /// seconds after the first step.
    fn bounds(&self, start: f64, size: UVec2) -> Vec<Bounded> {
        let after = |step: u32| (self.times[step as usize] - start) as f32;
        let bounded = |(first, share): (&u32, f32)| match *first {
            NEVER => Bounded { value: f32::NAN, least: f32::NAN, most: f32::NAN },
            first => {
                let (least, most) = (after(first.saturating_sub(1)), after(first));
                Bounded { value: least + share * (most - least), least, most }
            }
        };
        self.first.par_iter().zip(way::shares(&self.first, size)).map(bounded).collect()
    }

    /// Arrival from what front and level tell, within its bounds, the lower one excluded.
    fn arrival(&self, bounds: &Bounded, front: f32, level: f32) -> f32 {
        let Bounded { least, most, .. } = *bounds;
        let weight = if level.is_nan() { 0.0 } else { self.options.level_share };
        let level = if level.is_nan() { front } else { least + level * (most - least) };
        let time = weight * level + (1.0 - weight) * front;
        // A cell that is dry at a step is wet after it: by a thousandth of the interval at least.
        time.max(least + 1e-3 * (most - least)).min(most)
    }
}

impl ArrivalMap {
    /// The latest arrival in seconds after `start`; `None` if no cell is ever wet.
    pub fn last(&self) -> Option<f32> {
        self.after.values().iter().copied().filter(|after| !after.is_nan()).reduce(f32::max)
    }
}
