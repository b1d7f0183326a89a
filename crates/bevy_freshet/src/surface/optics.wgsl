// Reflectance, absorption and scattering; the Rust twin is `freshet_hydro::optics`.
#define_import_path freshet::surface::optics

#import freshet::surface::bindings::surface
#import freshet::surface::types

// Unpolarised reflectance (Fresnel 1823) between media whose indices have the ratio `index` = n₂/n₁.
fn fresnel_exact(cos_i: f32, index: f32) -> f32 {
    let cos_t_squared = 1.0 - (1.0 - cos_i * cos_i) / (index * index);
    if cos_t_squared <= 0.0 {
        return 1.0;
    }
    let cos_t = sqrt(cos_t_squared);
    let s = (cos_i - index * cos_t) / (cos_i + index * cos_t);
    let p = (index * cos_i - cos_t) / (index * cos_i + cos_t);
    return 0.5 * (s * s + p * p);
}

// Reflected share of light that meets the surface from the air at `cos_i` to the normal, in the water's chosen mode.
fn reflectance(cos_incidence: f32) -> f32 {
    let cos_i = clamp(cos_incidence, 0.0, 1.0);
    var share: f32;
    if surface.fresnel == types::FRESNEL_SIMPLE {
        share = 1.0 - surface.fresnel_correction * cos_i;
    } else if surface.fresnel == types::FRESNEL_SCHLICK {
        let r = (surface.index - 1.0) / (surface.index + 1.0);
        share = r * r + (1.0 - r * r) * pow(1.0 - cos_i, 5.0);
    } else if surface.fresnel == types::FRESNEL_RECIPROCAL {
        share = pow(1.0 + cos_i, -5.0);
    } else if surface.fresnel == types::FRESNEL_CONSTANT {
        share = surface.fresnel_correction;
    } else {
        share = fresnel_exact(cos_i, surface.index);
    }
    return clamp(share, 0.0, 1.0);
}

// Absorption of what is dissolved at the fragment's place, 1/m.
var<private> dye: vec3<f32>;

// Extinction of a beam, 1/m: light scattered forward is counted as unscattered.
fn extinction() -> vec3<f32> {
    return surface.absorption + dye + surface.backscatter;
}

// Beer–Lambert.
fn transmittance(length: f32) -> vec3<f32> {
    return exp(-extinction() * length);
}

// Radiance that the water itself sends towards the eye, for light of irradiance E = π `lit` falling on it, seen over
// `path` metres down to `depth`; `sun_path` is the way of the light per metre of depth.
//
// Deep water returns 0.33 b_b/(a + b_b) of the light (Morel and Prieur 1977); a layer returns the share
// 1 − exp(−c (L + d/μ)) of that.
fn scattered(lit: vec3<f32>, path: f32, depth: f32, sun_path: f32) -> vec3<f32> {
    let c = max(extinction(), vec3(1e-6));
    return lit * 0.33 * surface.backscatter / c * (1.0 - exp(-c * (path + depth * sun_path)));
}
