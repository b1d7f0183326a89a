// Stage: what carries foam and dye, and where foam is born: not under ice. Runs once a frame.
#import freshet::simulation::numbers::{numbers, inside, index, place}
#import freshet::surface::bindings::surface
#import freshet::surface::frozen
#import freshet::surface::waves

@group(0) @binding(1) var<storage, read> ground: array<vec4<f32>>;          // current (m/s), depth (m), foam born by deformation (1/s)
@group(0) @binding(2) var<storage, read> bodies: array<vec4<f32>>;          // velocity (m/s), cover, raise (m)
@group(0) @binding(3) var<storage, read_write> stream: array<vec4<f32>>;    // velocity (m/s), depth (m), births (1/s)

// The most covered of the cells around, itself included.
fn nearest_body(at: vec2<i32>) -> vec4<f32> {
    var most = vec4(0.0);
    for (var i = 0; i < 9; i++) {
        let around = at + vec2(i % 3, i / 3) - 1;
        if inside(around) {
            let body = bodies[index(around)];
            if body.z > most.z {
                most = body;
            }
        }
    }
    return most;
}

// Births at the waterline: where waves run up, little where it is calm.
fn shore(at: vec2<i32>, depth: f32) -> f32 {
    if depth >= numbers.shore_depth || numbers.shore <= 0.0 {
        return 0.0;
    }
    // The waves as if they did not fade in the shallows.
    let crest = waves::displacement(place(at), 1.0, numbers.cell).y;
    let run_up = clamp(crest / numbers.shore_depth, 0.0, 1.0);
    let share = numbers.calm_shore + (1.0 - numbers.calm_shore) * run_up;
    return numbers.shore * (1.0 - depth / numbers.shore_depth) * share;
}

@compute @workgroup_size(#{GROUP}, #{GROUP})
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = vec2<i32>(id.xy);
    if !inside(at) {
        return;
    }
    let here = ground[index(at)];
    let depth = here.z;
    if depth <= 0.0 {
        stream[index(at)] = vec4(0.0, 0.0, depth, 0.0);
        return;
    }
    var velocity = here.xy;
    var births = shore(at, depth)
        + here.w
        + numbers.speed * max(length(here.xy) - numbers.speed_threshold, 0.0);
    if numbers.silhouettes > 0u {
        // A body drags along what it covers; the foam of its rim is born beside and not under it.
        let own = bodies[index(at)];
        velocity = mix(here.xy, own.xy, own.z);
        let body = nearest_body(at);
        births += numbers.bodies * body.z * (1.0 - own.z) * length(body.xy - here.xy);
    }
    stream[index(at)] = vec4(velocity, depth, births * frozen::felt(place(at)).open);
}
