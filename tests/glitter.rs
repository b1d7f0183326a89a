//! Sun, lamps and stylised highlights on waves, near and far.
use crate::stage::{SIZE, Stage};
use bevy::prelude::*;
use bevy_freshet::prelude::*;

/// Height of the nearest view, m: from there on waves and ripples are larger than a pixel.
const NEAREST: f32 = 6.0;

/// Wind waves under a light whose mirror image lies in the middle of the view, seen by an orthographic camera that is
/// `height` metres high and whose rays fall 30° to the horizon. `light` gets the direction in which the light falls.
fn lit(height: f32, lighting: WaterLighting, glitters: bool, light: impl Fn(&mut Stage, Vec3)) -> (Stage, Entity) {
    let mut stage = Stage::new();
    let deep = WaterOptics { absorption: Vec3::splat(1e3), backscatter: Vec3::ZERO, ..default() };
    let surface = WaterSurface { sunlight: glitters, ..default() };
    let waves = WaterWaves::wind(4.0, 2000.0, vec2(1.0, 0.4));
    stage.spawn((Water::new(Vec2::splat(600.0)), waves, deep, surface, lighting));
    let down = vec3(0.0, -0.5, 0.75_f32.sqrt());
    light(&mut stage, down);
    let projection = OrthographicProjection {
        scaling_mode: bevy::camera::ScalingMode::FixedVertical { viewport_height: height },
        far: 2000.0,
        ..OrthographicProjection::default_3d()
    };
    let look = down.with_z(-down.z);
    let pose = Transform::from_translation(look * -10.0 * height).looking_to(look, Vec3::Y);
    let camera = stage.camera(Projection::Orthographic(projection), pose);
    (stage, camera)
}

fn sun(stage: &mut Stage, down: Vec3) {
    stage.spawn((DirectionalLight::default(), Transform::default().looking_to(down, Vec3::Y)));
}

fn lamp(stage: &mut Stage, down: Vec3) {
    let light = PointLight { intensity: 1e9, range: 1e5, ..default() };
    stage.spawn((light, Transform::from_translation(down * -100.0)));
}

/// Mean and highest luminance of the middle `share` of the picture's width and height.
fn mean_and_peak((mut stage, camera): (Stage, Entity), share: f32) -> (f32, f32) {
    let picture = stage.picture(camera);
    let half = SIZE.as_vec2() / 2.0;
    let lit: Vec<f32> = picture
        .pixels()
        .filter(|(pixel, _)| (pixel.as_vec2() + 0.5 - half).abs().cmple(half * share).all())
        .map(|(_, color)| color.element_sum() / 3.0)
        .collect();
    (lit.iter().sum::<f32>() / lit.len() as f32, lit.iter().copied().fold(0.0, f32::max))
}

/// The same water must be as bright from twice as far, although waves and ripples sink below a pixel, and no pixel may
/// flash where many waves share it.
#[test]
fn glitter_keeps_its_light_with_distance_and_does_not_sparkle() {
    let near_and_far = [1.0, 2.0, 4.0, 8.0].map(|times| (times * NEAREST, 2.0 * times * NEAREST));
    for (near, far) in near_and_far {
        let sunlit = |height| lit(height, WaterLighting::PHYSICAL, true, sun);
        let (mean, _) = mean_and_peak(sunlit(near), 1.0);
        let (mean_far, _) = mean_and_peak(sunlit(far), 0.5);
        let (whole, peak) = mean_and_peak(sunlit(far), 1.0);
        println!("{near} m: {mean}, {far} m: {mean_far}, peak {} means", peak / whole);
        assert!((mean_far / mean - 1.0).abs() < 0.25, "{near} m: {mean}, {far} m: {mean_far}");
        assert!(peak < 20.0 * whole, "{far} m: a pixel of {peak} in a mean of {whole}");
    }
}

/// The mean radiance of the same water from twice as far, relative to that from near, at three distances.
fn gains(lighting: WaterLighting, glitters: bool, light: fn(&mut Stage, Vec3)) -> [f32; 3] {
    [1.0, 2.0, 4.0].map(|times| {
        let (near, far) = (times * NEAREST, 2.0 * times * NEAREST);
        let (mean, _) = mean_and_peak(lit(near, lighting, glitters, light), 1.0);
        let (mean_far, _) = mean_and_peak(lit(far, lighting, glitters, light), 0.5);
        assert!(mean > 0.0);
        mean_far / mean
    })
}

#[test]
fn a_lamps_glitter_keeps_its_light_with_distance() {
    let gains = gains(WaterLighting::PHYSICAL, true, lamp);
    println!("lamp: {gains:?}");
    assert!(gains.iter().all(|gain| (gain - 1.0).abs() < 0.1), "{gains:?}");
}

#[test]
fn stylised_highlights_keep_their_light_with_distance() {
    let bumped = WaterLighting { highlight: 1.0, flatness: 0.0, ..WaterLighting::PHYSICAL };
    for lighting in [bumped, WaterLighting::LAKE_2006] {
        let gains = gains(lighting, false, sun);
        println!("{gains:?}");
        assert!(gains.iter().all(|gain| (gain - 1.0).abs() < 0.1), "{gains:?}");
    }
}
