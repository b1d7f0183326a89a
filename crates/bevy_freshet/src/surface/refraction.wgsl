// What is seen through the surface: the bed where Snell's law puts it, dimmed and tinted by the water in between.
#define_import_path freshet::surface::refraction

#import freshet::surface::bindings::surface
#import freshet::surface::light::Light
#import freshet::surface::optics
#import freshet::surface::scene

// The end of a ray under water.
struct Hit {
    pixel: vec2<f32>,      // where the scene shows it
    path: f32,             // way under water, units: m
    depth: f32,            // depth of the end below the surface, units: m
    position: vec3<f32>,   // world
}

// Way of a ray that meets nothing: no light comes back.
const ENDLESS: f32 = 1e4;

// Whether what stands behind a pixel is under water and behind the surface, so that the ray can have reached it.
fn is_below(behind: scene::Behind, surface_point: vec3<f32>, surface_depth: f32) -> bool {
    return behind.depth < surface_depth && behind.position.y < max(surface_point.y, surface.level);
}

fn trace(at: vec3<f32>, at_depth: f32, straight: scene::Behind, pixel: vec2<f32>, ray: vec3<f32>) -> Hit {
    // Nothing, or what is seen through a crest above the eye: no bed.
    if straight.depth <= 0.0 || straight.position.y >= at.y {
        return Hit(pixel, ENDLESS, ENDLESS, at + ray * ENDLESS);
    }
    // The bed is level over the shift to first order: guess its depth straight behind, look there, and correct once.
    let slant = 1.0 / max(-ray.y, 0.05);
    var end = straight;
    var found = pixel;
    for (var i = 0; i < 2; i++) {
        let guess = scene::pixel_of(at + ray * (max(at.y - end.position.y, 0.0) * slant));
        let next = scene::behind(guess);
        if next.depth <= 0.0 || !is_below(next, at, at_depth) {
            break;
        }
        end = next;
        found = guess;
    }
    let depth = max(at.y - end.position.y, 0.0);
    return Hit(found, depth * slant, depth, end.position);
}

// Colour of one ray under water.
fn look(hit: Hit, lit: Light) -> vec3<f32> {
    let scattered = optics::scattered(lit.below, hit.path, hit.depth, lit.sun_path);
    if hit.path >= ENDLESS {
        return scattered;
    }
    let fog = scene::fog_to(hit.position, hit.pixel);
    let bed = scene::without_fog(scene::color_behind(hit.pixel), fog);
    let way = hit.path + hit.depth * lit.sun_path * surface.light_path;
    return bed * optics::transmittance(way) + scattered;
}

fn bend(normal: vec3<f32>, to_eye: vec3<f32>, index: f32) -> vec3<f32> {
    return normalize(mix(-to_eye, refract(-to_eye, normal, 1.0 / index), surface.refraction));
}

fn refracted(
    at: vec3<f32>,
    frag_coord: vec4<f32>,
    normal: vec3<f32>,
    to_eye: vec3<f32>,
    straight: scene::Behind,
    lit: Light,
) -> vec3<f32> {
    let pixel = frag_coord.xy;
    if surface.refraction <= 0.0 {
        return look(trace(at, frag_coord.z, straight, pixel, -to_eye), lit);
    }
    let green = look(trace(at, frag_coord.z, straight, pixel, bend(normal, to_eye, surface.index)), lit);
    if surface.dispersion <= 0.0 {
        return green;
    }
    let spread = 0.5 * surface.dispersion;
    let red = look(trace(at, frag_coord.z, straight, pixel, bend(normal, to_eye, max(surface.index - spread, 1.0))), lit);
    let blue = look(trace(at, frag_coord.z, straight, pixel, bend(normal, to_eye, surface.index + spread)), lit);
    return vec3(red.r, green.g, blue.b);
}
