//! Which part of a water is simulated.
use bevy::prelude::*;

/// A rectangle of square cells that lies on a water, in whole cells from the water's centre.
///
/// The window moves in whole cells, so that what is in a cell stays where it is on the water.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FieldWindow {
    /// The cell in the north-west corner; cell (0, 0) has its own north-west corner in the water's centre.
    pub first: IVec2,
    /// Cells along local x and z; zero where nothing is simulated.
    pub size: UVec2,
    /// Size of a cell, m.
    pub cell: f32,
}

impl FieldWindow {
    /// Local xz of the north-west corner, m.
    pub fn origin(&self) -> Vec2 {
        self.first.as_vec2() * self.cell
    }

    /// Where local `place` lies, in cells from the north-west corner: the centre of the first cell is at (½, ½).
    pub fn cells_from_place(&self, place: Vec2) -> Vec2 {
        place / self.cell - self.first.as_vec2()
    }

    /// Size along local x and z, m.
    pub fn extent(&self) -> Vec2 {
        self.size.as_vec2() * self.cell
    }
}
