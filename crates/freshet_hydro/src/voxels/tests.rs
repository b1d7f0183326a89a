//! Hulls against Archimedes, and motion against the formulas of falling and drifting bodies.

use std::f32::consts::PI;

use approx::assert_relative_eq;
use glam::{EulerRot, Mat3, Quat, Vec2, Vec3};
use proptest::prelude::*;

use super::*;
use crate::load::{BodyState, Fluid, Inertia, Load, Motion, Pose, Surface, Wrench};
use crate::waves::{GRAVITY, WATER_DENSITY};

/// Weight of a cubic metre of water, N.
const WEIGHT: f32 = WATER_DENSITY * GRAVITY;

const STILL: Surface = Surface { height: 0.0, slope: Vec2::ZERO, velocity: Vec3::ZERO };

fn cuboid(size: Vec3) -> VoxelHull {
    VoxelHull::new([-size / 2.0, size / 2.0], 4, |_| f32::NEG_INFINITY).unwrap()
}

fn sphere(radius: f32) -> VoxelHull {
    let volume = 4.0 / 3.0 * PI * radius.powi(3);
    let corner = Vec3::splat(radius);
    VoxelHull::new([-corner, corner], 4, |p| p.length() - radius).unwrap().with_volume(volume).unwrap()
}

/// A capsule along y: a cylinder of half height `half` between two half spheres.
fn capsule(half: f32, radius: f32) -> VoxelHull {
    let corner = Vec3::new(radius, half + radius, radius);
    VoxelHull::new([-corner, corner], 4, |p| (p - Vec3::Y * p.y.clamp(-half, half)).length() - radius).unwrap()
}

fn still_load(hull: &VoxelHull, height: f32, rotation: Quat) -> Load {
    let position = Vec3::Y * height;
    let pose = Pose { position, rotation };
    let centre = position + rotation * hull.centroid();
    let body = BodyState { pose, centre, ..BodyState::default() };
    hull.load(&body, &Fluid::default(), &Drag::default(), |_| Some(STILL))
}

