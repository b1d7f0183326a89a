// Stage: foam and dye drift, spread, are born and decay, for one step. The twin is `Transport::step` in `freshet_hydro`.
// Without DYE it is foam alone: most waters have no dye, and one number costs much less than four.
#import freshet::simulation::numbers::{numbers, inside, index}

@group(0) @binding(1) var<storage, read> stream: array<vec4<f32>>;              // velocity (m/s), depth (m), births (1/s)
@group(0) @binding(2) var<storage, read> matter: array<vec4<f32>>;              // foam, dye
@group(0) @binding(3) var<storage, read_write> matter_out: array<vec4<f32>>;

#ifdef DYE
alias Matter = vec4<f32>; // foam, dye

fn load(i: u32) -> Matter {
    return matter[i];
}

fn store(i: u32, amount: Matter) {
    matter_out[i] = amount;
}

// What spreads: not foam, which floats.
fn spreading(rise: Matter) -> Matter {
    return vec4(0.0, rise.yzw) * (numbers.spreading / numbers.cell);
}

fn of_foam(foam: f32) -> Matter {
    return vec4(foam, 0.0, 0.0, 0.0);
}

// A step of birth and decay: what is above `rest` is left in part.
fn aged(carried: Matter, rest: f32, left: f32) -> Matter {
    return vec4(rest + (carried.x - rest) * left, carried.yzw * exp(-numbers.dye_decay * numbers.transport_step));
}
#else
alias Matter = f32; // foam

fn load(i: u32) -> Matter {
    return matter[i].x;
}

fn store(i: u32, amount: Matter) {
    matter_out[i] = vec4(amount, 0.0, 0.0, 0.0);
}

fn spreading(rise: Matter) -> Matter {
    return 0.0;
}

fn of_foam(foam: f32) -> Matter {
    return foam;
}

fn aged(carried: Matter, rest: f32, left: f32) -> Matter {
    return rest + (carried - rest) * left;
}
#endif

struct Side {
    matter: Matter,
    speed: f32,         // along the axis, units: m/s
    wet: bool,
    open: bool,         // beyond the water or the window
}

fn side(at: vec2<i32>, axis: vec2<f32>) -> Side {
    if !inside(at) {
        return Side(Matter(0.0), 0.0, false, true);
    }
    let i = index(at);
    let here = stream[i];
    let speed = clamp(dot(here.xy, axis), -numbers.most_speed, numbers.most_speed);
    return Side(load(i), speed, here.z > 0.0, here.z <= numbers.open_below);
}

// Harmonic mean of two differences of one sign, else zero (van Leer 1974).
fn van_leer(a: Matter, b: Matter) -> Matter {
    let product = a * b;
    let some = product > Matter(0.0);
    return select(Matter(0.0), 2.0 * product / select(Matter(1.0), a + b, some), some);
}

// Flux per metre through the face between `low` and `high`, whose outer neighbours are `lower` and `higher`.
fn flux(lower: Side, low: Side, high: Side, higher: Side, usual: Matter) -> Matter {
    if low.wet && high.wet {
        let speed = 0.5 * (low.speed + high.speed);
        let slack = 0.5 * (1.0 - abs(speed) * numbers.transport_step / numbers.cell);
        let rise = high.matter - low.matter;
        let before = select(Matter(0.0), low.matter - lower.matter, lower.wet);
        let after = select(Matter(0.0), higher.matter - high.matter, higher.wet);
        let face = select(
            high.matter - slack * van_leer(after, rise),
            low.matter + slack * van_leer(before, rise),
            speed >= 0.0,
        );
        return face * speed - spreading(rise);
    }
    // Out with what is there, in with what is usual there.
    if low.wet && high.open {
        return low.speed * select(usual, low.matter, low.speed > 0.0);
    }
    if low.open && high.wet {
        return high.speed * select(usual, high.matter, high.speed < 0.0);
    }
    return Matter(0.0);
}

@compute @workgroup_size(#{GROUP}, #{GROUP})
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = vec2<i32>(id.xy);
    if !inside(at) {
        return;
    }
    let i = index(at);
    let here = stream[i];
    if here.z <= 0.0 {
        store(i, Matter(0.0));
        return;
    }
    let fed = here.w * numbers.foam_life;
    let rest = fed / (1.0 + fed);
    let usual = of_foam(rest);
    var gained = Matter(0.0);
    for (var n = 0; n < 2; n++) {
        let axis = vec2(1 - n, n);
        let along = vec2<f32>(axis);
        let lower = side(at - 2 * axis, along);
        let low = side(at - axis, along);
        let own = side(at, along);
        let high = side(at + axis, along);
        let higher = side(at + 2 * axis, along);
        gained += flux(lower, low, own, high, usual) - flux(low, own, high, higher, usual);
    }
    let carried = load(i) + numbers.transport_step / numbers.cell * gained;
    // dm/dt = b (1 − m) − m/T, exactly.
    let left = exp(-(here.w + 1.0 / numbers.foam_life) * numbers.transport_step);
    store(i, aged(carried, rest, left));
}
