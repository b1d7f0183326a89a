//! A water with its settings checked and its waves at one instant: what surface, query and bodies read.
use super::{
    ResolvedSimulation, Water, WaterBed, WaterFlow, WaterIce, WaterWaves,
    frozen::{self, IceMap, ResolvedIce},
};
use crate::{report::Reported, simulation::Simulated};
use bevy::{math::Affine2, prelude::*};
use freshet_hydro::{
    grid::Grid,
    ice,
    shallow_water::FieldSample,
    waves::{self, Particle, WaveField},
};
use std::sync::Arc;

/// A water at one instant of the running schedule's clock.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct ResolvedWater {
    /// World xz from the water's local xz.
    pub world_from_local: Affine2,
    /// The water's local xz from world xz.
    pub local_from_world: Affine2,
    /// World height of the still surface, m.
    pub level: f32,
    /// Half of the size along local x and z, m; zero for a water that is unusable.
    pub half_size: Vec2,
    /// The waves, in local xz.
    pub waves: WaveField,
    /// See [`WaterWaves::fade_depth`].
    pub fade_depth: f32,
    /// The ground below, if any.
    pub bed: Option<ResolvedBed>,
    /// Uniform part of the current in local xz, m/s.
    pub drift: Vec2,
    /// Map of the current in local xz with its factor.
    pub flow: Option<(Arc<Grid<Vec2>>, f32)>,
    /// The ice, if there is any.
    pub ice: Option<ResolvedIce>,
    /// How far the ground that simulation takes where there is no bed lies below the still level, m.
    pub flat_ground: Option<f32>,
    /// The simulated water, if it is simulated.
    pub simulated: Option<ResolvedSimulation>,
}

/// How far under the ground the surface of a simulated water is put where it is dry, m.
const DRY: f32 = 0.5;

/// A bed as a water sees it.
#[derive(Clone, Debug)]
pub(crate) struct ResolvedBed {
    /// The entity with the [`WaterBed`].
    pub entity: Entity,
    /// Elevations relative to [`ResolvedBed::base`], m.
    pub elevations: Arc<Grid<f32>>,
    /// The bed's local xz from the water's local xz.
    pub bed_from_local: Affine2,
    /// World height of the bed entity, m.
    pub base: f32,
    /// Bound of the slope of its ground; infinite if data is missing.
    pub steepest: f32,
}

impl ResolvedWater {
    /// A direction of the water's frame in the world.
    pub fn direction_to_world(&self, direction: Vec3) -> Vec3 {
        let turned = self.world_from_local.transform_vector2(direction.xz());
        vec3(turned.x, direction.y, turned.y)
    }

    /// Whether local `place` lies in the water's rectangle.
    pub fn covers(&self, place: Vec2) -> bool {
        place.abs().cmple(self.half_size).all() && self.half_size.min_element() > 0.0
    }

    /// Depth at local `place` without waves, m: negative on dry land, infinite without a bed. Where the bed has no data there
    /// is no water: minus infinity.
    pub fn still_depth(&self, place: Vec2) -> f32 {
        self.ground_depth(place) + self.risen(place)
    }

    /// How far the ground at local `place` lies below the still level, m: infinite without a bed where it is not simulated, minus
    /// infinity where a bed has no data.
    pub fn ground_depth(&self, place: Vec2) -> f32 {
        let Some(bed) = &self.bed else {
            let is_simulated = |_: &f32| self.simulated.as_ref().is_some_and(|it| it.area.share(place) > 0.0);
            return self.flat_ground.filter(is_simulated).unwrap_or(f32::INFINITY);
        };
        let elevation = bed.elevations.sample(bed.bed_from_local.transform_point2(place));
        if elevation.is_nan() { f32::NEG_INFINITY } else { self.level - (bed.base + elevation) }
    }

    /// The simulated water at local `place`, blended into the water outside its area; nothing if it is not simulated or dry.
    ///
    /// `at` in `water.wgsl` is its twin.
    pub fn simulated_at(&self, place: Vec2) -> Option<FieldSample> {
        let simulated = self.simulated.as_ref()?;
        let share = simulated.area.share(place);
        if share >= 1.0 {
            return simulated.sample(place);
        }
        let within = || simulated.sample(place).unwrap_or(FieldSample { level: self.under_ground(place), ..default() });
        let water = if share > 0.0 { within() } else { FieldSample::default() };
        Some(FieldSample {
            level: share * water.level,
            slope: share * water.slope,
            velocity: self.mapped_current(place).lerp(water.velocity, share),
            rising: share * water.rising,
        })
    }

