// Sun, moon and lamps on the surface: their glitter and what they send below it.
#define_import_path freshet::surface::light

#import bevy_pbr::{
    mesh_view_bindings as view_bindings,
    mesh_view_bindings::view,
    mesh_view_types::DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT,
    shadows::fetch_directional_shadow,
}
#import freshet::surface::beam::{Beam, Place}
#import freshet::surface::bindings::surface
#import freshet::surface::lamps
#import freshet::surface::mirror::sky_irradiance
#import freshet::surface::optics
#import freshet::surface::stylised
#import freshet::surface::types

struct Light {
    glitter: vec3<f32>,  // reflected radiance, as drawn
    above: vec3<f32>,    // irradiance on the surface / π, as drawn
    below: vec3<f32>,    // irradiance below the surface / π, as drawn
    sun_path: f32,       // way of the strongest light per metre of depth
    glow: vec3<f32>,     // radiance that stylised highlights add, as drawn
    shade: f32,          // factor of the stylised diffuse light
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

// What is summed over the lights.
struct Sum {
    light: Light,
    strongest: f32,      // irradiance of the strongest light so far
    shade: f32,          // half-Lambert shade, weighted by irradiance
    weight: f32,
}

fn add(sum: ptr<function, Sum>, beam: Beam, place: Place) {
    let brightness = max(beam.irradiance.r, max(beam.irradiance.g, beam.irradiance.b));
    (*sum).shade += brightness * stylised::half_lambert(beam, place);
    (*sum).weight += brightness;
    (*sum).light.glow += stylised::glow(beam, place);
    let rise = beam.to_light.y;
    if rise <= 0.0 {
        return;
    }
    let irradiance = beam.irradiance * beam.shadow;
    let variance = place.hidden + surface.roughness + beam.spread;
    (*sum).light.glitter += irradiance * glitter(place.normal, place.to_eye, beam.to_light, variance);
    (*sum).light.above += irradiance * (max(dot(place.normal, beam.to_light), 0.0) / 3.14159265);
    (*sum).light.below += irradiance * (rise * (1.0 - optics::fresnel_exact(rise, surface.index)) / 3.14159265);
    if brightness > (*sum).strongest {
        (*sum).strongest = brightness;
        // Snell: the way down is 1/cos θ_t per metre of depth.
        (*sum).light.sun_path = inverseSqrt(1.0 - (1.0 - rise * rise) / (surface.index * surface.index));
    }
}

fn directional(i: u32, place: Place) -> Beam {
    let light = &view_bindings::lights.directional_lights[i];
    var shadow = 1.0;
    if ((*light).flags & DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u && (*light).direction_to_light.y > 0.0 {
        let view_z = (view.view_from_world * vec4(place.position, 1.0)).z;
        shadow = fetch_directional_shadow(i, vec4(place.position, 1.0), vec3(0.0, 1.0, 0.0), view_z, place.pixel);
    }
    return Beam((*light).direction_to_light, (*light).color.rgb * view.exposure, shadow, 0.0);
}

// All lights at a place.
fn lights(place: Place) -> Light {
    let diffuse = sky_irradiance() + view_bindings::lights.ambient_color.rgb * view.exposure;
    var sum = Sum(Light(vec3(0.0), diffuse, diffuse, 1.2, vec3(0.0), 1.0), 0.0, 0.0, 0.0);
    for (var i = 0u; i < view_bindings::lights.n_directional_lights; i++) {
        add(&sum, directional(i, place), place);
    }
    let near = lamps::near(place.position, place.pixel);
    for (var i = near.first; i < near.end; i++) {
        add(&sum, lamps::beam(i, i >= near.spots, place.position, place.pixel), place);
    }
    if sum.weight > 0.0 {
        sum.light.shade = mix(1.0, sum.shade / sum.weight, surface.diffuse);
    }
    return sum.light;
}
