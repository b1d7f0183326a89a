//! What happens at the four sides of the domain.
use super::scheme::{Flux, Side, riemann, wall};
use crate::waves::GRAVITY;

/// A side of the domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DomainSide {
    /// Smallest x, column 0.
    West,
    /// Largest x, last column.
    East,
    /// Smallest z, row 0.
    North,
    /// Largest z, last row.
    South,
}

impl DomainSide {
    /// All sides, in the order of their numbers.
    pub const ALL: [Self; 4] = [Self::West, Self::East, Self::North, Self::South];
}

/// What the outside of one cell of a side does at this instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum EdgeCell {
    /// Nothing passes, water slides along.
    #[default]
    Wall,
    /// Water leaves as it comes; none enters.
    Open,
    /// Water at this level, m, goes on outside for ever with this speed, m/s, inwards, so waves leave.
    Far { level: f32, entering: f32 },
    /// The water at the edge stands at this level, m, whatever comes.
    Level(f32),
    /// This much enters, m²/s; leaves, if negative.
    Discharge(f32),
}

/// The flux out of the domain through an edge.
///
/// `inside` is the water at its inner side, whose normal velocity points outwards; `bed` is its bed, m. [`Flux::before`] is
/// the momentum that leaves the inner cell.
pub(super) fn flux(inside: Side, edge: EdgeCell) -> Flux {
    let bed = inside.level - inside.depth;
    match edge {
        EdgeCell::Open if inside.normal > 0.0 => through(inside, inside.depth, inside.normal),
        EdgeCell::Wall | EdgeCell::Open => Flux { before: wall(inside.depth, inside.normal), ..Flux::default() },
        EdgeCell::Far { level, entering } => {
            let depth = (level - bed).max(0.0);
            let outside = Side { depth, level: level.max(bed), normal: -entering, tangential: 0.0 };
            riemann(inside, outside, f32::NEG_INFINITY, 0.0)
        }
        EdgeCell::Level(level) => {
            let celerity = (GRAVITY * inside.depth).sqrt();
            if inside.normal >= celerity && inside.depth > 0.0 {
                // Faster than its waves: no news of the outside can enter.
                return through(inside, inside.depth, inside.normal);
            }
            let depth = (level - bed).max(0.0);
            let outside = (GRAVITY * depth).sqrt();
            // The outgoing invariant u + 2c is that of the inside; inflow is critical at most.
            let normal = inside.normal + 2.0 * (celerity - outside);
            through(inside, depth, normal.clamp(-outside, outside.max(inside.normal)))
        }
        EdgeCell::Discharge(entering) if entering > 0.0 => {
            let celerity = celerity_from_discharge(inside, entering);
            through(inside, celerity * celerity / GRAVITY, -entering * GRAVITY / (celerity * celerity))
        }
        EdgeCell::Discharge(entering) => {
            // Water that is asked for and not there cannot leave.
            let celerity = (GRAVITY * inside.depth).sqrt();
            let leaving = (-entering).min(inside.depth * (inside.normal.max(0.0) + celerity));
            let depth = inside.depth.max(1e-6);
            through(inside, inside.depth, leaving / depth)
        }
    }
}

/// Celerity c, m/s, at an edge through which `entering` q > 0 (m²/s) flows: with u + 2c as inside,
/// `2 c³ − (u + 2c)ᵢₙ c² − g q = 0`, and c ≥ (g q)^⅓, where the inflow is critical.
fn celerity_from_discharge(inside: Side, entering: f32) -> f32 {
    let invariant = inside.normal + 2.0 * (GRAVITY * inside.depth).sqrt();
    let power = GRAVITY * entering;
    let critical = libm::cbrtf(power);
    // Newton from above the only positive root falls to it monotonically.
    let mut celerity = 0.5 * invariant.max(0.0) + libm::cbrtf(0.5 * power);
    for _ in 0..8 {
        let square = celerity * celerity;
        let value = 2.0 * square * celerity - invariant * square - power;
        let slope = 6.0 * square - 2.0 * invariant * celerity;
        celerity -= value / slope.max(1e-20);
    }
    celerity.max(critical)
}

/// The flux of water `depth` deep that leaves with the speed `normal` (negative: enters, without speed along the edge).
fn through(inside: Side, depth: f32, normal: f32) -> Flux {
    let mass = depth * normal;
    let pressure = 0.5 * GRAVITY * ((depth - inside.depth) * (depth + inside.depth));
    Flux { mass, before: mass * normal + pressure, after: 0.0, tangential: mass.max(0.0) * inside.tangential }
}
