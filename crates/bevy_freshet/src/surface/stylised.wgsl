// Shading and highlights of older water, drawn beside the physical ones: [AT15] Anastasov and Tomova (2015), [M06]
// Mátyás (2006). `WaterLighting` sets their strength.
//
// Symbols: N normal, V to the eye, L to the light, R = reflect(−L, N), H half-way between V and L, σ² slope variance that
// a pixel hides, both directions together.
#define_import_path freshet::surface::stylised

#import freshet::surface::beam::{Beam, Place}
#import freshet::surface::bindings::surface

const UP: vec3<f32> = vec3<f32>(0.0, 1.0, 0.0);

// cosⁿθ ≈ exp(−n θ²/2) is a lobe of variance 1/n in each direction. Hidden slopes that widen it by `variance` in each
// direction leave n' = n/(1 + n variance), and the same light, as the peak falls by n'/n.
fn lobe(cosine: f32, exponent: f32, variance: f32) -> f32 {
    let share = 1.0 / (1.0 + exponent * variance);
    return share * pow(max(cosine, 1e-4), exponent * share);
}

// lerp((R·V)^sharpness, (R_flat·V)^shininess, flatness) [AT15]. A slope turns R by twice its angle: 4 · σ²/2.
fn bumped_highlight(beam: Beam, place: Place) -> f32 {
    let bumped = lobe(dot(reflect(-beam.to_light, place.normal), place.to_eye), surface.sharpness, 2.0 * place.hidden);
    let flat_ = lobe(dot(reflect(-beam.to_light, UP), place.to_eye), surface.shininess, 0.0);
    return mix(bumped, flat_, surface.flatness);
}

// (N·H)^n, tinted [M06]. A slope turns N by its angle: σ²/2.
fn tinted_highlight(beam: Beam, place: Place) -> vec3<f32> {
    let half_way = normalize(place.to_eye + beam.to_light);
    return surface.tint * lobe(dot(place.normal, half_way), surface.tint_exponent, 0.5 * place.hidden);
}

// Radiance that one light adds by the highlights above, and by shining through from behind or below: max(0, L·(−N)).
fn glow(beam: Beam, place: Place) -> vec3<f32> {
    var glow = surface.translucent_color * (max(0.0, dot(beam.to_light, -place.normal)) / 3.14159265);
    if beam.to_light.y > 0.0 {
        glow += surface.highlight * bumped_highlight(beam, place) + tinted_highlight(beam, place);
    }
    return beam.irradiance * beam.shadow * glow;
}

// lerp(N_flat·L, N·L, wave shadow)/2 + 1/2 [AT15], half-Lambert: the shade of the surface under one light.
fn half_lambert(beam: Beam, place: Place) -> f32 {
    let cosine = mix(dot(UP, beam.to_light), dot(place.normal, beam.to_light), surface.wave_shadow);
    return 0.5 + 0.5 * cosine * beam.shadow;
}
