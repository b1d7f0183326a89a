// Stage: the clock chooses Δt, and every cell of the sides says what flows out there. The twin is `edge.rs` in
// `freshet_hydro::shallow_water`.
#import freshet::simulation::shallow_water::bindings::{numbers, parity, clock, state, bed, edges, leaving, Leaving, edge_offsets, within, WALL, OPEN, STILL, LEVEL, DISCHARGE}
#import freshet::simulation::shallow_water::scheme::{GRAVITY, DEEPEST, FASTEST, NO_CREST, Flux, Side, added_to, sane, per_depth, reconstruct, riemann, wall}

// Time that the frame adds is owed to the water.
@compute @workgroup_size(1)
fn begin() {
    clock.owed[0] = min(clock.owed[0] + numbers.added, numbers.most_owed);
    clock.steps = 0u;
}

// Δt, s: the Courant number's, no more than is owed, and such that what is left needs no tiny step.
fn choose_dt(owed: f32) -> f32 {
    let fastest = bitcast<f32>(atomicLoad(&clock.fastest[parity.x]));
    let signal = numbers.courant * numbers.cell / max(max(fastest, numbers.entering), 1e-20);
    let longest = min(signal, numbers.longest);
    let steps = max(ceil(owed / longest), 1.0);
    return select(owed / steps, longest, steps > 2.0);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let dt = choose_dt(clock.owed[parity.x]);
    if id.x == 0u {
        tick(dt);
    }
    let count = 2 * (numbers.size.x + numbers.size.y);
    if i32(id.x) < count && dt > 0.0 {
        leave(i32(id.x), dt);
    }
}

fn tick(dt: f32) {
    let owed = clock.owed[parity.x];
    clock.dt = dt;
    clock.owed[1u - parity.x] = select(owed - dt, 0.0, dt >= owed);
    atomicStore(&clock.fastest[1u - parity.x], select(0u, atomicLoad(&clock.fastest[parity.x]), dt <= 0.0));
    clock.steps += select(0u, 1u, dt > 0.0);
    clock.time = added_to(clock.time, dt);
    clock.rained = added_to(clock.rained, dt * numbers.rain);
}

// The cell, the direction out of it, and the edge of the side's cell `at`.
fn leave(at: i32, dt: f32) {
    let size = numbers.size;
    let offsets = edge_offsets();
    var cell = vec2(0, at);
    var out = vec2(-1, 0);
    if at >= offsets.w {
        cell = vec2(at - offsets.w, size.y - 1);
        out = vec2(0, 1);
    } else if at >= offsets.z {
        cell = vec2(at - offsets.z, 0);
        out = vec2(0, -1);
    } else if at >= offsets.y {
        cell = vec2(size.x - 1, at - offsets.y);
        out = vec2(1, 0);
    }
    let flux = edge_flux(inside(cell, out, dt / numbers.cell), edges[at].kind, edges[at].value);
    leaving[at] = Leaving(vec3(flux.mass, flux.before, flux.tangential), added_to(leaving[at].sum, flux.mass * dt));
}

// The side of the `cell` towards `out`, whose normal velocity points outwards.
fn inside(cell: vec2<i32>, out: vec2<i32>, ratio: f32) -> Side {
    let c = load(cell);
    let faces = reconstruct(
        c,
        load(cell + vec2(-1, 0)),
        load(cell + vec2(1, 0)),
        load(cell + vec2(0, -1)),
        load(cell + vec2(0, 1)),
        ratio,
    );
    if out.x < 0 {
        return Side(faces.west.x, faces.west.y, -faces.west.z, faces.west.w);
    } else if out.x > 0 {
        return Side(faces.east.x, faces.east.y, faces.east.z, faces.east.w);
    } else if out.y < 0 {
        return Side(faces.north.x, faces.north.y, -faces.north.w, faces.north.z);
    }
    return Side(faces.south.x, faces.south.y, faces.south.w, faces.south.z);
}

fn load(at: vec2<i32>) -> vec4<f32> {
    let size = numbers.size;
    let cell = vec2(within(at.x, size.x, numbers.periodic.x), within(at.y, size.y, numbers.periodic.y));
    let i = cell.y * size.x + cell.x;
    let raw = state[i];
    let depth = max(sane(raw.x, DEEPEST), 0.0);
    let factor = per_depth(depth);
    var velocity = vec2(sane(raw.z * factor, FASTEST), sane(raw.w * factor, FASTEST));
    let offsets = edge_offsets();
    let beyond_x = (at.x < 0 || at.x >= size.x) && numbers.periodic.x == 0u;
    if beyond_x && edges[select(offsets.y, offsets.x, at.x < 0) + cell.y].kind == WALL {
        velocity.x = -velocity.x;
    }
    let beyond_z = (at.y < 0 || at.y >= size.y) && numbers.periodic.y == 0u;
    if beyond_z && edges[select(offsets.w, offsets.z, at.y < 0) + cell.x].kind == WALL {
        velocity.y = -velocity.y;
    }
    return vec4(depth, depth + bed[i], velocity);
}

fn edge_flux(at: Side, kind: u32, value: f32) -> Flux {
    let ground = at.level - at.depth;
    let celerity = sqrt(GRAVITY * at.depth);
    if kind == OPEN && at.normal > 0.0 {
        return through(at, at.depth, at.normal);
    } else if kind == WALL || kind == OPEN {
        return Flux(0.0, wall(at.depth, at.normal), 0.0, 0.0);
    } else if kind == STILL {
        return riemann(at, Side(max(value - ground, 0.0), max(value, ground), 0.0, 0.0), NO_CREST);
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
