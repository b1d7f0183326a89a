//! The ground under and around the water.
use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use freshet_flood::esri_ascii::{EsriError, EsriGrid};
use freshet_hydro::{
    fill::fill_missing,
    grid::{Grid, GridError},
};
use std::{path::Path, sync::Arc};

/// Elevations of the ground on a grid that is centred on the entity; the entity's `Transform` places it (translation
/// and rotation about y).
///
/// Waters within its extent fade their waves and edges by its depth, and
/// [`WaterQuery`](crate::query::WaterQuery) measures depth from it. It is drawn if a
/// [`BedShading`](crate::bed::BedShading) is beside it.
#[derive(Component, Reflect, Clone, Debug)]
#[reflect(Component, Clone, Debug)]
#[require(Transform, Visibility)]
pub struct WaterBed {
    #[reflect(ignore, default = "no_elevations")]
    elevations: Arc<Grid<f32>>,
    /// Bound of the slope between cell centres; infinite if cells have no data.
    #[reflect(ignore, default = "unbounded")]
    steepest: f32,
}

fn unbounded() -> f32 {
    f32::INFINITY
}

/// The steepest slope of `elevations` between cell centres; infinite if any has no data.
fn steepest_slope(elevations: &Grid<f32>) -> f32 {
    let cells = elevations.values().iter();
    if cells.clone().any(|z| !z.is_finite()) {
        return f32::INFINITY;
    }
    let columns = elevations.size().x as usize;
    let steepest = |step: usize, ends: &dyn Fn(usize) -> bool| {
        let pairs = cells.clone().zip(cells.clone().skip(step)).enumerate();
        pairs.filter(|(i, _)| !ends(*i)).map(|(_, (a, b))| (a - b).abs()).fold(0.0, f32::max)
    };
    let (across, along) = (steepest(1, &|i| (i + 1) % columns == 0), steepest(columns, &|_| false));
    across.hypot(along) / elevations.cell_size()
}

/// A grid of one cell without data: what reflection builds a bed from.
fn no_elevations() -> Arc<Grid<f32>> {
    Arc::new(Grid::new(UVec2::ONE, 1.0, vec![f32::NAN]).expect("one cell of one metre is a grid"))
}

/// Why a [`WaterBed`] cannot be made.
#[derive(thiserror::Error, Debug)]
pub enum WaterBedError {
    /// The file is not a readable ESRI ASCII grid.
    #[error(transparent)]
    File(#[from] EsriError),
    /// The elevations do not form a grid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// No cell has an elevation.
    #[error("the bed has no cell with an elevation")]
    Empty,
}

impl WaterBed {
    /// A bed from elevations (m, relative to the entity; NaN or infinite where there is no data).
    ///
    /// # Errors
    /// [`WaterBedError::Empty`] if no cell has an elevation.
    pub fn new(elevations: Grid<f32>) -> Result<Self, WaterBedError> {
        if elevations.values().iter().all(|z| !z.is_finite()) {
            return Err(WaterBedError::Empty);
        }
        let finite = elevations.map(|z| if z.is_finite() { *z } else { f32::NAN });
        Ok(Self { steepest: steepest_slope(&finite), elevations: Arc::new(finite) })
    }

    /// A bed from an ESRI ASCII grid; its centre comes to lie at the entity.
    ///
    /// # Errors
    /// [`WaterBedError`] naming file and line if the file cannot be read.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, WaterBedError> {
        Self::new(EsriGrid::read(path)?.grid)
    }

    /// A bed from a formula: `size` cells (columns, rows) of `cell_size` metres, `elevation` of local xz in metres.
    ///
    /// # Errors
    /// [`WaterBedError`] if size or cell size is zero, or no elevation is finite.
    pub fn from_fn(size: UVec2, cell_size: f32, mut elevation: impl FnMut(Vec2) -> f32) -> Result<Self, WaterBedError> {
        let half = (size.as_vec2() - 1.0) * 0.5;
        Self::new(Grid::from_fn(size, cell_size, |cell| elevation((cell.as_vec2() - half) * cell_size))?)
    }

    /// The same bed with its gaps filled by a smooth continuation of the ground around them, at least `lowest` (m), so
    /// that land goes on where the data ends.
    pub fn filled(&self, lowest: f32) -> Self {
        let filled = fill_missing(&self.elevations, lowest);
        Self { steepest: steepest_slope(&filled), elevations: Arc::new(filled) }
    }

    /// The elevations, m; NaN where there is no data.
    pub fn elevations(&self) -> &Arc<Grid<f32>> {
        &self.elevations
    }

    /// Bound of the slope of the ground; infinite if data is missing.
    pub(crate) fn steepest(&self) -> f32 {
        self.steepest
    }

    /// Elevation at local xz, m, bilinear between cell centres; `None` outside the grid and where data is missing.
    pub fn height(&self, place: Vec2) -> Option<f32> {
        self.elevations.cell_at(place)?;
        let height = self.elevations.sample(place);
        height.is_finite().then_some(height)
    }

    /// Upward unit normal of the ground at local xz, from central differences over one cell; `None` where
    /// [`WaterBed::height`] has none.
    pub fn normal(&self, place: Vec2) -> Option<Vec3> {
        let here = self.height(place)?;
        let step = self.elevations.cell_size() * 0.5;
        let height = |offset: Vec2| self.height(place + offset);
        // One-sided where the other side is missing.
        let slope = |axis: Vec2| match (height(-axis * step), height(axis * step)) {
            (Some(before), Some(after)) => (after - before) / (2.0 * step),
            (Some(before), None) => (here - before) / step,
            (None, Some(after)) => (after - here) / step,
            (None, None) => 0.0,
        };
        Some(vec3(-slope(Vec2::X), 1.0, -slope(Vec2::Y)).normalize())
    }

