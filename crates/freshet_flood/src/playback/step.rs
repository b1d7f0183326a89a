//! A step of a flood, as it is played back.

use bytemuck::{Pod, Zeroable};
use freshet_hydro::grid::Grid;
use glam::{UVec2, Vec2, vec2};
use half::f16;

use super::ground::{BANK, Ground};
use crate::maps::{FloodMaps, MapsError};
use crate::step::Quantity;

/// Water in a cell at a step.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct PlayedCell {
    /// Depth, m; 0 where the ground has no data.
    pub depth: f32,
    /// Velocity to the east and the south, m/s, as the bits of half precision.
    pub velocity: [u16; 2],
}

impl PlayedCell {
    /// Velocity to the east and the south, m/s.
    pub fn velocity(&self) -> Vec2 {
        Vec2::from(self.velocity.map(|bits| f16::from_bits(bits).to_f32()))
    }
}

/// All cells at a step, row by row from the north.
#[derive(Debug)]
pub struct PlayedStep {
    /// Its number.
    pub index: usize,
    /// Its time, s in the data.
    pub time: f64,
    /// What is in the cells.
    pub cells: Vec<PlayedCell>,
}

impl PlayedStep {
    /// Reads the step at `index`.
    ///
    /// # Errors
    /// [`MapsError`] if a picture cannot be read, or there is no such step.
    pub fn read(maps: &FloodMaps, ground: &Ground, index: usize) -> Result<Self, MapsError> {
        let (depth, velocity) = (maps.depth(index)?, velocities(maps, ground, index)?);
        let cell = |place: usize, depth: f32| {
            let is_known = ground.elevations.get(place).is_some_and(|elevation| *elevation != BANK);
            let velocity = velocity.as_ref().and_then(|velocity| velocity.get(place)).copied().unwrap_or_default();
            let velocity = if velocity.is_finite() { velocity } else { Vec2::ZERO };
            PlayedCell {
                depth: if is_known { depth.max(0.0) } else { 0.0 },
                velocity: velocity.to_array().map(|speed| f16::from_f32(speed).to_bits()),
            }
        };
        let cells = depth.values().iter().enumerate().map(|(place, depth)| cell(place, *depth)).collect();
        Ok(Self { index, time: maps.times().get(index).copied().unwrap_or_default(), cells })
    }

    /// Depths, m.
    pub(super) fn depths(&self, size: UVec2, cell_size: f32) -> Grid<f32> {
        let depths = self.cells.iter().map(|cell| cell.depth).collect();
        Grid::new(size, cell_size, depths).expect("a flood has cells")
    }
}

/// Velocities at a step: what the model wrote, else its speeds along the current, else the current; nothing if there is neither.
fn velocities(maps: &FloodMaps, ground: &Ground, index: usize) -> Result<Option<Vec<Vec2>>, MapsError> {
    let has = |wanted: Quantity| maps.quantities(index).any(|quantity| quantity == wanted);
    let read = |quantity: Quantity| Ok::<_, MapsError>(maps.quantity(index, quantity)?.into_values());
    if has(Quantity::East) && has(Quantity::North) {
        let (east, north) = (read(Quantity::East)?, read(Quantity::North)?);
        return Ok(Some(east.into_iter().zip(north).map(|(east, north)| vec2(east, -north)).collect()));
    }
    let Some(current) = &ground.current else { return Ok(None) };
    if !has(Quantity::Speed) {
        return Ok(Some(current.clone()));
    }
    let speeds = read(Quantity::Speed)?;
    Ok(Some(speeds.into_iter().zip(current).map(|(speed, along)| speed * along.normalize_or_zero()).collect()))
}
