//! What acts on the simulated fields of a water in the coming frame.
use bevy::prelude::*;

/// Written by `interaction` every frame, read by the stages.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct Deposits {
    /// Cells of the window in which bodies cross the surface, each cell at most once.
    pub silhouettes: Vec<SilhouetteCell>,
    /// Touches, drops and spills since the last frame.
    pub strokes: Vec<Stroke>,
}

/// A cell of the [`FieldWindow`](super::FieldWindow) that bodies cover at the waterline, wholly or in part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SilhouetteCell {
    /// Column and row in the window.
    pub cell: UVec2,
    /// Covered share of the cell, 0…1.
    pub cover: f32,
    /// Displaced water over the area of the cell, m. Summed over cells and times their area it is the bodies' displaced
    /// volume; a body wholly under water has no cells.
    pub draft: f32,
    /// Velocity of the bodies, local xz, m/s.
    pub velocity: Vec2,
}

/// Something that reaches the water at a place, once: a touch, a drop, a spill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    /// Local xz of its centre, m.
    pub place: Vec2,
    /// Radius (standard deviation of a Gaussian), m, > 0.
    pub radius: f32,
    /// Volume of water that is raised at the place, m³; negative pushes down.
    pub volume: f32,
    /// Foam added, m² of full cover.
    pub foam: f32,
    /// Dye added: absorption per metre of path, times volume of water: (1/m)·m³.
    pub dye: Vec3,
}
