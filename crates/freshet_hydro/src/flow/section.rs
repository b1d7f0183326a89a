//! Lines across a channel, and the cell faces they cross.

use glam::{DVec2, UVec2, Vec2};

use crate::grid::Grid;

/// A straight line across a channel, between two points in local (x, z) metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// One end.
    pub from: Vec2,
    /// The other end. Seen from above with north up, water that crosses from the left-hand to the right-hand side of
    /// someone walking to this end counts as positive.
    pub to: Vec2,
}

impl Section {
    /// The section between two points in local (x, z) metres.
    pub fn new(from: Vec2, to: Vec2) -> Self {
        Self { from, to }
    }

    /// Length in metres.
    pub fn length(&self) -> f32 {
        self.from.distance(self.to)
    }

    /// Unit vector to the right-hand side, in whose direction a discharge is positive; zero if the section is a point.
    pub fn normal(&self) -> Vec2 {
        (self.to - self.from).perp().normalize_or_zero()
    }

    /// How the way from `a` to `b` crosses the section: +1 to the right-hand side, −1 to the left, 0 not at all.
    ///
    /// A point on the line belongs to its right-hand side, so a line through cell centres still parts the cells in two.
    fn crossing(&self, a: Vec2, b: Vec2) -> f32 {
        let (from, a, b) = (self.from.as_dvec2(), a.as_dvec2(), b.as_dvec2());
        let along = self.to.as_dvec2() - from;
        let (right_a, right_b) = (along.perp_dot(a - from), along.perp_dot(b - from));
        if (right_a >= 0.0) == (right_b >= 0.0) {
            return 0.0;
        }
        let point: DVec2 = a + (b - a) * (right_a / (right_a - right_b));
        let share = along.dot(point - from) / along.length_squared();
        match (0.0..=1.0).contains(&share) {
            true if right_b >= 0.0 => 1.0,
            true => -1.0,
            false => 0.0,
        }
    }
}

/// The directions that faces look in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axis {
    /// Faces between west and east.
    X,
    /// Faces between north and south.
    Z,
}

impl Axis {
    fn unit(self) -> UVec2 {
        match self {
            Self::X => UVec2::X,
            Self::Z => UVec2::Y,
        }
    }
}

/// One face, between the cell before it (west or north) and the cell after it (east or south).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Face {
    pub axis: Axis,
    /// The cell after the face; one step off the grid at its eastern and southern border.
    after: UVec2,
}

impl Face {
    /// The cell before the face, `None` on the western or northern border of the grid.
    fn before(self) -> Option<UVec2> {
        let unit = self.axis.unit();
        self.after.cmpge(unit).all().then(|| self.after - unit)
    }

    /// Where the cells before and after the face are stored in `cells`; `None` outside it.
    pub fn sides<T>(self, cells: &Grid<T>) -> [Option<usize>; 2] {
        let before = self.before().and_then(|before| cells.index(before));
        [before, cells.index(self.after)]
    }

    /// How going over the face from the cell before to the cell after crosses `section`: +1, −1 or 0.
    pub fn crossing<T>(self, cells: &Grid<T>, section: &Section) -> f32 {
        let after = cells.position(self.after);
        let before = match self.before() {
            Some(before) => cells.position(before),
            None => after - self.axis.unit().as_vec2() * cells.cell_size(),
        };
        section.crossing(before, after)
    }
}

/// All faces of a grid of cells.
pub(super) fn faces<T>(cells: &Grid<T>) -> impl Iterator<Item = Face> {
    let size = cells.size();
    [Axis::X, Axis::Z].into_iter().flat_map(move |axis| {
        let end = size + axis.unit();
        (0..end.y).flat_map(move |z| (0..end.x).map(move |x| Face { axis, after: UVec2::new(x, z) }))
    })
}
