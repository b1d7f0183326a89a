//! How light passes turbid ice.
use glam::{Vec3, vec3};

/// Absorption of pure ice at [`CHANNEL_WAVELENGTHS`](crate::optics::CHANNEL_WAVELENGTHS), 1/m: 4π κ/λ with the
/// imaginary indices κ = 1.43·10⁻⁸, 2.29·10⁻⁹, 9.24·10⁻¹¹ of Warren and Brandt (2008).
pub const PURE_ICE_ABSORPTION: Vec3 = vec3(0.2765, 0.0523, 0.0026);

/// Diffuse light at a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Share that comes back.
    pub reflectance: Vec3,
    /// Share that comes through.
    pub transmittance: Vec3,
}

/// Reflectance and transmittance for diffuse light of a layer of `thickness` (m, ≥ 0) with `absorption` and
/// backscattering `scattering` (1/m, ≥ 0), over a black ground.
///
/// Kubelka and Munk (1931), in the form of Kubelka (1948): with K = 2a (diffuse light goes two metres per metre of
/// depth), S the scattering and γ = √(K (K + 2S)),
/// ```text
/// R = S sinh γh / D,   T = γ / D,   D = γ cosh γh + (K + S) sinh γh
/// ```
/// Divided by γ cosh γh, with tanh γh / γ → h for γ → 0, it holds for clear and for thick ice alike.
pub fn layer(absorption: Vec3, scattering: f32, thickness: f32) -> Layer {
    let channels = absorption.to_array().map(|a| {
        let (k, s) = (2.0 * a, scattering);
        let gamma = (k * (k + 2.0 * s)).sqrt().max(1e-4);
        let decay = libm::expf(-gamma * thickness);
        let sech = 2.0 * decay / (1.0 + decay * decay);
        let way = (1.0 - decay * decay) / (1.0 + decay * decay) / gamma;
        let d = 1.0 + (k + s) * way;
        [s * way / d, sech / d]
    });
    let [r, g, b] = channels;
    Layer { reflectance: vec3(r[0], g[0], b[0]), transmittance: vec3(r[1], g[1], b[1]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    #[test]
    fn the_constants_are_those_of_the_refractive_indices() {
        let kappa = vec3(1.43e-8, 2.289e-9, 9.239e-11);
        let expected = 4.0 * core::f32::consts::PI * kappa / (crate::optics::CHANNEL_WAVELENGTHS * 1e-9);
        assert!((PURE_ICE_ABSORPTION / expected - 1.0).abs().max_element() < 0.01, "{expected}");
    }

    #[test]
    fn limits_are_known() {
        let clear = layer(PURE_ICE_ABSORPTION, 0.0, 0.5);
        assert_eq!(clear.reflectance, Vec3::ZERO);
        assert_relative_eq!(clear.transmittance.x, (-2.0 * 0.2765_f32 * 0.5).exp(), epsilon = 1e-5);
        // Without absorption nothing is lost: R = S h/(1 + S h).
        let white = layer(Vec3::ZERO, 3.0, 0.5);
        assert_relative_eq!(white.reflectance.x, 1.5 / 2.5, epsilon = 1e-3);
        // Endless: R = 1 + K/S − √((K/S)² + 2 K/S).
        let deep = layer(Vec3::splat(0.1), 2.0, 1e3);
        assert_relative_eq!(deep.reflectance.x, 1.1 - (0.01_f32 + 0.2).sqrt(), epsilon = 1e-4);
        let ice = layer(PURE_ICE_ABSORPTION, 2.0, 1.0).reflectance;
        assert!(ice.z > ice.y && ice.y > 1.1 * ice.x, "deep ice is blue: {ice}");
    }

    proptest! {
        /// Two layers make one: T = T₁T₂/(1 − R₁R₂), R = R₁ + T₁² R₂/(1 − R₁R₂) (Stokes 1862).
        #[test]
        fn layers_add_up(a in 0.0_f32..2.0, s in 0.0_f32..20.0, h in 0.0_f32..2.0, more in 0.0_f32..2.0) {
            let of = |h: f32| { let l = layer(Vec3::splat(a), s, h); (l.reflectance.x, l.transmittance.x) };
            let ((r1, t1), (r2, t2), (r, t)) = (of(h), of(more), of(h + more));
            prop_assert!((t - t1 * t2 / (1.0 - r1 * r2)).abs() < 2e-3);
            prop_assert!((r - (r1 + t1 * t1 * r2 / (1.0 - r1 * r2))).abs() < 2e-3);
            prop_assert!(r + t <= 1.0 + 1e-4);
        }
    }
}
