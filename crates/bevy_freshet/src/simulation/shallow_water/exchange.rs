//! What floating bodies take from a simulated water and give back to it.
use super::driver::Simulated;
use crate::body::{ResolvedWater, SimulatedWater};
use bevy::prelude::*;
use freshet_hydro::shallow_water::{Displaced, Displacement, Field, Push};

/// The room that floating bodies take up in a simulated water, as of the last fixed step.
#[derive(Default)]
pub(crate) struct Exchange {
    pub displacement: Displacement,
    /// Cells that they were in before, by index.
    before: Vec<usize>,
}

impl Simulated {
    /// Time that has been simulated, s: less than before where it has begun anew.
    pub fn time(&self) -> f64 {
        self.simulation.as_deref().map_or(0.0, |simulation| simulation.water.time())
    }

    /// Takes all bodies out of the water, so that they can be put in where they are now. False if there is no simulation.
    pub fn take_bodies_out(&mut self) -> bool {
        let Some(simulation) = self.simulation.as_deref_mut() else { return false };
        let Exchange { displacement, before } = &mut self.exchange;
        displacement.clear();
        self.forces.clear();
        before.clear();
        before.extend(simulation.water.raised().map(|(index, _)| index));
        _ = simulation.water.set_displaced(&[]);
        true
    }

    /// How far the ground in a cell lies below the `level` at its middle (local xz, m), if there is such a cell and it does.
    pub fn room(&self, cell: IVec2, level: impl Fn(Vec2) -> f32) -> Option<f32> {
        let (raster, simulation) = (self.raster()?, self.simulation.as_deref()?);
        let room = level(raster.middle(cell)) - simulation.water.bed()[raster.index(cell)?];
        (room > 0.0).then_some(room)
    }

    /// Puts all bodies in: levels rise where they have come, and fall where they have gone, before the water answers.
    pub fn put_bodies_in(&mut self, resolved: &mut ResolvedWater) {
        let Some(simulation) = self.simulation.as_deref_mut() else { return };
        let Exchange { displacement, before: cells } = &mut self.exchange;
        if simulation.water.set_displaced(displacement.cells()).is_err() {
            // Cells of a simulation that has since got another size.
            displacement.clear();
        }
        cells.extend(simulation.water.raised().map(|(index, _)| index));
        if Field::follow(&mut simulation.field, &simulation.water, cells)
            && let Some(simulated) = &mut resolved.simulated
        {
            simulated.water = SimulatedWater::Field(simulation.field.clone());
        }
    }

    /// Force on the water per density (local x and z, m⁴/s²) by the room that a body takes up, over the next `dt` (s).
    pub fn reaction(&mut self, own: &[Displaced], dt: f64) -> Vec2 {
        let Some(simulation) = self.simulation.as_deref_mut().filter(|_| dt > 0.0) else { return Vec2::ZERO };
        simulation.water.reaction(own, dt)
    }

    /// Spreads a force on the water (local x and z, per density, m⁴/s²) over the cells of a body, by what it displaces and how much
    /// water is there.
    pub fn push_back(&mut self, force: Vec2, columns: &[(UVec2, f32)]) {
        let Some(simulation) = self.simulation.as_deref() else { return };
        let Some(raster) = self.raster() else { return };
        let depths = simulation.water.depths();
        let weigh = |&(at, depth): &(UVec2, f32)| Some((at, depth * depths[raster.index(at.as_ivec2())?]));
        let weighted = || columns.iter().filter_map(weigh);
        let sum: f32 = weighted().map(|(_, weight)| weight).sum();
        let per_weight = force / (sum * raster.cell * raster.cell);
        let push = |(cell, weight)| Push { cell, force: per_weight * weight, ..default() };
        // What is beyond all bounds would be refused with everything else.
        self.forces.extend(weighted().map(push).filter(|push| push.force.abs().max_element() < 1e6));
    }
}

#[cfg(test)]
impl Simulated {
    /// Volume times velocity of all water, m⁴/s.
    pub fn momentum(&self) -> bevy::math::DVec2 {
        let Some(simulation) = self.simulation.as_deref() else { return bevy::math::DVec2::ZERO };
        let area = f64::from(simulation.water.cell_size()).powi(2);
        let discharges = simulation.water.conserved().map(|[_, x, z, _]| bevy::math::dvec2(x.into(), z.into()));
        area * discharges.sum::<bevy::math::DVec2>()
    }
}
