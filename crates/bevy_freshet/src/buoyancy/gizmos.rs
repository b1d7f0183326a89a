//! Debug drawing of floating bodies: where the water cuts them, and the forces that hold them.

use super::{
    body::Body,
    floating::{Buoyancy, Floating},
};
use crate::report::nearest;
use bevy::{
    color::palettes::css::{AQUA, DODGER_BLUE, LIME, ORANGE_RED, WHITE, YELLOW},
    gizmos::GizmoPlugin,
    prelude::*,
    transform::TransformSystems,
};
use bevy_rapier3d::{
    plugin::{
        RapierConfiguration,
        context::{RapierContextEntityLink, RapierRigidBodySet},
    },
    prelude::RapierRigidBodyHandle,
};
use freshet_hydro::{
    hull::{Flotation, Hull},
    load::Pose,
    waves::WATER_DENSITY,
};
use std::ops::RangeInclusive;

/// Arrows shorter than this share of the hull's length are left out: they would show how rounding twitches.
const SHORTEST: f32 = 1e-3;

/// Registers [`BuoyancyGizmos`], where there are gizmos at all.
pub(super) struct BuoyancyGizmosPlugin;

impl Plugin for BuoyancyGizmosPlugin {
    fn build(&self, _: &mut App) {}

    // When all plugins have been added: a server has no gizmos, and `DefaultPlugins` may come after the water.
    fn finish(&self, app: &mut App) {
        if !app.is_plugin_added::<GizmoPlugin>() {
            return;
        }
        let store = app.world().resource::<GizmoConfigStore>();
        if store.get_config::<BuoyancyGizmos>().is_none() {
            // In front of everything: most of it lies within the hull or under water.
            let config = GizmoConfig { depth_bias: -1.0, ..default() };
            app.insert_gizmo_config(BuoyancyGizmos::default(), config);
        }
        app.add_systems(PostUpdate, draw.after(TransformSystems::Propagate));
    }
}

/// What is drawn of [`Floating`] bodies for debugging: nothing, until [`draw_all`](Self::draw_all) is switched on or a body has a
/// [`ShowBuoyancyGizmo`].
///
/// Bodies out of the water have nothing drawn, whatever the settings. A part whose colour is `None` is left out.
///
/// ```no_run
/// # use bevy::prelude::*;
/// # use bevy_freshet::prelude::*;
/// fn show(mut store: ResMut<GizmoConfigStore>) {
///     store.config_mut::<BuoyancyGizmos>().1.draw_all = true;
/// }
/// ```
#[derive(Clone, Debug, PartialEq, Reflect, GizmoConfigGroup)]
#[reflect(Clone, Default, Debug, PartialEq)]
pub struct BuoyancyGizmos {
    /// Draws all floating bodies. Default `false`.
    pub draw_all: bool,
    /// Colour of the line where the hull's triangles cut the water that the forces used. Default aqua. Where colliders overlap the lines of
    /// each go on within the other.
    pub waterline: Option<Color>,
    /// Colour of the arrow of Archimedes' push ρ g V, at the centre of buoyancy. Default blue.
    pub buoyancy: Option<Color>,
    /// Colour of the arrow of all else that the water does (resistance, stream, slopes), at the centre of buoyancy. Default orange.
    pub resistance: Option<Color>,
    /// Colour of the arrow of the weight, at the centre of mass. Default yellow.
    pub weight: Option<Color>,
    /// Colour of a ball at the centre of the water displaced. Default white.
    pub center_of_buoyancy: Option<Color>,
    /// Colour of a cross at the transverse metacentre, on a line from the centre of buoyancy up to it: a body whose centre of mass lies
    /// below it stands upright. Default green. See [`Flotation::metacentric_radius`].
    pub metacenter: Option<Color>,
    /// Length of the weight's arrow as a share of the hull's length (the edge of a cube of its volume), 0…1000, default 1. Other
    /// forces have arrows to the same scale.
    pub force_scale: f32,
    /// Radius of ball and cross, as a share of the hull's length, 0…1000, default 0.05.
    pub marker_size: f32,
}

impl Default for BuoyancyGizmos {
    fn default() -> Self {
        Self {
            draw_all: false,
            waterline: Some(AQUA.into()),
            buoyancy: Some(DODGER_BLUE.into()),
            resistance: Some(ORANGE_RED.into()),
            weight: Some(YELLOW.into()),
            center_of_buoyancy: Some(WHITE.into()),
            metacenter: Some(LIME.into()),
            force_scale: 1.0,
            marker_size: 0.05,
        }
    }
}

