// Stage: the clock chooses Δt, and every cell takes a step of it. Cells at the edges of the domain take it as if nothing were
// there; the stage `border` takes it again for them.
//
// An invocation goes down four columns of ROWS cells, and keeps what rows and columns share. The twin is `strip.rs` in
// `freshet_hydro::shallow_water`.
#import freshet::simulation::shallow_water::bindings::{numbers, parity, clock, state, state_out, within, choose_dt}
#import freshet::simulation::shallow_water::cells::{Around, primitive, flux_x, flux_z, update}
#import freshet::simulation::shallow_water::scheme::{Faces, added_to, beyond, reconstruct}

const COLUMNS: i32 = 4;
const ROWS: i32 = #{ROWS};

// Time that the frame adds is owed to the water.
@compute @workgroup_size(1)
fn begin() {
    clock.owed[0] = min(clock.owed[0] + numbers.added, numbers.most_owed);
    clock.steps = 0u;
}

fn tick(dt: f32) {
    let owed = clock.owed[parity.x];
    clock.dt = dt;
    clock.rests[1u - parity.x] = select(0u, 1u, dt <= 0.0);
    clock.owed[1u - parity.x] = select(owed - dt, 0.0, dt >= owed);
    clock.steps += select(0u, 1u, dt > 0.0);
    clock.time = added_to(clock.time, dt);
    clock.rained = added_to(clock.rained, dt * numbers.rain);
    // For the step after the next one: nobody reads or writes this turn's number in the next.
    let kept = atomicLoad(&clock.fastest[parity.x]);
    atomicMax(&clock.fastest[1u - parity.x], select(0u, kept, dt <= 0.0));
}

// Depth, level and velocity of eight cells of a row; the middle four are the invocation's own.
struct Row {
    a: vec4<f32>,
    b: vec4<f32>,
    c: vec4<f32>,
    d: vec4<f32>,
    e: vec4<f32>,
    f: vec4<f32>,
    g: vec4<f32>,
    h: vec4<f32>,
}

fn load_row(first: vec4<i32>, last: vec4<i32>, row: i32) -> Row {
    let base = within(row, numbers.size.y, numbers.periodic.y) * numbers.size.x;
    var cells = Row(
        primitive(base + first.x),
        primitive(base + first.y),
        primitive(base + first.z),
        primitive(base + first.w),
        primitive(base + last.x),
        primitive(base + last.y),
        primitive(base + last.z),
        primitive(base + last.w),
    );
    // The cell behind the western or eastern edge, wherever it is among them.
    let own = first.z;
    let columns = select(numbers.size.x, -1, numbers.periodic.x != 0u || numbers.size.x < 2);
    cells.b = select(cells.b, beyond(cells.c, cells.d), columns > 0 && own == 0);
    cells.d = select(cells.d, beyond(cells.c, cells.b), own + 1 == columns);
    cells.e = select(cells.e, beyond(cells.d, cells.c), own + 2 == columns);
    cells.f = select(cells.f, beyond(cells.e, cells.d), own + 3 == columns);
    cells.g = select(cells.g, beyond(cells.f, cells.e), own + 4 == columns);
    return cells;
}

// The row behind the northern or southern edge.
fn row_beyond(here: Row, next: Row) -> Row {
    return Row(
        here.a,
        beyond(here.b, next.b),
        beyond(here.c, next.c),
        beyond(here.d, next.d),
        beyond(here.e, next.e),
        beyond(here.f, next.f),
        beyond(here.g, next.g),
        here.h,
    );
}

@compute @workgroup_size(#{GROUP_X}, #{GROUP_Z})
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = numbers.size;
    let dt = choose_dt();
    if id.x == 0u && id.y == 0u {
        tick(dt);
    }
    let column = i32(id.x) * COLUMNS;
    let first = i32(id.y) * ROWS;
    if column >= size.x || first >= size.y {
        return;
    }
    let last = min(first + ROWS, size.y);
    if dt > 0.0 {
        go_down(column, first, last, dt);
    } else if clock.rests[parity.x] == 0u {
        stay(column, first, last);
    }
}

// The time that was asked for has been simulated, and more steps than it took may follow: the first of them copies the state, so
// that it is in whichever buffer comes next, and the others do nothing.
fn stay(column: i32, first: i32, last: i32) {
    let size = numbers.size;
    for (var row = first; row < last; row++) {
        for (var k = column; k < min(column + COLUMNS, size.x); k++) {
            state_out[row * size.x + k] = state[row * size.x + k];
        }
    }
}

