//! What the water does to a hull in a given pose and motion.
//!
//! The depth of the points below the surface is taken as linear along every edge. A triangle is cut where the depth is 0, and over
//! what is under water the pressure p = ρ g d is integrated exactly: with corners p_i at depths d_i, S = d₁ + d₂ + d₃ and area vector
//! **A**,
//!
//! **F** = −ρ g (S/3) **A**, at Σ p_i (d_i + S)/(4 S).
//!
//! Over a closed surface these forces add up to ρ g V ŷ through the centroid of the displaced water; under a sloping surface also to the
//! push down the slope.
use super::{
    Hull, HullDrag,
    faces::{Faces, Sums},
    resistance::FaceDrag,
};
use crate::load::{BodyState, Fluid, Load, Surface, SurfaceLattice};
use glam::{Mat3, Vec2, Vec3};
use pulp::{Arch, Simd, WithSimd};

/// Share of its volume below which a hull counts as dry: less is rounding.
pub(super) const LEAST_SHARE: f32 = 1e-9;

/// What is known of a point of a hull in a step.
#[derive(Debug, Clone, Copy, Default)]
pub struct HullPoint {
    /// From the centre of mass, in the world, m.
    pub(super) arm: Vec3,
    /// Below the surface, m.
    pub(super) depth: f32,
    /// Velocity of the water there, m/s.
    pub(super) velocity: Vec3,
}

impl Hull {
    /// What the water does to the hull of `body`, about its centre of mass.
    ///
    /// `surface` gives the water at a world (x, z), or `None` where there is none. `points` is room that is used from step to step, so
    /// that none is allocated.
    pub fn load(
        &self,
        body: &BodyState,
        fluid: &Fluid,
        drag: &HullDrag,
        points: &mut Vec<HullPoint>,
        surface: impl FnMut(Vec2) -> Option<Surface>,
    ) -> Load {
        let Some(around) = self.look_up(body, points, surface) else { return Load::default() };
        let turning = 0.5 * self.length() * body.motion.angular.length();
        let speed = (around.velocity - body.motion.linear).length().hypot(turning);
        let drag = FaceDrag::new(drag, fluid.density, fluid.gravity, self.length(), speed);
        let sums = self.wetted(points, Faces::new(body.motion, around.base, drag));
        self.finish(&sums, body, fluid, &around)
    }

    /// [`Hull::load`] on a lattice. Not generic, so that it is compiled here, whoever calls it and however that is compiled.
    pub fn load_on(
        &self,
        body: &BodyState,
        fluid: &Fluid,
        drag: &HullDrag,
        points: &mut Vec<HullPoint>,
        lattice: &SurfaceLattice,
    ) -> Load {
        self.load(body, fluid, drag, points, |at| lattice.at(at))
    }

    /// What all faces under water add up to. Not generic, so that it is compiled here, whoever calls it and however that is compiled.
    pub(super) fn wetted(&self, points: &[HullPoint], faces: Faces) -> Sums {
        Arch::new().dispatch(Wetted { hull: self, points, faces })
    }

    /// Looks up the water at all points; nothing if there is none.
    pub(super) fn look_up(
        &self,
        body: &BodyState,
        points: &mut Vec<HullPoint>,
        mut surface: impl FnMut(Vec2) -> Option<Surface>,
    ) -> Option<Around> {
        let world_from_body = body.world_from_body();
        let (origin, centre) = (body.origin(), body.centre);
        let mut around = Around { least: Vec3::INFINITY, most: Vec3::NEG_INFINITY, ..Around::default() };
        let mut count = 0.0;
        let (mut deepest, mut shallowest) = (0.0_f32, f32::INFINITY);
        points.clear();
        points.extend(self.points.iter().map(|point| {
            let arm = origin + world_from_body * *point;
            let Some(water) = surface(Vec2::new(centre.x + arm.x, centre.z + arm.z)) else {
                // As far out of the water as the hull is long: it ends near the last point that has some.
                shallowest = 0.0;
                return HullPoint { arm, depth: -self.length(), velocity: Vec3::ZERO };
            };
            let height = water.height - centre.y;
            count += 1.0;
            around.least = around.least.min(arm);
            around.most = around.most.max(arm);
            around.height += height;
            around.velocity += water.velocity;
            let depth = height - arm.y;
            deepest = deepest.max(depth);
            shallowest = shallowest.min(depth);
            HullPoint { arm, depth, velocity: water.velocity }
        }));
        (deepest > 0.0).then(|| Around {
            height: around.height / count,
            velocity: around.velocity / count,
            base: shallowest.max(0.0),
            deepest,
            ..around
        })
    }

