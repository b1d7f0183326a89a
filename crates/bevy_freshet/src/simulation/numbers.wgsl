// What the stages of the simulated fields need to know. The Rust twin is `GpuNumbers` in `numbers.rs`.
#define_import_path freshet::simulation::numbers

struct Numbers {
    size: vec2<u32>,            // cells of the window
    shift: vec2<i32>,           // by how many cells the window moved since the fields were last worked on
    origin: vec2<f32>,          // north-west corner of the window, local xz, units: m
    drift: vec2<f32>,           // uniform part of the current, local xz, units: m/s
    absorbs: vec4<f32>,         // 1 where the western, eastern, northern, southern rim absorbs rings, 0 where it is a wall
    cell: f32,                  // units: m
    open_below: f32,            // still depth below which a cell lies beyond the water, units: m
    silhouettes: u32,           // cells that bodies cover

    wavenumber: f32,            // of the rings, units: rad/m
    deep_celerity: f32,         // c² of the rings in deep water, g/k, units: m²/s²
    most_celerity: f32,         // largest c² that the step can carry, units: m²/s²
    ring_step: f32,             // units: s
    ring_decay: f32,            // 1/τ, units: 1/s
    rim_width: f32,             // cells
    rim_decay: f32,             // rate at the outer end of an absorbing rim for a celerity of one, units: 1/m

    transport_step: f32,        // units: s
    most_speed: f32,            // largest speed along an axis that the step can carry, units: m/s
    spreading: f32,             // diffusivity of dye, units: m²/s
    dye_decay: f32,             // units: 1/s
    dye_mixing: f32,            // depth over which dye mixes at most, units: m

    foam_life: f32,             // units: s
    calm_shore: f32,            // share of the shore's foam that is born without waves
    shore: f32,                 // birth rates as in `freshet_hydro::fields::foam::FoamSources`
    shore_depth: f32,
    shear: f32,
    shear_threshold: f32,
    breaking: f32,
    breaking_threshold: f32,
    speed: f32,
    speed_threshold: f32,
    bodies: f32,
}

@group(0) @binding(0) var<uniform> numbers: Numbers;

fn inside(at: vec2<i32>) -> bool {
    return all(at >= vec2(0)) && all(at < vec2<i32>(numbers.size));
}

// Where the cell at column and row `at` is stored.
fn index(at: vec2<i32>) -> u32 {
    return u32(at.y) * numbers.size.x + u32(at.x);
}

// Local xz of the middle of a cell, m.
fn place(at: vec2<i32>) -> vec2<f32> {
    return numbers.origin + (vec2<f32>(at) + 0.5) * numbers.cell;
}
