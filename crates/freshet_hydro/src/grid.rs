//! Rasters: values at the centres of square cells.
//!
//! Column 0 is west (smallest x) and row 0 is north (smallest z); values are stored row by row from the north-west
//! corner. A grid is centred on its local origin and knows nothing of where in the world that origin lies.

use std::ops::{Add, Mul, Sub};

use glam::{IVec2, UVec2, Vec2};
use thiserror::Error;

/// Values at the centres of square cells, centred on the local origin of the xz plane.
///
/// In grids of elevation or depth, `f32::NAN` marks a cell without data. Arithmetic carries it along, so a sample that
/// touches such a cell is NaN as well instead of a plausible wrong number.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid<T> {
    size: UVec2,
    cell_size: f32,
    values: Vec<T>,
}

/// Where square cells lie on the xz plane, without what is in them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Raster {
    /// The north-west corner of the first cell (x, z), m.
    pub origin: Vec2,
    /// Side of a cell, m, > 0.
    pub cell: f32,
    /// Columns and rows.
    pub size: UVec2,
}

impl Raster {
    /// Whether it meets the rectangle between `min` and `max` (x, z), m.
    pub fn meets(&self, min: Vec2, max: Vec2) -> bool {
        let last = self.origin + self.size.as_vec2() * self.cell;
        min.cmple(last).all() && max.cmpge(self.origin).all()
    }

    /// Place of a cell in a list row by row, if there is such a cell.
    pub fn index(&self, cell: IVec2) -> Option<usize> {
        let is_inside = cell.cmpge(IVec2::ZERO).all() && cell.cmplt(self.size.as_ivec2()).all();
        is_inside.then(|| cell.y as usize * self.size.x as usize + cell.x as usize)
    }

    /// Middle of a cell (x, z), m.
    pub fn middle(&self, cell: IVec2) -> Vec2 {
        self.origin + (cell.as_vec2() + 0.5) * self.cell
    }
}

/// Why values do not make a [`Grid`].
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum GridError {
    /// The grid would have no cell.
    #[error("a grid needs at least one column and one row, not {} × {}", .0.x, .0.y)]
    Empty(UVec2),
    /// The side of a cell, in metres, is not a finite number above zero.
    #[error("the cell size must be a finite number of metres above zero, not {0}")]
    CellSize(f32),
    /// The number of values is not columns × rows.
    #[error("{} columns × {} rows need {} values, not {found}", .size.x, .size.y, cell_count(*.size))]
    Length {
        /// Columns and rows asked for.
        size: UVec2,
        /// Number of values given.
        found: usize,
    },
}

fn cell_count(size: UVec2) -> u64 {
    u64::from(size.x) * u64::from(size.y)
}

impl<T> Grid<T> {
    /// Makes a grid of `size` (columns, rows; at least 1 each) from `values` in rows from the north, each from the west.
    ///
    /// `cell_size` is the side of a cell in metres, finite and above zero.
    ///
    /// # Errors
    /// [`GridError`] if the size is zero, the cell size is not positive, or the number of values is not columns × rows.
    pub fn new(size: UVec2, cell_size: f32, values: Vec<T>) -> Result<Self, GridError> {
        if size.min_element() == 0 {
            return Err(GridError::Empty(size));
        }
        if !(cell_size.is_finite() && cell_size > 0.0) {
            return Err(GridError::CellSize(cell_size));
        }
        if values.len() as u64 != cell_count(size) {
            let found = values.len();
            return Err(GridError::Length { size, found });
        }
        Ok(Self { size, cell_size, values })
    }

    /// Makes a grid by calling `value` for every cell (column, row), row by row from the north-west corner.
    ///
    /// # Errors
    /// [`GridError`] as for [`Grid::new`].
    pub fn from_fn(size: UVec2, cell_size: f32, value: impl FnMut(UVec2) -> T) -> Result<Self, GridError> {
        Self::new(size, cell_size, cells(size).map(value).collect())
    }

    /// Columns and rows, at least 1 each.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Side of a cell in metres, above zero.
    pub fn cell_size(&self) -> f32 {
        self.cell_size
    }

    /// Size of the whole grid along x and z in metres.
    pub fn extent(&self) -> Vec2 {
        self.size.as_vec2() * self.cell_size
    }

    /// All values, row by row from the north-west corner.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// All values for writing, row by row from the north-west corner.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// Gives up the grid for its values, row by row from the north-west corner.
    pub fn into_values(self) -> Vec<T> {
        self.values
    }

