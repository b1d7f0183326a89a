//! What acts on the fields, as the stages read it: silhouettes cell by cell, and strokes sorted into tiles of cells.
use super::{Deposits, FieldWindow, SilhouetteCell, Stroke};
use bevy::{platform::collections::HashMap, prelude::*, render::render_resource::ShaderType};
use std::collections::BTreeMap;

/// Cells along the side of a tile, and of a workgroup.
pub(super) const TILE: u32 = 8;

/// How many standard deviations a stroke reaches: beyond lie 3·10⁻⁴ of it.
pub(crate) const REACH: f32 = 4.0;
/// Narrowest stroke, cells. Sampled at cell centres its volume is right to 10⁻⁴: the error is `2 exp(−2 π² σ²)` (Poisson
/// summation).
pub(crate) const NARROWEST: f32 = 0.75;

/// The twin of `Silhouette` in `bodies.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(test, derive(Reflect))]
pub(crate) struct GpuSilhouette {
    pub velocity: Vec2,
    pub cover: f32,
    pub raise: f32,
    pub cell: u32,
}

/// The twin of `Tile` in `deposit.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(test, derive(Reflect))]
pub(crate) struct GpuTile {
    pub corner: IVec2,
    pub first: u32,
    pub strokes: u32,
}

/// The twin of `Stroke` in `deposit.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(test, derive(Reflect))]
pub(crate) struct GpuStroke {
    pub middle: Vec2,
    pub radius: f32,
    pub volume: f32,
    pub dye: Vec3,
    pub foam: f32,
}

/// What acts on the fields in one frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct GpuDeposits {
    pub silhouettes: Vec<GpuSilhouette>,
    pub tiles: Vec<GpuTile>,
    pub strokes: Vec<GpuStroke>,
}

/// What bodies displaced in each cell when the fields were last advanced.
#[derive(Clone, Debug, Default)]
pub(crate) struct Drafts {
    window: FieldWindow,
    /// Draft (m) by column and row from the water's centre.
    cells: HashMap<IVec2, f32>,
}

impl Drafts {
    /// The silhouettes with the change of their drafts times `factor`, also of those that are gone.
    ///
    /// What stands in cells that were not in the window before has not just come there: it raises nothing.
    fn advance(&mut self, window: &FieldWindow, cells: &[SilhouetteCell], factor: f32) -> Vec<GpuSilhouette> {
        let known = |cell: IVec2| self.window.cell == window.cell && self.window.index(cell).is_some();
        let mut now = HashMap::default();
        let mut gone = core::mem::take(&mut self.cells);
        let mut silhouettes: Vec<GpuSilhouette> = Vec::with_capacity(cells.len());
        for one in cells {
            let cell = window.first + one.cell.as_ivec2();
            let Some(index) = window.index(cell) else { continue };
            let before = gone.remove(&cell).unwrap_or_default();
            let raise = if known(cell) { (one.draft - before) * factor } else { 0.0 };
            now.insert(cell, one.draft);
            silhouettes.push(GpuSilhouette { velocity: one.velocity, cover: one.cover, raise, cell: index });
        }
        let left = gone.into_iter().filter(|(cell, _)| known(*cell));
        silhouettes.extend(left.filter_map(|(cell, before)| {
            Some(GpuSilhouette { raise: -before * factor, cell: window.index(cell)?, ..default() })
        }));
        // The order in a map is not repeatable.
        silhouettes.sort_unstable_by_key(|one| one.cell);
        *self = Self { window: *window, cells: now };
        silhouettes
    }
}

impl FieldWindow {
    /// Where the cell at column and row from the water's centre is stored.
    fn index(&self, cell: IVec2) -> Option<u32> {
        let at = cell - self.first;
        let inside = at.cmpge(IVec2::ZERO).all() && at.cmplt(self.size.as_ivec2()).all();
        inside.then(|| at.y as u32 * self.size.x + at.x as u32)
    }
}

impl GpuDeposits {
    /// Silhouettes alone, while the clock stands still.
    pub fn covers(window: &FieldWindow, deposits: &Deposits) -> Self {
        Self { silhouettes: Drafts::default().advance(window, &deposits.silhouettes, 0.0), ..default() }
    }

    /// Deposits on a window after `drafts`, with the rings of bodies times `factor`.
    pub fn new(window: &FieldWindow, deposits: &Deposits, drafts: &mut Drafts, factor: f32) -> Self {
        let silhouettes = drafts.advance(window, &deposits.silhouettes, factor);
        let mut reached: BTreeMap<(u32, u32), Vec<GpuStroke>> = BTreeMap::new();
        for one in silhouettes.iter().filter(|one| one.raise != 0.0) {
            let at = uvec2(one.cell % window.size.x, one.cell / window.size.x).as_ivec2();
            for tile in tiles(window, at - 1, at + 1) {
                reached.entry(tile).or_default();
            }
        }
        for stroke in &deposits.strokes {
            let stroke = gpu_stroke(stroke, window.cell);
            let (middle, reach) = (window.cells_from_place(stroke.middle), stroke.radius / window.cell * REACH);
            let corners = [middle - reach, middle + reach].map(|corner| corner.floor().as_ivec2());
            for tile in tiles(window, corners[0], corners[1]) {
                reached.entry(tile).or_default().push(stroke);
            }
        }
        let mut sorted = Self { silhouettes, ..default() };
        for ((row, column), strokes) in reached {
            let (first, count) = (sorted.strokes.len() as u32, strokes.len() as u32);
            sorted.tiles.push(GpuTile { corner: (uvec2(column, row) * TILE).as_ivec2(), first, strokes: count });
            sorted.strokes.extend(strokes);
        }
        sorted
    }
}

