//! What the GPU has drawn.
use super::stage::Stage;
use bevy::{
    prelude::*,
    render::gpu_readback::{Readback, ReadbackComplete},
};

#[derive(Resource, Default)]
struct Read(Option<Vec<u8>>);

/// The bytes of a picture; rows may be padded to 256 bytes.
pub fn read(stage: &mut Stage, picture: &Handle<Image>) -> Vec<u8> {
    stage.app.init_resource::<Read>();
    let reader = stage.spawn(Readback::texture(picture.clone()));
    let world = stage.app.world_mut();
    world.entity_mut(reader).observe(|read: On<ReadbackComplete>, mut to: ResMut<Read>| to.0 = Some(read.data.clone()));
    for _ in 0..20 {
        stage.app.update();
        if let Some(data) = stage.app.world_mut().resource_mut::<Read>().0.take() {
            stage.app.world_mut().despawn(reader);
            return data;
        }
    }
    panic!("nothing was read");
}

/// Texels of `bytes` each, row by row, without what pads rows.
pub fn texels(data: &[u8], size: UVec2, bytes: usize) -> impl Iterator<Item = &[u8]> {
    let row = data.len() / size.y as usize;
    data.chunks_exact(row).flat_map(move |row| row[..size.x as usize * bytes].chunks_exact(bytes))
}

/// Four numbers of half precision.
pub fn halves(texel: &[u8]) -> Vec4 {
    let half = |at: usize| half::f16::from_le_bytes([texel[at], texel[at + 1]]).to_f32();
    vec4(half(0), half(2), half(4), half(6))
}
