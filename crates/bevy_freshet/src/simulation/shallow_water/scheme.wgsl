// The formulas of the scheme, for one cell or one face: those of `freshet_hydro::shallow_water`, in the same order.
#define_import_path freshet::simulation::shallow_water::scheme

const GRAVITY: f32 = 9.81;      // units: m/s²
const FILM: f32 = 1e-4;         // units: m
const DEEPEST: f32 = 1e6;       // units: m
const FASTEST: f32 = 1e4;       // units: m/s
const CLOSED: f32 = 1e30;       // crest of a face that nothing can pass, units: m
const NO_CREST: f32 = -1e30;

// `value` unless it is NaN or of `limit` and more, else 0.
fn sane(value: f32, limit: f32) -> f32 {
    return select(0.0, value, abs(value) < limit);
}

// A sum (x) and what it cannot hold (y), with `more` (Kahan).
fn added_to(sum: vec2<f32>, more: f32) -> vec2<f32> {
    let change = more + sum.y;
    let total = sum.x + change;
    return vec2(total, change - (total - sum.x));
}

// What turns a discharge (m²/s) into its speed: 1/h, and 2h/(h² + ε²) in films.
fn per_depth(depth: f32) -> f32 {
    let square = depth * depth;
    return 2.0 * depth / (square + max(square, FILM * FILM));
}

// Half the differences across a cell, limited so that neither face overshoots the neighbour there.
fn half_slope(before: vec4<f32>, here: vec4<f32>, after: vec4<f32>) -> vec4<f32> {
    let to_here = here - before;
    let from_here = after - here;
    let central = (1.0 / 3.0) * (to_here + from_here);
    let most = max(min(to_here, from_here), vec4(0.0));
    let least = min(max(to_here, from_here), vec4(0.0));
    return 0.75 * max(min(central, most), least);
}

// The cell behind an edge as it stands for what is there: that at the edge, on a bed that goes on with its slope; but not from a
// bank, where still water would be drawn up.
fn beyond(here: vec4<f32>, next: vec4<f32>) -> vec4<f32> {
    let bed = here.y - here.x;
    let goes_on = bed - (next.y - next.x);
    return vec4(here.x, here.y + select(0.0, goes_on, next.x > 0.0), here.zw);
}

// What a cell shows at its four sides half a step later: depth, level and the velocity along x and z.
struct Faces {
    west: vec4<f32>,
    east: vec4<f32>,
    north: vec4<f32>,
    south: vec4<f32>,
    broken: f32,        // 0…1: 1 in jumps and bores
}

// The cell `c` among its neighbours, each depth, level and velocity; `ratio` is Δt/Δx, and `friction` Δt and g n².
fn reconstruct(c: vec4<f32>, w: vec4<f32>, e: vec4<f32>, n: vec4<f32>, s: vec4<f32>, ratio: f32, friction: vec2<f32>) -> Faces {
    let x = half_slope(w, c, e);
    let z = half_slope(n, c, s);
    // ∂h/∂t = −∇·(h u), ∂u/∂t = −u·∇u − g ∇η over Δt/2, where a slope is half the difference over Δx.
    let risen = -ratio * (c.z * x.x + c.w * z.x + c.x * (x.z + z.w));
    let u = c.z - ratio * (c.z * x.z + c.w * z.z + GRAVITY * x.y);
    let v = c.w - ratio * (c.z * x.w + c.w * z.w + GRAVITY * z.y);
    let kept = slowed_by_friction(c.x, sqrt(c.z * c.z + c.w * c.w), 0.5 * friction.x, friction.y);
    let later = vec4(c.x + risen, c.y + risen, u * kept, v * kept);
    let bed = c.y - c.x;
    let beds = vec4(w.y - w.x, e.y - e.x, n.y - n.x, s.y - s.x);
    let rises = abs(beds - bed);
    let shallow_x = c.x < max(rises.x, rises.y);
    let shallow_z = c.x < max(rises.z, rises.w);
    return Faces(
        side(c, later, -x, beds.x, shallow_x),
        side(c, later, x, beds.y, shallow_x),
        side(c, later, -z, beds.z, shallow_z),
        side(c, later, z, beds.w, shallow_z),
        brokenness(c.x, (w.z - e.z) + (n.w - s.w)),
    );
}

// How broken the water is, where `closing` is the speed at which the neighbours of a cell approach each other.
fn brokenness(depth: f32, closing: f32) -> f32 {
    let approach = max(closing, 0.0);
    let share = approach * approach / (GRAVITY * max(depth, 1e-3));
    return max(min(20.0 * (share - 0.005), 1.0), 0.0);
}

// What a cell shows towards a neighbour whose bed is at `next`. Where it is shallower than the bed's steps the face's bed is kept
// between those of both cells. The bed of a face stays where it is, also where the water would fall below it.
fn side(now: vec4<f32>, later: vec4<f32>, slope: vec4<f32>, next: f32, is_shallow: bool) -> vec4<f32> {
    let bed = now.y - now.x;
    let found = (now.y + slope.y) - (now.x + slope.x);
    let kept = max(min(found, max(bed, next)), min(bed, next));
    let shown = select(found, kept, is_shallow);
    let lift = select(0.0, kept - found, is_shallow);
    let moved = later + slope;
    return vec4(max(moved.x, 0.0), max(moved.y + lift, shown), moved.zw);
}

