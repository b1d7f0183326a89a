//! Ice on a water: where it comes first, how thick it grows, and how light passes it.
//!
//! One number, `freezing` (0…1), is the part of a winter that has passed, counted in degree days of frost: at 0 all
//! water is open, at 1 all of it bears a solid cover. [`order_map`] tells for every place which part of the frost
//! must be spent before it freezes; from there on the ice thickens after Stefan ([`Winter::thickness`]). Nothing has a
//! memory, so a winter can be run backwards.
//!
//! | symbol | meaning |
//! |---|---|
//! | h | thickness of the ice, m |
//! | k | conductivity of ice, 2.24 W/(m K) |
//! | H | heat that the air takes from a surface, 22 W/(m² K) |
//! | ρ L | heat of fusion per volume, 917 kg/m³ · 334 kJ/kg |
//!
//! The surface shader's `ice_growth.wgsl` holds the same equations of growth and light.

mod distance;
mod growth;
mod light;
mod order;

pub use distance::distance_to;
pub use growth::{CLOSED, LAST, SETTLED, THINNEST_WINTER, Winter, cover, settled};
pub use light::{Layer, PURE_ICE_ABSORPTION, layer};
pub use order::{Freezing, Site, order_map};
