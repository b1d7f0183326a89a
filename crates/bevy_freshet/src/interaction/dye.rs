//! Bodies that leak dye.
use super::{
    body::{BodyMotion, DisturbsWater},
    disturb::deposit,
};
use crate::{
    body::ResolvedWater,
    query::WaterQuery,
    report::Reported,
    simulation::{Deposits, FieldProgress, FieldWindow, Stroke},
};
use bevy::prelude::*;

/// Leaks dye into the water: from its origin while that is under water, else from the middle of its section with the
/// surface ([`DisturbsWater`]). High and dry it leaks nothing.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[require(DisturbsWater)]
pub struct DyesWater {
    /// Absorption of the liquid, 1/m per channel, 0…10⁵. Default: a red that lets 1 % of green and blue through a
    /// millimetre. [`absorption_from_color`] gives it for a colour.
    pub absorption: Vec3,
    /// Liquid that leaks, m³/s, 0…1000. Default 10⁻⁴: a tenth of a litre. The level of the water stays.
    pub rate: f32,
    /// Radius (standard deviation) of the leak, m, 0.001…1000. Default 0.2.
    pub radius: f32,
}

impl DyesWater {
    /// Liquid through a millimetre of which white light gets `color`.
    pub fn of_color(color: impl Into<Color>) -> Self {
        Self { absorption: absorption_from_color(color, 1e-3), ..default() }
    }
}

impl Default for DyesWater {
    fn default() -> Self {
        Self { absorption: vec3(50.0, 4605.0, 4605.0), rate: 1e-4, radius: 0.2 }
    }
}

/// Absorption (1/m per channel) of a liquid that white light leaves in `color` after `distance` (m, > 0).
///
/// `a = −ln c / distance` (Beer 1852) for linear channels c, of which a thousandth is the darkest that counts. Distances
/// that are not above zero count as a micrometre.
pub fn absorption_from_color(color: impl Into<Color>, distance: f32) -> Vec3 {
    let color = LinearRgba::from(color.into());
    let channel = |c: f32| -ops::ln(if c.is_nan() { 1.0 } else { c.clamp(1e-3, 1.0) });
    Vec3::from(color.to_f32_array_no_alpha().map(channel)) / distance.max(1e-6)
}

/// Leaks for as long as the frame was.
pub(super) fn leak(
    time: Res<Time>,
    sources: Query<(Entity, &DyesWater, &GlobalTransform, &BodyMotion, Has<DisturbsWater>)>,
    query: WaterQuery,
    mut waters: Query<(&ResolvedWater, &FieldWindow, &FieldProgress, &mut Deposits)>,
    mut reported: ResMut<Reported>,
) {
    for (entity, source, pose, motion, is_cut) in &sources {
        // Without silhouettes there is no section, but for an old one.
        let section = motion.section.filter(|_| is_cut);
        let origin = pose.translation();
        let around = origin.is_finite().then(|| query.sample(origin)).flatten();
        let drowned = around.filter(|around| around.height >= origin.y).map(|around| around.water);
        let Some(water) = drowned.or(section.map(|(water, _)| water)) else { continue };
        let Ok((resolved, window, progress, mut deposits)) = waters.get_mut(water) else { continue };
        if !progress.runs() {
            continue;
        }
        let place = match (drowned, section) {
            (None, Some((_, centroid))) => centroid,
            _ => resolved.local_from_world.transform_point2(origin.xz()),
        };
        let usual = DyesWater::default();
        let absorption =
            reported.clamp3(entity, "DyesWater::absorption", source.absorption, 0.0..=1e5, usual.absorption);
        let rate = reported.clamp(entity, "DyesWater::rate", source.rate, 0.0..=1e3, usual.rate);
        let radius = reported.clamp(entity, "DyesWater::radius", source.radius, 1e-3..=1e3, usual.radius);
        let dye = absorption * (rate * time.delta_secs());
        if dye != Vec3::ZERO {
            deposit(window, &mut deposits, Stroke { place, radius, volume: 0.0, foam: 0.0, dye });
        }
    }
}
