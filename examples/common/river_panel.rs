//! The panel of the river: bodies are put back, and dropped where the camera looks.
use crate::river::{Bodies, LEVEL};
use bevy::prelude::*;
use bevy_freshet::{
    panel::{DropRequested, RestartRequested, WaterPanelPlugin},
    prelude::*,
};
use bevy_rapier3d::prelude::*;
use std::path::Path;

/// Where a body was at the start.
#[derive(Component)]
struct Start(Transform);

/// Dropped by hand: gone after a restart.
#[derive(Component)]
struct Dropped;

pub fn plugin(app: &mut App) {
    let presets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/presets");
    app.add_plugins(WaterPanelPlugin { presets, actions: true, ..default() })
        .add_systems(PostStartup, remember)
        .add_systems(Update, (drop_body, restart.run_if(on_message::<RestartRequested>)));
}

fn remember(mut commands: Commands, bodies: Query<(Entity, &Transform), With<Floating>>) {
    for (body, pose) in &bodies {
        commands.entity(body).insert(Start(*pose));
    }
}

fn restart(
    mut commands: Commands,
    mut bodies: Query<(&Start, &mut Transform, &mut Velocity)>,
    dropped: Query<Entity, With<Dropped>>,
) {
    for (start, mut pose, mut velocity) in &mut bodies {
        (*pose, *velocity) = (start.0, Velocity::zero());
    }
    for body in &dropped {
        commands.entity(body).despawn();
    }
}

fn drop_body(
    mut commands: Commands,
    mut requests: MessageReader<DropRequested>,
    mut count: Local<usize>,
    bodies: Res<Bodies>,
) {
    for request in requests.read() {
        let place = Transform::from_translation(request.place.with_y(request.place.y.max(LEVEL + 1.0)));
        let body = bodies.spawn(&mut commands, *count, place);
        commands.entity(body).insert(Dropped);
        *count += 1;
    }
}
