//! A box with rounded edges.

use super::{Hull, HullError, positive};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Steps of the angle along each rounded edge: 236 triangles in all.
const STEPS: u32 = 4;

/// Points of a rounded corner.
const POINTS: u32 = (STEPS + 1) * (STEPS + 2) / 2;

impl Hull {
    /// All that lies within `border` of [`Hull::cuboid`], m: the border is added outside. 236 triangles.
    ///
    /// Its volume is 8 x y z + 8 (x y + y z + z x) b + 2 π (x + y + z) b² + 4/3 π b³ with the half edges x, y, z and the border b
    /// (Steiner 1840): the box, plates on its faces, quarters of rods on its edges, and eighths of a ball at its corners.
    ///
    /// # Errors
    /// As [`Hull::ball`], for each size.
    pub fn round_cuboid(half: Vec3, border: f32) -> Result<Self, HullError> {
        for value in half.to_array() {
            positive("half edge", value)?;
        }
        let b = positive("border", border)?;
        let half = half.as_dvec3();
        let points = (0..8).flat_map(|corner| corner_points(half, b, corner)).collect();
        let triangles: Vec<_> =
            (0..8).flat_map(corner_triangles).chain(edge_triangles()).chain(face_triangles()).collect();
        let DVec3 { x, y, z } = half;
        let volume = 8.0 * x * y * z
            + 8.0 * (x * y + y * z + z * x) * b
            + 2.0 * PI * (x + y + z) * b * b
            + 4.0 / 3.0 * PI * b.powi(3);
        let shared = triangles.len();
        Self::measured(points, triangles, shared)?.with_volume(volume as f32)
    }
}

/// Signs of x, y and z at a corner: bits of its number.
fn signs(corner: u32) -> DVec3 {
    let sign = |axis: u32| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
    DVec3::new(sign(0), sign(1), sign(2))
}

/// An eighth of a ball, in rows from the x axis to the edge between the y and the z axis.
fn corner_points(half: DVec3, border: f64, corner: u32) -> impl Iterator<Item = Vec3> {
    let rows = (0..=STEPS).flat_map(|row| (0..=row).map(move |column| (row, column)));
    rows.map(move |(row, column)| {
        let direction = DVec3::from([STEPS - row, row - column, column].map(f64::from)).normalize();
        (signs(corner) * (half + border * direction)).as_vec3()
    })
}

/// The point of a corner that lies in a row, counted from the x axis, and a column, counted from the y axis.
fn at(corner: u32, row: u32, column: u32) -> u32 {
    corner * POINTS + row * (row + 1) / 2 + column
}

/// A triangle of a corner of all signs positive, turned over where it is mirrored an odd number of times.
fn mirrored(corner: u32, [a, b, c]: [u32; 3]) -> [u32; 3] {
    if corner.count_ones() % 2 == 1 { [a, b, c] } else { [a, c, b] }
}

fn corner_triangles(corner: u32) -> impl Iterator<Item = [u32; 3]> {
    let rows = (0..STEPS).flat_map(|row| (0..=row).map(move |column| (row, column)));
    rows.flat_map(move |(row, column)| {
        let here = at(corner, row, column);
        let [left, right] = [at(corner, row + 1, column), at(corner, row + 1, column + 1)];
        let beside = (column < row).then(|| [here, right, at(corner, row, column + 1)]);
        [Some([here, left, right]), beside].into_iter().flatten().map(move |triangle| mirrored(corner, triangle))
    })
}

/// The points of a corner's rounding that lie at right angles to an axis, from the next axis to the one after.
fn rim(corner: u32, axis: u32, step: u32) -> u32 {
    match axis {
        0 => at(corner, STEPS, step),
        1 => at(corner, STEPS - step, STEPS - step),
        _ => at(corner, step, 0),
    }
}

/// Strips between the corners at both ends of each edge of the box.
fn edge_triangles() -> impl Iterator<Item = [u32; 3]> {
    let edges = (0..3).flat_map(|axis| (0..8).filter(move |corner| corner >> axis & 1 == 1).map(move |c| (axis, c)));
    edges.flat_map(|(axis, front)| {
        let back = front ^ 1 << axis;
        (0..STEPS).flat_map(move |step| {
            let [a, b] = [rim(front, axis, step), rim(front, axis, step + 1)];
            let [c, d] = [rim(back, axis, step + 1), rim(back, axis, step)];
            [mirrored(front, [a, c, b]), mirrored(front, [a, d, c])]
        })
    })
}

/// The flat faces, between the points of four corners that lie on an axis.
fn face_triangles() -> impl Iterator<Item = [u32; 3]> {
    let faces = (0..3).flat_map(|axis| [0, 1].map(move |side| (axis, side)));
    faces.flat_map(|(axis, side)| {
        let pole = |next: u32, last: u32| {
            let corner = side << axis | next << ((axis + 1) % 3) | last << ((axis + 2) % 3);
            rim(corner, (axis + 2) % 3, 0)
        };
        let [a, b, c, d] = [pole(0, 0), pole(1, 0), pole(1, 1), pole(0, 1)];
        let outward = |[a, b, c]: [u32; 3]| if side == 1 { [a, b, c] } else { [a, c, b] };
        [outward([a, b, c]), outward([a, c, d])]
    })
}
