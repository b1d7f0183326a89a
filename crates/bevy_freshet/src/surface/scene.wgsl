// All that depends on the view: what was drawn before the water, how far away it is, and the fog in between.
#define_import_path freshet::surface::scene

#import bevy_pbr::{
    mesh_view_bindings as view_bindings,
    mesh_view_bindings::view,
    view_transformations::{frag_coord_to_uv, position_ndc_to_world, position_world_to_clip, uv_to_ndc},
}

#ifdef DEPTH_PREPASS
#import bevy_pbr::prepass_utils::prepass_depth
#endif

#ifdef DISTANCE_FOG
#import bevy_pbr::pbr_functions::apply_fog
#endif

#ifdef TONEMAP_IN_SHADER
#import bevy_core_pipeline::tonemapping::approximate_inverse_tone_mapping
#endif

// Something opaque behind a pixel of the target.
struct Behind {
    position: vec3<f32>, // world, units: m
    depth: f32,          // 1 near … 0 infinitely far
}

fn behind(pixel: vec2<f32>) -> Behind {
#ifdef DEPTH_PREPASS
    let depth = prepass_depth(vec4(pixel, 0.0, 0.0), 0u);
    let ndc = vec3(uv_to_ndc(frag_coord_to_uv(pixel)), max(depth, 1e-9));
    return Behind(position_ndc_to_world(ndc), depth);
#else
    return Behind(vec3(0.0), 0.0);
#endif
}

// The pixel of the target at which a world position is seen. Beyond the edges of the viewport the picture is mirrored:
// that shows no seam, where its last row repeated would show streaks.
fn pixel_of(position: vec3<f32>) -> vec2<f32> {
    let clip = position_world_to_clip(position);
    let place = clip.xy / max(clip.w, 1e-6) * vec2(0.5, -0.5) + 0.5;
    let uv = 1.0 - abs(1.0 - abs(place));
    let inside = clamp(uv * view.viewport.zw, vec2(0.5), view.viewport.zw - 0.5);
    return view.viewport.xy + inside;
}

// Linear radiance, as drawn, of the opaque scene at a pixel of the target.
fn color_behind(pixel: vec2<f32>) -> vec3<f32> {
    // The texel whose depth `behind` tells: interpolation would mix in what stands beside it, in front of the water.
    let uv = (floor(pixel) + 0.5) / vec2<f32>(textureDimensions(view_bindings::view_transmission_texture));
    var color =
        textureSampleLevel(view_bindings::view_transmission_texture, view_bindings::view_transmission_sampler, uv, 0.0);
#ifdef TONEMAP_IN_SHADER
    // The inverse divides by the length of its result.
    color = approximate_inverse_tone_mapping(max(color, vec4(1e-5)), view.color_grading);
#endif
    return color.rgb;
}

// Fog between the eye and a place: what is behind becomes `color * clear + glow`.
struct Fog {
    clear: vec3<f32>,
    glow: vec3<f32>,
}

fn fog_to(position: vec3<f32>, pixel: vec2<f32>) -> Fog {
#ifdef DISTANCE_FOG
    // Bevy's fog is affine in the colour: black and white tell all of it.
    let eye = view.world_position.xyz;
    let glow = apply_fog(view_bindings::fog, vec4(0.0, 0.0, 0.0, 1.0), position, eye, pixel).rgb;
    let white = apply_fog(view_bindings::fog, vec4(1.0), position, eye, pixel).rgb;
    return Fog(white - glow, glow);
#else
    return Fog(vec3(1.0), vec3(0.0));
#endif
}

fn with_fog(color: vec3<f32>, fog: Fog) -> vec3<f32> {
    return color * fog.clear + fog.glow;
}

// The colour before the fog; what the fog hid entirely comes back as black.
fn without_fog(color: vec3<f32>, fog: Fog) -> vec3<f32> {
    return max(color - fog.glow, vec3(0.0)) / max(fog.clear, vec3(1e-3));
}

// Direction from a place to the eye; parallel for an orthographic view.
fn direction_to_eye(position: vec3<f32>) -> vec3<f32> {
    if view.clip_from_view[3].w == 1.0 {
        return normalize(view.world_from_view[2].xyz);
    }
    return normalize(view.world_position.xyz - position);
}
