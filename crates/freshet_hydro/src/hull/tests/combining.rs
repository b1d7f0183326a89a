//! A union holds what any of its parts holds, once.

use super::*;
use glam::Quat;
use proptest::prelude::*;

#[track_caller]
fn union(parts: Vec<Hull>) -> Hull {
    let union = Hull::union(parts).unwrap();
    assert_eq!(union.doubled, 0);
    assert!(is_closed(&union.hull));
    union.hull
}

#[test]
fn two_cubes_that_overlap_by_half_hold_one_and_a_half() {
    let hull = union(vec![unit_cube_at(0.0, 0.0, 0.0), unit_cube_at(0.5, 0.0, 0.0)]);
    near("volume", hull.volume().into(), 1.5, 1e-6);
    near_point("centroid", hull.centroid(), Vec3::X * 0.25, 1e-6);
    near_matrix("moments", hull.covariance(), Mat3::from_diagonal(Vec3::new(2.25, 1.0, 1.0) / 12.0), 1e-6);
    near("area", hull.area().into(), 2.0 + 4.0 * 1.5, 1e-5);
    assert!(hull.shared() < hull.triangles().len());
}

#[test]
fn what_three_cubes_have_in_common_comes_back() {
    let at = [(0.0, 0.0), (0.5, 0.0), (0.25, 0.5)];
    let hull = union(at.map(|(x, z)| unit_cube_at(x, 0.0, z)).to_vec());
    // Two side by side cover 1.5 × 1; the third adds what lies beyond z = 0.5.
    near("volume", hull.volume().into(), 1.5 + 0.5, 1e-6);
    near_point("centroid", hull.centroid(), Vec3::new(0.25, 0.0, 0.5 * 0.75 / 2.0), 1e-6);
}

#[test]
fn cubes_that_touch_share_nothing() {
    for part in [
        unit_cube_at(1.0, 0.0, 0.0),
        unit_cube_at(1.0, 1.0, 0.0),
        unit_cube_at(1.0, 1.0, 1.0),
        unit_cube_at(1.0, 0.3, 0.0),
    ] {
        let hull = union(vec![unit_cube_at(0.0, 0.0, 0.0), part]);
        near("volume", hull.volume().into(), 2.0, 1e-6);
        assert_eq!(hull.shared(), hull.triangles().len());
    }
}

#[test]
fn a_part_that_is_given_twice_counts_once() {
    let ball = Hull::ball(1.0).unwrap();
    let hull = union(vec![ball.clone(), ball.clone(), ball.clone()]);
    near("volume", (hull.volume() / ball.volume()).into(), 1.0, 1e-5);
    let small = Hull::ball(0.3).unwrap();
    near("volume", (union(vec![small, ball.clone()]).volume() / ball.volume()).into(), 1.0, 1e-5);
}

#[test]
fn balls_share_their_lens() {
    let ball = |x: f32| Hull::ball(1.0).unwrap().placed(Quat::from_rotation_z(x), Vec3::X * x).unwrap();
    let hull = union(vec![ball(0.0), ball(1.0)]);
    // Two caps of height 1/2: π h² (3 − h)/3 each.
    let lens = 2.0 * std::f32::consts::PI * 0.25 * 2.5 / 3.0;
    near("volume", (hull.volume() / (2.0 * ball(0.0).volume() - lens)).into(), 1.0, 3e-3);
}

#[test]
fn parts_that_are_not_convex_count_twice_and_say_so() {
    let (points, triangles) = torus(1.0, 0.25, 24, 12);
    let ring = || Hull::new(&points, &triangles).unwrap();
    let rod = |x: f32| Hull::cylinder(0.5, 0.2).unwrap().placed(Quat::IDENTITY, Vec3::X * x).unwrap();
    let through_the_tube = Hull::union(vec![ring(), rod(1.0)]).unwrap();
    assert_eq!(through_the_tube.doubled, 1);
    let through_the_middle = Hull::union(vec![ring(), rod(0.0)]).unwrap();
    assert_eq!(through_the_middle.doubled, 0);
    near("volume", (through_the_middle.hull.volume() / (ring().volume() + rod(0.0).volume())).into(), 1.0, 1e-6);
}

#[test]
fn too_many_overlaps_count_twice_and_say_so() {
    let heap = Hull::union((0..8).map(|i| unit_cube_at(0.01 * i as f32, 0.0, 0.0)).collect()).unwrap();
    // Six parts make 2⁶ − 7 = 57 intersections, and the seventh would make 57 + 6 more.
    assert_eq!(heap.doubled, 6 + 7);
    near("volume", heap.hull.volume().into(), 1.05 + 2.0, 1e-5);
    let row = Hull::union((0..60).map(|i| unit_cube_at(0.75 * i as f32, 0.0, 0.0)).collect()).unwrap();
    assert_eq!(row.doubled, 0);
    near("volume", row.hull.volume().into(), 0.75 * 59.0 + 1.0, 1e-3);
}

#[test]
fn a_union_of_nothing_is_refused() {
    assert_eq!(Hull::union(Vec::new()), Err(crate::hull::HullError::NoTriangles));
}

/// One place somewhere in every cell of a lattice over a cube of 4.2 m, and the volume of a cell, m³. In the middle of the cells, faces
/// along the lattice would be misjudged whole.
fn scattered() -> (impl Iterator<Item = Vec3>, f32) {
    const COUNT: usize = 56;
    let step = 4.2 / COUNT as f32;
    let cell = |i: usize| Vec3::new((i % COUNT) as f32, (i / COUNT % COUNT) as f32, (i / COUNT / COUNT) as f32);
    let mut state = 1_u64;
    // Knuth's linear congruential generator MMIX.
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1 << 24) as f32
    };
    let place = move |i: usize| (cell(i) + Vec3::new(random(), random(), random())) * step - 2.1;
    ((0..COUNT.pow(3)).map(place), step.powi(3))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Three parts in any pose, against counting places.
    #[test]
    fn unions_hold_what_counting_finds(
        turns in prop::array::uniform3(prop::array::uniform4(-1.0_f32..1.0)),
        places in prop::array::uniform3(prop::array::uniform3(-0.6_f32..0.6)),
    ) {
        let shapes = [Hull::cuboid(Vec3::new(0.5, 0.6, 0.7)), Hull::cylinder(0.6, 0.4), Hull::capsule(0.3, 0.4)];
        let mut parts = Vec::new();
        for ((shape, turn), place) in shapes.into_iter().zip(turns).zip(places) {
            let rotation = Quat::from_array(turn);
            prop_assume!(rotation.length() > 0.1);
            parts.push(shape.unwrap().placed(rotation, Vec3::from_array(place)).unwrap());
        }
        let inside = |point: Vec3| parts.iter().any(|part| {
            let beyond = |&triangle: &[u32; 3]| {
                let [a, b, c] = triangle.map(|i| part.points()[i as usize]);
                (b - a).cross(c - a).dot(point - a) > 0.0
            };
            !part.triangles().iter().any(beyond)
        });
        let (places, each) = scattered();
        let counted = places.filter(|&place| inside(place)).count() as f32 * each;
        let hull = union(parts.clone());
        // The surface of some 8 m² goes through 1400 of its cells, each misjudged by up to 2·10⁻⁴ m³ at random: together by 8·10⁻³ m³.
        prop_assert!((hull.volume() - counted).abs() < 0.04, "{} for {counted}", hull.volume());
    }
}
