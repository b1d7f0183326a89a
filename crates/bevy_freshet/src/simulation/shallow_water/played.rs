//! Water that is not simulated but played back: it is drawn, asked and felt the same way.
use super::{Simulated, driver::pictures_of, frame::ShallowFrame, frame::ShallowWork};
use crate::body::{ResolvedSimulation, SimulatedArea};
use bevy::prelude::*;
use freshet_hydro::shallow_water::Field;
use std::sync::Arc;

impl Simulated {
    /// Shows `field` where nothing is simulated.
    pub fn play(&mut self, field: Option<Arc<Field>>) {
        self.played = field.map(|field| {
            let half_size = 0.5 * field.cell_size() * field.size().as_vec2();
            ResolvedSimulation { field, age: 0.0, area: SimulatedArea::all(half_size) }
        });
    }

    /// What the renderer has to do for what is played.
    pub fn played_frame(&mut self, images: &mut Assets<Image>) -> Option<ShallowFrame> {
        let field = self.played.as_ref()?.field.clone();
        let pictures = pictures_of(&mut self.pictures, field.size(), images).map(|picture| picture.id());
        Some(ShallowFrame { work: ShallowWork::Cpu(field), pictures })
    }
}
