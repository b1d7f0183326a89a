//! When the water works.
use bevy::prelude::*;

/// The steps of the water within a frame.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum WaterSystems {
    /// The waters' settings are checked and resolved for the clock of the running schedule.
    ///
    /// Runs in `FixedFirst` for the fixed clock, and again in `RunFixedMainLoop` after the fixed steps and in
    /// `PostUpdate` after transform propagation for the virtual clock.
    Resolve,
    /// Floating bodies look up heights and velocities. In `FixedUpdate`, after Rapier's `PhysicsSet::SyncBackend`, so
    /// that poses and shapes are those of the coming step.
    Sample,
    /// Forces of the water are handed to the physics engine. In `FixedUpdate`, after [`WaterSystems::Sample`] and before
    /// Rapier's `PhysicsSet::StepSimulation`.
    Force,
    /// Silhouettes of bodies, touches and rain are gathered for the simulated fields. In `PostUpdate`, after
    /// [`WaterSystems::Resolve`] and before [`WaterSystems::Present`].
    Displace,
    /// Surfaces, mirrors and their GPU data follow waters and cameras. In `PostUpdate`, after
    /// [`WaterSystems::Resolve`] and before Bevy's `CameraUpdateSystems` and `VisibilitySystems::UpdateFrusta`.
    Present,
}
