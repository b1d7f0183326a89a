//! Where a raster lies on the map.

use glam::{DVec2, UVec2};

/// Place, cell size and shape of a raster on a map, by convention in metres of a projected coordinate system.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Georeference {
    /// South-western corner of the south-western cell: (easting, northing).
    pub corner: DVec2,
    /// Side of a square cell, above zero.
    pub cell_size: f64,
    /// Columns and rows, at least 1 each.
    pub size: UVec2,
}
