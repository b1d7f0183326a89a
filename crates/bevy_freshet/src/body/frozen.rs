//! A water's ice with its settings checked, and the map of where it comes first.
use super::{ResolvedWater, WaterIce, resolved::ResolvedBed};
use crate::report::Reported;
use bevy::prelude::*;
use freshet_hydro::{
    grid::Grid,
    ice::{self, Freezing, Site, Winter},
};
use std::sync::Arc;

/// The ice of a water: what surface and query read of it.
#[derive(Clone, Debug)]
pub(crate) struct ResolvedIce {
    /// Which part (0…1) of the water freezes before each place, on a grid centred on the water.
    pub order: Arc<Grid<f32>>,
    /// The winter and its time.
    pub winter: Winter,
    /// See [`WaterIce::level_drop`].
    pub level_drop: f32,
}

impl ResolvedIce {
    /// Thickness at local `place`, m.
    pub fn thickness(&self, place: Vec2) -> f32 {
        self.winter.thickness(self.order.sample(place))
    }

    /// Whether ice covers the whole water.
    pub fn is_closed(&self) -> bool {
        freshet_hydro::ice::cover(self.winter.thickness(1.0)) >= 1.0
    }

    /// The most that the surface can sink, m.
    pub fn deepest_drop(&self) -> f32 {
        self.level_drop * self.winter.thickness(0.0)
    }
}

/// The order in which a water freezes, kept until what it was computed from changes.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct IceMap {
    known: Option<(Causes, Arc<Grid<f32>>)>,
}

/// What the order of freezing depends on.
#[derive(Clone, Debug)]
struct Causes {
    half_size: Vec2,
    level: f32,
    flat_ground: Option<f32>,
    bed: Option<ResolvedBed>,
    drift: Vec2,
    flow: Option<(Arc<Grid<Vec2>>, f32)>,
    freezing: Freezing,
}

/// Most cells of a map: computing that many takes a few hundredths of a second.
const MOST_CELLS: f32 = 384.0 * 384.0;
/// Change of the level that is worth a new map, m.
const LEVEL_STEP: f32 = 0.1;

impl Causes {
    fn new(water: &ResolvedWater, freezing: Freezing) -> Self {
        let &ResolvedWater { half_size, level, drift, ref bed, ref flow, .. } = water;
        let flat_ground = water.flat_ground;
        Self { half_size, level, flat_ground, bed: bed.clone(), drift, flow: flow.clone(), freezing }
    }

    /// Whether a map made from `self` still serves for `other`.
    fn serves(&self, other: &Self) -> bool {
        let same_bed = match (&self.bed, &other.bed) {
            (Some(a), Some(b)) => {
                let moved = a.bed_from_local.translation.distance(b.bed_from_local.translation);
                Arc::ptr_eq(&a.elevations, &b.elevations)
                    && moved < 0.5 * a.elevations.cell_size()
                    && a.bed_from_local.matrix2.abs_diff_eq(b.bed_from_local.matrix2, 1e-3)
                    && ((self.level - a.base) - (other.level - b.base)).abs() < LEVEL_STEP
            }
            (a, b) => a.is_none() && b.is_none(),
        };
        let same_flow = match (&self.flow, &other.flow) {
            (Some((a, scale)), Some((b, other_scale))) => Arc::ptr_eq(a, b) && scale == other_scale,
            (a, b) => a.is_none() && b.is_none(),
        };
        let same_rest = self.flat_ground == other.flat_ground
            && self.half_size == other.half_size
            && self.drift == other.drift
            && self.freezing == other.freezing;
        same_bed && same_flow && same_rest
    }
}

impl IceMap {
    /// The order of freezing of `water`; `None` for a water of no size.
    fn of(&mut self, water: &ResolvedWater, freezing: Freezing) -> Option<Arc<Grid<f32>>> {
        if water.half_size == Vec2::ZERO {
            return None;
        }
        let causes = Causes::new(water, freezing);
        if let Some((known, map)) = &self.known
            && known.serves(&causes)
        {
            return Some(map.clone());
        }
        let map = Arc::new(map_of(water, &freezing)?);
        self.known = Some((causes, map.clone()));
        Some(map)
    }
}

fn map_of(water: &ResolvedWater, freezing: &Freezing) -> Option<Grid<f32>> {
    let extent = water.half_size * 2.0;
    // As fine as the bed tells, or as the unevenness of the front needs.
    let finest = water.bed.as_ref().map_or(0.25 * freezing.unevenness_size, |bed| bed.elevations.cell_size());
    let cell = finest.max((extent.x * extent.y / MOST_CELLS).sqrt()).max(extent.max_element() / 2048.0);
    let size = (extent / cell).ceil().max(Vec2::ONE).as_uvec2();
    // What freezes is chosen by the still water, also where it is simulated.
    let still_current = |place| water.drift + water.mapped_current(place);
    let site = |place| Site { depth: water.ground_depth(place), speed: still_current(place).length() };
    ice::order_map(size, cell, freezing, site).ok()
}

/// The ice of `water` as `settings` describe it; `None` where nothing freezes.
pub(super) fn resolve(
    entity: Entity,
    settings: &WaterIce,
    map: &mut IceMap,
    water: &ResolvedWater,
    reported: &mut Reported,
) -> Option<ResolvedIce> {
    let usable = WaterIce::default();
    let mut clamp = |field, value, range, fallback| reported.clamp(entity, field, value, range, fallback);
    let winter = Winter {
        freezing: clamp("WaterIce::freezing", settings.freezing, 0.0..=1.0, 0.0),
        thickest: clamp("WaterIce::thickness", settings.thickness, WaterIce::THICKNESSES, usable.thickness),
    };
    let level_drop = clamp("WaterIce::level_drop", settings.level_drop, 0.0..=1.0, usable.level_drop);
    let bank_reach = clamp("WaterIce::bank_reach", settings.bank_reach, 0.1..=1e3, usable.bank_reach);
    let flow_limit = clamp("WaterIce::flow_limit", settings.flow_limit, 0.01..=100.0, usable.flow_limit);
    if winter.freezing <= 0.0 {
        return None;
    }
    let order = map.of(water, Freezing { bank_reach, flow_limit, unevenness_size: 1.5 * bank_reach })?;
    Some(ResolvedIce { order, winter, level_drop })
}