    /// Where in [`Grid::values`] the cell (column, row) is stored, or `None` outside the grid.
    pub fn index(&self, cell: UVec2) -> Option<usize> {
        cell.cmplt(self.size).all().then(|| cell.y as usize * self.size.x as usize + cell.x as usize)
    }

    /// The value of the cell (column, row), or `None` outside the grid.
    pub fn get(&self, cell: UVec2) -> Option<&T> {
        self.index(cell).map(|index| &self.values[index])
    }

    /// The cells (column, row) in the order of [`Grid::values`].
    pub fn cells(&self) -> impl Iterator<Item = UVec2> + use<T> {
        cells(self.size)
    }

    /// Every cell (column, row) with its value, in the order of [`Grid::values`].
    pub fn iter(&self) -> impl Iterator<Item = (UVec2, &T)> {
        self.cells().zip(&self.values)
    }

    /// Centre of the cell (column, row) in local (x, z) metres: (cell + ½ − size / 2) · cell size.
    ///
    /// Cells outside the grid have a centre too: that of the grid continued.
    pub fn position(&self, cell: UVec2) -> Vec2 {
        (cell.as_vec2() + 0.5 - self.size.as_vec2() / 2.0) * self.cell_size
    }

    /// The cell (column, row) that holds the local point (x, z) in metres, or `None` outside the grid.
    ///
    /// A cell owns its western and northern edge, so the grid's eastern and southern edges lie outside.
    pub fn cell_at(&self, point: Vec2) -> Option<UVec2> {
        let cell = (point / self.cell_size + self.size.as_vec2() / 2.0).floor();
        (cell.cmpge(Vec2::ZERO).all() && cell.cmplt(self.size.as_vec2()).all()).then(|| cell.as_uvec2())
    }

    /// A grid of the same shape with every value passed through `value`.
    pub fn map<U>(&self, value: impl FnMut(&T) -> U) -> Grid<U> {
        Grid { size: self.size, cell_size: self.cell_size, values: self.values.iter().map(value).collect() }
    }
}

impl<T> Grid<T>
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>,
{
    /// The value at the local point (x, z) in metres, both finite, bilinear between cell centres.
    ///
    /// Outside the outermost cell centres the nearest point on their rectangle counts. If any of the four cells around
    /// the point is NaN, so is the result.
    ///
    /// The order of operations is fixed so that a shader which loads the four texels can repeat it:
    /// ```text
    /// p = clamp(point / cell_size + size / 2 − ½, 0, size − 1)
    /// i = floor(p),  j = min(i + 1, size − 1),  t = p − i
    /// lerp(a, b, t) = a + (b − a) · t
    /// lerp(lerp(v[i.x, i.z], v[j.x, i.z], t.x), lerp(v[i.x, j.z], v[j.x, j.z], t.x), t.z)
    /// ```
    /// WGSL's `mix` may be evaluated as a·(1 − t) + b·t, which rounds differently: write `lerp` out.
    pub fn sample(&self, point: Vec2) -> T {
        let last = self.size - 1;
        let p = (point / self.cell_size + (self.size.as_vec2() / 2.0 - 0.5)).clamp(Vec2::ZERO, last.as_vec2());
        let i = p.floor().as_uvec2();
        let j = (i + 1).min(last);
        let t = p - p.floor();
        let value = |x: u32, z: u32| self.values[z as usize * self.size.x as usize + x as usize];
        let north = lerp(value(i.x, i.y), value(j.x, i.y), t.x);
        let south = lerp(value(i.x, j.y), value(j.x, j.y), t.x);
        lerp(north, south, t.y)
    }
}

fn cells(size: UVec2) -> impl Iterator<Item = UVec2> {
    (0..size.y).flat_map(move |row| (0..size.x).map(move |column| UVec2::new(column, row)))
}

