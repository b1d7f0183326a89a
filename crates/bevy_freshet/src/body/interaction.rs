//! How the water answers what touches it.
use bevy::prelude::*;

/// The cells on which the water answers bodies, touches and rain: with rings, foam and dye.
///
/// They fill the water, or, if that is too large, a window of it ahead of the camera.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug)]
pub struct WaterInteraction {
    /// Whether anything is simulated at all. Default true.
    pub enabled: bool,
    /// Size of a cell, m, 0.01…100. Default 0.25. Rings shorter than four cells cannot spread.
    pub cell: f32,
    /// Most cells along an axis, 16…2048. Default 512.
    pub cells: u32,
    /// Factor on the rings that bodies make, 0…10. Default 1: the volume of the ring is that which the body displaced.
    /// 0 switches rings off.
    pub rings: f32,
    /// Length of the rings' waves, m, 0.05…1000. Default 1.2. It sets their speed: c² = (g/k) tanh(k d).
    pub wavelength: f32,
    /// Time in which rings decay to 1/e, s, 0.05…1000. Default 5.
    pub decay: f32,
    /// Rain, mm/h, 0…500. Default 0. Its drops make rings.
    pub rain: f32,
    /// Spreading of dye by turbulence, m²/s, 0…1. Default 0.01.
    pub spreading: f32,
    /// Time in which dye fades to 1/e, s, 0.1…1e6. Default 120.
    pub dye_life: f32,
}

impl Default for WaterInteraction {
    fn default() -> Self {
        Self {
            enabled: true,
            cell: 0.25,
            cells: 512,
            rings: 1.0,
            wavelength: 1.2,
            decay: 5.0,
            rain: 0.0,
            spreading: 0.01,
            dye_life: 120.0,
        }
    }
}
