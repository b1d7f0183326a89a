//! Lamps and stylised light, read from pixels.
use crate::{
    said::complaints,
    stage::{Picture, SIZE, Stage, still_water},
};
use bevy::{camera::Exposure, prelude::*};
use bevy_freshet::prelude::*;
use core::f32::consts::PI;
use freshet_hydro::optics::{WATER_INDEX, fresnel_exact};

/// Luminous flux of the lamps, lm.
const FLUX: f32 = 1e6;

/// Reaches so far that the window around its range is 1 within a millionth.
fn lamp() -> PointLight {
    PointLight { intensity: FLUX, range: 1e4, ..default() }
}

/// Level, bottomless water that shows the light scattered in it, seen straight down from an orthographic camera; `height` is
/// the height of the view, m.
fn scattering(height: f32) -> (Stage, Entity) {
    let mut stage = Stage::new();
    let (water, waves, surface, optics) = still_water(Vec2::splat(100.0));
    let surface = WaterSurface { view: SurfaceView::Refraction, ..surface };
    let optics = WaterOptics { absorption: Vec3::splat(ABSORPTION), backscatter: Vec3::splat(BACKSCATTER), ..optics };
    stage.spawn((water, waves, surface, optics));
    let projection = OrthographicProjection {
        scaling_mode: bevy::camera::ScalingMode::FixedVertical { viewport_height: height },
        far: 100.0,
        ..OrthographicProjection::default_3d()
    };
    let pose = Transform::from_xyz(0.0, 30.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::NEG_Z);
    let camera = stage.camera(Projection::Orthographic(projection), pose);
    (stage, camera)
}

const ABSORPTION: f32 = 1.0;
const BACKSCATTER: f32 = 0.5;

/// What [`scattering`] shows where a lamp is `height` metres above the surface and `aside` metres beside the place.
fn expected(height: f32, aside: f32) -> f32 {
    let distance = height.hypot(aside);
    let rise = height / distance;
    let irradiance = FLUX / (4.0 * PI) / (distance * distance) * rise * (1.0 - fresnel_exact(rise, WATER_INDEX));
    Exposure::default().exposure() * irradiance / PI * 0.33 * BACKSCATTER / (ABSORPTION + BACKSCATTER)
}

/// The pixel `aside` metres to the right of the middle of a view that is `height` metres high.
fn beside(picture: &Picture, height: f32, aside: f32) -> f32 {
    picture.at(SIZE.x / 2 + (aside / height * SIZE.y as f32) as u32, SIZE.y / 2).x
}

#[test]
fn the_light_of_a_lamp_falls_with_the_square_of_its_distance() {
    for height in [1.0, 2.0, 4.0, 8.0, 16.0] {
        let (mut stage, camera) = scattering(1.0);
        stage.spawn((lamp(), Transform::from_xyz(0.0, height, 0.0)));
        let found = beside(&stage.picture(camera), 1.0, 0.0);
        println!("{height} m: {found}, expected {}", expected(height, 0.0));
        assert!((found / expected(height, 0.0) - 1.0).abs() < 0.01, "{height} m: {found}");
    }
}

#[test]
fn a_lamp_is_mirrored_where_geometry_has_it() {
    for place in [vec3(0.0, 3.0, -4.0), vec3(1.5, 2.0, -3.0), vec3(-2.0, 1.0, -6.0)] {
        let mut stage = Stage::new();
        let (water, waves, surface, optics) = still_water(Vec2::splat(100.0));
        stage.spawn((water, waves, WaterSurface { sunlight: true, roughness: 1e-4, ..surface }, optics));
        stage.spawn((lamp(), Transform::from_translation(place)));
        let pose = Transform::from_xyz(0.0, 3.0, 5.0).looking_at(vec3(0.0, 0.0, -1.0), Vec3::Y);
        let camera = stage.camera(PerspectiveProjection::default(), pose);
        let picture = stage.picture(camera);
        let (brightest, color) = picture.pixels().max_by(|a, b| a.1.x.total_cmp(&b.1.x)).unwrap();
        let mirrored = stage.project(camera, place.with_y(-place.y));
        println!("{brightest} {color}, expected {mirrored}");
        assert!(color.x > 0.1);
        assert!((brightest.as_vec2() + 0.5).distance(mirrored) < 1.5, "{brightest}, expected {mirrored}");
    }
}

#[test]
fn a_spot_light_keeps_to_its_cone() {
    let (height, inner, outer) = (5.0, 0.3_f32, 0.4_f32);
    let (mut stage, camera) = scattering(6.0);
    let light = SpotLight { intensity: FLUX, range: 1e4, inner_angle: inner, outer_angle: outer, ..default() };
    stage.spawn((light, Transform::from_xyz(0.0, height, 0.0).looking_to(Vec3::NEG_Y, Vec3::X)));
    let picture = stage.picture(camera);
    for aside in [0.0, 0.7, 1.4] {
        let found = beside(&picture, 6.0, aside);
        assert!((found / expected(height, aside) - 1.0).abs() < 0.03, "{aside} m: {found}");
    }
    assert_eq!(beside(&picture, 6.0, height * outer.tan() + 0.05), 0.0);
    let between = beside(&picture, 6.0, height * (0.5 * (inner + outer)).tan());
    assert!(between > 0.0 && between < 0.6 * expected(height, 1.8), "{between}");
}

