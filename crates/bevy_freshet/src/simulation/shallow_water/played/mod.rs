//! Water that is not simulated but played back: it is drawn, asked and felt the same way.
//!
//! What is known of the steps around a time is in textures; a stage works out the pictures of that time from them.
mod stage;
#[cfg(test)]
mod tests;
mod textures;

pub(super) use stage::{Played, forget_played, plan_played, played_layout, run_played};

use super::{Simulated, driver::pictures_of, frame::ShallowFrame, frame::ShallowWork};
use crate::body::{ResolvedSimulation, SimulatedArea, SimulatedWater};
use bevy::{prelude::*, shader::load_shader_library};
use freshet_flood::playback::PlayedInterval;
use std::sync::Arc;

/// Loads what the stage imports.
pub(super) fn load_library(app: &mut App) {
    load_shader_library!(app, "played.wgsl");
}

impl Simulated {
    /// Shows `water` on all of a water of this size (m) where nothing is simulated.
    pub fn play(&mut self, water: Option<(SimulatedWater, Vec2)>) {
        self.played =
            water.map(|(water, size)| ResolvedSimulation { water, age: 0.0, area: SimulatedArea::all(0.5 * size) });
    }

    /// What the renderer has to do for what is played, and for what probably is `next`.
    pub fn played_frame(
        &mut self,
        next: Option<Arc<PlayedInterval>>,
        images: &mut Assets<Image>,
    ) -> Option<ShallowFrame> {
        let water = &self.played.as_ref()?.water;
        let work = match water {
            SimulatedWater::Field(field) => ShallowWork::Cpu(field.clone()),
            SimulatedWater::Moment(moment) => ShallowWork::Played(moment.clone(), next),
        };
        let pictures = pictures_of(&mut self.pictures, water.size(), images).map(|picture| picture.id());
        Some(ShallowFrame { work, pictures })
    }
}
