// Stage: raises the water by what bodies displaced and by touches, and adds their foam and dye. One workgroup for each tile of
// cells that something reaches.
#import freshet::simulation::numbers::{numbers, inside, index, place}

struct Tile {
    corner: vec2<i32>,      // its first cell
    first: u32,             // first stroke of it
    strokes: u32,
}

struct Stroke {
    middle: vec2<f32>,      // local xz, units: m
    radius: f32,            // standard deviation, units: m
    volume: f32,            // units: m³
    dye: vec3<f32>,         // units: (1/m)·m³
    foam: f32,              // units: m²
}

@group(0) @binding(1) var<storage, read> tiles: array<Tile>;
@group(0) @binding(2) var<storage, read> strokes: array<Stroke>;
@group(0) @binding(3) var<storage, read> celerity: array<f32>;                  // m²/s²; 0 where it is dry
@group(0) @binding(4) var<storage, read> bodies: array<vec4<f32>>;              // velocity (m/s), cover, raise (m)
@group(0) @binding(5) var<storage, read_write> waves: array<vec2<f32>>;         // η (m), v (m/s)
@group(0) @binding(6) var<storage, read_write> matter: array<vec4<f32>>;        // foam, dye

fn wet(at: vec2<i32>) -> bool {
    return inside(at) && celerity[index(at)] > 0.0;
}

// What reaches `at` from its neighbour `beside`, a quarter of the difference; nothing across the face of a dry cell.
fn across(at: vec2<i32>, beside: vec2<i32>) -> f32 {
    if !wet(beside) {
        return 0.0;
    }
    return 0.25 * (bodies[index(beside)].w - bodies[index(at)].w);
}

fn spread_along_x(at: vec2<i32>) -> f32 {
    return bodies[index(at)].w + (across(at, at - vec2(1, 0)) + across(at, at + vec2(1, 0)));
}

// The displaced water, spread by ¼, ½, ¼ along x and then z, so that no height stands on one cell alone.
fn raise(at: vec2<i32>) -> f32 {
    let own = spread_along_x(at);
    var sum = 0.0;
    for (var side = -1; side <= 1; side += 2) {
        let beside = at + vec2(0, side);
        if wet(beside) {
            sum += 0.25 * (spread_along_x(beside) - own);
        }
    }
    return own + sum;
}

@compute @workgroup_size(#{GROUP}, #{GROUP})
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let tile = tiles[group.x];
    let at = tile.corner + vec2<i32>(local.xy);
    if !wet(at) {
        return;
    }
    var height = 0.0;
    if numbers.silhouettes > 0u {
        height = raise(at);
    }
    var added = vec4(0.0);
    for (var i = tile.first; i < tile.first + tile.strokes; i++) {
        let stroke = strokes[i];
        let away = place(at) - stroke.middle;
        let variance = stroke.radius * stroke.radius;
        let density = exp(-0.5 * dot(away, away) / variance) / (6.2831853 * variance);
        height += stroke.volume * density;
        added += vec4(stroke.foam, stroke.dye) * density;
    }
    waves[index(at)].x += height;
    matter[index(at)] += added;
}
