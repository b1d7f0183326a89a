// Stage: one step of every cell. An invocation goes down a column of ROWS cells, and keeps what two rows share. The twin is
// `strip.rs` in `freshet_hydro::shallow_water`.
#import freshet::simulation::shallow_water::bindings::{numbers, parity, clock, state, state_out, bed, edges, leaving, extras, given, edge_offsets, within, WALL}
#import freshet::simulation::shallow_water::scheme::{GRAVITY, FILM, DEEPEST, FASTEST, CLOSED, NO_CREST, Faces, Flux, Side, added_to, sane, per_depth, reconstruct, along_x, along_z, riemann, wall, kept_by_friction}

const ROWS: i32 = #{ROWS};

// Depth, level and velocity of five cells of a row around the invocation's column.
struct Row {
    ww: vec4<f32>,
    w: vec4<f32>,
    c: vec4<f32>,
    e: vec4<f32>,
    ee: vec4<f32>,
}

// What flows through the western and eastern face of a cell, and how its own slope pushes it.
struct Across {
    west: Flux,
    east: Flux,
    push: vec2<f32>,    // g h ∇η Δx, units: m²/s²
}

fn primitive(i: i32) -> vec4<f32> {
    let raw = state[i];
    let depth = max(sane(raw.x, DEEPEST), 0.0);
    let factor = per_depth(depth);
    return vec4(depth, depth + bed[i], sane(raw.z * factor, FASTEST), sane(raw.w * factor, FASTEST));
}

// Whether the cell `at` of a side is a wall.
fn is_wall(offset: i32, at: i32) -> bool {
    return edges[offset + at].kind == WALL;
}

fn load_row(column: i32, row: i32) -> Row {
    let size = numbers.size;
    let wraps = numbers.periodic;
    let z = within(row, size.y, wraps.y);
    let base = z * size.x;
    let at = vec4(
        within(column - 2, size.x, wraps.x),
        within(column - 1, size.x, wraps.x),
        within(column + 1, size.x, wraps.x),
        within(column + 2, size.x, wraps.x),
    );
    var cells = Row(
        primitive(base + at.x),
        primitive(base + at.y),
        primitive(base + column),
        primitive(base + at.z),
        primitive(base + at.w),
    );
    let offsets = edge_offsets();
    if wraps.x == 0u && (column < 2 || column >= size.x - 2) {
        // Behind a wall the water comes the other way.
        let west = select(1.0, -1.0, is_wall(offsets.x, z));
        let east = select(1.0, -1.0, is_wall(offsets.y, z));
        cells.ww.z *= select(1.0, west, column < 2);
        cells.w.z *= select(1.0, west, column < 1);
        cells.e.z *= select(1.0, east, column >= size.x - 1);
        cells.ee.z *= select(1.0, east, column >= size.x - 2);
    }
    if wraps.y == 0u && (row < 0 || row >= size.y) {
        let offset = select(offsets.w, offsets.z, row < 0);
        cells.w.w *= select(1.0, -1.0, is_wall(offset, at.y));
        cells.c.w *= select(1.0, -1.0, is_wall(offset, column));
        cells.e.w *= select(1.0, -1.0, is_wall(offset, at.z));
    }
    return cells;
}

fn flux_x(before: vec4<f32>, after: vec4<f32>, column: i32, row: i32) -> Flux {
    if numbers.has_walls == 0u {
        return riemann(along_x(before), along_x(after), NO_CREST);
    }
    let size = numbers.size;
    let i = within(row, size.y, numbers.periodic.y) * size.x + within(column, size.x, numbers.periodic.x);
    return over_crest(along_x(before), along_x(after), extras[i].x);
}

fn flux_z(before: vec4<f32>, after: vec4<f32>, column: i32, row: i32) -> Flux {
    if numbers.has_walls == 0u {
        return riemann(along_z(before), along_z(after), NO_CREST);
    }
    let i = within(row, numbers.size.y, numbers.periodic.y) * numbers.size.x + column;
    return over_crest(along_z(before), along_z(after), extras[i].y);
}

fn over_crest(before: Side, after: Side, crest: f32) -> Flux {
    var flux = riemann(before, after, crest);
    if crest >= CLOSED {
        flux.before += wall(before.depth, before.normal);
        flux.after += wall(after.depth, -after.normal);
    }
    return flux;
}

