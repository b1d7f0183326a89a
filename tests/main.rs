//! Integration tests of the plugin: one binary, so that Bevy is linked once. A module per theme.
#![expect(clippy::unwrap_used, reason = "a test may fail by panicking")]

mod said;
mod stage;

#[cfg(feature = "rapier")]
mod boat;
#[cfg(feature = "rapier")]
mod buoyancy;
#[cfg(feature = "rapier")]
mod buoyancy_cost;
#[cfg(feature = "rapier")]
mod buoyancy_gizmos;
#[cfg(feature = "rapier")]
mod buoyancy_joints;
#[cfg(feature = "rapier")]
mod buoyancy_messages;
#[cfg(feature = "rapier")]
mod buoyancy_ponds;
#[cfg(feature = "rapier")]
mod buoyancy_shapes;
#[cfg(feature = "rapier")]
mod endurance;
#[cfg(feature = "rapier")]
mod exchange;
#[cfg(feature = "rapier")]
mod exchange_changes;
mod features;
mod fields;
mod flood;
mod flood_cost;
mod flow;
mod foam;
mod glitter;
mod heights;
mod ice;
mod ice_growth;
mod light;
mod night;
mod optics;
mod reflection;
mod river;
mod robustness;
#[cfg(feature = "rapier")]
mod rough_river;
mod running;
mod shore;
mod simulated;
mod simulated_gpu;
mod star_filter;
mod touch;
mod views;
mod warnings;
mod waves;
