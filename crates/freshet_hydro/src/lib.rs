//! Water physics without an engine.
//!
//! Everything is in SI units and in the plugin's frame: right-handed, y up, the still surface in the xz plane. On
//! rasters column 0 is west (smallest x) and row 0 is north (smallest z).

pub mod fields;
pub mod fill;
pub mod flow;
pub mod grid;
pub mod hull;
pub mod ice;
mod lanes;
pub mod levels;
pub mod load;
pub mod noise;
pub mod optics;
pub mod rain;
pub mod samples;
pub mod shallow_water;
pub mod silhouette;
pub mod voxels;
pub mod waves;