// Fluxes of the middle cell of `here` along x.
fn across(north: Row, here: Row, south: Row, faces: Faces, column: i32, row: i32, ratio: f32) -> Across {
    let size = numbers.size;
    let west = reconstruct(here.w, here.ww, here.c, north.w, south.w, ratio);
    let east = reconstruct(here.e, here.c, here.ee, north.e, south.e, ratio);
    var result: Across;
    result.west = flux_x(west.east, faces.west, column - 1, row);
    result.east = flux_x(faces.east, east.west, column, row);
    let z = clamp(row, 0, size.y - 1);
    if numbers.periodic.x == 0u && column == 0 {
        let out = leaving[edge_offsets().x + z].flux;
        result.west = Flux(-out.x, 0.0, out.y, -out.z);
    }
    if numbers.periodic.x == 0u && column == size.x - 1 {
        let out = leaving[edge_offsets().y + z].flux;
        result.east = Flux(out.x, out.y, 0.0, out.z);
    }
    result.push = 0.5 * GRAVITY * vec2(
        (faces.west.x + faces.east.x) * (faces.east.y - faces.west.y),
        (faces.north.x + faces.south.x) * (faces.south.y - faces.north.y),
    );
    return result;
}

// The flux along z through the northern face of `row`.
fn northern(before: vec4<f32>, after: vec4<f32>, column: i32, row: i32) -> Flux {
    if numbers.periodic.y == 0u && row == 0 {
        let out = leaving[edge_offsets().z + column].flux;
        return Flux(-out.x, 0.0, out.y, -out.z);
    }
    if numbers.periodic.y == 0u && row == numbers.size.y {
        let out = leaving[edge_offsets().w + column].flux;
        return Flux(out.x, out.y, 0.0, out.z);
    }
    return flux_z(before, after, column, row - 1);
}

// Writes the new state of cell `i`, and returns its |u| + c.
fn update(i: i32, x: Across, north: Flux, south: Flux, dt: f32) -> f32 {
    let ratio = dt / numbers.cell;
    let raw = state[i];
    let depth = max(sane(raw.x, DEEPEST), 0.0);
    let flowed = -ratio * ((x.east.mass - x.west.mass) + (south.mass - north.mass));
    var rate = numbers.rain;
    if numbers.has_sources != 0u {
        rate += extras[i].z;
    }
    // A sink takes no more than there is.
    let added = max(dt * rate, -max(depth + flowed, 0.0));
    // Kahan: what the sum cannot hold is carried to the next step, and so is water that left twice.
    let change = flowed + added + sane(raw.y, DEEPEST);
    let sum = max(depth + change, 0.0);
    let carry = change - (sum - depth);
    if numbers.has_sources != 0u {
        given[i] = added_to(given[i], added);
    }
    let force = vec2(
        (x.east.before - x.west.after) + x.push.x + (south.tangential - north.tangential),
        (south.before - north.after) + x.push.y + (x.east.tangential - x.west.tangential),
    );
    let momentum = vec2(sane(raw.z, DEEPEST * FASTEST), sane(raw.w, DEEPEST * FASTEST)) - ratio * force;
    let factor = per_depth(sum);
    // In a film the discharge follows the reduced speed, so that none is left over when it deepens.
    let film = select(1.0, sum * factor, sum < FILM);
    let size = sqrt(momentum.x * momentum.x + momentum.y * momentum.y);
    let kept = film * kept_by_friction(sum, size, dt, numbers.drag);
    state_out[i] = vec4(sum, carry, momentum * kept);
    return max(abs(momentum.x), abs(momentum.y)) * kept * factor + sqrt(GRAVITY * sum);
}

@compute @workgroup_size(#{GROUP}, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = numbers.size;
    let column = i32(id.x);
    let first = i32(id.y) * ROWS;
    if column >= size.x || first >= size.y {
        return;
    }
    let last = min(first + ROWS, size.y);
    let dt = clock.dt;
    if dt <= 0.0 {
        for (var row = first; row < last; row++) {
            state_out[row * size.x + column] = state[row * size.x + column];
        }
        return;
    }
    let ratio = dt / numbers.cell;
    var north = load_row(column, first - 2);
    var here = load_row(column, first - 1);
    var south = load_row(column, first);
    var faces = reconstruct(here.c, here.w, here.e, north.c, south.c, ratio);
    var before = faces.south;
    var x: Across;
    var entering: Flux;
    var fastest = 0.0;
    for (var row = first; row <= last; row++) {
        north = here;
        here = south;
        south = load_row(column, row + 1);
        faces = reconstruct(here.c, here.w, here.e, north.c, south.c, ratio);
        let northern_flux = northern(before, faces.north, column, row);
        if row > first {
            fastest = max(fastest, update((row - 1) * size.x + column, x, entering, northern_flux, dt));
        }
        x = across(north, here, south, faces, column, row, ratio);
        entering = northern_flux;
        before = faces.south;
    }
    atomicMax(&clock.fastest[1u - parity.x], bitcast<u32>(fastest));
}
