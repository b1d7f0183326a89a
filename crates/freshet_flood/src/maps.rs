//! The written form of a flood: a folder of 16-bit PNG pictures and one manifest, `flood.ron`.
//!
//! ```text
//! flood.ron                    all that is no picture: version, place on the map, times, scales ([`Manifest`])
//! terrain.png  normals.png     the ground
//! arrival.png  flow.png        when the water comes, and the current
//! maximum_depth.png  maximum_speed.png  duration.png  hazard.png
//! depth/0000.png …             depth at every step; speed, level, east and north where the model wrote them
//! ```
//! All pictures are of one size, one pixel a cell, the top row north. In grey ones a pixel of 0 is empty (dry, or without
//! data) and others mean offset + scale · pixel, by the numbers that the manifest gives for each picture.
//!
//! Depths err by half of the precision at most. What is dry stays exactly dry, and nothing passes the threshold between dry
//! and wet, so that interpolation between steps is the same as with the model's own numbers. Other values err by half of
//! their scale, 1 / 131 068 of the picture's range; arrivals are rounded up by less than 1 / 65 534.

mod error;
mod manifest;
mod picture;
mod writer;

use std::fs;
use std::path::{Component, Path, PathBuf};
use std::sync::OnceLock;

use freshet_hydro::grid::Grid;
use glam::Vec3;
use serde::Deserialize;

use crate::arrival::ArrivalMap;
use crate::flow_map::{Defaults, FlowMap};
use crate::georeference::Georeference;
use crate::incremental::MOST_CELLS;
use crate::interpolation::{Interval, quantity_at};
use crate::step::{Quantity, Step};
pub use error::MapsError;
pub use manifest::{Entry, FILE, Manifest, Map, Picture, Smoothing, Sources, VERSION};
use picture::Scale;
pub(crate) use picture::deepest;
pub use writer::MapsWriter;

/// What pixel 0 of a step's picture means.
fn empty_of(quantity: Quantity) -> f32 {
    if quantity == Quantity::Level { f32::NAN } else { 0.0 }
}

/// A flood in its folder. Opening it reads the manifest; pictures are read when they are asked for.
#[derive(Debug)]
pub struct FloodMaps {
    folder: PathBuf,
    manifest: Manifest,
    times: Vec<f64>,
    arrival: OnceLock<ArrivalMap>,
}

impl FloodMaps {
    /// Opens the folder of a flood.
    ///
    /// # Errors
    /// [`MapsError`] if there is no manifest, it is of another version, or it says what cannot be: no steps, times that do
    /// not increase, no cells, a place that is no number, files outside the folder.
    pub fn open(folder: impl Into<PathBuf>) -> Result<Self, MapsError> {
        let folder = folder.into();
        let path = folder.join(FILE);
        let text = fs::read_to_string(&path).map_err(|source| MapsError::io(&path, source))?;
        let wrong = |reason: String| MapsError::Manifest { path: path.clone(), reason };

        /// What is read before anything that another version may have changed.
        #[derive(Deserialize)]
        struct Versioned {
            version: u32,
        }
        let version = ron::from_str(&text).map(|Versioned { version }| version);
        match version.map_err(|error| wrong(error.to_string()))? {
            VERSION => {}
            found => return Err(MapsError::Version { path, found }),
        }
        let manifest: Manifest = ron::from_str(&text).map_err(|error| wrong(error.to_string()))?;
        check(&manifest).map_err(|reason| wrong(reason.into()))?;
        let times = manifest.steps.iter().map(|step| step.time).collect();
        Ok(Self { folder, manifest, times, arrival: OnceLock::new() })
    }

    /// Whether a folder holds a flood in this form.
    pub fn is_in(folder: impl AsRef<Path>) -> bool {
        folder.as_ref().join(FILE).is_file()
    }

    /// Its folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Everything that is no picture.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// Times of the steps since the beginning of the data, s, increasing, at least one.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Where the cells of all rasters lie on the map.
    pub fn georeference(&self) -> &Georeference {
        &self.manifest.georeference
    }

    /// Depth in metres from which on a cell is wet.
    pub fn threshold(&self) -> f32 {
        self.manifest.threshold
    }

    /// The quantities that the step at `index` has, in the order of [`Quantity::ALL`].
    pub fn quantities(&self, index: usize) -> impl Iterator<Item = Quantity> {
        self.manifest.steps.get(index).into_iter().flat_map(|step| step.pictures.keys().copied())
    }

