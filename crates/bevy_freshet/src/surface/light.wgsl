// Sun and moon on the surface: their glitter and what they send below it.
#define_import_path freshet::surface::light

#import bevy_pbr::{
    mesh_view_bindings as view_bindings,
    mesh_view_bindings::view,
    mesh_view_types::DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT,
    shadows::fetch_directional_shadow,
}
#import freshet::surface::bindings::surface
#import freshet::surface::mirror::sky_irradiance
#import freshet::surface::optics

struct Light {
    glitter: vec3<f32>,  // reflected radiance, as drawn
    above: vec3<f32>,    // irradiance on the surface / π, as drawn
    below: vec3<f32>,    // irradiance below the surface / π, as drawn
    sun_path: f32,       // way of the strongest light per metre of depth
}

// Slope distribution of Beckmann (1963), with the shadowing of Smith as approximated by Schlick (1994), for a slope
// variance σ² of both directions together: D = exp(−tan²θ/σ²)/(π σ² cos⁴θ).
fn glitter(normal: vec3<f32>, to_eye: vec3<f32>, to_light: vec3<f32>, variance: f32) -> f32 {
    let half_way = normalize(to_eye + to_light);
    let n_h = clamp(dot(normal, half_way), 1e-3, 1.0);
    let n_l = max(dot(normal, to_light), 1e-4);
    let n_v = max(dot(normal, to_eye), 1e-2);
    let cos2 = n_h * n_h;
    let facets = exp((cos2 - 1.0) / (cos2 * variance)) / (3.14159265 * variance * cos2 * cos2);
    let k = sqrt(variance) * 0.7978846;
    let shadowing = 1.0 / ((n_l * (1.0 - k) + k) * (n_v * (1.0 - k) + k));
    return 0.25 * facets * shadowing * optics::fresnel_exact(dot(half_way, to_light), surface.index) * n_l;
}

// The lights at `position` for a surface of `normal` whose unresolved slopes have `variance`.
fn lights(position: vec3<f32>, normal: vec3<f32>, to_eye: vec3<f32>, variance: f32, pixel: vec2<f32>) -> Light {
    let diffuse = sky_irradiance() + view_bindings::lights.ambient_color.rgb * view.exposure;
    var result = Light(vec3(0.0), diffuse, diffuse, 1.2);
    var strongest = 0.0;
    let view_z = (view.view_from_world * vec4(position, 1.0)).z;
    for (var i = 0u; i < view_bindings::lights.n_directional_lights; i++) {
        let light = view_bindings::lights.directional_lights[i];
        let to_light = light.direction_to_light;
        if to_light.y <= 0.0 {
            continue;
        }
        var shadow = 1.0;
        if (light.flags & DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u {
            shadow = fetch_directional_shadow(i, vec4(position, 1.0), vec3(0.0, 1.0, 0.0), view_z, pixel);
        }
        let irradiance = light.color.rgb * (shadow * view.exposure);
        result.glitter += irradiance * glitter(normal, to_eye, to_light, variance);
        result.above += irradiance * max(dot(normal, to_light), 0.0) / 3.14159265;
        let entering = irradiance * (to_light.y * (1.0 - optics::fresnel_exact(to_light.y, surface.index)));
        result.below += entering / 3.14159265;
        if max(light.color.r, light.color.g) > strongest {
            strongest = max(light.color.r, light.color.g);
            // Snell: the way down is 1/cos θ_t per metre of depth.
            result.sun_path = inverseSqrt(1.0 - (1.0 - to_light.y * to_light.y) / (surface.index * surface.index));
        }
    }
    return result;
}
