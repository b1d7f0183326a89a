//! How often a surface goes round a point.

use super::corners;
use glam::{DVec3, Vec3};
use std::f64::consts::TAU;

/// How often closed triangles go round a point: 1 inside a solid, 0 outside it, ½ on a face of it.
///
/// The sum of the solid angles of the triangles over 4π, each by tan(Ω/2) = a·(b × c) / (|a||b||c| + (a·b)|c| + (b·c)|a| + (c·a)|b|)
/// (van Oosterom & Strackee, *The solid angle of a plane triangle*, 1983, eq. 8).
pub(super) fn winding<'a>(points: &[Vec3], triangles: impl IntoIterator<Item = &'a [u32; 3]>, point: DVec3) -> f64 {
    let half_angle = |&triangle: &[u32; 3]| {
        let [a, b, c] = corners(points, triangle).map(|corner| corner - point);
        let [la, lb, lc] = [a, b, c].map(DVec3::length);
        libm::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb)
    };
    triangles.into_iter().map(half_angle).sum::<f64>() / TAU
}
