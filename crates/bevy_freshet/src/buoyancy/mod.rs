//! Rigid bodies of bevy_rapier3d that float (feature `rapier`).
//!
//! Add [`Floating`] to a dynamic `RigidBody`; the rest follows. In every fixed step, between Rapier's
//! `PhysicsSet::SyncBackend` and `PhysicsSet::StepSimulation`, so that shapes, poses and masses are those that the
//! solver is about to use:
//!
//! 1. hulls are built for new bodies, and rebuilt when a collider, a mesh or a scale has changed;
//! 2. bodies are put into the simulated waters that they were in ([`WaterSimulation::push`](crate::body::WaterSimulation::push)): each cell
//!    loses the room that the hull takes up in it;
//! 3. [`WaterSystems::Sample`]: the water is looked up on a lattice over each body's footprint;
//! 4. [`WaterSystems::Force`]: pressure, resistance and added mass ([`freshet_hydro::load`]) are lent to the solver, for one
//!    step: after it they are taken back, so that they never add up and a game's own `ExternalForce` keeps its value and its effect.
//!    Simulated water gets the opposite of them;
//! 5. messages tell what [`Entered`], [`Left`], [`Submerged`] and [`Splash`]ed.
//!
//! [`BuoyancyGizmos`] draw what comes of it.
//!
//! The forces go to the solver's body itself, not through the component `ExternalForce`: writing that one wakes the
//! body each time, and a body that floats would never sleep.
//!
//! # Limits
//!
//! * What a joint or a contact does to a body is known to the water some steps later.
//! * Rapier must run in `FixedUpdate` (`in_fixed_schedule()`); a warning tells when it does not.
//! * With `substeps` above 1, and while `TimestepMode::Interpolated` catches up, a force holds for all of the step.
//! * bevy_rapier 0.36 writes back a wrong `Transform` for bodies below a *rotated* parent (its `writeback_rigid_bodies`
//!   scales after rotating); moved and scaled parents are right, and the solver's own pose always is.
//! * Waves that ride on simulated water push bodies and are not pushed back, and where they are up to a tenth of the momentum that is exchanged by
//!   pressure is made or lost. A body of less than a cell is spread over three by three of them.
//! * On the GPU, a simulated water learns of bodies in the next frame, and they of it when its state has come back.
//! * A mesh holds what its outermost closed shells enclose ([`Hull::new`](freshet_hydro::hull::Hull::new)): sealed cavities stay dry for ever
//!   and displace water, and what is open stays filled, so that neither leaks.

mod body;
mod contact;
mod exchange;
mod floating;
mod footprint;
mod force;
mod form;
mod gizmos;
mod held;
mod messages;
mod return_to;
mod solid;

pub use floating::{Buoyancy, BuoyancyModel, Floating, Weight};
pub use gizmos::{BuoyancyGizmos, ShowBuoyancyGizmo};
pub use messages::{Entered, Left, Passage, Splash, Submerged};
pub use return_to::ReturnTo;

use crate::{report::Reported, schedule::WaterSystems};
use bevy::prelude::*;
use bevy_rapier3d::plugin::{PhysicsSet, TimestepMode};

/// Makes bodies with [`Floating`] float and [`ReturnTo`] sensors return them. Part of `WaterPlugin`.
///
/// Does nothing while Rapier's plugin is absent, and may be added before or after it.
pub struct BuoyancyPlugin;

impl Plugin for BuoyancyPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(gizmos::BuoyancyGizmosPlugin)
            .init_resource::<Reported>()
            .add_message::<AssetEvent<Mesh>>()
            .add_message::<Entered>()
            .add_message::<Left>()
            .add_message::<Submerged>()
            .add_message::<Splash>()
            .configure_sets(
                FixedUpdate,
                (WaterSystems::Sample, WaterSystems::Force)
                    .chain()
                    .after(PhysicsSet::SyncBackend)
                    .before(PhysicsSet::StepSimulation),
            )
            .add_systems(
                FixedUpdate,
                (
                    (body::build_hulls, exchange::displace)
                        .chain()
                        .after(PhysicsSet::SyncBackend)
                        .before(WaterSystems::Sample),
                    footprint::sample_water.in_set(WaterSystems::Sample),
                    (force::find_forces, force::lend_forces, exchange::return_forces)
                        .chain()
                        .in_set(WaterSystems::Force),
                    (force::take_forces_back, messages::tell_contacts, return_to::return_bodies)
                        .chain()
                        .after(PhysicsSet::StepSimulation)
                        .before(PhysicsSet::Writeback),
                )
                    .run_if(resource_exists::<TimestepMode>),
            );
    }

    fn finish(&self, app: &mut App) {
        let has_rapier = |schedule: &Schedule| schedule.graph().system_sets.contains(PhysicsSet::StepSimulation);
        if app.get_schedule(PostUpdate).is_some_and(has_rapier) {
            warn!(
                "Rapier runs in PostUpdate, the water in FixedUpdate: bodies will not float. Use in_fixed_schedule()"
            );
        }
    }
}
