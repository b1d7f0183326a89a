// Colours for inspection; `views.rs` says how to read them.
#define_import_path freshet::surface::views

#import freshet::surface::bindings::surface
#import freshet::surface::mesh
#import freshet::surface::types
#import freshet::surface::water

// Speed at which the colour of the current is brightest, m/s.
const FULL_SPEED: f32 = 2.0;

// units: m/s²
const GRAVITY: f32 = 9.81;

// Pixels across the tile of an arrow, at least, where the water is seen most sharply.
const ARROW_PIXELS: f32 = 24.0;

// The velocity of the water where map or simulation say `current`, both local xz, m/s.
fn velocity(current: vec2<f32>) -> vec2<f32> {
    return surface.current_drift + current;
}

// The fully saturated colour at `turn` (0…1) around the wheel: red, yellow, green, cyan, blue, magenta.
fn hue(turn: f32) -> vec3<f32> {
    return clamp(abs(fract(turn + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, vec3(0.0), vec3(1.0));
}

// Direction as hue, from east (+x) over south (+z); speed as brightness; an arrow in every tile.
fn flow(place: vec2<f32>, current: vec2<f32>, pixel_size: f32) -> vec3<f32> {
    let towards = velocity(current);
    let speed = length(towards);
    let color = hue(atan2(towards.y, towards.x) / 6.2831853) * min(speed / FULL_SPEED, 1.0);
    return mix(color, vec3(1.0), arrow(place, pixel_size));
}

// Share of a pixel that the arrow of its tile covers. Tiles measure a power of two, so that they stay where they are while
// the eye comes closer; arrows are as long as the water flows fast, up to their tile.
fn arrow(place: vec2<f32>, pixel_size: f32) -> f32 {
    let tile = exp2(ceil(log2(max(pixel_size, 1e-4) * ARROW_PIXELS)));
    let center = (floor(place / tile) + 0.5) * tile;
    let towards = velocity(water::at(center).current);
    let speed = length(towards);
    if speed < 1e-3 {
        return 0.0;
    }
    let along = towards / speed;
    let from_center = (place - center) / tile;
    let p = vec2(dot(from_center, along), along.x * from_center.y - along.y * from_center.x);
    let half_length = mix(0.15, 0.45, min(speed / FULL_SPEED, 1.0));
    // A shaft, and a head of half its length that narrows to the tip.
    let head = half_length - p.x;
    let shaft = max(abs(p.y) - 0.02, max(-half_length - p.x, p.x - half_length));
    let tip = max(abs(p.y) - 0.35 * head, max(-head, head - 0.6 * half_length));
    let distance = min(shaft, tip) * tile / max(pixel_size, 1e-4);
    return clamp(0.5 - distance, 0.0, 1.0);
}

// Depth by colour: red 0, yellow 1, green 3, cyan 7, blue 15, black 31 m and more; between these by log₂(1 + depth).
fn depth(still_depth: f32) -> vec3<f32> {
    let step = min(log2(1.0 + max(still_depth, 0.0)), 5.0);
    if step < 4.0 {
        return hue(step / 6.0);
    }
    return vec3(0.0, 0.0, 5.0 - step);
}

// Speed of the water over that of long waves.
fn froude(current: vec2<f32>, still_depth: f32) -> f32 {
    return length(velocity(current)) / sqrt(GRAVITY * max(still_depth, 1e-3));
}

// The colour of a number on the scale of the view.
fn scaled(value: f32) -> vec3<f32> {
    return even_color(clamp((value - surface.view_range.x) * surface.view_range.y, 0.0, 1.0));
}

// The colour at `share` of a scale: lightness and hue of Oklab go evenly. The twin is `ViewScale::color` in `scale.rs`.
fn even_color(share: f32) -> vec3<f32> {
    let lightness = 0.4 + 0.52 * share;
    let turn = radians(310.0 - 200.0 * share);
    let ab = 0.11 * vec2(cos(turn), sin(turn));
    let roots = lightness + vec3(
        dot(ab, vec2(0.39633778, 0.21580376)),
        dot(ab, vec2(-0.105561346, -0.06385417)),
        dot(ab, vec2(-0.08948418, -1.2914855)),
    );
    let cones = roots * roots * roots;
    return vec3(
        dot(cones, vec3(4.0767417, -3.3077116, 0.23096994)),
        dot(cones, vec3(-1.268438, 2.6097574, -0.3413194)),
        dot(cones, vec3(-0.0041960863, -0.7034186, 1.7076147)),
    );
}

// Share of a pixel that the edges of the mesh's triangles cover, see `nested_grid`: the grid lines of the ring, and the
// diagonals towards +x +z. Where cells are too small to be told apart the lines fade.
fn wire(place: vec2<f32>, pixel_size: f32) -> f32 {
    let from_center = place - surface.mesh_center;
    let cell = mesh::cell_at(from_center);
    let p = fract(from_center / cell);
    let to_grid = min(min(p.x, 1.0 - p.x), min(p.y, 1.0 - p.y));
    // The diagonal runs from the corner of the least x and z to that of the greatest.
    let to_diagonal = abs(p.x - p.y) * 0.70710678;
    let pixels = min(to_grid, to_diagonal) * cell / max(pixel_size, 1e-6);
    return clamp(1.0 - pixels, 0.0, 1.0) * smoothstep(3.0, 8.0, cell / max(pixel_size, 1e-6));
}
