//! Fields that live on a rectangle of square cells on still water: [`rings`], and [`transport`] of [`foam`] and dye.
//!
//! The plugin runs the same schemes in compute shaders; these are the twins for servers, and what the shaders are tested
//! against. Cells are in rows from the north-west corner, x to the east and z to the south, as in
//! [`grid`](crate::grid).
pub mod foam;
pub mod rings;
pub mod transport;

use glam::{IVec2, UVec2};

/// The rectangle of cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cells {
    /// Columns and rows.
    pub size: UVec2,
    /// Side of a cell, m, > 0.
    pub side: f32,
}

impl Cells {
    /// Number of cells.
    pub fn count(&self) -> usize {
        self.size.x as usize * self.size.y as usize
    }

    /// Area of a cell, m².
    pub fn area(&self) -> f32 {
        self.side * self.side
    }

    /// Where the cell at column and row `at` is stored, or `None` outside the rectangle.
    pub fn index(&self, at: IVec2) -> Option<usize> {
        let inside = at.cmpge(IVec2::ZERO).all() && at.cmplt(self.size.as_ivec2()).all();
        inside.then(|| at.y as usize * self.size.x as usize + at.x as usize)
    }

    /// Column and row of every cell, in the order of storage.
    pub fn iter(&self) -> impl Iterator<Item = IVec2> + use<> {
        let size = self.size.as_ivec2();
        (0..size.y).flat_map(move |row| (0..size.x).map(move |column| IVec2::new(column, row)))
    }
}

/// The four neighbours of a cell.
const NEIGHBOURS: [IVec2; 4] = [IVec2::NEG_X, IVec2::X, IVec2::NEG_Y, IVec2::Y];
