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

/// What a picture of the water shows; in luminance.
struct Seen {
    mean: f32,
    /// Mean of the middle half of its width and height.
    middle: f32,
    peak: f32,
}

fn seen((mut stage, camera): (Stage, Entity)) -> Seen {
    let picture = stage.picture(camera);
    let half = SIZE.as_vec2() / 2.0;
    let mean = |share: f32| {
        let within = |pixel: UVec2| (pixel.as_vec2() + 0.5 - half).abs().cmple(half * share).all();
        let lit: Vec<f32> =
            picture.pixels().filter(|(pixel, _)| within(*pixel)).map(|(_, color)| color.element_sum() / 3.0).collect();
        lit.iter().sum::<f32>() / lit.len() as f32
    };
    let peak = picture.pixels().map(|(_, color)| color.element_sum() / 3.0).fold(0.0, f32::max);
    Seen { mean: mean(1.0), middle: mean(0.5), peak }
}

/// The water from `distances` times [`NEAREST`], each twice as far as the one before it.
fn from_afar(distances: usize, lighting: WaterLighting, glitters: bool, light: fn(&mut Stage, Vec3)) -> Vec<Seen> {
    (0..distances).map(|i| seen(lit((1 << i) as f32 * NEAREST, lighting, glitters, light))).collect()
}

/// The mean radiance of the same water from twice as far, relative to that from near.
fn gains(seen: &[Seen]) -> Vec<f32> {
    assert!(seen.iter().all(|seen| seen.mean > 0.0));
    seen.windows(2).map(|pair| pair[1].middle / pair[0].mean).collect()
}

/// The same water must be as bright from twice as far, although waves and ripples sink below a pixel, and no pixel may
/// flash where many waves share it.
#[test]
fn glitter_keeps_its_light_with_distance_and_does_not_sparkle() {
    let seen = from_afar(5, WaterLighting::PHYSICAL, true, sun);
    let (gains, peaks) = (gains(&seen), seen.iter().map(|seen| seen.peak / seen.mean).collect::<Vec<_>>());
    println!("sun: {gains:?}, peaks {peaks:?}");
    assert!(gains.iter().all(|gain| (gain - 1.0).abs() < 0.1), "{gains:?}");
    assert!(peaks[1..].iter().all(|peak| *peak < 20.0), "{peaks:?}");
}

#[test]
fn a_lamps_glitter_keeps_its_light_with_distance() {
    let gains = gains(&from_afar(4, WaterLighting::PHYSICAL, true, lamp));
    println!("lamp: {gains:?}");
    assert!(gains.iter().all(|gain| (gain - 1.0).abs() < 0.1), "{gains:?}");
}

#[test]
fn stylised_highlights_keep_their_light_with_distance() {
    let bumped = WaterLighting { flatness: 0.0, ..WaterLighting::RIVER_2015 };
    for lighting in [bumped, WaterLighting::LAKE_2006] {
        let gains = gains(&from_afar(4, lighting, false, sun));
        println!("stylised: {gains:?}");
        assert!(gains.iter().all(|gain| (gain - 1.0).abs() < 0.1), "{gains:?}");
    }
}
