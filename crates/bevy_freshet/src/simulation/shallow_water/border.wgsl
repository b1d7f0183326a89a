// Stage: cells at the edges of the domain take the step, with what flows out there. The twin is `edge.rs` in
// `freshet_hydro::shallow_water`.
#import freshet::simulation::shallow_water::bindings::{numbers, parity, clock, edges, leaving, Leaving, Edge, within, WALL, OPEN, FAR, LEVEL, DISCHARGE}
#import freshet::simulation::shallow_water::cells::{Around, primitive, flux_x, flux_z, update}
#import freshet::simulation::shallow_water::scheme::{GRAVITY, NO_CREST, Faces, Flux, Side, added_to, beyond, reconstruct, riemann, wall}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = i32(id.x);
    if id.x == 0u {
        // Read by nobody until the next step's cells have been written.
        atomicStore(&clock.fastest[parity.x], 0u);
    }
    if clock.dt > 0.0 && at < 2 * (numbers.size.x + numbers.size.y) {
        take_step(at);
    }
}

// Where edges of the sides begin.
fn offsets() -> vec4<i32> {
    let size = numbers.size;
    return vec4(0, size.y, 2 * size.y, 2 * size.y + size.x);
}

// The cell at the edge `at`.
fn cell_at(at: i32) -> vec2<i32> {
    let size = numbers.size;
    let begins = offsets();
    if at >= begins.w {
        return vec2(at - begins.w, size.y - 1);
    } else if at >= begins.z {
        return vec2(at - begins.z, 0);
    } else if at >= begins.y {
        return vec2(size.x - 1, at - begins.y);
    }
    return vec2(0, at);
}

fn index(cell: vec2<i32>) -> i32 {
    let size = numbers.size;
    return within(cell.y, size.y, numbers.periodic.y) * size.x + within(cell.x, size.x, numbers.periodic.x);
}

// The cell beside `cell` in the direction `to`, or what stands for it behind an edge.
fn beside(cell: vec2<i32>, to: vec2<i32>) -> vec4<f32> {
    let size = numbers.size;
    let there = cell + to;
    let wraps = select(numbers.periodic.y, numbers.periodic.x, to.x != 0) != 0u;
    let count = select(size.y, size.x, to.x != 0);
    let is_inside = all(there >= vec2(0)) && all(there < size);
    if is_inside || wraps || count < 2 {
        return primitive(index(there));
    }
    return beyond(primitive(index(cell)), primitive(index(cell - to)));
}

fn faces_of(cell: vec2<i32>, dt: f32) -> Faces {
    return reconstruct(
        primitive(index(cell)),
        beside(cell, vec2(-1, 0)),
        beside(cell, vec2(1, 0)),
        beside(cell, vec2(0, -1)),
        beside(cell, vec2(0, 1)),
        dt / numbers.cell,
        vec2(dt, numbers.drag),
    );
}

// The side `at` begins with: 0 west, 1 east, 2 north, 3 south.
fn side_of(at: i32) -> u32 {
    let begins = offsets();
    return select(0u, 1u, at >= begins.y) + select(0u, 1u, at >= begins.z) + select(0u, 1u, at >= begins.w);
}

