//! The line in which the water surface cuts a hull.
use super::{
    Hull,
    load::{HullPoint, cut, odd_first},
};
use crate::load::{Pose, Surface};
use glam::{Vec2, Vec3};

impl Hull {
    /// The waterline of the hull where `pose` puts it: for each triangle that the surface cuts the two ends of the cut in the world, m, in
    /// no particular order. Empty for a hull that is dry or wholly submerged.
    ///
    /// `surface` gives the water at a world (x, z), or `None` where there is none. Triangles are cut where [`Hull::load`] cuts them, so
    /// that below this line is the water that carries the hull. Of a union the lines of all parts are given, also where they run
    /// within another part.
    pub fn waterline(&self, pose: &Pose, surface: impl FnMut(Vec2) -> Option<Surface>) -> Vec<[Vec3; 2]> {
        let body = self.at_rest(pose);
        let mut points = Vec::with_capacity(self.points.len());
        if self.look_up(&body, &mut points, surface).is_none() {
            return Vec::new();
        }
        let corners = |triangle: &[u32; 3]| triangle.map(|index| &points[index as usize]);
        let segment = |triangle| Some(across(odd_first(corners(triangle))?).map(|point| body.centre + point.arm));
        self.triangles[..self.shared].iter().filter_map(segment).collect()
    }
}

/// Where the surface crosses a triangle of which only `a` is wet, or only `a` is dry.
fn across([a, b, c]: [&HullPoint; 3]) -> [HullPoint; 2] {
    if a.depth > 0.0 { [cut(a, b), cut(a, c)] } else { [cut(b, a), cut(c, a)] }
}