fn column_within(column: i32) -> i32 {
    return within(column, numbers.size.x, numbers.periodic.x);
}

fn go_down(column: i32, first: i32, last: i32, dt: f32) {
    let size = numbers.size;
    let ratio = dt / numbers.cell;
    let friction = vec2(dt, numbers.drag);
    let left = vec4(column_within(column - 2), column_within(column - 1), column, column_within(column + 1));
    let right = vec4(column_within(column + 2), column_within(column + 3), column_within(column + 4), column_within(column + 5));
    var north = load_row(left, right, first - 2);
    var here = load_row(left, right, first - 1);
    var south = load_row(left, right, first);
    var c = reconstruct(here.c, here.b, here.d, north.c, south.c, ratio, friction);
    var d = reconstruct(here.d, here.c, here.e, north.d, south.d, ratio, friction);
    var e = reconstruct(here.e, here.d, here.f, north.e, south.e, ratio, friction);
    var f = reconstruct(here.f, here.e, here.g, north.f, south.f, ratio, friction);
    var around_c: Around;
    var around_d: Around;
    var around_e: Around;
    var around_f: Around;
    var fastest = 0.0;
    // Whether there is a northern and a southern edge with a slope.
    let ends = numbers.periodic.y == 0u && size.y > 1;
    for (var row = first; row <= last; row++) {
        north = here;
        here = south;
        south = load_row(left, right, row + 1);
        if row == 0 && ends {
            north = row_beyond(here, south);
        }
        if row == size.y - 1 && ends {
            south = row_beyond(here, north);
        }
        let above_c = c;
        let above_d = d;
        let above_e = e;
        let above_f = f;
        c = reconstruct(here.c, here.b, here.d, north.c, south.c, ratio, friction);
        d = reconstruct(here.d, here.c, here.e, north.d, south.d, ratio, friction);
        e = reconstruct(here.e, here.d, here.f, north.e, south.e, ratio, friction);
        f = reconstruct(here.f, here.e, here.g, north.f, south.f, ratio, friction);
        let over = within(row - 1, size.y, numbers.periodic.y) * size.x;
        around_c.south = flux_z(above_c.south, c.north, max(above_c.broken, c.broken), over + left.z);
        around_d.south = flux_z(above_d.south, d.north, max(above_d.broken, d.broken), over + left.w);
        around_e.south = flux_z(above_e.south, e.north, max(above_e.broken, e.broken), over + right.x);
        around_f.south = flux_z(above_f.south, f.north, max(above_f.broken, f.broken), over + right.y);
        if row > first {
            fastest = max(fastest, leave(column, row - 1, above_c, around_c, dt));
            fastest = max(fastest, leave(column + 1, row - 1, above_d, around_d, dt));
            fastest = max(fastest, leave(column + 2, row - 1, above_e, around_e, dt));
            fastest = max(fastest, leave(column + 3, row - 1, above_f, around_f, dt));
        }
        let b = reconstruct(here.b, here.a, here.c, north.b, south.b, ratio, friction);
        let g = reconstruct(here.g, here.f, here.h, north.g, south.g, ratio, friction);
        let own = within(row, size.y, numbers.periodic.y) * size.x;
        let bc = flux_x(b.east, c.west, max(b.broken, c.broken), own + left.y);
        let cd = flux_x(c.east, d.west, max(c.broken, d.broken), own + left.z);
        let de = flux_x(d.east, e.west, max(d.broken, e.broken), own + left.w);
        let ef = flux_x(e.east, f.west, max(e.broken, f.broken), own + right.x);
        let fg = flux_x(f.east, g.west, max(f.broken, g.broken), own + right.y);
        around_c = Around(bc, cd, around_c.south, around_c.south);
        around_d = Around(cd, de, around_d.south, around_d.south);
        around_e = Around(de, ef, around_e.south, around_e.south);
        around_f = Around(ef, fg, around_f.south, around_f.south);
    }
    atomicMax(&clock.fastest[1u - parity.x], bitcast<u32>(fastest));
}

// Writes the new state of a cell, if it is one, and returns its signal; that of a border cell is not known yet.
fn leave(column: i32, row: i32, faces: Faces, around: Around, dt: f32) -> f32 {
    let size = numbers.size;
    if column >= size.x {
        return 0.0;
    }
    let is_border = numbers.periodic.x == 0u && (column == 0 || column == size.x - 1)
        || numbers.periodic.y == 0u && (row == 0 || row == size.y - 1);
    let signal = update(row * size.x + column, faces, around, dt, !is_border);
    return select(signal, 0.0, is_border);
}
