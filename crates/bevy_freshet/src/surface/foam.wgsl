// How foam looks.
#define_import_path freshet::surface::foam

#import freshet::surface::bindings::surface

// Share of a pixel that foam of mean cover `density` hides at local `place`.
fn cover(place: vec2<f32>, density: f32) -> f32 {
    return clamp(density, 0.0, 1.0) * surface.foam_amount;
}

// Light that foam scatters, for irradiance E = π `lit` falling on it.
fn color(lit: vec3<f32>) -> vec3<f32> {
    return surface.foam_albedo * lit;
}
