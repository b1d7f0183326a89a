//! Foam on the water.
use bevy::prelude::*;

/// Foam: born at the shore, in fast and sheared flow and around bodies, carried by the current, and decaying.
///
/// Its density is simulated on the cells of [`WaterInteraction`](super::WaterInteraction); 1 covers the water. Each
/// source is switched off by 0.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug)]
pub struct WaterFoam {
    /// Factor on the drawn cover, 0…1. Default 1; 0 draws none and lets what is there rest.
    pub amount: f32,
    /// Time in which foam decays to 1/e, s, 0.1…1000. Default 8.
    pub life: f32,
    /// Foam born at the waterline, 1/s, 0…10. Default 0.3.
    pub shore: f32,
    /// Depth of the still water below which the shore makes foam, m, 0.01…10. Default 0.2.
    pub shore_depth: f32,
    /// Foam born in sheared flow, per unit of shear (1/s per 1/s), 0…10. Default 0.2.
    pub shear: f32,
    /// Shear below which none is born, 1/s, 0…100. Default 0.13.
    pub shear_threshold: f32,
    /// Foam born where the current runs together, as in hydraulic jumps and breaking fronts, per unit of convergence (1/s per 1/s),
    /// 0…10. Default 1.
    pub breaking: f32,
    /// Convergence below which none is born, 1/s, 0…100. Default 0.4.
    pub breaking_threshold: f32,
    /// Foam born in fast flow, 1/s for each m/s above the threshold, 0…10. Default 0.1.
    pub speed: f32,
    /// Speed below which none is born, m/s, 0…100. Default 0.85.
    pub speed_threshold: f32,
    /// Foam born around bodies, 1/s for each m/s between body and water, 0…10. Default 1.
    pub bodies: f32,
    /// Size of the bubbles' pattern, m, 0.05…100. Default 1.5.
    pub pattern_size: f32,
    /// Share of the light that foam scatters back (linear RGB), 0…1. Default 0.75, 0.77, 0.76.
    pub albedo: LinearRgba,
}

impl Default for WaterFoam {
    fn default() -> Self {
        Self {
            amount: 1.0,
            life: 8.0,
            shore: 0.3,
            shore_depth: 0.2,
            shear: 0.2,
            shear_threshold: 0.13,
            breaking: 1.0,
            breaking_threshold: 0.4,
            speed: 0.1,
            speed_threshold: 0.85,
            bodies: 1.0,
            pattern_size: 1.5,
            albedo: LinearRgba::rgb(0.75, 0.77, 0.76),
        }
    }
}
