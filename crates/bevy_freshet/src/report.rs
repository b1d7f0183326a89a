//! Complaints about unusable settings: each is said once, with the entity and the field.
use bevy::{ecs::entity::EntityHashMap, prelude::*};
use std::fmt::Display;

/// What has been complained about, so that it is said once and not every frame.
#[derive(Resource, Default)]
pub(crate) struct Reported(EntityHashMap<Vec<&'static str>>);

impl Reported {
    /// Warns that `field` of `entity` is unusable and what happens instead; only the first time for that field.
    pub(crate) fn warn(&mut self, entity: Entity, field: &'static str, problem: impl Display) {
        let fields = self.0.entry(entity).or_default();
        if !fields.contains(&field) {
            fields.push(field);
            warn!("{entity}: {field} {problem}");
        }
    }

    /// `value` if it is finite and within `range`, else the nearest bound (`fallback` for NaN) and a warning.
    pub(crate) fn clamp(
        &mut self,
        entity: Entity,
        field: &'static str,
        value: f32,
        range: core::ops::RangeInclusive<f32>,
        fallback: f32,
    ) -> f32 {
        if range.contains(&value) {
            return value;
        }
        let used = nearest(value, &range, fallback);
        self.warn(entity, field, format_args!("is {value}, outside {}…{}; {used} is used", range.start(), range.end()));
        used
    }

    /// [`Reported::clamp`] for every channel of a colour-like vector.
    pub(crate) fn clamp3(
        &mut self,
        entity: Entity,
        field: &'static str,
        value: Vec3,
        range: core::ops::RangeInclusive<f32>,
        fallback: Vec3,
    ) -> Vec3 {
        Vec3::from_array(core::array::from_fn(|i| self.clamp(entity, field, value[i], range.clone(), fallback[i])))
    }
}

/// `value`, or the bound of `range` that is nearest to it; `fallback` for NaN.
pub(crate) fn nearest(value: f32, range: &core::ops::RangeInclusive<f32>, fallback: f32) -> f32 {
    if value.is_nan() { fallback } else { value.clamp(*range.start(), *range.end()) }
}

/// Forgets complaints about entities that are gone, so that a reused identifier is heard again.
pub(crate) fn forget_despawned(mut reported: ResMut<Reported>, entities: Query<()>) {
    reported.0.retain(|entity, _| entities.contains(*entity));
}
