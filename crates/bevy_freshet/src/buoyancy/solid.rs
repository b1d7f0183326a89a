//! Shapes of the physics engine as solids: in or out, how far from the surface, how much volume.

use bevy::{
    mesh::{Indices, Mesh, VertexAttributeValues},
    platform::collections::HashMap,
    prelude::*,
};
use bevy_rapier3d::parry::{
    bounding_volume::{Aabb, BoundingVolume},
    math::Pose,
    query::PointQuery,
    shape::{ConvexPolyhedron, SharedShape, TriMesh, TriMeshFlags, TypedShape},
    transformation::try_convex_hull,
};
use freshet_hydro::{
    hull::{Hull, HullError, Union},
    voxels::{self, VoxelHull},
};

/// Part of a body that has an inside, placed in the body's frame.
#[derive(Clone)]
pub(super) struct Solid {
    pose: Pose,
    shape: SharedShape,
}

/// What is wrong with a shape.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub(super) enum Flaw {
    /// It has no inside; it is left out.
    #[error("has no volume (half-space, height field, polyline, segment or triangle); it does not float")]
    NoVolume,
    /// It is a triangle mesh that does not close; its convex hull is used.
    #[error("is a triangle mesh of which {0}; it floats as its convex hull")]
    Open(HullError),
    /// Its surface holds no volume that could be found; it is left out.
    #[error("is left out: {0}")]
    Refused(HullError),
    /// It overlaps another one, and one of both is not convex.
    #[error("overlaps another, and not both are convex; what they have in common counts twice ({0} pairs)")]
    Overlap(usize),
}

impl Solid {
    /// Appends the solids of `shape` at `pose` to `solids`, compounds taken apart, and passes flaws to `report`.
    pub(super) fn collect(shape: &SharedShape, pose: Pose, solids: &mut Vec<Self>, report: &mut impl FnMut(Flaw)) {
        use TypedShape as T;
        let shape = match shape.as_typed_shape() {
            T::Compound(compound) => {
                for (part_pose, part) in compound.shapes() {
                    Self::collect(part, pose * *part_pose, solids, report);
                }
                return;
            }
            T::HalfSpace(_) | T::HeightField(_) | T::Polyline(_) | T::Segment(_) | T::Triangle(_) => {
                report(Flaw::NoVolume);
                return;
            }
            T::TriMesh(mesh) => match Self::close(mesh.vertices().to_vec(), mesh.indices().to_vec(), report) {
                Some(shape) => shape,
                None => return,
            },
            _ => shape.clone(),
        };
        solids.push(Self { pose, shape });
    }

    /// The solid of a Bevy mesh scaled by `scale`, if it has triangles.
    pub(super) fn from_mesh(mesh: &Mesh, scale: Vec3, report: &mut impl FnMut(Flaw)) -> Option<Self> {
        let VertexAttributeValues::Float32x3(positions) = mesh.attribute(Mesh::ATTRIBUTE_POSITION)? else {
            return None;
        };
        let vertices: Vec<Vec3> = positions.iter().map(|p| Vec3::from(*p) * scale).collect();
        let flat: Vec<u32> = match mesh.indices() {
            Some(Indices::U16(indices)) => indices.iter().map(|i| u32::from(*i)).collect(),
            Some(Indices::U32(indices)) => indices.clone(),
            None => (0..vertices.len() as u32).collect(),
        };
        let triangles = flat.as_chunks::<3>().0.to_vec();
        let shape = Self::close(vertices, triangles, report)?;
        Some(Self { pose: Pose::IDENTITY, shape })
    }

    /// A triangle mesh that knows in from out: the mesh itself with outward normals if it is closed, else its hull.
    fn close(vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>, report: &mut impl FnMut(Flaw)) -> Option<SharedShape> {
        match Hull::new(&vertices, &triangles) {
            Ok(hull) => {
                let (points, triangles) = (hull.points().to_vec(), hull.triangles().to_vec());
                TriMesh::with_flags(points, triangles, TriMeshFlags::ORIENTED).ok().map(SharedShape::new)
            }
            Err(open @ HullError::Open { .. }) => {
                report(Flaw::Open(open));
                SharedShape::convex_hull(&vertices)
            }
            Err(_) => {
                report(Flaw::NoVolume);
                None
            }
        }
    }

