//! Pressure and drag on a hull in a given pose and motion.

use glam::{Mat3, Quat, Vec2, Vec3};

use super::{Cell, VoxelHull, outer};
use crate::waves::{GRAVITY, WATER_DENSITY};

/// Where a body is: world from body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// Position of the body frame's origin in the world, in m.
    pub position: Vec3,
    /// Rotation from the body's frame to the world's, of unit length.
    pub rotation: Quat,
}

/// How a body moves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// Velocity of the centre of mass in the world, in m/s.
    pub linear: Vec3,
    /// Angular velocity in the world, in rad/s.
    pub angular: Vec3,
}

/// The water surface above or below a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Surface {
    /// Height η of the surface, in m.
    pub height: f32,
    /// Slope (∂η/∂x, ∂η/∂z) of the surface, without unit.
    pub slope: Vec2,
    /// Velocity of the water, current and waves together, in m/s.
    pub velocity: Vec3,
}

/// A force and a torque about the centre of mass, in the world.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wrench {
    /// Force, in N.
    pub force: Vec3,
    /// Torque about the centre of mass, in N·m.
    pub torque: Vec3,
}

impl Wrench {
    /// Neither force nor torque.
    pub const ZERO: Self = Self { force: Vec3::ZERO, torque: Vec3::ZERO };

    /// Adds `force` (N) acting at `arm` (m) from the centre of mass.
    pub fn add_at(&mut self, force: Vec3, arm: Vec3) {
        self.force += force;
        self.torque += arm.cross(force);
    }

    /// Whether no component is infinite or not a number.
    pub fn is_finite(&self) -> bool {
        self.force.is_finite() && self.torque.is_finite()
    }
}

impl std::ops::Add for Wrench {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, torque: self.torque + other.torque }
    }
}

/// The liquid and the gravity that acts on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fluid {
    /// Density ρ, in kg/m³, positive. Default [`WATER_DENSITY`]; sea water has 1025.
    pub density: f32,
    /// Gravity g, in m/s², not negative. Default [`GRAVITY`].
    pub gravity: f32,
}

impl Default for Fluid {
    fn default() -> Self {
        Self { density: WATER_DENSITY, gravity: GRAVITY }
    }
}

/// How strongly water resists the motion of a body through it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drag {
    /// Linear part, as a share ζ of critical damping: the rate 2ζ√(g/L) with [`VoxelHull::length`] L acts on the
    /// displaced mass, so that small and large bodies of a shape come to rest after as many swings. It stands for
    /// the waves that a moving body radiates. ≥ 0, default 0.25.
    pub damping: f32,
    /// Drag coefficient C_d of the quadratic part ½ ρ C_d A w², A being the shadow of the body along the relative
    /// velocity w. ≥ 0, default 0.8: between a sphere (0.47) and a cube (1.05) (Hoerner, *Fluid-Dynamic Drag*, 1965).
    pub coefficient: f32,
}

impl Default for Drag {
    fn default() -> Self {
        Self { damping: 0.25, coefficient: 0.8 }
    }
}

/// What the water does to a hull: constant forces, and resistance that is linear in the body's motion.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Load {
    /// Pressure of the water at rest around the body: Archimedes' push and its lever.
    pub pressure: Wrench,
    /// Force of the moving water on a body held still.
    pub stream: Wrench,
    /// Resistance to the body's own motion.
    pub resistance: Resistance,
    /// Volume under water, in m³.
    pub submerged_volume: f32,
    /// Area in which the surface cuts the body, in m².
    pub waterplane_area: f32,
    /// Mean velocity of the water around the submerged part, in m/s.
    pub water_velocity: Vec3,
}

/// The symmetric, positive 6 × 6 matrix that turns a motion into the force and torque that resist it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resistance {
    /// Force per velocity, in N·s/m.
    pub linear: Mat3,
    /// Torque per velocity, in N·s; its transpose is force per angular velocity.
    pub coupling: Mat3,
    /// Torque per angular velocity, in N·m·s.
    pub angular: Mat3,
}

impl Default for Resistance {
    /// None. (The default of a matrix is the identity.)
    fn default() -> Self {
        Self { linear: Mat3::ZERO, coupling: Mat3::ZERO, angular: Mat3::ZERO }
    }
}

impl Resistance {
    /// Adds a point at `arm` from the centre of mass that resists with `b` times its velocity v + ω × r:
    /// force −B(v + ω × r), torque r × force.
    fn add_at(&mut self, b: Mat3, arm: Vec3) {
        let cross = cross_matrix(arm);
        self.linear += b;
        self.coupling += cross * b;
        self.angular += cross * b * cross.transpose();
    }

    /// The force and torque by which the water resists `motion`.
    pub fn apply(&self, motion: &Motion) -> Wrench {
        Wrench {
            force: -(self.linear * motion.linear + self.coupling.transpose() * motion.angular),
            torque: -(self.coupling * motion.linear + self.angular * motion.angular),
        }
    }
}

/// The matrix \[r\] with \[r\] v = r × v.
fn cross_matrix(r: Vec3) -> Mat3 {
    Mat3::from_cols(Vec3::new(0.0, r.z, -r.y), Vec3::new(-r.z, 0.0, r.x), Vec3::new(r.y, -r.x, 0.0))
}