fn lerp<T>(a: T, b: T, t: f32) -> T
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>,
{
    a + (b - a) * t
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use glam::{uvec2, vec2};
    use proptest::prelude::*;

    use super::*;

    fn ramp(size: UVec2, cell_size: f32) -> Grid<f32> {
        let value = |cell: UVec2| 10.0 + cell.x as f32 - 3.0 * cell.y as f32;
        Grid::from_fn(size, cell_size, value).expect("a valid shape")
    }

    #[test]
    fn wrong_shapes_are_refused() {
        let new = |size, cell_size, count| Grid::new(size, cell_size, vec![0_u8; count]);
        assert_eq!(new(uvec2(0, 3), 1.0, 0), Err(GridError::Empty(uvec2(0, 3))));
        assert_eq!(new(uvec2(1, 1), 0.0, 1), Err(GridError::CellSize(0.0)));
        assert!(new(uvec2(1, 1), f32::NAN, 1).is_err());
        let message = new(uvec2(4, 3), 1.0, 11).map_err(|error| error.to_string());
        assert_eq!(message, Err("4 columns × 3 rows need 12 values, not 11".into()));
        // A product that wraps around in 32 bits must not pass for a small one.
        assert!(new(UVec2::splat(1 << 16), 1.0, 0).is_err());
    }

    #[test]
    fn row_0_is_north_and_the_centre_is_the_origin() {
        let grid = ramp(uvec2(4, 3), 2.0);
        assert_eq!(grid.extent(), vec2(8.0, 6.0));
        assert_eq!(grid.position(uvec2(0, 0)), vec2(-3.0, -2.0));
        assert_eq!(grid.position(uvec2(3, 2)), vec2(3.0, 2.0));
        assert_eq!(grid.values()[..5], [10.0, 11.0, 12.0, 13.0, 7.0]);
        assert_eq!(grid.get(uvec2(0, 1)), Some(&7.0));
        assert_eq!(grid.get(uvec2(4, 0)), None);
        assert_eq!(grid.index(uvec2(3, 2)), Some(11));
    }

    #[test]
    fn a_cell_owns_its_western_and_northern_edge() {
        let grid = ramp(uvec2(4, 3), 2.0);
        assert_eq!(grid.cell_at(vec2(-4.0, -3.0)), Some(uvec2(0, 0)));
        assert_eq!(grid.cell_at(vec2(3.9, 2.9)), Some(uvec2(3, 2)));
        assert_eq!(grid.cell_at(vec2(4.0, 0.0)), None);
        assert_eq!(grid.cell_at(vec2(0.0, -3.1)), None);
        assert_eq!(grid.cell_at(vec2(f32::NAN, 0.0)), None);
        for cell in grid.cells() {
            assert_eq!(grid.cell_at(grid.position(cell)), Some(cell));
        }
    }

    #[test]
    fn iteration_and_map_keep_the_order() {
        let mut grid = ramp(uvec2(3, 2), 1.0);
        for (cell, &value) in grid.iter() {
            assert_eq!(grid.get(cell), Some(&value));
        }
        let doubled = grid.map(|value| value * 2.0);
        for value in grid.values_mut() {
            *value *= 2.0;
        }
        assert_eq!(doubled, grid);
        assert_eq!(doubled.cell_size(), 1.0);
        assert_eq!(doubled.into_values(), [20.0, 22.0, 24.0, 14.0, 16.0, 18.0]);
    }

    #[test]
    fn a_sample_without_data_is_nan_and_one_beside_it_is_not() {
        let grid = Grid::new(uvec2(3, 1), 1.0, vec![1.0, 2.0, f32::NAN]).expect("a valid shape");
        assert_relative_eq!(grid.sample(vec2(-0.5, 0.0)), 1.5);
        assert!(grid.sample(vec2(0.5, 0.0)).is_nan());
        assert_eq!(grid.sample(vec2(-9.0, 9.0)), 1.0);
    }

    proptest! {
        #[test]
        fn sampling_is_exact_at_centres_and_linear_between(
            columns in 1_u32..9, rows in 1_u32..9, cell_size in 0.1_f32..50.0, u in 0.0_f32..1.0, v in 0.0_f32..1.0,
        ) {
            let grid = ramp(uvec2(columns, rows), cell_size);
            let corner = grid.position(UVec2::ZERO);
            let far = grid.position(grid.size() - 1);
            let steps = vec2(u, v) * (grid.size() - 1).as_vec2();
            let expected = 10.0 + steps.x - 3.0 * steps.y;
            let point = corner + (far - corner) * vec2(u, v);
            prop_assert!((grid.sample(point) - expected).abs() < 1e-4);
            let velocity = grid.map(|&value| vec2(value, -value));
            prop_assert!((velocity.sample(point) - vec2(expected, -expected)).length() < 1e-4);
            // Beyond the outermost centres the nearest of them counts.
            prop_assert!((grid.sample(corner * 2.0 - far) - 10.0).abs() < 1e-4);
        }
    }
}