// What passes a face along its normal. The pressure ½ g h² of each side is left out of `before` and `after`.
struct Flux {
    mass: f32,          // units: m²/s
    before: f32,        // momentum along the normal as the cell before the face gets it, units: m³/s²
    after: f32,         // as the cell after it gets it
    tangential: f32,    // units: m³/s²
}

// Depth, level, normal and tangential velocity.
struct Side {
    depth: f32,
    level: f32,
    normal: f32,
    tangential: f32,
}

fn along_x(at: vec4<f32>) -> Side {
    return Side(at.x, at.y, at.z, at.w);
}

fn along_z(at: vec4<f32>) -> Side {
    return Side(at.x, at.y, at.w, at.z);
}

// Hydrostatic reconstruction (Audusse et al. 2004) with HLLC (Toro 2001), exact within critical fans. Where the water is
// broken shear is smoothed as by HLL, lest jumps grow fingers.
fn riemann(l: Side, r: Side, crest: f32, broken: f32) -> Flux {
    let sill = max(max(l.level - l.depth, r.level - r.depth), crest);
    let hl = max(l.level - sill, 0.0);
    let hr = max(r.level - sill, 0.0);
    let cl = sqrt(GRAVITY * hl);
    let cr = sqrt(GRAVITY * hr);
    // A dry side moves with the front that would run over it: u + 2c.
    let ul = select(r.normal - 2.0 * cr, l.normal, hl > 0.0);
    let ur = select(l.normal + 2.0 * cl, r.normal, hr > 0.0);
    let middle_speed = 0.5 * (ul + ur) + (cl - cr);
    let middle_celerity = max(0.5 * (cl + cr) + 0.25 * (ul - ur), 0.0);
    // Speeds of the heads and tails of the two waves.
    let head_l = ul - cl;
    let tail_l = middle_speed - middle_celerity;
    let tail_r = middle_speed + middle_celerity;
    let head_r = ur + cr;
    let sl = min(min(head_l, tail_l), 0.0);
    let sr = max(max(head_r, tail_r), 0.0);
    let ql = hl * ul;
    let qr = hr * ur;
    let per_width = 1.0 / max(sr - sl, 1e-20);
    let both = sl * sr;
    let pressure = 0.5 * GRAVITY * ((hr - hl) * (hr + hl));
    let mass = (sr * ql - sl * qr + both * (hr - hl)) * per_width;
    let before = (sr * (ql * ul) - sl * (qr * ur + pressure) + both * (qr - ql)) * per_width;

    // Within a fan that opens to both sides of the face the flow is critical, and known exactly.
    let fan_l = head_l < 0.0 && tail_l > 0.0;
    let fan_r = head_r > 0.0 && tail_r < 0.0;
    let speed = select(ur - 2.0 * cr, ul + 2.0 * cl, fan_l) * (1.0 / 3.0);
    let celerity = max(select(-speed, speed, fan_l), 0.0);
    let depth = celerity * celerity * (1.0 / GRAVITY);
    let fan_mass = depth * select(-celerity, celerity, fan_l);
    let fan_before = depth * celerity * celerity + 0.5 * GRAVITY * ((depth - hl) * (depth + hl));
    let is_fan = fan_l || fan_r;
    let passed = select(mass, fan_mass, is_fan);
    let given = select(before, fan_before, is_fan);

    let carried = max(passed, 0.0) * l.tangential + min(passed, 0.0) * r.tangential;
    let smoothed = broken * (both * per_width * min(hl, hr)) * (r.tangential - l.tangential);
    return Flux(passed, given, given - pressure, carried + smoothed);
}

// Momentum that a wall takes from water that comes at it with speed `towards`, beyond the pressure of its depth.
fn wall(depth: f32, towards: f32) -> f32 {
    let celerity = sqrt(GRAVITY * depth);
    let speed = max(max(celerity - towards, celerity + 0.5 * towards), 0.0);
    return depth * towards * (towards + speed);
}

// h^(−1/3) for h > 0.
fn inverse_cube_root(h: f32) -> f32 {
    let guess = bitcast<f32>(0x54a1aa00u - (bitcast<u32>(h) >> 16u) * 0x5555u);
    let r = 1.0 - h * (guess * guess * guess);
    let square = r * r;
    let series = (1.0 / 3.0 + 2.0 / 9.0 * r) + square * ((14.0 / 81.0 + 35.0 / 243.0 * r) + square * (91.0 / 729.0));
    return guess + guess * (r * series);
}

// Share of its discharge that water keeps after `dt` (s) of Manning friction, `drag` being g n².
fn kept_by_friction(depth: f32, discharge: f32, dt: f32, drag: f32) -> f32 {
    let root = inverse_cube_root(max(depth, 1e-6));
    let square = root * root;
    let rate = (square * square) * (square * root) * ((drag * dt) * discharge);
    return 2.0 / (1.0 + sqrt(1.0 + 4.0 * rate));
}

// Share of its speed that water keeps in `dt` (s) of friction, linear in it with that of `speed`.
fn slowed_by_friction(depth: f32, speed: f32, dt: f32, drag: f32) -> f32 {
    let root = inverse_cube_root(max(depth, 1e-6));
    let square = root * root;
    return 1.0 / (1.0 + (square * square) * ((drag * dt) * speed));
}
