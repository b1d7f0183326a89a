//! How light meets water: reflection at the surface, absorption and scattering below it.
//!
//! The surface shader's `optics.wgsl` holds the same equations.
use glam::{Vec3, vec3};

/// Refractive index of fresh water for visible light at 20 °C (Hale and Querry 1973: 1.331 … 1.337).
pub const WATER_INDEX: f32 = 1.333;

/// Wavelengths, nm, that stand for the red, green and blue channel.
pub const CHANNEL_WAVELENGTHS: Vec3 = vec3(650.0, 550.0, 450.0);

/// Absorption of pure water at [`CHANNEL_WAVELENGTHS`], 1/m (Pope and Fry 1997, table 3).
pub const PURE_WATER_ABSORPTION: Vec3 = vec3(0.340, 0.0565, 0.00922);

/// Backscattering of pure water at [`CHANNEL_WAVELENGTHS`], 1/m: half of the scattering of Smith and Baker 1981.
pub const PURE_WATER_BACKSCATTER: Vec3 = vec3(0.0004, 0.0009, 0.0022);

/// Exact reflectance of unpolarised light (Fresnel 1823) for a ray in air that meets water of `index` with
/// `cos_incidence` (0…1) to the normal.
pub fn fresnel_exact(cos_incidence: f32, index: f32) -> f32 {
    let cos_i = cos_incidence.clamp(0.0, 1.0);
    // Snell: sin θ_t = sin θ_i / n; the root has no real value under total internal reflection.
    let cos_t_squared = 1.0 - (1.0 - cos_i * cos_i) / (index * index);
    if cos_t_squared <= 0.0 {
        return 1.0;
    }
    let cos_t = cos_t_squared.sqrt();
    let perpendicular = (cos_i - index * cos_t) / (cos_i + index * cos_t);
    let parallel = (index * cos_i - cos_t) / (index * cos_i + cos_t);
    0.5 * (perpendicular * perpendicular + parallel * parallel)
}

/// Reflectance at normal incidence, `((n − 1)/(n + 1))²`.
pub fn normal_reflectance(index: f32) -> f32 {
    let r = (index - 1.0) / (index + 1.0);
    r * r
}

/// Schlick's approximation (1994): `R₀ + (1 − R₀)(1 − cos θ)⁵`.
pub fn fresnel_schlick(cos_incidence: f32, index: f32) -> f32 {
    let r0 = normal_reflectance(index);
    let m = 1.0 - cos_incidence.clamp(0.0, 1.0);
    r0 + (1.0 - r0) * m * m * m * m * m
}

/// What is dissolved and suspended in a water, and thereby its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constituents {
    /// Chlorophyll a, mg/m³: 0.05 open ocean … 5 coast … 50 green lake.
    pub chlorophyll: f32,
    /// Absorption of coloured dissolved organic matter at 440 nm, 1/m: 0.01 ocean … 1 river … 10 bog.
    pub dissolved_organics: f32,
    /// Suspended mineral sediment, g/m³: 0 ocean … 10 river … 500 flood.
    pub sediment: f32,
}

impl Constituents {
    /// Absorption at [`CHANNEL_WAVELENGTHS`], 1/m.
    ///
    /// `a = a_w + A_ph C^0.65 + a_g e^(−0.014 (λ − 440)) + 0.041 M e^(−0.0123 (λ − 443))`: pure water; phytoplankton
    /// after Bricaud et al. 1995, rounded to one exponent (0.010, 0.008, 0.038 at 650, 550, 450 nm); dissolved organics after Bricaud et al. 1981; minerals after Babin et al. 2003 (m²/g).
    pub fn absorption(&self) -> Vec3 {
        let phytoplankton = vec3(0.010, 0.008, 0.038) * libm::powf(self.chlorophyll, 0.65);
        let organics = CHANNEL_WAVELENGTHS.map_channels(|l| self.dissolved_organics * libm::expf(-0.014 * (l - 440.0)));
        let minerals = CHANNEL_WAVELENGTHS.map_channels(|l| 0.041 * self.sediment * libm::expf(-0.0123 * (l - 443.0)));
        PURE_WATER_ABSORPTION + phytoplankton + organics + minerals
    }

