//! Camera controllers and the player's hand rest while the panel is used.
use super::OrbitCamera;
use crate::interaction::WaterTouchBlocked;
use bevy::{camera_controller::free_camera::FreeCameraState, prelude::*};
use bevy_egui::input::EguiWantsInput;

/// Beside a `FreeCamera` that was switched off here, so that only such are switched on again.
#[derive(Component)]
pub(super) struct Held;

/// Switches free cameras off while the pointer is over the panel, a text is typed, or an [`OrbitCamera`] beside them has
/// taken over.
pub(super) fn hold_controllers(
    mut commands: Commands,
    egui: Res<EguiWantsInput>,
    mut cameras: Query<(Entity, &mut FreeCameraState, Option<&OrbitCamera>, Has<Held>)>,
) {
    let in_use = egui.wants_pointer_input() || egui.wants_keyboard_input();
    for (camera, mut state, orbit, held) in &mut cameras {
        let hold = in_use || orbit.is_some_and(|orbit| orbit.enabled);
        if hold && state.enabled {
            state.enabled = false;
            commands.entity(camera).try_insert(Held);
        } else if !hold && held {
            state.enabled = true;
            commands.entity(camera).try_remove::<Held>();
        }
    }
}

/// Keeps the player's hand off the water while the panel wants the pointer. A game may block it for reasons of its own
/// meanwhile: only what was blocked here is released here.
pub(super) fn block_touch(egui: Res<EguiWantsInput>, mut blocked: ResMut<WaterTouchBlocked>, mut ours: Local<bool>) {
    let wanted = egui.wants_pointer_input();
    if wanted && !blocked.0 {
        (blocked.0, *ours) = (true, true);
    } else if !wanted && core::mem::take(&mut *ours) {
        blocked.0 = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::camera_controller::free_camera::FreeCamera;

    #[test]
    fn a_free_camera_rests_while_another_one_orbits() {
        let mut app = App::new();
        app.init_resource::<EguiWantsInput>().add_systems(PreUpdate, hold_controllers);
        let camera = app.world_mut().spawn((FreeCamera::default(), OrbitCamera::default())).id();
        let off_by_the_game = app.world_mut().spawn(FreeCamera::default()).id();
        app.world_mut().get_mut::<FreeCameraState>(off_by_the_game).unwrap().enabled = false;
        let enabled = |app: &App, camera| app.world().get::<FreeCameraState>(camera).unwrap().enabled;
        app.update();
        assert!(!enabled(&app, camera));
        app.world_mut().get_mut::<OrbitCamera>(camera).unwrap().enabled = false;
        app.update();
        assert!(enabled(&app, camera));
        assert!(!enabled(&app, off_by_the_game), "a camera that the game has switched off stays off");
    }
}
