//! Silhouettes, drafts and velocities of bodies.
use super::{CELL, FRAME, Pond, WINDOW, assert_near, at};
use crate::{
    body::{ResolvedWater, WaterBed, WaterInteraction, WaterWaves, Wave},
    simulation::{FieldWindow, SilhouetteCell},
};
use bevy::{mesh::skinning::SkinnedMesh, prelude::*};
use core::f32::consts::PI;

fn area(cells: &[SilhouetteCell]) -> f32 {
    cells.iter().map(|cell| cell.cover * CELL * CELL).sum()
}

fn volume(cells: &[SilhouetteCell]) -> f32 {
    cells.iter().map(|cell| cell.draft * CELL * CELL).sum()
}

fn place(cell: &SilhouetteCell) -> Vec2 {
    WINDOW.origin() + (cell.cell.as_vec2() + 0.5) * CELL
}

#[test]
fn silhouettes_are_the_sections_of_the_bodies() {
    let turned = Quat::from_euler(EulerRot::XYZ, 0.0, 0.4, 0.0);
    let ball = Sphere::new(0.8).mesh().uv(96, 64);
    let torus = Torus::new(0.5, 1.5).mesh().minor_resolution(48).major_resolution(96).build();
    let cap = |depth: f32| (PI * depth * (1.6 - depth), PI * depth * depth * (2.4 - depth) / 3.0);
    let bodies: [(Mesh, Transform, (f32, f32)); 4] = [
        (Cuboid::new(1.0, 0.8, 1.4).into(), at(1.03, 0.1, -0.4).with_rotation(turned), (1.4, 1.4 * 0.3)),
        (ball.clone(), at(-2.0, 0.3, 1.0), cap(0.5)),
        // A squeezed and mirrored sphere, an ellipsoid.
        (ball, at(0.0, 0.0, 0.0).with_scale(vec3(-2.0, 0.5, 1.0)), (2.0 * cap(0.8).0, cap(0.8).1)),
        (torus, at(0.5, 0.0, 0.2), (PI * (2.25 - 0.25), PI * PI * 0.25)),
    ];
    for (i, (mesh, pose, (section, displaced))) in bodies.into_iter().enumerate() {
        let mut pond = Pond::still();
        pond.body(mesh, pose);
        let cells = pond.cells();
        assert_near(area(&cells), section, 0.02, &format!("section of body {i}"));
        assert_near(volume(&cells), displaced, 0.02, &format!("displaced volume of body {i}"));
        let centroid = cells.iter().map(|c| place(c) * c.cover * CELL * CELL).sum::<Vec2>() / area(&cells);
        assert!(centroid.distance(pose.translation.xz()) < 0.02, "body {i} is at {centroid}");
        let middle = cells.iter().find(|c| place(c).distance(pose.translation.xz()) < 0.08);
        assert_eq!(middle.is_none(), i == 3, "only the torus has a hole");
    }
}

#[test]
fn parts_of_a_body_are_cut_together_and_bodies_share_cells() {
    let mut pond = Pond::still();
    let body = pond.body(Cuboid::new(1.0, 1.0, 1.0), at(0.0, 0.0, 0.0));
    let mesh = pond.app.world().get::<Mesh3d>(body).unwrap().clone();
    pond.app.world_mut().spawn((mesh.clone(), at(2.0, 0.25, 0.0), ChildOf(body)));
    let cells = pond.cells();
    assert_near(area(&cells), 2.0, 1e-3, "two boxes");
    assert_near(volume(&cells), 0.75, 1e-3, "two boxes displace");

    // A second body across the first: its area counts once, its volume too.
    let across = at(0.5, 0.0, 0.0);
    pond.body(Cuboid::new(1.0, 1.0, 1.0), across);
    let cells = pond.cells();
    assert_near(area(&cells), 2.5, 1e-3, "overlapping");
    assert_near(volume(&cells), 1.25, 1e-3, "overlapping boxes displace");
    assert!(cells.iter().all(|cell| cell.cover <= 1.0));
    let mut places: Vec<UVec2> = cells.iter().map(|cell| cell.cell).collect();
    places.dedup();
    assert_eq!(places.len(), cells.len(), "each cell once");
}

