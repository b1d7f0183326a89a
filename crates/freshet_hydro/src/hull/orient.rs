//! Which pieces of a surface bound what water cannot enter, and which way round their triangles go.

use super::inside::winding;
use super::{HullError, area_vector, bounds, corners, edges, undirected};
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;

/// Most triangles of a shell at whose middles is asked whether it lies within another.
const PROBES: usize = 8;

/// How far below the faces of a shell is asked, as a share of its length: more than rounding, so that shells which touch are told apart.
const DEPTH: f64 = 1e-3;

/// A connected piece of the surface.
struct Shell {
    triangles: Vec<[u32; 3]>,
    /// Signed, m³.
    volume: f64,
    bounds: [Vec3; 2],
}

/// The triangles of the outermost shells, counter-clockwise seen from outside, as [`Hull::new`](super::Hull::new) says.
pub(super) fn oriented(points: &[Vec3], triangles: Vec<[u32; 3]>) -> Result<Vec<[u32; 3]>, HullError> {
    if triangles.is_empty() {
        return Err(HullError::Flat);
    }
    let mut shells = shells(points, triangles);
    closed(points, shells.iter().flat_map(|shell| &shell.triangles))?;
    // Whatever holds another shell is larger than it, so what lies around a shell is settled before the shell is.
    shells.sort_by(|a, b| b.volume.abs().total_cmp(&a.volume.abs()));
    let mut outermost = Vec::<Shell>::with_capacity(shells.len());
    for shell in shells {
        if !outermost.iter().any(|around| around.holds(points, &shell)) {
            outermost.push(shell.outward());
        }
    }
    Ok(outermost.into_iter().flat_map(|shell| shell.triangles).collect())
}

impl Shell {
    fn new(points: &[Vec3], triangles: Vec<[u32; 3]>) -> Self {
        let own: Vec<_> = triangles.as_flattened().iter().map(|&point| points[point as usize]).collect();
        let origin = own[0].as_dvec3();
        let tetrahedron = |&triangle: &[u32; 3]| {
            let [a, b, c] = corners(points, triangle).map(|corner| corner - origin);
            a.dot(b.cross(c)) / 6.0
        };
        let volume = triangles.iter().map(tetrahedron).sum();
        Self { triangles, volume, bounds: bounds(&own) }
    }

    /// The shell with its normals to the outside.
    fn outward(mut self) -> Self {
        if self.volume < 0.0 {
            self.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        self
    }

    /// Whether `other` lies within this shell, whichever way round its triangles go: with its box, and with what is just
    /// below the middles of its faces.
    fn holds(&self, points: &[Vec3], other: &Self) -> bool {
        let may_hold = self.bounds[0].cmple(other.bounds[0]).all() && other.bounds[1].cmple(self.bounds[1]).all();
        may_hold && other.probes(points).all(|probe| winding(points, &self.triangles, probe) > 0.5)
    }

    /// Points just below the middles of some of its triangles, spread over the shell, m. Thin ones are as good as others.
    fn probes(&self, points: &[Vec3]) -> impl Iterator<Item = DVec3> {
        let step = self.triangles.len().div_ceil(PROBES);
        let depth = DEPTH * libm::cbrt(self.volume);
        self.triangles.iter().step_by(step).map(move |&triangle| {
            let [a, b, c] = corners(points, triangle);
            (a + b + c) / 3.0 - depth * area_vector([a, b, c]).normalize_or_zero()
        })
    }
}

/// The connected pieces of the surface, each wound one way.
///
/// Goes from triangle to triangle over their edges and turns each as the one before.
fn shells(points: &[Vec3], mut triangles: Vec<[u32; 3]>) -> Vec<Shell> {
    let neighbours = neighbours(&triangles);
    let mut seen = vec![false; triangles.len()];
    let mut shells = Vec::new();
    for seed in 0..triangles.len() {
        if seen[seed] {
            continue;
        }
        seen[seed] = true;
        let (mut members, mut next) = (vec![seed], 0);
        while let Some(&triangle) = members.get(next) {
            next += 1;
            for &other in &neighbours[triangle] {
                if !seen[other] {
                    seen[other] = true;
                    members.push(other);
                    if edges(triangles[triangle]).iter().any(|edge| edges(triangles[other]).contains(edge)) {
                        triangles[other].swap(1, 2);
                    }
                }
            }
        }
        members.sort_unstable();
        shells.push(Shell::new(points, members.into_iter().map(|i| triangles[i]).collect()));
    }
    shells
}

/// The triangles beyond each triangle's edges.
///
/// Where several parts share an edge, more than two triangles meet there. They are paired in the order of the list, because meshes
/// are written part by part: those of opposite directions if there are as many of them, and otherwise one after the other.
fn neighbours(triangles: &[[u32; 3]]) -> Vec<Vec<usize>> {
    let mut at_edge = BTreeMap::<(u32, u32), [Vec<usize>; 2]>::new();
    for (i, &triangle) in triangles.iter().enumerate() {
        for edge in edges(triangle) {
            at_edge.entry(undirected(edge)).or_default()[usize::from(edge.0 < edge.1)].push(i);
        }
    }
    let mut neighbours = vec![Vec::with_capacity(3); triangles.len()];
    let mut join = |a: usize, b: usize| {
        neighbours[a].push(b);
        neighbours[b].push(a);
    };
    for [back, forth] in at_edge.values() {
        if back.len() == forth.len() {
            back.iter().zip(forth).for_each(|(&a, &b)| join(a, b));
        } else {
            let mut sides = [back.as_slice(), forth].concat();
            sides.sort_unstable();
            sides.chunks_exact(2).for_each(|pair| join(pair[0], pair[1]));
        }
    }
    neighbours
}

/// Whether every edge is passed as often one way as the other.
fn closed<'a>(points: &[Vec3], triangles: impl Iterator<Item = &'a [u32; 3]>) -> Result<(), HullError> {
    let mut balance = BTreeMap::<(u32, u32), i32>::new();
    for edge in triangles.flat_map(|&triangle| edges(triangle)) {
        *balance.entry(undirected(edge)).or_default() += if edge.0 < edge.1 { 1 } else { -1 };
    }
    let mut open = balance.into_iter().filter(|&(_, balance)| balance != 0).map(|(edge, _)| edge);
    match open.next() {
        None => Ok(()),
        Some((from, to)) => {
            Err(HullError::Open { edges: 1 + open.count(), from: points[from as usize], to: points[to as usize] })
        }
    }
}
