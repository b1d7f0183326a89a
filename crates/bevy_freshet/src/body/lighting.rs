//! Light in the manner of older water, beside the physical one.
use crate::report::Reported;
use bevy::prelude::*;

/// Parts of the shading of two older works, for those who want their look. All are off by default: sun, moon and lamps
/// then light the water by Fresnel's equations and the distribution of its slopes alone.
///
/// Highlights keep their mean radiance with distance: where ripples become smaller than a pixel, the lobes widen by the
/// slope variance that the pixel hides, and lose height.
///
/// Sources: Anastasov and Tomova (2015), *Dynamic surface rendering of water in liquid and solid state*, and Mátyás (2006),
/// *Water surface rendering using shader technologies*. Where these give no number, the default is ours.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug)]
pub struct WaterLighting {
    /// How far the surface is shaded by half-Lambert diffuse light, `½ + ½ lerp(N·L, N_wave·L, wave_shadow)`
    /// (Anastasov and Tomova), 0…1. Default 0: not at all. Several lights are weighted by their irradiance.
    pub diffuse: f32,
    /// Share of the waves' normal in that, 0…1; the rest is the level surface's. Default 0.2, as in the source.
    pub wave_shadow: f32,
    /// Strength of the highlight `lerp((R_wave·V)^sharpness, (R·V)^shininess, flatness)` (Anastasov and Tomova): its
    /// radiance at the peak for each unit of the light's irradiance, 1/sr, 0…100. Default 0: none. Of the order of 1 it is
    /// as bright as the physical glitter.
    pub highlight: f32,
    /// Share of the level surface's highlight in that, 0…1. Default 0.3, as in the source.
    pub flatness: f32,
    /// Exponent of the waves' highlight, 1…10 000. Default 100. Higher is smaller.
    pub sharpness: f32,
    /// Exponent of the level surface's highlight, 1…10 000. Default 40.
    pub shininess: f32,
    /// Strength of the tinted highlight `(N·H)^tint_exponent` (Mátyás), as [`WaterLighting::highlight`], 1/sr, 0…100.
    /// Default 0: none.
    pub tinted_highlight: f32,
    /// Colour of the tinted highlight (linear RGB), 0…1. Default (0.98, 0.97, 0.7), as in the source.
    pub tint: LinearRgba,
    /// Exponent of the tinted highlight, 1…10 000. Default 400.
    pub tint_exponent: f32,
    /// Strength of the light that shines through from behind a wave or from below the surface, `max(0, L·(−N))` (Anastasov
    /// and Tomova): the share of the irradiance that comes out, 0…10. Default 0: none.
    pub translucence: f32,
    /// Colour of that light (linear RGB), 0…1. Default (0.08, 0.36, 0.30).
    pub translucent_color: LinearRgba,
}

impl WaterLighting {
    /// Physical light alone.
    pub const PHYSICAL: Self = Self {
        diffuse: 0.0,
        wave_shadow: 0.2,
        highlight: 0.0,
        flatness: 0.3,
        sharpness: 100.0,
        shininess: 40.0,
        tinted_highlight: 0.0,
        tint: LinearRgba::rgb(0.98, 0.97, 0.7),
        tint_exponent: 400.0,
        translucence: 0.0,
        translucent_color: LinearRgba::rgb(0.08, 0.36, 0.30),
    };
    /// The light of Anastasov and Tomova's river, on top of the physical one.
    pub const RIVER_2015: Self = Self { diffuse: 1.0, highlight: 0.3, translucence: 1.0, ..Self::PHYSICAL };
    /// The highlight of Mátyás' lake, on top of the physical one.
    pub const LAKE_2006: Self = Self { tinted_highlight: 0.6, ..Self::PHYSICAL };

    /// The nearest lighting that can be drawn; complains about each field that had to be changed for it.
    pub(crate) fn usable(&self, entity: Entity, reported: &mut Reported) -> Self {
        let usual = Self::PHYSICAL;
        let mut clamp = |field, value, range, fallback| reported.clamp(entity, field, value, range, fallback);
        let exponents = 1.0..=1e4;
        Self {
            diffuse: clamp("WaterLighting::diffuse", self.diffuse, 0.0..=1.0, usual.diffuse),
            wave_shadow: clamp("WaterLighting::wave_shadow", self.wave_shadow, 0.0..=1.0, usual.wave_shadow),
            highlight: clamp("WaterLighting::highlight", self.highlight, 0.0..=100.0, usual.highlight),
            flatness: clamp("WaterLighting::flatness", self.flatness, 0.0..=1.0, usual.flatness),
            sharpness: clamp("WaterLighting::sharpness", self.sharpness, exponents.clone(), usual.sharpness),
            shininess: clamp("WaterLighting::shininess", self.shininess, exponents.clone(), usual.shininess),
            tinted_highlight: clamp("WaterLighting::tinted_highlight", self.tinted_highlight, 0.0..=100.0, 0.0),
            tint_exponent: clamp("WaterLighting::tint_exponent", self.tint_exponent, exponents, usual.tint_exponent),
            translucence: clamp("WaterLighting::translucence", self.translucence, 0.0..=10.0, usual.translucence),
            tint: usable_color(entity, "WaterLighting::tint", self.tint, usual.tint, reported),
            translucent_color: usable_color(
                entity,
                "WaterLighting::translucent_color",
                self.translucent_color,
                usual.translucent_color,
                reported,
            ),
        }
    }
}

fn usable_color(
    entity: Entity,
    field: &'static str,
    color: LinearRgba,
    usual: LinearRgba,
    reported: &mut Reported,
) -> LinearRgba {
    LinearRgba::from_vec3(reported.clamp3(entity, field, color.to_vec3(), 0.0..=1.0, usual.to_vec3()))
}

impl Default for WaterLighting {
    fn default() -> Self {
        Self::PHYSICAL
    }
}
