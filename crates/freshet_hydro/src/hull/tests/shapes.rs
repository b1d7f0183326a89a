//! Shapes hold what their smooth originals hold.

use super::*;
use crate::hull::HullError;
use proptest::prelude::*;
use std::f32::consts::PI;

/// Compares a hull with the volume, the height of the centroid and the second moments about it of a solid of revolution about y.
/// All are exact but for rounding, save the moments across the axis: they differ by what the corners are off the smooth surface.
#[track_caller]
fn compare(hull: &Hull, volume: f32, height: f32, [across, along]: [f32; 2]) {
    let length = hull.length();
    near("volume", (hull.volume() / volume).into(), 1.0, 1e-6);
    near_point("centroid", hull.centroid() / length, Vec3::Y * height / length, 1e-6);
    let moments = hull.covariance();
    near("moment along", (moments.y_axis.y / along).into(), 1.0, 1e-4);
    for across_moment in [moments.x_axis.x, moments.z_axis.z] {
        near("moment across", (across_moment / across).into(), 1.0, 5e-3);
    }
    let mixed = [moments.x_axis.y, moments.y_axis.z, moments.z_axis.x];
    near_point("mixed moments", Vec3::from_array(mixed) / length.powi(2), Vec3::ZERO, 1e-6);
    assert!(is_closed(hull));
}

#[test]
fn a_ball_holds_four_thirds_pi() {
    let r = 0.7_f32;
    let ball = Hull::ball(r).unwrap();
    compare(&ball, 4.0 / 3.0 * PI * r.powi(3), 0.0, [r * r / 5.0; 2]);
    assert_eq!(ball.triangles().len(), 320);
    near("area", (ball.area() / (4.0 * PI * r * r)).into(), 1.0, 0.01);
}

#[test]
fn a_cuboid_is_exact_in_all_moments() {
    let half = Vec3::new(0.5, 1.0, 1.5);
    let cuboid = Hull::cuboid(half).unwrap();
    near("volume", cuboid.volume().into(), 6.0, 1e-6);
    near_point("centroid", cuboid.centroid(), Vec3::ZERO, 1e-7);
    near_matrix("moments", cuboid.covariance(), Mat3::from_diagonal(half * half / 3.0), 1e-6);
    let [xx, yy, zz] = (half * half / 3.0).to_array();
    near_matrix("inertia", cuboid.unit_inertia(), Mat3::from_diagonal(Vec3::new(yy + zz, zz + xx, xx + yy)), 1e-6);
    near("area", cuboid.area().into(), 2.0 * (2.0 + 6.0 + 3.0), 1e-5);
    assert_eq!(cuboid.bounds(), [-half, half]);
}

#[test]
fn a_cylinder_holds_its_circle_times_its_height() {
    let (h, r) = (0.8_f32, 0.5_f32);
    let cylinder = Hull::cylinder(h, r).unwrap();
    compare(&cylinder, 2.0 * PI * r * r * h, 0.0, [r * r / 4.0, h * h / 3.0]);
}

#[test]
fn a_cone_has_its_centroid_a_quarter_up() {
    let (h, r) = (0.8_f32, 0.5_f32);
    let cone = Hull::cone(h, r).unwrap();
    compare(&cone, 2.0 / 3.0 * PI * r * r * h, -h / 2.0, [3.0 / 20.0 * r * r, 3.0 / 20.0 * h * h]);
}

#[test]
fn a_capsule_is_a_cylinder_and_a_ball() {
    let (h, r) = (0.8_f32, 0.5_f32);
    let [rod, ball] = [2.0 * PI * r * r * h, 4.0 / 3.0 * PI * r.powi(3)];
    let across = (rod * r * r / 4.0 + ball * r * r / 5.0) / (rod + ball);
    // A half ball's centroid lies 3/8 r above its base.
    let along = (rod * h * h / 3.0 + ball * (h * h + 0.75 * h * r + r * r / 5.0)) / (rod + ball);
    compare(&Hull::capsule(h, r).unwrap(), rod + ball, 0.0, [across, along]);
}

