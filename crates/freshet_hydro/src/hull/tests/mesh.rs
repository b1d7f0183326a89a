//! Meshes as they come: doubled points, wrong windings, holes, and things that are no mesh.

use super::*;
use crate::hull::HullError;
use proptest::prelude::*;

fn cube() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let cube = Hull::cuboid(Vec3::splat(0.5)).unwrap();
    (cube.points().to_vec(), cube.triangles().to_vec())
}

/// Every triangle with points of its own, each shifted a little.
fn apart(points: &[Vec3], triangles: &[[u32; 3]], shift: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let corners = triangles.as_flattened().iter().enumerate();
    let apart = corners.map(|(i, &point)| points[point as usize] + shift * ((i % 7) as f32 / 3.0 - 1.0)).collect();
    (apart, (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

/// Two meshes in one list.
fn both(a: (Vec<Vec3>, Vec<[u32; 3]>), b: (Vec<Vec3>, Vec<[u32; 3]>)) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let first = a.0.len() as u32;
    let moved = b.1.into_iter().map(|triangle| triangle.map(|point| first + point)).collect();
    ([a.0, b.0].concat(), [a.1, moved].concat())
}

fn sized(mesh: (Vec<Vec3>, Vec<[u32; 3]>), scale: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    (mesh.0.into_iter().map(|point| point * scale).collect(), mesh.1)
}

fn inside_out(mesh: (Vec<Vec3>, Vec<[u32; 3]>)) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    (mesh.0, mesh.1.into_iter().map(|[a, b, c]| [a, c, b]).collect())
}

#[track_caller]
fn holds(mesh: (Vec<Vec3>, Vec<[u32; 3]>), volume: f32) -> Hull {
    let hull = Hull::new(&mesh.0, &mesh.1).unwrap();
    near("volume", (hull.volume() / volume).into(), 1.0, 1e-5);
    assert!(is_closed(&hull));
    hull
}

#[test]
fn a_cube_with_points_for_every_face_is_welded() {
    let (points, triangles) = cube();
    let hull = holds(apart(&points, &triangles, 0.0), 1.0);
    assert_eq!(hull.points().len(), 8);
    let hull = holds(apart(&points, &triangles, 3e-7), 1.0);
    assert_eq!(hull.points().len(), 8, "points on both sides of a cell's border");
}

#[test]
fn far_from_the_origin_points_are_welded_too() {
    let (points, triangles) = cube();
    let points: Vec<_> = points.iter().map(|point| *point + Vec3::new(1e5, -2e5, 3e5)).collect();
    let hull = holds(apart(&points, &triangles, 0.0), 1.0);
    near_point("centroid", hull.centroid(), Vec3::new(1e5, -2e5, 3e5), 0.02);
}

#[test]
fn wrong_windings_are_mended() {
    holds(inside_out(cube()), 1.0);
    let (points, mut triangles) = cube();
    for triangle in triangles.iter_mut().step_by(3) {
        triangle.swap(0, 1);
    }
    holds((points, triangles), 1.0);
}

#[test]
fn an_l_has_its_centroid_off_the_middle() {
    let outline = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    let layer = |z: f32| outline.map(|(x, y)| Vec3::new(x, y, z));
    let lid = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
    let walls = (0..6).flat_map(|i| [[i, (i + 1) % 6, (i + 1) % 6 + 6], [i, (i + 1) % 6 + 6, i + 6]]);
    let triangles = lid.into_iter().map(|[a, b, c]| [a, c, b]).chain(lid.map(|lid| lid.map(|i| i + 6))).chain(walls);
    let hull = holds(([layer(0.0), layer(1.0)].concat(), triangles.collect()), 3.0);
    near_point("centroid", hull.centroid(), Vec3::new(5.0 / 6.0, 5.0 / 6.0, 0.5), 1e-6);
    // Three unit squares, whose middles lie at (−1, −1)/3, (2, −1)/3 and (−1, 2)/3 from there: their mean of x y is −1/9.
    near("moment xy", hull.covariance().x_axis.y.into(), -1.0 / 9.0, 1e-6);
    near("moment xx", hull.covariance().x_axis.x.into(), 2.0 / 9.0 + 1.0 / 12.0, 1e-6);
}

#[test]
fn a_torus_holds_what_its_polygons_sweep() {
    let (major, minor, n, m) = (2.0_f32, 0.5_f32, 48, 24);
    let hull = holds(torus(major, minor, n, m), polygonal_torus(major.into(), minor.into(), n.into(), m.into()));
    near_point("centroid", hull.centroid(), Vec3::ZERO, 1e-6);
}

/// Its section at height y is a ring between two n-gons, of the area n/2 sin(2π/n) (r₂² − r₁²), and r₂² − r₁² = 2 R (r₂ − r₁), which
/// summed over y gives 2 R times the area of the m-gon, m/2 sin(2π/m) r².
fn polygonal_torus(major: f64, minor: f64, n: f64, m: f64) -> f32 {
    let part = |k: f64| 0.5 * k * (std::f64::consts::TAU / k).sin();
    (part(m) * minor * minor * 2.0 * major * part(n)) as f32
}

/// Water cannot enter a sealed cavity, so it displaces as if solid, whichever way round the shells are wound.
#[test]
fn a_sealed_cavity_displaces_as_if_solid() {
    for inner in [sized(cube(), 0.5), inside_out(sized(cube(), 0.5))] {
        holds(both(cube(), inner.clone()), 1.0);
        holds(both(inner.clone(), cube()), 1.0);
        holds(both(inside_out(cube()), inner.clone()), 1.0);
        let (points, mut triangles) = both(cube(), inner);
        triangles[3].swap(0, 1);
        triangles[15].swap(0, 1);
        let hull = holds((points, triangles), 1.0);
        assert_eq!(hull.triangles().len(), 12);
    }
}

/// A hollow sphere floats with the draft of a solid one of the same mass: same volume, same moments, same load.
#[test]
fn a_hollow_sphere_is_the_hull_of_its_outer_shell() {
    let sphere = |radius: f32| {
        let ball = Hull::ball(radius).unwrap();
        (ball.points().to_vec(), ball.triangles().to_vec())
    };
    let solid = holds(sphere(1.0), 4.0 / 3.0 * std::f32::consts::PI);
    for inner in [sphere(0.95), inside_out(sphere(0.95))] {
        let hollow = holds(both(sphere(1.0), inner), solid.volume());
        near_point("centroid", hollow.centroid(), solid.centroid(), 1e-6);
        near_matrix("moments", hollow.covariance(), solid.covariance(), 1e-5);
    }
    holds(both(sized(cube(), 2.0), inside_out(sphere(0.9))), 8.0);
}

/// However often shells are nested, only the outermost counts, and beside each other all of them do.
#[test]
fn only_outermost_shells_count() {
    let nested = both(both(inside_out(sized(cube(), 0.25)), cube()), sized(cube(), 0.5));
    holds(nested.clone(), 1.0);
    holds(inside_out(nested.clone()), 1.0);
    let beside = |x: f32| {
        let (points, triangles) = nested.clone();
        (points.iter().map(|point| *point + Vec3::X * x).collect::<Vec<_>>(), triangles)
    };
    let hull = holds(both(beside(-2.0), beside(2.0)), 2.0);
    near_point("centroid", hull.centroid(), Vec3::ZERO, 1e-6);
    // One that lies in the hole of a torus is not within it, though it is within its box.
    let ring = torus(2.0, 0.5, 48, 24);
    let volume = Hull::new(&ring.0, &ring.1).unwrap().volume();
    holds(both(ring, sized(cube(), 0.9)), volume + 0.729);
}

/// Shells that touch from within are within, and the same shell made of other triangles counts once.
#[test]
fn touching_from_within_is_within() {
    let (points, triangles) = sized(cube(), 0.5);
    let on_the_floor = (points.iter().map(|point| *point - Vec3::Y * 0.25).collect::<Vec<_>>(), triangles);
    holds(both(cube(), on_the_floor.clone()), 1.0);
    holds(both(cube(), inside_out(on_the_floor)), 1.0);
    let finer = Hull::cuboid(Vec3::splat(0.5)).unwrap().refined(0.4, 400);
    holds(both(cube(), (finer.points().to_vec(), finer.triangles().to_vec())), 1.0);
}

#[test]
fn parts_of_one_mesh_may_touch() {
    let aside = |x: f32, y: f32| {
        let (points, triangles) = cube();
        (points.iter().map(|point| *point + Vec3::new(x, y, 0.0)).collect::<Vec<_>>(), triangles)
    };
    holds(both(cube(), aside(1.0, 0.0)), 2.0);
    holds(both(cube(), aside(1.0, 1.0)), 2.0);
    holds(both(cube(), inside_out(aside(1.0, 1.0))), 2.0);
    holds(both(cube(), cube()), 1.0);
    holds(both(cube(), inside_out(cube())), 1.0);
}

#[test]
fn an_open_mesh_names_an_edge() {
    let (points, mut triangles) = cube();
    triangles.pop();
    let error = Hull::new(&points, &triangles).unwrap_err();
    let HullError::Open { edges, from, to } = error else { panic!("{error}") };
    assert_eq!(edges, 3);
    assert!(points.contains(&from) && points.contains(&to) && from != to);
}

#[test]
fn thin_triangles_do_not_open_a_surface() {
    let (mut points, mut triangles) = cube();
    let [a, b, c] = triangles[0];
    points.push(points[a as usize].midpoint(points[b as usize]));
    triangles[0] = [a, 8, c];
    triangles.extend([[8, b, c], [a, b, 8], [a, a, b], [c, c, c]]);
    holds((points, triangles), 1.0);
}

#[test]
fn what_is_no_mesh_is_refused() {
    let (points, triangles) = cube();
    assert_eq!(Hull::new(&points, &[]), Err(HullError::NoTriangles));
    assert_eq!(Hull::new(&[], &[[0, 1, 2]]), Err(HullError::Index { triangle: 0, point: 0, points: 0 }));
    let beyond = [triangles.as_slice(), &[[0, 1, 8]]].concat();
    assert_eq!(Hull::new(&points, &beyond), Err(HullError::Index { triangle: 12, point: 8, points: 8 }));
    for bad in [f32::NAN, f32::INFINITY] {
        let mut points = points.clone();
        points[5].y = bad;
        assert_eq!(Hull::new(&points, &triangles), Err(HullError::NotFinite(5)));
    }
    let flat: Vec<_> = points.iter().map(|point| *point * Vec3::new(1.0, 1.0, 0.0)).collect();
    assert!(matches!(Hull::new(&flat, &triangles), Err(HullError::Flat | HullError::Open { .. })));
    assert_eq!(Hull::new(&[Vec3::ONE; 8], &triangles), Err(HullError::Flat));
    let huge: Vec<_> = points.iter().map(|point| *point * f32::MAX).collect();
    assert_eq!(Hull::new(&huge, &triangles), Err(HullError::Flat));
}

proptest! {
    #[test]
    fn nothing_panics(
        points in prop::collection::vec(prop::array::uniform3(prop_oneof![-2.0_f32..2.0, any::<f32>(), Just(0.0)]), 0..9),
        triangles in prop::collection::vec(prop::array::uniform3(0_u32..9), 0..20),
    ) {
        let points: Vec<_> = points.into_iter().map(Vec3::from_array).collect();
        if let Ok(hull) = Hull::new(&points, &triangles) {
            prop_assert!(hull.volume() > 0.0 && hull.centroid().is_finite() && is_closed(&hull));
        }
    }
}
