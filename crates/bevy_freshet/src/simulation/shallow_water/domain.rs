//! The rectangle of cells that stands for a water, and the ground under it.
use crate::{
    body::{ResolvedBed, ResolvedWater, SimulatedArea, WaterEdges, WaterSimulation, WaterWalls},
    report::Reported,
};
use bevy::prelude::*;
use freshet_hydro::{
    grid::Grid,
    shallow_water::{DomainSide, Edge, EdgePart, ShallowWater, ShallowWaterError},
};

/// Most cells of a simulation.
const MOST_CELLS: f32 = 16_777_216.0;
/// Most of them in a row: the largest picture that every device of WebGPU has.
const MOST_IN_ROW: f32 = 8192.0;
/// Higher than the highest ground by this, m, the land is where the bed has no data.
const NO_DATA_RISE: f32 = 1.0;
/// Most samples of the bed along a side of a cell.
const MOST_SAMPLES: f32 = 8.0;

/// Where the cells of a simulation lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Domain {
    /// Columns and rows.
    pub size: UVec2,
    /// Side of a cell, m.
    pub cell: f32,
    /// Their middle, local xz, m.
    pub center: Vec2,
}

impl Domain {
    /// The cells of an area, and the area that they fill.
    pub fn new(area: SimulatedArea, cell_size: f32) -> (Self, SimulatedArea) {
        let (size, cell) = cells_of(area.half_size, cell_size);
        let half_size = if area.is_part() { 0.5 * cell * size.as_vec2() } else { area.half_size };
        (Self { size, cell, center: area.center }, SimulatedArea { half_size, ..area })
    }
}

/// The part of a water that is simulated.
pub(super) fn usable_area(
    entity: Entity,
    water: &ResolvedWater,
    settings: &WaterSimulation,
    reported: &mut Reported,
) -> SimulatedArea {
    let all = SimulatedArea::all(water.half_size);
    let Some(wanted) = settings.area else { return all };
    let blend = reported.clamp(entity, "WaterSimulation::blend", settings.blend, 0.0..=1e4, 4.0);
    SimulatedArea::part(wanted, water.half_size, blend).unwrap_or_else(|| {
        reported.warn(
            entity,
            "WaterSimulation::area",
            format_args!("is {wanted:?}, no part of the water; all of it is used"),
        );
        all
    })
}

/// Columns, rows and the side of a cell (m) of a water: as many whole cells as fit best, fewer and larger ones if they were
/// more than can be simulated.
pub(super) fn cells_of(half_size: Vec2, cell_size: f32) -> (UVec2, f32) {
    let extent = 2.0 * half_size;
    let smallest = (extent.x * extent.y / MOST_CELLS).sqrt().max(extent.max_element() / MOST_IN_ROW);
    // A water may be narrower than a cell.
    let cell = cell_size.min(extent.min_element()).max(smallest);
    ((extent / cell).round().max(Vec2::ONE).as_uvec2(), cell)
}

/// Elevation of the ground where there is no bed, m over the still level.
pub(super) fn usable_ground(settings: &WaterSimulation) -> f32 {
    if settings.ground.is_finite() { settings.ground.clamp(-1e5, 1e5) } else { WaterSimulation::default().ground }
}

/// Elevations of the ground over the still level (m), each the mean over its cell.
pub(super) fn ground_below(water: &ResolvedWater, settings: &WaterSimulation, domain: &Domain) -> Grid<f32> {
    let &Domain { size, cell, center } = domain;
    let Some(bed) = &water.bed else {
        let flat = usable_ground(settings);
        return Grid::from_fn(size, cell, |_| flat).expect("a water has cells");
    };
    let base = bed.base - water.level;
    let highest = bed.elevations.values().iter().copied().filter(|z| z.is_finite()).fold(f32::NEG_INFINITY, f32::max);
    let samples = (2.0 * cell / bed.elevations.cell_size()).ceil().clamp(1.0, MOST_SAMPLES) as u32;
    let middle = size.as_vec2() / 2.0;
    let mean = |at: UVec2| {
        let place = center + (at.as_vec2() - middle) * cell;
        mean_elevation(bed, place, cell, samples).unwrap_or(highest + NO_DATA_RISE) + base
    };
    Grid::from_fn(size, cell, mean).expect("a water has cells")
}