/// Height of the body's origin at which the water carries a body of relative density `s`, by bisection.
fn equilibrium(hull: &VoxelHull, rotation: Quat, s: f32) -> f32 {
    let (mut low, mut high) = (-10.0, 10.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let submerged = still_load(hull, middle, rotation).submerged_volume;
        if submerged > s * hull.volume() {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[test]
fn sampled_volumes_are_near_and_given_ones_exact() {
    assert_relative_eq!(cuboid(Vec3::new(1.0, 2.0, 3.0)).volume(), 6.0, max_relative = 1e-5);
    let exact = PI * 0.3f32.powi(2) * 1.0 + 4.0 / 3.0 * PI * 0.3f32.powi(3);
    assert_relative_eq!(capsule(0.5, 0.3).volume(), exact, max_relative = 0.02);
    let scaled = capsule(0.5, 0.3).with_volume(exact).unwrap();
    let cells: f32 = scaled.cells().iter().map(|cell| cell.volume).sum();
    assert_relative_eq!(cells, exact, max_relative = 1e-5);
    assert_relative_eq!(sphere(1.0).volume(), 4.0 / 3.0 * PI, max_relative = 1e-6);
}

/// I/m of a cube is a²/6, of a sphere 2r²/5, and a box far from its frame's origin has the same.
#[test]
fn inertia_comes_from_the_cells() {
    let cube = cuboid(Vec3::splat(2.0)).unit_inertia();
    assert!(cube.abs_diff_eq(Mat3::from_diagonal(Vec3::splat(4.0 / 6.0)), 1e-5));
    let ball = sphere(0.5).unit_inertia();
    assert!(ball.abs_diff_eq(Mat3::from_diagonal(Vec3::splat(0.1)), 2e-3));
    let away = Vec3::new(100.0, -50.0, 20.0);
    let far = VoxelHull::new([away, away + 2.0], 4, |_| f32::NEG_INFINITY).unwrap();
    assert!(far.centroid().abs_diff_eq(away + 1.0, 1e-4));
    assert!(far.unit_inertia().abs_diff_eq(cube, 1e-4));
}

#[test]
fn shadows_are_those_of_the_shape() {
    assert!(cuboid(Vec3::new(1.0, 2.0, 3.0)).projected_area().abs_diff_eq(Vec3::new(6.0, 3.0, 2.0), 1e-4));
    assert!(sphere(1.0).projected_area().abs_diff_eq(Vec3::splat(PI), 0.1));
}

/// A sphere of relative density s has the draft R(1 + 2 cos((acos(1 − 2s) + 4π)/3)).
#[test]
fn sphere_drafts() {
    let radius = 0.7;
    let hull = sphere(radius);
    for s in [0.1_f32, 0.25, 0.5, 0.75, 0.9] {
        let angle = ((1.0 - 2.0 * s).acos() + 4.0 * PI) / 3.0;
        let exact = radius * (1.0 + 2.0 * angle.cos());
        for rotation in [Quat::IDENTITY, Quat::from_rotation_x(0.6), Quat::from_euler(EulerRot::XYZ, 0.4, 1.0, 0.7)] {
            let draft = radius - equilibrium(&hull, rotation, s);
            assert_relative_eq!(draft, exact, max_relative = 0.02, epsilon = 0.02 * radius);
        }
    }
}

#[test]
fn box_drafts_are_exact() {
    let size = Vec3::new(2.0, 0.6, 1.0);
    for s in [0.1_f32, 0.25, 0.5, 0.75, 0.9] {
        let draft = 0.3 - equilibrium(&cuboid(size), Quat::IDENTITY, s);
        assert_relative_eq!(draft, s * 0.6, max_relative = 1e-4);
    }
}

/// A lying capsule cuts the water in circle segments; half of it is under at half density.
#[test]
fn capsule_floats_half_under_at_half_density() {
    let hull = capsule(0.5, 0.3);
    for rotation in [Quat::IDENTITY, Quat::from_rotation_x(PI / 2.0), Quat::from_rotation_z(0.5)] {
        assert!(equilibrium(&hull, rotation, 0.5).abs() < 0.02 * 0.6);
    }
}

/// Archimedes: a submerged body of any shape and pose is pushed by ρgV through its centroid.
#[test]
fn submerged_push_is_that_of_archimedes() {
    let hull = capsule(0.5, 0.3);
    let load = still_load(&hull, -5.0, Quat::from_euler(EulerRot::XYZ, 0.4, 1.0, 0.7));
    assert!(load.pressure.force.abs_diff_eq(Vec3::Y * WEIGHT * hull.volume(), 1e-4 * WEIGHT));
    assert!(load.pressure.torque.length() < 1e-4 * load.pressure.force.length());
    assert_eq!(still_load(&hull, 5.0, Quat::IDENTITY).pressure, Wrench::ZERO);
}

/// Under a slope s the push is ρgV(ŷ − s) (divergence theorem): floats slide down waves.
#[test]
fn a_slope_pushes_downhill() {
    let hull = cuboid(Vec3::ONE);
    let slope = Vec2::new(0.1, -0.2);
    let water = |at: Vec2| Some(Surface { height: 10.0 + slope.dot(at), slope, velocity: Vec3::ZERO });
    let load = hull.load(&BodyState::default(), &Fluid::default(), &Drag::default(), water);
    assert!(load.pressure.force.abs_diff_eq(WEIGHT * Vec3::new(-0.1, 1.0, 0.2), 1e-4 * WEIGHT));
}

/// Box 2 × 1 × 0.6 m of half density: GM = 0.12778 m, so the righting moment at a small tilt φ is −ρgV·GM·φ.
#[test]
fn a_tilted_box_is_righted_as_its_metacentre_says() {
    let hull = cuboid(Vec3::new(2.0, 0.6, 1.0));
    let tilt = 0.02;
    let load = still_load(&hull, 0.0, Quat::from_rotation_x(tilt));
    let exact = -WEIGHT * 0.6 * 0.127_78 * tilt;
    assert_relative_eq!(load.pressure.torque.x, exact, max_relative = 0.1);
}

/// A cube of half density is unstable upright (GM < 0), one of density 0.1 stable.
#[test]
fn a_half_dense_cube_tips_over_and_a_light_one_stands() {
    let hull = cuboid(Vec3::ONE);
    let moment = |s: f32| {
        let rotation = Quat::from_rotation_z(0.1);
        still_load(&hull, equilibrium(&hull, rotation, s), rotation).pressure.torque.z
    };
    assert!(moment(0.5) > 0.0);
    assert!(moment(0.1) < 0.0);
}

/// A body let go in a stream of 1 m/s, stepped as a solver would step it.
fn drift(hull: &VoxelHull, s: f32, dt: f32, seconds: f32) -> Vec<f32> {
    let mass = s * WATER_DENSITY * hull.volume();
    let inverse_inertia = (hull.unit_inertia() * mass).inverse();
    let stream = Surface { velocity: Vec3::X, ..STILL };
    let (fluid, drag) = (Fluid::default(), Drag::default());
    let weight = Wrench { force: Vec3::NEG_Y * mass * GRAVITY, torque: Vec3::ZERO };
    let mut position = Vec3::Y * equilibrium(hull, Quat::IDENTITY, s);
    let mut motion = Motion::default();
    (0..(seconds / dt) as usize)
        .map(|_| {
            let pose = Pose { position, rotation: Quat::IDENTITY };
            let body = BodyState { pose, centre: position, motion };
            let load = hull.load(&body, &fluid, &drag, |_| Some(stream));
            let wrench = load.over_step(
                &motion,
                &Inertia { inverse_mass: Vec3::splat(mass.recip()), inverse_inertia },
                weight,
                dt,
            );
            motion.linear += (wrench.force + weight.force) * (dt / mass);
            position += motion.linear * dt;
            motion.linear.x
        })
        .collect()
}

#[test]
fn a_stream_carries_bodies_to_its_speed_without_overshoot() {
    for (size, s) in [(1.0, 0.5), (0.1, 0.05), (0.02, 0.01), (3.0, 0.9)] {
        for dt in [1.0 / 60.0, 1.0 / 20.0] {
            let speeds = drift(&cuboid(Vec3::splat(size)), s, dt, 10.0);
            assert!(speeds.iter().all(|v| *v <= 1.0 + 1e-4), "overshoot of a {size} m cube at {dt} s");
            assert!(speeds.is_sorted_by(|a, b| *a <= *b + 1e-5));
            assert!(speeds.last().is_some_and(|v| *v > 0.95), "{size} m cube: {:?}", speeds.last());
        }
    }
}

/// In balance the force of a step is the pressure alone, whatever the step's length.
#[test]
fn a_body_in_balance_stays_so() {
    let hull = cuboid(Vec3::ONE);
    let load = still_load(&hull, 0.0, Quat::IDENTITY);
    let weight = Wrench { force: -load.pressure.force, torque: Vec3::ZERO };
    for dt in [1e-3, 0.02, 0.5] {
        let wrench = load.over_step(
            &Motion::default(),
            &Inertia { inverse_mass: Vec3::splat(2e-3), inverse_inertia: Mat3::IDENTITY * 0.01 },
            weight,
            dt,
        );
        assert!(wrench.force.abs_diff_eq(load.pressure.force, 1e-5 * load.pressure.force.y));
    }
}

#[test]
fn what_is_no_body_is_refused() {
    let unit = [Vec3::ZERO, Vec3::ONE];
    assert_eq!(VoxelHull::new(unit, 4, |_| f32::INFINITY), Err(HullError::Empty));
    let cube = VoxelHull::new(unit, 4, |_| f32::NEG_INFINITY).unwrap();
    assert_eq!(cube.clone().with_volume(0.0), Err(HullError::Volume(0.0)));
    assert!(cube.with_volume(f32::NAN).is_err());
    let flat = [Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0)];
    assert!(matches!(VoxelHull::new(flat, 4, |_| f32::NEG_INFINITY), Err(HullError::Bounds { .. })));
    let nan = [Vec3::NAN, Vec3::ONE];
    assert!(matches!(VoxelHull::new(nan, 4, |_| f32::NEG_INFINITY), Err(HullError::Bounds { .. })));
    assert_eq!(VoxelHull::new(unit, 0, |_| f32::NEG_INFINITY).unwrap().cells().len(), 1);
}

proptest! {
    /// Drag takes energy out, never in: without water motion and weight a step cannot speed a body up.
    #[test]
    fn resistance_never_adds_energy(
        linear in prop::array::uniform3(-20.0f32..20.0),
        angular in prop::array::uniform3(-20.0f32..20.0),
        size in 0.02f32..3.0,
        s in 0.02f32..1.0,
        dt in 0.001f32..0.1,
    ) {
        let hull = cuboid(Vec3::new(size, 0.5 * size, 2.0 * size));
        let mass = s * WATER_DENSITY * hull.volume();
        let inertia = hull.unit_inertia() * mass;
        let before = Motion { linear: linear.into(), angular: angular.into() };
        let fluid = Fluid { gravity: 0.0, ..Fluid::default() };
        let pose = Pose { position: Vec3::NEG_Y * 10.0, rotation: Quat::IDENTITY };
        let body = BodyState { pose, centre: pose.position, motion: before };
        let load = hull.load(&body, &fluid, &Drag::default(), |_| Some(STILL));
        let solver = Inertia { inverse_mass: Vec3::splat(mass.recip()), inverse_inertia: inertia.inverse() };
        let wrench = load.over_step(&before, &solver, Wrench::ZERO, dt);
        let energy = |m: &Motion| mass * m.linear.length_squared() + m.angular.dot(inertia * m.angular);
        let after = Motion {
            linear: before.linear + wrench.force * (dt / mass),
            angular: before.angular + inertia.inverse() * wrench.torque * dt,
        };
        prop_assert!(energy(&after) <= energy(&before) * (1.0 + 1e-4) + 1e-6);
        prop_assert!(after.linear.dot(before.linear) >= -1e-4 * before.linear.length_squared());
    }

    /// The submerged volume grows with depth from nothing to all of it, in every pose.
    #[test]
    fn submersion_is_monotone(angles in prop::array::uniform3(-3.0f32..3.0), depth in -1.0f32..1.0, more in 0.0f32..0.5) {
        let hull = sphere(0.5);
        let rotation = Quat::from_euler(EulerRot::XYZ, angles[0], angles[1], angles[2]);
        let shallow = still_load(&hull, -depth, rotation);
        let deep = still_load(&hull, -depth - more, rotation);
        prop_assert!(deep.submerged_volume >= shallow.submerged_volume - 1e-6);
        prop_assert!(deep.submerged_volume <= hull.volume() * (1.0 + 1e-5));
        prop_assert_eq!(shallow, still_load(&hull, -depth, rotation));
    }
}
