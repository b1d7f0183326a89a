//! Solids of revolution about y: an outline of lines and arcs, turned into triangles.

use super::{Hull, HullError};
use glam::{DVec2, Vec3};
use std::f64::consts::{PI, TAU};

/// Half of an outline, from its lowest point on the axis to its highest: x is the radius r, y the height, m.
pub(super) struct Profile {
    corners: Vec<DVec2>,
    smooth: Sums,
}

/// The sums ∫dV, ∫y dV and ∫y² dV over a solid: m³, m⁴, m⁵.
#[derive(Clone, Copy, Default)]
struct Sums([f64; 3]);

impl Profile {
    pub(super) fn from(start: DVec2) -> Self {
        Self { corners: vec![start], smooth: Sums::default() }
    }

    /// Goes on straight to `end`.
    pub(super) fn line(mut self, end: DVec2) -> Self {
        self.smooth.add_frustum(self.end(), end);
        self.corners.push(end);
        self
    }

    /// Goes on in a circle about `centre`, from one angle above the horizontal to another, counter-clockwise. The outline so far ends
    /// where the arc begins.
    pub(super) fn arc(mut self, centre: DVec2, radius: f64, from: f64, to: f64, steps: usize) -> Self {
        self.smooth.add_arc(centre, radius, from, to);
        self.corners.extend((1..=steps).map(|step| {
            let angle = from + (to - from) * step as f64 / steps as f64;
            centre + radius * DVec2::new(libm::cos(angle), libm::sin(angle))
        }));
        self
    }

    fn end(&self) -> DVec2 {
        self.corners[self.corners.len() - 1]
    }

    /// The solid with `sides` sides, with the volume and centroid of the smooth one.
    ///
    /// Corners on the surface leave the solid too small. It is stretched along the axis until the second moment there is that of the
    /// smooth solid, widened until the volume is, and moved until the centroid is.
    pub(super) fn hull(&self, sides: usize) -> Result<Hull, HullError> {
        let mut rough = Sums::default();
        self.corners.windows(2).for_each(|pair| rough.add_frustum(pair[0], pair[1]));
        // A polygon of n sides has n/2 sin(2π/n) of the square of its corners' distance as area, a circle π.
        let polygon = 0.5 * sides as f64 * libm::sin(TAU / sides as f64) / PI;
        let stretch = (self.smooth.spread() / rough.spread()).sqrt();
        let widen = (self.smooth.volume() / (rough.volume() * polygon * stretch)).sqrt();
        let rise = self.smooth.height() - rough.height() * stretch;

        let rings = self.corners.len() - 2;
        let mut points = Vec::with_capacity(rings * sides + 2);
        points.push(Vec3::new(0.0, (self.corners[0].y * stretch + rise) as f32, 0.0));
        for corner in &self.corners[1..=rings] {
            points.extend((0..sides).map(|side| {
                let angle = TAU * side as f64 / sides as f64;
                let (r, y) = (corner.x * widen, corner.y * stretch + rise);
                Vec3::new((r * libm::sin(angle)) as f32, y as f32, (r * libm::cos(angle)) as f32)
            }));
        }
        points.push(Vec3::new(0.0, (self.end().y * stretch + rise) as f32, 0.0));
        let triangles = triangles(rings as u32, sides as u32);
        let shared = triangles.len();
        Hull::measured(points, triangles, shared)
    }
}

/// Triangles between a lowest point, rings of points and a highest point.
fn triangles(rings: u32, sides: u32) -> Vec<[u32; 3]> {
    let top = rings * sides + 1;
    let at = |ring: u32, side: u32| 1 + ring * sides + side % sides;
    let mut triangles = Vec::with_capacity((2 * rings * sides) as usize);
    for side in 0..sides {
        triangles.push([0, at(0, side + 1), at(0, side)]);
        for ring in 1..rings {
            let [a, b] = [at(ring - 1, side), at(ring - 1, side + 1)];
            let [c, d] = [at(ring, side + 1), at(ring, side)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        triangles.push([at(rings - 1, side), at(rings - 1, side + 1), top]);
    }
    triangles
}

/// Places in −1…1 and weights of Gauss and Legendre's rule of three points, exact for polynomials up to the fifth degree: r² y² on a
/// straight line is of the fourth.
const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.774_596_669_241_483_4, 5.0 / 18.0)];

/// Parts into which an arc is cut to be integrated: with 32 of them the error is below 10⁻⁹.
const PARTS: usize = 32;

impl Sums {
    fn volume(&self) -> f64 {
        self.0[0]
    }

    /// Height of the centroid, m.
    fn height(&self) -> f64 {
        self.0[1] / self.0[0]
    }

    /// Second moment along the axis about the centroid, m².
    fn spread(&self) -> f64 {
        self.0[2] / self.0[0] - self.height().powi(2)
    }

    /// Adds a slice of the radius, height and thickness given, m.
    fn add_slice(&mut self, r: f64, y: f64, thickness: f64) {
        let volume = PI * r * r * thickness;
        self.0[0] += volume;
        self.0[1] += volume * y;
        self.0[2] += volume * y * y;
    }

    /// Adds what a straight piece of outline sweeps.
    fn add_frustum(&mut self, from: DVec2, to: DVec2) {
        for (place, weight) in GAUSS {
            let at = from.lerp(to, 0.5 + 0.5 * place);
            self.add_slice(at.x, at.y, weight * (to.y - from.y));
        }
    }

    /// Adds what an arc sweeps: y = y₀ + b sin α, and hence dy = b cos α dα.
    fn add_arc(&mut self, centre: DVec2, radius: f64, from: f64, to: f64) {
        let width = (to - from) / PARTS as f64;
        for part in 0..PARTS {
            for (place, weight) in GAUSS {
                let angle = from + width * (part as f64 + 0.5 + 0.5 * place);
                let arm = radius * DVec2::new(libm::cos(angle), libm::sin(angle));
                self.add_slice(centre.x + arm.x, centre.y + arm.y, weight * width * arm.x);
            }
        }
    }
}