    /// Backscattering at [`CHANNEL_WAVELENGTHS`], 1/m.
    ///
    /// `b_b = b_bw + (0.002 + 0.01 (0.5 − 0.25 lg C)(λ/550)^v) 0.416 C^0.766 + 0.019 · 0.51 M`, `v = (lg C − 0.3)/2 ≤ 0`:
    /// pure water; algae after Morel and Maritorena 2001, eqs. 12–14; minerals with 0.51 m²/g (Babin et al. 2003), of
    /// which 1.9 % go backward (Petzold 1972).
    pub fn backscatter(&self) -> Vec3 {
        let minerals = Vec3::splat(0.019 * 0.51 * self.sediment);
        if self.chlorophyll <= 0.0 {
            return PURE_WATER_BACKSCATTER + minerals;
        }
        let lg = libm::log10f(self.chlorophyll);
        let exponent = (0.5 * (lg - 0.3)).min(0.0);
        let spectral = (0.5 - 0.25 * lg).max(0.0);
        let scattering = 0.416 * libm::powf(self.chlorophyll, 0.766);
        let algae = CHANNEL_WAVELENGTHS
            .map_channels(|l| (0.002 + 0.01 * spectral * libm::powf(l / 550.0, exponent)) * scattering);
        PURE_WATER_BACKSCATTER + algae + minerals
    }
}

/// Share of the light that passes `length` (m) of water of `extinction` (1/m): Beer–Lambert, `exp(−c L)`.
pub fn transmittance(extinction: Vec3, length: f32) -> Vec3 {
    extinction.map_channels(|c| libm::expf(-c * length))
}

/// Share of the light falling on deep water that comes back out of it: `0.33 b_b/(a + b_b)` (Morel and Prieur 1977,
/// with `a + b_b` for `a` so that it stays below one third in turbid water).
pub fn deep_reflectance(absorption: Vec3, backscatter: Vec3) -> Vec3 {
    0.33 * backscatter / (absorption + backscatter).max(Vec3::splat(1e-6))
}

trait MapChannels {
    fn map_channels(self, f: impl Fn(f32) -> f32) -> Self;
}

impl MapChannels for Vec3 {
    fn map_channels(self, f: impl Fn(f32) -> f32) -> Self {
        vec3(f(self.x), f(self.y), f(self.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn reflectance_follows_the_table_of_fresnel() {
        for (degrees, exact, schlick) in [
            (0.0, 0.02037, 0.02037),
            (30.0, 0.02144, 0.02042),
            (60.0, 0.05969, 0.05099),
            (75.0, 0.21238, 0.23949),
            (85.0, 0.58352, 0.64131),
        ] {
            let cos = f32::to_radians(degrees).cos();
            assert_relative_eq!(fresnel_exact(cos, WATER_INDEX), exact, epsilon = 1e-5);
            assert_relative_eq!(fresnel_schlick(cos, WATER_INDEX), schlick, epsilon = 1e-5);
        }
    }

    #[test]
    fn grazing_light_is_reflected_whole() {
        assert_relative_eq!(fresnel_exact(0.0, WATER_INDEX), 1.0);
        assert_relative_eq!(fresnel_schlick(0.0, WATER_INDEX), 1.0);
    }

    #[test]
    fn twice_the_depth_squares_the_transmittance() {
        let extinction = Constituents { chlorophyll: 3.0, dissolved_organics: 0.8, sediment: 4.0 }.absorption();
        let once = transmittance(extinction, 1.3);
        assert!((transmittance(extinction, 2.6) - once * once).abs().max_element() < 1e-6);
    }

    #[test]
    fn constituents_colour_water_as_in_nature() {
        let ocean = Constituents { chlorophyll: 0.05, dissolved_organics: 0.005, sediment: 0.0 };
        let bog = Constituents { chlorophyll: 1.0, dissolved_organics: 8.0, sediment: 0.5 };
        let flood = Constituents { chlorophyll: 2.0, dissolved_organics: 1.0, sediment: 200.0 };
        let colour = |c: &Constituents| deep_reflectance(c.absorption(), c.backscatter());
        let (ocean, bog, flood) = (colour(&ocean), colour(&bog), colour(&flood));
        assert!(ocean.z > 3.0 * ocean.y && ocean.y > ocean.x, "the open ocean is blue: {ocean}");
        assert!(bog.x > bog.z && bog.max_element() < 0.03, "a bog is dark and brown: {bog}");
        assert!(flood.x > flood.y && flood.y > flood.z && flood.x > 0.05, "a flood is bright and brown: {flood}");
    }
}