/// The lamp stands so that the plate's shadow lies beside the plate.
#[test]
fn a_shadowed_lamp_gives_nothing() {
    let spot = SpotLight {
        intensity: FLUX,
        range: 1e4,
        inner_angle: 0.9,
        outer_angle: 1.0,
        shadow_maps_enabled: true,
        ..default()
    };
    for is_spot in [false, true] {
        let (mut stage, camera) = scattering(6.0);
        let lamp = Transform::from_xyz(-2.0, 4.0, 0.0);
        if is_spot {
            stage.spawn((spot, lamp.looking_at(Vec3::ZERO, Vec3::Y)));
        } else {
            stage.spawn((PointLight { shadow_maps_enabled: true, ..self::lamp() }, lamp));
        }
        let lit = stage.picture(camera);
        stage.paint(Cuboid::new(1.0, 0.1, 1.0), LinearRgba::BLACK, Transform::from_xyz(-1.0, 2.0, 0.0));
        let shaded = stage.picture(camera);
        assert!(beside(&lit, 6.0, 0.2) > 0.1);
        assert_eq!(beside(&shaded, 6.0, 0.2), 0.0, "spot light: {is_spot}");
        assert_eq!(beside(&shaded, 6.0, 2.5), beside(&lit, 6.0, 2.5), "spot light: {is_spot}");
    }
}

#[test]
fn a_lamp_out_of_reach_changes_nothing() {
    let mut stage = Stage::new();
    stage.app.insert_resource(ClearColor(Color::WHITE));
    stage.spawn((Water::new(Vec2::splat(100.0)), WaterWaves::wind(4.0, 2000.0, Vec2::X)));
    let pose = Transform::from_xyz(0.0, 3.0, 5.0).looking_at(Vec3::ZERO, Vec3::Y);
    let camera = stage.camera(PerspectiveProjection::default(), pose);
    let without = stage.picture(camera).bits();
    stage.spawn((PointLight { intensity: FLUX, range: 5.0, ..default() }, Transform::from_xyz(0.0, 30.0, 0.0)));
    assert!(without == stage.picture(camera).bits());
}

/// Bottomless black water under a white sky and a light that comes in along `down`, seen straight down.
fn styled(lighting: WaterLighting, down: Vec3) -> f32 {
    let mut stage = Stage::new();
    stage.app.insert_resource(ClearColor(Color::WHITE));
    let (water, waves, surface, optics) = still_water(Vec2::splat(100.0));
    stage.spawn((water, waves, surface, optics, lighting));
    let light = DirectionalLight { illuminance: 1000.0, ..default() };
    stage.spawn((light, Transform::default().looking_to(down, Vec3::X)));
    let pose = Transform::from_xyz(0.0, 30.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::NEG_Z);
    let camera = stage.camera(PerspectiveProjection::default(), pose);
    stage.picture(camera).at(SIZE.x / 2, SIZE.y / 2).y
}

/// Each part against its formula, with L, V and N known.
#[test]
fn stylised_light_is_what_its_formulas_say() {
    let down = vec3(0.6, -0.8, 0.0);
    let cosine = 0.8_f32;
    let irradiance = 1000.0 * Exposure::default().exposure();
    let plain = styled(WaterLighting::PHYSICAL, down);
    let check = |name, found: f32, expected: f32| {
        println!("{name}: {found}, expected {expected}");
        assert!((found / expected - 1.0).abs() < 0.02, "{name}: {found}, expected {expected}");
    };
    let diffuse = WaterLighting { diffuse: 1.0, ..WaterLighting::PHYSICAL };
    check("half-Lambert", styled(diffuse, down), plain * (0.5 + 0.5 * cosine));
    let highlight = WaterLighting { highlight: 1.0, sharpness: 3.0, shininess: 2.0, ..WaterLighting::PHYSICAL };
    let lobes = 0.7 * cosine.powi(3) + 0.3 * cosine.powi(2);
    check("highlight", styled(highlight, down), plain + irradiance * lobes);
    let tinted = WaterLighting { tinted_highlight: 1.0, tint_exponent: 10.0, ..WaterLighting::PHYSICAL };
    let half_way = (0.5 * (1.0 + cosine)).sqrt();
    check("tinted highlight", styled(tinted, down), plain + irradiance * 0.97 * half_way.powi(10));
    let translucent = WaterLighting { translucence: 1.0, ..WaterLighting::PHYSICAL };
    check("from above", styled(translucent, down), plain);
    check("from below", styled(translucent, -down), plain + irradiance * 0.36 * cosine / PI);
}

#[test]
fn senseless_lighting_is_reported_once_and_drawn_all_the_same() {
    let mut stage = Stage::new();
    stage.app.insert_resource(ClearColor(Color::WHITE));
    let lighting = WaterLighting { highlight: -1.0, tint_exponent: f32::NAN, ..WaterLighting::LAKE_2006 };
    stage.spawn((Water::new(Vec2::splat(100.0)), lighting));
    let sun = Transform::default().looking_to(Vec3::NEG_Y, Vec3::X);
    stage.spawn((DirectionalLight { illuminance: 1000.0, ..default() }, sun));
    let pose = Transform::from_xyz(0.0, 30.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::NEG_Z);
    let camera = stage.camera(PerspectiveProjection::default(), pose);
    let said = complaints(&mut stage.app, |app| (0..3).for_each(|_| app.update()));
    for field in ["WaterLighting::highlight is -1", "WaterLighting::tint_exponent is NaN"] {
        assert_eq!(said.iter().filter(|line| line.contains(field)).count(), 1, "{field}: {said:#?}");
    }
    assert!(stage.picture(camera).pixels().all(|(_, color)| color.is_finite()));
}
