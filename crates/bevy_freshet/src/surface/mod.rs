//! The drawn surface: a mesh that follows the camera, and the material that reflects, refracts and absorbs.
//!
//! For every water and every camera that sees it there is one surface entity. It is drawn in Bevy's transmissive phase:
//! after the opaque scene, of which it reads colour and depth, and before anything transparent. Cameras therefore get
//! a `DepthPrepass`.
mod detail;
mod foam;
mod gpu;
mod ice;
mod ice_tile;
mod material;
mod mesh;
mod ripples;
mod scale;
mod shape;
mod sync;
mod tile;
mod viewer;
mod views;
mod write;

pub(crate) use gpu::GpuSurface;
pub(crate) use ice::write_frozen;
pub(crate) use ripples::advance_ripples;
pub use scale::ViewScale;
pub(crate) use sync::GroundTextures;
pub use viewer::NoWater;
pub(crate) use viewer::{ViewerData, Viewers};
pub(crate) use write::{write_ground, write_water};

use crate::schedule::WaterSystems;
use bevy::{
    asset::embedded_asset,
    camera::{CameraUpdateSystems, visibility::VisibilitySystems},
    light::SimulationLightSystems,
    pbr::ViewTransmissionTexture,
    prelude::*,
    render::{RenderApp, RenderStartup},
    shader::load_shader_library,
};

/// How finely the surface is drawn.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug)]
#[require(ripples::Ripples)]
pub struct WaterSurface {
    /// Spacing of the mesh near the camera, m, 0.005…100. Default 0.15. Waves shorter than four cells are drawn flatter
    /// than they are, shorter than two not at all (their normals remain).
    pub cell: f32,
    /// Cells across the finest part of the mesh, 8…256, rounded to a multiple of 4. Default 64. Each ring around it is
    /// twice as wide with cells twice as large.
    pub cells: u32,
    /// How far off its place each wave may be drawn by cells that are larger and fewer than that, pixels, 0…4. Default
    /// 0.25, which none can see. 0 keeps all cells of all rings.
    pub mesh_error: f32,
    /// Root mean square slope of the fine ripples, 0…1. Default 0.045. 0 switches them off.
    pub ripples: f32,
    /// Size of the ripples' pattern, m, > 0. Default 4: ripples of 6 cm to 1 m.
    pub ripple_size: f32,
    /// Slope variance of what is too small for any texture, 0.0001…0.5: how much the sun's glitter spreads. Default
    /// 0.002.
    pub roughness: f32,
    /// Whether sun, moon and lamps glitter on the surface. Default true.
    pub sunlight: bool,
    /// What is drawn. Default [`SurfaceView::Water`].
    pub view: SurfaceView,
    /// Factor on the range of the views level, speed, Froude number and age, 0.001…1000. Default 1. See [`SurfaceView::scale`].
    pub view_scale: f32,
}

impl Default for WaterSurface {
    fn default() -> Self {
        Self {
            cell: 0.15,
            cells: 64,
            mesh_error: 0.25,
            ripples: 0.045,
            ripple_size: 4.0,
            roughness: 0.002,
            sunlight: true,
            view: SurfaceView::Water,
            view_scale: 1.0,
        }
    }
}

