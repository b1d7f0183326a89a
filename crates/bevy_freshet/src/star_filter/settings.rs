//! The component [`StarFilter`].
use crate::report::Reported;
use bevy::{
    camera::Hdr,
    prelude::*,
    render::{extract_component::ExtractComponent, sync_component::SyncComponent},
};
use core::{f32::consts::PI, ops::RangeInclusive};

/// Draws a star around whatever is much brighter than white: put it on a camera with `Camera3d` and [`Hdr`].
///
/// Brightness is what the camera draws, after its exposure and before tone mapping, where 1 is the white of a page in the light
/// that the exposure is made for. The settings therefore serve at noon and at night.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct StarFilter {
    /// Light of a star, as a share of the light above the threshold that it comes from, 0…10. Default 0.5; 0 draws none.
    pub intensity: f32,
    /// Brightness from which on light makes a star, 0…10 000. Default 6.
    pub threshold: f32,
    /// Brightness beyond which a pixel makes no brighter star, 0…10 000. Default 200: it keeps the sun itself from filling
    /// the picture.
    pub limit: f32,
    /// Length along which an arm falls to 1 %, as a share of the picture's height, 0.005…0.5. Default 0.1. Arms end at 500
    /// pixels.
    pub length: f32,
    /// Arms of a star, 2…16. Default 6. Each costs two to four passes.
    pub arms: u32,
    /// Angle of the first arm, from the right anticlockwise, rad, −100…100. Default π/12: no arm lies
    /// along the path of glitter under a light, where arms would run into one another.
    pub angle: f32,
}

impl Default for StarFilter {
    fn default() -> Self {
        Self { intensity: 0.5, threshold: 6.0, limit: 200.0, length: 0.1, arms: 6, angle: PI / 12.0 }
    }
}

impl StarFilter {
    /// The nearest filter that can be drawn, where `clamp(field, value, range, fallback)` brings one number into its range.
    fn usable(&self, mut clamp: impl FnMut(&'static str, f32, RangeInclusive<f32>, f32) -> f32) -> Self {
        let usual = Self::default();
        Self {
            intensity: clamp("StarFilter::intensity", self.intensity, 0.0..=10.0, usual.intensity),
            threshold: clamp("StarFilter::threshold", self.threshold, 0.0..=1e4, usual.threshold),
            limit: clamp("StarFilter::limit", self.limit, 0.0..=1e4, usual.limit),
            length: clamp("StarFilter::length", self.length, 0.005..=0.5, usual.length),
            arms: clamp("StarFilter::arms", self.arms as f32, 2.0..=16.0, usual.arms as f32) as u32,
            angle: clamp("StarFilter::angle", self.angle, -100.0..=100.0, usual.angle),
        }
    }
}

impl SyncComponent for StarFilter {
    type Target = (Self, super::prepare::StarPasses, super::prepare::StarPipelines);
}

impl ExtractComponent for StarFilter {
    type QueryData = &'static Self;
    type QueryFilter = With<Hdr>;
    type Out = Self;

    fn extract_component(filter: &Self) -> Option<Self> {
        let clamp = |value: f32, range: RangeInclusive<f32>, fallback: f32| {
            if value.is_nan() { fallback } else { value.clamp(*range.start(), *range.end()) }
        };
        let usable = filter.usable(|_, value, range, fallback| clamp(value, range, fallback));
        (usable.intensity > 0.0 && usable.limit > usable.threshold).then_some(usable)
    }
}

/// Complains about settings out of their range, and about cameras that cannot show anything brighter than white.
pub(super) fn report_unusable(
    mut reported: ResMut<Reported>,
    changed: Query<(Entity, &StarFilter), Changed<StarFilter>>,
    filters: Query<Entity, (With<StarFilter>, With<Camera3d>, Without<Hdr>)>,
) {
    for (entity, filter) in &changed {
        filter.usable(|field, value, range, fallback| reported.clamp(entity, field, value, range, fallback));
    }
    for entity in &filters {
        reported.warn(entity, "StarFilter", "needs the component Hdr on its camera; no stars are drawn");
    }
}
