//! Edges of the domain as they were asked for, and as every cell of a side has them at an instant.
use super::{DomainSide, Series, ShallowWaterError, edge::EdgeCell};
use crate::waves::GRAVITY;
use std::ops::Range;

/// What is outside a part of a side.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Edge {
    /// A wall along which water slides.
    #[default]
    Wall,
    /// Water leaves as it comes, and none enters: a river that goes on with the same slope. A trough that arrives is reflected,
    /// for to leave it would need water from outside.
    Open,
    /// Still water at this level, m, goes on for ever: crests and troughs leave, and the level inside tends to it.
    Still(Series),
    /// Water at this level, m, goes on for ever with this speed, m/s, inwards (negative: outwards): the river of which this is a part.
    /// Crests and troughs leave.
    Stream {
        /// Level, m.
        level: Series,
        /// Speed inwards, m/s.
        entering: Series,
    },
    /// The level at the edge is this, m, whatever comes: a tide, a reservoir. Waves are reflected.
    Level(Series),
    /// This much water enters, m³/s over the whole part, spread as critical flow would be. Negative: is taken, as far as there is any.
    Discharge(Series),
}

/// Faster, m/s, no stream enters.
const MOST_ENTERING: f32 = 1e3;

/// Part of a side.
#[derive(Clone, Debug, PartialEq)]
pub enum EdgePart {
    /// All of it.
    All,
    /// These cells, from the west or the north.
    Cells(Range<u32>),
}

/// A part of a side with its edge, and the share of a discharge of each of its cells, per metre.
#[derive(Clone, Debug)]
struct Part {
    side: DomainSide,
    cells: Range<usize>,
    edge: Edge,
}

/// All edges.
#[derive(Clone, Debug)]
pub(super) struct Edges {
    parts: Vec<Part>,
    /// Whether x and z wrap around.
    pub periodic: (bool, bool),
    /// Cells of the western, eastern, northern and southern side.
    pub cells: [Vec<EdgeCell>; 4],
    size: (usize, usize),
}

impl Edges {
    pub fn walls(columns: usize, rows: usize) -> Self {
        let walls = |count| vec![EdgeCell::Wall; count];
        let cells = [walls(rows), walls(rows), walls(columns), walls(columns)];
        Self { parts: Vec::new(), periodic: (false, false), cells, size: (columns, rows) }
    }

    pub fn set(&mut self, side: DomainSide, part: EdgePart, edge: Edge) -> Result<(), ShallowWaterError> {
        let count = self.cells[side as usize].len();
        let cells = match part {
            EdgePart::All => 0..count,
            EdgePart::Cells(cells) => {
                if cells.start >= cells.end || cells.end as usize > count {
                    return Err(ShallowWaterError::EdgeCells { cells, count: count as u32 });
                }
                cells.start as usize..cells.end as usize
            }
        };
        match &edge {
            Edge::Still(series) | Edge::Level(series) | Edge::Discharge(series) if !series.is_valid() => {
                return Err(ShallowWaterError::Series("an edge"));
            }
            Edge::Stream { level, entering } if !(level.is_valid() && entering.is_valid()) => {
                return Err(ShallowWaterError::Series("an edge"));
            }
            _ => {}
        }
        self.parts.retain(|part| part.side != side || part.cells.start < cells.start || part.cells.end > cells.end);
        self.parts.push(Part { side, cells, edge });
        Ok(())
    }