    /// One value for each cell of the whole flood, in the unit that [`Map`] tells.
    ///
    /// # Errors
    /// [`MapsError::Missing`] if it was not converted, or another if its picture cannot be read.
    pub fn map(&self, map: Map) -> Result<Grid<f32>, MapsError> {
        let picture = self.manifest.maps.get(&map).ok_or_else(|| self.missing(map.name()))?;
        self.read(picture, map.empty())
    }

    /// Elevation of the terrain, m; NaN without data.
    ///
    /// # Errors
    /// As for [`FloodMaps::map`].
    pub fn terrain(&self) -> Result<Grid<f32>, MapsError> {
        self.map(Map::Terrain)
    }

    /// Unit normals of the terrain (east, up, south).
    ///
    /// # Errors
    /// As for [`FloodMaps::map`].
    pub fn normals(&self) -> Result<Grid<Vec3>, MapsError> {
        let file = self.manifest.normals.as_ref().ok_or_else(|| self.missing("terrain"))?;
        let Georeference { size, cell_size, .. } = self.manifest.georeference;
        Ok(Grid::new(size, cell_size as f32, picture::read_normals(&self.folder.join(file), size)?)?)
    }

    /// When the water first reaches each cell. Read once.
    ///
    /// # Errors
    /// As for [`FloodMaps::map`].
    pub fn arrival(&self) -> Result<&ArrivalMap, MapsError> {
        if let Some(arrival) = self.arrival.get() {
            return Ok(arrival);
        }
        let start = self.times.first().copied().unwrap_or_default();
        let after = self.map(Map::Arrival)?;
        Ok(self.arrival.get_or_init(|| ArrivalMap { start, after }))
    }

    /// The current.
    ///
    /// # Errors
    /// As for [`FloodMaps::map`].
    pub fn flow(&self) -> Result<FlowMap, MapsError> {
        let file = self.manifest.flow.as_ref().ok_or_else(|| self.missing("flow"))?;
        let path = self.folder.join(file);
        let map = FlowMap::read(&path, Defaults::default())?;
        let (found, expected) = (map.velocity.size(), self.manifest.georeference.size);
        if found == expected { Ok(map) } else { Err(MapsError::Size { path, found, expected }) }
    }

    /// The step at `index`, with all that was converted.
    ///
    /// # Errors
    /// [`MapsError::NoStep`] from the number of steps on, or another if a picture cannot be read.
    pub fn step(&self, index: usize) -> Result<Step, MapsError> {
        let entry = self.entry(index)?;
        entry.pictures.iter().try_fold(Step::new(entry.time), |step, (quantity, picture)| {
            Ok(step.with(*quantity, self.read(picture, empty_of(*quantity))?))
        })
    }

    /// A quantity of the step at `index`. Depths and speeds are 0 where it is dry, levels NaN; the level is terrain and
    /// depth together if the model wrote none.
    ///
    /// # Errors
    /// As for [`FloodMaps::step`], and [`MapsError::Missing`] if it was not converted.
    pub fn quantity(&self, index: usize, quantity: Quantity) -> Result<Grid<f32>, MapsError> {
        match self.entry(index)?.pictures.get(&quantity) {
            Some(picture) => self.read(picture, empty_of(quantity)),
            None if quantity == Quantity::Level => self.level_of(&self.depth(index)?),
            None => Err(self.missing(quantity.name())),
        }
    }

    /// Depths of the step at `index`, m; 0 where it is dry.
    ///
    /// # Errors
    /// As for [`FloodMaps::quantity`].
    pub fn depth(&self, index: usize) -> Result<Grid<f32>, MapsError> {
        self.quantity(index, Quantity::Depth)
    }

    /// What happens between the step at `index` and the next one: depths and turns, what a viewer keeps while it plays it.
    ///
    /// # Errors
    /// As for [`FloodMaps::quantity`]. The arrival map is used if it was converted.
    pub fn interval(&self, index: usize) -> Result<Interval, MapsError> {
        let step = |index: usize| Ok::<_, MapsError>((self.entry(index)?.time, self.depth(index)?));
        let arrival = match self.manifest.maps.contains_key(&Map::Arrival) {
            true => Some(self.arrival()?),
            false => None,
        };
        Ok(Interval::new(step(index)?, step(index + 1)?, arrival, self.manifest.threshold))
    }

