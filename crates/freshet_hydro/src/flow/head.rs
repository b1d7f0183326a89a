//! The head that drives the flow.
//!
//! With conductivity k = d^(5/3) / √|∇η| (n comes in with the scale), continuity is the Euler equation of a convex
//! energy, ∫ ⅔ d^(5/3) |∇η|^(3/2) (a p-Laplacian with p = 3/2). It is discretised as such: a cell's |∇η|² is half the
//! sum of the squares of the slopes over its four faces. Differentiating by the heads of the cells gives the discharge
//! through a face: the mean of the two cells' conductivities times the slope. Walls have no slope.
//!
//! The iteration solves the linear problem for given conductivities, then renews these (Kačanov 1959; as Picard
//! iteration known to modellers). Because x ↦ x^(3/4) is concave, each linear problem minimises a parabola that touches
//! the energy from above, so the energy falls in every step and the steps need no damping (Diening, Fornasier, Tomasi &
//! Wank 2020, *Numerische Mathematik* 145, 1–34, analyse it for 1 < p ≤ 2). Along a channel, where the discharge is
//! given, a step turns a slope s into one proportional to √s: it halves the error of log s.
//!
//! The conductivity has no bound where the slope vanishes, as in every creek that leads nowhere. So
//! √|∇η| is taken as (|∇η|² + ε²)^(1/4), which keeps the energy convex and the argument whole.

use super::conjugate_gradient::Conductances;
use super::network::Network;
use super::{End, FlowError};

/// ε as a share of the root-mean-square slope of the first, linear solution. At the mean slope it changes the conductivity by 3 in 10⁷.
const REGULARISATION: f64 = 1e-3;

/// The iteration ends when no head changes by more than this share of the drop; of the slope from cell to cell it then
/// misses about as little, for what is left of the error is smooth.
const TOLERANCE: f64 = 1e-5;

/// Share of its residual to which a linear problem is solved before the conductivities, which are rough as well, are renewed.
const ROUGHLY: f64 = 0.1;

/// The same for the first one, which sets ε, and the last one: as far as it goes, so that continuity holds to the last digit of an f32.
const EXACTLY: f64 = 0.0;

/// As the error halves in every iteration, about 20 are usual.
const MOST_ITERATIONS: usize = 100;

/// Heads of 1 on the inflow section and 0 on the outflow section, with everything in units of one cell.
pub(super) struct Head {
    /// Head of every cell.
    pub values: Vec<f64>,
    /// Conductivity of every cell, d^(5/3) / √slope.
    pub conductivity: Vec<f64>,
}

impl Head {
    /// Finds the head for the depths of the cells in metres.
    pub fn with_unit_drop(network: &Network, depths: &[f64]) -> Result<Self, FlowError> {
        let conveyance: Vec<f64> = depths.iter().map(|&d| d * two_thirds_power(d)).collect();
        let mut head = Self {
            values: vec![0.5; depths.len()],
            // As if the slope were the same everywhere.
            conductivity: conveyance.clone(),
        };
        let mut reduction = EXACTLY;
        let mut epsilon_squared = None;
        for _ in 0..MOST_ITERATIONS {
            let previous = head.values.clone();
            if !head.relax(network, reduction) {
                break;
            }
            let pairs = head.values.iter().zip(&previous);
            let settled = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < TOLERANCE;
            if settled && reduction == EXACTLY {
                return Ok(head);
            }
            // A rough solution may move little and yet be far from the exact one.
            reduction = if settled { EXACTLY } else { ROUGHLY };
            let slopes_squared = head.slopes_squared(network);
            let epsilon_squared = *epsilon_squared.get_or_insert_with(|| {
                let mean = slopes_squared.iter().sum::<f64>() / depths.len() as f64;
                mean * REGULARISATION * REGULARISATION
            });
            let terms = conveyance.iter().zip(&slopes_squared);
            for (conductivity, (conveyance, slope_squared)) in head.conductivity.iter_mut().zip(terms) {
                *conductivity = conveyance / (slope_squared + epsilon_squared).sqrt().sqrt();
            }
        }
        Err(FlowError::NotConverged(MOST_ITERATIONS))
    }

    /// Solves the linear problem for the present conductivities. Returns whether that succeeded.
    fn relax(&mut self, network: &Network, reduction: f64) -> bool {
        let k = &self.conductivity;
        let along = network.edges.iter().map(|&[a, b]| 0.5 * (k[a as usize] + k[b as usize]));
        let mut anchors = vec![0.0; k.len()];
        let mut right = vec![0.0; k.len()];
        for open in &network.open {
            // A section is half a cell from the cell's centre.
            let conductance = 2.0 * k[open.cell as usize];
            anchors[open.cell as usize] += conductance;
            right[open.cell as usize] += conductance * known_head(open.end);
        }
        let conductances = Conductances { edges: &network.edges, along: along.collect(), anchors };
        conductances.solve(&right, reduction, &mut self.values)
    }

    /// Fall of the head over every inner face, from the cell before to the cell after, per cell.
    pub fn inner_slopes<'a>(&'a self, network: &'a Network) -> impl Iterator<Item = f64> + 'a {
        let head = &self.values;
        network.edges.iter().map(|&[a, b]| head[a as usize] - head[b as usize])
    }

    /// Fall of the head over every open face, from west to east or from north to south, per cell.
    pub fn open_slopes<'a>(&'a self, network: &'a Network) -> impl Iterator<Item = f64> + 'a {
        network.open.iter().map(|open| {
            let fall = 2.0 * (known_head(open.end) - self.values[open.cell as usize]);
            if open.cell_is_after { fall } else { -fall }
        })
    }

    /// |∇η|² of every cell.
    fn slopes_squared(&self, network: &Network) -> Vec<f64> {
        let mut squared = vec![0.0; self.values.len()];
        for (slope, &[a, b]) in self.inner_slopes(network).zip(&network.edges) {
            squared[a as usize] += 0.5 * slope * slope;
            squared[b as usize] += 0.5 * slope * slope;
        }
        for (slope, open) in self.open_slopes(network).zip(&network.open) {
            squared[open.cell as usize] += 0.5 * slope * slope;
        }
        squared
    }
}

fn known_head(end: End) -> f64 {
    match end {
        End::Inflow => 1.0,
        End::Outflow => 0.0,
    }
}

/// x^(2/3). From libm, so that flows are the same on every platform.
fn two_thirds_power(x: f64) -> f64 {
    let root = libm::cbrt(x);
    root * root
}