/// V = ∫A dy, with the area A of the section at each height, in ten thousand slices: volume, height of the centroid and moments.
fn sliced(low: f64, high: f64, radius: impl Fn(f64) -> f64) -> (f32, f32, [f32; 2]) {
    let step = (high - low) / 1e4;
    let slices: Vec<_> = (0..10_000).map(|i| low + (f64::from(i) + 0.5) * step).map(|y| (y, radius(y))).collect();
    let sum = |of: &dyn Fn(f64, f64) -> f64| {
        slices.iter().map(|&(y, r)| of(y, r) * std::f64::consts::PI * r * r * step).sum::<f64>()
    };
    let volume = sum(&|_, _| 1.0);
    let height = sum(&|y, _| y) / volume;
    let [across, along] =
        [sum(&|_, r| r * r / 4.0), sum(&|y, _| (y - height).powi(2))].map(|sum| (sum / volume) as f32);
    (volume as f32, height as f32, [across, along])
}

#[test]
fn a_round_cylinder_holds_what_its_slices_hold() {
    let (h, r, b) = (0.6, 0.4, 0.2);
    let (volume, height, moments) = sliced(-h - b, h + b, |y| r + (b * b - (y.abs() - h).max(0.0).powi(2)).sqrt());
    compare(&Hull::round_cylinder(h as f32, r as f32, b as f32).unwrap(), volume, height, moments);
}

#[test]
fn a_round_cone_holds_what_its_slices_hold() {
    let (h, r, b) = (0.6_f64, 0.4_f64, 0.2_f64);
    let slant = (4.0 * h * h + r * r).sqrt();
    let rim = |y: f64| r + (b * b - (y + h).powi(2)).max(0.0).sqrt();
    let tip = |y: f64| (b * b - (y - h).powi(2)).max(0.0).sqrt();
    let side = |y: f64| r * (h - y) / (2.0 * h) + b * slant / (2.0 * h);
    let lean = b * r / slant;
    let radius = |y: f64| {
        if y < lean - h {
            rim(y)
        } else if y > h + lean {
            tip(y)
        } else {
            side(y)
        }
    };
    let (volume, height, moments) = sliced(-h - b, h + b, radius);
    compare(&Hull::round_cone(h as f32, r as f32, b as f32).unwrap(), volume, height, moments);
}

#[test]
fn a_round_cuboid_holds_box_plates_rods_and_ball() {
    let (Vec3 { x, y, z }, b) = (Vec3::new(0.5, 0.3, 0.7), 0.15_f32);
    let volume =
        8.0 * (x * y * z + (x * y + y * z + z * x) * b) + 2.0 * PI * (x + y + z) * b * b + 4.0 / 3.0 * PI * b.powi(3);
    let hull = Hull::round_cuboid(Vec3::new(x, y, z), b).unwrap();
    near("volume", (hull.volume() / volume).into(), 1.0, 1e-6);
    near_point("centroid", hull.centroid(), Vec3::ZERO, 1e-6);
    near_point("size", hull.bounds()[1], Vec3::new(x, y, z) + b, 0.01);
    for (axis, [x, y, z]) in [[x, y, z], [y, z, x], [z, x, y]].into_iter().enumerate() {
        // Across an axis lie rounded rectangles, whose border shrinks beyond the box as that of a circle.
        let area = |border: f32| 4.0 * y * z + 4.0 * border * (y + z) + PI * border * border;
        let step = (x + b) / 1e4;
        let slices = (0..10_000).map(|i| (i as f32 + 0.5) * step);
        let sum: f64 =
            slices.map(|at| f64::from(at * at * area((b * b - (at - x).max(0.0).powi(2)).sqrt()) * step)).sum();
        near("moment", f64::from(hull.covariance().col(axis)[axis] * volume) / (2.0 * sum), 1.0, 5e-3);
    }
    assert_eq!(hull.triangles().len(), 236);
    assert!(is_closed(&hull));
}