    /// Its surface in the body's frame.
    fn hull(&self) -> Result<Hull, HullError> {
        use TypedShape as T;
        let hull = match self.shape.as_typed_shape() {
            T::Ball(ball) => Hull::ball(ball.radius),
            T::Cuboid(cuboid) => Hull::cuboid(cuboid.half_extents),
            T::Cylinder(cylinder) => Hull::cylinder(cylinder.half_height, cylinder.radius),
            T::Cone(cone) => Hull::cone(cone.half_height, cone.radius),
            T::Capsule(capsule) if capsule.half_height() <= 0.0 => {
                Hull::ball(capsule.radius).and_then(|hull| hull.placed(Quat::IDENTITY, capsule.center()))
            }
            T::Capsule(capsule) => Hull::capsule(capsule.half_height(), capsule.radius)
                .and_then(|hull| hull.placed(capsule.rotation_wrt_y(), capsule.center())),
            T::RoundCuboid(round) => match (round.inner_shape.half_extents, round.border_radius) {
                (half, 0.0) => Hull::cuboid(half),
                (half, border) => Hull::round_cuboid(half, border),
            },
            T::RoundCylinder(round) => match (round.inner_shape.half_height, round.inner_shape.radius) {
                (half_height, radius) if round.border_radius == 0.0 => Hull::cylinder(half_height, radius),
                (half_height, radius) => Hull::round_cylinder(half_height, radius, round.border_radius),
            },
            T::RoundCone(round) => match (round.inner_shape.half_height, round.inner_shape.radius) {
                (half_height, radius) if round.border_radius == 0.0 => Hull::cone(half_height, radius),
                (half_height, radius) => Hull::round_cone(half_height, radius, round.border_radius),
            },
            T::RoundConvexPolyhedron(round) => rounded(&round.inner_shape, round.border_radius),
            T::ConvexPolyhedron(polyhedron) => {
                let (points, triangles) = polyhedron.to_trimesh();
                Hull::new(&points, &triangles)
            }
            T::TriMesh(mesh) => Hull::new(mesh.vertices(), mesh.indices()),
            T::Voxels(voxels) => {
                let (points, triangles) = voxels.to_trimesh();
                Hull::new(&points, &triangles)
            }
            _ => Err(HullError::NoTriangles),
        }?;
        hull.placed(self.pose.rotation, self.pose.translation)
    }

    /// Bounding box with the body at `body`.
    fn aabb(&self, body: &Pose) -> Aabb {
        self.shape.compute_aabb(&(*body * self.pose))
    }

    /// Signed distance from a point of the body's frame to the surface, m, negative inside.
    fn distance(&self, point: Vec3) -> f32 {
        let point = self.pose.inverse_transform_point(point);
        match self.shape.as_typed_shape() {
            TypedShape::ConvexPolyhedron(hull) => plane_distance(hull, point),
            TypedShape::RoundCuboid(round) => projected(&round.inner_shape, point) - round.border_radius,
            TypedShape::RoundCylinder(round) => projected(&round.inner_shape, point) - round.border_radius,
            TypedShape::RoundCone(round) => projected(&round.inner_shape, point) - round.border_radius,
            TypedShape::RoundConvexPolyhedron(round) => plane_distance(&round.inner_shape, point) - round.border_radius,
            _ => projected(&*self.shape, point),
        }
    }
}

/// Signed distance by projection on the surface.
fn projected(shape: &(impl PointQuery + ?Sized), point: Vec3) -> f32 {
    let distance = shape.project_local_point(point, false).point.distance(point);
    if shape.contains_local_point(point) { -distance } else { distance }
}

/// Signed distance to the nearest plane of a face: exact inside, and near enough just outside, where it is asked for.
fn plane_distance(hull: &ConvexPolyhedron, point: Vec3) -> f32 {
    let corner_of = |first: u32| hull.points()[hull.vertices_adj_to_face()[first as usize] as usize];
    hull.faces()
        .iter()
        .map(|face| face.normal.dot(point - corner_of(face.first_vertex_or_edge)))
        .fold(f32::NEG_INFINITY, f32::max)
}

