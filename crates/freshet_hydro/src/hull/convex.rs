//! What convex solids have in common.

use super::{Hull, area_vector, bounds, boxes_meet, corners, undirected};
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;

/// Two solids that share less than this part of the smaller one only touch: ten times what the points of an `f32` are rounded by.
const TOUCHING: f64 = 1e-6;

/// A convex solid: its points, and the polygons between them, counter-clockwise seen from outside.
#[derive(Debug, Clone)]
pub(super) struct Convex {
    points: Vec<DVec3>,
    faces: Vec<Vec<u32>>,
    planes: Vec<Plane>,
    bounds: [Vec3; 2],
    volume: f64,
    /// How far a point may be off a plane and yet on it, m.
    rounding: f64,
}

/// The points x with n·x = d, and n towards the outside.
#[derive(Debug, Clone, Copy)]
struct Plane {
    normal: DVec3,
    offset: f64,
}

impl Convex {
    /// The solid of a hull, or `None` if the hull is not convex.
    ///
    /// It is, if no point lies beyond the plane of any triangle. Points are rounded to ε times their largest coordinate, and a
    /// triangle of height h leans by ε/h, which is allowed for over the diagonal of the bounding box.
    pub(super) fn of(hull: &Hull) -> Option<Self> {
        if hull.shared < hull.triangles.len() {
            return None;
        }
        let points: Vec<_> = hull.points.iter().map(|point| point.as_dvec3()).collect();
        let bounds = hull.bounds();
        let [min, max] = bounds.map(|corner| corner.as_dvec3());
        let diagonal = (max - min).length();
        let rounding = f64::from(f32::EPSILON) * min.abs().max(max.abs()).max_element();
        let mut planes = Vec::with_capacity(hull.triangles.len());
        for &triangle in &hull.triangles {
            let [a, b, c] = corners(&hull.points, triangle);
            let across = area_vector([a, b, c]);
            let longest = (b - a).length().max((c - b).length()).max((a - c).length());
            let height = across.length() / longest;
            if height > rounding {
                let normal = across.normalize();
                let offset = points.iter().map(|point| normal.dot(*point)).fold(f64::NEG_INFINITY, f64::max);
                if offset > normal.dot(a) + 4.0 * rounding * (1.0 + diagonal / height) {
                    return None;
                }
                planes.push(Plane { normal, offset });
            }
        }
        let faces = hull.triangles.iter().map(|triangle| triangle.to_vec()).collect();
        Some(Self { points, faces, planes, bounds, volume: f64::from(hull.volume), rounding })
    }

    /// What both solids hold, or `None` if they do no more than touch.
    pub(super) fn intersection(&self, other: &Self) -> Option<Self> {
        if !boxes_meet(self.bounds, other.bounds) {
            return None;
        }
        let mut common = Self { rounding: self.rounding.max(other.rounding), ..self.clone() };
        for &plane in &other.planes {
            common.clip(plane)?;
        }
        common.volume = common.measure();
        if common.volume <= TOUCHING * self.volume.min(other.volume) {
            return None;
        }
        common.planes.extend_from_slice(&other.planes);
        let points: Vec<_> = common.points.iter().map(|point| point.as_vec3()).collect();
        common.bounds = bounds(&points);
        Some(common)
    }

    /// Adds the surface to a list of points and triangles, clockwise seen from outside if `reversed`.
    pub(super) fn append(&self, points: &mut Vec<Vec3>, triangles: &mut Vec<[u32; 3]>, reversed: bool) {
        let first = points.len() as u32;
        points.extend(self.points.iter().map(|point| point.as_vec3()));
        let wound = |[a, b, c]: [u32; 3]| if reversed { [a, c, b] } else { [a, b, c] };
        triangles.extend(self.triangles().map(|triangle| wound(triangle.map(|point| first + point))));
    }

