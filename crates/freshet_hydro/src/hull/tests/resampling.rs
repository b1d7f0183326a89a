//! More or fewer triangles, and the same solid.

use super::*;

#[track_caller]
fn same_solid(a: &Hull, b: &Hull) {
    near("volume", (a.volume() / b.volume()).into(), 1.0, 1e-5);
    near_point("centroid", a.centroid(), b.centroid(), 1e-5 * b.length());
    assert!(is_closed(a));
    let measured = Hull::measured(a.points.clone(), a.triangles.clone(), a.shared).unwrap();
    near("measured volume", (measured.volume() / b.volume()).into(), 1.0, 1e-5);
    near_matrix("measured moments", measured.covariance(), a.covariance(), 1e-5 * b.length().powi(2));
}

fn fine_torus() -> Hull {
    let (points, triangles) = torus(2.0, 0.7, 100, 50);
    Hull::new(&points, &triangles).unwrap()
}

#[test]
fn a_simplified_torus_is_a_torus() {
    let torus = fine_torus();
    assert_eq!(torus.triangles().len(), 10_000);
    for most in [2000, 400, 150] {
        let simplified = torus.clone().simplified(most);
        assert!(simplified.triangles().len() <= most, "{} for {most}", simplified.triangles().len());
        same_solid(&simplified, &torus);
        near("area", (simplified.area() / torus.area()).into(), 1.0, 20.0 / most as f64);
        let points = simplified.points().len() as i64;
        assert_eq!(points - simplified.triangles().len() as i64 / 2, 0, "points − edges + triangles of a torus");
    }
}

#[test]
fn a_box_of_many_triangles_is_simplified_to_twelve() {
    let cuboid = Hull::cuboid(Vec3::new(1.0, 0.5, 2.0)).unwrap();
    let simplified = cuboid.clone().refined(0.3, 2000).simplified(12);
    assert_eq!(simplified.triangles().len(), 12);
    same_solid(&simplified, &cuboid);
    near_point("corner", simplified.bounds()[1], cuboid.bounds()[1], 1e-4);
}

#[test]
fn nothing_is_simplified_away() {
    let ball = Hull::ball(1.0).unwrap();
    let least = ball.clone().simplified(0);
    assert_eq!(least.triangles().len(), 4);
    same_solid(&least, &ball);
    assert_eq!(ball.clone().simplified(320), ball);
}

#[test]
fn a_union_is_not_simplified() {
    let hull = Hull::union(vec![unit_cube_at(0.0, 0.0, 0.0), unit_cube_at(0.5, 0.1, 0.0)]).unwrap().hull;
    assert_eq!(hull.clone().simplified(4), hull);
}

#[test]
fn refined_edges_are_no_longer_than_asked() {
    let hull = Hull::union(vec![unit_cube_at(0.0, 0.0, 0.0), unit_cube_at(0.5, 0.1, 0.0)]).unwrap().hull;
    let refined = hull.clone().refined(0.25, 10_000);
    for &triangle in refined.triangles() {
        let [a, b, c] = triangle.map(|i| refined.points()[i as usize]);
        assert!(a.distance(b).max(b.distance(c)).max(c.distance(a)) <= 0.25);
    }
    same_solid(&refined, &hull);
    assert_eq!(refined.volume(), hull.volume());
}

#[test]
fn refining_stops_at_the_most_triangles() {
    let ball = Hull::ball(1.0).unwrap();
    for longest_edge in [0.01, 0.0, -1.0] {
        let refined = ball.clone().refined(longest_edge, 1000);
        assert_eq!(refined.triangles().len(), 1000);
        same_solid(&refined, &ball);
    }
    assert_eq!(ball.clone().refined(f32::NAN, 1000), ball);
    assert_eq!(ball.clone().refined(10.0, 1000), ball);
    assert_eq!(ball.clone().refined(0.01, 0), ball);
}
