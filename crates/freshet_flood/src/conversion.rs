//! From the steps of a model and its terrain to a folder of maps.
//!
//! The steps are read twice. The first time, maps of the whole flood are gathered and everything is checked: nothing is
//! written before the last step was found good. The second time the steps themselves are written. Memory holds one step, the
//! one before it, and the maps.

mod gathered;
mod summary;

use std::path::{Path, PathBuf};

use glam::DVec2;
use thiserror::Error;

use crate::arrival::{ArrivalError, ArrivalOptions};
use crate::flow_map::FlowMap;
use crate::maps::{Manifest, Map, MapsError, MapsWriter, Smoothing, Sources, VERSION};
use crate::maxima::Maxima;
use crate::raster::Raster;
use crate::step::{Quantity, Step};
use crate::steps::{Steps, StepsError};
use crate::terrain::{NotCovered, normals};
use gathered::{Gathered, Source};
pub use summary::{Amount, Progress, Summary};

/// What can be converted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// Heights and normals of the terrain.
    Terrain,
    /// The arrival map.
    Arrival,
    /// Depths at every step.
    Depth,
    /// Speeds, velocities and levels at every step, where the model wrote them.
    Velocity,
    /// The flow map.
    Flow,
    /// Greatest depth, greatest speed, duration and hazard rating.
    Maxima,
}

impl Part {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::Terrain, Self::Arrival, Self::Depth, Self::Velocity, Self::Flow, Self::Maxima];

    /// The word for it: `terrain`, `arrival`, `depth`, `velocity`, `flow` or `maxima`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Terrain => "terrain",
            Self::Arrival => "arrival",
            Self::Depth => "depth",
            Self::Velocity => "velocity",
            Self::Flow => "flow",
            Self::Maxima => "maxima",
        }
    }
}

/// Which cells are converted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Crop {
    /// The least rectangle with all that is ever wet, and one cell more on every side where there is one.
    #[default]
    Wet,
    /// All that the model has.
    All,
    /// The cells that a rectangle on the map meets: (easting, northing) of its south-western and north-eastern corner.
    Rectangle(DVec2, DVec2),
}

/// How a flood is converted.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// What is converted. Default: everything.
    pub parts: Vec<Part>,
    /// How the arrival map is made, and which depth is wet.
    pub arrival: ArrivalOptions,
    /// Which cells are converted.
    pub crop: Crop,
    /// Depths err by at most half of this, m, above zero. Default: 0.001, which reaches to 65 m.
    pub precision: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { parts: Part::ALL.to_vec(), arrival: ArrivalOptions::default(), crop: Crop::default(), precision: 1e-3 }
    }
}

