//! Triangles of meshes, read once per mesh.
use bevy::{
    asset::AssetId,
    mesh::{Indices, MeshAccessError, PrimitiveTopology, VertexAttributeValues},
    platform::collections::HashMap,
    prelude::*,
};
use std::{fmt, sync::Arc};

/// The triangles of a mesh, looking outwards.
pub(super) struct Shape {
    pub vertices: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Centre and half size of the bounding box.
    pub center: Vec3,
    pub half: Vec3,
}

/// Why a mesh cannot disturb water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Flaw {
    /// Its data lives in the render world only.
    NotInMainWorld,
    /// It is no list of triangles.
    NoTriangles,
    /// It moves with its joints.
    Skinned,
}

impl fmt::Display for Flaw {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::NotInMainWorld => "keeps no data in the main world (`RenderAssetUsages`)",
            Self::NoTriangles => "has no list of triangles",
            Self::Skinned => "is skinned",
        })?;
        f.write_str("; it does not disturb the water")
    }
}

impl Shape {
    fn read(mesh: &Mesh) -> Result<Self, Flaw> {
        let in_main_world = |error: MeshAccessError| match error {
            MeshAccessError::ExtractedToRenderWorld => Flaw::NotInMainWorld,
            MeshAccessError::NotFound => Flaw::NoTriangles,
        };
        let positions = mesh.try_attribute(Mesh::ATTRIBUTE_POSITION).map_err(in_main_world)?;
        let VertexAttributeValues::Float32x3(positions) = positions else { return Err(Flaw::NoTriangles) };
        let vertices: Vec<Vec3> = positions.iter().copied().map(Vec3::from).collect();
        let indices: Vec<u32> = match mesh.try_indices_option().map_err(in_main_world)? {
            Some(Indices::U16(indices)) => indices.iter().copied().map(u32::from).collect(),
            Some(Indices::U32(indices)) => indices.clone(),
            None => (0..vertices.len() as u32).collect(),
        };
        let triangles = indices.as_chunks::<3>().0.to_vec();
        if triangles.is_empty() || mesh.primitive_topology() != PrimitiveTopology::TriangleList {
            return Err(Flaw::NoTriangles);
        }
        let sound = || vertices.iter().filter(|v| v.is_finite());
        let min = sound().copied().reduce(Vec3::min).ok_or(Flaw::NoTriangles)?;
        let max = sound().copied().reduce(Vec3::max).ok_or(Flaw::NoTriangles)?;
        let mut shape = Self { triangles, center: 0.5 * (min + max), half: 0.5 * (max - min), vertices };
        if shape.volume() < 0.0 {
            shape.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        Ok(shape)
    }

    /// Signed volume: negative if the triangles look inwards.
    fn volume(&self) -> f32 {
        let corner = |index: u32| self.vertices.get(index as usize).map(|v| v - self.center).filter(|v| v.is_finite());
        self.triangles
            .iter()
            .filter_map(|&[a, b, c]| Some(corner(a)?.dot(corner(b)?.cross(corner(c)?)) / 6.0))
            .sum()
    }
}

/// Shapes of meshes that have been read.
#[derive(Default)]
pub(super) struct Shapes(HashMap<AssetId<Mesh>, Result<Arc<Shape>, Flaw>>);

impl Shapes {
    /// The shape of the mesh `id`; `None` while it still loads.
    pub fn get(&mut self, id: AssetId<Mesh>, meshes: &Assets<Mesh>) -> Option<Result<Arc<Shape>, Flaw>> {
        if let Some(known) = self.0.get(&id) {
            return Some(known.clone());
        }
        let shape = Shape::read(meshes.get(id)?).map(Arc::new);
        self.0.insert(id, shape.clone());
        Some(shape)
    }

    /// Forgets meshes that have changed or are gone.
    pub fn refresh<'a>(&mut self, events: impl IntoIterator<Item = &'a AssetEvent<Mesh>>) {
        for event in events {
            if let AssetEvent::Modified { id } | AssetEvent::Removed { id } | AssetEvent::Unused { id } = event {
                self.0.remove(id);
            }
        }
    }
}
