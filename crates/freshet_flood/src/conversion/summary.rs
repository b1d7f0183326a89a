//! What is told of a conversion, while it runs and when it is done.

use freshet_hydro::grid::Grid;
use rayon::prelude::*;

use crate::terrain::Resampling;
use crate::window::Window;

/// How far a conversion is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// So many steps were read the first time.
    Read(usize),
    /// The maps are being made; there are so many steps.
    Maps(usize),
    /// So many steps were written.
    Written(usize),
}

/// What was converted.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Time (s), volume (m³) and wet area (m²) of each step, over all cells of the model.
    pub steps: Vec<Amount>,
    /// The cells that were converted, of those of the model.
    pub window: Window,
    /// The cells that are ever wet.
    pub wet_cells: usize,
    /// The latest arrival, s since the first step.
    pub last_arrival: f32,
    /// How the terrain was brought onto the cells of the steps.
    pub terrain: Option<Resampling>,
    /// Bytes of all files.
    pub bytes: u64,
}

/// How much water there is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amount {
    /// Time since the beginning of the data, s.
    pub time: f64,
    /// Volume, m³.
    pub volume: f64,
    /// Wet area, m².
    pub area: f64,
}

impl Amount {
    pub(super) fn of(time: f64, depth: &Grid<f32>, threshold: f32) -> Self {
        // Row by row, so that the sum is the same for any number of threads.
        let rows = depth.values().par_chunks(depth.size().x as usize).map(|row| {
            let sum: f64 = row.iter().filter(|depth| **depth > 0.0).map(|depth| f64::from(*depth)).sum();
            (sum, row.iter().filter(|depth| **depth >= threshold).count())
        });
        let rows: Vec<(f64, usize)> = rows.collect();
        let cell = f64::from(depth.cell_size()).powi(2);
        let (sum, count) = rows.iter().fold((0.0, 0), |(sum, count), row| (sum + row.0, count + row.1));
        Self { time, volume: sum * cell, area: count as f64 * cell }
    }
}
