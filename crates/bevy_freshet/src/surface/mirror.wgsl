// What the surface reflects: the mirror camera's picture, and the sky.
#define_import_path freshet::surface::mirror

#import freshet::surface::bindings::{surface, mirror, mirror_sampler, sky, sky_sampler, sky_light}
#import freshet::surface::types
#import freshet::surface::scene::{Fog, without_fog}

// Radiance of the sky in a world direction, perceptual `roughness` 0…1.
fn sky_radiance(direction: vec3<f32>, roughness: f32) -> vec3<f32> {
    // Cubemaps are left-handed.
    let texel_direction = surface.sky_from_world * direction * vec3(1.0, 1.0, -1.0);
    let lod = roughness * f32(textureNumLevels(sky) - 1u);
    return textureSampleLevel(sky, sky_sampler, texel_direction, lod).rgb * surface.sky_tint;
}

// Irradiance of the sky on a level surface, divided by π.
fn sky_irradiance() -> vec3<f32> {
    let up = surface.sky_from_world * vec3(0.0, 1.0, 0.0) * vec3(1.0, 1.0, -1.0);
    return textureSampleLevel(sky_light, sky_sampler, up, 0.0).rgb * surface.sky_tint;
}

// The mirror camera's picture where the ray from `foot` on the still surface goes, with its cover in alpha; empty
// without a mirror.
fn mirrored(foot: vec3<f32>, direction: vec3<f32>) -> vec4<f32> {
    if (surface.flags & types::FLAG_MIRROR) == 0u {
        return vec4(0.0);
    }
    // The mirror camera sees the unmirrored scene from below: a ray through `foot` is one of its own rays, so the
    // assumed distance matters only where the surface is not level.
    let seen = foot + direction * surface.mirror_distance;
    let clip = surface.mirror_clip_from_world * vec4(seen, 1.0);
    if clip.w <= 0.0 {
        return vec4(0.0);
    }
    let half_texel = 0.5 / vec2<f32>(textureDimensions(mirror));
    let uv = clamp(clip.xy / clip.w * vec2(0.5, -0.5) + 0.5, half_texel, 1.0 - half_texel);
    return textureSampleLevel(mirror, mirror_sampler, uv, 0.0);
}

// Mirrored things carry the fog between them and the mirrored eye: the colour, weighted by cover, without the part of
// it that lies between eye and surface.
fn freed_of_fog(picture: vec4<f32>, fog: Fog) -> vec3<f32> {
    return without_fog(picture.rgb, Fog(fog.clear, fog.glow * picture.a));
}
