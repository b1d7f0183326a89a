//! Pressure and drag on a hull in a given pose and motion.

use glam::{Mat3, Vec2, Vec3};

use super::{Cell, VoxelHull};
use crate::load::{BodyState, Fluid, Load, Surface};

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
    /// Pressure and drag on the hull of `body`, about its centre of mass.
    ///
    /// `surface` gives the water at a world (x, z), or `None` where there is none.
    ///
    /// A submerged part V is pressed by ρ g V (−∂η/∂x, 1, −∂η/∂z), the pressure gradient under a slope; the water
    /// moves with one velocity from surface to bed.
    pub fn load(
        &self,
        body: &BodyState,
        fluid: &Fluid,
        drag: &Drag,
        mut surface: impl FnMut(Vec2) -> Option<Surface>,
    ) -> Load {
        let world_from_body = body.world_from_body();
        let drag = CellDrag::new(self, fluid, drag, &world_from_body);
        let (origin, centre) = (body.origin(), body.centre);
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
                add_cell(&mut load, cell, &wetted, arm, &water, body, fluid, &drag);
            }
        }
        if load.submerged_volume > 0.0 {
            load.water_velocity /= load.submerged_volume;
        }
        load
    }
}

/// Adds the submerged part of a cell.
fn add_cell(
    load: &mut Load,
    cell: &Cell,
    wetted: &Wetted,
    arm: Vec3,
    water: &Surface,
    body: &BodyState,
    fluid: &Fluid,
    drag: &CellDrag,
) {
    let volume = cell.volume * wetted.share;
    let area = cell.volume * wetted.waterplane;
    let weight = fluid.density * fluid.gravity;
    let arm = arm + wetted.shift;

    let up_slope = Vec3::new(-water.slope.x, 1.0, -water.slope.y);
    load.pressure.add_at(up_slope * (weight * volume), arm);
    // Rising by y loses ρ g A y of push.
    load.stiffness.add_along(weight * area, Vec3::Y, arm);

    let relative = body.passed_by(water.velocity, arm);
    let resistance = drag.at(volume, relative.length());
    load.resistance.add_at(resistance, arm);
    load.stream.add_at(resistance * water.velocity, arm);

    load.submerged_volume += volume;
    load.waterplane_area += area;
    load.water_velocity += water.velocity * volume;
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
