//! The surface of a simulated water as others see it: level, depth and velocity at any place, smooth over the wet cells.
use super::{
    ShallowWater,
    cells::{self, FieldSample, WET, WaterCells},
};
use glam::{UVec2, Vec2, Vec4, Vec4Swizzles};
use std::sync::Arc;

/// A state of a [`ShallowWater`] for looking up places, with how fast its level changes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Field {
    size: UVec2,
    cell_size: f32,
    /// Level (m), depth (m) and velocity (m/s) of every cell.
    cells: Vec<Vec4>,
    /// ∂η/∂t of every cell, m/s.
    rising: Vec<f32>,
    /// Slope of the level in every wet cell.
    slopes: Vec<Vec2>,
    /// Whether a wall stands above the water at the eastern and southern face of every cell; empty if there is none.
    walls: Vec<[bool; 2]>,
    lowest: f32,
    highest: f32,
    steepest: f32,
    fastest: f32,
}

/// ∂η/∂t of `cells`, m/s, since `before`, `elapsed` (s) earlier; 0 where it was dry, or nothing is known.
fn rising(cells: &[Vec4], before: Option<&Field>, elapsed: f64) -> Vec<f32> {
    let Some(before) = before.filter(|before| before.cells.len() == cells.len() && elapsed > 0.0) else {
        return vec![0.0; cells.len()];
    };
    let rate = |(now, then): (&Vec4, &Vec4)| {
        if now.y > WET && then.y > WET { (now.x - then.x) / elapsed as f32 } else { 0.0 }
    };
    cells.iter().zip(&before.cells).map(rate).collect()
}

impl Field {
    /// The state of `water`, rising as it has since `before`, which was `elapsed` (s) earlier.
    pub fn new(water: &ShallowWater, before: Option<&Self>, elapsed: f64) -> Self {
        let size = water.size();
        let cell = |index| {
            let velocity = water.velocity(index);
            Vec4::new(water.level(index), water.depths()[index], velocity.x, velocity.y)
        };
        let cells: Vec<Vec4> = (0..water.depths().len()).map(cell).collect();
        let rising = rising(&cells, before, elapsed);
        let mut field = Self { size, cell_size: water.cell_size(), cells, rising, ..Self::default() };
        field.find_walls(water);
        field.find_slopes();
        field.find_bounds();
        field
    }

    /// No water: one cell of dry ground at `level` (m).
    pub fn dry(level: f32) -> Self {
        let (cells, rising, slopes) = (vec![Vec4::new(level, 0.0, 0.0, 0.0)], vec![0.0], vec![Vec2::ZERO]);
        Self { size: UVec2::ONE, cell_size: 1.0, cells, rising, slopes, ..Self::default() }
    }

    fn find_walls(&mut self, water: &ShallowWater) {
        let Some(crests) = water.crests() else { return };
        let (columns, count) = (self.size.x as usize, self.cells.len());
        let stands = |crest: f32, here: usize, there: usize| {
            there < count && crest >= self.cells[here].x.max(self.cells[there].x)
        };
        let walls =
            crests.enumerate().map(|(i, [east, south])| [stands(east, i, i + 1), stands(south, i, i + columns)]);
        let walls: Vec<[bool; 2]> = walls.collect();
        if walls.iter().any(|wall| wall[0] || wall[1]) {
            self.walls = walls;
        }
    }

    fn find_slopes(&mut self) {
        self.slopes = (0..self.cells.len()).map(|index| cells::slope(self, index)).collect();
    }

    /// Takes over the levels of these cells of `water`, whose water is as it was: bodies have come into them, or left.
    ///
    /// Nothing happens, and `false` is given, if they lie where they did.
    pub fn follow(this: &mut Arc<Self>, water: &ShallowWater, cells: &[usize]) -> bool {
        if cells.iter().all(|&index| this.cells[index].x == water.level(index)) {
            return false;
        }
        let field = Arc::make_mut(this);
        for &index in cells {
            let level = water.level(index);
            field.cells[index].x = level;
            if field.cells[index].y > WET {
                field.lowest = field.lowest.min(level);
                field.highest = field.highest.max(level);
            }
        }
        let (columns, count) = (field.size.x as usize, field.cells.len());
        for &index in cells {
            let (north, west) = (index.checked_sub(columns), index.checked_sub(1));
            let around = [north, west, Some(index), Some(index + 1), Some(index + columns)];
            for index in around.into_iter().flatten().filter(|index| *index < count) {
                field.slopes[index] = cells::slope(field, index);
                field.steepest = field.steepest.max(field.slopes[index].length());
            }
        }
        true
    }

    fn find_bounds(&mut self) {
        (self.lowest, self.highest) = (f32::INFINITY, f32::NEG_INFINITY);
        for (cell, slope) in self.cells.iter().zip(&self.slopes).filter(|(cell, _)| cell.y > WET) {
            self.lowest = self.lowest.min(cell.x);
            self.highest = self.highest.max(cell.x);
            self.steepest = self.steepest.max(slope.length());
            self.fastest = self.fastest.max(cell.zw().length());
        }
        if self.lowest > self.highest {
            (self.lowest, self.highest) = (0.0, 0.0);
        }
    }

    /// Columns and rows.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Side of a cell, m.
    pub fn cell_size(&self) -> f32 {
        self.cell_size
    }

    /// Level (m), depth (m) and velocity (m/s) of every cell, row by row from the north.
    pub fn cells(&self) -> &[Vec4] {
        &self.cells
    }

    /// Slope of the level along x and z in every cell; 0 where it is dry.
    pub fn slopes(&self) -> &[Vec2] {
        &self.slopes
    }

    /// Whether a wall stands above the water at the eastern and southern face of every cell; empty if no wall does.
    pub fn walls(&self) -> &[[bool; 2]] {
        &self.walls
    }

