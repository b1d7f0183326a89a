//! Reflectance, absorption, refraction and fog, read from pixels.
use crate::stage::{SIZE, Stage, still_water};
use bevy::{
    pbr::{DistanceFog, FogFalloff},
    prelude::*,
};
use bevy_freshet::prelude::*;
use freshet_hydro::optics::{fresnel_exact, fresnel_schlick};

/// An orthographic camera that sees every pixel of the level surface under the same angle (degrees from the normal).
fn slanted(stage: &mut Stage, degrees: f32) -> Entity {
    let direction = Quat::from_rotation_x(degrees.to_radians()) * Vec3::NEG_Y;
    let projection = OrthographicProjection {
        scaling_mode: bevy::camera::ScalingMode::FixedVertical { viewport_height: 1.0 },
        near: 0.0,
        far: 200.0,
        ..OrthographicProjection::default_3d()
    };
    let up = if degrees < 1.0 { Vec3::NEG_Z } else { Vec3::Y };
    let pose = Transform::from_translation(direction * -40.0).looking_to(direction, up);
    stage.camera(Projection::Orthographic(projection), pose)
}

fn center(stage: &mut Stage, camera: Entity) -> Vec3 {
    stage.picture(camera).at(SIZE.x / 2, SIZE.y / 2)
}

/// Light from the centre pixel of water under a white sky and over a black depth: the share that is reflected.
fn reflected_share(fresnel: Fresnel, degrees: f32) -> f32 {
    let mut stage = Stage::new();
    stage.app.insert_resource(ClearColor(Color::WHITE));
    let (water, waves, surface, optics) = still_water(Vec2::splat(600.0));
    stage.spawn((water, waves, surface, WaterOptics { fresnel, ..optics }));
    let black = Plane3d::default().mesh().size(2000.0, 2000.0);
    stage.paint(black, LinearRgba::BLACK, Transform::from_xyz(0.0, -3.0, 0.0));
    let camera = slanted(&mut stage, degrees);
    center(&mut stage, camera).x
}

#[test]
fn reflected_share_follows_fresnel() {
    for degrees in [0.0, 30.0, 60.0, 75.0, 85.0_f32] {
        let share = reflected_share(Fresnel::Exact, degrees);
        let exact = fresnel_exact(degrees.to_radians().cos(), 1.333);
        assert!((share - exact).abs() < 0.02, "{degrees}°: {share}, expected {exact}");
    }
}

#[test]
fn reflected_share_follows_schlick() {
    for degrees in [0.0, 30.0, 60.0, 75.0, 85.0_f32] {
        let share = reflected_share(Fresnel::Schlick, degrees);
        let schlick = fresnel_schlick(degrees.to_radians().cos(), 1.333);
        assert!((share - schlick).abs() < 0.02, "{degrees}°: {share}, expected {schlick}");
    }
}

#[test]
fn simple_and_reciprocal_follow_their_formulas() {
    let cos = 60f32.to_radians().cos();
    let simple = reflected_share(Fresnel::Simple { correction: 1.8 }, 60.0);
    assert!((simple - (1.0 - 1.8 * cos)).abs() < 0.02, "{simple}");
    let reciprocal = reflected_share(Fresnel::Reciprocal, 60.0);
    assert!((reciprocal - (1.0 + cos).powi(-5)).abs() < 0.02, "{reciprocal}");
}

const ABSORPTION: Vec3 = Vec3::new(0.45, 0.2, 0.1);

/// Colour of a white bed at `depth` under water of [`ABSORPTION`], seen at `degrees` to the normal through a surface
/// that reflects nothing.
fn white_bed(depth: f32, degrees: f32) -> Vec3 {
    let mut stage = Stage::new();
    let (water, waves, surface, optics) = still_water(Vec2::splat(600.0));
    let optics = WaterOptics { absorption: ABSORPTION, reflectivity: 0.0, light_path: 0.0, ..optics };
    stage.spawn((water, waves, surface, optics));
    let white = Plane3d::default().mesh().size(2000.0, 2000.0);
    stage.paint(white, LinearRgba::WHITE, Transform::from_xyz(0.0, -depth, 0.0));
    let camera = slanted(&mut stage, degrees);
    center(&mut stage, camera)
}

fn assert_close(measured: Vec3, expected: Vec3, relative: f32) {
    let error = ((measured - expected) / expected).abs().max_element();
    assert!(error < relative, "{measured}, expected {expected}: {error}");
}

#[test]
fn absorption_follows_beer_and_lambert() {
    for depth in [0.5, 1.0, 2.0, 4.0] {
        assert_close(white_bed(depth, 0.0), (-ABSORPTION * depth).exp(), 0.02);
        // Under 50° the ray goes on under 35.08°: the path is longer than the depth.
        let sine = 50f32.to_radians().sin() / 1.333;
        let path = depth / (1.0 - sine * sine).sqrt();
        assert_close(white_bed(depth, 50.0), (-ABSORPTION * path).exp(), 0.02);
    }
}

