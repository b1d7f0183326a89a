//! Floating bodies as hulls: closed triangle surfaces, and what the water does to them.
//!
//! Where [`voxels`](crate::voxels) approximate a body by cells, a [`Hull`] is cut by the water surface triangle by triangle, and the
//! pressure is integrated over what lies below it without an error.
//!
//! # Symbols
//!
//! V volume (m³), c centroid (m), C second central moments (m²): the mean of (x − c)(x − c)ᵀ over the volume.

use glam::{Mat3, Vec3};

/// A closed surface of triangles in the body's own frame: one solid, or the union of several.
#[derive(Debug, Clone, PartialEq)]
pub struct Hull {
    points: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// Triangles from here on bound what several parts have in common: they count negatively.
    shared: usize,
    volume: f32,
    centroid: Vec3,
    covariance: Mat3,
}

impl Hull {
    /// Points of the surface, m.
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// Triangles as indices of points, counter-clockwise seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Where those triangles begin that bound what several parts have in common. What they add is to be taken away.
    pub fn shared(&self) -> usize {
        self.shared
    }

    /// Volume, m³.
    pub fn volume(&self) -> f32 {
        self.volume
    }

    /// Centroid, m: where a homogeneous body has its centre of mass.
    pub fn centroid(&self) -> Vec3 {
        self.centroid
    }

    /// Second central moments C, m².
    pub fn covariance(&self) -> Mat3 {
        self.covariance
    }
}