    /// Lowest and highest level of wet cells, m; 0 if all is dry.
    pub fn levels(&self) -> (f32, f32) {
        (self.lowest, self.highest)
    }

    /// Steepest slope of the level.
    pub fn steepest(&self) -> f32 {
        self.steepest
    }

    /// Greatest speed, m/s.
    pub fn fastest(&self) -> f32 {
        self.fastest
    }

    /// The water at local (x, z) in metres, `age` (s) later than the field is: `None` where all cells around it are dry.
    ///
    /// Outside the outermost cell centres the nearest point on their rectangle counts.
    pub fn sample(&self, place: Vec2, age: f32) -> Option<FieldSample> {
        cells::sample(self, place, age)
    }
}

impl WaterCells for Field {
    fn size(&self) -> UVec2 {
        self.size
    }

    fn cell_size(&self) -> f32 {
        self.cell_size
    }

    fn cell(&self, index: usize) -> Vec4 {
        self.cells[index]
    }

    fn rising(&self, index: usize) -> f32 {
        self.rising[index]
    }

    fn slope(&self, index: usize) -> Vec2 {
        self.slopes[index]
    }

    fn has_wall(&self, index: usize, axis: usize) -> bool {
        self.walls.get(index).is_some_and(|wall| wall[axis])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{grid::Grid, shallow_water::DomainSide};
    use glam::{uvec2, vec2};

    /// A lake whose shore lies at x = 0, with a tilted surface.
    fn lake() -> Field {
        let bed = Grid::from_fn(uvec2(20, 8), 1.0, |cell| if cell.x < 10 { -2.0 } else { 3.0 }).expect("a valid shape");
        let mut water = ShallowWater::new(&bed).expect("a finite bed");
        water.set_water(|at, bed| ((0.1 * at.x - bed).max(0.0), vec2(0.5, -0.25))).expect("sane water");
        Field::new(&water, None, 0.0)
    }

    #[test]
    fn a_plane_is_sampled_exactly_and_does_not_climb_the_bank() {
        let field = lake();
        let inside = field.sample(vec2(-4.2, 0.7), 0.0).expect("water");
        assert!((inside.level + 0.42).abs() < 1e-5 && (inside.slope - vec2(0.1, 0.0)).length() < 1e-5);
        assert!((inside.velocity - vec2(0.5, -0.25)).length() < 1e-6);
        // Between the last wet centre and the first dry one the level is that of the wet one.
        let shore = field.sample(vec2(0.3, 0.0), 0.0).expect("water");
        assert!((shore.level + 0.05).abs() < 1e-5, "{shore:?}");
        assert_eq!(field.sample(vec2(5.0, 0.0), 0.0), None);
    }

    #[test]
    fn a_front_falls_to_the_ground_before_it() {
        let bed = Grid::new(uvec2(9, 3), 1.0, vec![0.0; 27]).expect("a valid shape");
        let mut water = ShallowWater::new(&bed).expect("a finite bed");
        water.set_water(|at, _| (if at.x < 0.5 { 0.4 } else { 0.0 }, Vec2::ZERO)).expect("sane water");
        let field = Field::new(&water, None, 0.0);
        let level = |x| field.sample(vec2(x, 0.0), 0.0).map(|sample| sample.level);
        assert_eq!([level(-0.5), level(0.0), level(0.25), level(0.5)], [Some(0.4), Some(0.4), Some(0.3), Some(0.2)]);
        assert_eq!(level(1.5), None);
    }

    #[test]
    fn water_does_not_lean_over_a_wall_unless_it_flows_over_it() {
        let bed = Grid::new(uvec2(8, 6), 1.0, vec![0.0; 48]).expect("a valid shape");
        let mut water = ShallowWater::new(&bed).expect("a finite bed");
        water.set_water(|at, _| (if at.x < 0.0 { 1.5 } else { 0.5 }, Vec2::ZERO)).expect("sane water");
        let level = |water: &ShallowWater, x| Field::new(water, None, 0.0).sample(vec2(x, 0.2), 0.0).expect("water");
        for row in 0..6 {
            water.set_wall(uvec2(3, row), DomainSide::East, 2.0).expect("a cell");
        }
        let [near, far] = [-0.05, 0.05].map(|x| level(&water, x));
        assert_eq!([near.level, far.level], [1.5, 0.5]);
        assert_eq!([near.slope, far.slope], [Vec2::ZERO; 2]);
        for row in 0..6 {
            water.set_wall(uvec2(3, row), DomainSide::East, 1.0).expect("a cell");
        }
        assert!((level(&water, 0.0).level - 1.0).abs() < 1e-6, "a weir is under water");
    }

    #[test]
    fn bounds_are_those_of_wet_cells() {
        let field = lake();
        let (lowest, highest) = field.levels();
        assert!((lowest + 0.95).abs() < 1e-5 && (highest + 0.05).abs() < 1e-5);
        assert!((field.steepest() - 0.1).abs() < 1e-5 && (field.fastest() - 0.559).abs() < 1e-3);
    }

    #[test]
    fn an_older_field_goes_on_rising() {
        let bed = Grid::new(uvec2(4, 4), 1.0, vec![0.0; 16]).expect("a valid shape");
        let mut water = ShallowWater::new(&bed).expect("a finite bed");
        water.fill(1.0).expect("a sane level");
        let before = Field::new(&water, None, 0.0);
        water.fill(1.25).expect("a sane level");
        let now = Field::new(&water, Some(&before), 0.5);
        let level = |age| now.sample(Vec2::ZERO, age).expect("water").level;
        assert!((level(0.0) - 1.25).abs() < 1e-6 && (level(0.25) - 1.375).abs() < 1e-5);
    }
}