#[test]
fn twice_the_depth_squares_the_transmittance() {
    let once = white_bed(1.5, 30.0);
    assert_close(white_bed(3.0, 30.0), once * once, 0.02);
}

/// A stripe under one metre of water, seen at 45°, and the columns of its left edge per channel along a row.
fn stripe_edges(dispersion: f32) -> [f32; 3] {
    let mut stage = Stage::new();
    let (water, waves, surface, optics) = still_water(Vec2::splat(600.0));
    stage.spawn((water, waves, surface, WaterOptics { dispersion, reflectivity: 0.0, ..optics }));
    let black = Plane3d::default().mesh().size(200.0, 200.0);
    stage.paint(black, LinearRgba::BLACK, Transform::from_xyz(0.0, -1.02, 0.0));
    let stripe = Plane3d::default().mesh().size(0.3, 100.0);
    stage.paint(stripe, LinearRgba::WHITE, Transform::from_xyz(0.0, -1.0, 0.0));
    // Looking along x, so that the edge is shifted along the rows of pixels.
    let direction = vec3(1.0, -1.0, 0.0).normalize();
    let projection = OrthographicProjection {
        scaling_mode: bevy::camera::ScalingMode::FixedVertical { viewport_height: 1.0 },
        far: 200.0,
        ..OrthographicProjection::default_3d()
    };
    let pose = Transform::from_translation(direction * -20.0 + vec3(-0.35, 0.0, 0.0)).looking_to(direction, Vec3::Z);
    let camera = stage.camera(Projection::Orthographic(projection), pose);
    let picture = stage.picture(camera);
    // Rows run along z here, columns along the view's vertical: the stripe is crossed within a column.
    core::array::from_fn(|channel| {
        let along: Vec<f32> = (0..SIZE.y).map(|y| picture.at(SIZE.x / 2, y)[channel]).collect();
        let across: Vec<f32> = (0..SIZE.x).map(|x| picture.at(x, SIZE.y / 2)[channel]).collect();
        let varies = |line: &[f32]| line.iter().any(|&v| v > 0.5) && line.iter().any(|&v| v < 0.5);
        let line = if varies(&across) { across } else { along };
        assert!(varies(&line), "the stripe is in the picture");
        line.iter().position(|&v| v > 0.5).unwrap() as f32
    })
}

#[test]
fn dispersion_separates_red_and_blue() {
    let [red, green, blue] = stripe_edges(0.0);
    assert!(red == green && green == blue, "without dispersion the edges coincide: {red} {green} {blue}");
    let [red, green, blue] = stripe_edges(0.15);
    assert!((red - blue).abs() >= 3.0, "red and blue part: {red} {blue}");
    assert!((green - red) * (green - blue) <= 0.0, "green lies between: {red} {green} {blue}");
}

#[test]
fn a_box_in_front_of_the_water_leaves_no_ghost() {
    let mut stage = Stage::new();
    let (water, _, surface, optics) = still_water(Vec2::splat(60.0));
    // Strongly bent: waves move the refraction by many pixels.
    let waves = WaterWaves::wind(6.0, 500.0, Vec2::X);
    let surface = WaterSurface { ripples: 0.3, ..surface };
    stage.spawn((water, waves, surface, WaterOptics { reflectivity: 0.0, ..optics }));
    let white = Plane3d::default().mesh().size(200.0, 200.0);
    stage.paint(white, LinearRgba::GREEN, Transform::from_xyz(0.0, -3.0, 0.0));
    let pose = Transform::from_xyz(0.0, 3.0, 8.0).looking_at(vec3(0.0, 0.0, 0.0), Vec3::Y);
    let camera = stage.camera(PerspectiveProjection::default(), pose);
    // Between camera and water, well above it.
    stage.paint(
        Cuboid::from_length(0.6),
        LinearRgba::RED,
        Transform::from_xyz(0.0, 2.0, 5.0).with_rotation(Quat::from_rotation_y(0.4)),
    );
    let picture = stage.picture(camera);
    let mut red_pixels = 0;
    for (pixel, color) in picture.pixels() {
        if color.x > 0.5 {
            red_pixels += 1;
        } else {
            assert!(color.x < 1e-3, "red bleeds into the water at {pixel}: {color}");
        }
    }
    assert!(red_pixels > 200, "the box is in the picture");
}

