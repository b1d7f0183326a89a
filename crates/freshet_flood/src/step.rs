//! One instant of a flood.

use std::fmt;
use std::str::FromStr;

use freshet_hydro::grid::Grid;
use glam::Vec2;
use thiserror::Error;

/// What a hydraulic model tells of each cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
pub enum Quantity {
    /// Depth of the water, m. 0 or no data where it is dry.
    Depth,
    /// Speed of the water, averaged over its depth, m/s.
    Speed,
    /// Elevation of the water's surface, m.
    Level,
    /// Velocity of the water to the east (u), m/s.
    East,
    /// Velocity of the water to the north (v), m/s.
    North,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Depth, Self::Speed, Self::Level, Self::East, Self::North];

    /// The word for it: `depth`, `speed`, `level`, `east` or `north`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Speed => "speed",
            Self::Level => "level",
            Self::East => "east",
            Self::North => "north",
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.pad(self.name())
    }
}

/// That a text is no quantity's name.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("expected depth, speed, level, east or north, found “{0}”")]
pub struct QuantityError(pub String);

impl FromStr for Quantity {
    type Err = QuantityError;

    /// The quantity of a name as [`Quantity::name`] gives it, in any case.
    fn from_str(text: &str) -> Result<Self, QuantityError> {
        let quantity = Self::ALL.into_iter().find(|quantity| quantity.name().eq_ignore_ascii_case(text));
        quantity.ok_or_else(|| QuantityError(text.into()))
    }
}

/// The state of a flood at one time. All of its rasters are of one shape; NaN marks cells without data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Step {
    /// Time since the beginning of the data, s.
    pub time: f64,
    rasters: [Option<Grid<f32>>; Quantity::ALL.len()],
}

impl Step {
    /// A step that knows nothing yet.
    pub fn new(time: f64) -> Self {
        Self { time, rasters: Default::default() }
    }

    /// The step with one more raster, in place of what it had of that quantity.
    pub fn with(mut self, quantity: Quantity, raster: Grid<f32>) -> Self {
        self.rasters[quantity as usize] = Some(raster);
        self
    }

    /// The raster of a quantity, if the model wrote it.
    pub fn get(&self, quantity: Quantity) -> Option<&Grid<f32>> {
        self.rasters[quantity as usize].as_ref()
    }

    /// Speed of the water in m/s: as the model wrote it, or else the length of its velocity.
    pub fn speed(&self) -> Option<Grid<f32>> {
        let from_velocity = || self.velocity().map(|velocity| velocity.map(|velocity| velocity.length()));
        self.get(Quantity::Speed).cloned().or_else(from_velocity)
    }

    /// Velocity of the water (east, south) in m/s, if the model wrote both of its parts.
    pub fn velocity(&self) -> Option<Grid<Vec2>> {
        let (east, north) = (self.get(Quantity::East)?, self.get(Quantity::North)?);
        let mut north = north.values().iter();
        Some(east.map(|east| Vec2::new(*east, -north.next().unwrap_or(&f32::NAN))))
    }
}
