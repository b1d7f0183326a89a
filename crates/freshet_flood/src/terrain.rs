//! The terrain under a flood: brought onto the raster of its steps, and its normals.

use freshet_hydro::grid::Grid;
use glam::{DVec2, IVec2, UVec2, Vec3};
use rayon::prelude::*;
use thiserror::Error;

use crate::georeference::Georeference;
use crate::window::Window;

/// Share of a cell by which rasters may miss each other and still count as aligned: what rounded coordinates leave.
const ALIGNED: f64 = 1e-3;

/// The terrain lies elsewhere.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "the terrain from {terrain_from} to {terrain_to} does not cover the steps from {steps_from} to {steps_to} (easting, \
     northing)"
)]
pub struct NotCovered {
    terrain_from: DVec2,
    terrain_to: DVec2,
    steps_from: DVec2,
    steps_to: DVec2,
}

/// How a terrain was brought onto another raster.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Resampling {
    /// Cell by cell: the cells are the same.
    Exact,
    /// Bilinearly between the centres of the terrain's cells.
    Bilinear,
}

/// The elevations of `terrain`, which lies at `from`, on the raster `to`.
///
/// # Errors
/// [`NotCovered`] if `to` reaches beyond the terrain.
pub fn on_raster(
    terrain: &Grid<f32>,
    from: &Georeference,
    to: &Georeference,
) -> Result<(Grid<f32>, Resampling), NotCovered> {
    let extent = |place: &Georeference| (place.corner, place.corner + place.size.as_dvec2() * place.cell_size);
    let ((terrain_from, terrain_to), (steps_from, steps_to)) = (extent(from), extent(to));
    let slack = ALIGNED * to.cell_size;
    if !((steps_from + slack).cmpge(terrain_from).all() && (steps_to - slack).cmple(terrain_to).all()) {
        return Err(NotCovered { terrain_from, terrain_to, steps_from, steps_to });
    }
    // Column and row of the north-western corner of `to` in the terrain.
    let offset = DVec2::new(steps_from.x - terrain_from.x, terrain_to.y - steps_to.y) / from.cell_size;
    let is_same_cell = (from.cell_size - to.cell_size).abs() * to.size.max_element() as f64 <= slack;
    if is_same_cell && offset.distance(offset.round()) < ALIGNED {
        let window = Window { origin: offset.round().as_uvec2(), size: to.size };
        if (window.origin + window.size).cmple(terrain.size()).all() {
            return Ok((window.of(terrain), Resampling::Exact));
        }
    }
    let half = terrain.extent().as_dvec2() / 2.0;
    let sample = |cell: UVec2| {
        let place = offset * from.cell_size + (cell.as_dvec2() + 0.5) * to.cell_size;
        terrain.sample((place - half).as_vec2())
    };
    let resampled = Grid::from_fn(to.size, to.cell_size as f32, sample);
    // The raster of steps that were read is a valid one.
    Ok((resampled.unwrap_or_else(|_| terrain.clone()), Resampling::Bilinear))
}

/// Unit normals (east, up, south) of a terrain by the filter of Sobel (1968); up where it has no data.
///
/// ```text
/// ∂z/∂x = ((z(x+1, y−1) − z(x−1, y−1)) + 2 (z(x+1, y) − z(x−1, y)) + (z(x+1, y+1) − z(x−1, y+1))) / 8 Δ
/// ```
/// and along y likewise. A neighbour beyond the rim, or without data, counts as the cell itself.
pub fn normals(terrain: &Grid<f32>) -> Grid<Vec3> {
    let columns = terrain.size().x as usize;
    let normal = |place: usize| {
        let cell = IVec2::new((place % columns) as i32, (place / columns) as i32);
        let here = terrain.values()[place];
        let z = |x: i32, y: i32| {
            let value = terrain.get((cell + IVec2::new(x, y)).as_uvec2()).copied();
            value.filter(|z| !z.is_nan()).unwrap_or(here)
        };
        let [nw, n, ne] = [-1, 0, 1].map(|x| z(x, -1));
        let [sw, s, se] = [-1, 0, 1].map(|x| z(x, 1));
        let run = 8.0 * terrain.cell_size();
        let slope_x = ((ne - nw) + 2.0 * (z(1, 0) - z(-1, 0)) + (se - sw)) / run;
        let slope_z = ((sw - nw) + 2.0 * (s - n) + (se - ne)) / run;
        if here.is_nan() { Vec3::Y } else { Vec3::new(-slope_x, 1.0, -slope_z).normalize() }
    };
    let normals: Vec<Vec3> = (0..terrain.values().len()).into_par_iter().map(normal).collect();
    let mut normals = normals.into_iter();
    terrain.map(|_| normals.next().unwrap_or(Vec3::Y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use glam::{dvec2, uvec2};

    fn plane(size: UVec2, cell: f32) -> Grid<f32> {
        Grid::from_fn(size, cell, |at| 0.1 * cell * at.x as f32 - 0.2 * cell * at.y as f32).unwrap()
    }

    #[test]
    fn aligned_cells_are_taken_as_they_are() {
        let terrain = plane(uvec2(10, 8), 2.0);
        let from = Georeference { corner: dvec2(100.0, 50.0), cell_size: 2.0, size: uvec2(10, 8) };
        let to = Georeference { corner: dvec2(104.0, 52.0), cell_size: 2.0, size: uvec2(3, 4) };
        let (cut, how) = on_raster(&terrain, &from, &to).unwrap();
        assert_eq!((how, cut.get(uvec2(0, 0))), (Resampling::Exact, terrain.get(uvec2(2, 3))));
    }

    #[test]
    fn other_cells_are_met_on_the_plane_and_gaps_are_refused() {
        let terrain = plane(uvec2(10, 8), 2.0);
        let from = Georeference { corner: dvec2(100.0, 50.0), cell_size: 2.0, size: uvec2(10, 8) };
        let to = Georeference { corner: dvec2(105.0, 53.0), cell_size: 3.0, size: uvec2(2, 3) };
        let (cut, how) = on_raster(&terrain, &from, &to).unwrap();
        assert_eq!(how, Resampling::Bilinear);
        // The centre of the north-western cell: (106.5, 60.5) on the map, 6.5 m east and 5.5 m south of the corner.
        assert_relative_eq!(*cut.get(uvec2(0, 0)).unwrap(), 0.1 * (6.5 - 1.0) - 0.2 * (5.5 - 1.0), epsilon = 1e-4);
        let beyond = Georeference { corner: dvec2(105.0, 40.0), ..to };
        let message = on_raster(&terrain, &from, &beyond).unwrap_err().to_string();
        assert!(message.contains("does not cover"), "{message}");
    }

    #[test]
    fn normals_of_a_plane() {
        let normals = normals(&plane(uvec2(5, 5), 2.0));
        assert_relative_eq!(*normals.get(uvec2(2, 2)).unwrap(), Vec3::new(-0.1, 1.0, 0.2).normalize(), epsilon = 1e-5);
        let hole = Grid::new(uvec2(1, 1), 1.0, vec![f32::NAN]).unwrap();
        assert_eq!(super::normals(&hole).values(), [Vec3::Y]);
    }
}
