//! The shader's equations of ice against their Rust twins.
use crate::stage::Stage;
use bevy::{
    prelude::*,
    render::{
        RenderApp,
        render_resource::{
            BindGroupEntry, BindGroupLayout, BufferDescriptor, BufferInitDescriptor, BufferUsages,
            ComputePassDescriptor, MapMode, PollType, RawComputePipelineDescriptor, ShaderModuleDescriptor,
            ShaderSource,
        },
        renderer::{RenderDevice, RenderQueue},
    },
};
use freshet_hydro::ice::{self, PURE_ICE_ABSORPTION, Winter};

const GROWTH: &str = include_str!("../crates/bevy_freshet/src/surface/ice_growth.wgsl");

/// Order, freezing, thickest and scattering go in; thickness, cover, settled snow and a mean come out, and then both
/// sides of a layer.
const MAIN: &str = "
@group(0) @binding(0) var<storage, read> given: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> found: array<vec4<f32>>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let g = given[id.x];
    let h = thickness(g.x, g.y, g.z);
    let l = layer(vec3(0.2765, 0.0523, 0.0026), g.w, h);
    found[3u * id.x] = vec4(h, cover(h), settled(h), 0.0);
    found[3u * id.x + 1u] = vec4(l.reflectance, 0.0);
    found[3u * id.x + 2u] = vec4(l.transmittance, 0.0);
}";

/// What the shader finds for each of `given`: three vectors each.
fn found(stage: &Stage, given: &[Vec4]) -> Vec<Vec4> {
    let world = stage.app.sub_app(RenderApp).world();
    let (device, queue) = (world.resource::<RenderDevice>(), world.resource::<RenderQueue>());
    let plain: String = GROWTH.lines().filter(|line| !line.starts_with('#')).collect::<Vec<_>>().join("\n");
    let source = ShaderSource::Wgsl((plain + MAIN).into());
    let module = device.create_and_validate_shader_module(ShaderModuleDescriptor { label: Some("ice"), source });
    let pipeline = device.create_compute_pipeline(&RawComputePipelineDescriptor {
        label: Some("ice"),
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: default(),
        cache: None,
    });
    let bytes: Vec<u8> = given.iter().flat_map(|g| g.to_array().map(f32::to_le_bytes)).flatten().collect();
    let input = device.create_buffer_with_data(&BufferInitDescriptor {
        label: None,
        contents: &bytes,
        usage: BufferUsages::STORAGE,
    });
    let buffer = |usage| {
        let size = 3 * bytes.len() as u64;
        device.create_buffer(&BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    };
    let output = buffer(BufferUsages::STORAGE | BufferUsages::COPY_SRC);
    let returned = buffer(BufferUsages::MAP_READ | BufferUsages::COPY_DST);
    let layout: BindGroupLayout = pipeline.get_bind_group_layout(0).into();
    let entries = [(0, &input), (1, &output)]
        .map(|(binding, buffer)| BindGroupEntry { binding, resource: buffer.as_entire_binding() });
    let group = device.create_bind_group("ice", &layout, &entries);
    let mut encoder = device.create_command_encoder(&default());
    {
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(given.len() as u32, 1, 1);
    }
    encoder.copy_buffer_to_buffer(&output, 0, &returned, 0, 3 * bytes.len() as u64);
    queue.submit([encoder.finish()]);
    device.map_buffer(&returned.slice(..), MapMode::Read, |result| result.unwrap());
    device.poll(PollType::wait_indefinitely()).unwrap();
    let view = returned.slice(..).get_mapped_range();
    let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().unwrap());
    view.chunks_exact(16).map(|v| vec4(number(&v[0..4]), number(&v[4..8]), number(&v[8..12]), 0.0)).collect()
}

#[test]
fn the_shader_grows_ice_as_the_cpu_does() {
    let mut stage = Stage::new();
    stage.app.update();
    let mut random = fastrand::Rng::with_seed(4);
    let mut given: Vec<Vec4> = (0..1000)
        .map(|_| vec4(random.f32(), random.f32(), 0.1 + 2.9 * random.f32(), 20.0 * random.f32().powi(3)))
        .collect();
    given.extend([vec4(0.0, 0.0, 0.3, 0.0), vec4(1.0, 1.0, 0.1, 0.0), vec4(0.0, 1.0, 3.0, 1e3)]);
    for (g, found) in given.iter().zip(found(&stage, &given).chunks_exact(3)) {
        let thickness = Winter { freezing: g.y, thickest: g.z }.thickness(g.x);
        let layer = ice::layer(PURE_ICE_ABSORPTION, g.w, thickness);
        let expected = [
            vec4(thickness, ice::cover(thickness), ice::settled(thickness), 0.0),
            layer.reflectance.extend(0.0),
            layer.transmittance.extend(0.0),
        ];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs().max_element() < 2e-5, "{g}: {found}, the CPU has {expected}");
        }
    }
}
