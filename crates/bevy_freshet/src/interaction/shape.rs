//! Triangles of meshes, read once per mesh.
use bevy::{
    asset::AssetId,
    mesh::{Indices, MeshAccessError, PrimitiveTopology, VertexAttributeValues},
    platform::collections::HashMap,
    prelude::*,
};
use std::{fmt, sync::Arc};

/// Distance, as a share of half the size of a mesh, within which vertices are the same.
const WELD: f32 = 2e-6;

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
        if indices.len() < 3 || mesh.primitive_topology() != PrimitiveTopology::TriangleList {
            return Err(Flaw::NoTriangles);
        }
        let sound = || vertices.iter().filter(|v| v.is_finite());
        let min = sound().copied().reduce(Vec3::min).ok_or(Flaw::NoTriangles)?;
        let max = sound().copied().reduce(Vec3::max).ok_or(Flaw::NoTriangles)?;
        let (center, half) = (0.5 * (min + max), 0.5 * (max - min));
        let (vertices, triangles) = weld(&vertices, indices.as_chunks::<3>().0, center, WELD * half.max_element());
        let mut shape = Self { vertices, triangles, center, half };
        if shape.volume() < 0.0 {
            shape.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        Ok(shape)
    }

    /// Signed volume: negative if the triangles look inwards.
    fn volume(&self) -> f32 {
        let corner = |index: u32| self.vertices.get(index as usize).map(|v| v - self.center).filter(|v| v.is_finite());
        self.triangles.iter().filter_map(|&[a, b, c]| Some(corner(a)?.dot(corner(b)?.cross(corner(c)?)) / 6.0)).sum()
    }
}

/// Makes vertices that lie within about `grid` (m) of one another one, and leaves out triangles that have no area then.
///
/// Meshes repeat vertices for normals and seams, and the copies differ by rounding: sin 2π is not sin 0. The water could run
/// between the sides of a seam, and the section would be open.
fn weld(positions: &[Vec3], indices: &[[u32; 3]], center: Vec3, grid: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut known: HashMap<(IVec3, bool), u32> = HashMap::default();
    let mut vertices = Vec::new();
    let welded: Vec<u32> = positions
        .iter()
        .map(|&position| {
            let key = ((position - center) / grid.max(f32::MIN_POSITIVE)).round().as_ivec3();
            *known.entry((key, position.is_finite())).or_insert_with(|| {
                vertices.push(position);
                vertices.len() as u32 - 1
            })
        })
        .collect();
    let triangles = indices
        .iter()
        .filter_map(|triangle| {
            let [Some(&a), Some(&b), Some(&c)] = triangle.map(|index| welded.get(index as usize)) else { return None };
            (a != b && b != c && c != a).then_some([a, b, c])
        })
        .collect();
    (vertices, triangles)
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

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::asset::RenderAssetUsages;

    fn flaw(mesh: &Mesh) -> Option<Flaw> {
        Shape::read(mesh).err()
    }

    #[test]
    fn unusable_meshes_are_known() {
        let corners = vec![[0.0, 0.0, 1.0]; 6];
        let lines = Mesh::new(PrimitiveTopology::LineList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, corners.clone());
        let empty = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
        let nowhere = empty.clone().with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, vec![[f32::NAN; 3]; 6]);
        for mesh in [&lines, &empty, &nowhere] {
            assert_eq!(flaw(mesh), Some(Flaw::NoTriangles));
        }
        let mut extracted = Mesh::from(Cuboid::default());
        extracted.take_gpu_data().unwrap();
        assert_eq!(flaw(&extracted), Some(Flaw::NotInMainWorld));
        // All corners in one place make no triangle, but no trouble either.
        let point = empty.with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, corners);
        assert_eq!(Shape::read(&point).ok().unwrap().triangles, [[0; 3]; 0]);
    }

    #[test]
    fn seams_are_welded_and_insides_turned_out() {
        let sphere = Sphere::new(2.0).mesh().uv(32, 18);
        let shape = Shape::read(&sphere).ok().unwrap();
        // Two poles and 17 rings; each edge has two triangles: V − E + F = 2 with 2 E = 3 F.
        assert_eq!(shape.vertices.len(), 2 + 17 * 32);
        assert_eq!(shape.vertices.len() as i32 - shape.triangles.len() as i32 / 2, 2);
        let Some(Indices::U32(mut indices)) = sphere.indices().cloned() else { panic!("no indices") };
        indices.reverse();
        let inside_out = Shape::read(&sphere.with_inserted_indices(Indices::U32(indices))).ok().unwrap();
        assert!((inside_out.volume() / shape.volume() - 1.0).abs() < 1e-5 && shape.volume() > 0.0);
    }
}
