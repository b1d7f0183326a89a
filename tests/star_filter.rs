//! Stars around bright pixels.
use crate::{
    said,
    stage::{Picture, SIZE, Stage},
};
use bevy::{
    camera::{Hdr, Viewport},
    prelude::*,
};
use bevy_freshet::star_filter::{StarFilter, StarFilterPlugin};
use core::f32::consts::TAU;

/// An orthographic view of one metre a pixel, whose pixel right of and above the middle has the brightness `brightness`.
fn dot(brightness: f32) -> (Stage, Entity) {
    let mut stage = Stage::with(|app| _ = app.add_plugins(StarFilterPlugin));
    let color = LinearRgba::rgb(brightness, 0.5 * brightness, 0.25 * brightness);
    stage.paint(Rectangle::new(1.0, 1.0), color, Transform::from_xyz(0.5, 0.5, 0.0));
    let projection = OrthographicProjection::default_3d();
    let camera = stage.camera(Projection::Orthographic(projection), Transform::from_xyz(0.0, 0.0, 10.0));
    (stage, camera)
}

fn filtered(stage: &mut Stage, camera: Entity, filter: StarFilter) -> Picture {
    stage.app.world_mut().entity_mut(camera).insert(filter);
    stage.picture(camera)
}

fn sum(picture: &Picture) -> Vec3 {
    picture.pixels().map(|(_, color)| color).sum()
}

/// Mean of the 3 × 3 pixels around a place relative to the bright pixel, y up.
fn around(picture: &Picture, place: Vec2) -> f32 {
    let at = vec2(SIZE.x as f32 / 2.0 + 0.5 + place.x, SIZE.y as f32 / 2.0 - 0.5 - place.y).as_ivec2();
    let block = (-1..=1).flat_map(|i| (-1..=1).map(move |j| ivec2(i, j)));
    block.map(|d| picture.at((at.x + d.x) as u32, (at.y + d.y) as u32).x).sum::<f32>() / 9.0
}

const BRIGHT: f32 = 106.0;

#[test]
fn a_bright_pixel_has_arms_at_the_stated_angles() {
    for (arms, angle) in [(4, 0.0), (6, 0.3), (5, 1.0)] {
        let (mut stage, camera) = dot(BRIGHT);
        let filter = StarFilter { arms, angle, length: 0.3, intensity: 1.0, ..default() };
        let picture = filtered(&mut stage, camera, filter);
        for arm in 0..arms {
            let turn = |share: f32| Vec2::from_angle(angle + (arm as f32 + share) * TAU / arms as f32);
            for distance in [12.0, 24.0] {
                let (on, between) = (around(&picture, turn(0.0) * distance), around(&picture, turn(0.5) * distance));
                assert!(on > 0.01 && between < 0.05 * on, "{arms} arms, {arm}, {distance} px: {on}, {between}");
            }
        }
    }
}

/// No arm leaves the picture, so what is added is exactly the intensity's share of what is above the threshold.
#[test]
fn stars_add_the_stated_light_in_the_stated_color() {
    for intensity in [0.25, 1.0] {
        let (mut stage, camera) = dot(BRIGHT);
        let plain = sum(&stage.picture(camera));
        let added = sum(&filtered(&mut stage, camera, StarFilter { intensity, ..default() })) - plain;
        let expected = vec3(1.0, 0.5, 0.25) * (BRIGHT - StarFilter::default().threshold) * intensity;
        println!("{added}, expected {expected}");
        assert!((added / expected - 1.0).abs().max_element() < 0.03, "{added}, expected {expected}");
    }
}

#[test]
fn nothing_below_the_threshold_has_a_star() {
    let (mut stage, camera) = dot(StarFilter::default().threshold * 0.99);
    let plain = stage.picture(camera).bits();
    assert!(plain == filtered(&mut stage, camera, StarFilter::default()).bits());
}

#[test]
fn without_intensity_or_component_the_picture_stays() {
    let (mut stage, camera) = dot(BRIGHT);
    let plain = stage.picture(camera).bits();
    assert!(plain != filtered(&mut stage, camera, StarFilter::default()).bits());
    assert!(plain == filtered(&mut stage, camera, StarFilter { intensity: 0.0, ..default() }).bits());
    filtered(&mut stage, camera, StarFilter::default());
    stage.app.world_mut().entity_mut(camera).remove::<StarFilter>();
    assert!(plain == stage.picture(camera).bits());
}

#[test]
fn multisampled_cameras_have_stars_too() {
    let (mut stage, camera) = dot(BRIGHT);
    stage.app.world_mut().entity_mut(camera).insert(Msaa::Sample4);
    let plain = sum(&stage.picture(camera)).x;
    let added = sum(&filtered(&mut stage, camera, StarFilter::default())).x - plain;
    let expected = 0.5 * (BRIGHT - StarFilter::default().threshold);
    assert!((added / expected - 1.0).abs() < 0.03, "{added}, expected {expected}");
}

#[test]
fn stars_stay_in_their_viewport() {
    let (mut stage, camera) = dot(BRIGHT);
    let viewport = Viewport { physical_position: uvec2(41, 23), physical_size: uvec2(101, 91), ..default() };
    stage.app.world_mut().get_mut::<Camera>(camera).unwrap().viewport = Some(viewport.clone());
    let plain = stage.picture(camera);
    let (bright, _) = plain.pixels().max_by(|a, b| a.1.x.total_cmp(&b.1.x)).unwrap();
    let filter = StarFilter { length: 0.5, arms: 4, angle: 0.0, ..default() };
    let starry = filtered(&mut stage, camera, filter);
    let (mut moment, mut total) = (Vec2::ZERO, 0.0);
    for ((pixel, before), (_, after)) in plain.pixels().zip(starry.pixels()) {
        let added = after.x - before.x;
        let from = viewport.physical_position;
        let inside = pixel.cmpge(from).all() && pixel.cmplt(from + viewport.physical_size).all();
        assert!(inside || added == 0.0, "{pixel}: {added}");
        moment += pixel.as_vec2() * added;
        total += added;
    }
    assert!(total > 10.0);
    assert!((moment / total).distance(bright.as_vec2()) < 1.5, "{} {bright}", moment / total);
}

#[test]
fn a_camera_without_hdr_and_senseless_settings_are_reported_once() {
    let (mut stage, camera) = dot(BRIGHT);
    let senseless = StarFilter { intensity: f32::NAN, arms: 400, ..default() };
    stage.app.world_mut().entity_mut(camera).remove::<Hdr>().insert(senseless);
    let said = said::complaints(&mut stage.app, |app| (0..3).for_each(|_| app.update()));
    for part in ["StarFilter needs the component Hdr", "StarFilter::intensity", "StarFilter::arms"] {
        assert_eq!(said.iter().filter(|line| line.contains(part)).count(), 1, "{part}: {said:#?}");
    }
}
