//! Centre of buoyancy, waterplane, metacentre and waterline of shapes for which naval architecture has formulas.

use super::*;
use crate::load::{Pose, Surface};
use glam::{Quat, Vec2};
use std::f32::consts::{FRAC_PI_2, PI};

/// Height of the water, m: not the origin's, so that a forgotten one shows.
const LEVEL: f32 = 3.0;

fn still(_: Vec2) -> Option<Surface> {
    Some(Surface { height: LEVEL, ..Surface::default() })
}

/// A pose far from the origin, the hull's own origin `depth` m under water, heeled and then turned.
fn pose(depth: f32, heel: f32) -> Pose {
    let rotation = Quat::from_rotation_y(0.7) * Quat::from_rotation_x(heel);
    Pose { position: Vec3::new(120.0, LEVEL - depth, -50.0), rotation }
}

fn perimeter(hull: &Hull, pose: &Pose) -> f64 {
    hull.waterline(pose, still).iter().map(|[from, to]| f64::from(from.distance(*to))).sum()
}

/// Length, height and beam of the box, m, and its draft.
const BOX: Vec3 = Vec3::new(4.0, 1.0, 1.6);
const DRAFT: f32 = 0.3;

fn cuboid() -> Hull {
    Hull::cuboid(0.5 * BOX).unwrap()
}

#[test]
fn a_box_has_its_metacentre_at_b_squared_over_12_t() {
    let upright = pose(DRAFT - 0.5 * BOX.y, 0.0);
    let flotation = cuboid().flotation(&upright, still).unwrap();
    near("volume", flotation.volume.into(), (BOX.x * DRAFT * BOX.z).into(), 1e-5);
    let centre = upright.position.with_y(LEVEL - 0.5 * DRAFT);
    near_point("centre of buoyancy", flotation.centre_of_buoyancy, centre, 1e-4);
    near("area", flotation.waterplane.area.into(), (BOX.x * BOX.z).into(), 1e-4);
    let [least, most] = flotation.waterplane.principal_moments();
    near("moment about the length", least.into(), (BOX.x * BOX.z.powi(3) / 12.0).into(), 1e-4);
    near("moment about the beam", most.into(), (BOX.z * BOX.x.powi(3) / 12.0).into(), 1e-4);
    let radius = BOX.z * BOX.z / (12.0 * DRAFT);
    near("metacentric radius", flotation.metacentric_radius().into(), radius.into(), 1e-4);
    let keel_to_centre = 0.4;
    let height = 0.5 * DRAFT + radius - keel_to_centre;
    let centre_of_mass = centre.with_y(LEVEL - DRAFT + keel_to_centre);
    near("metacentric height", flotation.metacentric_height(centre_of_mass).into(), height.into(), 1e-4);
}

#[test]
fn a_box_is_cut_along_its_four_sides() {
    let upright = pose(DRAFT - 0.5 * BOX.y, 0.0);
    near("perimeter", perimeter(&cuboid(), &upright), (2.0 * (BOX.x + BOX.z)).into(), 1e-4);
    for point in cuboid().waterline(&upright, still).as_flattened() {
        near("height", point.y.into(), LEVEL.into(), 1e-5);
        let own = upright.rotation.inverse() * (*point - upright.position);
        let outwards = (own.x.abs() - 0.5 * BOX.x).max(own.z.abs() - 0.5 * BOX.z);
        near("distance from the sides", outwards.into(), 0.0, 1e-4);
    }
}

