//! Real-time water for the Bevy engine: what you see is what floats you, and all of it is measured against physics.
//!
//! Add [`WaterPlugin`], spawn a [`Water`](body::Water) and, with bevy_rapier3d, bodies that are
//! [`Floating`](buoyancy::Floating). Everything else is a component beside these, with a useful default.
//!
//! SI units throughout; y is up and the still surface is level.

// The scene of the integration tests serves unit tests as well.
#[cfg(test)]
extern crate self as bevy_freshet;

pub mod bed;
pub mod body;
#[cfg(feature = "rapier")]
pub mod buoyancy;
pub mod features;
pub mod flood;
pub mod interaction;
#[cfg(test)]
mod layout;
#[cfg(feature = "panel")]
pub mod panel;
pub mod preset;
pub mod query;
pub mod reflection;
mod report;
mod schedule;
#[cfg(test)]
mod shaders;
pub mod simulation;
pub mod sky;
pub mod star_filter;
pub mod surface;

pub use schedule::WaterSystems;

/// What an app with water usually needs.
pub mod prelude {
    #[cfg(feature = "rapier")]
    pub use crate::buoyancy::{
        Buoyancy, BuoyancyGizmos, BuoyancyModel, Entered, Floating, Left, Passage, ReturnTo, ShowBuoyancyGizmo, Splash,
        Submerged, Weight,
    };
    pub use crate::{
        WaterPlugin, WaterSystems,
        bed::BedShading,
        body::{
            DomainSide, Edge, Fresnel, ResetSimulation, Series, SimulationBackend, SimulationStart, SimulationState,
            StepSimulation, Water, WaterBed, WaterEdge, WaterEdges, WaterFlow, WaterFoam, WaterIce, WaterInteraction,
            WaterLighting, WaterOptics, WaterSimulation, WaterSource, WaterSources, WaterWall, WaterWalls, WaterWaves,
        },
        flood::Flood,
        interaction::{Disturb, DisturbsWater, DyesWater, WaterTouch, WaterTouchBlocked},
        query::{Submersion, WaterHit, WaterQuery, WaterSample},
        reflection::WaterReflection,
        sky::{Sky, SkyPlugin, SkyView},
        star_filter::{StarFilter, StarFilterPlugin},
        surface::{NoWater, SurfaceView, WaterSurface},
    };
}

use bevy::{
    prelude::*,
    render::{RenderApp, RenderPlugin},
};

/// Water: drawn, reflecting, and answering [`WaterQuery`](query::WaterQuery); with the feature `rapier` it carries
/// bodies.
///
/// Works in an app without a renderer or a GPU, where it is not drawn but floats bodies all the same.
#[derive(Default)]
pub struct WaterPlugin;

impl Plugin for WaterPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins((
            body::BodyPlugin,
            interaction::InteractionPlugin,
            simulation::ShallowWaterPlugin,
            flood::FloodPlugin,
        ));
        #[cfg(feature = "rapier")]
        app.add_plugins(buoyancy::BuoyancyPlugin);
        if app.get_sub_app(RenderApp).is_some() {
            app.add_plugins((
                surface::SurfacePlugin,
                reflection::ReflectionPlugin,
                bed::BedPlugin,
                simulation::SimulationPlugin,
            ));
        }
    }

    fn finish(&self, app: &mut App) {
        if app.is_plugin_added::<surface::SurfacePlugin>() {
            return;
        }
        if app.get_sub_app(RenderApp).is_some() {
            warn!("WaterPlugin was added before DefaultPlugins: water is felt but not drawn");
        } else if app.is_plugin_added::<RenderPlugin>() {
            warn!("there is no GPU device: water is felt but not drawn");
        }
    }
}
