// One cell: what its state says, and its state after a step.
#define_import_path freshet::simulation::shallow_water::cells
#import freshet::simulation::shallow_water::bindings::{numbers, state, state_out, bed, extras, given}
#import freshet::simulation::shallow_water::scheme::{GRAVITY, FILM, DEEPEST, FASTEST, CLOSED, NO_CREST, Faces, Flux, Side, added_to, sane, per_depth, along_x, along_z, riemann, wall, kept_by_friction}

// Depth, level and velocity of cell `i`.
fn primitive(i: i32) -> vec4<f32> {
    let raw = state[i].xyz;
    let depth = max(sane(raw.x, DEEPEST), 0.0);
    let factor = per_depth(depth);
    return vec4(depth, depth + bed[i], sane(raw.y * factor, FASTEST), sane(raw.z * factor, FASTEST));
}

// The flux through the eastern face of cell `i`.
fn flux_x(before: vec4<f32>, after: vec4<f32>, broken: f32, i: i32) -> Flux {
#ifdef WALLS
    return over_crest(along_x(before), along_x(after), extras[i].x, broken);
#else
    return riemann(along_x(before), along_x(after), NO_CREST, broken);
#endif
}

// The flux through the southern face of cell `i`.
fn flux_z(before: vec4<f32>, after: vec4<f32>, broken: f32, i: i32) -> Flux {
#ifdef WALLS
    return over_crest(along_z(before), along_z(after), extras[i].y, broken);
#else
    return riemann(along_z(before), along_z(after), NO_CREST, broken);
#endif
}

fn over_crest(before: Side, after: Side, crest: f32, broken: f32) -> Flux {
    var flux = riemann(before, after, crest, broken);
    let is_closed = crest >= CLOSED;
    flux.before += select(0.0, wall(before.depth, before.normal), is_closed);
    flux.after += select(0.0, wall(after.depth, -after.normal), is_closed);
    return flux;
}

// What flows through the faces of a cell.
struct Around {
    west: Flux,
    east: Flux,
    north: Flux,
    south: Flux,
}

// Writes the new state of cell `i` with these faces, and returns its |u| + c.
//
// What sources give is counted if the cell `counts`.
fn update(i: i32, faces: Faces, around: Around, dt: f32, counts: bool) -> f32 {
    let ratio = dt / numbers.cell;
    let raw = state[i];
    let depth = max(sane(raw.x, DEEPEST), 0.0);
    let flowed = -ratio * ((around.east.mass - around.west.mass) + (around.south.mass - around.north.mass));
    var rate = numbers.rain;
#ifdef SOURCES
    rate += extras[i].z;
#endif
    // A sink takes no more than there is.
    let added = max(dt * rate, -max(depth + flowed, 0.0));
    // Kahan: what the sum cannot hold is carried to the next step, and so is water that left twice.
    let change = flowed + added + sane(raw.w, DEEPEST);
    let sum = max(depth + change, 0.0);
    let carry = change - (sum - depth);
#ifdef SOURCES
    given[i] = added_to(given[i], select(0.0, added - dt * numbers.rain, counts));
#endif
    // g h ∇η Δx
    let push_x = 0.5 * GRAVITY * (faces.west.x + faces.east.x) * (faces.east.y - faces.west.y);
    let push_z = 0.5 * GRAVITY * (faces.north.x + faces.south.x) * (faces.south.y - faces.north.y);
    let force_x = (around.east.before - around.west.after) + push_x + (around.south.tangential - around.north.tangential);
    let force_z = (around.south.before - around.north.after) + push_z + (around.east.tangential - around.west.tangential);
    let momentum = vec2(sane(raw.y, DEEPEST * FASTEST), sane(raw.z, DEEPEST * FASTEST)) - ratio * vec2(force_x, force_z);
    let factor = per_depth(sum);
    // In a film the discharge follows the reduced speed, so that none is left over when it deepens.
    let film = select(1.0, sum * factor, sum < FILM);
    let size = sqrt(momentum.x * momentum.x + momentum.y * momentum.y);
    let kept = film * kept_by_friction(sum, size, dt, numbers.drag);
    state_out[i] = vec4(sum, momentum * kept, carry);
    return max(abs(momentum.x), abs(momentum.y)) * kept * factor + sqrt(GRAVITY * sum);
}
