//! Fewer triangles for nearly the same solid.
//!
//! Edges are collapsed to points, those first that change the surface least (Garland & Heckbert, *Surface simplification using quadric
//! error metrics*, 1997 \[GH97\]), and what the solid holds is then restored.

use super::{Hull, area_vector, undirected};
use glam::{DMat3, DVec3, Vec3};
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// A triangle may not turn by more than this cosine in a collapse: 78°.
const LEAST_TURN: f64 = 0.2;

/// Triangles do not become lower than this share of their longest edge.
const THIN: f64 = 0.01;

/// Share of the squared distance from a triangle's middle in what a point costs. A trifle keeps points from sliding along flat places,
/// where they cost nothing otherwise.
const ATTRACTION: f64 = 1e-6;

impl Hull {
    /// Nearly the same shape with at most `most` triangles, and with the same volume and centroid.
    ///
    /// The surface stays closed and in one piece. If that allows no fewer, there are more than `most`. A union whose parts overlap
    /// comes back unchanged: simplify its parts.
    pub fn simplified(self, most: usize) -> Self {
        if self.triangles.len() <= most || self.shared < self.triangles.len() {
            return self;
        }
        let mut collapse = Collapse::new(&self);
        while collapse.alive > most
            && let Some(edge) = collapse.next()
        {
            collapse.merge(edge);
        }
        let (points, triangles) = collapse.surface();
        self.restored(points, triangles).unwrap_or(self)
    }

    /// Another surface with this hull's volume and centroid: scaled about its centroid, and moved. `None` if it holds nothing.
    fn restored(&self, points: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Option<Self> {
        let shared = triangles.len();
        let hull = Self::measured(points, triangles, shared).and_then(|hull| hull.with_volume(self.volume)).ok()?;
        let aside = self.centroid.as_dvec3() - hull.centroid.as_dvec3();
        hull.moved(|point| point + aside).ok()
    }
}

/// A surface while its edges collapse.
struct Collapse {
    /// Seen from the hull's centroid, m.
    points: Vec<DVec3>,
    quadrics: Vec<Quadric>,
    /// How often each point has changed: an edge in the queue is outdated if it was queued before.
    versions: Vec<u32>,
    triangles: Vec<Option<[u32; 3]>>,
    /// The triangles at each point, with some that are gone.
    around: Vec<Vec<u32>>,
    alive: usize,
    cheapest: BinaryHeap<Reverse<Edge>>,
    /// Edges that may not collapse as long as their surroundings are what they are.
    blocked: BTreeSet<(u32, u32)>,
}

/// An edge that may collapse. Sorted by cost, as the bits of a positive float.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    cost: u64,
    ends: (u32, u32),
    versions: (u32, u32),
}

impl Collapse {
    fn new(hull: &Hull) -> Self {
        let centre = hull.centroid.as_dvec3();
        let count = hull.points.len();
        let mut collapse = Self {
            points: hull.points.iter().map(|point| point.as_dvec3() - centre).collect(),
            quadrics: vec![Quadric::NONE; count],
            versions: vec![0; count],
            triangles: hull.triangles.iter().copied().map(Some).collect(),
            around: vec![Vec::new(); count],
            alive: hull.triangles.len(),
            cheapest: BinaryHeap::new(),
            blocked: BTreeSet::new(),
        };
        for (i, &triangle) in hull.triangles.iter().enumerate() {
            let quadric = Quadric::of(triangle.map(|point| collapse.points[point as usize]));
            for point in triangle {
                collapse.quadrics[point as usize].add(&quadric);
                collapse.around[point as usize].push(i as u32);
            }
        }
        let edges: BTreeSet<_> =
            hull.triangles.iter().flat_map(|&triangle| super::edges(triangle)).map(undirected).collect();
        edges.into_iter().for_each(|edge| collapse.queue(edge));
        collapse
    }

    fn queue(&mut self, ends: (u32, u32)) {
        let (_, cost) = self.target(ends);
        let versions = (self.versions[ends.0 as usize], self.versions[ends.1 as usize]);
        self.cheapest.push(Reverse(Edge { cost: cost.max(0.0).to_bits(), ends, versions }));
    }

    /// Where the point goes to which an edge collapses, and the error there, m⁴.
    fn target(&self, (from, to): (u32, u32)) -> (DVec3, f64) {
        let mut quadric = self.quadrics[from as usize];
        quadric.add(&self.quadrics[to as usize]);
        let [a, b] = [self.points[from as usize], self.points[to as usize]];
        let candidates = [a, b, 0.5 * (a + b)].into_iter().chain(quadric.best_near(0.5 * (a + b), a.distance(b)));
        let with_error = candidates.map(|point| (point, quadric.error(point)));
        with_error.min_by(|x, y| x.1.total_cmp(&y.1)).unwrap_or((a, f64::INFINITY))
    }

    /// The cheapest edge that may collapse.
    fn next(&mut self) -> Option<(u32, u32)> {
        while let Some(Reverse(edge)) = self.cheapest.pop() {
            let (from, to) = edge.ends;
            let current = edge.versions == (self.versions[from as usize], self.versions[to as usize]);
            if current && self.keeps_surface(from, to) && self.keeps_sides(edge.ends) {
                return Some(edge.ends);
            }
            if current {
                self.blocked.insert(edge.ends);
            }
        }
        None
    }

