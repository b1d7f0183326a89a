//! The fields of a water that are simulated on the GPU: rings, foam and dye.
//!
//! Every frame, in `PostUpdate`, a window of each water is chosen, deposits on it are gathered, and its clock is advanced
//! in steps of 1/60 s. The render world then runs the stages, once a frame before any camera:
//!
//! ```text
//! ground    still depth, current, celerity of the rings       when the window or what lies below changed
//! bodies    their silhouettes                                 when there are any
//! stream    what carries foam and dye; where foam is born
//! shift     what is known, moved with the window              when it moved
//! deposit   displaced water, touches, spills                  on the tiles that they reach
//! carry, rings                                                for each step
//! transport                                                   for each step
//! compose   pictures for the surface's shader
//! ```
//!
//! Schemes and formulas are those of [`freshet_hydro::fields`], which holds the same on the CPU.
mod deposits;
mod frame;
mod numbers;
mod plan;
mod progress;
pub(crate) mod shallow_water;
mod stages;
mod state;
#[cfg(test)]
mod tests;
mod tiles;
mod window;

pub(crate) use deposits::{Deposits, SilhouetteCell, Stroke};
pub(crate) use frame::FieldFrame;
pub(crate) use progress::FieldProgress;
pub(crate) use shallow_water::{ShallowFrame, ShallowWaterPlugin, Simulate, Simulated};
pub(crate) use tiles::{NARROWEST, REACH};
pub(crate) use window::FieldWindow;

use bevy::{
    asset::embedded_asset,
    core_pipeline::schedule::camera_driver,
    prelude::*,
    render::{
        Render, RenderApp, RenderStartup, RenderSystems,
        extract_component::ExtractComponentPlugin,
        renderer::{RenderGraph, RenderGraphSystems},
    },
    shader::load_shader_library,
};

/// The simulated fields of a water as pictures of its [`FieldWindow`], for the surface's shader.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct FieldPictures {
    /// Slope of the rings (xy, local), their height (z, m) and the share that bodies cover at the waterline (w).
    pub rings: Option<Handle<Image>>,
    /// Cover of foam (x) and the absorption of dye (yzw, 1/m).
    pub matter: Option<Handle<Image>>,
}

/// The steps of the fields within [`WaterSystems::Displace`](crate::WaterSystems::Displace), one after the other.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum FieldSystems {
    /// The [`FieldWindow`] of every water is chosen.
    Window,
    /// [`Deposits`] on the window are gathered.
    Deposit,
    /// The clock of the fields is advanced, and the deposits are handed to the stages.
    Step,
}

/// Simulates the fields. Does nothing in an app without a GPU device.
pub(crate) struct SimulationPlugin;

impl Plugin for SimulationPlugin {
    fn build(&self, app: &mut App) {
        if app.get_sub_app(RenderApp).is_none() {
            return;
        }
        load_shader_library!(app, "numbers.wgsl");
        embedded_asset!(app, "ground.wgsl");
        embedded_asset!(app, "bodies.wgsl");
        embedded_asset!(app, "stream.wgsl");
        embedded_asset!(app, "shift.wgsl");
        embedded_asset!(app, "deposit.wgsl");
        embedded_asset!(app, "carry.wgsl");
        embedded_asset!(app, "rings.wgsl");
        embedded_asset!(app, "transport.wgsl");
        embedded_asset!(app, "compose.wgsl");

        app.add_plugins(ExtractComponentPlugin::<frame::FieldFrame>::default()).add_systems(
            PostUpdate,
            (
                window::place_windows.in_set(FieldSystems::Window),
                (progress::forget_frames, progress::step_fields).chain().in_set(FieldSystems::Step),
            ),
        );
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        render_app
            .init_resource::<plan::FieldPlans>()
            .add_systems(RenderStartup, (stages::create_stages, state::forget_states))
            .add_systems(Render, plan::plan_fields.in_set(RenderSystems::PrepareBindGroups))
            .add_systems(RenderGraph, plan::run_stages.in_set(RenderGraphSystems::Render).before(camera_driver));
    }
}
