//! The wet cells of a reach and the faces between them.

use super::section::{Face, faces};
use super::{End, FlowError, Section};
use crate::grid::Grid;

/// All cells that water can reach from both ends without crossing a section, numbered from 0 in the order of the grid.
pub(super) struct Network {
    /// Where each cell is stored in the grid.
    pub cells: Vec<usize>,
    /// The faces between two cells of the reach.
    pub inner: Vec<Face>,
    /// Numbers of the cells before and after each inner face: the smaller first, sorted by the larger.
    pub edges: Vec<[u32; 2]>,
    /// The faces on the two sections.
    pub open: Vec<OpenFace>,
}

/// A face through which water enters or leaves the reach.
pub(super) struct OpenFace {
    pub face: Face,
    /// The section it lies on.
    pub end: End,
    /// Number of the one cell of the reach beside it.
    pub cell: u32,
    /// Whether that is the cell after the face (east or south of it).
    pub cell_is_after: bool,
}

/// A face on one of the sections, with its wet sides.
struct Cut {
    face: Face,
    end: End,
    sides: [Option<usize>; 2],
}

impl Network {
    pub fn new(wet: &Grid<bool>, inflow: &Section, outflow: &Section) -> Result<Self, FlowError> {
        let mut parts = Parts::new(wet.values().len());
        let mut pairs = Vec::new();
        let mut cuts = Vec::new();
        for face in faces(wet) {
            let sides = face.sides(wet);
            if sides.iter().flatten().any(|&cell| !wet.values()[cell]) {
                continue;
            }
            if face.crossing(wet, inflow) != 0.0 {
                let end = End::Inflow;
                cuts.push(Cut { face, end, sides });
            } else if face.crossing(wet, outflow) != 0.0 {
                let end = End::Outflow;
                cuts.push(Cut { face, end, sides });
            } else if let [Some(before), Some(after)] = sides {
                parts.join(before, after);
                pairs.push((face, before, after));
            }
            // What is left, the border of the grid where no section lies on it, is a wall.
        }
        for (end, section) in [(End::Inflow, inflow), (End::Outflow, outflow)] {
            if !cuts.iter().any(|cut| cut.end == end) {
                return Err(FlowError::NoWater { end, section: *section, extent: wet.extent() });
            }
        }
        Self::between(wet, &mut parts, &pairs, &cuts)
    }

    /// Keeps the parts of the water that touch both sections.
    fn between(
        wet: &Grid<bool>,
        parts: &mut Parts,
        pairs: &[(Face, usize, usize)],
        cuts: &[Cut],
    ) -> Result<Self, FlowError> {
        let mut touches = vec![[false; 2]; wet.values().len()];
        for cut in cuts {
            for &cell in cut.sides.iter().flatten() {
                touches[parts.root(cell)][(cut.end == End::Outflow) as usize] = true;
            }
        }
        let mut number = vec![None; wet.values().len()];
        let mut cells = Vec::new();
        for (cell, &wet) in wet.values().iter().enumerate() {
            if wet && touches[parts.root(cell)] == [true; 2] {
                number[cell] = Some(cells.len() as u32);
                cells.push(cell);
            }
        }
        if cells.is_empty() {
            return Err(FlowError::NotConnected);
        }
        let (inner, edges) = inner_faces(pairs, &number);
        let open = open_faces(cuts, &number)?;
        Ok(Self { cells, inner, edges, open })
    }
}

/// The faces between two cells that have a number, sorted by the larger number, and those numbers.
fn inner_faces(pairs: &[(Face, usize, usize)], number: &[Option<u32>]) -> (Vec<Face>, Vec<[u32; 2]>) {
    let mut inner: Vec<(Face, [u32; 2])> =
        pairs.iter().filter_map(|&(face, before, after)| Some((face, [number[before]?, number[after]?]))).collect();
    inner.sort_by_key(|(_, [before, after])| (*after, *before));
    inner.into_iter().unzip()
}

/// The cut faces beside exactly one cell that has a number.
fn open_faces(cuts: &[Cut], number: &[Option<u32>]) -> Result<Vec<OpenFace>, FlowError> {
    let mut open = Vec::new();
    for cut in cuts {
        let [before, after] = cut.sides.map(|side| side.and_then(|cell| number[cell]));
        let (cell, cell_is_after) = match (before, after) {
            (Some(_), Some(_)) => return Err(FlowError::PassedRound(cut.end)),
            (Some(before), None) => (before, false),
            (None, Some(after)) => (after, true),
            (None, None) => continue,
        };
        open.push(OpenFace { face: cut.face, end: cut.end, cell, cell_is_after });
    }
    Ok(open)
}

/// Connected parts of a set of cells, as a forest whose roots stand for the parts.
struct Parts {
    parent: Vec<usize>,
}

impl Parts {
    fn new(count: usize) -> Self {
        Self { parent: (0..count).collect() }
    }

    fn root(&mut self, mut cell: usize) -> usize {
        while self.parent[cell] != cell {
            // Halving the path at each look-up keeps the trees flat.
            self.parent[cell] = self.parent[self.parent[cell]];
            cell = self.parent[cell];
        }
        cell
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b);
    }
}