    fn triangles_at(&self, point: u32) -> impl Iterator<Item = [u32; 3]> {
        self.around[point as usize].iter().filter_map(|&triangle| self.triangles[triangle as usize])
    }

    fn neighbours(&self, point: u32) -> BTreeSet<u32> {
        self.triangles_at(point).flatten().filter(|other| *other != point).collect()
    }

    /// The link condition (Dey et al., *Topology preserving edge contraction*, 1999): the ends of the edge have no other neighbours in
    /// common than the opposite corners of its two triangles, and those two do not make up all of the surface.
    fn keeps_surface(&self, from: u32, to: u32) -> bool {
        let common = self.neighbours(from).intersection(&self.neighbours(to)).count();
        let sides = self.triangles_at(from).filter(|triangle| triangle.contains(&to)).count();
        common == 2 && sides == 2 && self.triangles_at(from).count() + self.triangles_at(to).count() > 6
    }

    /// Whether no triangle turns over or becomes a line, at which none could say whether it turns over next time.
    fn keeps_sides(&self, (from, to): (u32, u32)) -> bool {
        let (target, _) = self.target((from, to));
        let kept = |point: u32, other: u32| {
            self.triangles_at(point).filter(move |triangle| !triangle.contains(&other)).all(|triangle| {
                let place = |corner: u32| self.points[corner as usize];
                let before = triangle.map(place);
                let after = triangle.map(|corner| if corner == point { target } else { place(corner) });
                let [old, new] = [before, after].map(area_vector);
                old.dot(new) >= LEAST_TURN * old.length() * new.length() && height(after) >= THIN.min(height(before))
            })
        };
        kept(from, to) && kept(to, from)
    }

    /// Collapses an edge to a point, which takes the place of its first end.
    fn merge(&mut self, (from, to): (u32, u32)) {
        let (target, _) = self.target((from, to));
        let other = self.quadrics[to as usize];
        self.quadrics[from as usize].add(&other);
        self.points[from as usize] = target;
        self.versions[from as usize] += 1;
        self.versions[to as usize] += 1;
        for index in std::mem::take(&mut self.around[to as usize]) {
            let Some(triangle) = &mut self.triangles[index as usize] else { continue };
            if triangle.contains(&from) {
                self.triangles[index as usize] = None;
                self.alive -= 1;
            } else {
                *triangle = triangle.map(|corner| if corner == to { from } else { corner });
                self.around[from as usize].push(index);
            }
        }
        let triangles = &self.triangles;
        self.around[from as usize].retain(|&triangle| triangles[triangle as usize].is_some());
        for point in self.neighbours(from) {
            self.blocked.remove(&undirected((from, point)));
            self.queue(undirected((from, point)));
            for beyond in self.neighbours(point) {
                if self.blocked.remove(&undirected((point, beyond))) {
                    self.queue(undirected((point, beyond)));
                }
            }
        }
    }

    /// What is left, without the points that are gone.
    fn surface(&self) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let mut place = vec![u32::MAX; self.points.len()];
        let mut points = Vec::new();
        let mut triangles: Vec<[u32; 3]> = self.triangles.iter().copied().flatten().collect();
        for corner in triangles.as_flattened_mut() {
            let place = &mut place[*corner as usize];
            if *place == u32::MAX {
                *place = points.len() as u32;
                points.push(self.points[*corner as usize].as_vec3());
            }
            *corner = *place;
        }
        (points, triangles)
    }
}

/// Height of a triangle as a share of its longest edge.
fn height([a, b, c]: [DVec3; 3]) -> f64 {
    let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    if longest > 0.0 { area_vector([a, b, c]).length() / longest } else { 0.0 }
}

/// The sum of the squared distances from planes, each with its triangle's area as weight: xᵀA x + 2 b·x + c (\[GH97\] eq. 2), m⁴.
#[derive(Clone, Copy)]
struct Quadric {
    a: DMat3,
    b: DVec3,
    c: f64,
}

impl Quadric {
    const NONE: Self = Self { a: DMat3::ZERO, b: DVec3::ZERO, c: 0.0 };

    /// Of a triangle's plane, and a small share of the squared distance from its middle.
    fn of(corners: [DVec3; 3]) -> Self {
        let across = area_vector(corners);
        let (area, normal) = (0.5 * across.length(), across.normalize_or_zero());
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let offset = -normal.dot(middle);
        let pull = ATTRACTION * area;
        let planes = DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z) * area;
        Self {
            a: planes + DMat3::from_diagonal(DVec3::splat(pull)),
            b: normal * (offset * area) - middle * pull,
            c: offset * offset * area + pull * middle.length_squared(),
        }
    }

    fn add(&mut self, other: &Self) {
        self.a += other.a;
        self.b += other.b;
        self.c += other.c;
    }

    fn error(&self, point: DVec3) -> f64 {
        point.dot(self.a * point) + 2.0 * self.b.dot(point) + self.c
    }

    /// Where the error is least, if that is within `reach` of a place: elsewhere the planes are nearly parallel.
    fn best_near(&self, place: DVec3, reach: f64) -> Option<DVec3> {
        let best = self.a.inverse() * -self.b;
        (best.is_finite() && best.distance(place) <= reach).then_some(best)
    }
}
