// What all stages of the shallow water bind.
#define_import_path freshet::simulation::shallow_water::bindings

struct Numbers {
    size: vec2<i32>,            // columns and rows
    periodic: vec2<u32>,
    cell: f32,                  // Δx, units: m
    courant: f32,
    drag: f32,                  // g n²
    rain: f32,                  // units: m/s
    added: f32,                 // time that this frame adds, units: s
    most_owed: f32,             // time that may be owed, units: s
    entering: f32,              // fastest signal that may enter at the edges, units: m/s
    longest: f32,               // longest step that the sources allow, units: s
}

// The clock. Of two values one is read and the other written, in turns, so that no invocation reads what another writes.
struct Clock {
    fastest: array<atomic<u32>, 2>,     // |u| + c as bits, units: m/s
    owed: array<f32, 2>,                // time that no step has used yet, units: s
    rests: array<u32, 2>,               // 1 after a step of no time: both states are the same
    dt: f32,                            // of the newest step, units: s
    steps: u32,
    time: vec2<f32>,                    // time that has been simulated, and what the first number cannot hold, units: s
    rained: vec2<f32>,                  // depth of rain that has fallen, likewise, units: m
}

// What is outside a cell of a side.
struct Edge {
    kind: u32,
    value: f32,
    entering: f32,      // speed inwards of the water outside, units: m/s
}

// What a body does to the water of a cell.
struct Push {
    cell: u32,
    strength: f32,      // ½ C D/L
    velocity: vec2<f32>,    // of the body, units: m/s
    force: vec2<f32>,       // on the water, per area and density, units: m²/s²
}

// A cell whose bed bodies raise, or have left.
struct Raised {
    cell: u32,
    bed: f32,           // units: m
}

// What flows out of the domain through a cell of a side.
struct Leaving {
    sum: vec2<f32>,     // volume per width so far, and what the first number cannot hold, units: m²
}

@group(0) @binding(0) var<uniform> numbers: Numbers;
@group(0) @binding(1) var<uniform> parity: vec4<u32>;                           // 0 or 1: which value of a pair is read
@group(0) @binding(2) var<storage, read_write> clock: Clock;
@group(0) @binding(3) var<storage, read> state: array<vec4<f32>>;               // depth (m), discharge (m²/s), carry (m)
@group(0) @binding(4) var<storage, read_write> state_out: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> bed: array<f32>;                       // units: m
@group(0) @binding(6) var<storage, read> edges: array<Edge>;                    // of the western, eastern, northern, southern side
@group(0) @binding(7) var<storage, read_write> leaving: array<Leaving>;         // through the same cells
@group(0) @binding(8) var<storage, read> extras: array<vec4<f32>>;              // crests of the eastern and southern face (m), source (m/s)
@group(0) @binding(9) var<storage, read_write> given: array<vec2<f32>>;         // depth that sources gave beside rain, and its carry, units: m

const WALL: u32 = 0u;
const OPEN: u32 = 1u;
const FAR: u32 = 2u;
const LEVEL: u32 = 3u;
const DISCHARGE: u32 = 4u;

// The column or row inside the domain that stands for one that may be outside.
fn within(at: i32, count: i32, wraps: u32) -> i32 {
    let inside = clamp(at, 0, count - 1);
    let wrapped = (at + 2 * count) % count;
    return select(inside, wrapped, wraps != 0u && at != inside);
}

// Δt, s: the Courant number's, no more than is owed, and such that what is left needs no tiny step. 0 if nothing is owed.
fn choose_dt() -> f32 {
    let owed = clock.owed[parity.x];
    let fastest = bitcast<f32>(atomicLoad(&clock.fastest[parity.x]));
    let signal = numbers.courant * numbers.cell / max(max(fastest, numbers.entering), 1e-20);
    let longest = min(signal, numbers.longest);
    let steps = max(ceil(owed / longest), 1.0);
    return select(owed / steps, longest, steps > 2.0);
}
