//! Foam as it is drawn: on the water and nowhere else, around what stands in the current, and as much as there is.
use crate::stage::{Picture, Stage, still_water};
use bevy::{camera::Exposure, light::light_consts::lux, prelude::*};
use bevy_freshet::prelude::*;
use core::f32::consts::PI;

/// Water that shows nothing but its foam.
fn black_water(size: Vec2) -> impl Bundle {
    let (water, waves, surface, optics) = still_water(size);
    let optics = WaterOptics { absorption: Vec3::splat(1e3), reflectivity: 0.0, ..optics };
    (water, waves, surface, optics)
}

fn sun(stage: &mut Stage) {
    stage.spawn((DirectionalLight::default(), Transform::default().looking_to(Vec3::NEG_Y, Vec3::Z)));
}

/// Pictures with the foam of `water` and without.
fn with_and_without(stage: &mut Stage, water: Entity, camera: Entity) -> [Picture; 2] {
    [1.0, 0.0].map(|amount| {
        stage.app.world_mut().get_mut::<WaterFoam>(water).unwrap().amount = amount;
        stage.picture(camera)
    })
}

fn is_blue(color: Vec3) -> bool {
    color.z > 0.5 && color.x < 0.1
}

/// Asserts that the blue pixels are the same in both pictures, and returns how many they are and how many others differ.
fn blue_stays(pictures: &[Picture; 2]) -> (usize, usize) {
    let [with, without] = pictures;
    let (mut blue, mut foamy) = (0, 0);
    for ((pixel, with), (_, without)) in with.pixels().zip(without.pixels()) {
        if is_blue(without) {
            assert!(with == without, "{with} with foam and {without} without at {pixel}");
            blue += 1;
        } else if with != without {
            foamy += 1;
        }
    }
    (blue, foamy)
}

const BLUE: LinearRgba = LinearRgba::rgb(0.0, 0.1, 1.0);

#[test]
fn what_stands_before_foam_has_none() {
    let mut stage = Stage::new();
    sun(&mut stage);
    let foam = WaterFoam { speed: 1.0, ..default() };
    let flow = WaterFlow::uniform(vec2(1.5, 0.0));
    let water = stage.spawn((black_water(Vec2::splat(40.0)), foam, flow));
    // One in the air and one that stands on the bottom, near the eye and far from it.
    stage.paint(Cuboid::new(0.3, 1.0, 0.3), BLUE, Transform::from_xyz(-0.6, 2.0, 8.0));
    stage.paint(Cuboid::new(1.0, 9.0, 1.0), BLUE, Transform::from_xyz(3.0, 0.0, 2.0));
    let pose = Transform::from_xyz(0.0, 3.0, 12.0).looking_at(Vec3::ZERO, Vec3::Y);
    let camera = stage.camera(PerspectiveProjection::default(), pose);
    stage.settle();
    stage.run(0.1);
    let (blue, foamy) = blue_stays(&with_and_without(&mut stage, water, camera));
    println!("{blue} pixels of the pillars stay, {foamy} pixels foam");
    assert!(blue > 3000 && foamy > 10_000, "{blue} pixels of the pillars stay, {foamy} pixels foam");
}

#[test]
fn a_pillar_in_the_current_foams_around_and_behind_it() {
    let mut stage = Stage::new();
    sun(&mut stage);
    let foam = WaterFoam { shear: 0.0, speed: 0.0, life: 3.0, ..default() };
    let flow = WaterFlow::uniform(vec2(1.0, 0.0));
    let water = stage.spawn((black_water(Vec2::splat(30.0)), foam, flow));
    let pillar = stage.paint(Cuboid::new(1.0, 3.0, 1.0), BLUE, Transform::IDENTITY);
    stage.app.world_mut().entity_mut(pillar).insert(DisturbsWater);
    let pose = Transform::from_xyz(0.0, 4.0, 6.0).looking_at(Vec3::ZERO, Vec3::Y);
    let camera = stage.camera(PerspectiveProjection::default(), pose);
    stage.settle();
    (0..60).for_each(|_| stage.step(1.0 / 15.0));
    let (blue, foamy) = blue_stays(&with_and_without(&mut stage, water, camera));
    assert!(blue > 1000 && foamy > 1000, "{blue} pixels of the pillar stay, {foamy} pixels foam");

    stage.app.world_mut().get_mut::<WaterSurface>(water).unwrap().view = SurfaceView::Foam;
    let picture = stage.picture(camera);
    let density = |place: Vec2| {
        let pixel = stage.project(camera, vec3(place.x, 0.0, place.y)).as_uvec2();
        picture.at(pixel.x, pixel.y).x
    };
    let beside = [vec2(0.0, 0.75), vec2(0.75, 0.3), vec2(0.75, -0.3)].map(density);
    let (wake, before, aside) = (density(vec2(2.5, 0.0)), density(vec2(-2.0, 0.0)), density(vec2(0.0, -4.0)));
    println!("foam: {beside:?} beside the pillar, {wake} behind it, {before} before it, {aside} aside");
    assert!(beside.iter().all(|density| *density > 0.1), "{beside:?} beside the pillar");
    assert!(wake > 0.05 && before < 0.01 && aside < 0.01, "{wake} behind it, {before} before it, {aside} aside");
}

#[test]
fn drawn_foam_covers_as_much_as_there_is() {
    let mut stage = Stage::new();
    sun(&mut stage);
    let white = WaterFoam { shear: 0.0, life: 1.0, pattern_size: 0.3, albedo: LinearRgba::WHITE, ..default() };
    let cells = WaterInteraction { cell: 0.5, ..default() };
    let water = stage.spawn((black_water(Vec2::splat(120.0)), white, cells, WaterFlow::uniform(vec2(1.0, 0.3))));
    let cameras = [8.0, 90.0].map(|viewport_width| stage.camera_above(Vec3::ZERO, viewport_width));
    stage.settle();
    let mean = |picture: &Picture| {
        picture.pixels().map(|(_, color)| color.x).sum::<f32>() / picture.size.element_product() as f32
    };
    // The radiance of a white page under the sun.
    let white = lux::AMBIENT_DAYLIGHT / PI * Exposure::default().exposure();
    for speed in [1.0, 4.0, 10.0] {
        stage.app.world_mut().get_mut::<WaterFoam>(water).unwrap().speed = speed;
        (0..40).for_each(|_| stage.step(0.1));
        for camera in cameras {
            let mut draw = |view: SurfaceView| {
                stage.app.world_mut().get_mut::<WaterSurface>(water).unwrap().view = view;
                mean(&stage.picture(camera))
            };
            let (density, cover) = (draw(SurfaceView::Foam), draw(SurfaceView::Water) / white);
            println!("foam of density {density} covers {cover}");
            assert!((0.05..0.95).contains(&density), "{density}");
            assert!((cover / density - 1.0).abs() < 0.05, "foam of density {density} covers {cover}");
        }
    }
}