/// A convex polyhedron with a border of `radius` around it: the convex hull of balls at its corners, with its true volume
/// V + A r + M r² + 4/3 π r³ (Steiner), where M is half the sum of the edges' lengths times the angles between their faces' normals.
fn rounded(inner: &ConvexPolyhedron, radius: f32) -> Result<Hull, HullError> {
    let ball = Hull::ball(radius)?;
    let (points, triangles) = inner.to_trimesh();
    let inner_hull = Hull::new(&points, &triangles)?;
    let around = |point: &Vec3| ball.points().iter().map(|offset| *point + *offset).collect::<Vec<_>>();
    let cloud: Vec<Vec3> = inner.points().iter().flat_map(around).collect();
    let (points, triangles) = try_convex_hull(&cloud).map_err(|_| HullError::Flat)?;
    let volume = inner_hull.volume()
        + inner_hull.area() * radius
        + mean_curvature(&inner_hull) * radius * radius
        + 4.0 / 3.0 * core::f32::consts::PI * radius.powi(3);
    Hull::new(&points, &triangles)?.with_volume(volume)
}

/// Half the sum of the edges' lengths times the angles between the normals of their triangles, m.
fn mean_curvature(hull: &Hull) -> f32 {
    let mut normals = HashMap::<(u32, u32), Vec3>::default();
    let mut sum = 0.0;
    for triangle in hull.triangles() {
        let [a, b, c] = triangle.map(|point| hull.points()[point as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for k in 0..3 {
            let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
            match normals.remove(&(to, from)) {
                Some(other) => {
                    let length = hull.points()[from as usize].distance(hull.points()[to as usize]);
                    sum += 0.5 * length * normal.angle_between(other);
                }
                None => _ = normals.insert((from, to), normal),
            }
        }
    }
    sum
}

/// The surface of the union of `solids`.
pub(super) fn hull_of(solids: &[Solid], report: &mut impl FnMut(Flaw)) -> Result<Hull, HullError> {
    let part = |solid: &Solid| solid.hull().inspect_err(|error| report(Flaw::Refused(*error))).ok();
    let parts = solids.iter().filter_map(part).collect();
    let Union { hull, doubled } = Hull::union(parts)?;
    if doubled > 0 {
        report(Flaw::Overlap(doubled));
    }
    Ok(hull)
}

/// Bounding box of all solids with the body at `body`.
pub(super) fn bounds(solids: &[Solid], body: &Pose) -> Aabb {
    solids.iter().map(|solid| solid.aabb(body)).fold(Aabb::new_invalid(), |all, aabb| all.merged(&aabb))
}

/// Cuts the union of `solids` into voxels.
pub(super) fn voxelize(solids: &[Solid], cells_per_axis: u32) -> Result<VoxelHull, voxels::HullError> {
    let bounds = bounds(solids, &Pose::IDENTITY);
    VoxelHull::new([bounds.mins, bounds.maxs], cells_per_axis as usize, |point| {
        solids.iter().map(|solid| solid.distance(point)).fold(f32::INFINITY, f32::min)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::primitives::{Cuboid, Sphere};
    use bevy_rapier3d::parry::shape::RoundShape;
    use core::f32::consts::PI;

    fn solids_of(shape: &SharedShape) -> (Vec<Solid>, Vec<Flaw>) {
        let (mut solids, mut flaws) = (Vec::new(), Vec::new());
        Solid::collect(shape, Pose::IDENTITY, &mut solids, &mut |flaw| flaws.push(flaw));
        (solids, flaws)
    }

    fn hull(shape: &SharedShape) -> (Hull, Vec<Flaw>) {
        let (solids, mut flaws) = solids_of(shape);
        (hull_of(&solids, &mut |flaw| flaws.push(flaw)).unwrap(), flaws)
    }

    /// Shapes of known volume; the hull has it exactly, voxels before they are scaled to it within 3 %.
    #[test]
    fn shapes_have_their_volume() {
        let corners: Vec<Vec3> =
            (0..8).map(|i| Vec3::from([0, 1, 2].map(|axis| f32::from(i >> axis & 1 == 1)))).collect();
        let polyhedron = match SharedShape::convex_hull(&corners).unwrap().as_convex_polyhedron() {
            Some(polyhedron) => polyhedron.clone(),
            None => unreachable!("a convex hull is one"),
        };
        let rounded = 0.512 + 6.0 * 0.064 + 3.0 * 0.8 * PI * 0.01 + PI / 750.0;
        // A unit cube with a border of 0.1 m: 1 + 6 r + 3 π r² + 4/3 π r³.
        let around = 1.0 + 0.6 + 0.03 * PI + PI / 750.0;
        let round = RoundShape { inner_shape: polyhedron, border_radius: 0.1 };
        let cases = [
            (SharedShape::ball(0.5), PI / 6.0),
            (SharedShape::cuboid(0.5, 1.0, 2.0), 8.0),
            (SharedShape::cylinder(1.0, 0.5), PI / 2.0),
            (SharedShape::cone(1.0, 0.5), PI / 6.0),
            (SharedShape::capsule_y(0.5, 0.5), PI / 4.0 + PI / 6.0),
            (SharedShape::capsule_x(0.0, 0.5), PI / 6.0),
            (SharedShape::convex_hull(&corners).unwrap(), 1.0),
            (SharedShape::round_cuboid(0.4, 0.4, 0.4, 0.1), rounded),
            (SharedShape::round_cuboid(0.4, 0.4, 0.4, 0.0), 0.512),
            (SharedShape::new(round), around),
        ];
        for (shape, volume) in cases {
            let (hull, flaws) = hull(&shape);
            assert!((hull.volume() / volume - 1.0).abs() < 1e-5, "{} instead of {volume}", hull.volume());
            assert!(flaws.is_empty());
            let voxels = voxelize(&solids_of(&shape).0, 4).unwrap();
            assert!((voxels.volume() / volume - 1.0).abs() < 0.03, "{} instead of {volume}", voxels.volume());
        }
    }

    /// Parts are where their poses put them.
    #[test]
    fn compounds_count_overlap_once() {
        let cube = SharedShape::cuboid(0.5, 0.5, 0.5);
        let at = |x: f32| Pose::from_translation(Vec3::X * x);
        let (half, _) = hull(&SharedShape::compound(vec![(at(0.0), cube.clone()), (at(0.5), cube.clone())]));
        assert!((half.volume() - 1.5).abs() < 1e-5 && half.centroid().abs_diff_eq(Vec3::X * 0.25, 1e-5));
        let plank = SharedShape::cuboid(0.02, 0.5, 0.5);
        let (apart, _) = hull(&SharedShape::compound(vec![(at(0.0), cube), (at(3.0), plank)]));
        assert!((apart.volume() - 1.04).abs() < 1e-5 && (apart.centroid().x - 0.12 / 1.04).abs() < 1e-5);
    }

    #[test]
    fn meshes_are_solid_if_closed() {
        let mut flaws = Vec::new();
        let mut volume = |mesh: &Mesh, scale| {
            let solid = Solid::from_mesh(mesh, scale, &mut |flaw| flaws.push(flaw)).unwrap();
            hull_of(&[solid], &mut |flaw| flaws.push(flaw)).unwrap().volume()
        };
        // The volume of the mesh, a little less than the sphere's.
        let sphere = volume(&Sphere::new(1.0).mesh().ico(9).unwrap(), Vec3::new(1.0, 2.0, 1.0));
        assert!((sphere / (8.0 / 3.0 * PI) - 1.0).abs() < 0.02, "{sphere}");
        let mirrored = volume(&Cuboid::default().into(), Vec3::new(-1.0, 1.0, 1.0));
        assert!((mirrored - 1.0).abs() < 1e-5);
        assert!(flaws.is_empty(), "{flaws:?}");
    }

    #[test]
    fn open_and_hollow_shapes_are_named() {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let open = SharedShape::trimesh(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2]]).unwrap();
        let (tetrahedron, flaws) = hull(&open);
        assert!(matches!(flaws[..], [Flaw::Open(HullError::Open { edges: 3, .. })]), "{flaws:?}");
        assert!((tetrahedron.volume() - 1.0 / 6.0).abs() < 1e-5);
        let (solids, flaws) = solids_of(&SharedShape::halfspace(Vec3::Y));
        assert!(solids.is_empty());
        assert_eq!(flaws, [Flaw::NoVolume]);
    }
}
