//! Simulated water as others see it, and where it passes into the water around it.
use bevy::prelude::*;
use freshet_flood::playback::Moment;
use freshet_hydro::shallow_water::{Field, FieldSample, WaterCells};
use std::sync::Arc;

/// The simulated water of a [`ResolvedWater`](super::ResolvedWater).
#[derive(Clone, Debug)]
pub(crate) struct ResolvedSimulation {
    pub water: SimulatedWater,
    /// How old it is, s.
    pub age: f32,
    pub area: SimulatedArea,
}

/// Where simulated water is looked up.
#[derive(Clone, Debug)]
pub(crate) enum SimulatedWater {
    /// What a simulation has come to.
    Field(Arc<Field>),
    /// A moment of a flood.
    Moment(Arc<Moment>),
}

/// The rectangle of a water that is simulated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SimulatedArea {
    /// Its middle, local xz, m.
    pub center: Vec2,
    /// Half of its sides, m.
    pub half_size: Vec2,
    /// One over the width (m) of the strip within its western, eastern, northern and southern side along which it passes into the
    /// water outside; 0 at the water's own sides, where nothing is outside.
    pub per_blend: Vec4,
}

/// Narrowest strip, m.
const NARROWEST: f32 = 1e-3;

impl SimulatedArea {
    /// All of a water of `half_size` (m).
    pub fn all(half_size: Vec2) -> Self {
        Self { center: Vec2::ZERO, half_size, per_blend: Vec4::ZERO }
    }

    /// The part `wanted` of a water of `half_size`, blended over `blend` (m); nothing if they do not meet.
    pub fn part(wanted: Rect, half_size: Vec2, blend: f32) -> Option<Self> {
        let found = wanted.intersect(Rect::from_center_half_size(Vec2::ZERO, half_size));
        if found.is_empty() || !(found.min.is_finite() && found.max.is_finite()) {
            return None;
        }
        // Sides that come within a thousandth of the water's are its own.
        let slack = 1e-3 * half_size.min_element();
        let beyond = vec4(found.min.x, -found.max.x, found.min.y, -found.max.y) + half_size.xxyy();
        let is_inner = beyond.cmpgt(Vec4::splat(slack));
        let per_blend = Vec4::select(is_inner, Vec4::splat(blend.max(NARROWEST).recip()), Vec4::ZERO);
        Some(Self { center: found.center(), half_size: found.half_size(), per_blend })
    }

    /// Whether other water is around it.
    pub fn is_part(&self) -> bool {
        self.per_blend != Vec4::ZERO
    }

    /// Share of the simulated water at local `place`: 0 from the rim on outwards, 1 within the strip. `ground.wgsl` has it too.
    pub fn share(&self, place: Vec2) -> f32 {
        let offset = place - self.center;
        let inside = self.half_size.xxyy() + vec4(offset.x, -offset.x, offset.y, -offset.y);
        let t = Vec4::select(self.per_blend.cmpgt(Vec4::ZERO), inside * self.per_blend, Vec4::ONE);
        let t = t.min_element().clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }
}

impl SimulatedWater {
    /// Columns and rows.
    pub fn size(&self) -> UVec2 {
        match self {
            Self::Field(field) => field.size(),
            Self::Moment(moment) => moment.size(),
        }
    }

    /// Side of a cell, m.
    pub fn cell_size(&self) -> f32 {
        match self {
            Self::Field(field) => field.cell_size(),
            Self::Moment(moment) => moment.cell_size(),
        }
    }

    /// The lowest and the highest level, m.
    pub fn levels(&self) -> (f32, f32) {
        match self {
            Self::Field(field) => field.levels(),
            Self::Moment(moment) => moment.levels(),
        }
    }

    /// The steepest slope of the level.
    pub fn steepest(&self) -> f32 {
        match self {
            Self::Field(field) => field.steepest(),
            Self::Moment(moment) => moment.steepest(),
        }
    }

    /// The greatest speed, m/s.
    pub fn fastest(&self) -> f32 {
        match self {
            Self::Field(field) => field.fastest(),
            Self::Moment(moment) => moment.fastest(),
        }
    }

    /// Whether a wall stands above it somewhere.
    pub fn has_walls(&self) -> bool {
        matches!(self, Self::Field(field) if !field.walls().is_empty())
    }

    fn sample(&self, place: Vec2, age: f32) -> Option<FieldSample> {
        match self {
            Self::Field(field) => field.sample(place, age),
            Self::Moment(moment) => moment.sample(place, age),
        }
    }
}

impl ResolvedSimulation {
    /// The simulated water at local `place`; nothing where it is dry.
    pub fn sample(&self, place: Vec2) -> Option<FieldSample> {
        self.water.sample(place - self.area.center, self.age)
    }

    /// Lowest and highest level, m, with the still water around it.
    pub fn levels(&self) -> (f32, f32) {
        let (lowest, highest) = self.water.levels();
        if self.area.is_part() { (lowest.min(0.0), highest.max(0.0)) } else { (lowest, highest) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_of_a_water_blends_nowhere() {
        let all = SimulatedArea::all(vec2(10.0, 5.0));
        assert!(!all.is_part() && all.share(vec2(10.0, -5.0)) == 1.0);
        let whole =
            SimulatedArea::part(Rect::from_center_half_size(Vec2::ZERO, Vec2::splat(99.0)), vec2(10.0, 5.0), 2.0);
        assert_eq!(whole, Some(all));
    }

    #[test]
    fn a_part_blends_at_its_inner_sides_only() {
        // Its western side is the water's own.
        let part = SimulatedArea::part(Rect::new(-20.0, -3.0, 4.0, 3.0), vec2(10.0, 5.0), 2.0).expect("they meet");
        assert_eq!((part.center, part.half_size), (vec2(-3.0, 0.0), vec2(7.0, 3.0)));
        assert_eq!(part.per_blend, vec4(0.0, 0.5, 0.5, 0.5));
        assert_eq!(part.share(vec2(-10.0, 0.0)), 1.0);
        assert_eq!([4.0, 3.0, 2.0].map(|x| part.share(vec2(x, 0.0))), [0.0, 0.5, 1.0]);
        assert_eq!([5.0, 30.0].map(|x| part.share(vec2(x, 0.0))), [0.0; 2]);
        assert_eq!(SimulatedArea::part(Rect::new(11.0, 0.0, 12.0, 1.0), vec2(10.0, 5.0), 2.0), None);
    }
}
