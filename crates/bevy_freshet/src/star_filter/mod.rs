//! Stars around glints, as a cross-screen filter before the lens makes them: what the low sun does on ripples.
//!
//! ```no_run
//! # use bevy::{camera::Hdr, prelude::*};
//! # use bevy_freshet::star_filter::{StarFilter, StarFilterPlugin};
//! # let mut app = App::new();
//! app.add_plugins((DefaultPlugins, StarFilterPlugin));
//! # fn setup(mut commands: Commands) {
//! commands.spawn((Camera3d::default(), Hdr, StarFilter::default()));
//! # }
//! ```
//!
//! Anastasov and Tomova (2015) name star-shaped glints as what their water lacks. The way is Kawase's (2003, *Frame Buffer
//! Postprocessing Effects in DOUBLE-S.T.E.A.L*): what is brighter than a threshold is drawn at half resolution, smeared along
//! each arm in a few passes that each reach four times as far, and added to the picture after bloom and before tone mapping.
//! Every pass keeps the sum of the light. The cost is that of one pass at half resolution for each arm and factor of four in
//! length; a camera without [`StarFilter`] pays nothing.
mod pass;
mod pipeline;
mod prepare;
mod settings;

pub use settings::StarFilter;

use crate::report::Reported;
use bevy::{
    asset::embedded_asset,
    core_pipeline::{Core3d, Core3dSystems, tonemapping::tonemapping},
    post_process::bloom::bloom,
    prelude::*,
    render::{
        GpuResourceAppExt, Render, RenderApp, RenderStartup, RenderSystems, extract_component::ExtractComponentPlugin,
        render_resource::SpecializedRenderPipelines,
    },
};

/// Draws the stars of every camera with a [`StarFilter`]. Does nothing in an app without a GPU device.
#[derive(Default)]
pub struct StarFilterPlugin;

impl Plugin for StarFilterPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Reported>().add_systems(Last, settings::report_unusable);
        if app.get_sub_app(RenderApp).is_none() {
            return;
        }
        embedded_asset!(app, "star_filter.wgsl");
        app.add_plugins(ExtractComponentPlugin::<StarFilter>::default());
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        render_app
            .init_gpu_resource::<SpecializedRenderPipelines<pipeline::StarPipeline>>()
            .init_gpu_resource::<prepare::StarUniforms>()
            .add_systems(RenderStartup, pipeline::init_star_pipeline)
            .add_systems(
                Render,
                (
                    prepare::prepare_star_pipelines.in_set(RenderSystems::Prepare),
                    prepare::prepare_star_passes.in_set(RenderSystems::PrepareResources),
                ),
            )
            .add_systems(Core3d, pass::star_filter.after(bloom).before(tonemapping).in_set(Core3dSystems::PostProcess));
    }
}