    /// Sets every cell to what its edge is at `time` (s). Returns the speed, m/s, of the fastest signal that may enter.
    pub fn update(&mut self, bed: &[f32], cell_size: f32, time: f64) -> f32 {
        let mut fastest = 0.0_f32;
        for cells in &mut self.cells {
            cells.fill(EdgeCell::Wall);
        }
        for part in &self.parts {
            let (columns, rows) = self.size;
            let side = part.side;
            let bed = |k: usize| match side {
                DomainSide::West => bed[k * columns],
                DomainSide::East => bed[k * columns + columns - 1],
                DomainSide::North => bed[k],
                DomainSide::South => bed[(rows - 1) * columns + k],
            };
            let cells = &mut self.cells[side as usize][part.cells.clone()];
            let start = part.cells.start;
            match &part.edge {
                Edge::Wall => cells.fill(EdgeCell::Wall),
                Edge::Open => cells.fill(EdgeCell::Open),
                Edge::Still(level) | Edge::Level(level) | Edge::Stream { level, .. } => {
                    let level = level.at(time);
                    let entering = if let Edge::Stream { entering, .. } = &part.edge { entering.at(time) } else { 0.0 };
                    let entering = entering.clamp(-MOST_ENTERING, MOST_ENTERING);
                    let is_given = matches!(part.edge, Edge::Level(_));
                    cells.fill(if is_given { EdgeCell::Level(level) } else { EdgeCell::Far { level, entering } });
                    for k in part.cells.clone() {
                        let celerity = (GRAVITY * (level - bed(k)).max(0.0)).sqrt();
                        fastest = fastest.max(2.0 * celerity + entering.abs());
                    }
                }
                Edge::Discharge(discharge) => {
                    let discharge = f64::from(discharge.at(time));
                    let width = f64::from(cell_size);
                    let level = level_of_critical_flow(part.cells.clone().map(bed), discharge.abs() / width);
                    for (k, cell) in cells.iter_mut().enumerate() {
                        let entering = unit_discharge(level, bed(start + k)).copysign(discharge);
                        *cell = EdgeCell::Discharge(entering as f32);
                        fastest = fastest.max(2.0 * libm::cbrtf(GRAVITY * entering.abs() as f32));
                    }
                }
            }
        }
        fastest
    }
}

/// Critical flow over `bed` at this level, m²/s: √g h^(3/2).
fn unit_discharge(level: f64, bed: f32) -> f64 {
    let depth = (level - f64::from(bed)).max(0.0);
    libm::sqrt(f64::from(GRAVITY) * depth) * depth
}

/// The level, m, at which critical flow over all these beds adds up to `discharge` (m²/s, ≥ 0), to the last bit of the sum.
fn level_of_critical_flow(beds: impl Iterator<Item = f32> + Clone, discharge: f64) -> f64 {
    let lowest = f64::from(beds.clone().fold(f32::INFINITY, f32::min));
    let flow = |level: f64| beds.clone().map(|bed| unit_discharge(level, bed)).sum::<f64>();
    // All of it through the lowest cell is an upper bound.
    let (mut low, mut high) = (lowest, lowest + libm::cbrt(discharge * discharge / f64::from(GRAVITY)) + 1e-12);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if flow(middle) < discharge { low = middle } else { high = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_discharge_is_spread_over_the_lower_bed_and_adds_up() {
        let mut edges = Edges::walls(5, 1);
        let bed = [3.0, 0.0, -1.0, 0.2, 9.0];
        edges.set(DomainSide::North, EdgePart::All, Edge::Discharge(12.0.into())).expect("a valid edge");
        edges.update(&bed, 2.0, 0.0);
        let entering: Vec<f32> = edges.cells[DomainSide::North as usize]
            .iter()
            .map(|cell| if let EdgeCell::Discharge(entering) = cell { *entering } else { f32::NAN })
            .collect();
        assert!((entering.iter().sum::<f32>() * 2.0 - 12.0).abs() < 1e-5, "{entering:?}");
        assert!(entering[0] == 0.0 && entering[4] == 0.0 && entering[2] > entering[1]);
    }

    #[test]
    fn parts_of_a_side_are_what_was_set_last() {
        let mut edges = Edges::walls(4, 4);
        edges.set(DomainSide::East, EdgePart::All, Edge::Open).expect("a valid edge");
        edges.set(DomainSide::East, EdgePart::Cells(1..3), Edge::Level(2.0.into())).expect("a valid edge");
        edges.update(&[0.0; 16], 1.0, 0.0);
        assert_eq!(
            edges.cells[DomainSide::East as usize],
            [EdgeCell::Open, EdgeCell::Level(2.0), EdgeCell::Level(2.0), EdgeCell::Open]
        );
        let outside = edges.set(DomainSide::East, EdgePart::Cells(3..5), Edge::Open);
        assert_eq!(outside, Err(ShallowWaterError::EdgeCells { cells: 3..5, count: 4 }));
    }
}
