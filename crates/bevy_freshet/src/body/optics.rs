//! What the water is made of, as light sees it.
use bevy::prelude::*;
use freshet_hydro::optics::{PURE_WATER_ABSORPTION, WATER_INDEX};

/// How much of the light is reflected at the surface, by the angle of incidence θ.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Default, Clone, Debug, PartialEq)]
pub enum Fresnel {
    /// `1 − c cos θ` with the correction `c` (0…2): the cheapest. Anastasov and Tomova (2015) use 1.8.
    Simple {
        /// Share of refraction at normal incidence.
        correction: f32,
    },
    /// `R₀ + (1 − R₀)(1 − cos θ)⁵` (Schlick 1994).
    Schlick,
    /// `(1 + cos θ)⁻⁵`, a mode of the lake of Mátyás (2006).
    Reciprocal,
    /// The mean of both polarisations (Fresnel 1823).
    #[default]
    Exact,
    /// The same share (0…1) at every angle: what is left when the Fresnel term is switched off.
    Constant {
        /// Share of reflection.
        share: f32,
    },
}

/// Optical properties of a water body.
///
/// Light below the surface is absorbed and scattered per channel; red, green and blue stand for 650, 550 and 450 nm.
/// Each effect is switched off by the value its field documents.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug)]
pub struct WaterOptics {
    /// Absorption `a`, 1/m, ≥ 0. Zero is water as clear as air.
    pub absorption: Vec3,
    /// Backscattering `b_b`, 1/m, ≥ 0: what makes turbid water bright. Zero switches scattering off.
    pub backscatter: Vec3,
    /// Refractive index, 1…3. Default 1.333. At 1 nothing is refracted, and nothing reflected by [`Fresnel::Exact`].
    pub index: f32,
    /// How the reflected share depends on the angle. Default [`Fresnel::Exact`].
    pub fresnel: Fresnel,
    /// Factor on the reflected share, 0…1. Default 1; 0 switches reflection off.
    pub reflectivity: f32,
    /// How far rays are bent under water, 0…1. Default 1, as Snell's law has it; 0 switches refraction off: the bed is
    /// seen straight through the surface.
    pub refraction: f32,
    /// Difference of the refractive index between blue and red, 0…0.2. Default 0: no dispersion. Real water has 0.006.
    pub dispersion: f32,
    /// How much of the sunlight's own way down to the bed is counted, 0…1. Default 1, as in nature; 0 leaves the bed lit
    /// as in air.
    pub light_path: f32,
    /// Colour of the dull film that Mátyás (2006) blends over his lake (linear RGB). Default (0.1, 0.1, 0.2).
    pub dull_color: LinearRgba,
    /// Share of the dull film, 0…1. Default 0: none.
    pub dullness: f32,
    /// Depth over which the water's edge fades in, m, ≥ 0. Default 0.12; 0 is a hard edge.
    pub edge_depth: f32,
    /// Whether the camera's `DistanceFog` acts on the water. Default true.
    pub fog: bool,
}

impl WaterOptics {
    const BASE: Self = Self {
        absorption: PURE_WATER_ABSORPTION,
        backscatter: Vec3::ZERO,
        index: WATER_INDEX,
        fresnel: Fresnel::Exact,
        reflectivity: 1.0,
        refraction: 1.0,
        dispersion: 0.0,
        light_path: 1.0,
        dull_color: LinearRgba::rgb(0.1, 0.1, 0.2),
        dullness: 0.0,
        edge_depth: 0.12,
        fog: true,
    };

    const fn made_of(absorption: Vec3, backscatter: Vec3) -> Self {
        Self { absorption, backscatter, ..Self::BASE }
    }

    /// Pure water (Pope and Fry 1997), without scattering.
    pub const PURE: Self = Self::BASE;
    /// A clear lowland river: 1.5 mg/m³ chlorophyll, dissolved organics 0.5 1/m, 1.5 g/m³ sediment.
    pub const RIVER: Self = Self::made_of(Vec3::new(0.38427, 0.1906, 0.54978), Vec3::new(0.01863, 0.01916, 0.02049));
    /// A clear lake: 1 mg/m³ chlorophyll, dissolved organics 0.1 1/m, 0.5 g/m³ sediment.
    pub const LAKE: Self = Self::made_of(Vec3::new(0.3569, 0.0914, 0.1530), Vec3::new(0.00811, 0.00866, 0.01002));
    /// The open ocean: 0.2 mg/m³ chlorophyll, dissolved organics 0.02 1/m.
    pub const OCEAN: Self = Self::made_of(Vec3::new(0.3446, 0.0636, 0.0400), Vec3::new(0.00140, 0.00196, 0.00335));
    /// A tropical lagoon: 0.05 mg/m³ chlorophyll, dissolved organics 0.005 1/m.
    pub const TROPICAL: Self = Self::made_of(Vec3::new(0.3417, 0.0587, 0.0190), Vec3::new(0.00079, 0.00133, 0.00269));
    /// A river in flood: 3 mg/m³ chlorophyll, dissolved organics 1.2 1/m, 60 g/m³ sediment.
    pub const MUDDY: Self = Self::made_of(Vec3::new(0.6167, 0.9898, 3.3871), Vec3::new(0.58740, 0.58790, 0.58920));
}

impl Default for WaterOptics {
    fn default() -> Self {
        Self::LAKE
    }
}

impl From<freshet_hydro::optics::Constituents> for WaterOptics {
    /// Water whose colour comes from what is in it; see [`freshet_hydro::optics::Constituents`] for the sources.
    fn from(constituents: freshet_hydro::optics::Constituents) -> Self {
        Self::made_of(constituents.absorption(), constituents.backscatter())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use freshet_hydro::optics::Constituents;

    #[test]
    fn presets_are_what_their_constituents_make() {
        for (preset, chlorophyll, dissolved_organics, sediment) in [
            (WaterOptics::RIVER, 1.5, 0.5, 1.5),
            (WaterOptics::LAKE, 1.0, 0.1, 0.5),
            (WaterOptics::OCEAN, 0.2, 0.02, 0.0),
            (WaterOptics::TROPICAL, 0.05, 0.005, 0.0),
            (WaterOptics::MUDDY, 3.0, 1.2, 60.0),
        ] {
            let made = WaterOptics::from(Constituents { chlorophyll, dissolved_organics, sediment });
            assert!((preset.absorption - made.absorption).abs().max_element() < 1e-4, "{made:?}");
            assert!((preset.backscatter - made.backscatter).abs().max_element() < 1e-4, "{made:?}");
        }
    }
}
