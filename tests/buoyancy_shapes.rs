//! What floating bodies are made of: shapes, colliders of children, meshes, given masses.
use crate::buoyancy::{LEVEL, assert_near, body, read, run, solver_body, sphere_draft, still_water};
use bevy::prelude::*;
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use core::f32::consts::PI;
use freshet_hydro::waves::WATER_DENSITY;

/// Bodies of many shapes of 1 m³ and 500 kg/m³ displace their mass.
#[test]
fn all_closed_shapes_float() {
    let corners: Vec<Vec3> =
        (0..8).map(|i| Vec3::from([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 0.5 } else { -0.5 }))).collect();
    let faces = [
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    let half = || Collider::cuboid(0.25, 0.5, 0.5);
    let at = |x: f32| (Vec3::X * x, Quat::IDENTITY);
    let colliders = [
        Collider::convex_hull(&corners).unwrap(),
        Collider::trimesh(corners.clone(), faces.to_vec()).unwrap(),
        Collider::compound(vec![(at(-0.25).0, at(0.0).1, half()), (at(0.25).0, at(0.0).1, half())]),
        Collider::cylinder(0.5, (1.0 / PI).sqrt()),
        Collider::capsule_y(0.4, (1.0 / PI).sqrt() * 0.75),
    ];
    for (index, collider) in colliders.into_iter().enumerate() {
        let (mut app, _) = still_water();
        let entity = app.world_mut().spawn(body(collider, Floating::default(), 0.0)).id();
        run(&mut app, 20.0);
        let buoyancy = read::<Buoyancy>(&app, entity);
        println!("shape {index}: {buoyancy:?}");
        assert_near(buoyancy.submerged_volume, buoyancy.volume * 500.0 / WATER_DENSITY, 0.02, "submerged volume");
        if index < 4 {
            assert_near(buoyancy.volume, 1.0, 0.01, "volume");
        }
    }
}

/// A body made of its children's colliders, one of which is taken away under way.
#[test]
fn childrens_colliders_count() {
    let (mut app, _) = still_water();
    let raft = (RigidBody::Dynamic, Floating::default(), Transform::from_xyz(0.0, LEVEL, 0.0));
    let raft = app.world_mut().spawn(raft).id();
    let [_, lost] = [-1.0, 1.0].map(|x| {
        let log = (Collider::cuboid(0.5, 0.5, 2.0), Transform::from_xyz(x, 0.0, 0.0), ChildOf(raft));
        app.world_mut().spawn(log).id()
    });
    run(&mut app, 5.0);
    assert_near(read::<Buoyancy>(&app, raft).volume, 8.0, 1e-3, "volume");
    app.world_mut().despawn(lost);
    run(&mut app, 10.0);
    assert_near(read::<Buoyancy>(&app, raft).volume, 4.0, 1e-3, "volume of one log");
    assert_near(solver_body(&mut app, raft, |body| body.mass()), 2000.0, 1e-3, "mass of one log");
}

/// A body without a collider floats by its mesh.
#[test]
fn a_mesh_is_a_hull() {
    let (mut app, _) = still_water();
    let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(Sphere::new(0.5).mesh().ico(5).unwrap());
    let ball = (RigidBody::Dynamic, Mesh3d(mesh), Floating::with_density(250.0), Transform::from_xyz(0.0, LEVEL, 0.0));
    let ball = app.world_mut().spawn(ball).id();
    run(&mut app, 20.0);
    let draft = LEVEL - (read::<Transform>(&app, ball).translation.y - 0.5);
    assert_near(draft, sphere_draft(0.5, 250.0 / WATER_DENSITY), 0.05, "draft");
}

/// A hollow ball of two shells, both inside out, floats as a ball of its outer one; a plane has no hull.
#[test]
fn odd_meshes_are_hulls_if_they_close() {
    let (mut app, _) = still_water();
    let shell = Sphere::new(0.5).mesh().ico(5).unwrap();
    let mut hollow = shell.clone().scaled_by(Vec3::splat(0.9));
    hollow.merge(&shell).unwrap();
    let hollow = hollow.with_inverted_winding().unwrap();
    let [hollow, whole, plane] = [hollow, shell, Plane3d::default().into()].map(|mesh| {
        let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(mesh);
        let at = Transform::from_xyz(0.0, LEVEL, 0.0);
        app.world_mut().spawn((RigidBody::Dynamic, Mesh3d(mesh), Floating::with_density(250.0), at)).id()
    });
    run(&mut app, 20.0);
    let [buoyancy, exact] = [hollow, whole].map(|entity| read::<Buoyancy>(&app, entity));
    assert_near(buoyancy.volume, exact.volume, 1e-4, "volume");
    assert_near(buoyancy.draft, exact.draft, 1e-3, "draft");
    assert_eq!(read::<Buoyancy>(&app, plane).volume, 0.0);
    assert!(read::<Transform>(&app, plane).translation.is_finite());
}

/// A body that loses its only collider falls, and floats again when it has one.
#[test]
fn a_body_may_lose_its_collider() {
    let (mut app, _) = still_water();
    let ball = app.world_mut().spawn(body(Collider::ball(0.5), Floating::default(), 0.0)).id();
    run(&mut app, 2.0);
    app.world_mut().entity_mut(ball).remove::<Collider>();
    run(&mut app, 1.0);
    assert_eq!(read::<Buoyancy>(&app, ball).volume, 0.0);
    let fallen = read::<Transform>(&app, ball).translation;
    assert!(fallen.is_finite() && fallen.y < LEVEL - 3.0, "{fallen}");
    app.world_mut().entity_mut(ball).insert(Collider::ball(0.5));
    run(&mut app, 40.0);
    let draft = LEVEL - read::<Transform>(&app, ball).translation.y + 0.5;
    assert_near(draft, sphere_draft(0.5, 500.0 / WATER_DENSITY), 0.01, "draft");
}

#[test]
fn mass_may_be_given_or_left_to_rapier() {
    let (mut app, _) = still_water();
    let given = app.world_mut().spawn(body(Collider::cuboid(0.5, 0.5, 0.5), Floating::with_mass(200.0), 0.0)).id();
    let own = body(Collider::cuboid(0.5, 0.5, 0.5), Floating::with_rapier_mass(), 0.0);
    let own = app.world_mut().spawn((own, ColliderMassProperties::Mass(300.0), ReadMassProperties::default())).id();
    app.world_mut().get_mut::<Transform>(own).unwrap().translation.x = 20.0;
    run(&mut app, 20.0);
    assert_near(solver_body(&mut app, given, |body| body.mass()), 200.0, 1e-4, "mass");
    assert_near(read::<Buoyancy>(&app, given).submerged_volume, 200.0 / WATER_DENSITY, 0.01, "submerged volume");
    assert_near(solver_body(&mut app, own, |body| body.mass()), 300.0, 1e-4, "mass");
    assert_near(read::<Buoyancy>(&app, own).submerged_volume, 300.0 / WATER_DENSITY, 0.01, "submerged volume");
}
