//! The current of a water.
use bevy::prelude::*;
use freshet_flood::flow_map::{Defaults, FlowMap, FlowMapError};
use freshet_hydro::grid::Grid;
use std::{path::Path, sync::Arc};

/// The current: a velocity in m/s at every place of the water, seen and felt alike. Without this component the water
/// stands still.
///
/// Velocities are horizontal, in the water's local frame: x along local x (east for an unturned water), y along local z
/// (south).
///
/// A map's velocities fade to zero at the waterline, over [`WaterFlow::BANK_DEPTH`]: its cells are wider than that.
#[derive(Component, Reflect, Clone, Debug)]
#[reflect(Component, Default, Clone, Debug)]
pub struct WaterFlow {
    /// Velocity of the whole water, m/s; a map adds to it. Default zero.
    pub uniform: Vec2,
    /// Factor on the map's velocities. Default 1.
    pub scale: f32,
    /// Velocities, m/s, on a grid centred on the water.
    #[reflect(ignore)]
    pub map: Option<Arc<Grid<Vec2>>>,
}

impl WaterFlow {
    /// Depth of water (m) from which on a map's velocity counts in full.
    pub const BANK_DEPTH: f32 = 0.1;

    /// The same velocity (m/s) everywhere.
    pub fn uniform(velocity: Vec2) -> Self {
        Self { uniform: velocity, scale: 1.0, map: None }
    }

    /// Velocities (m/s) on a grid that is centred on the water.
    pub fn from_map(map: impl Into<Arc<Grid<Vec2>>>) -> Self {
        Self { uniform: Vec2::ZERO, scale: 1.0, map: Some(map.into()) }
    }

    /// A flow map as `freshet-flood flow` writes it: a picture whose red is the velocity to the east (+x) and whose green
    /// is that to the south (+z), with half as still water, and which knows its own scale and cell size.
    ///
    /// For a painted picture, which knows neither, read it with [`FlowMap::read`] and give both there.
    ///
    /// # Errors
    /// [`FlowMapError`] naming the file if it cannot be read.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, FlowMapError> {
        Ok(Self::from_map(FlowMap::read(path, Defaults::default())?.velocity))
    }
}

impl Default for WaterFlow {
    fn default() -> Self {
        Self::uniform(Vec2::ZERO)
    }
}