#[test]
fn hidden_bodies_and_those_beside_the_window_leave_nothing() {
    for pose in [at(0.0, 0.51, 0.0), at(0.0, -0.51, 0.0), at(0.0, 40.0, 0.0), at(8.0, 0.0, 0.0), at(0.0, 0.0, 90.0)] {
        let mut pond = Pond::still();
        pond.body(Cuboid::from_length(1.0), pose);
        assert_eq!(pond.cells(), [], "{}", pose.translation);
    }
    // On the rim of the window, half of it.
    let mut pond = Pond::still();
    pond.body(Cuboid::from_length(1.0), at(6.4, 0.0, 0.0));
    let cells = pond.cells();
    assert_near(area(&cells), 0.5, 1e-3, "half in the window");
    assert_near(volume(&cells), 0.25, 1e-3, "half in the window");
    assert!(cells.iter().all(|cell| cell.cell.cmplt(WINDOW.size).all()));
    // Without a window nothing is done.
    pond.app.world_mut().entity_mut(pond.water).insert(FieldWindow::default());
    assert_eq!(pond.cells(), []);
}

#[test]
fn dry_ground_is_not_covered() {
    let mut pond = Pond::still();
    let bed = WaterBed::from_fn(UVec2::splat(80), 0.5, |p| if p.x > 0.0 { 1.0 } else { -2.0 }).unwrap();
    let pose = pond.world(Transform::IDENTITY);
    pond.app.world_mut().spawn((bed, pose));
    pond.body(Cuboid::new(4.0, 1.0, 1.0), Transform::IDENTITY);
    assert!(pond.cells().iter().all(|cell| place(cell).x < 0.3));
    assert!(area(&pond.cells()) > 1.5);
}

#[test]
fn a_diving_ball_lets_go_without_a_jump() {
    let mut pond = Pond::still();
    let ball = pond.body(Sphere::new(0.5).mesh().uv(64, 48), Transform::IDENTITY);
    let mut last: Option<f32> = None;
    for i in 0..=100 {
        let pose = pond.world(at(0.0, -0.5 * i as f32 / 100.0 - 0.001, 0.0));
        pond.app.world_mut().entity_mut(ball).insert(pose);
        let now = volume(&pond.cells());
        // The whole ball is 0.52 m³; it dives from half to whole in 100 steps.
        assert!(last.is_none_or(|last| (now - last).abs() < 0.1), "step {i}: from {last:?} to {now} m³");
        last = Some(now);
    }
    assert!(last.unwrap() < 0.02, "{last:?} m³ are left");
}