/// Why a flood cannot be converted.
#[derive(Debug, Error)]
pub enum ConversionError {
    /// A step cannot be read.
    #[error(transparent)]
    Steps(#[from] StepsError),
    /// The steps do not make an arrival map.
    #[error("{}: {source}", .path.display())]
    Arrival {
        /// The folder or file of the steps.
        path: PathBuf,
        /// What is wrong.
        source: ArrivalError,
    },
    /// The terrain lies elsewhere.
    #[error(transparent)]
    NotCovered(#[from] NotCovered),
    /// There is only one step.
    #[error("{}: expected at least two steps, found one: nothing moves", .0.display())]
    OneStep(PathBuf),
    /// Nothing is wet.
    #[error("{}: no cell of any step is {threshold} m deep or more: there is no flood", .path.display())]
    AllDry {
        /// The folder or file of the steps.
        path: PathBuf,
        /// Depth from which on a cell would be wet, m.
        threshold: f32,
    },
    /// The model wrote levels but no depths, and there is no terrain to take from them.
    #[error("{}: depths of steps that only tell levels need the terrain", .0.display())]
    NoTerrain(PathBuf),
    /// The rectangle to convert meets no cell.
    #[error("the rectangle to crop to lies outside the steps")]
    Outside,
    /// The precision is no length.
    #[error("the precision must be a finite number of metres above zero, not {0}")]
    Precision(f64),
    /// Pixels of 16 bits do not reach so deep.
    #[error("a depth of {depth} m needs a precision of {needed:.1e} m or coarser, and no finer threshold")]
    TooDeep {
        /// The greatest depth, m.
        depth: f32,
        /// The finest precision that reaches it, m.
        needed: f64,
    },
    /// The steps are not the same as when they were read first.
    #[error("{}: the steps changed while they were read", .0.display())]
    Changed(PathBuf),
    /// The maps cannot be written.
    #[error(transparent)]
    Maps(#[from] MapsError),
}

/// Converts `steps`, over `terrain` (with its name) if it is known, into a folder at `place`, which appears whole or not at
/// all. `progress` is called after every step.
///
/// # Errors
/// [`ConversionError`]; then nothing is written, and what was at `place` stays.
pub fn convert(
    steps: &Steps,
    terrain: Option<(&str, &Raster)>,
    options: &Options,
    place: &Path,
    mut progress: impl FnMut(Progress) + Send,
) -> Result<Summary, ConversionError> {
    if !(options.precision.is_finite() && options.precision > 0.0) {
        return Err(ConversionError::Precision(options.precision));
    }
    let source = Source::new(steps, terrain)?;
    let maps = Gathered::read(&source, options, &mut progress)?;
    progress(Progress::Maps(maps.amounts.len()));
    let mut writer = MapsWriter::new(place, manifest(&source, &maps, options))?;
    // To pack the flow map takes as long as all else.
    let flow = || {
        let is_wanted = options.parts.contains(&Part::Flow);
        is_wanted.then(|| FlowMap::new(maps.window.of(&maps.current), None).encode()).transpose()
    };
    let others = || {
        write_maps(&mut writer, &source, &maps, &options.parts)?;
        write_steps(&mut writer, &source, &maps, &options.parts, &mut progress)
    };
    let (others, flow) = rayon::join(others, flow);
    others?;
    if let Some(bytes) = flow.map_err(MapsError::from)? {
        writer.add_flow(&bytes)?;
    }
    Ok(Summary {
        window: maps.window,
        wet_cells: maps.arrival.after.values().iter().filter(|after| !after.is_nan()).count(),
        last_arrival: maps.arrival.last().unwrap_or_default(),
        terrain: source.bed.map(|(.., resampling)| resampling),
        bytes: writer.finish()?,
        steps: maps.amounts,
    })
}

fn manifest(source: &Source, maps: &Gathered, options: &Options) -> Manifest {
    let ArrivalOptions { radius, threshold, level_share } = options.arrival;
    let name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let sources = Sources {
        steps: name(source.steps.path()),
        terrain: source.bed.as_ref().map(|(name, _, resampling)| ((*name).into(), *resampling)),
    };
    Manifest {
        version: VERSION,
        georeference: maps.window.georeference(&source.steps.georeference()),
        window: maps.window,
        threshold,
        precision: options.precision,
        arrival: Smoothing { radius, level_share },
        sources,
        maps: Default::default(),
        flow: None,
        normals: None,
        steps: Vec::new(),
    }
}

fn write_maps(
    writer: &mut MapsWriter,
    source: &Source,
    maps: &Gathered,
    parts: &[Part],
) -> Result<(), ConversionError> {
    let window = maps.window;
    if let Some((_, bed, _)) = source.bed.as_ref().filter(|_| parts.contains(&Part::Terrain)) {
        writer.add_map(Map::Terrain, &window.of(bed))?;
        writer.add_normals(&window.of(&normals(bed)))?;
    }
    if parts.contains(&Part::Arrival) {
        writer.add_map(Map::Arrival, &window.of(&maps.arrival.after))?;
    }
    if parts.contains(&Part::Maxima) {
        let Maxima { depth, speed, duration, hazard } = &maps.maxima;
        writer.add_map(Map::MaximumDepth, &window.of(depth))?;
        if let Some(speed) = speed {
            writer.add_map(Map::MaximumSpeed, &window.of(speed))?;
        }
        writer.add_map(Map::Duration, &window.of(duration))?;
        writer.add_map(Map::Hazard, &window.of(hazard))?;
    }
    Ok(())
}

fn write_steps(
    writer: &mut MapsWriter,
    source: &Source,
    maps: &Gathered,
    parts: &[Part],
    progress: &mut impl FnMut(Progress),
) -> Result<(), ConversionError> {
    let wanted = |quantity: &Quantity| match quantity {
        Quantity::Depth => parts.contains(&Part::Depth),
        _ => parts.contains(&Part::Velocity),
    };
    let quantities: Vec<Quantity> = Quantity::ALL.into_iter().filter(wanted).collect();
    let times: Vec<f64> = maps.amounts.iter().map(|amount| amount.time).collect();
    let changed = || ConversionError::Changed(source.path());
    let mut written = 0;
    // Times belong to the flood also if no step is written.
    if quantities.is_empty() {
        return times.into_iter().try_for_each(|time| Ok(writer.add_step(&Step::new(time), &[])?));
    }
    for step in source.iter() {
        let step = step?;
        let depth = step.get(Quantity::Depth).filter(|_| times.get(written) == Some(&step.time));
        let is_same = depth.is_some_and(|depth| depth.size() == maps.arrival.after.size());
        if !is_same {
            return Err(changed());
        }
        let cut = quantities.iter().filter_map(|quantity| Some((*quantity, maps.window.of(step.get(*quantity)?))));
        let cut = cut.fold(Step::new(step.time), |cut, (quantity, grid)| cut.with(quantity, grid));
        writer.add_step(&cut, &quantities)?;
        written += 1;
        progress(Progress::Written(written));
    }
    if written == times.len() { Ok(()) } else { Err(changed()) }
}
