//! Planar reflection: a mirror camera for every visible water level and viewing camera.
//!
//! A mirror camera stands where its viewer's eye is mirrored at the still surface, sees with the same projection, and
//! draws everything above the water to a texture; the surface looks up where a reflected ray leaves that picture. What
//! it costs is roughly the scene at the mirror's resolution; shadow maps are shared with the viewer if
//! they can be.
mod camera;
mod projection;
mod shadows;

pub use camera::MirrorCamera;
pub(crate) use camera::{MirrorKey, Mirrors, update_mirrors};

use crate::schedule::WaterSystems;
use bevy::{
    camera::visibility::RenderLayers,
    light::SimulationLightSystems,
    prelude::*,
    render::{Render, RenderApp, RenderSystems, extract_component::ExtractComponentPlugin},
};

/// How a water reflects the scene. Waters of one level share the mirror; the settings of the one with the finest
/// resolution count.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug)]
pub struct WaterReflection {
    /// Whether things are mirrored. Default true. Off, the surface reflects the sky alone.
    pub planar: bool,
    /// Size of the mirror's picture relative to the viewport, 0.05…1. Default 0.5.
    pub resolution: f32,
    /// The mirror is drawn in every n-th frame, ≥ 1. Default 1. Between, the last picture is reprojected.
    pub refresh: u32,
    /// How far below the still surface things are still mirrored, m, 0…1. Default 0.02. Hides seams where waves dip
    /// below the mirror plane; too much mirrors what is under water.
    pub clip_offset: f32,
    /// Assumed distance of mirrored things from the surface, m, > 0. Default 3. Waves move the picture of things at
    /// this distance as far as in nature, that of nearer ones farther and that of farther ones less.
    pub distance: f32,
    /// How strongly the surface's slopes distort the reflection, 0…1. Default 1, as in nature.
    pub distortion: f32,
    /// Whether the mirror has shadow maps of the sun for itself. Default false: it uses its viewer's, which are then drawn once
    /// for both if no other 3D camera is drawn between the two. Mirrored things can miss their shadow: where the
    /// viewer has no map, and in steep views near the seam of two cascades. A mirror with `layers` of its own has its own maps.
    pub own_shadows: bool,
    /// What is mirrored. Default `None`: what the viewing camera sees.
    pub layers: Option<RenderLayers>,
}

impl Default for WaterReflection {
    fn default() -> Self {
        Self {
            planar: true,
            resolution: 0.5,
            refresh: 1,
            clip_offset: 0.02,
            distance: 3.0,
            distortion: 1.0,
            own_shadows: false,
            layers: None,
        }
    }
}

/// Keeps the mirror cameras.
pub(crate) struct ReflectionPlugin;

impl Plugin for ReflectionPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(ExtractComponentPlugin::<shadows::SharesShadows>::default())
            .init_resource::<Mirrors>()
            .add_systems(
                PostUpdate,
                (
                    update_mirrors.in_set(WaterSystems::Present).after(crate::surface::advance_ripples),
                    shadows::share_cascades
                        .after(SimulationLightSystems::UpdateDirectionalLightCascades)
                        .before(SimulationLightSystems::UpdateLightFrusta),
                ),
            );
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app.add_systems(
                Render,
                shadows::skip_drawn_shadows.after(RenderSystems::CreateViews).before(RenderSystems::Specialize),
            );
        }
    }
}