/// Mean elevation over the cell whose north-western corner is at local `corner`; nothing if no sample has data.
fn mean_elevation(bed: &ResolvedBed, corner: Vec2, cell: f32, samples: u32) -> Option<f32> {
    let (mut sum, mut count) = (0.0, 0_u32);
    for sample in 0..samples * samples {
        let within = (uvec2(sample % samples, sample / samples).as_vec2() + 0.5) / samples as f32;
        let elevation = bed.elevations.sample(bed.bed_from_local.transform_point2(corner + within * cell));
        if elevation.is_finite() {
            sum += elevation;
            count += 1;
        }
    }
    (count > 0).then(|| sum / count as f32)
}

/// Cells of a side that a part from `from` to `to` (local m along it) covers; nothing if it covers none.
pub(super) fn cells_of_part(water: &ShallowWater, side: DomainSide, from: f32, to: f32) -> Option<EdgePart> {
    let size = water.size();
    let count = if matches!(side, DomainSide::West | DomainSide::East) { size.y } else { size.x };
    let index = |along: f32| (along / water.cell_size() + count as f32 / 2.0).round().clamp(0.0, count as f32) as u32;
    let (first, last) = (index(from.min(to)), index(from.max(to)));
    if from.is_nan() || to.is_nan() || first == last { None } else { Some(EdgePart::Cells(first..last)) }
}

/// Sets what is outside the sides where nothing else is said: walls, but the water around it towards that.
pub(super) fn set_rims(
    water: &mut ShallowWater,
    area: &SimulatedArea,
    around: &ResolvedWater,
) -> Result<(), ShallowWaterError> {
    for (side, per_blend) in DomainSide::ALL.into_iter().zip(area.per_blend.to_array()) {
        water.set_edge(side, EdgePart::All, default())?;
        if per_blend <= 0.0 {
            continue;
        }
        let (inwards, count) = match side {
            DomainSide::West => (Vec2::X, water.size().y),
            DomainSide::East => (Vec2::NEG_X, water.size().y),
            DomainSide::North => (Vec2::Y, water.size().x),
            DomainSide::South => (Vec2::NEG_Y, water.size().x),
        };
        for cell in 0..count {
            let along = (cell as f32 + 0.5) * water.cell_size() - area.half_size.dot(inwards.yx().abs());
            let place = area.center - inwards * area.half_size + inwards.yx().abs() * along;
            let entering = around.mapped_current(place).dot(inwards);
            let edge = Edge::Stream { level: 0.0.into(), entering: entering.into() };
            water.set_edge(side, EdgePart::Cells(cell..cell + 1), edge)?;
        }
    }
    Ok(())
}

/// Sets what is outside parts of the sides; the error is that of the first part that is refused.
pub(super) fn set_edges(water: &mut ShallowWater, edges: &WaterEdges, center: Vec2) -> Result<(), ShallowWaterError> {
    water.set_periodic(edges.periodic.x, edges.periodic.y);
    let mut result = Ok(());
    for part in &edges.parts {
        let offset = if matches!(part.side, DomainSide::West | DomainSide::East) { center.y } else { center.x };
        if let Some(cells) = cells_of_part(water, part.side, part.from - offset, part.to - offset) {
            result = result.and(water.set_edge(part.side, cells, part.edge.clone()));
        }
    }
    result
}

/// Puts walls on the faces of cells, along the staircase next to each line.
pub(super) fn set_walls(water: &mut ShallowWater, walls: &WaterWalls, center: Vec2) -> Result<(), ShallowWaterError> {
    water.clear_walls();
    let mut result = Ok(());
    for wall in &walls.walls {
        let cells = |place: Vec2| (place - center) / water.cell_size() + water.size().as_vec2() / 2.0;
        let (from, to) = (cells(wall.from), cells(wall.to));
        if !(from.is_finite() && to.is_finite()) {
            continue;
        }
        for (cell, side) in faces_along(from, to, water.size()) {
            result = result.and(water.set_wall(cell, side, wall.crest));
        }
    }
    result
}

