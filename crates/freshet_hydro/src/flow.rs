//! Steady flow of a river through its wetted channel.
//!
//! Depth-averaged flow in which friction balances the slope of the surface and inertia is left out (the diffusive wave;
//! reviewed by Hunter et al. 2007, *Geomorphology* 90, 208–225), with the friction law of Manning (1891):
//! ```text
//! ∇·q = 0                                 continuity
//! q = −d^(5/3) / (n √|∇η|) · ∇η           discharge per metre of width, m²/s
//! u = q / d = −d^(2/3) / (n √|∇η|) · ∇η   velocity, m/s
//! ```
//! | symbol | meaning |
//! |---|---|
//! | d = level − z_b | depth under a flat water level, m |
//! | η | head: the small slope of the surface that drives the flow, m |
//! | n | Manning roughness, s/m^⅓ |
//!
//! Nothing flows through banks, and since the speed goes with d^(2/3) it falls to zero towards them. Water enters
//! through one [`Section`] and leaves through another, each at one head all along; creeks that lead nowhere stay still.
//! The head is homogeneous: λη carries √λ times the discharge. So it is found once, for a drop of one, and scaled.
//!
//! Left out with inertia are the fast outer thread after a bend, eddies, and jets below a narrows.

mod conjugate_gradient;
mod field;
mod head;
mod network;
mod section;

use glam::Vec2;
use thiserror::Error;

pub use self::field::{FlowField, discharge_across};
pub use self::section::Section;
use self::{head::Head, network::Network};
use crate::grid::Grid;

/// Least depth of a cell that takes part in the flow, in metres. Shallower ones would carry next to nothing.
pub const MINIMUM_DEPTH: f32 = 0.05;

/// A stretch of river: where water enters, where it leaves, and how much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Where water enters. It must cross the whole channel; water upstream of it stays still.
    pub inflow: Section,
    /// Where water leaves. It must cross the whole channel; water beyond it stays still.
    pub outflow: Section,
    /// Water that passes through every cross-section, in m³/s, above zero. All speeds are proportional to it.
    pub discharge: f32,
    /// Manning roughness n in s/m^⅓, above zero; see [`Reach::NATURAL_CHANNEL`]. Given the discharge, it changes the
    /// head and leaves the velocities as they are.
    pub manning: f32,
}

impl Reach {
    /// Manning roughness of a clean, straight, natural channel, in s/m^⅓ (Chow 1959, *Open-Channel Hydraulics*,
    /// table 5-6, D-1 a 1).
    pub const NATURAL_CHANNEL: f32 = 0.03;

    /// A reach with the roughness of a natural channel, carrying `discharge` m³/s (above zero).
    pub fn new(inflow: Section, outflow: Section, discharge: f32) -> Self {
        Self { inflow, outflow, discharge, manning: Self::NATURAL_CHANNEL }
    }
}

/// One of the two ends of a [`Reach`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Where water enters.
    Inflow,
    /// Where water leaves.
    Outflow,
}

impl std::fmt::Display for End {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(match self {
            Self::Inflow => "inflow",
            Self::Outflow => "outflow",
        })
    }
}

/// Why a flow cannot be computed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum FlowError {
    /// The water level is not a finite number of metres.
    #[error("the water level must be a finite number of metres, not {0}")]
    Level(f32),
    /// The discharge is not a finite number above zero.
    #[error("the discharge must be a finite number of m³/s above zero, not {0}")]
    Discharge(f32),
    /// The roughness is not a finite number above zero.
    #[error("the Manning roughness must be a finite number of s/m^⅓ above zero, not {0}")]
    Manning(f32),
    /// No cell is deep enough to carry water.
    #[error("no cell of the grid lies more than {MINIMUM_DEPTH} m under the water level of {0} m")]
    Dry(f32),
    /// A section separates no wet cell from another one or from the outside of the grid.
    #[error(
        "the {end} section from ({}, {}) to ({}, {}) crosses no water; the grid reaches from ({}, {}) to ({}, {})",
        .section.from.x, .section.from.y, .section.to.x, .section.to.y,
        -.extent.x / 2.0, -.extent.y / 2.0, .extent.x / 2.0, .extent.y / 2.0,
    )]
    NoWater {
        /// Which end of the reach.
        end: End,
        /// The section in question.
        section: Section,
        /// Extent of the grid in metres.
        extent: Vec2,
    },
    /// No wet cells lead from the inflow to the outflow section.
    #[error("no water connects the inflow section to the outflow section")]
    NotConnected,
    /// Water of the reach lies on both sides of a section.
    #[error("water passes round the {0} section: it must cross the whole channel, from bank to bank")]
    PassedRound(End),
    /// The iteration for the head did not settle; the data are out of the range of the method.
    #[error("the head did not settle within {0} iterations")]
    NotConverged(usize),
}

/// Computes the steady flow of a river over `bed`, under a flat water surface at `level`.
///
/// `bed` holds bed elevations in metres, NaN where there are no data; `level` is in metres above the same datum. Cells
/// deeper than [`MINIMUM_DEPTH`] are wet. The reach is all wet water between the two sections; cells are joined across
/// their edges, not their corners.
///
/// # Errors
/// [`FlowError`] if a number is out of range, a section crosses no water or leaves a way round it, or the two sections
/// are not connected.
pub fn steady_flow(bed: &Grid<f32>, level: f32, reach: &Reach) -> Result<FlowField, FlowError> {
    if !level.is_finite() {
        return Err(FlowError::Level(level));
    }
    if !(reach.discharge.is_finite() && reach.discharge > 0.0) {
        return Err(FlowError::Discharge(reach.discharge));
    }
    if !(reach.manning.is_finite() && reach.manning > 0.0) {
        return Err(FlowError::Manning(reach.manning));
    }
    let wet = bed.map(|&bed| level - bed > MINIMUM_DEPTH);
    if !wet.values().contains(&true) {
        return Err(FlowError::Dry(level));
    }
    let network = Network::new(&wet, &reach.inflow, &reach.outflow)?;
    let depths: Vec<f64> = network.cells.iter().map(|&cell| f64::from(level - bed.values()[cell])).collect();
    let head = Head::with_unit_drop(&network, &depths)?;
    Ok(FlowField::new(bed, reach, &network, &depths, &head))
}