    /// Where the surface of simulated water is put at local `place` if it is dry, m over the still level.
    fn under_ground(&self, place: Vec2) -> f32 {
        -self.ground_depth(place).clamp(-1e5, 1e5) - DRY
    }

    /// How far simulation has raised the surface at local `place` over the still level, m: under the ground where it is dry.
    pub fn risen(&self, place: Vec2) -> f32 {
        if self.simulated.is_none() {
            return 0.0;
        }
        self.simulated_at(place).map_or_else(|| self.under_ground(place), |water| water.level)
    }

    /// Share of the waves' height at local `place`.
    pub fn fade(&self, place: Vec2) -> f32 {
        waves::shallow_fade(self.still_depth(place), self.fade_depth) * self.open(place)
    }

    /// Thickness of the ice at local `place`, m.
    pub fn ice_thickness(&self, place: Vec2) -> f32 {
        self.ice.as_ref().map_or(0.0, |ice| ice.thickness(place))
    }

    /// Share of the surface at local `place` that no ice covers.
    pub fn open(&self, place: Vec2) -> f32 {
        1.0 - ice::cover(self.ice_thickness(place))
    }

    /// How far the surface at local `place` lies below the still water's, as the ice has lowered it, m.
    pub fn drop(&self, place: Vec2) -> f32 {
        self.ice.as_ref().map_or(0.0, |ice| ice.level_drop * ice.thickness(place))
    }

    /// The particles of the waves above up to [`WaveField::AT_ONCE`] local `places`, as if there were water everywhere. More places cost
    /// hardly more than one.
    pub fn particles(&self, places: &[Vec2]) -> [Particle; WaveField::AT_ONCE] {
        self.particles_of(&self.waves, places)
    }

    /// The same, of some of its `waves` only.
    pub fn particles_of(&self, waves: &WaveField, places: &[Vec2]) -> [Particle; WaveField::AT_ONCE] {
        waves.particles_above(places, |rest| self.fade(rest))
    }

    /// Height of the surface over the still water's where `particle` is, m: waves on what is simulated, lowered by ice.
    pub fn elevation(&self, particle: &Particle) -> f32 {
        particle.displacement.y - self.drop(particle.rest) + self.risen(particle.rest)
    }

    /// Height of the surface at local `place` over the still water's, m, as if there were water everywhere.
    pub fn surface(&self, place: Vec2) -> f32 {
        self.elevation(&self.particles(&[place])[0])
    }

    /// Bounds of the height of the surface over the still water's, m: the lowest it can be, and the highest.
    pub fn elevations(&self) -> (f32, f32) {
        let amplitude = self.waves.total_amplitude();
        let (lowest, highest) = self.simulated.as_ref().map_or((0.0, 0.0), ResolvedSimulation::levels);
        (lowest - amplitude - self.ice.as_ref().map_or(0.0, ResolvedIce::deepest_drop), highest + amplitude)
    }

    /// The middle of the still surface, turned as the water.
    pub fn pose(&self) -> Transform {
        let (_, angle, center) = self.world_from_local.to_scale_angle_translation();
        Transform::from_xyz(center.x, self.level, center.y).with_rotation(Quat::from_rotation_y(-angle))
    }

    /// Current at the surface at local `place`, local xz, m/s: none under closed ice.
    pub fn current(&self, place: Vec2) -> Vec2 {
        self.open_current(place) * self.open(place)
    }

    /// Current at local `place` as it is without ice, local xz, m/s.
    pub fn open_current(&self, place: Vec2) -> Vec2 {
        if self.simulated.is_some() {
            return self.drift + self.simulated_at(place).map_or(Vec2::ZERO, |water| water.velocity);
        }
        self.drift + self.mapped_current(place)
    }

    /// Current of the flow map at local `place`, local xz, m/s: less over the last decimetre of still water.
    pub fn mapped_current(&self, place: Vec2) -> Vec2 {
        let Some((map, scale)) = &self.flow else { return Vec2::ZERO };
        let share = waves::shallow_fade(self.ground_depth(place), WaterFlow::BANK_DEPTH);
        let mapped = map.sample(place);
        // A map may have gaps.
        if mapped.is_finite() { mapped * (*scale * share) } else { Vec2::ZERO }
    }
}

