// Stage: writes the silhouettes of bodies into the cleared cells. Runs when there are any.
#import freshet::simulation::numbers::numbers

struct Silhouette {
    velocity: vec2<f32>,    // local xz, units: m/s
    cover: f32,             // 0…1
    raise: f32,             // displaced since the last time, units: m
    cell: u32,
}

@group(0) @binding(1) var<storage, read> silhouettes: array<Silhouette>;
@group(0) @binding(2) var<storage, read_write> bodies: array<vec4<f32>>;    // velocity (m/s), cover, raise (m)

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= numbers.silhouettes {
        return;
    }
    let one = silhouettes[id.x];
    bodies[one.cell] = vec4(one.velocity, one.cover, one.raise);
}
