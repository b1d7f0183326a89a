//! Sections, covers and volumes of bodies at the waterline, against solids in closed form.

use std::f32::consts::{PI, TAU};

use approx::assert_relative_eq;
use freshet_hydro::silhouette::Section;
use glam::{EulerRot, Quat, UVec2, Vec2, Vec3, uvec2, vec2, vec3};
use proptest::prelude::*;

/// A closed mesh.
#[derive(Clone, Default)]
struct Body {
    vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Body {
    /// The surface `point(i, j)` over rings × sides, closed in both directions.
    fn rings(rings: u32, sides: u32, point: impl Fn(f32, f32) -> Vec3) -> Self {
        let vertices = (0..rings * sides)
            .map(|i| point((i / sides) as f32 / rings as f32 * TAU, (i % sides) as f32 / sides as f32 * TAU))
            .collect();
        let index = |ring: u32, side: u32| ring % rings * sides + side % sides;
        let triangles = (0..rings * sides)
            .flat_map(|i| {
                let (r, s) = (i / sides, i % sides);
                let [a, b, c, d] = [index(r, s), index(r + 1, s), index(r + 1, s + 1), index(r, s + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect();
        Self { vertices, triangles }
    }

    fn torus(major: f32, minor: f32) -> Self {
        Self::rings(128, 64, |u, v| {
            let distance = major + minor * v.cos();
            vec3(distance * u.cos(), minor * v.sin(), -distance * u.sin())
        })
        .outward()
    }

    fn sphere(radius: f32) -> Self {
        let (rings, sides) = (96, 128);
        let mut body = Self::default();
        for ring in 0..=rings {
            let (sin, cos) = (ring as f32 / rings as f32 * PI).sin_cos();
            for side in 0..sides {
                let angle = side as f32 / sides as f32 * TAU;
                body.vertices.push(radius * vec3(sin * angle.cos(), cos, -sin * angle.sin()));
            }
        }
        for ring in 0..rings {
            for side in 0..sides {
                let index = |ring: u32, side: u32| ring * sides + side % sides;
                let [a, b] = [index(ring, side), index(ring + 1, side)];
                let [c, d] = [index(ring + 1, side + 1), index(ring, side + 1)];
                body.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        body.outward()
    }

    /// A prism along y between −`half` and `half` over a counter-clockwise (x right, z up) polygon that its first corner
    /// sees all of.
    fn prism(corners: &[Vec2], half: f32) -> Self {
        let n = corners.len() as u32;
        let ring = |y: f32| corners.iter().map(move |c| vec3(c.x, y, c.y));
        let mut triangles = Vec::new();
        for i in 0..n {
            let j = (i + 1) % n;
            triangles.extend([[i, j, n + j], [i, n + j, n + i]]);
        }
        for i in 1..n - 1 {
            triangles.extend([[0, i + 1, i], [n, n + i, n + i + 1]]);
        }
        Self { vertices: ring(-half).chain(ring(half)).collect(), triangles }.outward()
    }

    fn cuboid(half: Vec3) -> Self {
        let corners = [vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, 1.0)];
        Self::prism(&corners.map(|c| c * vec2(half.x, half.z)), half.y)
    }

    fn signed_volume(&self) -> f32 {
        let corner = |i: u32| self.vertices[i as usize];
        self.triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2]))) / 6.0).sum()
    }

    /// Turns all triangles over if they look inwards.
    fn outward(mut self) -> Self {
        if self.signed_volume() < 0.0 {
            self.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        self
    }

    fn posed(mut self, rotation: Quat, at: Vec3) -> Self {
        self.vertices.iter_mut().for_each(|v| *v = rotation * *v + at);
        self
    }

    fn section(&self) -> Section {
        let mut section = Section::default();
        section.add(&self.vertices, self.triangles.iter().copied());
        section
    }
}

fn area(section: &Section) -> f32 {
    section.area_and_centroid().map_or(0.0, |(area, _)| area)
}

const CELL: f32 = 0.1;

/// A raster of 8 m × 8 m around the origin.
fn cover(section: &Section) -> Vec<(UVec2, f32)> {
    section.cover(Vec2::splat(-4.0), CELL, UVec2::splat(80)).cells().collect()
}

fn covered_area(section: &Section) -> f32 {
    cover(section).iter().map(|(_, share)| share * CELL * CELL).sum()
}

fn share_at(section: &Section, place: Vec2) -> f32 {
    let cell = ((place + 4.0) / CELL).as_uvec2();
    cover(section).iter().find(|(at, _)| *at == cell).map_or(0.0, |(_, share)| *share)
}

#[test]
fn sections_and_volumes_of_spheres() {
    for depth in [0.1, 0.5, 1.0, 1.5, 1.9] {
        let section = Body::sphere(1.0).posed(Quat::IDENTITY, vec3(0.3, 1.0 - depth, -0.2)).section();
        // The cap of depth d: V = π d² (3 R − d) / 3.
        let exact = PI * depth * (2.0 - depth);
        assert_relative_eq!(area(&section), exact, max_relative = 4e-3);
        assert_relative_eq!(covered_area(&section), area(&section), max_relative = 1e-4);
        assert_relative_eq!(section.volume(), PI * depth * depth * (3.0 - depth) / 3.0, max_relative = 6e-3);
        assert_relative_eq!(section.depth(), depth, max_relative = 1e-4);
        let (_, centroid) = section.area_and_centroid().unwrap();
        assert!(centroid.distance(vec2(0.3, -0.2)) < 1e-3, "{centroid}");
    }
}

#[test]
fn a_box_is_exact_cell_by_cell() {
    let section = Body::cuboid(vec3(0.5, 0.3, 0.25)).posed(Quat::IDENTITY, vec3(0.03, 0.1, 0.02)).section();
    assert_relative_eq!(area(&section), 0.5, max_relative = 1e-5);
    assert_relative_eq!(section.volume(), 0.5 * 0.2, max_relative = 1e-5);
    for (cell, share) in cover(&section) {
        let min = cell.as_vec2() * CELL - 4.0;
        let inside = (min + CELL).min(vec2(0.53, 0.27)) - min.max(vec2(-0.47, -0.23));
        let exact = inside.max(Vec2::ZERO).element_product() / (CELL * CELL);
        assert!((share - exact).abs() < 1e-4, "{cell}: {share}, exact {exact}");
    }
    assert_eq!(cover(&section).len(), 11 * 6);
}

#[test]
fn a_tilted_box_has_a_stretched_section() {
    // A long box turned by the angle a about z: its section in the middle is 1/cos a wider.
    for angle in [0.2_f32, 0.6, 1.0] {
        let section = Body::cuboid(vec3(0.5, 6.0, 0.4)).posed(Quat::from_rotation_z(angle), Vec3::ZERO).section();
        assert_relative_eq!(area(&section), 0.8 / angle.cos(), max_relative = 1e-4);
        assert_relative_eq!(section.volume(), 0.5 * 12.0 * 0.8, max_relative = 1e-4);
        assert_relative_eq!(covered_area(&section), area(&section), max_relative = 1e-4);
    }
}

#[test]
fn holes_stay_open() {
    // Lying half in the water, an annulus; standing on edge, two discs.
    let lying = Body::torus(1.5, 0.5).section();
    assert_relative_eq!(area(&lying), PI * (4.0 - 1.0), max_relative = 4e-3);
    assert_relative_eq!(lying.volume(), PI * PI * 1.5 * 0.25, max_relative = 6e-3);
    assert_relative_eq!(covered_area(&lying), area(&lying), max_relative = 1e-4);
    assert_eq!(share_at(&lying, Vec2::ZERO), 0.0);
    assert_relative_eq!(share_at(&lying, vec2(1.55, 0.05)), 1.0, epsilon = 1e-4);

    let standing = Body::torus(1.5, 0.5).posed(Quat::from_rotation_x(PI / 2.0), Vec3::ZERO).section();
    assert_relative_eq!(area(&standing), 2.0 * PI * 0.25, max_relative = 4e-3);
    assert_eq!(share_at(&standing, Vec2::ZERO), 0.0);
}

#[test]
fn concave_outlines_and_separate_shells_are_kept() {
    let l = [vec2(0.0, 0.0), vec2(2.0, 0.0), vec2(2.0, 1.0), vec2(1.0, 1.0), vec2(1.0, 2.0), vec2(0.0, 2.0)];
    let mut body = Body::prism(&l, 0.5);
    let section = body.section();
    assert_relative_eq!(covered_area(&section), 3.0, max_relative = 1e-4);
    assert_eq!(share_at(&section, vec2(1.55, 1.55)), 0.0);

    let other = Body::cuboid(Vec3::splat(0.5)).posed(Quat::from_rotation_y(0.4), vec3(-2.0, 0.1, -2.0));
    let offset = body.vertices.len() as u32;
    body.vertices.extend(other.vertices);
    body.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + offset)));
    let both = body.section();
    assert_relative_eq!(covered_area(&both), 4.0, max_relative = 1e-4);
    assert_relative_eq!(both.volume(), 3.0 * 0.5 + 0.4, max_relative = 1e-4);
}

