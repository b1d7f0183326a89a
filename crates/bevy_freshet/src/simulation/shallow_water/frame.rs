//! What is to be done for a shallow water in a frame, as the render world gets it.
use super::{GpuEdge, GpuShallow, Held};
use bevy::{
    prelude::*,
    render::{extract_component::ExtractComponent, sync_component::SyncComponent},
};
use std::sync::Arc;

/// What is to be done in a frame.
#[derive(Component, Clone, Debug)]
pub(crate) struct ShallowFrame {
    pub numbers: GpuShallow,
    /// Edges of the western, eastern, northern and southern side.
    pub edges: Vec<GpuEdge>,
    /// The state that replaces what the GPU has, unless it has it already.
    pub start: Option<Arc<StartState>>,
    /// Bed, walls and sources that replace what the GPU has.
    pub ground: Option<Arc<Ground>>,
    /// Whether faces have crests.
    pub has_walls: bool,
    /// Whether there are point sources.
    pub has_sources: bool,
    /// Most steps, an even number.
    pub steps: u32,
    /// Where the render world says what it has and hands back what it came to.
    pub held: Arc<Held>,
}

/// A state to begin with.
#[derive(Debug)]
pub(crate) struct StartState {
    /// Counts the states that were set; above 0.
    pub version: u64,
    /// Depth, discharge and carry of every cell.
    pub cells: Vec<Vec4>,
    /// The fastest signal in it, m/s.
    pub fastest: f32,
}

/// What is under and beside the water.
#[derive(Debug)]
pub(crate) struct Ground {
    /// Counts the grounds; above 0.
    pub version: u64,
    /// Elevation of every cell's bed, m.
    pub bed: Vec<f32>,
    /// Crests of the eastern and southern face (m) and the point sources (m/s) of every cell; empty if there are neither.
    pub extras: Vec<Vec4>,
}

impl SyncComponent for ShallowFrame {
    type Target = ShallowFrame;
}

impl ExtractComponent for ShallowFrame {
    type QueryData = &'static ShallowFrame;
    type QueryFilter = ();
    type Out = ShallowFrame;

    fn extract_component(frame: &ShallowFrame) -> Option<ShallowFrame> {
        Some(frame.clone())
    }
}
