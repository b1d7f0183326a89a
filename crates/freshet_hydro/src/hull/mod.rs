//! Floating bodies as hulls: closed triangle surfaces, and what the water does to them.
//!
//! Where [`voxels`](crate::voxels) approximate a body by cells, a [`Hull`] is cut by the water surface triangle by triangle, and the
//! pressure is integrated over what lies below it without an error.
//!
//! A hull comes from a mesh ([`Hull::new`]), from a shape ([`Hull::ball`], [`Hull::capsule`], …) or from several hulls
//! ([`Hull::union`]); [`Hull::simplified`] and [`Hull::refined`] change how many triangles it has, and not what it holds.
//! [`Hull::load`] is what the water does to it, [`Hull::flotation`] and [`Hull::waterline`] how it lies in the water.
//!
//! # Symbols
//!
//! V volume (m³), c centroid (m), C second central moments (m²): the mean of (x − c)(x − c)ᵀ over the volume.

mod added_mass;
mod columns;
mod convex;
mod faces;
mod flotation;
mod inside;
mod load;
mod moments;
mod orient;
mod profile;
mod refine;
mod resistance;
mod round_cuboid;
mod shapes;
mod simplify;
mod union;
mod waterline;
mod weld;

pub use added_mass::AddedMass;
pub use columns::{Columns, SurfacePlane};
pub use flotation::{Flotation, Waterplane};
pub use load::HullPoint;
pub use resistance::{HullDrag, VISCOSITY, friction_coefficient};
pub use union::Union;

use glam::{DVec3, Mat3, Quat, Vec3};
use moments::Moments;
use thiserror::Error;

/// A closed surface of triangles in the body's own frame: one solid, or the union of several.
///
/// ```
/// use freshet_hydro::hull::Hull;
/// use glam::Vec3;
///
/// let cube = Hull::cuboid(Vec3::splat(0.5))?;
/// let taller = cube.scaled(Vec3::new(1.0, 3.0, 1.0))?;
/// assert!((taller.volume() - 3.0).abs() < 1e-6);
/// # Ok::<(), freshet_hydro::hull::HullError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Hull {
    points: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// Triangles from here on bound what several parts have in common: they count negatively.
    shared: usize,
    volume: f32,
    centroid: Vec3,
    covariance: Mat3,
    added_mass: AddedMass,
}

/// Why there is no hull.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum HullError {
    /// A mesh without triangles, or a union without parts.
    #[error("there are no triangles")]
    NoTriangles,
    /// A point is infinite or not a number.
    #[error("point {0} is not finite")]
    NotFinite(usize),
    /// A triangle names a point that is not there.
    #[error("triangle {triangle} names point {point}, but there are {points} points")]
    Index {
        /// Which triangle.
        triangle: usize,
        /// The point it names.
        point: u32,
        /// How many points there are.
        points: usize,
    },
    /// The surface has holes, or is twisted like a Möbius strip: some edges are not passed as often one way as the other.
    #[error("the surface is open at {edges} edges, one of them from {from} to {to}")]
    Open {
        /// How many edges are open.
        edges: usize,
        /// Where one of them starts, in m.
        from: Vec3,
        /// Where it ends, in m.
        to: Vec3,
    },
    /// The surface is flat, cancels itself, or is so small or large that its volume is no `f32`.
    #[error("the surface holds no volume")]
    Flat,
    /// A size, scale, rotation or volume that no solid can have: zero, not finite, or negative where that means nothing.
    #[error("{value} is no {what}")]
    Size {
        /// What it was given for.
        what: &'static str,
        /// The value given.
        value: f32,
    },
}