fn take_step(at: i32) {
    let size = numbers.size;
    let dt = clock.dt;
    let cell = cell_at(at);
    let side = side_of(at);
    let open_x = numbers.periodic.x == 0u;
    let open_z = numbers.periodic.y == 0u;
    if (side < 2u && !open_x) || (side >= 2u && !open_z) {
        return;
    }
    let i = index(cell);
    let faces = faces_of(cell, dt);
    var around: Around;
    if open_x && cell.x == 0 {
        let out = edge_flux(Side(faces.west.x, faces.west.y, -faces.west.z, faces.west.w), edges[cell.y]);
        around.west = Flux(-out.mass, 0.0, out.before, -out.tangential);
        keep(side == 0u, at, out, dt);
    } else {
        let there = faces_of(cell + vec2(-1, 0), dt);
        around.west = flux_x(there.east, faces.west, max(there.broken, faces.broken), index(cell + vec2(-1, 0)));
    }
    if open_x && cell.x == size.x - 1 {
        around.east = edge_flux(Side(faces.east.x, faces.east.y, faces.east.z, faces.east.w), edges[offsets().y + cell.y]);
        keep(side == 1u, at, around.east, dt);
    } else {
        let there = faces_of(cell + vec2(1, 0), dt);
        around.east = flux_x(faces.east, there.west, max(faces.broken, there.broken), i);
    }
    if open_z && cell.y == 0 {
        let out = edge_flux(Side(faces.north.x, faces.north.y, -faces.north.w, faces.north.z), edges[offsets().z + cell.x]);
        around.north = Flux(-out.mass, 0.0, out.before, -out.tangential);
        keep(side == 2u, at, out, dt);
    } else {
        let there = faces_of(cell + vec2(0, -1), dt);
        around.north = flux_z(there.south, faces.north, max(there.broken, faces.broken), index(cell + vec2(0, -1)));
    }
    if open_z && cell.y == size.y - 1 {
        around.south = edge_flux(Side(faces.south.x, faces.south.y, faces.south.w, faces.south.z), edges[offsets().w + cell.x]);
        keep(side == 3u, at, around.south, dt);
    } else {
        let there = faces_of(cell + vec2(0, 1), dt);
        around.south = flux_z(faces.south, there.north, max(faces.broken, there.broken), i);
    }
    // A corner belongs to its western or eastern side, and a cell at both to the western one.
    let is_last = side == 1u && cell.x == 0 || side >= 2u && open_x && (cell.x == 0 || cell.x == size.x - 1);
    let is_again = is_last || side == 3u && cell.y == 0;
    if !is_again {
        let signal = update(i, faces, around, dt, true);
        atomicMax(&clock.fastest[1u - parity.x], bitcast<u32>(signal));
    }
}

// Counts what leaves through the side that the invocation is for.
fn keep(is_own: bool, at: i32, flux: Flux, dt: f32) {
    if is_own {
        leaving[at] = Leaving(added_to(leaving[at].sum, flux.mass * dt));
    }
}

// What flows out through an edge; the normal velocity `at` its inner side points outwards.
fn edge_flux(at: Side, edge: Edge) -> Flux {
    let kind = edge.kind;
    let value = edge.value;
    let ground = at.level - at.depth;
    let celerity = sqrt(GRAVITY * at.depth);
    if kind == OPEN && at.normal > 0.0 {
        return through(at, at.depth, at.normal);
    } else if kind == WALL || kind == OPEN {
        return Flux(0.0, wall(at.depth, at.normal), 0.0, 0.0);
    } else if kind == FAR {
        return riemann(at, Side(max(value - ground, 0.0), max(value, ground), -edge.entering, 0.0), NO_CREST, 0.0);
    } else if kind == LEVEL {
        if at.normal >= celerity && at.depth > 0.0 {
            // Faster than its waves: no news of the outside can enter.
            return through(at, at.depth, at.normal);
        }
        let depth = max(value - ground, 0.0);
        let outside = sqrt(GRAVITY * depth);
        // The outgoing invariant u + 2c is that of the inside; inflow is critical at most.
        let normal = at.normal + 2.0 * (celerity - outside);
        return through(at, depth, clamp(normal, -outside, max(outside, at.normal)));
    } else if value > 0.0 {
        let entering = celerity_from_discharge(at, value);
        return through(at, entering * entering / GRAVITY, -value * GRAVITY / (entering * entering));
    }
    // Water that is asked for and not there cannot leave.
    let taken = min(-value, at.depth * (max(at.normal, 0.0) + celerity));
    return through(at, at.depth, taken / max(at.depth, 1e-6));
}

// Celerity c at an edge through which q > 0 flows in: 2 c³ − (u + 2c)ᵢₙ c² − g q = 0, critical at least.
fn celerity_from_discharge(at: Side, entering: f32) -> f32 {
    let invariant = at.normal + 2.0 * sqrt(GRAVITY * at.depth);
    let power = GRAVITY * entering;
    var celerity = 0.5 * max(invariant, 0.0) + pow(0.5 * power, 1.0 / 3.0);
    for (var n = 0; n < 8; n++) {
        let square = celerity * celerity;
        let residual = 2.0 * square * celerity - invariant * square - power;
        let slope = 6.0 * square - 2.0 * invariant * celerity;
        celerity -= residual / max(slope, 1e-20);
    }
    return max(celerity, pow(power, 1.0 / 3.0));
}

// The flux of water `depth` deep that leaves with the speed `normal`.
fn through(at: Side, depth: f32, normal: f32) -> Flux {
    let mass = depth * normal;
    let pressure = 0.5 * GRAVITY * ((depth - at.depth) * (depth + at.depth));
    return Flux(mass, mass * normal + pressure, 0.0, max(mass, 0.0) * at.tangential);
}
