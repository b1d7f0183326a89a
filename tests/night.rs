//! The water at night, read from pixels.
use crate::stage::{SIZE, Stage};
use bevy::{camera::Exposure, prelude::*};
use bevy_freshet::{
    prelude::*,
    sky::{Moon, Sky, SkyPlugin, SkyView},
};

/// Bearing that the camera looks along, degrees.
const AHEAD: f32 = 60.0;

/// A clear night sky of few texels.
fn night(moon: Option<Moon>) -> Sky {
    Sky { cloud_cover: 0.0, resolution: 64, moon, ..Sky::with_sun(-40.0, 0.0) }
}

/// A lake that fills the lower half of the view; `exposure` as in [`SkyView`].
fn lake(sky: Sky, exposure: Option<f32>) -> (Stage, Entity) {
    let mut stage = Stage::with(|app| _ = app.add_plugins((WaterPlugin, SkyPlugin)));
    stage.spawn(sky);
    stage.spawn((Water::new(Vec2::splat(4000.0)), WaterWaves::wind(4.0, 2000.0, vec2(0.4, 1.0))));
    let look = Quat::from_rotation_y(-AHEAD.to_radians()) * Vec3::NEG_Z;
    let pose = Transform::from_xyz(0.0, 4.0, 0.0).looking_to(look, Vec3::Y);
    let camera = stage.camera(PerspectiveProjection { fov: 1.0, ..default() }, pose);
    // Long enough that starlight is well within what 16-bit floats resolve.
    stage.app.world_mut().entity_mut(camera).insert((SkyView { exposure, ..default() }, Exposure { ev100: EV }));
    (stage, camera)
}

const EV: f32 = -8.0;

/// Mean luminance of the water, as drawn, and the column of the middle of its light.
fn water(stage: &mut Stage, camera: Entity) -> (f32, f32) {
    let picture = stage.picture(camera);
    let below = picture.pixels().filter(|(pixel, _)| pixel.y > SIZE.y / 2 + 2);
    let (mut sum, mut moment, mut count) = (0.0, 0.0, 0.0);
    for (pixel, color) in below {
        let luminance = color.dot(vec3(0.2126, 0.7152, 0.0722));
        sum += luminance;
        moment += luminance * (pixel.x as f32 + 0.5);
        count += 1.0;
    }
    (sum / count, moment / sum)
}

#[test]
fn the_water_is_dark_at_night_and_shows_under_a_moon() {
    let exposure = Exposure { ev100: EV }.exposure();
    let radiance = |moon| {
        let (mut stage, camera) = lake(night(moon), None);
        water(&mut stage, camera).0 / exposure
    };
    let (moonless, moonlit) = (radiance(None), radiance(Some(Moon::full(30.0, AHEAD))));
    println!("{moonless} cd/m² without, {moonlit} cd/m² with a full moon");
    assert!(moonless > 0.0 && moonless < 1e-3, "{moonless} cd/m²");
    assert!(moonlit > 20.0 * moonless, "{moonlit} cd/m²");
}

#[test]
fn the_glade_lies_under_the_moon() {
    for aside in [-12.0_f32, 0.0, 15.0] {
        let moon = Moon::full(20.0, AHEAD + aside);
        let (mut stage, camera) = lake(night(Some(moon)), None);
        let (_, column) = water(&mut stage, camera);
        let under = stage.project(camera, Vec3::Y * 4.0 + moon.direction().with_y(0.0).normalize() * 1e3).x;
        let middle = SIZE.x as f32 / 2.0;
        println!("{aside}°: {column}, expected {under}");
        // What the sky adds evenly draws the middle of the light towards the middle of the picture.
        assert!((column - under).abs() < 3.0 + 0.25 * (under - middle).abs(), "{aside}°: {column}, expected {under}");
    }
}

#[test]
fn an_automatic_exposure_shows_the_night_and_leaves_it_dark() {
    let drawn = |sky| {
        let (mut stage, camera) = lake(sky, Some(0.0));
        water(&mut stage, camera).0
    };
    let day = drawn(Sky { cloud_cover: 0.0, resolution: 64, ..Sky::with_sun(40.0, AHEAD + 120.0) });
    let moonlit = drawn(night(Some(Moon::full(40.0, AHEAD + 120.0))));
    let moonless = drawn(night(None));
    println!("day {day}, moonlit {moonlit}, moonless {moonless}");
    assert!((0.1..0.5).contains(&(moonlit / day)), "{}", moonlit / day);
    assert!((0.02..0.5).contains(&(moonless / moonlit)), "{}", moonless / moonlit);
}