/// The submerged part of a cell, seen from the world.
struct Wetted {
    /// Submerged share k, 0…1.
    share: f32,
    /// Horizontal cut of the cell at the surface, in m².
    waterplane: f32,
    /// From the cell's centroid to that of its submerged part, in m.
    shift: Vec3,
}

impl Wetted {
    /// A cell whose centroid lies `depth` = η − y_c below the surface counts as a vertical column of half height
    /// h = √(3 var_y), var_y = ŷᵀCŷ: the box of the same volume and vertical variance, exact for an upright box.
    /// k = ½ + depth/2h; the submerged part ends h(1 − k) lower than the whole, and as far aside as the cell leans:
    /// the regression Cŷ/var_y of place on height.
    fn new(depth: f32, covariance: &Mat3) -> Self {
        let variance = covariance.y_axis.y.max(f32::MIN_POSITIVE);
        let half_height = (3.0 * variance).sqrt();
        let share = (0.5 + depth / (2.0 * half_height)).clamp(0.0, 1.0);
        let cut = share > 0.0 && share < 1.0;
        Self {
            share,
            waterplane: if cut { 0.5 / half_height } else { 0.0 },
            shift: covariance.y_axis * (-half_height * (1.0 - share) / variance),
        }
    }
}

impl VoxelHull {
    /// Pressure and drag on the hull at `pose` with `motion`, about the centre of mass `centre` (world, m).
    ///
    /// `surface` gives the water at a world (x, z), or `None` where there is none. `dt`, in s, is the length of the
    /// step for which [`Load::over_step`] will be asked; it makes the pressure that of the step's end, as far as the
    /// body's own motion changes it, which keeps bodies steady that bob faster than the steps follow.
    ///
    /// A submerged part V is pressed by ρ g V (−∂η/∂x, 1, −∂η/∂z), the pressure gradient under a slope; the water
    /// moves with one velocity from surface to bed.
    pub fn load(
        &self,
        pose: &Pose,
        centre: Vec3,
        motion: &Motion,
        fluid: &Fluid,
        drag: &Drag,
        dt: f32,
        mut surface: impl FnMut(Vec2) -> Option<Surface>,
    ) -> Load {
        let world_from_body = Mat3::from_quat(pose.rotation);
        let drag = CellDrag::new(self, fluid, drag, &world_from_body);
        // Relative to the centre of mass, so that a body a kilometre from the origin floats as precisely.
        let origin = pose.position - centre;
        let mut load = Load::default();
        for cell in &self.cells {
            let arm = origin + world_from_body * cell.centroid;
            let place = centre + arm;
            let Some(water) = surface(Vec2::new(place.x, place.z)) else {
                continue;
            };
            let covariance = world_from_body * cell.covariance * world_from_body.transpose();
            let wetted = Wetted::new(water.height - centre.y - arm.y, &covariance);
            if wetted.share > 0.0 {
                load.add_cell(cell, &wetted, arm, &water, motion, fluid, &drag, dt);
            }
        }
        if load.submerged_volume > 0.0 {
            load.water_velocity /= load.submerged_volume;
        }
        load
    }
}

impl Load {
    fn add_cell(
        &mut self,
        cell: &Cell,
        wetted: &Wetted,
        arm: Vec3,
        water: &Surface,
        motion: &Motion,
        fluid: &Fluid,
        drag: &CellDrag,
        dt: f32,
    ) {
        let volume = cell.volume * wetted.share;
        let area = cell.volume * wetted.waterplane;
        let weight = fluid.density * fluid.gravity;
        let arm = arm + wetted.shift;

        let up_slope = Vec3::new(-water.slope.x, 1.0, -water.slope.y);
        self.pressure.add_at(up_slope * (weight * volume), arm);

        let relative = water.velocity - motion.linear - motion.angular.cross(arm);
        // Rising by v·dt in the step loses ρ g A v dt of push.
        let heave = outer(Vec3::Y) * (weight * area * dt);
        let resistance = drag.at(volume, relative.length()) + heave;
        self.resistance.add_at(resistance, arm);
        self.stream.add_at(resistance * water.velocity, arm);

        self.submerged_volume += volume;
        self.waterplane_area += area;
        self.water_velocity += water.velocity * volume;
    }
}

/// The parts of the drag that all cells of a body share.
struct CellDrag {
    /// Linear drag per volume, in N·s/m per m³.
    linear: f32,
    /// Quadratic drag per volume and speed, in N·s²/m² per m³, along the world's axes.
    quadratic: Mat3,
}

impl CellDrag {
    fn new(hull: &VoxelHull, fluid: &Fluid, drag: &Drag, world_from_body: &Mat3) -> Self {
        let area = Mat3::from_diagonal(hull.projected_area);
        let per_volume = 0.5 * fluid.density * drag.coefficient / hull.volume;
        Self {
            linear: fluid.density * 2.0 * drag.damping * (fluid.gravity / hull.length()).sqrt(),
            quadratic: *world_from_body * area * world_from_body.transpose() * per_volume,
        }
    }

    /// Resistance of a submerged `volume` (m³) that water passes at `speed` (m/s), in N·s/m.
    fn at(&self, volume: f32, speed: f32) -> Mat3 {
        (Mat3::from_diagonal(Vec3::splat(self.linear)) + self.quadratic * speed) * volume
    }
}
