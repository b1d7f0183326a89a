// Stage: the still water and its current on the cells. Runs when window, bed, level or current change.
#import freshet::simulation::numbers::{numbers, inside, index, place}
#import freshet::surface::bindings::surface
#import freshet::surface::water

@group(0) @binding(1) var<storage, read_write> ground: array<vec4<f32>>;    // current (m/s), depth (m), foam born by deformation (1/s)
@group(0) @binding(2) var<storage, read_write> celerity: array<f32>;        // c² of the rings, m²/s²; 0 where it is dry

// Beyond the water's rectangle there is as little water as where the bed has no data.
fn depth_within(at: vec2<f32>, depth: f32) -> f32 {
    return select(-1e6, depth, all(abs(at) <= surface.half_size));
}

fn current_at(at: vec2<f32>) -> vec2<f32> {
    return numbers.drift + water::at(at).current;
}

@compute @workgroup_size(#{GROUP}, #{GROUP})
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = vec2<i32>(id.xy);
    if !inside(at) {
        return;
    }
    let middle = place(at);
    let here = water::at(middle);
    let depth = depth_within(middle, here.depth);
    let step = numbers.cell;
    let along_x = (current_at(middle + vec2(step, 0.0)) - current_at(middle - vec2(step, 0.0))) / (2.0 * step);
    let along_z = (current_at(middle + vec2(0.0, step)) - current_at(middle - vec2(0.0, step))) / (2.0 * step);
    let shear = length(vec2(along_x.x - along_z.y, along_z.x + along_x.y));
    let convergence = -(along_x.x + along_z.y);
    let births = numbers.shear * max(shear - numbers.shear_threshold, 0.0)
        + numbers.breaking * max(convergence - numbers.breaking_threshold, 0.0);
    ground[index(at)] = vec4(numbers.drift + here.current, depth, births);
    // c² = (g/k) tanh(k d); beyond k d = 10 the water is deep to the last digit.
    let relative = clamp(numbers.wavenumber * depth, 0.0, 10.0);
    celerity[index(at)] = min(numbers.deep_celerity * tanh(relative), numbers.most_celerity);
}