#[test]
fn waves_shift_the_waterline() {
    let wave = Wave { direction: vec2(1.0, 0.3), wavelength: 20.0, steepness: 0.2, phase: 0.0 };
    let mut pond = Pond::new(WaterWaves { trains: vec![wave], fade_depth: 0.0, ..WaterWaves::still() });
    pond.stop_the_clock();
    pond.body(Cuboid::new(1.0, 4.0, 1.5), at(0.7, 0.0, 0.3));
    let cells = pond.cells();
    assert_near(area(&cells), 1.5, 0.01, "an upright pillar keeps its section");
    let water = pond.app.world().get::<ResolvedWater>(pond.water).unwrap();
    let n = 30;
    let heights = (0..n * n).map(|i| {
        let place = vec2(0.2, -0.45) + vec2((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32 * vec2(1.0, 1.5);
        water.surface(place)
    });
    let mean = heights.sum::<f32>() / (n * n) as f32;
    assert!(mean.abs() > 0.05, "the wave must show: {mean} m");
    assert_near(volume(&cells), 1.5 * (2.0 + mean), 0.01, "displaced volume under the wave");
}

#[test]
fn cells_move_with_their_body() {
    let (velocity, spin) = (vec3(0.6, 0.0, -0.3), 0.8);
    let mut pond = Pond::still();
    let body = pond.body(Cuboid::new(1.0, 1.0, 1.0), Transform::IDENTITY);
    let mut cells = pond.cells();
    assert!(cells.iter().all(|cell| cell.velocity == Vec2::ZERO), "velocity in the first frame: {:?}", cells[0]);
    for i in 1..=60 {
        let time = i as f32 * FRAME;
        let pose = Transform::from_translation(velocity * time).with_rotation(Quat::from_rotation_y(spin * time));
        let pose = pond.world(pose);
        pond.app.world_mut().entity_mut(body).insert(pose);
        cells = pond.cells();
    }
    for cell in &cells {
        let arm = place(cell) - velocity.xz();
        // ω × r about y: (ω z, −ω x).
        let exact = velocity.xz() + spin * vec2(arm.y, -arm.x);
        assert!(cell.velocity.distance(exact) < 0.02, "{}: {} instead of {exact}", cell.cell, cell.velocity);
    }
    // While the clock stands still the body keeps its motion.
    pond.stop_the_clock();
    assert_eq!(pond.cells(), cells);
}

#[test]
fn a_teleport_is_no_motion() {
    let mut pond = Pond::still();
    let body = pond.body(Cuboid::from_length(1.0), at(-4.0, 0.0, 0.0));
    pond.cells();
    let pose = pond.world(at(4.0, 0.0, 0.0));
    pond.app.world_mut().entity_mut(body).insert(pose);
    let cells = pond.cells();
    assert!(!cells.is_empty() && cells.iter().all(|cell| cell.velocity == Vec2::ZERO));
}

#[test]
fn skinned_meshes_are_left_out() {
    let mut pond = Pond::still();
    let body = pond.body(Cuboid::from_length(1.0), Transform::IDENTITY);
    pond.app.world_mut().entity_mut(body).insert(SkinnedMesh::default());
    assert_eq!(pond.cells(), []);
}

#[test]
fn a_changed_mesh_is_read_again() {
    let mut pond = Pond::still();
    let body = pond.body(Cuboid::from_length(1.0), Transform::IDENTITY);
    assert_near(area(&pond.cells()), 1.0, 1e-3, "before");
    let id = pond.app.world().get::<Mesh3d>(body).unwrap().id();
    let mut meshes = pond.app.world_mut().resource_mut::<Assets<Mesh>>();
    *meshes.get_mut(id).unwrap() = Cuboid::from_length(2.0).into();
    // The event comes with the end of the frame.
    pond.cells();
    assert_near(area(&pond.cells()), 4.0, 1e-3, "after");
}

/// `cargo test -p bevy_freshet --all-features --lib fifty_balls -- --ignored --nocapture`
#[test]
#[ignore = "prints a time, and cannot fail"]
fn cost_of_fifty_balls() {
    for waves in [WaterWaves::still(), WaterWaves::wind(5.0, 5000.0, vec2(1.0, 0.4))] {
        let trains = waves.trains.len();
        let mut pond = Pond::new(waves);
        let cells = FieldWindow { first: IVec2::splat(-26), size: UVec2::splat(52), cell: 0.25 };
        pond.app.world_mut().entity_mut(pond.water).insert(cells);
        pond.set(WaterInteraction { rain: 20.0, ..default() });
        let measure = |pond: &mut Pond| {
            let mut times: Vec<f32> = (0..60)
                .map(|_| {
                    let start = std::time::Instant::now();
                    pond.app.update();
                    start.elapsed().as_secs_f32() * 1e3
                })
                .collect();
            times.sort_by(f32::total_cmp);
            (times[0], times[times.len() / 2])
        };
        let without = measure(&mut pond);
        for i in 0..50 {
            // 2 × 25 × 20 triangles.
            let mesh = Sphere::new(0.45).mesh().uv(25, 20);
            pond.body(mesh, at((i % 8) as f32 * 1.5 - 5.2, 0.1, (i / 8) as f32 * 1.5 - 5.2));
        }
        pond.app.update();
        let with = measure(&mut pond);
        println!(
            "{trains} trains: quickest and median frame {without:.2?} ms, {with:.2?} ms with 50 balls of 1000 triangles"
        );
    }
}
