//! Rectangles of cells cut out of a raster.

use freshet_hydro::grid::Grid;
use glam::{DVec2, UVec2};

use crate::georeference::Georeference;

/// A rectangle of cells of a raster.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Window {
    /// Its north-western cell: (column, row), counted from the north-western cell of the raster.
    pub origin: UVec2,
    /// Columns and rows, at least 1 each.
    pub size: UVec2,
}

impl Window {
    /// All of a raster of `size`.
    pub fn all(size: UVec2) -> Self {
        Self { origin: UVec2::ZERO, size }
    }

    /// The least rectangle with both of the cells.
    fn around(a: UVec2, b: UVec2) -> Self {
        Self { origin: a.min(b), size: a.max(b) - a.min(b) + 1 }
    }

    /// The least rectangle that holds every cell for which `is_in` is true; `None` if there is none.
    pub fn of_cells<T>(grid: &Grid<T>, is_in: impl Fn(&T) -> bool) -> Option<Self> {
        let cells = grid.iter().filter(|(_, value)| is_in(value)).map(|(cell, _)| (cell, cell));
        cells.reduce(|(least, most), (cell, _)| (least.min(cell), most.max(cell))).map(|(a, b)| Self::around(a, b))
    }

    /// The cells of a raster that a rectangle on the map meets, given by its south-western and north-eastern corner
    /// (easting, northing); `None` if it meets none.
    pub fn of_map(georeference: &Georeference, south_west: DVec2, north_east: DVec2) -> Option<Self> {
        let size = georeference.size.as_dvec2();
        let place = |point: DVec2| (point - georeference.corner) / georeference.cell_size;
        let (least, most) = (place(south_west).max(DVec2::ZERO).floor(), place(north_east).min(size).ceil());
        if !(least.cmplt(most).all() && south_west.is_finite() && north_east.is_finite()) {
            return None;
        }
        let (least, most) = (least.as_uvec2(), most.as_uvec2());
        // Rows count from the north, northings from the south.
        let origin = UVec2::new(least.x, georeference.size.y - most.y);
        Some(Self { origin, size: most - least })
    }

    /// The rectangle with `margin` cells more on every side, as far as a raster of `size` has them.
    pub fn grown(self, margin: u32, size: UVec2) -> Self {
        let origin = self.origin.saturating_sub(UVec2::splat(margin));
        let end = (self.origin + self.size + margin).min(size);
        Self { origin, size: end - origin }
    }

    /// What lies in the rectangle, which must lie in the grid; cells beyond it are left out.
    pub fn of<T: Copy>(&self, grid: &Grid<T>) -> Grid<T> {
        if *self == Self::all(grid.size()) {
            return grid.clone();
        }
        let columns = grid.size().x as usize;
        let (left, width) = (self.origin.x as usize, self.size.x as usize);
        let rows = grid.values().chunks_exact(columns).skip(self.origin.y as usize).take(self.size.y as usize);
        let values = rows.flat_map(|row| &row[left..left + width]).copied().collect();
        // The window lies in the grid and is not empty, so its values are as many as it has cells.
        Grid::new(self.size, grid.cell_size(), values).unwrap_or_else(|_| grid.clone())
    }

    /// Where the rectangle lies on the map.
    pub fn georeference(&self, of: &Georeference) -> Georeference {
        let rows_below = of.size.y - self.origin.y - self.size.y;
        let offset = DVec2::new(f64::from(self.origin.x), f64::from(rows_below)) * of.cell_size;
        Georeference { corner: of.corner + offset, cell_size: of.cell_size, size: self.size }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{dvec2, uvec2};

    const MAP: Georeference = Georeference { corner: dvec2(1000.0, 2000.0), cell_size: 5.0, size: uvec2(10, 8) };

    #[test]
    fn the_offset_stays_with_the_window() {
        let grid = Grid::from_fn(MAP.size, 5.0, |cell| cell.x + 10 * cell.y).unwrap();
        let window = Window::of_cells(&grid, |value| [23, 47].contains(value)).unwrap();
        assert_eq!(window, Window { origin: uvec2(3, 2), size: uvec2(5, 3) });
        let cut = window.of(&grid);
        assert_eq!((cut.get(uvec2(0, 0)), cut.get(uvec2(4, 2))), (Some(&23), Some(&47)));
        let place = window.georeference(&MAP);
        assert_eq!(place.corner, dvec2(1015.0, 2015.0));
        assert_eq!(Window::of_map(&MAP, place.corner, place.corner + dvec2(25.0, 15.0)), Some(window));
        assert_eq!(Window::of_cells(&grid, |_| false), None);
    }

    #[test]
    fn windows_stay_in_the_raster() {
        assert_eq!(Window::of_map(&MAP, dvec2(0.0, 0.0), dvec2(9e9, 9e9)), Some(Window::all(MAP.size)));
        assert_eq!(Window::of_map(&MAP, dvec2(0.0, 0.0), dvec2(999.0, 9e9)), None);
        assert_eq!(Window::of_map(&MAP, dvec2(f64::NAN, 0.0), dvec2(f64::NAN, 9e9)), None);
        let corner = Window { origin: uvec2(0, 7), size: uvec2(1, 1) };
        assert_eq!(corner.grown(2, MAP.size), Window { origin: uvec2(0, 5), size: uvec2(3, 3) });
    }
}