    fn finish(&self, sums: &Sums, body: &BodyState, fluid: &Fluid, around: &Around) -> Load {
        let weight = fluid.density * fluid.gravity;
        let mut load = sums.load(weight);
        load.submerged_volume = load.submerged_volume.min(self.volume);
        if load.submerged_volume <= LEAST_SHARE * self.volume {
            return Load::default();
        }
        // The water that moves with the hull is around its submerged part: where the push acts, and as deep as its mean depth.
        let centre = around.centre_of_buoyancy(sums);
        // A hull that is wholly submerged, or nearly, loses its push as well when it comes out, however little its waterplane says now.
        let secant = load.pressure.force.y / around.deepest - load.stiffness.linear.y_axis.y;
        if secant > 0.0 {
            load.stiffness.add_along(secant, Vec3::Y, centre);
        }
        let share = load.submerged_volume / self.volume * fluid.density;
        let world_from_body = body.world_from_body();
        let turned = |matrix: Mat3| world_from_body * matrix * world_from_body.transpose() * share;
        load.added_mass.add_at(turned(self.added_mass.linear), centre);
        load.added_mass.angular += turned(self.added_mass.angular);
        load
    }
}

/// The water around a hull.
#[derive(Default)]
pub(super) struct Around {
    /// Mean height over the centre of mass, m.
    height: f32,
    /// Mean velocity, m/s.
    velocity: Vec3,
    /// Depth of the highest point, m; 0 if any is dry.
    pub base: f32,
    /// Depth of the lowest point, m.
    deepest: f32,
    /// The box of the points that have water, from the centre of mass, m.
    least: Vec3,
    most: Vec3,
}

impl Around {
    /// Where the push of the pressure acts, as deep as the mean depth of the water displaced; from the centre of mass, m.
    pub fn centre_of_buoyancy(&self, sums: &Sums) -> Vec3 {
        let (force, torque) = sums.push();
        let y = self.height - sums.depths(self.base) / force.y;
        let centre = Vec3::new((torque.z + y * force.x) / force.y, y, (y * force.z - torque.x) / force.y);
        // Where some of the water is missing the forces do not balance: never further out than the hull reaches.
        centre.clamp(self.least, self.most)
    }
}

/// The triangles of a hull, cut by the surface; compiled once for every set of vector instructions.
struct Wetted<'a> {
    hull: &'a Hull,
    points: &'a [HullPoint],
    faces: Faces,
}

impl WithSimd for Wetted<'_> {
    type Output = Sums;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) -> Sums {
        let (own, shared) = self.hull.triangles.split_at(self.hull.shared);
        for (triangles, sign) in [(own, 1.0), (shared, -1.0)] {
            for triangle in triangles {
                self.add(triangle.map(|index| &self.points[index as usize]), sign);
            }
        }
        self.faces.finish()
    }
}

impl Wetted<'_> {
    /// Adds what is under water of a triangle.
    #[inline(always)]
    fn add(&mut self, corners: [&HullPoint; 3], sign: f32) {
        let Some([a, b, c]) = odd_first(corners) else {
            if corners[0].depth > 0.0 {
                self.faces.push(corners, sign);
            }
            return;
        };
        let pieces = if a.depth > 0.0 { [[*a, cut(a, b), cut(a, c)]; 2] } else { rest(a, b, c) };
        // A tip is one piece, and what is left without one are two.
        let count = if a.depth > 0.0 { 1 } else { 2 };
        for [p, q, r] in &pieces[..count] {
            self.faces.push([p, q, r], sign);
        }
    }
}

/// A triangle that the surface cuts, turned so that the corner that is alone wet, or alone dry, comes first.
#[inline(always)]
pub(super) fn odd_first([a, b, c]: [&HullPoint; 3]) -> Option<[&HullPoint; 3]> {
    match [a, b, c].map(|corner| corner.depth > 0.0) {
        [false, false, false] | [true, true, true] => None,
        [true, false, false] | [false, true, true] => Some([a, b, c]),
        [false, true, false] | [true, false, true] => Some([b, c, a]),
        [false, false, true] | [true, true, false] => Some([c, a, b]),
    }
}

/// What is under water of a triangle of which only `a` is dry.
fn rest(a: &HullPoint, b: &HullPoint, c: &HullPoint) -> [[HullPoint; 3]; 2] {
    let (before, after) = (cut(b, a), cut(c, a));
    [[before, *b, *c], [before, *c, after]]
}

/// Where the edge from a wet to a dry point meets the surface.
pub(super) fn cut(wet: &HullPoint, dry: &HullPoint) -> HullPoint {
    let t = wet.depth / (wet.depth - dry.depth);
    HullPoint { arm: wet.arm.lerp(dry.arm, t), depth: 0.0, velocity: wet.velocity.lerp(dry.velocity, t) }
}
