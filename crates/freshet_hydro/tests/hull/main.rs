//! Hulls against Archimedes and naval architecture, and motion against the formulas of falling, bobbing and drifting bodies.

mod motion;
mod resistance;
mod statics;

use freshet_hydro::{
    hull::{Hull, HullDrag, HullPoint},
    load::{BodyState, Fluid, Inertia, Load, Motion, Pose, Surface, Wrench},
    waves::{GRAVITY, WATER_DENSITY},
};
use glam::{DVec3, Mat3, Quat, Vec2, Vec3, vec3};
use std::f32::consts::PI;

/// Weight of a cubic metre of water, N.
const WEIGHT: f32 = WATER_DENSITY * GRAVITY;

/// No resistance at all.
const SLICK: HullDrag = HullDrag { friction: 0.0, bluff: 0.0, fair: 0.0, radiation: 0.0 };

const STILL: Surface = Surface { height: 0.0, slope: Vec2::ZERO, velocity: Vec3::ZERO };

/// A homogeneous body that moves by the water alone.
#[derive(Clone)]
struct Body {
    hull: Hull,
    points: Vec<HullPoint>,
    mass: f32,
    centre: Vec3,
    rotation: Quat,
    motion: Motion,
    submerged: f32,
    drag: HullDrag,
    /// Whether it cannot turn.
    upright: bool,
}

impl Body {
    /// At rest, with its centre at this height.
    fn new(hull: Hull, density: f32, height: f32) -> Self {
        Self {
            mass: density * hull.volume(),
            hull,
            points: Vec::new(),
            centre: vec3(0.0, height, 0.0),
            rotation: Quat::IDENTITY,
            motion: Motion::default(),
            submerged: 1.0,
            drag: HullDrag::default(),
            upright: false,
        }
    }

    fn pose(&self) -> Pose {
        Pose { position: self.centre - self.rotation * self.hull.centroid(), rotation: self.rotation }
    }

    fn inertia(&self) -> Mat3 {
        let turn = Mat3::from_quat(self.rotation);
        turn * (self.hull.unit_inertia() * self.mass) * turn.transpose()
    }

    fn load(&mut self, water: Surface) -> Load {
        let state = BodyState { pose: self.pose(), centre: self.centre, motion: self.motion };
        let at = |place: Vec2| Some(Surface { height: water.height + water.slope.dot(place), ..water });
        self.hull.load(&state, &Fluid::default(), &self.drag, &mut self.points, at)
    }

    /// A step as a rigid-body solver takes it: velocity first, then place.
    fn step(&mut self, water: Surface, dt: f32) {
        let mut load = self.load(water);
        let share = load.submerged_volume / self.hull.volume();
        load.entering = if share > self.submerged { 1.0 - self.submerged / share } else { 0.0 };
        self.submerged = share;
        let inverse_inertia = if self.upright { Mat3::ZERO } else { self.inertia().as_dmat3().inverse().as_mat3() };
        let inertia = Inertia { inverse_mass: Vec3::splat(self.mass.recip()), inverse_inertia };
        let weight = Wrench { force: Vec3::NEG_Y * (self.mass * GRAVITY), torque: Vec3::ZERO };
        let wrench = load.over_step(&self.motion, &inertia, weight, dt);
        self.motion.linear += (wrench.force + weight.force) / self.mass * dt;
        self.motion.angular += inertia.inverse_inertia * wrench.torque * dt;
        self.centre += self.motion.linear * dt;
        self.rotation = (Quat::from_scaled_axis(self.motion.angular * dt) * self.rotation).normalize();
    }