    /// Every face as a fan of triangles.
    fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        self.faces.iter().flat_map(|face| face.windows(2).skip(1).map(|pair| [face[0], pair[0], pair[1]]))
    }

    /// Volume by the divergence theorem, m³.
    fn measure(&self) -> f64 {
        let Some(&origin) = self.points.first() else { return 0.0 };
        let tetrahedron = |triangle: [u32; 3]| {
            let [a, b, c] = triangle.map(|point| self.points[point as usize] - origin);
            a.dot(b.cross(c)) / 6.0
        };
        self.triangles().map(tetrahedron).sum()
    }

    /// Takes away what lies beyond a plane. `None` if nothing is left.
    fn clip(&mut self, plane: Plane) -> Option<()> {
        let distance: Vec<f64> = self
            .points
            .iter()
            .map(|point| plane.normal.dot(*point) - plane.offset)
            .map(|distance| if distance.abs() <= self.rounding { 0.0 } else { distance })
            .collect();
        if !distance.iter().any(|distance| *distance < 0.0) {
            return None;
        }
        if !distance.iter().any(|distance| *distance > 0.0) {
            return Some(());
        }
        let mut cut = Cut { distance, crossings: BTreeMap::new() };
        let faces = std::mem::take(&mut self.faces);
        self.faces = faces.iter().map(|face| cut.kept(face, &mut self.points)).filter(|face| face.len() > 2).collect();
        let caps = caps(cut.open_edges(&self.faces));
        self.faces.extend(caps);
        self.forget_unused();
        Some(())
    }

    /// Drops points that no face uses any more.
    fn forget_unused(&mut self) {
        let mut place = vec![u32::MAX; self.points.len()];
        let mut points = Vec::new();
        for point in self.faces.iter_mut().flatten() {
            let place = &mut place[*point as usize];
            if *place == u32::MAX {
                *place = points.len() as u32;
                points.push(self.points[*point as usize]);
            }
            *point = *place;
        }
        self.points = points;
    }
}

/// A plane through a solid.
struct Cut {
    /// Of each point from the plane, m, positive outside and zero on it.
    distance: Vec<f64>,
    /// The new point on each edge that crosses the plane: one for both its faces.
    crossings: BTreeMap<(u32, u32), u32>,
}

impl Cut {
    /// What is left of a face (Sutherland & Hodgman, *Reentrant polygon clipping*, 1974).
    fn kept(&mut self, face: &[u32], points: &mut Vec<DVec3>) -> Vec<u32> {
        let mut kept = Vec::with_capacity(face.len() + 1);
        for (i, &from) in face.iter().enumerate() {
            let to = face[(i + 1) % face.len()];
            if self.distance[from as usize] <= 0.0 {
                kept.push(from);
            }
            if self.distance[from as usize] * self.distance[to as usize] < 0.0 {
                kept.push(self.crossing(undirected((from, to)), points));
            }
        }
        kept
    }

    fn crossing(&mut self, (from, to): (u32, u32), points: &mut Vec<DVec3>) -> u32 {
        *self.crossings.entry((from, to)).or_insert_with(|| {
            let [near, far] = [from, to].map(|point| self.distance[point as usize]);
            points.push(points[from as usize].lerp(points[to as usize], near / (near - far)));
            points.len() as u32 - 1
        })
    }

    /// Edges in the plane that have a face on one side only, in the direction that the missing face takes.
    fn open_edges(&self, faces: &[Vec<u32>]) -> Vec<(u32, u32)> {
        // Points beyond the list are crossings.
        let on_plane = |point: u32| self.distance.get(point as usize).is_none_or(|distance| *distance == 0.0);
        let mut balance = BTreeMap::<(u32, u32), i32>::new();
        for face in faces {
            for (i, &from) in face.iter().enumerate() {
                let to = face[(i + 1) % face.len()];
                if on_plane(from) && on_plane(to) {
                    *balance.entry(undirected((from, to))).or_default() += if from < to { 1 } else { -1 };
                }
            }
        }
        let missing = |((low, high), balance): ((u32, u32), i32)| {
            let edge = if balance > 0 { (high, low) } else { (low, high) };
            std::iter::repeat_n(edge, balance.unsigned_abs() as usize)
        };
        balance.into_iter().flat_map(missing).collect()
    }
}

/// The polygons that close the surface: every edge leads to one that starts where it ends, because those of a closed surface do, and
/// so the rounding of points cannot open it.
fn caps(mut open: Vec<(u32, u32)>) -> Vec<Vec<u32>> {
    let mut caps = Vec::new();
    while let Some((first, mut at)) = open.pop() {
        let mut cap = vec![first];
        while at != first {
            let Some(next) = open.iter().position(|edge| edge.0 == at) else { break };
            cap.push(at);
            at = open.swap_remove(next).1;
        }
        if cap.len() > 2 {
            caps.push(cap);
        }
    }
    caps
}