    /// Number of the last step that is not after a time in seconds; the first one before all.
    pub fn step_before(&self, time: f64) -> usize {
        self.times.partition_point(|step| *step <= time).saturating_sub(1)
    }

    /// Depths at any time in seconds, m; those of the first or last step outside their times. Exact at the steps.
    ///
    /// # Errors
    /// As for [`FloodMaps::quantity`].
    pub fn depth_at(&self, time: f64) -> Result<Grid<f32>, MapsError> {
        self.quantity_at(Quantity::Depth, time)
    }

    /// A quantity at any time in seconds: see [`FloodMaps::depth_at`] and [`quantity_at`].
    ///
    /// # Errors
    /// As for [`FloodMaps::quantity`].
    pub fn quantity_at(&self, quantity: Quantity, time: f64) -> Result<Grid<f32>, MapsError> {
        let index = self.step_before(time);
        if index + 1 == self.times.len() || time <= self.times[index] {
            return self.quantity(index, quantity);
        }
        let interval = self.interval(index)?;
        let depth = interval.depth_at(time);
        if quantity == Quantity::Depth {
            return Ok(depth);
        }
        let has = self.entry(index)?.pictures.contains_key(&quantity);
        if quantity == Quantity::Level && !has {
            return self.level_of(&depth);
        }
        let steps = (self.step(index)?, self.step(index + 1)?);
        let values = quantity_at(&interval, (&steps.0, &steps.1), quantity, (time, &depth), empty_of(quantity));
        values.ok_or_else(|| self.missing(quantity.name()))
    }

    /// Level of water with this depth, NaN where it is dry.
    fn level_of(&self, depth: &Grid<f32>) -> Result<Grid<f32>, MapsError> {
        let mut level = self.terrain()?;
        for (level, depth) in level.values_mut().iter_mut().zip(depth.values()) {
            *level = if *depth >= self.manifest.threshold { *level + depth } else { f32::NAN };
        }
        Ok(level)
    }

    fn entry(&self, index: usize) -> Result<&Entry, MapsError> {
        self.manifest.steps.get(index).ok_or(MapsError::NoStep(index, self.times.len()))
    }

    fn missing(&self, what: &str) -> MapsError {
        MapsError::Missing { folder: self.folder.clone(), what: what.into() }
    }

    fn read(&self, picture: &Picture, empty: f32) -> Result<Grid<f32>, MapsError> {
        let Georeference { size, cell_size, .. } = self.manifest.georeference;
        let scale = Scale { scale: picture.scale, offset: picture.offset };
        let pixels = picture::read(&self.folder.join(&picture.file), size)?;
        let values = pixels.into_iter().map(|pixel| scale.value(pixel, empty)).collect();
        Ok(Grid::new(size, cell_size as f32, values)?)
    }
}

/// What a manifest says that cannot be.
fn check(manifest: &Manifest) -> Result<(), &'static str> {
    let Manifest { georeference, threshold, steps, maps, flow, normals, .. } = manifest;
    let pictures = maps.values().chain(steps.iter().flat_map(|step| step.pictures.values()));
    let is_number = |picture: &Picture| picture.scale.is_finite() && picture.offset.is_finite();
    let files = pictures.clone().map(|picture| &picture.file).chain(flow).chain(normals);
    let is_inside =
        |file: &String| Path::new(file).components().all(|component| matches!(component, Component::Normal(_)));
    let times = steps.iter().map(|step| step.time);
    let cells = u64::from(georeference.size.x) * u64::from(georeference.size.y);
    let is_place = georeference.corner.is_finite() && georeference.cell_size > 0.0;
    let checks = [
        (georeference.size.min_element() > 0, "expected at least one column and one row"),
        (cells <= MOST_CELLS, "expected at most 10⁸ cells"),
        (
            is_place && (georeference.cell_size as f32).is_normal(),
            "expected a place on the map and a cell size above zero",
        ),
        (threshold.is_finite() && *threshold > 0.0, "expected a threshold above 0 m"),
        (!steps.is_empty(), "expected at least one step"),
        (times.clone().all(f64::is_finite) && times.is_sorted_by(|a, b| a < b), "expected times that increase"),
        (pictures.clone().all(is_number), "expected scales and offsets that are numbers"),
        (files.clone().all(is_inside), "expected files inside the folder"),
    ];
    checks.into_iter().find(|(is_right, _)| !is_right).map_or(Ok(()), |(_, expected)| Err(expected))
}
