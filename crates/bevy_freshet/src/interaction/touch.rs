//! The player's hand on the water.
use super::disturb::Disturb;
use crate::{query::WaterQuery, report::Reported};
use bevy::{
    camera::RenderTarget,
    input::touch::Touches,
    prelude::*,
    window::{PrimaryWindow, WindowRef},
};
use core::f32::consts::TAU;

/// Lets the player touch the water that a camera shows in a window: the left mouse button or a finger dents it, the right
/// button spills dye, both also while dragged.
///
/// Each touch becomes a [`Disturb`]. Only the water is asked what is under the pointer, so that a hand reaches through what
/// floats on it; [`WaterTouchBlocked`] keeps it off while a user interface has the pointer.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[require(Fingers)]
pub struct WaterTouch {
    /// Radius (standard deviation) of dents and blots, m, 0.001…100. Default 0.3.
    pub radius: f32,
    /// Depth of a dent, m, −10…10. Default 0.1; 0 switches dents off, negative ones are mounds.
    pub depth: f32,
    /// Foam in a dent, full cover being 1; 0…10. Default 0.3.
    pub foam: f32,
    /// Absorption of the dye, 1/m per channel, 0…10⁵. Default: that of [`DyesWater`](super::DyesWater).
    pub dye: Vec3,
    /// Dye that is spilled, m³/s, 0…1000. Default 0.001: a litre per second. 0 switches dye off.
    pub dye_rate: f32,
    /// Longest reach from the camera, m, > 0. Default 500.
    pub reach: f32,
}

impl Default for WaterTouch {
    fn default() -> Self {
        let dye = super::DyesWater::default().absorption;
        Self { radius: 0.3, depth: 0.1, foam: 0.3, dye, dye_rate: 1e-3, reach: 500.0 }
    }
}

/// Keeps [`WaterTouch`] off while it is true: for user interfaces, as long as they want the pointer.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Resource, Default, Clone, Debug, PartialEq)]
pub struct WaterTouchBlocked(pub bool);

/// Where each pointer last dented the water, in the world.
#[derive(Component, Default)]
pub(crate) struct Fingers(Vec<(Pointer, Vec3)>);

#[derive(Clone, Copy, Debug, PartialEq)]
enum Pointer {
    Mouse,
    Finger(u64),
}

/// What is pressed in the windows.
#[derive(bevy::ecs::system::SystemParam)]
pub(super) struct Pointers<'w, 's> {
    buttons: Option<Res<'w, ButtonInput<MouseButton>>>,
    touches: Option<Res<'w, Touches>>,
    windows: Query<'w, 's, (&'static Window, Has<PrimaryWindow>)>,
    blocked: Res<'w, WaterTouchBlocked>,
}

impl Pointers<'_, '_> {
    fn window(&self, target: &RenderTarget) -> Option<(&Window, bool)> {
        match target {
            RenderTarget::Window(WindowRef::Primary) => self.windows.iter().find(|(_, primary)| *primary),
            RenderTarget::Window(WindowRef::Entity(entity)) => self.windows.get(*entity).ok(),
            _ => None,
        }
    }

    /// Pointers that dent, and one that dyes, with their places in the window of `target`.
    fn pressed(&self, target: &RenderTarget) -> (Vec<(Pointer, Vec2)>, Option<Vec2>) {
        let Some((window, primary)) = self.window(target).filter(|_| !self.blocked.0) else { return default() };
        let held = |button| self.buttons.as_ref().is_some_and(|buttons| buttons.pressed(button));
        let cursor = window.cursor_position();
        let mut dents: Vec<_> =
            cursor.filter(|_| held(MouseButton::Left)).map(|at| (Pointer::Mouse, at)).into_iter().collect();
        // Bevy does not say which window was touched.
        if let Some(touches) = self.touches.as_ref().filter(|_| primary) {
            dents.extend(touches.iter().map(|touch| (Pointer::Finger(touch.id()), touch.position())));
        }
        (dents, cursor.filter(|_| held(MouseButton::Right)))
    }
}

/// Turns what is pressed into disturbances.
pub(super) fn touch_water(
    time: Res<Time>,
    mut cameras: Query<(Entity, &WaterTouch, &Camera, &RenderTarget, &GlobalTransform, &mut Fingers)>,
    pointers: Pointers,
    water: WaterQuery,
    mut disturb: MessageWriter<Disturb>,
    mut reported: ResMut<Reported>,
) {
    for (entity, touch, camera, target, pose, mut fingers) in &mut cameras {
        let (dents, dye) = pointers.pressed(target);
        fingers.0.retain(|(pointer, _)| dents.iter().any(|(pressed, _)| pressed == pointer));
        if !camera.is_active || (dents.is_empty() && dye.is_none()) {
            continue;
        }
        let touch = usable(entity, touch, &mut reported);
        let place = |at: Vec2| {
            camera.logical_viewport_rect().filter(|rect| rect.contains(at))?;
            water.raycast(camera.viewport_to_world(pose, at).ok()?, touch.reach)
        };
        for (pointer, at) in dents {
            let Some(hit) = place(at) else { continue };
            if fingers.moves(pointer, hit.position, touch.radius) {
                let foam = touch.foam * TAU * touch.radius * touch.radius;
                let dent = Disturb::push(hit.position, touch.radius, touch.depth).with_foam(foam);
                disturb.write(dent.on(hit.surface.water));
            }
        }
        if let Some(hit) = dye.and_then(place) {
            let volume = touch.dye_rate * time.delta_secs();
            disturb.write(Disturb::dye(hit.position, touch.radius, touch.dye, volume).on(hit.surface.water));
        }
    }
}

impl Fingers {
    /// Whether a pointer at `place` dents the water anew: when it is first pressed, and after every `radius` of way, so
    /// that the effect does not depend on the frame rate.
    fn moves(&mut self, pointer: Pointer, place: Vec3, radius: f32) -> bool {
        match self.0.iter_mut().find(|(known, _)| *known == pointer) {
            Some((_, last)) if last.distance(place) < radius => return false,
            Some((_, last)) => *last = place,
            None => self.0.push((pointer, place)),
        }
        true
    }
}

/// The settings, checked.
fn usable(entity: Entity, touch: &WaterTouch, reported: &mut Reported) -> WaterTouch {
    let usual = WaterTouch::default();
    WaterTouch {
        radius: reported.clamp(entity, "WaterTouch::radius", touch.radius, 1e-3..=100.0, usual.radius),
        depth: reported.clamp(entity, "WaterTouch::depth", touch.depth, -10.0..=10.0, usual.depth),
        foam: reported.clamp(entity, "WaterTouch::foam", touch.foam, 0.0..=10.0, usual.foam),
        dye: reported.clamp3(entity, "WaterTouch::dye", touch.dye, 0.0..=1e5, usual.dye),
        dye_rate: reported.clamp(entity, "WaterTouch::dye_rate", touch.dye_rate, 0.0..=1e3, usual.dye_rate),
        reach: reported.clamp(entity, "WaterTouch::reach", touch.reach, 0.0..=f32::INFINITY, usual.reach),
    }
}
