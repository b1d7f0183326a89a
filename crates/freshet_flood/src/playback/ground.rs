//! What is the same at all times of a flood.

use glam::Vec2;

use crate::maps::{FloodMaps, Map, MapsError};

/// Elevation of ground without data, m: a bank that nothing climbs.
pub const BANK: f32 = 1e4;

/// The ground of a flood, and the way of all of it.
#[derive(Debug)]
pub struct Ground {
    /// Elevation of every cell, m; [`BANK`] where there is no data, 0 everywhere without a terrain.
    pub elevations: Vec<f32>,
    /// The current of the whole flood, m/s, if it was converted.
    pub(super) current: Option<Vec<Vec2>>,
}

impl Ground {
    /// Reads the ground of a flood.
    ///
    /// # Errors
    /// [`MapsError`] if a picture cannot be read.
    pub fn read(maps: &FloodMaps) -> Result<Self, MapsError> {
        let manifest = maps.manifest();
        let size = manifest.georeference.size;
        let mut elevations = match manifest.maps.contains_key(&Map::Terrain) {
            true => maps.terrain()?.into_values(),
            false => vec![0.0; size.x as usize * size.y as usize],
        };
        elevations.iter_mut().filter(|elevation| !elevation.is_finite()).for_each(|elevation| *elevation = BANK);
        let current = manifest.flow.as_ref().map(|_| Ok::<_, MapsError>(maps.flow()?.velocity.into_values()));
        Ok(Self { elevations, current: current.transpose()? })
    }
}