/// The faces that separate the cells on one side of a line from those on the other, in cells from the north-western corner.
///
/// Along its longer axis the line crosses a column (or row) after the other; in each the face nearest to it is taken, and
/// where that one jumps, the faces across it.
fn faces_along(from: Vec2, to: Vec2, size: UVec2) -> Vec<(UVec2, DomainSide)> {
    let steep = (to - from).abs().y > (to - from).abs().x;
    let swap = |v: Vec2| if steep { v.yx() } else { v };
    let (a, b) = (swap(from), swap(to));
    let (a, b) = if a.x <= b.x { (a, b) } else { (b, a) };
    let size = if steep { size.yx() } else { size };
    let (along, across) =
        if steep { (DomainSide::West, DomainSide::North) } else { (DomainSide::North, DomainSide::West) };
    let mut faces = Vec::new();
    let cell = |x: u32, y: u32| if steep { uvec2(y, x) } else { uvec2(x, y) };
    let mut previous: Option<u32> = None;
    let (first, last) = (a.x.round().max(0.0) as u32, (b.x.round().max(0.0) as u32).min(size.x));
    for x in first..last {
        let share = ((x as f32 + 0.5 - a.x) / (b.x - a.x).max(1e-6)).clamp(0.0, 1.0);
        let y = (a.y + (b.y - a.y) * share).round().clamp(0.0, size.y as f32) as u32;
        if y > 0 && y < size.y {
            faces.push((cell(x, y), along));
        }
        if let Some(before) = previous {
            faces.extend((before.min(y)..before.max(y)).map(|y| (cell(x, y), across)));
        }
        previous = Some(y);
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_water_has_as_many_whole_cells_as_fit_best() {
        assert_eq!(cells_of(vec2(50.0, 20.2), 1.0), (uvec2(100, 40), 1.0));
        assert_eq!(cells_of(vec2(0.2, 9.0), 1.0), (uvec2(1, 45), 0.4));
        let (size, cell) = cells_of(Vec2::splat(5e5), 0.01);
        assert!(size.x <= 4096 && cell > 200.0);
        // A canal of 30 km: fewer cells than metres, wider than it is.
        let (size, cell) = cells_of(vec2(15_000.0, 1.0), 1.0);
        assert_eq!((size, cell), (uvec2(8192, 1), 30_000.0 / 8192.0));
    }

    #[test]
    fn a_wall_leaves_no_way_around_its_corners() {
        for (from, to) in
            [(vec2(1.0, 5.2), vec2(19.0, 9.7)), (vec2(4.4, 1.0), vec2(7.9, 14.0)), (vec2(3.0, 14.0), vec2(9.0, 2.0))]
        {
            let faces = faces_along(from, to, uvec2(20, 16));
            let closed = |cell: UVec2, side| faces.contains(&(cell, side));
            // From the first column or row to the last: flood from one side and never reach the other within the wall's span.
            let mut reached = vec![false; 20 * 16];
            let along = to - from;
            let is_beside = |cell: UVec2| {
                let away = cell.as_vec2() + 0.5 - from;
                let share = away.dot(along) / along.length_squared();
                (0.1..0.9).contains(&share)
            };
            let start = (0..320).map(|i| uvec2(i % 20, i / 20)).find(|&cell| is_beside(cell)).expect("cells");
            let mut stack = vec![start];
            let side_of = |cell: UVec2| along.perp_dot(cell.as_vec2() + 0.5 - from).signum();
            while let Some(cell) = stack.pop() {
                let i = (cell.y * 20 + cell.x) as usize;
                if std::mem::replace(&mut reached[i], true) {
                    continue;
                }
                let mut go = |to: UVec2, is_open: bool| {
                    if is_open && to.cmplt(uvec2(20, 16)).all() && is_beside(to) {
                        stack.push(to);
                    }
                };
                go(cell - uvec2(1, 0).min(cell), !closed(cell, DomainSide::West));
                go(cell - uvec2(0, 1).min(cell), !closed(cell, DomainSide::North));
                go(cell + uvec2(1, 0), !closed(cell + uvec2(1, 0), DomainSide::West));
                go(cell + uvec2(0, 1), !closed(cell + uvec2(0, 1), DomainSide::North));
            }
            let far = (0..320).map(|i| uvec2(i % 20, i / 20)).filter(|&cell| {
                let distance = along.perp_dot(cell.as_vec2() + 0.5 - from) / along.length();
                is_beside(cell) && side_of(cell) != side_of(start) && distance.abs() > 1.5
            });
            assert!(far.into_iter().all(|cell| !reached[(cell.y * 20 + cell.x) as usize]), "{from} {to}");
        }
    }
}
