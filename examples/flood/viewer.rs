//! What is looked at: the flood, its colouring, and the scales of these.
use bevy::{
    math::{DVec2, dvec2},
    prelude::*,
};
use bevy_freshet::{flood::FloodMaps, surface::ViewScale};
use freshet_flood::{maps::MapsError, step::Quantity};
use freshet_hydro::grid::Grid;
use std::sync::Arc;

/// How the water is shown.
#[derive(clap::ValueEnum, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coloring {
    /// As water
    #[default]
    Water,
    /// By its depth
    Depth,
    /// By its speed
    Speed,
    /// By the time at which it came
    Arrival,
    /// By the danger to people (Defra 2006)
    Hazard,
}

impl Coloring {
    pub const ALL: [Self; 5] = [Self::Water, Self::Depth, Self::Speed, Self::Arrival, Self::Hazard];

    pub fn name(self) -> &'static str {
        match self {
            Self::Water => "water",
            Self::Depth => "depth",
            Self::Speed => "speed",
            Self::Arrival => "arrival",
            Self::Hazard => "hazard",
        }
    }
}

/// Hazard ratings from which on there is danger, and for whom.
pub const HAZARDS: [(f32, &str); 4] = [(0.0, "caution"), (0.75, "for some"), (1.25, "for most"), (2.0, "for all")];

/// What is looked at.
#[derive(Resource)]
pub struct Viewer {
    pub maps: Arc<FloodMaps>,
    /// Elevations, with gaps filled.
    pub terrain: Arc<Grid<f32>>,
    /// Seconds from the first step to the first wetting.
    pub arrival: Option<Grid<f32>>,
    pub coloring: Coloring,
    pub exaggeration: f32,
    /// Greatest depth (m) and speed (m/s) of the scales.
    most: [f32; 2],
}

impl Viewer {
    /// # Errors
    /// [`MapsError`] if terrain or steps cannot be read.
    pub fn new(maps: Arc<FloodMaps>, coloring: Coloring, exaggeration: f32) -> Result<Self, MapsError> {
        let size = maps.georeference().size;
        let terrain = maps.terrain()?;
        let known: Vec<f32> = terrain.values().iter().copied().filter(|z| z.is_finite()).collect();
        let terrain = freshet_hydro::fill::fill_missing(&terrain, percentile(known, 0.02));
        let arrival = maps.arrival().ok().map(|arrival| arrival.after.clone()).filter(|grid| grid.size() == size);
        let steps = [maps.times().len() / 2, maps.times().len() - 1];
        let most = |quantity: Quantity| {
            let values = steps.iter().filter_map(|step| maps.quantity(*step, quantity).ok());
            let values = values.flat_map(Grid::into_values).filter(|value| *value > 0.0).collect();
            round(percentile(values, 0.995))
        };
        Ok(Self {
            most: [most(Quantity::Depth), most(Quantity::Speed)],
            maps,
            terrain: Arc::new(terrain),
            arrival,
            coloring,
            exaggeration,
        })
    }

    /// Values of the first and the last colour, and their unit.
    pub fn scale(&self) -> Option<ViewScale> {
        let (low, high, unit) = match self.coloring {
            Coloring::Water => return None,
            Coloring::Depth => (0.0, self.most[0], "m"),
            Coloring::Speed => (0.0, self.most[1], "m/s"),
            Coloring::Arrival => {
                let times = self.maps.times();
                ((times[0] / 60.0) as f32, (times[times.len() - 1] / 60.0) as f32, "min")
            }
            Coloring::Hazard => (0.0, HAZARDS.len() as f32, ""),
        };
        Some(ViewScale { low, high, unit })
    }

    /// Easting and northing of a place of the world (x, z).
    pub fn on_map(&self, place: Vec2) -> DVec2 {
        let map = self.maps.georeference();
        let middle = map.corner + 0.5 * map.cell_size * map.size.as_dvec2();
        middle + dvec2(place.x.into(), -f64::from(place.y))
    }

    /// The place of the world (x, z) with this easting and northing.
    pub fn in_world(&self, place: DVec2) -> Vec2 {
        let map = self.maps.georeference();
        let middle = map.corner + 0.5 * map.cell_size * map.size.as_dvec2();
        let from_middle = (place - middle).as_vec2();
        vec2(from_middle.x, -from_middle.y)
    }

    /// The cell with this easting and northing.
    ///
    /// # Errors
    /// Where the flood is, if it is not there.
    pub fn cell_on_map(&self, place: DVec2) -> Result<usize, String> {
        let map = self.maps.georeference();
        let cell = ((place - map.corner) / map.cell_size).floor();
        let is_inside = cell.cmpge(DVec2::ZERO).all() && cell.cmplt(map.size.as_dvec2()).all();
        if is_inside {
            // Rows begin in the north.
            let (column, row) = (cell.x as usize, map.size.y as usize - 1 - cell.y as usize);
            return Ok(row * map.size.x as usize + column);
        }
        let end = map.corner + map.cell_size * map.size.as_dvec2();
        Err(format!(
            "expected a place in the flood, E {} to {} and N {} to {}, found E {} N {}",
            map.corner.x, end.x, map.corner.y, end.y, place.x, place.y
        ))
    }

    /// When the water first reaches a cell, s in the data.
    pub fn arrival_of(&self, index: usize) -> Option<f64> {
        let after = self.arrival.as_ref()?.values()[index];
        after.is_finite().then(|| self.maps.times()[0] + f64::from(after))
    }
}

/// The colour of a class of hazard.
pub fn hazard_color(class: usize) -> LinearRgba {
    // From light to dark: the worst is the darkest.
    ViewScale::color(1.0 - class as f32 / (HAZARDS.len() - 1) as f32)
}

/// The value below which `share` of all are; 0 of none.
pub fn percentile(mut values: Vec<f32>, share: f32) -> f32 {
    let index = (values.len().saturating_sub(1)) as f64 * f64::from(share);
    // One value in its place is had in a tenth of the time of all.
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(index as usize, f32::total_cmp).1 }
}

/// The next round number: one digit that divides well, or 15, times a power of ten.
pub fn round(value: f32) -> f32 {
    if value <= 0.0 || !value.is_finite() {
        return 1.0;
    }
    let power = 10_f32.powf(value.log10().floor());
    [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0]
        .map(|digit| digit * power)
        .into_iter()
        .find(|round| *round >= value * 0.999)
        .unwrap_or(10.0 * power)
}
