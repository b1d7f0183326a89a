//! Which part of a water is simulated.
use crate::{
    body::{ResolvedWater, WaterInteraction},
    report::Reported,
    simulation::{frame::FieldFrame, progress::FieldProgress},
    surface::Viewers,
};
use bevy::prelude::*;
use freshet_hydro::grid::Raster;

/// A rectangle of square cells that lies on a water, in whole cells from the water's centre.
///
/// The window moves in whole cells, so that what is in a cell stays where it is on the water.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
#[require(FieldProgress, FieldFrame)]
pub(crate) struct FieldWindow {
    /// The cell in the north-west corner; cell (0, 0) has its own north-west corner in the water's centre.
    pub first: IVec2,
    /// Cells along local x and z; zero where nothing is simulated.
    pub size: UVec2,
    /// Size of a cell, m.
    pub cell: f32,
}

/// Fewest cells along an axis of a window.
const FEWEST: f32 = 16.0;
/// Step of a window that follows the camera, cells.
const SNAP: f32 = 8.0;
/// How far ahead of the camera the middle of the window is, in lengths of the window.
const AHEAD: f32 = 0.35;

/// Part of a cell by which a water may be larger than its cells, lest one of whole cells gets one more by rounding.
const SLACK: f32 = 1e-3;

impl FieldWindow {
    /// Local xz of the north-west corner, m.
    pub fn origin(&self) -> Vec2 {
        self.first.as_vec2() * self.cell
    }

    /// Where local `place` lies, in cells from the north-west corner: the centre of the first cell is at (½, ½).
    pub fn cells_from_place(&self, place: Vec2) -> Vec2 {
        place / self.cell - self.first.as_vec2()
    }

    /// The cells of the window.
    pub fn raster(&self) -> Raster {
        Raster { origin: self.origin(), cell: self.cell, size: self.size }
    }

    /// Size along local x and z, m.
    pub fn extent(&self) -> Vec2 {
        self.size.as_vec2() * self.cell
    }

    /// 1 for each side (low x, high x, low z, high z) at which water of `half_size` (m) goes on beyond the window, 0 for those
    /// that are the water's own.
    pub fn open_sides(&self, half_size: Vec2) -> Vec4 {
        let (first, last) = (self.origin() + half_size, half_size - self.origin() - self.extent());
        let beyond = vec4(first.x, last.x, first.y, last.y);
        // Cells may end that much before the water does.
        Vec4::select(beyond.cmpgt(Vec4::splat(2.0 * SLACK * self.cell)), Vec4::ONE, Vec4::ZERO)
    }

    /// The window of a water of `half_size` (m) with cells of `cell` (m), at most `cells` along an axis: all of the water
    /// if it fits, else around local `middle` as far as the water reaches.
    fn around(middle: Vec2, half_size: Vec2, cell: f32, cells: f32) -> Self {
        // Water of few cells gets finer ones.
        let cell = cell.min(2.0 * half_size.min_element() / FEWEST);
        let reach = (half_size / cell - SLACK).ceil().max(Vec2::ONE);
        let size = (2.0 * reach).min(Vec2::splat(cells));
        let first = ((middle / cell - 0.5 * size) / SNAP).round() * SNAP;
        let first = first.clamp(-reach, reach - size);
        Self { first: first.as_ivec2(), size: size.as_uvec2(), cell }
    }
}

/// Chooses the window of every water: what the first camera looks at, if not all of it fits.
pub(super) fn place_windows(
    mut reported: ResMut<Reported>,
    viewers: Viewers,
    mut waters: Query<(Entity, &WaterInteraction, &ResolvedWater, &mut FieldWindow)>,
) {
    let eye = viewers.iter().next().map(|viewer| *viewer.pose);
    for (entity, settings, water, mut window) in &mut waters {
        let usable = WaterInteraction::default();
        let mut clamp = |field, value, range, fallback| reported.clamp(entity, field, value, range, fallback);
        let cell = clamp("WaterInteraction::cell", settings.cell, 0.01..=100.0, usable.cell);
        let cells = clamp("WaterInteraction::cells", settings.cells as f32, FEWEST..=2048.0, usable.cells as f32);
        let wanted = if settings.enabled && water.half_size != Vec2::ZERO {
            let ahead = |eye: GlobalTransform| {
                let way = AHEAD * cells * cell * eye.forward().xz();
                water.local_from_world.transform_point2(eye.translation().xz() + way)
            };
            FieldWindow::around(eye.map_or(Vec2::ZERO, ahead), water.half_size, cell, cells)
        } else {
            FieldWindow::default()
        };
        window.set_if_neq(wanted);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_water_that_fits_is_simulated_as_a_whole() {
        let window = FieldWindow::around(vec2(7.0, 3.0), vec2(10.0, 5.1), 0.25, 512.0);
        assert_eq!(window, FieldWindow { first: ivec2(-40, -21), size: uvec2(80, 42), cell: 0.25 });
        assert_eq!(window.cells_from_place(window.origin()), Vec2::ZERO);
        assert_eq!(window.open_sides(vec2(10.0, 5.1)), Vec4::ZERO);
        let odd = vec2(10.0002, 5.0002);
        assert_eq!(FieldWindow::around(Vec2::ZERO, odd, 0.25, 512.0).open_sides(odd), Vec4::ZERO);
        // However small it is.
        let puddle = FieldWindow::around(Vec2::ZERO, vec2(0.4, 1.0), 0.25, 512.0);
        assert_eq!(puddle.size, uvec2(16, 40));
    }

    #[test]
    fn a_window_of_large_water_stays_on_it_and_moves_in_steps() {
        let at = |x: f32, z: f32| FieldWindow::around(vec2(x, z), vec2(500.0, 300.0), 0.25, 256.0);
        for (x, z) in [(0.0, 0.0), (13.2, -99.0), (499.0, 299.0), (-1e6, 1e6)] {
            let window = at(x, z);
            assert_eq!(window.size, UVec2::splat(256));
            let (first, last) = (window.origin(), window.origin() + window.extent());
            assert!(first.cmpge(vec2(-500.0, -300.0)).all() && last.cmple(vec2(500.0, 300.0)).all(), "{window:?}");
        }
        assert_eq!(at(0.0, 0.0).open_sides(vec2(500.0, 300.0)), Vec4::ONE);
        assert_eq!(at(499.0, 0.0).open_sides(vec2(500.0, 300.0)), vec4(1.0, 0.0, 1.0, 1.0));
        assert_eq!(at(0.0, 0.0), at(0.9, -0.9));
        assert_eq!(at(2.0, 0.0).first - at(0.0, 0.0).first, ivec2(8, 0));
    }

    #[test]
    fn sides_beyond_which_the_water_goes_on_are_open() {
        let window = FieldWindow { first: ivec2(-10, -4), size: uvec2(20, 16), cell: 1.0 };
        assert_eq!(window.open_sides(vec2(10.0, 4.0)), Vec4::ZERO);
        assert_eq!(window.open_sides(vec2(10.0, 40.0)), vec4(0.0, 0.0, 1.0, 1.0));
        assert_eq!(window.open_sides(vec2(11.0, 40.0)), Vec4::ONE);
    }
}
