//! Hulls of the usual shapes, whose volume and centroid are those of the smooth shape.
//!
//! A surface of triangles with its corners on a round one holds too little: a ball of 320 triangles lacks 3 %, and would float 3 %
//! too deep. So each is grown until its volume is right. What is left of the difference lies in the second moments, below 0.5 %.

use super::profile::Profile;
use super::{Hull, HullError, positive, undirected};
use glam::{DVec2, DVec3, Vec3};
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI};

/// Steps of the angle from a pole to the equator.
const STEPS: usize = 4;

impl Hull {
    /// A ball of `radius` (m) about the origin: an icosahedron with each face cut into 16, 320 triangles.
    ///
    /// # Errors
    /// [`HullError::Size`] if `radius` is not positive and finite, [`HullError::Flat`] if its volume is beyond an `f32`.
    pub fn ball(radius: f32) -> Result<Self, HullError> {
        let radius = positive("radius", radius)?;
        let (mut points, mut triangles) = icosahedron();
        for _ in 0..2 {
            triangles = quartered(&mut points, &triangles);
        }
        let points = points.into_iter().map(|point| (point * radius).as_vec3()).collect();
        let shared = triangles.len();
        Self::measured(points, triangles, shared)?.with_volume((4.0 / 3.0 * PI * radius.powi(3)) as f32)
    }

    /// A box from −`half` to +`half` (m): 12 triangles.
    ///
    /// # Errors
    /// [`HullError::Size`] if an edge is not positive and finite, [`HullError::Flat`] if its volume is beyond an `f32`.
    pub fn cuboid(half: Vec3) -> Result<Self, HullError> {
        for value in half.to_array() {
            positive("half edge", value)?;
        }
        let sign = |corner: usize, axis: usize| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
        let points = (0..8).map(|i| half * Vec3::new(sign(i, 0), sign(i, 1), sign(i, 2))).collect();
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Self::measured(points, triangles, 12)
    }

    /// A cylinder about y, from −`half_height` to +`half_height`, m: 240 triangles.
    ///
    /// # Errors
    /// As [`Hull::ball`], for each size.
    pub fn cylinder(half_height: f32, radius: f32) -> Result<Self, HullError> {
        let [h, r] = [positive("half height", half_height)?, positive("radius", radius)?];
        Profile::from(DVec2::new(0.0, -h))
            .line(DVec2::new(r, -h))
            .line(DVec2::new(r, 0.0))
            .line(DVec2::new(r, h))
            .line(DVec2::new(0.0, h))
            .hull(40)
    }

    /// A capsule about y: all that lies within `radius` of the axis from −`half_height` to +`half_height`, m. 320 triangles.
    ///
    /// # Errors
    /// As [`Hull::ball`], for each size.
    pub fn capsule(half_height: f32, radius: f32) -> Result<Self, HullError> {
        let [h, r] = [positive("half height", half_height)?, positive("radius", radius)?];
        let [low, high] = [DVec2::new(0.0, -h), DVec2::new(0.0, h)];
        Profile::from(DVec2::new(0.0, -h - r))
            .arc(low, r, -FRAC_PI_2, 0.0, STEPS)
            .line(DVec2::new(r, h))
            .arc(high, r, 0.0, FRAC_PI_2, STEPS)
            .hull(20)
    }

    /// A cone about y with its base at −`half_height` and its apex at +`half_height`, m: 256 triangles.
    ///
    /// # Errors
    /// As [`Hull::ball`], for each size.
    pub fn cone(half_height: f32, radius: f32) -> Result<Self, HullError> {
        let [h, r] = [positive("half height", half_height)?, positive("radius", radius)?];
        Profile::from(DVec2::new(0.0, -h))
            .line(DVec2::new(r, -h))
            .line(DVec2::new(0.5 * r, 0.0))
            .line(DVec2::new(0.0, h))
            .hull(64)
    }

    /// All that lies within `border` of [`Hull::cylinder`], m: the border is added outside. 320 triangles.
    ///
    /// # Errors
    /// As [`Hull::ball`], for each size.
    pub fn round_cylinder(half_height: f32, radius: f32, border: f32) -> Result<Self, HullError> {
        let [h, r] = [positive("half height", half_height)?, positive("radius", radius)?];
        let b = positive("border", border)?;
        Profile::from(DVec2::new(0.0, -h - b))
            .line(DVec2::new(r, -h - b))
            .arc(DVec2::new(r, -h), b, -FRAC_PI_2, 0.0, STEPS - 1)
            .line(DVec2::new(r + b, h))
            .arc(DVec2::new(r, h), b, 0.0, FRAC_PI_2, STEPS - 1)
            .line(DVec2::new(0.0, h + b))
            .hull(20)
    }

    /// All that lies within `border` of [`Hull::cone`], m: the border is added outside. 320 triangles.
    ///
    /// # Errors
    /// As [`Hull::ball`], for each size.
    pub fn round_cone(half_height: f32, radius: f32, border: f32) -> Result<Self, HullError> {
        let [h, r] = [positive("half height", half_height)?, positive("radius", radius)?];
        let b = positive("border", border)?;
        let [base, apex] = [DVec2::new(r, -h), DVec2::new(0.0, h)];
        // The side rises 2 h over r, and its normal leans upwards by as much as the side leans inwards.
        let lean = libm::atan2(r, 2.0 * h);
        let normal = DVec2::new(libm::cos(lean), libm::sin(lean));
        Profile::from(DVec2::new(0.0, -h - b))
            .line(DVec2::new(r, -h - b))
            .arc(base, b, -FRAC_PI_2, lean, STEPS)
            .line(apex + b * normal)
            .arc(apex, b, lean, FRAC_PI_2, STEPS - 1)
            .hull(20)
    }
}

/// The regular icosahedron with its corners on the unit ball.
fn icosahedron() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (a, b) = (1.0, 0.5 * (1.0 + 5.0_f64.sqrt()));
    let rectangle = [(-a, b), (a, b), (-a, -b), (a, -b)];
    let xy = rectangle.map(|(s, l)| DVec3::new(s, l, 0.0));
    let yz = rectangle.map(|(s, l)| DVec3::new(0.0, s, l));
    let zx = rectangle.map(|(s, l)| DVec3::new(l, 0.0, s));
    let points = [xy, yz, zx].concat().into_iter().map(DVec3::normalize).collect();
    #[rustfmt::skip]
    let triangles = vec![
        [0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6], [7, 1, 8],
        [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11], [6, 2, 10], [8, 6, 7], [9, 8, 1],
    ];
    (points, triangles)
}

/// Each triangle cut into four, the new points on the unit ball.
fn quartered(points: &mut Vec<DVec3>, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles = HashMap::new();
    let mut middle = |from: u32, to: u32| {
        *middles.entry(undirected((from, to))).or_insert_with(|| {
            points.push((points[from as usize] + points[to as usize]).normalize());
            points.len() as u32 - 1
        })
    };
    let mut quarters = Vec::with_capacity(4 * triangles.len());
    for &[a, b, c] in triangles {
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        quarters.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    quarters
}
