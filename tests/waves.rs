//! What is drawn is what is felt.
use crate::stage::{Picture, SIZE, Stage, still_water};
use bevy::{ecs::system::RunSystemOnce, prelude::*};
use bevy_freshet::prelude::*;

pub const LEVEL: f32 = 1.5;
/// Width of the picture, m.
const WIDTH: f32 = 6.0;

pub fn sea() -> WaterWaves {
    WaterWaves { fade_depth: 0.0, ..WaterWaves::wind(4.0, 3000.0, vec2(1.0, 0.4)) }
}

/// Waves on a fine mesh, whose heights a camera draws from straight above.
pub fn scene(stage: &mut Stage, waves: WaterWaves, pose: Transform) -> Entity {
    let (water, _, surface, optics) = still_water(Vec2::splat(WIDTH + 6.0));
    let surface = WaterSurface { view: SurfaceView::Height, cell: 0.03, cells: 256, mesh_error: 0.0, ..surface };
    stage.spawn((water, waves, surface, optics, pose));
    stage.camera_above(pose.translation, WIDTH)
}

/// Drawn and queried heights over the still surface at 1000 places of the picture.
pub fn heights(stage: &mut Stage, camera: Entity, center: Vec2) -> Vec<(Vec2, f32, f32)> {
    let picture = stage.picture(camera);
    let pixels: Vec<UVec2> = (0..1000).map(|i| uvec2(i * 37 % SIZE.x, (i * 61 + i / 7) % SIZE.y)).collect();
    let place = move |pixel: UVec2| center + (pixel.as_vec2() + 0.5 - SIZE.as_vec2() / 2.0) * (WIDTH / SIZE.x as f32);
    let queried = {
        let pixels = pixels.clone();
        stage
            .app
            .world_mut()
            .run_system_once(move |water: WaterQuery| {
                let height = |&pixel: &UVec2| {
                    let at = place(pixel);
                    water.sample(vec3(at.x, LEVEL, at.y)).unwrap().height - LEVEL
                };
                pixels.iter().map(height).collect::<Vec<_>>()
            })
            .unwrap()
    };
    let drawn = pixels.iter().map(|pixel| {
        let split = picture.at(pixel.x, pixel.y);
        split.x + split.y / 64.0
    });
    pixels.iter().zip(drawn).zip(queried).map(|((&pixel, drawn), queried)| (place(pixel), drawn, queried)).collect()
}

fn assert_same(samples: &[(Vec2, f32, f32)], amplitude: f32) {
    let highest = samples.iter().map(|(_, drawn, _)| drawn.abs()).fold(0.0, f32::max);
    assert!(highest > 0.2 * amplitude, "there are waves: {highest}");
    for (place, drawn, queried) in samples {
        let error = (drawn - queried).abs();
        assert!(error < 1e-3 + 1e-4 * amplitude, "{place}: drawn {drawn}, queried {queried}");
    }
}

fn amplitude(waves: &WaterWaves) -> f32 {
    waves.trains.iter().map(|wave| wave.steepness * wave.wavelength / core::f32::consts::TAU).sum()
}

#[test]
fn drawn_height_is_the_queried_height() {
    let mut stage = Stage::new();
    let camera = scene(&mut stage, sea(), Transform::from_xyz(0.0, LEVEL, 0.0));
    stage.settle();
    stage.run(3.0);
    assert_same(&heights(&mut stage, camera, Vec2::ZERO), amplitude(&sea()));
}

#[test]
fn drawn_height_is_the_queried_height_on_turned_and_moved_water() {
    let mut stage = Stage::new();
    let pose = Transform::from_xyz(13.0, LEVEL, -8.0).with_rotation(Quat::from_rotation_y(0.7));
    let camera = scene(&mut stage, sea(), pose);
    stage.settle();
    stage.run(1.0);
    assert_same(&heights(&mut stage, camera, vec2(13.0, -8.0)), amplitude(&sea()));
}

#[test]
fn drawn_height_is_the_queried_height_where_waves_fade_on_a_shore() {
    let mut stage = Stage::new();
    let bed = WaterBed::from_fn(uvec2(40, 40), 0.5, |p| LEVEL - 0.5 - 0.1 * p.x + 0.05 * (p.y * 2.0).sin()).unwrap();
    stage.spawn(bed);
    let waves = WaterWaves { fade_depth: 0.8, ..sea() };
    let camera = scene(&mut stage, waves.clone(), Transform::from_xyz(0.0, LEVEL, 0.0));
    stage.settle();
    stage.run(2.0);
    assert_same(&heights(&mut stage, camera, Vec2::ZERO), amplitude(&waves));
}

#[test]
fn a_crest_travels_with_the_phase_speed() {
    let wave =
        |wavelength: f32| bevy_freshet::body::Wave { direction: Vec2::X, wavelength, steepness: 0.15, phase: 0.0 };
    let depth = 0.4;
    let waves = WaterWaves { trains: vec![wave(2.0)], depth, fade_depth: 0.0 };
    let mut stage = Stage::new();
    let camera = scene(&mut stage, waves, Transform::from_xyz(0.0, LEVEL, 0.0));
    stage.settle();
    let crest = |stage: &mut Stage| {
        // The phase of the fundamental along a row.
        let picture = stage.picture(camera);
        let (mut sin, mut cos) = (0.0, 0.0);
        let columns = (SIZE.x as f32 / WIDTH * 4.0) as u32; // two whole waves
        for column in 0..columns {
            let split = picture.at(column, SIZE.y / 2);
            let angle = column as f32 / columns as f32 * 2.0 * core::f32::consts::TAU;
            let height = split.x + split.y / 64.0;
            sin += height * angle.sin();
            cos += height * angle.cos();
        }
        sin.atan2(cos) / core::f32::consts::TAU * 2.0
    };
    let before = crest(&mut stage);
    stage.run(0.5);
    let moved = (crest(&mut stage) - before).rem_euclid(2.0);
    let speed = freshet_hydro::waves::angular_frequency(core::f32::consts::TAU / 2.0, depth) / core::f32::consts::PI;
    assert!((moved - speed * 0.5).abs() < 0.01 * speed * 0.5, "moved {moved} m, expected {}", speed * 0.5);
}

#[test]
fn a_mesh_with_only_the_cells_that_a_viewer_needs_looks_like_a_full_one() {
    let mut stage = Stage::new();
    let (water, _, surface, optics) = still_water(Vec2::splat(200.0));
    let surface = WaterSurface { view: SurfaceView::Normal, ..surface };
    let water = stage.spawn((water, sea(), surface, optics));
    let pose = Transform::from_xyz(0.0, 3.0, 0.0).looking_to(vec3(0.3, -0.15, -1.0), Vec3::Y);
    let camera = stage.camera(PerspectiveProjection::default(), pose);
    let mut picture = |mesh_error| {
        stage.app.world_mut().get_mut::<WaterSurface>(water).unwrap().mesh_error = mesh_error;
        stage.picture(camera)
    };
    let [full, usual, flat] = [0.0, WaterSurface::default().mesh_error, 4.0].map(&mut picture);
    // Root mean square difference of the normals.
    let difference = |one: &Picture, other: &Picture| {
        let squares = one.pixels().zip(other.pixels()).map(|((_, one), (_, other))| one.distance_squared(other));
        (squares.sum::<f32>() / (SIZE.x * SIZE.y) as f32).sqrt()
    };
    let (usual, flat) = (difference(&full, &usual), difference(&full, &flat));
    assert!(usual < 0.003, "usual {usual}");
    assert!(flat > 3.0 * usual, "usual {usual}, four pixels off {flat}");
}