/// Everything a shape is made of, at odd proportions.
fn of_every_kind(a: f32, b: f32, c: f32) -> Vec<Hull> {
    let half = Vec3::new(a, b, c);
    let kinds = [
        Hull::ball(a),
        Hull::cuboid(half),
        Hull::cylinder(a, b),
        Hull::capsule(a, b),
        Hull::cone(a, b),
        Hull::round_cuboid(half, c),
        Hull::round_cylinder(a, b, c),
        Hull::round_cone(a, b, c),
    ];
    kinds.into_iter().map(Result::unwrap).collect()
}

#[test]
fn sizes_that_are_none_are_refused() {
    for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let half = Vec3::new(1.0, 1.0, bad);
        let refused = [
            Hull::ball(bad),
            Hull::cuboid(half),
            Hull::cylinder(1.0, bad),
            Hull::capsule(bad, 1.0),
            Hull::cone(1.0, bad),
            Hull::round_cuboid(half, 1.0),
            Hull::round_cylinder(1.0, 1.0, bad),
            Hull::round_cone(bad, 1.0, 1.0),
            Hull::ball(1.0).unwrap().with_volume(bad),
        ];
        assert!(refused.iter().all(|hull| matches!(hull, Err(HullError::Size { .. }))), "{bad}: {refused:?}");
    }
    let lost = Hull::ball(1.0).unwrap().placed(glam::Quat::IDENTITY, Vec3::X * 1e8);
    assert_eq!(lost, Err(HullError::Flat), "coordinates of 10⁸ m are rounded to 8 m");
    assert_eq!(Hull::ball(1e-20), Err(HullError::Flat));
    assert_eq!(Hull::ball(1e20), Err(HullError::Flat));
}

proptest! {
    #[test]
    fn shapes_of_any_proportion_are_closed_and_convex(a in 0.01_f32..10.0, b in 0.01_f32..10.0, c in 0.01_f32..10.0) {
        for (kind, hull) in of_every_kind(a, b, c).iter().enumerate() {
            prop_assert!(is_closed(hull), "{kind}");
            prop_assert!(crate::hull::convex::Convex::of(hull).is_some(), "{kind}");
            let again = Hull::new(hull.points(), hull.triangles()).unwrap();
            prop_assert!((again.volume() / hull.volume() - 1.0).abs() < 1e-5, "{kind}");
        }
    }

    #[test]
    fn volume_grows_with_the_cube_of_size_wherever_the_body_is(
        turn in prop::array::uniform4(-1.0_f32..1.0),
        place in prop::array::uniform3(-10.0_f32..10.0),
        scale in 0.1_f32..10.0,
        mirror in 0_u32..8,
    ) {
        let rotation = glam::Quat::from_array(turn);
        prop_assume!(rotation.length() > 0.1);
        let factors = Vec3::from_array([0, 1, 2].map(|axis| if mirror >> axis & 1 == 1 { -scale } else { scale }));
        for hull in of_every_kind(0.5, 0.8, 0.3) {
            let expected = hull.volume() * scale.powi(3);
            let inertia = hull.unit_inertia() * scale * scale;
            let rotation = rotation.normalize();
            let moved = hull.clone().scaled(factors).unwrap().placed(rotation, Vec3::from_array(place)).unwrap();
            prop_assert!((moved.volume() / expected - 1.0).abs() < 1e-4, "{} for {expected}", moved.volume());
            let centre = rotation * (hull.centroid() * factors) + Vec3::from_array(place);
            prop_assert!(moved.centroid().distance(centre) < 2e-5, "{} for {centre}", moved.centroid());
            let turned = Mat3::from_quat(rotation) * inertia * Mat3::from_quat(rotation.inverse());
            prop_assert!(mirror != 0 || moved.unit_inertia().abs_diff_eq(turned, 1e-3 * scale * scale));
            prop_assert!(moved.area() > 0.0 && is_closed(&moved));
        }
    }
}