    /// Energy at the present place: kinetic, of the body and of the water that moves with it; potential, of the body, and of the water
    /// that it displaces, which has been lifted from its depth to the surface. J.
    ///
    /// A solver's step gives the velocity with which it comes here; `next` is that with which it leaves, and the present one is their
    /// mean.
    fn energy(&mut self, next: &Motion) -> f64 {
        let load = self.load(STILL);
        let now = Motion {
            linear: 0.5 * (self.motion.linear + next.linear),
            angular: 0.5 * (self.motion.angular + next.angular),
        };
        let turned = now.angular.dot(self.inertia() * now.angular);
        let added = load.added_mass.times(&now);
        let water = added.force.dot(now.linear) + added.torque.dot(now.angular);
        let kinetic = 0.5 * f64::from(self.mass * now.linear.length_squared() + turned + water);
        let placed: Vec<Vec3> =
            self.hull.points().iter().map(|p| self.rotation * (*p - self.hull.centroid())).collect();
        let (volume, centroid) = below_plane(&placed, self.hull.triangles(), |p| -(p.y + self.centre.y));
        let lifted = f64::from(WEIGHT) * volume * -(centroid.y + f64::from(self.centre.y));
        kinetic + f64::from(self.mass * GRAVITY * self.centre.y) + lifted
    }
}

/// Runs a body for some seconds at this rate.
fn run(body: &mut Body, water: Surface, seconds: f32, rate: f32) {
    for _ in 0..(seconds * rate) as usize {
        body.step(water, rate.recip());
    }
}

/// A ring with a square section: concave, with a hole.
fn ring(radius: f32, half: f32) -> Hull {
    let sectors = 24;
    let mut points = Vec::new();
    for k in 0..sectors {
        let (sin, cos) = (k as f32 / sectors as f32 * 2.0 * PI).sin_cos();
        for (r, y) in [(radius - half, -half), (radius + half, -half), (radius + half, half), (radius - half, half)] {
            points.push(vec3(r * cos, y, r * sin));
        }
    }
    let mut triangles = Vec::new();
    for k in 0..sectors {
        let next = (k + 1) % sectors;
        for side in 0..4 {
            let [a, b] = [4 * k + side, 4 * k + (side + 1) % 4];
            let [c, d] = [4 * next + (side + 1) % 4, 4 * next + side];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Hull::new(&points, &triangles).expect("a hull")
}

/// Closed shapes of about a cubic metre, one of them concave.
fn shapes() -> Vec<(&'static str, Hull)> {
    vec![
        ("ball", Hull::ball(0.6).expect("a hull")),
        ("cuboid", Hull::cuboid(vec3(0.5, 0.3, 0.8)).expect("a hull")),
        ("cylinder", Hull::cylinder(0.7, 0.4).expect("a hull")),
        ("capsule", Hull::capsule(0.5, 0.3).expect("a hull")),
        ("cone", Hull::cone(0.5, 0.5).expect("a hull")),
        ("ring", ring(0.8, 0.2)),
    ]
}

/// Volume and centroid of what is below a plane of which `depth` gives the depth of a point: signed tetrahedra from a point of the
/// plane, so that the cut itself adds nothing.
fn below_plane(points: &[Vec3], triangles: &[[u32; 3]], depth: impl Fn(Vec3) -> f32) -> (f64, DVec3) {
    let apex = vec3(0.0, depth(Vec3::ZERO), 0.0).as_dvec3();
    let mut volume = 0.0;
    let mut moment = DVec3::ZERO;
    let mut add = |a: DVec3, b: DVec3, c: DVec3| {
        let part = (a - apex).dot((b - apex).cross(c - apex)) / 6.0;
        volume += part;
        moment += part * (a + b + c + apex) / 4.0;
    };
    for triangle in triangles {
        let corners = triangle.map(|index| points[index as usize]);
        let depths = corners.map(&depth);
        let mut polygon = Vec::new();
        for k in 0..3 {
            let (p, q) = (corners[k].as_dvec3(), corners[(k + 1) % 3].as_dvec3());
            let (dp, dq) = (f64::from(depths[k]), f64::from(depths[(k + 1) % 3]));
            if dp > 0.0 {
                polygon.push(p);
            }
            if (dp > 0.0) != (dq > 0.0) {
                polygon.push(p + (q - p) * (dp / (dp - dq)));
            }
        }
        for k in 2..polygon.len() {
            add(polygon[0], polygon[k - 1], polygon[k]);
        }
    }
    (volume, if volume.abs() > 0.0 { moment / volume } else { apex })
}
