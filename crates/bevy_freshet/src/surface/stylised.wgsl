// Shading and highlights of older water, drawn beside the physical ones: [AT15] Anastasov and Tomova (2015), [M06]
// Mátyás (2006). `WaterLighting` sets their strength.
//
// Symbols: N normal, V to the eye, L to the light, R = reflect(−L, N), H half-way between V and L, σ² slope variance that
// a pixel hides, both directions together.
#define_import_path freshet::surface::stylised

#import freshet::surface::beam::{Beam, Place}
#import freshet::surface::bindings::surface

const UP: vec3<f32> = vec3<f32>(0.0, 1.0, 0.0);

// cosⁿθ ≈ exp(−n θ²/2) is a lobe of variance 1/n in each direction. Hidden slopes that widen it by `variance` leave
// n' = n/(1 + n variance) in that direction; dividing the peak by the widths keeps the light.
fn narrowed(exponent: f32, variance: f32) -> f32 {
    return 1.0 / (1.0 + exponent * variance);
}

fn lobe(cosine: f32, exponent: f32) -> f32 {
    return pow(max(cosine, 1e-4), exponent);
}

// (R·V)^n under hidden slopes. A slope turns R by twice its angle in the plane of L and V, by less across it: its variances
// are 4 · σ²/2 and that times (H·V)².
fn reflected_lobe(beam: Beam, place: Place, exponent: f32) -> f32 {
    let reflected = reflect(-beam.to_light, place.normal);
    let incline = dot(normalize(place.to_eye + beam.to_light), place.to_eye);
    let along = narrowed(exponent, 2.0 * place.hidden);
    let across = narrowed(exponent, 2.0 * place.hidden * incline * incline);
    let normal_of_plane = cross(beam.to_light, place.to_eye);
    let off = place.to_eye - reflected;
    let aside = dot(off, normal_of_plane);
    let share = aside * aside / max(dot(off, off) * dot(normal_of_plane, normal_of_plane), 1e-9);
    return sqrt(along * across) * lobe(dot(reflected, place.to_eye), exponent * mix(along, across, share));
}

// lerp((R·V)^sharpness, (R_flat·V)^shininess, flatness) [AT15].
fn bumped_highlight(beam: Beam, place: Place) -> f32 {
    let level = lobe(dot(reflect(-beam.to_light, UP), place.to_eye), surface.shininess);
    return mix(reflected_lobe(beam, place, surface.sharpness), level, surface.flatness);
}

// (N·H)^n, tinted [M06]. A slope turns N by its angle in either direction: σ²/2.
fn tinted_highlight(beam: Beam, place: Place) -> vec3<f32> {
    let half_way = normalize(place.to_eye + beam.to_light);
    let share = narrowed(surface.tint_exponent, 0.5 * place.hidden);
    return surface.tint * (share * lobe(dot(place.normal, half_way), surface.tint_exponent * share));
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