#[test]
fn fog_hides_water_and_land_alike() {
    let mut stage = Stage::new();
    stage.app.insert_resource(ClearColor(Color::BLACK));
    let (water, waves, surface, optics) = still_water(vec2(4000.0, 4000.0));
    // Black water: what is seen of it is fog alone.
    let optics = WaterOptics { reflectivity: 0.0, absorption: Vec3::splat(1e3), ..optics };
    stage.spawn((water, waves, surface, optics, Transform::from_xyz(2000.0, 0.0, 0.0)));
    let land = Plane3d::default().mesh().size(4000.0, 4000.0);
    stage.paint(land.build(), LinearRgba::BLACK, Transform::from_xyz(-2000.0, 0.0, 0.0));
    stage.paint(land.build(), LinearRgba::BLACK, Transform::from_xyz(0.0, -5.0, 0.0));
    let pose = Transform::from_xyz(0.0, 6.0, 0.0).looking_to(vec3(0.0, -0.1, -1.0), Vec3::Y);
    let camera = stage.camera(PerspectiveProjection::default(), pose);
    for falloff in [
        FogFalloff::Exponential { density: 0.02 },
        FogFalloff::ExponentialSquared { density: 0.01 },
        FogFalloff::Linear { start: 10.0, end: 300.0 },
    ] {
        let fog = DistanceFog { color: Color::WHITE, falloff, ..default() };
        stage.app.world_mut().entity_mut(camera).insert(fog);
        let picture = stage.picture(camera);
        for y in (SIZE.y / 2..SIZE.y).step_by(5) {
            // Mirror places of the picture's halves are equally far away.
            let (land, water) = (picture.at(40, y).x, picture.at(SIZE.x - 41, y).x);
            assert!((land - water).abs() < 0.01, "row {y}: land {land}, water {water}");
        }
        assert!(picture.at(40, SIZE.y / 2 + 5).x > 0.1, "there is fog");
    }
}

#[test]
fn the_bed_keeps_its_own_fog_only_once() {
    let mut stage = Stage::new();
    let (water, waves, surface, optics) = still_water(vec2(4000.0, 4000.0));
    stage.spawn((water, waves, surface, WaterOptics { reflectivity: 0.0, refraction: 0.0, ..optics }));
    let bed = Plane3d::default().mesh().size(4000.0, 4000.0);
    stage.paint(bed, LinearRgba::rgb(0.5, 0.5, 0.5), Transform::from_xyz(0.0, -0.01, 0.0));
    let pose = Transform::from_xyz(0.0, 6.0, 0.0).looking_to(vec3(0.0, -0.1, -1.0), Vec3::Y);
    let camera = stage.camera(PerspectiveProjection::default(), pose);
    let fog = DistanceFog { color: Color::WHITE, falloff: FogFalloff::Exponential { density: 0.02 }, ..default() };
    stage.app.world_mut().entity_mut(camera).insert(fog);
    let wet = stage.picture(camera);
    let world = stage.app.world_mut();
    let water = world.query_filtered::<Entity, With<Water>>().single(world).unwrap();
    world.despawn(water);
    let dry = stage.picture(camera);
    for y in (SIZE.y / 2 + 3..SIZE.y).step_by(5) {
        let (wet, dry) = (wet.at(100, y).x, dry.at(100, y).x);
        assert!((wet - dry).abs() < 0.01, "row {y}: under a film of water {wet}, dry {dry}");
    }
}

#[test]
fn the_sunlights_own_way_down_is_counted() {
    let mut stage = Stage::new();
    let (water, waves, surface, optics) = still_water(Vec2::splat(600.0));
    stage.spawn((water, waves, surface, WaterOptics { absorption: ABSORPTION, reflectivity: 0.0, ..optics }));
    let white = Plane3d::default().mesh().size(2000.0, 2000.0);
    stage.paint(white, LinearRgba::WHITE, Transform::from_xyz(0.0, -1.5, 0.0));
    // A sun 40° from the zenith goes on under 28.83° below the surface.
    let to_sun = Quat::from_rotation_z(40f32.to_radians()) * Vec3::Y;
    stage.spawn((DirectionalLight::default(), Transform::default().looking_to(-to_sun, Vec3::X)));
    let camera = slanted(&mut stage, 0.0);
    let sine = 40f32.to_radians().sin() / 1.333;
    let way = 1.5 + 1.5 / (1.0 - sine * sine).sqrt();
    assert_close(center(&mut stage, camera), (-ABSORPTION * way).exp(), 0.02);
}

#[test]
fn deep_turbid_water_returns_its_share_of_the_light() {
    let backscatter = vec3(0.3, 0.2, 0.1);
    let mut stage = Stage::new();
    let (water, waves, surface, optics) = still_water(Vec2::splat(600.0));
    let optics = WaterOptics { absorption: ABSORPTION, backscatter, reflectivity: 0.0, ..optics };
    stage.spawn((water, waves, surface, optics));
    let illuminance = 2_000.0;
    let sun = DirectionalLight { illuminance, shadow_maps_enabled: false, ..default() };
    stage.spawn((sun, Transform::default().looking_to(Vec3::NEG_Y, Vec3::X)));
    let camera = slanted(&mut stage, 0.0);
    // 0.33 b_b/(a + b_b) E/π (Morel and Prieur 1977) of what enters the water.
    let entering = illuminance * bevy::camera::Exposure::default().exposure() * (1.0 - fresnel_exact(1.0, 1.333));
    let share = 0.33 * backscatter / (ABSORPTION + backscatter);
    assert_close(center(&mut stage, camera), share * entering / core::f32::consts::PI, 0.02);
}
