//! More triangles for the same solid.

use super::{Hull, edges, undirected};
use glam::Vec3;
use std::collections::{BTreeMap, BinaryHeap};

impl Hull {
    /// The same solid with edges no longer than `longest_edge` (m), as far as that takes no more than `most` triangles.
    ///
    /// The longest edge is split at its middle, and with it all triangles that meet there, so the surface stays closed; and again,
    /// until none is too long (Rivara, *Algorithms for refining triangular grids*, 1984). A length that is not positive splits as
    /// often as `most` allows; one that is not a number, never.
    pub fn refined(self, longest_edge: f32, most: usize) -> Self {
        let mut refinement = Refinement::new(self.points, &self.triangles);
        while let Some((length, from, to)) = refinement.longest.pop() {
            let Some(sides) = refinement.sides.get(&(from, to)) else { continue };
            let room = refinement.triangles.len() + sides.len() <= most;
            let too_long = f32::from_bits(length) > longest_edge;
            if !(room && too_long && refinement.split(from, to)) {
                break;
            }
        }
        let Refinement { points, triangles, origin, .. } = refinement;
        let (outer, inner): (Vec<_>, Vec<_>) =
            triangles.into_iter().zip(origin).partition(|&(_, origin)| origin < self.shared);
        let shared = outer.len();
        let triangles = outer.into_iter().chain(inner).map(|(triangle, _)| triangle).collect();
        Self { points, triangles, shared, ..self }
    }
}

/// A surface while its edges are split.
struct Refinement {
    points: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// The triangle of the hull that each is a part of.
    origin: Vec<usize>,
    /// The triangles at each edge.
    sides: BTreeMap<(u32, u32), Vec<usize>>,
    /// Edges by length in m, as bits: those of positive floats are ordered as the floats are.
    longest: BinaryHeap<(u32, u32, u32)>,
}

impl Refinement {
    fn new(points: Vec<Vec3>, triangles: &[[u32; 3]]) -> Self {
        let mut sides = BTreeMap::<_, Vec<_>>::new();
        for (i, &triangle) in triangles.iter().enumerate() {
            edges(triangle).into_iter().for_each(|edge| sides.entry(undirected(edge)).or_default().push(i));
        }
        let mut refinement = Self {
            points,
            triangles: triangles.to_vec(),
            origin: (0..triangles.len()).collect(),
            sides: BTreeMap::new(),
            longest: BinaryHeap::new(),
        };
        sides.keys().for_each(|&edge| refinement.queue(edge));
        Self { sides, ..refinement }
    }

    fn queue(&mut self, edge: (u32, u32)) {
        let (from, to) = undirected(edge);
        let length = self.points[from as usize].distance(self.points[to as usize]);
        self.longest.push((length.to_bits(), from, to));
    }

    /// Splits the triangles at an edge. Returns whether there is a point between its ends.
    fn split(&mut self, from: u32, to: u32) -> bool {
        let [start, end] = [self.points[from as usize], self.points[to as usize]];
        let middle = start.midpoint(end);
        if middle == start || middle == end {
            return false;
        }
        let point = self.points.len() as u32;
        self.points.push(middle);
        self.queue((from, point));
        self.queue((point, to));
        for side in self.sides.remove(&(from, to)).unwrap_or_default() {
            self.halve(side, from, to, point);
        }
        true
    }

    /// Cuts a triangle from the middle of an edge to its opposite corner.
    fn halve(&mut self, triangle: usize, from: u32, to: u32, middle: u32) {
        let corners = self.triangles[triangle];
        let half = self.triangles.len();
        let with = |old: u32| corners.map(|corner| if corner == old { middle } else { corner });
        self.triangles[triangle] = with(to);
        self.triangles.push(with(from));
        self.origin.push(self.origin[triangle]);
        let opposite = corners.into_iter().find(|corner| *corner != from && *corner != to).unwrap_or(from);
        for side in self.sides.entry(undirected((opposite, to))).or_default() {
            if *side == triangle {
                *side = half;
            }
        }
        self.queue((opposite, middle));
        self.sides.entry(undirected((opposite, middle))).or_default().extend([triangle, half]);
        self.sides.entry(undirected((from, middle))).or_default().push(triangle);
        self.sides.entry(undirected((middle, to))).or_default().push(half);
    }
}
