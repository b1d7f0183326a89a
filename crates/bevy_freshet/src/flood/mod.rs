//! Floods of hydraulic models, played back as water: drawn, asked and felt like any other.
//!
//! ```no_run
//! # use bevy::prelude::*;
//! # use bevy_freshet::{flood::FloodMaps, prelude::*};
//! # use std::sync::Arc;
//! fn setup(mut commands: Commands) -> Result {
//!     let maps = Arc::new(FloodMaps::open("flood")?);
//!     commands.spawn(Flood::bed(&maps)?);
//!     commands.spawn(Flood::water(&maps));
//!     Ok(())
//! }
//! ```
//! `freshet-flood convert` makes the folder from what a model wrote. Between its steps a front moves as the arrival map says
//! ([`freshet_flood::interpolation`]).
//!
//! Steps are read ahead in a background task: two at a time, and those around the ones that are shown stay in memory.
mod ahead;
mod play;
mod settings;

pub use freshet_flood::maps::{FloodMaps, MapsError};
pub use play::FloodState;
pub use settings::{Flood, FloodBedError};

pub(crate) use play::FloodPlugin;
