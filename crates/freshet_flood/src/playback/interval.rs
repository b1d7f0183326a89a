//! Two steps, and what happens between them.

use std::sync::Arc;

use glam::{UVec2, Vec2, vec2};

use super::{Ground, PlayedStep};
use crate::interpolation::Interval;
use crate::maps::{FloodMaps, Map, MapsError};

/// Two steps, and the water on the way from one to the other.
#[derive(Debug)]
pub struct PlayedInterval {
    /// The ground under it, shared with the other intervals of a flood.
    pub ground: Arc<Ground>,
    /// Both steps, each shared with the interval beside it; twice the same at the end of a flood.
    pub steps: [Arc<PlayedStep>; 2],
    /// When a cell turns dry or wet, as a share 0…1 of the time between the steps; 0 where it does not turn.
    pub turn: Vec<f32>,
    /// Columns and rows.
    pub size: UVec2,
    /// Side of a cell, m.
    pub cell_size: f32,
    /// Depth in metres from which on a cell is wet.
    pub threshold: f32,
    pub(super) bounds: Bounds,
}

/// What all wet cells lie between, at any time of an interval.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bounds {
    pub lowest: f32,
    pub highest: f32,
    pub steepest: f32,
    pub fastest: f32,
}

impl PlayedInterval {
    /// Reads the step at `index` and the next one, which stays as it is if it is the last; what is in `known` of the same flood is taken
    /// from there.
    ///
    /// # Errors
    /// [`MapsError`] if a picture cannot be read, or there is no such step.
    pub fn read(maps: &FloodMaps, known: &[Arc<Self>], index: usize) -> Result<Self, MapsError> {
        let ground = match known.first() {
            Some(part) => part.ground.clone(),
            None => Arc::new(Ground::read(maps)?),
        };
        let step = |index: usize| match known.iter().flat_map(|part| &part.steps).find(|step| step.index == index) {
            Some(step) => Ok(step.clone()),
            None => Ok::<_, MapsError>(Arc::new(PlayedStep::read(maps, &ground, index)?)),
        };
        let first = step(index)?;
        let second = if index + 1 < maps.times().len() { step(index + 1)? } else { first.clone() };
        let place = maps.georeference();
        let mut interval = Self {
            turn: Vec::new(),
            size: place.size,
            cell_size: place.cell_size as f32,
            threshold: maps.threshold(),
            bounds: Bounds::default(),
            ground,
            steps: [first, second],
        };
        interval.turn = interval.turns(maps)?;
        interval.bounds = interval.find_bounds();
        Ok(interval)
    }

    /// Number of the first step.
    pub fn index(&self) -> usize {
        self.steps[0].index
    }

    /// The share of the way from the first step to the second at a time, 0 before and 1 after them.
    pub fn share(&self, time: f64) -> f32 {
        let [start, end] = [&self.steps[0], &self.steps[1]].map(|step| step.time);
        if end > start { ((time - start) / (end - start)).clamp(0.0, 1.0) as f32 } else { 0.0 }
    }

    fn turns(&self, maps: &FloodMaps) -> Result<Vec<f32>, MapsError> {
        let [first, second] = &self.steps;
        if Arc::ptr_eq(first, second) {
            return Ok(vec![0.0; first.cells.len()]);
        }
        let arrival = match maps.manifest().maps.contains_key(&Map::Arrival) {
            true => Some(maps.arrival()?),
            false => None,
        };
        let depths = |step: &PlayedStep| (step.time, step.depths(self.size, self.cell_size));
        let [before, after] = [depths(first), depths(second)];
        Ok(Interval::new(before, after, arrival, self.threshold).turn.into_values())
    }

    /// Depths of a cell at both steps, m.
    pub(super) fn depths(&self, index: usize) -> [f32; 2] {
        [self.steps[0].cells[index].depth, self.steps[1].cells[index].depth]
    }

    /// Least and greatest level of a cell while it is wet, m.
    fn levels(&self, index: usize) -> Option<Vec2> {
        let [before, after] = self.depths(index);
        let ground = self.ground.elevations[index];
        let (least, most) = (before.min(after).max(self.threshold), before.max(after));
        (most >= self.threshold).then_some(ground + vec2(least, most))
    }

    fn find_bounds(&self) -> Bounds {
        let mut bounds = Bounds { lowest: f32::INFINITY, highest: f32::NEG_INFINITY, ..Bounds::default() };
        for index in 0..self.turn.len() {
            let Some(levels) = self.levels(index) else { continue };
            bounds.lowest = bounds.lowest.min(levels.x);
            bounds.highest = bounds.highest.max(levels.y);
            bounds.steepest = bounds.steepest.max(self.steepest_at(index, levels));
            let fastest = self.steps.each_ref().map(|step| step.cells[index].velocity().length());
            bounds.fastest = bounds.fastest.max(fastest[0].max(fastest[1]));
        }
        if bounds.lowest > bounds.highest { Bounds::default() } else { bounds }
    }

    /// No slope in a cell with these levels is steeper: dry ground beside it counts with its own level, or that of the cell.
    fn steepest_at(&self, index: usize, here: Vec2) -> f32 {
        let (columns, rows) = (self.size.x as usize, self.size.y as usize);
        let (column, row) = (index % columns, index / columns);
        let level = |exists: bool, there: usize| {
            if !exists {
                return here;
            }
            let ground = self.ground.elevations[there];
            let dry = Vec2::splat(ground).min(here);
            let is_always_wet = self.depths(there).iter().all(|depth| *depth >= self.threshold);
            match self.levels(there) {
                Some(wet) if is_always_wet => wet,
                Some(wet) => vec2(dry.x.min(wet.x), dry.y.max(wet.y)),
                None => dry,
            }
        };
        let (west, north) = (index.wrapping_sub(1), index.wrapping_sub(columns));
        let range = |a: Vec2, b: Vec2| (a.y - b.x).max(b.y - a.x);
        let x = range(level(column + 1 < columns, index + 1), level(column > 0, west));
        let z = range(level(row + 1 < rows, index + columns), level(row > 0, north));
        vec2(x, z).length() / (2.0 * self.cell_size)
    }
}
