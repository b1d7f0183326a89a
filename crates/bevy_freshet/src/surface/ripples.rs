//! How far the fine ripples have travelled.
use super::{WaterSurface, sync::GroundTextures};
use crate::{body::ResolvedWater, report::Reported};
use bevy::{
    math::{DMat2, DVec2},
    prelude::*,
};
use core::f32::consts::TAU;

/// The second layer of ripples in the shader: turned by 30° and of half the size.
const SECOND: DMat2 = DMat2::from_cols(DVec2::new(1.7321, 1.0), DVec2::new(-1.0, 1.7321));

/// Longest way that the current carries a ripple before it is faded out and starts anew, in tiles.
const DRIFT_TILES: f32 = 0.5;

/// The ripples of a water. Their ways are added up step by step, so that a change of wind or current changes their
/// speed and not their place.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(crate) struct Ripples {
    /// Size of the pattern, m.
    pub size: f32,
    /// Shifts of the two layers, tiles.
    pub shifts: [DVec2; 2],
    /// Period of the two-phase drift with the flow map, s.
    pub cycle: f32,
    /// Where in that period the drift is, 0…1.
    pub phase: f64,
    /// Way of the uniform part of the current, m.
    pub carried: DVec2,
}

/// Lets every water's ripples travel: with the phase speed of their mean wavelength, the layers at an angle to each
/// other, and with the uniform part of the current.
pub(crate) fn advance_ripples(
    time: Res<Time>,
    mut ground: ResMut<GroundTextures>,
    mut reported: ResMut<Reported>,
    mut waters: Query<(Entity, &WaterSurface, &ResolvedWater, &mut Ripples)>,
) {
    let step = time.delta_secs_f64();
    for (entity, settings, water, mut ripples) in &mut waters {
        let size = reported.clamp(entity, "WaterSurface::ripple_size", settings.ripple_size, 1e-3..=1e4, 4.0);
        // The middle of the tile's octaves holds about 12 waves.
        let speed = |waves: f32| {
            let wavenumber = TAU * waves / size;
            freshet_hydro::waves::angular_frequency(wavenumber, f32::INFINITY) / wavenumber
        };
        let wind = water.waves.trains.first().map_or(Vec2::X, |train| train.wave_vector.normalize_or(Vec2::X));
        let first = wind * speed(12.0) + water.drift;
        let second = Vec2::from_angle(0.7).rotate(wind) * speed(24.0) + water.drift;
        let tiles = [first.as_dvec2(), SECOND * second.as_dvec2()].map(|velocity| velocity * step / f64::from(size));
        for (shift, moved) in ripples.shifts.iter_mut().zip(tiles) {
            *shift = (*shift + moved).fract_gl();
        }
        ripples.carried += water.drift.as_dvec2() * step;
        ripples.size = size;
        // The fastest water drifts by a fixed share of a tile in a cycle: nothing is stretched far.
        let fastest = match (&water.simulated, &water.flow) {
            // In powers of two, as every change of the cycle shifts the patterns.
            (Some(simulated), map) => {
                let around = map.as_ref().filter(|_| simulated.area.is_part());
                let around = around.map_or(0.0, |(map, scale)| ground.fastest(map) * scale.abs());
                simulated.water.fastest().max(around).max(0.25).log2().ceil().exp2()
            }
            (None, Some((map, scale))) => ground.fastest(map) * scale.abs(),
            (None, None) => 0.0,
        };
        ripples.cycle = (DRIFT_TILES * size / fastest.max(1e-3)).min(20.0);
        ripples.phase = (ripples.phase + step / f64::from(ripples.cycle)).fract();
    }
}
