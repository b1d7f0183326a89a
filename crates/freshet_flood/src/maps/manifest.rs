//! What stands beside the pictures of a flood: the file `flood.ron`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::georeference::Georeference;
use crate::step::Quantity;
use crate::terrain::Resampling;
use crate::window::Window;

/// Version of the written form. A reader refuses others.
pub const VERSION: u32 = 1;

/// Name of the manifest in the folder of a flood.
pub const FILE: &str = "flood.ron";

/// Everything about a flood that is no picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// [`VERSION`].
    pub version: u32,
    /// Where the cells of all pictures lie on the map, in metres.
    pub georeference: Georeference,
    /// Which cells of the model's rasters these are.
    pub window: Window,
    /// Depth in metres from which on a cell is wet.
    pub threshold: f32,
    /// Depths in metres err by at most half of this.
    pub precision: f64,
    /// How the arrival map was made.
    pub arrival: Smoothing,
    /// Where all of it comes from.
    pub sources: Sources,
    /// Pictures of the whole flood.
    pub maps: BTreeMap<Map, Picture>,
    /// The current as a picture that describes itself: [`crate::flow_map`].
    #[serde(default)]
    pub flow: Option<String>,
    /// Normals of the terrain, in 16-bit RGB: red east, green up, blue south, each 32768 + 32767 · component.
    #[serde(default)]
    pub normals: Option<String>,
    /// The steps in order of time.
    pub steps: Vec<Entry>,
}

/// Options of the arrival map: see [`crate::arrival::ArrivalOptions`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Smoothing {
    /// Cells.
    pub radius: u32,
    /// 0…1.
    pub level_share: f32,
}

/// What a flood was made from: names of files, without their folders.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sources {
    /// The folder or file of the steps.
    pub steps: String,
    /// The terrain, and how it was brought onto the cells of the steps.
    #[serde(default)]
    pub terrain: Option<(String, Resampling)>,
}

/// Pictures of the whole flood, one value for each cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Map {
    /// Elevation of the terrain, m; pixel 0 has no data.
    Terrain,
    /// Seconds from the first step to the first wetting: [`crate::arrival`]; pixel 0 is never wet.
    Arrival,
    /// Greatest depth, m.
    MaximumDepth,
    /// Greatest speed, m/s.
    MaximumSpeed,
    /// Time under water, s.
    Duration,
    /// Greatest hazard rating: [`crate::maxima::hazard_rating`].
    Hazard,
}

impl Map {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Terrain, Self::Arrival, Self::MaximumDepth, Self::MaximumSpeed, Self::Duration, Self::Hazard];

    /// Name of its picture, without ending.
    pub fn name(self) -> &'static str {
        match self {
            Self::Terrain => "terrain",
            Self::Arrival => "arrival",
            Self::MaximumDepth => "maximum_depth",
            Self::MaximumSpeed => "maximum_speed",
            Self::Duration => "duration",
            Self::Hazard => "hazard",
        }
    }

    /// What pixel 0 means: no data, or nothing.
    pub(super) fn empty(self) -> f32 {
        if matches!(self, Self::Terrain | Self::Arrival) { f32::NAN } else { 0.0 }
    }
}

/// A step and its pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Time since the beginning of the data, s.
    pub time: f64,
    /// Depth, and what else the model wrote. Depths and speeds are 0 at pixel 0, levels have no data there.
    pub pictures: BTreeMap<Quantity, Picture>,
}

/// A 16-bit grey picture, the top row north. A pixel of 0 is empty; others mean offset + scale · pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Picture {
    /// The file, in the folder of the manifest, with slashes between folders.
    pub file: String,
    /// Step between pixel values, above zero.
    pub scale: f64,
    /// What a pixel of 0 would mean if it were not empty.
    pub offset: f64,
}
