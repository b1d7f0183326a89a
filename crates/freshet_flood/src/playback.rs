//! Floods as water that is played back: level, depth and velocity of every cell at any time between two steps.

use std::sync::Arc;

use freshet_hydro::grid::Grid;
use freshet_hydro::shallow_water::Field;
use glam::{Vec2, Vec4, vec2, vec4};

use crate::interpolation::Interval;
use crate::maps::{FloodMaps, Map, MapsError};
use crate::step::Quantity;

/// Elevation of ground without data, m: a bank that nothing climbs.
const BANK: f32 = 1e4;

/// What is the same at all times of a flood: its ground, and the way of the whole flood.
#[derive(Debug)]
pub struct Ground {
    /// Elevation of every cell, m.
    elevations: Vec<f32>,
    /// The current of the whole flood, m/s, if it was converted.
    current: Option<Vec<Vec2>>,
}

/// Two steps, and the water on the way from one to the other.
#[derive(Debug)]
pub struct PlayedInterval {
    /// The first of them.
    pub index: usize,
    /// The ground under it, shared with the other intervals of a flood.
    pub ground: Arc<Ground>,
    interval: Interval,
    /// Velocity at both steps, m/s.
    velocities: [Vec<Vec2>; 2],
}

/// A flood without water.
pub fn dry(maps: &FloodMaps) -> Field {
    let place = maps.georeference();
    let cells = Grid::from_fn(place.size, place.cell_size as f32, |_| vec4(BANK, 0.0, 0.0, 0.0));
    cells.map_or_else(|_| Field::default(), |cells| Field::from_cells(cells, None, 0.0))
}

impl Ground {
    fn read(maps: &FloodMaps) -> Result<Self, MapsError> {
        let manifest = maps.manifest();
        let size = manifest.georeference.size;
        let count = size.x as usize * size.y as usize;
        let elevations = match manifest.maps.contains_key(&Map::Terrain) {
            true => maps.terrain()?.into_values(),
            false => vec![0.0; count],
        };
        let current = manifest.flow.as_ref().map(|_| Ok::<_, MapsError>(maps.flow()?.velocity.into_values()));
        Ok(Self { elevations, current: current.transpose()? })
    }

    /// Velocities at a step: what the model wrote, else its speeds along the current, else the current.
    fn velocities(&self, maps: &FloodMaps, index: usize) -> Result<Vec<Vec2>, MapsError> {
        let has = |wanted: Quantity| maps.quantities(index).any(|quantity| quantity == wanted);
        let read = |quantity: Quantity| Ok::<_, MapsError>(maps.quantity(index, quantity)?.into_values());
        if has(Quantity::East) && has(Quantity::North) {
            let (east, north) = (read(Quantity::East)?, read(Quantity::North)?);
            return Ok(east.into_iter().zip(north).map(|(east, north)| vec2(east, -north)).collect());
        }
        let Some(current) = &self.current else { return Ok(vec![Vec2::ZERO; self.elevations.len()]) };
        if !has(Quantity::Speed) {
            return Ok(current.clone());
        }
        let speeds = read(Quantity::Speed)?;
        Ok(speeds.into_iter().zip(current).map(|(speed, along)| speed * along.normalize_or_zero()).collect())
    }
}

impl PlayedInterval {
    /// Reads the step at `index` and the next one; the last one stays as it is. `ground` is read too if it is not known.
    ///
    /// # Errors
    /// [`MapsError`] if a picture cannot be read, or there is no such step.
    pub fn read(maps: &FloodMaps, ground: Option<Arc<Ground>>, index: usize) -> Result<Self, MapsError> {
        let ground = match ground {
            Some(ground) => ground,
            None => Arc::new(Ground::read(maps)?),
        };
        if index + 1 < maps.times().len() {
            let velocities = [ground.velocities(maps, index)?, ground.velocities(maps, index + 1)?];
            return Ok(Self { index, interval: maps.interval(index)?, velocities, ground });
        }
        let (time, depth) = (maps.times().get(index).copied().unwrap_or_default(), maps.depth(index)?);
        let interval = Interval::new((time, depth.clone()), (time + 1.0, depth), None, maps.threshold());
        let velocities = ground.velocities(maps, index)?;
        Ok(Self { index, interval, velocities: [velocities.clone(), velocities], ground })
    }

    /// The water at `time` (s of the data), `factor` times as high, rising as it has since `before`, which was so many seconds earlier.
    pub fn at(&self, time: f64, factor: f32, before: Option<(&Field, f64)>) -> Field {
        let depths = self.interval.depth_at(time);
        let share = self.interval.share(time);
        let mut cells = depths.values().iter().enumerate().map(|(i, depth)| self.cell(i, *depth, share, factor));
        let cells: Grid<Vec4> = depths.map(|_| cells.next().unwrap_or_default());
        let (before, elapsed) = before.unzip();
        Field::from_cells(cells, before, elapsed.unwrap_or_default())
    }

    /// Level, depth and velocity of a cell.
    fn cell(&self, index: usize, depth: f32, share: f32, factor: f32) -> Vec4 {
        let ground = self.ground.elevations.get(index).copied().filter(|ground| ground.is_finite());
        let Some(ground) = ground.filter(|_| depth >= self.interval.threshold) else {
            return vec4(factor * ground.unwrap_or(BANK), 0.0, 0.0, 0.0);
        };
        let is_wet = |step: &Grid<f32>| step.values()[index] >= self.interval.threshold;
        let [first, second] = [&self.velocities[0], &self.velocities[1]].map(|step| step[index]);
        let velocity = match (is_wet(&self.interval.before), is_wet(&self.interval.after)) {
            (true, true) => first.lerp(second, share),
            (true, false) => first,
            _ => second,
        };
        let velocity = if velocity.is_finite() { velocity } else { Vec2::ZERO };
        vec4(factor * (ground + depth), factor * depth, velocity.x, velocity.y)
    }
}
