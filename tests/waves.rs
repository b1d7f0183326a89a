//! What is drawn is what is felt.
use crate::stage::{SIZE, Stage, still_water};
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

/// Heights over the still surface that `scene` draws with a mesh error of 0 and with the usual one, and pixels per metre.
fn heights_by_mesh(scene: impl FnOnce(&mut Stage, WaterSurface) -> Entity) -> ([Vec<f32>; 2], f32) {
    const VIEW: f32 = 30.0;
    let mut stage = Stage::new();
    let (.., surface, _) = still_water(Vec2::ONE);
    let water = scene(&mut stage, WaterSurface { view: SurfaceView::Height, ..surface });
    let camera = stage.camera_above(Vec3::ZERO, VIEW);
    let pictures = [0.0, WaterSurface::default().mesh_error].map(|mesh_error| {
        stage.app.world_mut().get_mut::<WaterSurface>(water).unwrap().mesh_error = mesh_error;
        let picture = stage.picture(camera);
        picture.pixels().map(|(_, split)| split.x + split.y / 64.0).collect()
    });
    (pictures, SIZE.x as f32 / VIEW)
}

#[test]
fn a_mesh_of_no_more_cells_than_a_viewer_needs_is_off_by_no_more_than_it_may() {
    let waves = WaterWaves { fade_depth: 0.0, ..WaterWaves::wind(14.0, 8000.0, vec2(1.0, 0.4)) };
    let ([full, coarse], pixels_per_metre) = heights_by_mesh(|stage, surface| {
        let (water, _, _, optics) = still_water(Vec2::splat(60.0));
        stage.spawn((water, waves.clone(), surface, optics))
    });
    // Each train may be off by that much.
    let most = waves.trains.len() as f32 * WaterSurface::default().mesh_error / pixels_per_metre;
    let errors = full.iter().zip(&coarse).map(|(full, coarse)| (full - coarse).abs());
    let error = errors.fold(0.0, f32::max);
    let highest = full.iter().copied().fold(0.0, f32::max);
    assert!(highest > 1.5 * most, "there are waves to see: {highest} m");
    assert!(error < most, "{error} m off, where {most} m may be");
    assert!(error > 0.01 * most, "the mesh is a coarser one: {error} m off");
}

#[test]
fn a_coarser_mesh_shows_where_waves_end_at_a_quay() {
    // A swell that a few samples would carry, before a wall: beyond it the water is too shallow for waves.
    let swell = bevy_freshet::body::Wave { direction: Vec2::X, wavelength: 40.0, steepness: 0.08, phase: 0.0 };
    let waves = WaterWaves { trains: vec![swell], fade_depth: 1.0, ..WaterWaves::still() };
    let ([full, coarse], _) = heights_by_mesh(|stage, surface| {
        stage.spawn(WaterBed::from_fn(uvec2(80, 80), 0.5, |p| if p.x > 3.0 { -0.05 } else { -6.0 }).unwrap());
        let (water, _, _, optics) = still_water(Vec2::splat(38.0));
        stage.spawn((water, waves.clone(), surface, optics))
    });
    let highest = full.iter().copied().fold(0.0, f32::max);
    let errors = full.iter().zip(&coarse).map(|(full, coarse)| (full - coarse).abs());
    let off = errors.filter(|error| *error > 0.1 * highest).count() as f32 / full.len() as f32;
    // The wall itself, half a metre wide, may be drawn by other triangles.
    assert!(off < 0.5 / 30.0, "{off} of the picture is off by a tenth of the {highest} m");
}