/// Rows and columns of the tiles that the cells `first` to `last` of a window lie in.
fn tiles(window: &FieldWindow, first: IVec2, last: IVec2) -> impl Iterator<Item = (u32, u32)> + use<> {
    let most = window.size.as_ivec2() - 1;
    let inside = last.cmpge(IVec2::ZERO).all() && first.cmple(most).all();
    let [low, high] = [first, last].map(|cell| cell.clamp(IVec2::ZERO, most).as_uvec2() / TILE);
    let rows = if inside { low.y..high.y + 1 } else { 0..0 };
    rows.flat_map(move |row| (low.x..=high.x).map(move |column| (row, column)))
}

fn gpu_stroke(stroke: &Stroke, cell: f32) -> GpuStroke {
    let &Stroke { place, radius, volume, foam, dye } = stroke;
    GpuStroke { middle: place, radius: radius.max(NARROWEST * cell), volume, dye, foam }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::assert_same_layout;

    #[test]
    fn the_stages_read_what_is_written() {
        assert_same_layout::<GpuSilhouette, _>(include_str!("bodies.wgsl"), "Silhouette");
        assert_same_layout::<GpuTile, _>(include_str!("deposit.wgsl"), "Tile");
        assert_same_layout::<GpuStroke, _>(include_str!("deposit.wgsl"), "Stroke");
    }

    fn window(first: IVec2) -> FieldWindow {
        FieldWindow { first, size: uvec2(40, 24), cell: 0.5 }
    }

    fn body(column: u32, row: u32, draft: f32) -> SilhouetteCell {
        SilhouetteCell { cell: uvec2(column, row), cover: 1.0, draft, velocity: Vec2::X }
    }

    fn raised(silhouettes: &[GpuSilhouette]) -> f32 {
        silhouettes.iter().map(|one| one.raise).sum()
    }

    #[test]
    fn bodies_raise_what_they_newly_displace() {
        let mut drafts = Drafts::default();
        // What is there from the start has not just fallen in.
        assert_eq!(raised(&drafts.advance(&window(ivec2(-20, -12)), &[body(3, 4, 0.5)], 1.0)), 0.0);
        assert_eq!(raised(&drafts.advance(&window(ivec2(-20, -12)), &[body(3, 4, 0.7)], 1.0)), 0.7 - 0.5);
        // The same place in a window that has moved on, and a body that has just come.
        let there = [body(11, 4, 0.7), body(20, 20, 0.25)];
        assert_eq!(raised(&drafts.advance(&window(ivec2(-28, -12)), &there, 2.0)), 0.5);
        let gone = drafts.advance(&window(ivec2(-28, -12)), &[], 1.0);
        assert_eq!(raised(&gone), -0.7 - 0.25);
        assert!(gone.iter().all(|one| one.cover == 0.0));
        assert!(drafts.advance(&window(ivec2(-28, -12)), &[], 1.0).is_empty());
    }

    #[test]
    fn every_cell_that_a_stroke_reaches_is_in_one_tile_with_it() {
        let window = window(ivec2(-20, -12));
        let stroke =
            |x: f32, z: f32| Stroke { place: vec2(x, z), radius: 0.6, volume: 1.0, foam: 0.0, dye: Vec3::ZERO };
        let strokes = vec![stroke(0.1, 0.2), stroke(0.4, -0.3), stroke(9.9, 5.9), stroke(-40.0, 0.0)];
        let deposits = Deposits { strokes: strokes.clone(), ..default() };
        let sorted = GpuDeposits::new(&window, &deposits, &mut Drafts::default(), 1.0);
        let mut met = [0; 4];
        for at in (0..24).flat_map(|row| (0..40).map(move |column| ivec2(column, row))) {
            let of_cell: Vec<_> = sorted.tiles.iter().filter(|tile| tile.corner == at / 8 * 8).collect();
            assert!(of_cell.len() <= 1);
            let place = window.origin() + (at.as_vec2() + 0.5) * window.cell;
            for (n, stroke) in strokes.iter().enumerate().filter(|(_, stroke)| stroke.place.distance(place) < 4.0 * 0.6)
            {
                let tile = of_cell[0];
                let in_tile = &sorted.strokes[tile.first as usize..(tile.first + tile.strokes) as usize];
                assert_eq!(in_tile.iter().filter(|other| other.middle == stroke.place).count(), 1);
                met[n] += 1;
            }
        }
        assert!(met[0] > 50 && met[1] > 50 && met[2] > 10 && met[3] == 0, "{met:?}");
    }
}