/// The wall-sided formulas: heeled by φ about the middle of its waterline, B moves by BM tan φ to the side and by ½ BM tan² φ upwards,
/// seen from the hull, and the waterplane is wider by 1/cos φ.
#[test]
fn a_heeled_box_follows_the_wall_sided_formulas() {
    let heel = 0.25_f32;
    let to_waterline = DRAFT - 0.5 * BOX.y;
    let heeled = pose(to_waterline * heel.cos(), heel);
    let flotation = cuboid().flotation(&heeled, still).unwrap();
    let radius = BOX.z * BOX.z / (12.0 * DRAFT);
    near("volume", flotation.volume.into(), (BOX.x * DRAFT * BOX.z).into(), 1e-4);
    let own = heeled.rotation.inverse() * (flotation.centre_of_buoyancy - heeled.position);
    let rise = 0.5 * DRAFT - 0.5 * BOX.y + 0.5 * radius * heel.tan().powi(2);
    near_point("centre of buoyancy", own, Vec3::new(0.0, rise, radius * heel.tan()), 2e-4);
    near("radius", flotation.metacentric_radius().into(), (radius / heel.cos().powi(3)).into(), 1e-3);
    near("perimeter", perimeter(&cuboid(), &heeled), (2.0 * (BOX.x + BOX.z / heel.cos())).into(), 1e-3);
}

/// Upright BM = r²/(4 T). The line of the tessellated circle is a little longer than that of its area.
#[test]
fn an_upright_cylinder_has_its_metacentre_at_r_squared_over_4_t() {
    let (half_height, radius, draft) = (0.5, 0.8, 0.45);
    let hull = Hull::cylinder(half_height, radius).unwrap();
    let upright = pose(draft - half_height, 0.0);
    let flotation = hull.flotation(&upright, still).unwrap();
    near("radius", flotation.metacentric_radius().into(), (radius * radius / (4.0 * draft)).into(), 1e-3);
    near("perimeter", perimeter(&hull, &upright) / f64::from(2.0 * PI * radius), 1.0, 0.01);
}

/// However deep a lying cylinder floats, the pressure on its circle passes through the axis: that is its metacentre.
#[test]
fn a_lying_cylinder_has_its_metacentre_on_its_axis() {
    let hull = Hull::cylinder(2.0, 0.5).unwrap();
    for depth in [-0.3, 0.0, 0.2] {
        let lying = pose(depth, FRAC_PI_2);
        let metacentre = hull.flotation(&lying, still).unwrap().metacentre();
        near_point("metacentre", metacentre, lying.position, 5e-3);
    }
}

/// Two boxes apart: Steiner's d² A comes on top of their own moments.
#[test]
fn a_catamaran_has_the_moments_of_both_hulls() {
    let float = |z: f32| Hull::cuboid(0.5 * BOX).unwrap().placed(Quat::IDENTITY, Vec3::Z * z).unwrap();
    let hull = Hull::union(vec![float(-2.0), float(2.0)]).unwrap().hull;
    let upright = Pose { position: Vec3::Y * (LEVEL + 0.2), rotation: Quat::IDENTITY };
    let [xx, zz, xz] = hull.flotation(&upright, still).unwrap().waterplane.second_moments;
    let area = BOX.x * BOX.z;
    near("∫ x²", xx.into(), (2.0 * area * BOX.x * BOX.x / 12.0).into(), 1e-3);
    near("∫ z²", zz.into(), (2.0 * area * (BOX.z * BOX.z / 12.0 + 4.0)).into(), 1e-3);
    near("∫ x z", xz.into(), 0.0, 1e-3);
    near("perimeter", perimeter(&hull, &upright), (4.0 * (BOX.x + BOX.z)).into(), 1e-3);
}

#[test]
fn dry_and_submerged_hulls_have_no_waterline() {
    let (above, below) = (pose(-2.0, 0.1), pose(2.0, 0.1));
    assert_eq!(cuboid().flotation(&above, still), None);
    assert_eq!(cuboid().flotation(&below, |_| None), None);
    assert!(cuboid().waterline(&above, still).is_empty() && cuboid().waterline(&below, still).is_empty());
    let flotation = cuboid().flotation(&below, still).unwrap();
    near("volume", flotation.volume.into(), cuboid().volume().into(), 1e-5);
    assert_eq!(flotation.waterplane.area, 0.0);
    near_point("metacentre", flotation.metacentre(), below.position, 1e-3);
}
