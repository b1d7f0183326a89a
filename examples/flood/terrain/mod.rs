//! The terrain as it is drawn: tiles of a quadtree, as fine as a camera can tell, on a block.
mod mesh;
mod selection;
mod streaming;
mod tree;
mod walls;

use bevy::{camera::primitives::Frustum, math::primitives::ViewFrustum, prelude::*};
use bevy_freshet::{flood::Flood, panel::OrbitCamera};
use selection::Eye;

pub use streaming::Ground;
use streaming::Workshop;
pub use tree::Tree;
pub use walls::mesh as walls;

/// Where drawn terrain is; its scale is the exaggeration.
#[derive(Component)]
#[require(Transform, Visibility)]
pub struct Block;

/// Shows the tiles that the camera wants.
pub fn show(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut ground: ResMut<Ground>,
    block: Single<&Transform, With<Block>>,
    flood: Single<&Flood>,
    cameras: Query<(&Camera, &Transform), With<OrbitCamera>>,
) {
    let Some((camera, pose)) = cameras.iter().next() else { return };
    // Before the first frame a camera knows no size.
    let height = camera.physical_viewport_size().map_or(1080, |size| size.y) as f32;
    let eye = Eye {
        place: pose.translation,
        pixels: 0.5 * height * camera.clip_from_view().y_axis.y,
        exaggeration: block.scale.y,
        frustum: Some(frustum(camera.clip_from_view(), pose)),
    };
    ground.show(&eye, flood.waits, &mut Workshop { commands: &mut commands, meshes: &mut meshes });
}

/// What a camera sees from where it is in this frame; the component is that of the last one.
fn frustum(clip_from_view: Mat4, pose: &Transform) -> Frustum {
    let clip_from_world = clip_from_view * pose.to_matrix().inverse();
    let back = pose.back().as_vec3();
    Frustum(ViewFrustum::from_clip_from_world_custom_far(&clip_from_world, &pose.translation, &back, 1e9))
}
