//! Volume, centroid and second moments of what a closed surface holds.

use super::{bounds, corners};
use glam::{DMat3, DVec3, Vec3};

/// V (m³), c (m) and C (m²) of a solid.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moments {
    pub(super) volume: f64,
    pub(super) centroid: DVec3,
    pub(super) covariance: DMat3,
}

impl Moments {
    /// The moments of what the triangles bound, or `None` if its volume is not positive.
    ///
    /// By the divergence theorem the solid is the sum of the tetrahedra that the triangles (a, b, c) span with any one point o, each
    /// with the sign of its orientation. With a, b, c seen from o and s = a + b + c, such a tetrahedron has
    ///
    /// V = a·(b × c)/6,  ∫x = V s/4,  ∫xxᵀ = V (aaᵀ + bbᵀ + ccᵀ + ssᵀ)/20
    ///
    /// (Tonon, *Explicit exact formulas for the 3-D tetrahedron inertia tensor in terms of its vertex coordinates*, 2005). Here o is
    /// the middle of the bounding box, since far tetrahedra cancel each other and leave their rounding.
    pub(super) fn of(points: &[Vec3], triangles: &[[u32; 3]]) -> Option<Self> {
        let [min, max] = bounds(points);
        let origin = 0.5 * (min.as_dvec3() + max.as_dvec3());
        let (mut volume, mut first, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
        for &triangle in triangles {
            let [a, b, c] = corners(points, triangle).map(|corner| corner - origin);
            let (part, sum) = (a.dot(b.cross(c)) / 6.0, a + b + c);
            volume += part;
            first += sum * (part / 4.0);
            second += (outer(a) + outer(b) + outer(c) + outer(sum)) * (part / 20.0);
        }
        let mean = first / volume;
        let covariance = second * volume.recip() - outer(mean);
        (volume > 0.0).then_some(Self { volume, centroid: origin + mean, covariance })
    }
}

/// The matrix v vᵀ.
fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}