/// Draws the [`BuoyancyGizmos`] of this body, also when they are not drawn for all.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct ShowBuoyancyGizmo {
    /// Colour of the body's waterline; that of [`BuoyancyGizmos`] if `None`, the default.
    pub waterline: Option<Color>,
}

/// A body as it is drawn.
struct Subject<'a> {
    hull: &'a Hull,
    pose: Pose,
    flotation: Flotation,
    /// Its waterline in the world, m.
    waterline: Vec<[Vec3; 2]>,
    /// Of mass, in the world, m.
    center: Vec3,
    /// N.
    weight: Vec3,
    push: Vec3,
    resistance: Vec3,
}

impl Subject<'_> {
    fn draw(&self, gizmos: &mut Gizmos<BuoyancyGizmos>, waterline: Option<Color>) {
        let shown = gizmos.config_ext.clone();
        let length = self.hull.length();
        let marker = length * usable("marker_size", shown.marker_size, 0.0..=1e3, 0.05);
        let scale = length * usable("force_scale", shown.force_scale, 0.0..=1e3, 1.0) / self.weight.length();
        if let Some(color) = waterline.or(shown.waterline) {
            for [from, to] in &self.waterline {
                gizmos.line(*from, *to, color);
            }
        }
        let Flotation { centre_of_buoyancy, .. } = self.flotation;
        for (force, from, color) in [
            (self.weight, self.center, shown.weight),
            (self.push, centre_of_buoyancy, shown.buoyancy),
            (self.resistance, centre_of_buoyancy, shown.resistance),
        ] {
            let arrow = scale * force;
            // Without weight there is no scale.
            if let Some(color) = color.filter(|_| arrow.is_finite() && arrow.length() > SHORTEST * length) {
                gizmos.arrow(from, from + arrow, color);
            }
        }
        if let Some(color) = shown.center_of_buoyancy {
            gizmos.sphere(centre_of_buoyancy, marker, color);
        }
        if let Some(color) = shown.metacenter {
            let metacenter = self.flotation.metacentre();
            gizmos.line(centre_of_buoyancy, metacenter, color);
            gizmos.cross(Isometry3d::new(metacenter, self.pose.rotation), marker, color);
        }
    }
}

/// `value` if it is within `range`, else the nearest bound (`fallback` for NaN) and, the first time, a warning.
fn usable(field: &str, value: f32, range: RangeInclusive<f32>, fallback: f32) -> f32 {
    if range.contains(&value) {
        return value;
    }
    let used = nearest(value, &range, fallback);
    warn_once!("BuoyancyGizmos::{field} is {value}, outside {}…{}; {used} is used", range.start(), range.end());
    used
}

/// Draws the bodies where the picture shows them, on the water that their last step met.
fn draw(
    bodies: Query<
        (
            &GlobalTransform,
            &RapierRigidBodyHandle,
            &RapierContextEntityLink,
            &Body,
            &Buoyancy,
            Option<&ShowBuoyancyGizmo>,
        ),
        With<Floating>,
    >,
    contexts: Query<(&RapierRigidBodySet, &RapierConfiguration)>,
    mut gizmos: Gizmos<BuoyancyGizmos>,
) {
    if !gizmos.config.enabled {
        return;
    }
    for (transform, handle, link, state, buoyancy, show) in &bodies {
        if !gizmos.config_ext.draw_all && show.is_none() {
            continue;
        }
        let Ok((set, config)) = contexts.get(link.0) else { continue };
        // The water does not hold what it does not move.
        let Some(body) = set.bodies.get(handle.0).filter(|body| body.is_dynamic() && body.is_enabled()) else {
            continue;
        };
        let weight = config.gravity * (body.gravity_scale() * body.mass());
        let Some(hull) = state.form.as_ref().map(|form| &form.hull) else { continue };
        let (_, rotation, position) = transform.to_scale_rotation_translation();
        let pose = Pose { position, rotation };
        let water = |at| state.footprint.lattice.at(at);
        let Some(flotation) = hull.flotation(&pose, water) else { continue };
        let push = -config.gravity.with_x(0.0).with_z(0.0) * (WATER_DENSITY * buoyancy.submerged_volume);
        let subject = Subject {
            hull,
            pose,
            flotation,
            waterline: hull.waterline(&pose, water),
            center: position + rotation * body.local_center_of_mass(),
            weight,
            push,
            resistance: buoyancy.force - push,
        };
        subject.draw(&mut gizmos, show.and_then(|show| show.waterline));
    }
}
