// Light of one source as it arrives at the surface, and the place it meets.
#define_import_path freshet::surface::beam

struct Beam {
    to_light: vec3<f32>,   // unit vector
    irradiance: vec3<f32>, // of a surface that faces the light, without shadow, as drawn
    shadow: f32,           // share that arrives, 0…1
    spread: f32,           // slope variance that shines as broadly as the size of the source does
}

struct Place {
    position: vec3<f32>,   // world, units: m
    normal: vec3<f32>,     // as far as the pixel resolves it
    to_eye: vec3<f32>,
    hidden: f32,           // slope variance that the pixel hides
    pixel: vec2<f32>,
}
