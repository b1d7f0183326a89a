//! The components that describe a water: where it is, what it is made of, how it moves.
mod bed;
mod flow;
mod foam;
mod frozen;
mod ice;
mod interaction;
mod lighting;
mod optics;
mod resolved;
mod running;
mod simulated;
mod simulation;
mod waves;

pub use bed::{WaterBed, WaterBedError};
pub use flow::WaterFlow;
pub use foam::WaterFoam;
pub use ice::WaterIce;
pub use interaction::WaterInteraction;
pub use lighting::WaterLighting;
pub use optics::{Fresnel, WaterOptics};
pub(crate) use resolved::{ResolvedBed, ResolvedWater};
pub use running::{Balance, ResetSimulation, SimulationState, StepSimulation};
pub(crate) use simulated::{ResolvedSimulation, SimulatedArea, SimulatedWater};
pub use simulation::{
    CLOSED, DomainSide, Edge, Series, SimulationBackend, SimulationStart, WaterEdge, WaterEdges, WaterSimulation,
    WaterSource, WaterSources, WaterWall, WaterWalls,
};
pub use waves::{WaterWaves, Wave};

use crate::{
    flood::FloodState,
    reflection::WaterReflection,
    report::{Reported, forget_despawned},
    schedule::WaterSystems,
    simulation::{Deposits, FieldFrame, FieldPictures, FieldProgress, FieldWindow, ShallowFrame, Simulated},
    surface::WaterSurface,
};
use bevy::{app::RunFixedMainLoopSystems, ecs::message::MessageUpdateSystems, prelude::*};

/// A rectangle of water. Its entity's `Transform` places the still surface: translation and rotation about y count,
/// scale and tilt do not (water is level).
///
/// Everything else about it is a component beside this one, with a useful default.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug)]
#[require(
    Transform,
    Visibility,
    WaterOptics,
    WaterWaves,
    WaterSurface,
    WaterReflection,
    WaterFoam,
    WaterInteraction,
    WaterLighting,
    ResolvedWater,
    FieldWindow,
    FieldPictures,
    Deposits
)]
pub struct Water {
    /// Length along local x and z, m, > 0, at most [`Water::MAX_SIZE`]. Default 100 × 100.
    ///
    /// Water of no size is not drawn and lifts nothing.
    pub size: Vec2,
}

impl Water {
    /// Largest size along an axis, m.
    pub const MAX_SIZE: f32 = 1e6;

    /// Water of `size` (local x and z, m).
    pub const fn new(size: Vec2) -> Self {
        Self { size }
    }
}

impl Default for Water {
    fn default() -> Self {
        Self::new(Vec2::splat(100.0))
    }
}

/// Without [`Water`] nothing of what is derived from it is left, whatever components stay.
fn end_water(removed: On<Remove, Water>, mut commands: Commands) {
    let Ok(mut water) = commands.get_entity(removed.entity) else { return };
    water.try_remove::<(ResolvedWater, FieldWindow, FieldPictures, FieldProgress, Deposits)>();
    water.try_remove::<(Simulated, SimulationState, ShallowFrame, FloodState)>();
    water.try_insert(FieldFrame::Off);
}

/// Without [`WaterSimulation`] the water is still again.
fn end_simulation(removed: On<Remove, WaterSimulation>, mut commands: Commands) {
    if let Ok(mut water) = commands.get_entity(removed.entity) {
        water.try_remove::<(Simulated, SimulationState, ShallowFrame)>();
    }
}

/// Registers the components of a water and resolves them for every clock.
pub(crate) struct BodyPlugin;

impl Plugin for BodyPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Reported>()
            .add_observer(end_water)
            .add_observer(end_simulation)
            .add_systems(First, forget_despawned.after(MessageUpdateSystems))
            .add_systems(FixedFirst, resolved::resolve_waters.in_set(WaterSystems::Resolve))
            .add_systems(
                RunFixedMainLoop,
                resolved::resolve_waters
                    .in_set(WaterSystems::Resolve)
                    .in_set(RunFixedMainLoopSystems::AfterFixedMainLoop),
            )
            .add_systems(
                PostUpdate,
                resolved::resolve_waters.in_set(WaterSystems::Resolve).after(TransformSystems::Propagate),
            );
    }
}