/// Translation in xz and rotation about y of `pose`; scale and tilt are dropped.
pub(crate) fn yaw_frame(pose: &GlobalTransform) -> Affine2 {
    let (yaw, _, _) = pose.rotation().to_euler(EulerRot::YXZ);
    // A turn by +yaw about y takes x towards −z, which in (x, z) is a turn by −yaw.
    Affine2::from_angle_translation(-yaw, pose.translation().xz())
}

/// Checks every water's settings and evaluates them for the clock of the running schedule.
pub(crate) fn resolve_waters(
    time: Res<Time>,
    mut reported: ResMut<Reported>,
    beds: Query<(Entity, &WaterBed, &GlobalTransform)>,
    mut waters: Query<(
        Entity,
        &Water,
        &WaterWaves,
        Option<&WaterFlow>,
        &GlobalTransform,
        &mut ResolvedWater,
        Option<(&WaterIce, &mut IceMap)>,
        Option<&Simulated>,
    )>,
) {
    for (entity, water, waves, flow, pose, mut resolved, ice, simulated) in &mut waters {
        let world_from_local = yaw_frame(pose);
        let mut next = ResolvedWater {
            world_from_local,
            local_from_world: world_from_local.inverse(),
            level: pose.translation().y,
            half_size: usable_half_size(entity, water, pose, &mut reported),
            waves: usable_waves(entity, waves, time.elapsed_secs_f64(), &mut reported),
            fade_depth: reported.clamp(entity, "WaterWaves::fade_depth", waves.fade_depth, 0.0..=1e4, 0.8),
            ..default()
        };
        if let Some(flow) = flow {
            next.drift = usable_drift(entity, flow, &mut reported);
            let scale = reported.clamp(entity, "WaterFlow::scale", flow.scale, -1e3..=1e3, 1.0);
            next.flow = flow.map.clone().map(|map| (map, scale));
        }
        next.bed = bed_below(&next, &beds);
        next.simulated = simulated.and_then(Simulated::resolve);
        next.flat_ground = simulated.and_then(Simulated::flat_ground);
        if let Some((ice, mut map)) = ice {
            next.ice = frozen::resolve(entity, ice, &mut map, &next, &mut reported);
        }
        report_uncovered(entity, &next, &beds, &mut reported);
        *resolved = next;
    }
}

fn usable_half_size(entity: Entity, water: &Water, pose: &GlobalTransform, reported: &mut Reported) -> Vec2 {
    if !pose.affine().is_finite() {
        reported.warn(entity, "Transform", "is not finite; the water is switched off");
        return Vec2::ZERO;
    }
    if pose.up().y < 0.999 {
        reported.warn(entity, "Transform::rotation", "tilts the water; only the turn about y is used");
    }
    let usable = water.size.is_finite() && water.size.min_element() > 0.0;
    if usable && water.size.max_element() > Water::MAX_SIZE {
        reported.warn(entity, "Water::size", format_args!("is {}; {} m is used", water.size, Water::MAX_SIZE));
    }
    if usable {
        return water.size.min(Vec2::splat(Water::MAX_SIZE)) * 0.5;
    }
    reported.warn(entity, "Water::size", format_args!("is {}, not above zero; the water is switched off", water.size));
    Vec2::ZERO
}

fn usable_drift(entity: Entity, flow: &WaterFlow, reported: &mut Reported) -> Vec2 {
    if flow.uniform.is_finite() {
        return flow.uniform;
    }
    reported.warn(entity, "WaterFlow::uniform", format_args!("is {}; no current is used", flow.uniform));
    Vec2::ZERO
}

