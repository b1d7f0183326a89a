//! How finely a surface is drawn at each distance from its viewer.
use super::{WaterSurface, viewer::ViewerData};
use crate::{body::ResolvedWater, report::Reported};
use bevy::prelude::*;

/// Shape of a surface mesh, see [`nested_grid`](super::mesh::nested_grid).
#[derive(Component, Clone, Debug, PartialEq)]
pub(crate) struct SurfaceShape {
    /// Spacing of the finest grid, m.
    pub cell: f32,
    /// Cells across each ring that nothing coarsens.
    pub cells: u32,
    /// For each ring, from the middle outwards, the power of two by which its cells are larger than that.
    pub coarser: Vec<u8>,
}

/// What tells one mesh from another.
pub(super) type ShapeKey = (u32, u32, Vec<u8>);

/// Step of the mesh centre, in finest cells.
const SNAP_CELLS: f32 = 8.0;

impl SurfaceShape {
    /// Most rings, the square in the middle included: enough for the largest water with the finest mesh.
    pub const MOST_RINGS: usize = 32;

    /// The shape for a water and who looks at it.
    pub fn new(
        entity: Entity,
        settings: &WaterSurface,
        water: &ResolvedWater,
        viewer: &ViewerData,
        reported: &mut Reported,
    ) -> Self {
        let cell = reported.clamp(entity, "WaterSurface::cell", settings.cell, 0.005..=100.0, 0.15);
        let cells = reported.clamp(entity, "WaterSurface::cells", settings.cells as f32, 8.0..=256.0, 64.0);
        let error = reported.clamp(entity, "WaterSurface::mesh_error", settings.mesh_error, 0.0..=4.0, 0.25);
        let cells = (cells as u32).next_multiple_of(4);
        let mut shape = Self { cell, cells, coarser: Vec::new() };
        // From any place in the rectangle to its farthest corner, and a little more for the snapping of the centre.
        let rings = rings_for(shape.reach(), 2.0 * water.half_size.length() + SNAP_CELLS * cell);
        let (_, highest) = water.elevations();
        let height = ((viewer.pose.translation().y - water.level).abs() - highest).max(0.0);
        let wanted = |ring: i32| {
            let inner = if ring == 0 { 0.0 } else { shape.reach() * 2_f32.powi(ring - 1) };
            let distance = height.hypot((inner - SNAP_CELLS * cell).max(0.0));
            spacing_for(water, error * viewer.pixel_size(distance)) / (cell * 2_f32.powi(ring))
        };
        shape.coarser = coarsened(cells, (0..rings as i32).map(wanted));
        shape
    }

    /// Half the width of the square in the middle, m.
    pub fn reach(&self) -> f32 {
        self.cell * self.cells as f32 * 0.5
    }

    /// Size of the cells of each ring, m; the last is repeated.
    pub fn spacings(&self) -> [f32; Self::MOST_RINGS] {
        let last = self.coarser.len() - 1;
        core::array::from_fn(|ring| {
            let ring = ring.min(last);
            self.cell * 2_f32.powi(ring as i32 + i32::from(self.coarser[ring]))
        })
    }

    pub fn key(&self) -> ShapeKey {
        (self.cell.to_bits(), self.cells, self.coarser.clone())
    }

    /// Where the mesh is centred for an eye at local `eye`: steps of whole cells, so that vertices of the inner rings
    /// stay at the same places of the water while the camera moves.
    pub fn center(&self, eye: Vec2, half_size: Vec2) -> Vec2 {
        let step = self.cell * SNAP_CELLS;
        (eye.clamp(-half_size, half_size) / step).round() * step
    }
}

/// Rings, with the square of half width `inner` (m) in their middle, that reach at least `reach` metres from the centre.
fn rings_for(inner: f32, reach: f32) -> usize {
    let around = (reach / inner).max(1.0).log2().ceil() as usize;
    (around + 1).min(SurfaceShape::MOST_RINGS)
}

/// The widest spacing (m) with which each train of waves is drawn within `error` metres of its place, also where it fades at the
/// shore and at the front of ice.
///
/// Straight between samples s apart, A cos(k x) is off by A k² s²/8 at most. What is lower than the error needs no samples.
fn spacing_for(water: &ResolvedWater, error: f32) -> f32 {
    if error <= 0.0 {
        return 0.0;
    }
    let trains = water.waves.trains.iter().filter(|train| train.amplitude > error);
    let spacings = trains.map(|train| (8.0 * error / train.amplitude).sqrt() / train.wave_vector.length());
    // What fades turns within a cell of what it fades by.
    let highest = water.waves.trains.iter().map(|train| train.amplitude).fold(0.0, f32::max);
    let bed = water.bed.as_ref().filter(|_| water.fade_depth > 0.0 && highest > error);
    let ice = water.ice.as_ref().filter(|ice| highest.max(ice.deepest_drop()) > error);
    let bed = bed.map(|bed| bed.elevations.cell_size());
    let ice = ice.map(|ice| ice.order.cell_size());
    let simulated = water.simulated.as_ref().map(|simulated| simulated.water.cell_size());
    spacings.chain(bed).chain(ice).chain(simulated).fold(f32::INFINITY, f32::min)
}

/// The powers of two by which rings are coarsened of which each could do with cells `wanted` times as large. Rings keep 8 cells
/// or more, and cells do not shrink outwards.
fn coarsened(cells: u32, wanted: impl Iterator<Item = f32>) -> Vec<u8> {
    // Each ring must meet the next in whole cells.
    let most = (cells / 8).ilog2().min(cells.trailing_zeros() - 2) as f32;
    let coarsen = |inner: &mut u8, wanted: f32| {
        // NaN and less than one: as it is.
        let power = wanted.log2().floor().max(0.0).min(most) as u8;
        *inner = power.max(inner.saturating_sub(1));
        Some(*inner)
    };
    wanted.scan(0, coarsen).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_reach_as_far_as_asked() {
        let inner = 0.25 * 64.0 / 2.0;
        assert_eq!(rings_for(inner, 5.0), 1);
        assert_eq!(rings_for(inner, 8.1), 2);
        assert_eq!(rings_for(inner, 1000.0), 8);
        assert_eq!(rings_for(0.005, 1e30), SurfaceShape::MOST_RINGS);
    }

    #[test]
    fn a_ring_keeps_eight_cells_and_no_cell_is_smaller_than_one_farther_in() {
        let inf = f32::INFINITY;
        assert_eq!(coarsened(64, [0.5, 1.9, 2.0, 4.1, 64.0, inf].into_iter()), [0, 0, 1, 2, 3, 3]);
        assert_eq!(coarsened(64, [8.0, 0.0, 0.0, 0.0, f32::NAN].into_iter()), [3, 2, 1, 0, 0]);
        // 12 cells can be no other number that is a multiple of four.
        assert_eq!(coarsened(12, [inf, inf].into_iter()), [0, 0]);
        assert_eq!(coarsened(40, [inf, inf].into_iter()), [1, 1]);
        assert_eq!(coarsened(8, [inf].into_iter()), [0]);
    }
}