#[test]
fn hidden_and_touching_bodies_have_no_section() {
    let heights = [1.0, 0.5, -0.5 - 1e-6, -3.0];
    for (height, volume) in heights.into_iter().zip([0.0, 0.0, 1.0, 1.0]) {
        let section = Body::cuboid(Vec3::splat(0.5)).posed(Quat::IDENTITY, Vec3::Y * height).section();
        assert!(section.outline().is_empty() && cover(&section).is_empty(), "at {height}");
        assert_relative_eq!(section.volume(), volume, epsilon = 1e-5);
    }
    // With its top in the surface a box still shows: what lies at zero counts as above.
    let flush = Body::cuboid(Vec3::splat(0.5)).posed(Quat::IDENTITY, Vec3::Y * -0.5).section();
    assert_relative_eq!(covered_area(&flush), 1.0, max_relative = 1e-4);
    assert_relative_eq!(flush.volume(), 1.0, max_relative = 1e-5);
}

#[test]
fn a_raster_that_ends_within_the_body_takes_its_part() {
    let section = Body::sphere(1.0).section();
    let whole = cover(&section);
    let (first, size) = (uvec2(35, 38), uvec2(9, 30));
    let part: Vec<_> = section.cover(Vec2::splat(-4.0) + first.as_vec2() * CELL, CELL, size).cells().collect();
    let expected = whole.iter().filter(|(at, _)| at.cmpge(first).all() && at.cmplt(first + size).all());
    assert_eq!(part.len(), expected.clone().count());
    for ((cell, share), (at, exact)) in part.into_iter().zip(expected) {
        assert_eq!(cell + first, *at);
        assert!((share - exact).abs() < 1e-4, "{at}: {share}, {exact}");
    }
    assert_eq!(section.cover(vec2(1.5, 0.0), CELL, uvec2(20, 20)).cells().count(), 0);
    assert_eq!(section.cover(Vec2::splat(-4.0), CELL, UVec2::ZERO).cells().count(), 0);
}

