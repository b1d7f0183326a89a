//! What of a flood is played, and how.
use super::{FloodMaps, FloodState, MapsError};
use crate::{
    body::{Water, WaterBed, WaterBedError, WaterFoam, WaterInteraction, WaterOptics, WaterWaves},
    simulation::Simulated,
    surface::WaterSurface,
};
use bevy::prelude::*;
use std::sync::Arc;

/// Beside a [`Water`]: plays back a flood on it. Level and velocity of the data take the place of still water and flow map, as those of
/// a [simulation](crate::body::WaterSimulation) do; beside one, nothing is played.
///
/// The water must be as large as the flood and its middle is that of the flood; its height is the zero of the terrain's
/// elevations. [`Flood::water`] makes such a one.
///
/// Velocities are those of the data at any [`Flood::speed`]: what the model wrote, else speeds along the way of the front, else the front's
/// velocity from the arrival map.
#[derive(Component, Reflect, Clone, Debug)]
#[reflect(Component, Clone, Debug)]
#[require(FloodState, Simulated)]
pub struct Flood {
    #[reflect(ignore, default = "no_maps")]
    maps: Option<Arc<FloodMaps>>,
    /// Time in the data, s since its beginning; from the first step to the last. Default: that of the first step.
    pub time: f64,
    /// Whether it runs. Default true.
    pub playing: bool,
    /// Seconds of the data in a second, −10⁵…10⁵; runs backwards below 0. Default 60.
    pub speed: f32,
    /// Whether it begins anew at its end; otherwise it stops there. Default false.
    pub looping: bool,
    /// Whether frames wait for steps that are not read yet, for pictures and films; otherwise the last one stays, and the time. Default
    /// false.
    pub waits: bool,
    /// Factor on all elevations and depths, as drawn, asked and felt, 0.01…100; the bed must have it too. Default 1.
    pub exaggeration: f32,
}

fn no_maps() -> Option<Arc<FloodMaps>> {
    None
}

impl Flood {
    /// Plays `maps` from their first step on.
    pub fn new(maps: Arc<FloodMaps>) -> Self {
        Self {
            time: maps.times().first().copied().unwrap_or_default(),
            maps: Some(maps),
            playing: true,
            speed: 60.0,
            looping: false,
            waits: false,
            exaggeration: 1.0,
        }
    }

    /// A muddy water without waves that is as large as the flood and plays it. Its foam is born at the front, on four cells for each
    /// cell of the flood along an axis.
    pub fn water(maps: &Arc<FloodMaps>) -> impl Bundle + use<> {
        let cell = (maps.georeference().cell_size as f32 / 4.0).clamp(0.1, 100.0);
        (
            Water::new(Self::size(maps)),
            WaterOptics::MUDDY,
            WaterWaves::still(),
            // So that a kilometre away the shore is still cut by triangles of two cells.
            WaterSurface { cell: (2.0 * cell).clamp(0.15, 100.0), cells: 128, ..default() },
            WaterInteraction { cell, wavelength: (6.0 * cell).max(1.2), ..default() },
            // Fronts run together more slowly than rivers do; the shallow rim of what stands is no front.
            WaterFoam { shore: 0.0, breaking_threshold: 0.1, pattern_size: (2.0 * cell).max(1.5), ..default() },
            Self::new(maps.clone()),
        )
    }

    /// The ground under the flood; where the terrain has no data it goes on smoothly, and stays dry.
    ///
    /// # Errors
    /// [`FloodBedError`] if the flood was converted without a terrain, or it cannot be read.
    pub fn bed(maps: &FloodMaps) -> Result<WaterBed, FloodBedError> {
        Ok(WaterBed::new(maps.terrain()?)?.filled(f32::MIN))
    }

    /// Length of a flood along x (east) and z (south), m.
    pub fn size(maps: &FloodMaps) -> Vec2 {
        let place = maps.georeference();
        place.size.as_vec2() * place.cell_size as f32
    }

    /// What is played.
    pub fn maps(&self) -> Option<&Arc<FloodMaps>> {
        self.maps.as_ref()
    }

    /// Times of the first and the last step, s.
    pub fn span(&self) -> (f64, f64) {
        let times = self.maps.as_ref().map_or(&[][..], |maps| maps.times());
        (times.first().copied().unwrap_or_default(), times.last().copied().unwrap_or_default())
    }

    /// Its time, brought between the first and the last step.
    pub fn usable_time(&self) -> f64 {
        let (first, last) = self.span();
        if self.time.is_nan() { first } else { self.time.clamp(first, last) }
    }

    /// Lets `seconds` of the data pass, backwards if negative; at its end it stops or begins anew.
    pub fn advance(&mut self, seconds: f64) {
        let (first, last) = self.span();
        let time = self.usable_time() + seconds;
        let is_over = time < first || time > last;
        self.time = match self.looping && last > first {
            true if is_over => first + (time - first).rem_euclid(last - first),
            _ => time.clamp(first, last),
        };
        self.playing &= self.looping || !is_over;
    }

    /// Goes to the `count`-th step from here, backwards if negative, and stands there.
    pub fn step(&mut self, count: i32) {
        self.playing = false;
        let Some(maps) = &self.maps else { return };
        let (times, time) = (maps.times(), self.usable_time());
        // A time that is just off a step counts as that step.
        let near = 1e-6 * (1.0 + time.abs());
        let index = match count > 0 {
            true => times.partition_point(|step| *step <= time + near) as i64 - 1,
            false => times.partition_point(|step| *step < time - near) as i64,
        };
        let wanted = (index + i64::from(count)).clamp(0, times.len() as i64 - 1) as usize;
        self.time = times.get(wanted).copied().unwrap_or(time);
    }
}

/// Why there is no bed of a flood.
#[derive(thiserror::Error, Debug)]
pub enum FloodBedError {
    /// The terrain cannot be read.
    #[error(transparent)]
    Maps(#[from] MapsError),
    /// It makes no bed.
    #[error(transparent)]
    Bed(#[from] WaterBedError),
}
