//! Filling of missing values in elevation grids.
use crate::grid::Grid;
use glam::{UVec2, uvec2};

/// A copy of `grid` in which every NaN is replaced by a smooth continuation of the values around it, at least `lowest`.
///
/// Push and pull (after Gortler et al. 1996): the known values are averaged into ever coarser grids until nothing is
/// missing; each gap then takes the value of the finest grid that has one, interpolated. A grid without any value comes
/// back with `lowest` everywhere.
pub fn fill_missing(grid: &Grid<f32>, lowest: f32) -> Grid<f32> {
    if !grid.values().iter().any(|z| z.is_nan()) {
        return grid.clone();
    }
    let Some(coarse) = coarsened(grid) else {
        return grid.map(|z| if z.is_nan() { lowest } else { *z });
    };
    let coarse = fill_missing(&coarse, f32::NEG_INFINITY);
    let mut filled = grid.clone();
    for cell in grid.cells() {
        if let Some(index) = grid.index(cell).filter(|&index| grid.values()[index].is_nan()) {
            // Cell centres of the coarse grid lie between those of the fine one, counted from the same corner.
            let place = ((cell.as_vec2() + 0.5) * 0.5 - coarse.size().as_vec2() * 0.5) * coarse.cell_size();
            filled.values_mut()[index] = coarse.sample(place).max(lowest);
        }
    }
    filled
}

/// The grid of half the resolution, with the mean of the known values of each four cells; `None` from one cell on.
fn coarsened(grid: &Grid<f32>) -> Option<Grid<f32>> {
    if grid.size() == UVec2::ONE {
        return None;
    }
    let mean = |cell: UVec2| {
        let corners = [uvec2(0, 0), uvec2(1, 0), uvec2(0, 1), uvec2(1, 1)];
        let known = corners.iter().filter_map(|&corner| grid.get(cell * 2 + corner)).filter(|z| !z.is_nan());
        let (sum, count) = known.fold((0.0, 0), |(sum, count), z| (sum + z, count + 1));
        if count > 0 { sum / count as f32 } else { f32::NAN }
    };
    Grid::from_fn((grid.size() + 1) / 2, grid.cell_size() * 2.0, mean).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values_stay_and_gaps_continue_them() {
        let nan_east = |cell: UVec2| if cell.x > 12 { f32::NAN } else { 2.0 + 0.1 * cell.y as f32 };
        let grid = Grid::from_fn(uvec2(21, 17), 2.0, nan_east).unwrap();
        let filled = fill_missing(&grid, -10.0);
        for (cell, &z) in grid.iter() {
            let now = *filled.get(cell).unwrap();
            assert!(now.is_finite());
            if z.is_nan() {
                assert!((2.0 - 1e-3..=3.6 + 1e-3).contains(&now), "{cell}: {now} lies outside the known values");
                // Beside the known values the continuation joins them.
                assert!(cell.x > 13 || (now - (2.0 + 0.1 * cell.y as f32)).abs() < 0.3, "{cell}: {now}");
            } else {
                assert_eq!(now, z);
            }
        }
    }

    #[test]
    fn gaps_are_no_lower_than_asked() {
        let grid = Grid::new(uvec2(3, 1), 1.0, vec![-2.0, f32::NAN, f32::NAN]).unwrap();
        assert_eq!(fill_missing(&grid, 1.5).values(), [-2.0, 1.5, 1.5]);
        let empty = Grid::new(uvec2(2, 2), 1.0, vec![f32::NAN; 4]).unwrap();
        assert_eq!(fill_missing(&empty, 0.5).values(), [0.5; 4]);
    }
}
