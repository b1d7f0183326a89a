//! What a hull is said to hold, compared with what solids are known to hold.

mod combining;
mod flotation;
mod mesh;
mod resampling;
mod shapes;

use super::{Hull, undirected};
use glam::{Mat3, Vec3};
use std::collections::BTreeMap;

/// Panics with both values unless they differ by less than `tolerance`.
#[track_caller]
fn near(what: &str, value: f64, expected: f64, tolerance: f64) {
    let difference = (value - expected).abs();
    assert!(
        difference < tolerance,
        "{what} is {value}, not {expected}: off by {difference:e}, more than {tolerance:e}"
    );
}

#[track_caller]
fn near_point(what: &str, value: Vec3, expected: Vec3, tolerance: f32) {
    for axis in 0..3 {
        near(what, value[axis].into(), expected[axis].into(), tolerance.into());
    }
}

#[track_caller]
fn near_matrix(what: &str, value: Mat3, expected: Mat3, tolerance: f32) {
    for column in 0..3 {
        near_point(what, value.col(column), expected.col(column), tolerance);
    }
}

/// Every edge is passed as often one way as the other. Triangles without area may have an edge from a point to itself, which is none.
fn is_closed(hull: &Hull) -> bool {
    let mut balance = BTreeMap::<(u32, u32), i32>::new();
    for edge in hull.triangles().iter().flat_map(|&triangle| super::edges(triangle)) {
        *balance.entry(undirected(edge)).or_default() += edge.1.cmp(&edge.0) as i32;
    }
    balance.into_values().all(|balance| balance == 0)
}

fn unit_cube_at(x: f32, y: f32, z: f32) -> Hull {
    Hull::cuboid(Vec3::splat(0.5)).unwrap().placed(glam::Quat::IDENTITY, Vec3::new(x, y, z)).unwrap()
}

/// A ring about y through the middles of its tube, with `n` sides around and `m` sides of the tube.
fn torus(major: f32, minor: f32, n: u32, m: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let angle = |i: u32, of: u32| std::f32::consts::TAU * i as f32 / of as f32;
    let points = (0..n * m)
        .map(|i| {
            let (u, v) = (angle(i / m, n), angle(i % m, m));
            let r = major + minor * v.cos();
            Vec3::new(r * u.sin(), minor * v.sin(), r * u.cos())
        })
        .collect();
    let at = move |i: u32, j: u32| i % n * m + j % m;
    let triangles = (0..n)
        .flat_map(|i| (0..m).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    (points, triangles)
}
