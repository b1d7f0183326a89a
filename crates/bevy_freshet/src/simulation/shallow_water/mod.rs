//! The shallow water of [`freshet_hydro::shallow_water`] on the GPU.
//!
//! ```text
//! begin     the time that a frame adds is owed to the water       once a frame
//! step      Δt from the fastest signal; every cell takes a step   ┐ for each step that the
//! border    cells at the edges take it with what is outside       │ frame may take
//! push      bodies push the cells that they cover                 ┘
//! show      pictures for the surface's shader                     once a frame
//! show      the same pictures of a flood that is played back, in place of all of these
//! coarsen   a coarser level of them, also of those from the CPU   for each level
//! ```
//!
//! No number of them comes from the CPU during a frame: a step for which no time is left copies the state. What they come
//! to returns some frames later ([`returned`]), and is all that the CPU knows of the water.
mod control;
mod domain;
mod driver;
#[cfg(feature = "rapier")]
mod exchange;
mod frame;
mod numbers;
mod on_gpu;
mod pictures;
mod plan;
mod played;
mod returned;
mod stages;
mod state;
#[cfg(test)]
mod tests;
mod usable;

pub(crate) use driver::Simulated;
#[cfg(feature = "rapier")]
pub(crate) use exchange::Exchange;
pub(crate) use frame::{GpuWork, Ground, ShallowFrame, ShallowWork, StartState};
pub(crate) use numbers::{GpuEdge, GpuPush, GpuShallow};
pub(crate) use returned::{Held, Returned};

use crate::schedule::WaterSystems;

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

/// When waters are simulated; what is played back comes after it.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Simulate;

/// Simulates every water that has a [`WaterSimulation`](crate::body::WaterSimulation); on the CPU in an app without a GPU device.
pub(crate) struct ShallowWaterPlugin;

impl Plugin for ShallowWaterPlugin {
    fn build(&self, app: &mut App) {
        app.add_observer(control::ask_for_step)
            .add_observer(control::ask_for_reset)
            .add_systems(FixedFirst, driver::simulate_on_cpu.in_set(Simulate).before(WaterSystems::Resolve));
        if app.get_sub_app(RenderApp).is_some() {
            let simulate = driver::simulate_on_gpu.in_set(Simulate).after(TransformSystems::Propagate);
            app.add_plugins(StagesPlugin).add_systems(PostUpdate, simulate.before(WaterSystems::Resolve));
        }
    }
}

/// Runs the stages of every [`ShallowFrame`].
pub(crate) struct StagesPlugin;

impl Plugin for StagesPlugin {
    fn build(&self, app: &mut App) {
        load_shader_library!(app, "bindings.wgsl");
        load_shader_library!(app, "scheme.wgsl");
        load_shader_library!(app, "cells.wgsl");
        played::load_library(app);
        embedded_asset!(app, "border.wgsl");
        embedded_asset!(app, "coarsen.wgsl");
        embedded_asset!(app, "push.wgsl");
        embedded_asset!(app, "raise.wgsl");
        embedded_asset!(app, "show.wgsl");
        embedded_asset!(app, "step.wgsl");
        app.add_plugins(ExtractComponentPlugin::<ShallowFrame>::default());
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        render_app
            .init_resource::<plan::Plans>()
            .add_systems(RenderStartup, (stages::create_stages, state::forget_states, played::forget_played))
            .add_systems(
                Render,
                (
                    (plan::plan_steps, (played::plan_played, pictures::draw_pictures).chain())
                        .in_set(RenderSystems::PrepareBindGroups),
                    returned::map_copies.in_set(RenderSystems::Cleanup),
                ),
            )
            .add_systems(
                RenderGraph,
                (plan::run_steps, played::run_played, pictures::run_levels)
                    .chain()
                    .in_set(RenderGraphSystems::Render)
                    .before(camera_driver),
            );
    }
}
