//! Raster formats of hydraulic models, and the flow maps and floods made from them. Knows no engine.
//!
//! [`steps`] reads what a model wrote, [`conversion`] makes maps of it, and [`maps::FloodMaps`] reads these and tells the
//! depth at any time.
//!
//! Positions are those of [`freshet_hydro`]: metres from the centre of a raster, x to the east and z to the south.

pub mod arrival;
pub mod conversion;
pub mod current;
pub mod duration;
pub mod esri_ascii;
pub mod flow_map;
pub mod georeference;
pub mod geotiff;
pub mod incremental;
pub mod interpolation;
pub mod maps;
pub mod maxima;
mod neighbours;
pub mod playback;
pub mod raster;
pub mod step;
pub mod steps;
pub mod terrain;
pub mod text;
pub mod waterline;
pub mod window;
