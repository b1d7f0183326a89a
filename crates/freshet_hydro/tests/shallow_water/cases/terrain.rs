//! A part of the real terrain: the bed of a tidal river.
use freshet_flood::esri_ascii::EsriGrid;
use freshet_hydro::{grid::Grid, shallow_water::ShallowWater};
use glam::UVec2;

/// First column and row of the part: a bend of the river with flats beside it, and cells without data.
const CORNER: UVec2 = UVec2::new(118, 384);
/// Columns and rows of the part.
const COUNT: UVec2 = UVec2::splat(64);

/// Elevations of the part, m, in cells of 2 m; cells without data are as high as the highest of the others.
pub fn bed() -> Grid<f32> {
    let text = include_bytes!("../../../../../assets/terrain/tidal_river_2m.asc");
    let raster = EsriGrid::parse(text).expect("the terrain of the examples").grid;
    let at = |cell| *raster.get(cell + CORNER).expect("a part of the raster");
    let part = Grid::from_fn(COUNT, raster.cell_size(), at).expect("a valid shape");
    let highest = part.values().iter().copied().fold(f32::NEG_INFINITY, f32::max);
    part.map(|&elevation| if elevation.is_nan() { highest } else { elevation })
}

/// The part as dry land between walls.
pub fn land() -> ShallowWater {
    ShallowWater::new(&bed()).expect("a finite bed")
}