fn usable_waves(entity: Entity, settings: &WaterWaves, time: f64, reported: &mut Reported) -> WaveField {
    let depth = if settings.depth > 0.0 {
        settings.depth
    } else {
        reported.warn(entity, "WaterWaves::depth", format_args!("is {}; deep water is used", settings.depth));
        f32::INFINITY
    };
    if settings.trains.len() > WaterWaves::MAX {
        let (given, most) = (settings.trains.len(), WaterWaves::MAX);
        reported.warn(entity, "WaterWaves::trains", format_args!("has {given} trains; the first {most} are used"));
    }
    let mut usable: Vec<waves::Wave> = Vec::with_capacity(settings.trains.len().min(WaterWaves::MAX));
    for train in settings.trains.iter().take(WaterWaves::MAX) {
        let numbers = [train.direction.x, train.direction.y, train.wavelength, train.steepness, train.phase];
        if !numbers.iter().all(|n| n.is_finite()) || train.wavelength < 1e-3 || train.steepness < 0.0 {
            reported.warn(entity, "WaterWaves::trains", format_args!("holds {train:?}; that train is left out"));
            continue;
        }
        let &super::Wave { direction, wavelength, steepness, phase } = train;
        usable.push(waves::Wave { direction, wavelength, steepness, phase });
    }
    let steepness: f32 = usable.iter().map(|wave| wave.steepness).sum();
    if steepness > 0.95 {
        reported.warn(
            entity,
            "WaterWaves::trains",
            format_args!("have steepnesses that sum to {steepness}, more than 0.95; they are scaled down"),
        );
        usable.iter_mut().for_each(|wave| wave.steepness *= 0.95 / steepness);
    }
    WaveField::at(&usable, depth, time)
}

/// The bed whose grid holds the water's centre; the highest one if several do, of those that are below the water there, so that a lake under
/// a pond has not the pond's bed.
fn bed_below(water: &ResolvedWater, beds: &Query<(Entity, &WaterBed, &GlobalTransform)>) -> Option<ResolvedBed> {
    beds.iter()
        .filter_map(|(entity, bed, pose)| {
            let bed_from_local = yaw_frame(pose).inverse() * water.world_from_local;
            let center = bed_from_local.transform_point2(Vec2::ZERO);
            bed.elevations().cell_at(center)?;
            let (elevations, base) = (bed.elevations().clone(), pose.translation().y);
            let is_below = base + elevations.sample(center) < water.level;
            Some((is_below, ResolvedBed { entity, elevations, bed_from_local, base, steepest: bed.steepest() }))
        })
        .max_by(|(a_below, a), (b_below, b)| {
            a_below.cmp(b_below).then(a.base.total_cmp(&b.base)).then(a.entity.cmp(&b.entity))
        })
        .map(|(_, bed)| bed)
}

/// Warns if a corner of the water lies outside its bed, where the nearest edge of the bed counts, or if the water meets a
/// bed that is none of its own.
fn report_uncovered(
    entity: Entity,
    water: &ResolvedWater,
    beds: &Query<(Entity, &WaterBed, &GlobalTransform)>,
    reported: &mut Reported,
) {
    const CORNERS: [Vec2; 4] = [vec2(1.0, 1.0), vec2(1.0, -1.0), vec2(-1.0, 1.0), vec2(-1.0, -1.0)];
    // One centimetre of grace for a water that is exactly as large as its bed, or ends where a bed begins.
    let shrunk = |half: Vec2| (half - 0.01).max(Vec2::ZERO);
    let in_grid = |corner: Vec2, bed_from_local: Affine2, grid: &Grid<f32>| {
        grid.cell_at(bed_from_local.transform_point2(corner * shrunk(water.half_size))).is_some()
    };
    if water.half_size == Vec2::ZERO {
        return;
    }
    if let Some(ResolvedBed { entity: bed, elevations, bed_from_local, .. }) = &water.bed {
        if !CORNERS.iter().all(|&corner| in_grid(corner, *bed_from_local, elevations)) {
            let problem = format_args!("reaches beyond its bed {bed}; the bed's edge is continued there");
            reported.warn(entity, "Water::size", problem);
        }
        return;
    }
    for (bed, elevations, pose) in beds {
        let grid = elevations.elevations();
        let bed_from_local = yaw_frame(pose).inverse() * water.world_from_local;
        let local_from_bed = bed_from_local.inverse();
        let half = shrunk(grid.size().as_vec2() * grid.cell_size() * 0.5);
        let in_water = |corner: Vec2| water.covers(local_from_bed.transform_point2(corner * half));
        if in_water(Vec2::ZERO) || CORNERS.iter().any(|&c| in_water(c) || in_grid(c, bed_from_local, grid)) {
            let problem = format_args!("reaches over bed {bed}, which does not hold its centre; it has no bed");
            reported.warn(entity, "Water::size", problem);
        }
    }
}