/// What the surface shows: the water, or one of its parts for inspection and measurement.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Default, Clone, Debug, PartialEq)]
pub enum SurfaceView {
    /// The water.
    #[default]
    Water,
    /// The reflected light alone.
    Reflection,
    /// The light from below alone.
    Refraction,
    /// Reflected share in red, refracted share in green.
    Fresnel,
    /// World normal, from −1…1 to 0…1.
    Normal,
    /// Height over the still surface: red the height in m rounded to 1/64 m, green 64 times the rest.
    Height,
    /// Opacity of the water's edge.
    Edge,
    /// The current: hue its direction, brightness its speed up to 2 m/s, with arrows along it.
    Flow,
    /// Depth of the still water: red at the waterline, yellow 1 m, green 3 m, cyan 7 m, blue 15 m, black 31 m.
    Depth,
    /// The triangles of the mesh as green lines over the darkened water.
    Wireframe,
    /// Density of foam.
    Foam,
    /// What touches the water: red the share that bodies cover, green raised and blue lowered rings, full at 5 cm.
    Interaction,
    /// What a metre of the dyed water lets through: white where there is no dye.
    Dye,
    /// Ice: red its thickness in m as bodies feel it, green the drawn cover, blue the snow on it.
    Ice,
    /// Level without waves over the still level, −2…2 m. This and what follows have the colours of a [`ViewScale`].
    Level,
    /// Speed of the current, 0…4 m/s.
    Speed,
    /// Froude number of the current, u/√(g d), 0…2: 1 is critical.
    Froude,
    /// Age of the simulated state that bodies and queries know, 0…0.25 s of simulated time.
    Age,
}

/// Draws the water. Does nothing in an app without a GPU device.
pub(crate) struct SurfacePlugin;

impl Plugin for SurfacePlugin {
    fn build(&self, app: &mut App) {
        if app.get_sub_app(RenderApp).is_none() {
            return;
        }
        load_shader_library!(app, "types.wgsl");
        load_shader_library!(app, "bindings.wgsl");
        load_shader_library!(app, "ground.wgsl");
        load_shader_library!(app, "water.wgsl");
        load_shader_library!(app, "flow.wgsl");
        load_shader_library!(app, "field.wgsl");
        load_shader_library!(app, "foam.wgsl");
        load_shader_library!(app, "ice_growth.wgsl");
        load_shader_library!(app, "frozen.wgsl");
        load_shader_library!(app, "ice.wgsl");
        load_shader_library!(app, "mesh.wgsl");
        load_shader_library!(app, "waves.wgsl");
        load_shader_library!(app, "detail.wgsl");
        load_shader_library!(app, "optics.wgsl");
        load_shader_library!(app, "scene.wgsl");
        load_shader_library!(app, "mirror.wgsl");
        load_shader_library!(app, "beam.wgsl");
        load_shader_library!(app, "lamps.wgsl");
        load_shader_library!(app, "stylised.wgsl");
        load_shader_library!(app, "light.wgsl");
        load_shader_library!(app, "refraction.wgsl");
        load_shader_library!(app, "views.wgsl");
        embedded_asset!(app, "surface.wgsl");

        app.add_plugins(MaterialPlugin::<material::SurfaceMaterial>::default())
            .init_resource::<sync::GroundTextures>()
            .init_resource::<sync::SurfaceAssets>()
            .configure_sets(
                PostUpdate,
                WaterSystems::Present
                    .after(WaterSystems::Displace)
                    .after(TransformSystems::Propagate)
                    .after(VisibilitySystems::VisibilityPropagate)
                    .before(CameraUpdateSystems)
                    .before(VisibilitySystems::UpdateFrusta)
                    .before(VisibilitySystems::CalculateBounds),
            )
            .add_systems(
                PostUpdate,
                (
                    (
                        viewer::report_missing_camera,
                        viewer::require_depth,
                        sync::sync_surfaces,
                        advance_ripples,
                        write::write_surfaces.after(crate::reflection::update_mirrors),
                    )
                        .chain()
                        .in_set(WaterSystems::Present),
                    viewer::show_each_viewer_its_own
                        .after(VisibilitySystems::CheckVisibility)
                        .after(SimulationLightSystems::CheckLightVisibility)
                        .before(VisibilitySystems::MarkNewlyHiddenEntitiesInvisible),
                ),
            );
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app.add_systems(RenderStartup, forget_copies);
        }
    }
}

/// After a lost device, views keep the copy of the colour that they had there until something reads one again, and Bevy binds it.
fn forget_copies(mut commands: Commands, views: Query<Entity, With<ViewTransmissionTexture>>) {
    for view in &views {
        commands.entity(view).remove::<ViewTransmissionTexture>();
    }
}
