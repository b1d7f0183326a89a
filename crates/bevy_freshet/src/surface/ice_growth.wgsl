// How thick ice grows, and what light does in it; the Rust twin is `freshet_hydro::ice`.
#define_import_path freshet::surface::ice_growth

const LAST: f32 = 0.8;       // part of the winter after which the last place begins to freeze
const CLOSED: f32 = 0.02;    // thickness of a closed cover, units: m
const SETTLED: f32 = 0.12;   // thickness that carries all the snow, units: m
const AIR_FILM: f32 = 0.1;   // conductivity of ice over the heat transfer to the air, units: m

// Thickness, m, at a place of the given `order`: h = √(b² + s ((h_max + b)² − b²)) − b, s = freezing − LAST · order.
fn thickness(order: f32, freezing: f32, thickest: f32) -> f32 {
    let spent = max(freezing - LAST * order, 0.0);
    let end = thickest + AIR_FILM;
    return sqrt(AIR_FILM * AIR_FILM + spent * (end * end - AIR_FILM * AIR_FILM)) - AIR_FILM;
}

// Share of the water's surface that ice of `thickness` has taken.
fn cover(thickness: f32) -> f32 {
    return smoothstep(0.0, CLOSED, thickness);
}

// Share of the fallen snow that lies on ice of `thickness`.
fn settled(thickness: f32) -> f32 {
    return smoothstep(CLOSED, SETTLED, thickness);
}

// Diffuse light at a layer: what comes back and what comes through.
struct Layer {
    reflectance: vec3<f32>,
    transmittance: vec3<f32>,
}

// Kubelka and Munk: with γ = √(K (K + 2S)), K = 2a and w = tanh(γh)/γ,
// R = S w / (1 + (K + S) w), T = sech(γh) / (1 + (K + S) w).
fn layer(absorption: vec3<f32>, scattering: f32, thickness: f32) -> Layer {
    let k = 2.0 * absorption;
    let gamma = max(sqrt(k * (k + 2.0 * scattering)), vec3(1e-4));
    let decay = exp(-gamma * thickness);
    let sech = 2.0 * decay / (1.0 + decay * decay);
    let way = (1.0 - decay * decay) / (1.0 + decay * decay) / gamma;
    let d = 1.0 + (k + scattering) * way;
    return Layer(scattering * way / d, sech / d);
}