    /// The triangles of the cells of `columns` × `rows` (corners at cell centres, the last ones included), or `None`
    /// where all of it is without data. Smooth normals; uv in metres of local xz.
    ///
    /// A quad with one corner missing becomes one triangle, with more missing it is left out. The diagonal follows the
    /// smaller height difference, so that narrow channels and dikes stay whole.
    pub fn mesh(&self, columns: core::ops::Range<u32>, rows: core::ops::Range<u32>) -> Option<Mesh> {
        let size = self.elevations.size();
        let columns = columns.start..(columns.end + 1).min(size.x);
        let rows = rows.start..(rows.end + 1).min(size.y);
        let width = columns.len();
        let mut vertices = Vertices::default();
        for row in rows.clone() {
            for column in columns.clone() {
                vertices.push(self, uvec2(column, row));
            }
        }
        let mut indices = Vec::new();
        for row in 0..rows.len().saturating_sub(1) {
            for column in 0..width.saturating_sub(1) {
                let corner = row * width + column;
                vertices.triangulate([corner, corner + 1, corner + width + 1, corner + width], &mut indices);
            }
        }
        (!indices.is_empty()).then(|| vertices.mesh(indices))
    }

    fn vertex_normal(&self, cell: UVec2) -> Vec3 {
        self.normal(self.elevations.position(cell)).unwrap_or(Vec3::Y)
    }
}

#[derive(Default)]
struct Vertices {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
}

impl Vertices {
    fn push(&mut self, bed: &WaterBed, cell: UVec2) {
        let place = bed.elevations.position(cell);
        let height = bed.elevations.get(cell).copied().unwrap_or(f32::NAN);
        self.positions.push(vec3(place.x, height, place.y));
        self.normals.push(if height.is_finite() { bed.vertex_normal(cell) } else { Vec3::Y });
    }

    /// Adds the triangles of a quad whose corners go round as north-west, north-east, south-east, south-west.
    fn triangulate(&self, quad: [usize; 4], indices: &mut Vec<u32>) {
        let height = quad.map(|i| self.positions[i].y);
        let mut add = |corners: [usize; 3]| indices.extend(corners.map(|corner| quad[corner] as u32));
        match height.iter().position(|z| !z.is_finite()) {
            None if (height[0] - height[2]).abs() <= (height[1] - height[3]).abs() => {
                add([0, 2, 1]);
                add([0, 3, 2]);
            }
            None => {
                add([0, 3, 1]);
                add([1, 3, 2]);
            }
            Some(missing) if height.iter().filter(|z| z.is_finite()).count() == 3 => {
                add([(missing + 3) % 4, (missing + 2) % 4, (missing + 1) % 4]);
            }
            Some(_) => {}
        }
    }

    fn mesh(mut self, indices: Vec<u32>) -> Mesh {
        // Unused corners without data would make the bounding box NaN.
        let lowest = self.positions.iter().map(|p| p.y).filter(|y| y.is_finite()).fold(f32::MAX, f32::min);
        for position in self.positions.iter_mut().filter(|p| !p.y.is_finite()) {
            position.y = lowest;
        }
        let uvs: Vec<Vec2> = self.positions.iter().map(|p| p.xz()).collect();
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, self.positions)
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, self.normals)
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
            .with_inserted_indices(Indices::U32(indices))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn height_and_normal_follow_a_plane() {
        let bed = WaterBed::from_fn(uvec2(20, 30), 2.0, |p| 0.25 * p.x - 0.5 * p.y + 3.0).unwrap();
        let place = vec2(3.3, -7.1);
        assert!((bed.height(place).unwrap() - (0.25 * 3.3 + 0.5 * 7.1 + 3.0)).abs() < 1e-4);
        assert!(bed.normal(place).unwrap().distance(vec3(-0.25, 1.0, 0.5).normalize()) < 1e-4);
        assert_eq!(bed.height(vec2(100.0, 0.0)), None);
    }

    #[test]
    fn mesh_has_every_triangle_and_faces_up() {
        let bed = WaterBed::from_fn(uvec2(8, 6), 1.0, |p| (p.x * 0.7).sin() + p.y * 0.1).unwrap();
        let mesh = bed.mesh(0..7, 0..5).unwrap();
        assert_eq!(mesh.triangles().unwrap().count(), 2 * 7 * 5);
        for triangle in mesh.triangles().unwrap() {
            assert!(triangle.normal().unwrap().y > 0.0);
        }
    }

    #[test]
    fn cells_without_data_leave_a_gap_and_nothing_else() {
        let bed = WaterBed::from_fn(uvec2(5, 5), 1.0, |p| if p == Vec2::ZERO { f32::NAN } else { 1.0 }).unwrap();
        // The four quads around the missing corner keep one triangle each.
        assert_eq!(bed.mesh(0..4, 0..4).unwrap().triangles().unwrap().count(), 2 * 12 + 4);
        assert_eq!(bed.height(Vec2::ZERO), None);
        assert!(WaterBed::from_fn(uvec2(2, 2), 1.0, |_| f32::NAN).is_err());
    }

    #[test]
    fn ground_at_infinity_is_no_data() {
        let bed = WaterBed::from_fn(uvec2(5, 5), 1.0, |p| if p.x > 0.0 { f32::NEG_INFINITY } else { 1.0 }).unwrap();
        assert_eq!([-1.0, 0.5, 1.0].map(|x| bed.height(vec2(x, 0.0))), [Some(1.0), None, None]);
    }
}