#[test]
fn broken_meshes_do_not_smear() {
    let mut body = Body::cuboid(Vec3::splat(0.5));
    let sound = covered_area(&body.section());
    // Degenerate triangles, and indices of vertices that do not exist, change nothing.
    body.triangles.extend([[0, 0, 4], [0, 4, 4], [1, 2, 99], [u32::MAX, 0, 1]]);
    assert_eq!(covered_area(&body.section()), sound);
    assert_relative_eq!(body.section().volume(), 0.5, max_relative = 1e-5);

    // Without a wall across x the rows do not close: none is drawn.
    let mut open = Body::cuboid(Vec3::splat(0.5));
    open.triangles.retain(|t| !t.iter().all(|i| open.vertices[*i as usize].x > 0.0));
    assert_eq!(covered_area(&open.section()), 0.0);

    // A vertex that is not a number opens the mesh; nothing outside the body's rectangle may be covered.
    for i in 0..8 {
        let mut body = Body::cuboid(Vec3::splat(0.5)).posed(Quat::from_rotation_y(0.3), Vec3::ZERO);
        body.vertices[i].y = f32::NAN;
        let section = body.section();
        assert!(section.volume().is_finite());
        for (cell, share) in cover(&section) {
            let place = (cell.as_vec2() + 0.5) * CELL - 4.0;
            assert!(place.abs().max_element() < 0.75 && share < 1.001, "{place}: {share}");
        }
    }
    let mut vast = Body::cuboid(Vec3::splat(0.5));
    vast.vertices.iter_mut().for_each(|v| *v *= 1e30);
    assert!(cover(&vast.section()).iter().all(|(_, share)| (share - 1.0).abs() < 1e-3));
}

proptest! {
    /// In every attitude: cover sums to the section, no cell above one, and the volume falls as the body rises by as much
    /// as the section says (dV/dh = −A).
    #[test]
    fn cover_area_and_volume_agree(x in -3.0_f32..3.0, y in -1.5_f32..1.5, z in -3.0_f32..3.0,
                                   height in -0.6_f32..0.6, east in -1.0_f32..1.0) {
        let rotation = Quat::from_euler(EulerRot::XYZ, x, y, z);
        for body in [Body::cuboid(vec3(0.8, 0.5, 1.1)), Body::torus(1.0, 0.4)] {
            let at = |height: f32| body.clone().posed(rotation, vec3(east, height, 0.5)).section();
            let section = at(height);
            let area = area(&section);
            let sum = covered_area(&section);
            prop_assert!((sum - area).abs() < 1e-4 * area.max(1.0), "covered {sum}, section {area}");
            prop_assert!(cover(&section).iter().all(|(_, share)| (0.0..1.0001).contains(share)));
            let h = 0.01;
            let slope = (at(height - h).volume() - at(height + h).volume()) / (2.0 * h);
            // The mean of the sections in between: where the body only just dips in they differ.
            let areas = [height - h, height, height + h].map(|height| self::area(&at(height)));
            let (least, most) = (areas.iter().copied().fold(f32::MAX, f32::min), areas.iter().copied().fold(0.0, f32::max));
            let grace = 0.03 * area.max(0.5);
            prop_assert!((least - grace..most + grace).contains(&slope), "dV/dh {slope}, sections {areas:?}");
        }
    }
}