impl Hull {
    /// The hull of a mesh: a list of triangles as indices of points (m).
    ///
    /// Points that coincide become one, so that a mesh whose points are doubled for normals or texture coordinates is closed. The
    /// winding of the triangles is made the same on both sides of every edge, and outside is outside.
    ///
    /// The solid is what water cannot enter: all that the outermost shells enclose. A shell, which is a connected piece of the surface,
    /// is left out if it lies within another, however both are wound: it bounds a cavity that is sealed, or something in one, and
    /// neither displaces water beyond what the outer shell does. The volume is hence that of a hollow body with its cavities, and a
    /// density that is to give its mass is the mean over all of it. It counts as within if its faces do, asked at the middles of at most 8
    /// that are spread over it; it may touch the outer one from within. Shells side by side all count, and those that cross each other
    /// both count in full; use [`Hull::union`] on them.
    ///
    /// # Errors
    /// [`HullError::NoTriangles`], [`HullError::NotFinite`], [`HullError::Index`], [`HullError::Open`] or [`HullError::Flat`], each as
    /// it says.
    pub fn new(points: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, HullError> {
        let (points, triangles) = weld::welded(points, triangles)?;
        let triangles = orient::oriented(&points, triangles)?;
        let shared = triangles.len();
        Self::measured(points, triangles, shared)
    }

    /// A surface that is closed and wound rightly already, with the moments of what it holds.
    fn measured(points: Vec<Vec3>, triangles: Vec<[u32; 3]>, shared: usize) -> Result<Self, HullError> {
        if let Some(point) = points.iter().position(|point| !point.is_finite()) {
            return Err(HullError::NotFinite(point));
        }
        let Moments { volume, centroid, covariance } = Moments::of(&points, &triangles).ok_or(HullError::Flat)?;
        let hull = Self {
            points,
            triangles,
            shared,
            volume: volume as f32,
            centroid: centroid.as_vec3(),
            covariance: covariance.as_mat3(),
            added_mass: AddedMass::of(volume as f32, covariance.as_mat3()),
        };
        // A double sheet holds what its points are rounded by; and a volume of 10⁻⁴⁰ or 10⁴⁰ m³ would be 0 or ∞ soon.
        let [min, max] = hull.bounds().map(|corner| corner.as_dvec3());
        let rounding = (max - min).length().max(min.abs().max(max.abs()).max_element()) * f64::from(f32::EPSILON);
        let holds = volume > hull.total_area() * rounding && hull.volume.is_normal() && hull.covariance.is_finite();
        if holds { Ok(hull) } else { Err(HullError::Flat) }
    }

    /// Points of the surface, m.
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// Triangles as indices of points, counter-clockwise seen from outside. Those from [`Hull::shared`] on are wound the other way
    /// round.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Where those triangles begin that bound what several parts have in common. They are wound *clockwise* seen from outside, so
    /// that what is integrated over their normals takes away by itself what the parts hold twice.
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

    /// What has to be moved with the hull when it is wholly under water.
    pub fn added_mass(&self) -> AddedMass {
        self.added_mass
    }

    /// Inertia about the centroid of a homogeneous body of mass 1 kg, in m²: I = tr(C)·1 − C.
    pub fn unit_inertia(&self) -> Mat3 {
        let spread = self.covariance;
        let trace = spread.x_axis.x + spread.y_axis.y + spread.z_axis.z;
        Mat3::from_diagonal(Vec3::splat(trace)) - spread
    }

    /// The edge of a cube of this volume, m: the length by which small and large bodies compare.
    pub fn length(&self) -> f32 {
        libm::cbrtf(self.volume)
    }

    /// Area of the surface, m². That of a union is the area of the parts less that of what they have in common, which is exact but
    /// for faces on which parts touch: those count on both sides.
    pub fn area(&self) -> f32 {
        let area = |triangles: &[[u32; 3]]| triangles.iter().map(|&t| self.area_of(t)).sum::<f64>();
        let (outer, shared) = self.triangles.split_at(self.shared);
        (area(outer) - area(shared)) as f32
    }

    /// The smallest box around the surface: \[lower corner, upper corner\], m.
    pub fn bounds(&self) -> [Vec3; 2] {
        bounds(&self.points)
    }

    /// The same shape about the same centroid, grown or shrunk to hold `volume`, m³.
    ///
    /// # Errors
    /// [`HullError::Size`] if `volume` is not positive and finite, [`HullError::Flat`] if the size is beyond an `f32`.
    pub fn with_volume(self, volume: f32) -> Result<Self, HullError> {
        positive("volume", volume)?;
        let scale = libm::cbrt(f64::from(volume) / f64::from(self.volume));
        let centre = self.centroid.as_dvec3();
        self.moved(|point| centre + (point - centre) * scale)
    }

    /// The hull stretched along the body's axes, about its origin. Negative factors mirror it, and outside stays outside.
    ///
    /// # Errors
    /// [`HullError::Size`] if a factor is zero or not finite, [`HullError::Flat`] if the size is beyond an `f32`.
    pub fn scaled(mut self, scale: Vec3) -> Result<Self, HullError> {
        for value in scale.to_array() {
            if !value.is_finite() || value == 0.0 {
                return Err(HullError::Size { what: "scale", value });
            }
        }
        if (scale.to_array().iter().filter(|factor| **factor < 0.0).count()) % 2 == 1 {
            self.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        let scale = scale.as_dvec3();
        self.moved(|point| point * scale)
    }

    /// The hull turned about its origin by `rotation`, then moved by `translation`, m.
    ///
    /// # Errors
    /// [`HullError::Size`] if the rotation or the translation is no such thing, [`HullError::Flat`] if the hull is so small that it
    /// is lost in the rounding of where it is to be.
    pub fn placed(self, rotation: Quat, translation: Vec3) -> Result<Self, HullError> {
        let length = rotation.length();
        if !(length.is_finite() && length > 0.0) {
            return Err(HullError::Size { what: "rotation", value: length });
        }
        if let Some(&value) = translation.to_array().iter().find(|value| !value.is_finite()) {
            return Err(HullError::Size { what: "translation", value });
        }
        let rotation = rotation.as_dquat().normalize();
        self.moved(|point| rotation * point + translation.as_dvec3())
    }

    /// The hull with its points elsewhere, measured anew.
    fn moved(mut self, place: impl Fn(DVec3) -> DVec3) -> Result<Self, HullError> {
        for point in &mut self.points {
            *point = place(point.as_dvec3()).as_vec3();
        }
        Self::measured(self.points, self.triangles, self.shared)
    }

    /// Area of all triangles, whatever they bound, m².
    fn total_area(&self) -> f64 {
        self.triangles.iter().map(|&triangle| self.area_of(triangle)).sum()
    }

    fn area_of(&self, triangle: [u32; 3]) -> f64 {
        0.5 * area_vector(corners(&self.points, triangle)).length()
    }
}

/// The corners of a triangle, m.
fn corners(points: &[Vec3], triangle: [u32; 3]) -> [DVec3; 3] {
    triangle.map(|point| points[point as usize].as_dvec3())
}

/// Twice the area of a triangle, along its normal, m².
fn area_vector([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// The three edges of a triangle, in its own direction.
fn edges([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)]
}

/// An edge, whichever way it is passed.
fn undirected((from, to): (u32, u32)) -> (u32, u32) {
    (from.min(to), from.max(to))
}

/// The smallest box around points, m.
fn bounds(points: &[Vec3]) -> [Vec3; 2] {
    points.iter().fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[min, max], &point| [min.min(point), max.max(point)])
}

/// Whether two boxes have a point in common.
fn boxes_meet([a_min, a_max]: [Vec3; 2], [b_min, b_max]: [Vec3; 2]) -> bool {
    a_min.cmple(b_max).all() && b_min.cmple(a_max).all()
}

/// `value`, if it is positive and finite.
fn positive(what: &'static str, value: f32) -> Result<f64, HullError> {
    if value.is_finite() && value > 0.0 { Ok(f64::from(value)) } else { Err(HullError::Size { what, value }) }
}

#[cfg(test)]
mod tests;
