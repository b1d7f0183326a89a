// Stage: pictures of the water for the surface's shader. The twins are `Field` in `freshet_hydro::shallow_water`, and `Moment` in `freshet_flood`.
#ifdef PLAYED
#import freshet::simulation::shallow_water::played::{numbers, primitive}
#else
#import freshet::simulation::shallow_water::bindings::{numbers, state, bed, extras}
#import freshet::simulation::shallow_water::cells::primitive
#endif

@group(1) @binding(0) var picture: texture_storage_2d<rgba32float, write>;  // level, depth (m), velocity (m/s); see `dry`
@group(1) @binding(1) var slopes: texture_storage_2d<rgba16float, write>;   // slope of the level; 1 where a wall stands above it in the east and south

const WET: f32 = 1e-3; // units: m
const EAST: vec2<i32> = vec2(1, 0);
const SOUTH: vec2<i32> = vec2(0, 1);

// Invocations along a side of a workgroup, and cells along that of its tile: those beside its own belong to it.
const GROUP: i32 = 8;
const TILE: i32 = GROUP + 2;

// Depth, level and velocity of the cells of a workgroup, each worked out once.
var<workgroup> tile: array<vec4<f32>, TILE * TILE>;
// The north-western cell of the tile.
var<private> corner: vec2<i32>;

fn fill_tile(first: u32) {
    for (var k = i32(first); k < TILE * TILE; k += GROUP * GROUP) {
        let at = clamp(corner + vec2(k % TILE, k / TILE), vec2(0), numbers.size - 1);
#ifdef PLAYED
        tile[k] = primitive(at);
#else
        tile[k] = primitive(at.y * numbers.size.x + at.x);
#endif
    }
    workgroupBarrier();
}

// Depth, level and velocity of a cell of the tile.
fn cell_at(at: vec2<i32>) -> vec4<f32> {
    let within = at - corner;
    return tile[within.y * TILE + within.x];
}

// Whether a wall stands above the water between cell `at` and the one `to` its east (1, 0) or south (0, 1).
fn has_wall(at: vec2<i32>, to: vec2<i32>) -> bool {
#ifdef WALLS
    if all(at >= vec2(0)) && all(at + to < numbers.size) {
        let i = at.y * numbers.size.x + at.x;
        return select(extras[i].y, extras[i].x, to.x > 0) >= max(cell_at(at).y, cell_at(at + to).y);
    }
#endif
    return false;
}

// The level of a cell as it counts beside water at `level`: a dry cell above it is a bank, one below it is ground towards which
// a front falls.
fn beside(level: f32, at: vec2<i32>) -> f32 {
    if any(at < vec2(0)) || any(at >= numbers.size) {
        return level;
    }
    let there = cell_at(at);
    return select(min(there.y, level), there.y, there.x > WET);
}

// The level of the cell `there`, across the face that `cell` has `to` its east or south, beside water at `level`.
fn across(level: f32, cell: vec2<i32>, there: vec2<i32>, to: vec2<i32>) -> f32 {
    if has_wall(cell, to) {
        return level;
    }
    return beside(level, there);
}

// A dry cell: its level and depth, the level of wet cells around it, and 1 if there are any. So the surface goes on under a bank.
fn dry(at: vec2<i32>, here: vec2<f32>) -> vec4<f32> {
    var level = 0.0;
    var count = 0.0;
    for (var k = 0; k < 9; k++) {
        let there = at + vec2(k % 3, k / 3) - 1;
        if all(there >= vec2(0)) && all(there < numbers.size) {
            let cell = cell_at(there);
            level += select(0.0, cell.y, cell.x > WET);
            count += select(0.0, 1.0, cell.x > WET);
        }
    }
    return vec4(here, level / max(count, 1.0), min(count, 1.0));
}

@compute @workgroup_size(8, 8)
fn main(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) first: u32,
) {
    let at = vec2<i32>(id.xy);
    corner = vec2<i32>(group.xy) * GROUP - 1;
    fill_tile(first);
    if any(at >= numbers.size) {
        return;
    }
    let here = cell_at(at);
    var shown = vec4(here.y, here.x, here.zw);
    var steep = vec2(0.0);
    if here.x <= WET {
        shown = dry(at, shown.xy);
    } else {
        let east = across(here.y, at, at + EAST, EAST);
        let west = across(here.y, at - EAST, at - EAST, EAST);
        let south = across(here.y, at, at + SOUTH, SOUTH);
        let north = across(here.y, at - SOUTH, at - SOUTH, SOUTH);
        steep = vec2(east - west, south - north) / (2.0 * numbers.cell);
    }
    textureStore(picture, at, shown);
    let walls = select(vec2(0.0), vec2(1.0), vec2(has_wall(at, EAST), has_wall(at, SOUTH)));
    textureStore(slopes, at, vec4(steep, walls));
}
