//! What floating bodies take from a simulated water and give back to it.
use super::driver::Simulated;
use crate::{body::ResolvedWater, simulation::Raster};
use bevy::prelude::*;
use freshet_hydro::shallow_water::{Displaced, Displacement, Push};
use std::{collections::BTreeMap, sync::Arc};

/// The room that floating bodies take up in a simulated water, as of the last fixed step.
#[derive(Default)]
pub(crate) struct Exchange {
    pub displacement: Displacement,
    /// What they displaced before, m, by index of the cell.
    before: BTreeMap<usize, f32>,
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
        before.extend(simulation.water.raised().map(|(index, [ground, bed])| (index, bed - ground)));
        _ = simulation.water.set_displaced(&[]);
        true
    }

    /// How far the ground in a cell lies below the `level` at its middle (local xz, m), if there is such a cell and it does.
    pub fn room(&self, cell: IVec2, level: impl Fn(Vec2) -> f32) -> Option<f32> {
        let (Raster { origin, cell: side, size }, simulation) = (self.raster()?, self.simulation.as_deref()?);
        let is_inside = cell.cmpge(IVec2::ZERO).all() && cell.cmplt(size.as_ivec2()).all();
        let ground = |cell: UVec2| simulation.water.bed()[(cell.y * size.x + cell.x) as usize];
        let room = is_inside.then(|| level(origin + (cell.as_vec2() + 0.5) * side) - ground(cell.as_uvec2()))?;
        (room > 0.0).then_some(room)
    }

    /// Puts all bodies in: levels rise where they have come, and fall where they have gone, before the water answers.
    pub fn put_bodies_in(&mut self, resolved: &mut ResolvedWater) {
        let Some(simulation) = self.simulation.as_deref_mut() else { return };
        let Exchange { displacement, before, .. } = &mut self.exchange;
        if simulation.water.set_displaced(displacement.cells()).is_err() {
            // Cells of a simulation that has since got another size.
            displacement.clear();
        }
        let mut changes = std::mem::take(before);
        changes.values_mut().for_each(|by| *by = -*by);
        for (index, [ground, bed]) in simulation.water.raised() {
            *changes.entry(index).or_default() += bed - ground;
        }
        let changes: Vec<_> = changes.into_iter().filter(|(_, by)| *by != 0.0).collect();
        if !changes.is_empty() {
            Arc::make_mut(&mut simulation.field).raise(&changes);
            if let Some(simulated) = &mut resolved.simulated {
                simulated.field = simulation.field.clone();
            }
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
        let (size, cell) = (simulation.water.size(), simulation.water.cell_size());
        let depths = simulation.water.depths();
        let weighted = || {
            columns.iter().filter(|(at, _)| at.cmplt(size).all()).map(|&(at, depth)| {
                let index = at.y as usize * size.x as usize + at.x as usize;
                (at, depth * depths[index])
            })
        };
        let sum: f32 = weighted().map(|(_, weight)| weight).sum();
        let per_weight = force / (sum * cell * cell);
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
