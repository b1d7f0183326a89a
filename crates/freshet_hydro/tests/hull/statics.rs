//! Hulls against Archimedes: forces, drafts, attitudes.
use super::{Body, STILL, WEIGHT, below_plane, run, shapes};
use freshet_hydro::{
    hull::Hull,
    load::{BodyState, Fluid, Surface},
    waves::WATER_DENSITY,
};
use glam::{EulerRot, Mat3, Quat, Vec2, Vec3, vec2, vec3};
use proptest::prelude::*;
use std::f32::consts::{PI, TAU};

fn rotations() -> impl Strategy<Value = Quat> {
    (0.0..TAU, 0.0..PI, 0.0..TAU).prop_map(|(a, b, c)| Quat::from_euler(EulerRot::YXY, a, b, c))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// Under any plane the force on any hull is ρ g V (−∂η/∂x, 1, −∂η/∂z), through the centroid of the displaced water.
    #[test]
    fn the_force_is_the_weight_of_the_displaced_water(
        which in 0..6_usize, rotation in rotations(), height in -1.0..1.0_f32,
        slope in (-0.4..0.4_f32, -0.4..0.4_f32), scale in 0.01..100.0_f32,
    ) {
        let hull = shapes().swap_remove(which).1.scaled(Vec3::splat(scale)).expect("a hull");
        let mut body = Body::new(hull, 500.0, 0.0);
        body.rotation = rotation;
        let slope = vec2(slope.0, slope.1);
        let load = body.load(Surface { height: height * scale, slope, velocity: Vec3::ZERO });
        let placed: Vec<Vec3> = body.hull.points().iter().map(|p| rotation * (*p - body.hull.centroid())).collect();
        let depth = |p: Vec3| height * scale + slope.dot(vec2(p.x, p.z)) - p.y;
        let (volume, centroid) = below_plane(&placed, body.hull.triangles(), depth);
        let (volume, centroid) = (volume as f32, centroid.as_vec3());
        prop_assume!(volume > 0.02 * body.hull.volume());
        let expected = vec3(-slope.x, 1.0, -slope.y) * (WEIGHT * volume);
        let off = (load.pressure.force - expected).length() / expected.length();
        prop_assert!(off < 1e-4, "force off by {off}");
        let torque = centroid.cross(expected);
        let off = (load.pressure.torque - torque).length() / (expected.length() * body.hull.length());
        prop_assert!(off < 1e-4, "torque off by {off}");
        prop_assert!((load.submerged_volume / volume - 1.0).abs() < 1e-4);
    }
}

#[test]
fn bodies_rest_at_their_analytic_draft() {
    println!("shape      density  draft m   analytic  off %");
    let mut worst = 0.0_f32;
    for density in [50.0, 200.0, 350.0, 500.0, 650.0, 800.0, 950.0] {
        let s = density / WATER_DENSITY;
        let cap = 1.0 + 2.0 * (((1.0 - 2.0 * s).acos() + 4.0 * PI) / 3.0).cos();
        let cases = [
            ("ball", Hull::ball(0.5).expect("a hull"), 0.5, 0.5 * cap),
            ("cuboid", Hull::cuboid(vec3(0.6, 0.25, 0.5)).expect("a hull"), 0.25, 0.5 * s),
            ("cylinder", Hull::cylinder(0.25, 0.6).expect("a hull"), 0.25, 0.5 * s),
            ("cone", Hull::cone(0.3, 0.6).expect("a hull"), 0.15, 0.6 * (1.0 - (1.0 - s).cbrt())),
        ];
        for (name, hull, lowest, analytic) in cases {
            let mut body = Body::new(hull, density, 0.0);
            body.upright = true;
            run(&mut body, STILL, 90.0, 60.0);
            // Of the smooth shape, whose lowest point is that far below its centroid.
            let found = lowest - body.centre.y;
            let off = 100.0 * (found / analytic - 1.0);
            println!("{name:<10} {density:>6}  {found:>8.5}  {analytic:>8.5}  {off:>6.3}");
            worst = worst.max(off.abs());
            assert!(body.motion.linear.length() < 1e-3, "{name} of {density} is at rest");
        }
    }
    assert!(worst < 0.5, "{worst} %");
}

/// A cube floats upright if it is lighter than 0.211 or heavier than 0.789 of the water; between them it tips over.
#[test]
fn a_cube_stands_only_if_it_is_light_or_heavy() {
    for (s, stands) in [(0.15, true), (0.2, true), (0.23, false), (0.5, false), (0.77, false), (0.8, true), (0.9, true)]
    {
        let mut body = Body::new(Hull::cuboid(Vec3::splat(0.5)).expect("a hull"), s * WATER_DENSITY, 0.5 - s);
        body.rotation = Quat::from_euler(EulerRot::XYZ, 0.01, 0.0, 0.006);
        run(&mut body, STILL, 60.0, 60.0);
        let up = Mat3::from_quat(body.rotation).transpose() * Vec3::Y;
        let lean = up.abs().max_element().clamp(0.0, 1.0).acos().to_degrees();
        println!("density {s}: leans by {lean:.2}° after a minute");
        assert_eq!(lean < 1.0, stands, "{lean}");
    }
}

/// Where some of a hull's points have no water the forces are finite, and what acts there acts within the hull.
#[test]
fn a_hull_half_over_a_shore_is_pushed_within_itself() {
    for (name, hull) in shapes() {
        let mut body = Body::new(hull, 500.0, 0.0);
        for k in 0..40 {
            body.rotation = Quat::from_euler(EulerRot::YXZ, 0.3 * k as f32, 0.2 * k as f32, 0.5 * k as f32);
            let shore = 0.05 * k as f32 - 1.0;
            let state = BodyState { pose: body.pose(), centre: body.centre, motion: body.motion };
            let water = |place: Vec2| (place.x < shore).then_some(STILL);
            let load = body.hull.load(&state, &Fluid::default(), &body.drag, &mut body.points, water);
            let mass = load.added_mass;
            let reach = body.hull.points().iter().map(|p| p.distance(body.hull.centroid())).fold(0.0, f32::max);
            let most = mass.linear.x_axis.x.max(mass.linear.y_axis.y).max(mass.linear.z_axis.z);
            assert!(load.pressure.is_finite() && mass.angular.is_finite(), "{name} {k}");
            let turned = mass.angular.x_axis.x.max(mass.angular.y_axis.y).max(mass.angular.z_axis.z);
            assert!(turned <= 7.0 * most * reach * reach, "{name} {k}: {turned} {most}");
        }
    }
}
