// Stage: the fields as the surface's shader reads them. Runs last.
#import freshet::simulation::numbers::{numbers, inside, index}

@group(0) @binding(1) var<storage, read> ground: array<vec4<f32>>;      // current (m/s), depth (m), foam born by deformation (1/s)
@group(0) @binding(2) var<storage, read> bodies: array<vec4<f32>>;      // velocity (m/s), cover, raise (m)
@group(0) @binding(3) var<storage, read> waves: array<vec2<f32>>;       // η (m), v (m/s)
@group(0) @binding(4) var<storage, read> matter: array<vec4<f32>>;      // foam, dye
@group(0) @binding(5) var rings_picture: texture_storage_2d<rgba16float, write>;
@group(0) @binding(6) var matter_picture: texture_storage_2d<rgba16float, write>;

// In shallower water than this dye is as strong as here, m.
const SHALLOWEST: f32 = 0.05;

fn wet(at: vec2<i32>) -> bool {
    return inside(at) && ground[index(at)].z > 0.0;
}

// Height of the rings at `at`; before a dry cell it goes on level.
fn height(at: vec2<i32>, own: f32) -> f32 {
    if wet(at) {
        return waves[index(at)].x;
    }
    return own;
}

// Cover of foam and absorption of dye.
fn seen(at: vec2<i32>) -> vec4<f32> {
    let here = matter[index(at)];
    let depth = clamp(ground[index(at)].z, SHALLOWEST, numbers.dye_mixing);
    return vec4(clamp(here.x, 0.0, 1.0), max(here.yzw, vec3(0.0)) / depth);
}

@compute @workgroup_size(#{GROUP}, #{GROUP})
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = vec2<i32>(id.xy);
    if !inside(at) {
        return;
    }
    var rings = vec4(0.0, 0.0, 0.0, bodies[index(at)].z);
    var mean = vec4(0.0);
    if wet(at) {
        let own = waves[index(at)].x;
        let rise = vec2(
            height(at + vec2(1, 0), own) - height(at - vec2(1, 0), own),
            height(at + vec2(0, 1), own) - height(at - vec2(0, 1), own),
        );
        rings = vec4(rise / (2.0 * numbers.cell), own, rings.w);
        mean = seen(at);
    } else {
        // Land continues the water beside it, so that filtering does not thin out what lies at the waterline.
        var cells = 0.0;
        for (var i = 0; i < 9; i++) {
            let beside = at + vec2(i % 3, i / 3) - 1;
            if wet(beside) {
                mean += seen(beside);
                rings.z += waves[index(beside)].x;
                cells += 1.0;
            }
        }
        mean /= max(cells, 1.0);
        rings.z /= max(cells, 1.0);
    }
    textureStore(rings_picture, at, rings);
    textureStore(matter_picture, at, mean);
}
