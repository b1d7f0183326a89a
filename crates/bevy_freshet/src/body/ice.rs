//! The ice on a water.
use super::frozen::IceMap;
use bevy::prelude::*;
use freshet_hydro::ice::{PURE_ICE_ABSORPTION, THINNEST_WINTER};

/// Ice that grows from the banks inward. Beside a [`Water`](super::Water); a water without it never freezes, and pays
/// nothing.
///
/// Shallow and slow water near the banks freezes first, as computed from bed and flow
/// ([`order_map`](freshet_hydro::ice::order_map)). What is drawn is felt: where ice has closed,
/// [`WaterQuery`](crate::query::WaterQuery) finds neither waves nor current.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug)]
#[require(IceMap)]
pub struct WaterIce {
    /// How much of the winter has passed, 0…1: 0 is open water, 1 is frozen over. Default 1. May change in every frame,
    /// forth and back.
    pub freezing: f32,
    /// Thickness of the oldest ice at the end of the winter, m, 0.1…3. Default 0.3.
    pub thickness: f32,
    /// How far the surface sinks, as a share of the ice's thickness, 0…1. Default 0.2 (Anastasov and Tomova 2015).
    pub level_drop: f32,
    /// Distance from the bank over which its shelter is lost, m, 0.1…1000. Default 8.
    pub bank_reach: f32,
    /// Speed of the current above which no ice grows from the banks, m/s, 0.01…100. Default 0.6.
    pub flow_limit: f32,
    /// Share of the ice that snow covers in the end, 0…1. Default 0.65; 0 is bare ice.
    pub snow: f32,
    /// How strongly cracks are seen in bare ice, 0…1. Default 0.6.
    pub cracks: f32,
    /// Size of the pattern of snow drifts and cracks, m, 0.5…1000. Default 9.
    pub pattern_size: f32,
    /// Absorption of the ice, 1/m, 0…100. Default [`WaterIce::BLUE`] times that of pure ice.
    pub absorption: Vec3,
    /// Backscattering of the bubbles in the ice, 1/m, 0…1000. Default 2.5; 0.2 is clear black ice, 20 is white ice.
    pub scattering: f32,
    /// Slope variance of the bare ice, 0.0001…0.5: how blurred it mirrors. Default 0.006.
    pub roughness: f32,
    /// Share of the light that snow scatters back (linear RGB), 0…1. Default 0.86, 0.88, 0.91.
    pub snow_albedo: LinearRgba,
}

impl WaterIce {
    /// Ice after the share `freezing` (0…1) of the winter.
    pub fn frozen(freezing: f32) -> Self {
        Self { freezing, ..default() }
    }

    /// Pure ice is blue by the metre. With so many times its absorption a hand's breadth of it has that colour.
    pub const BLUE: f32 = 8.0;

    /// Range of [`WaterIce::thickness`], m.
    pub(crate) const THICKNESSES: core::ops::RangeInclusive<f32> = THINNEST_WINTER..=3.0;
}

impl Default for WaterIce {
    fn default() -> Self {
        Self {
            freezing: 1.0,
            thickness: 0.3,
            level_drop: 0.2,
            bank_reach: 8.0,
            flow_limit: 0.6,
            snow: 0.65,
            cracks: 0.6,
            pattern_size: 9.0,
            absorption: PURE_ICE_ABSORPTION * Self::BLUE,
            scattering: 2.5,
            roughness: 0.006,
            snow_albedo: LinearRgba::rgb(0.86, 0.88, 0.91),
        }
    }
}
