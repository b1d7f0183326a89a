//! Repeatability, and what happens with unusable settings.
use crate::{
    said::{complaints, run_on_this_thread},
    stage::{SIZE, Stage, still_water},
};
use bevy::prelude::*;
use bevy_freshet::prelude::*;

fn river_stage() -> (Stage, Entity) {
    let mut stage = Stage::new();
    let bed = WaterBed::from_fn(uvec2(30, 30), 1.0, |p| 0.05 * p.x * p.x - 1.0).unwrap();
    stage.paint(bed.mesh(0..30, 0..30).unwrap(), LinearRgba::rgb(0.4, 0.3, 0.2), Transform::IDENTITY);
    stage.spawn(bed);
    stage.spawn((Water::new(Vec2::splat(30.0)), WaterOptics::RIVER, WaterFlow::uniform(vec2(0.0, 0.7))));
    stage.spawn((DirectionalLight::default(), Transform::from_xyz(1.0, 2.0, -2.0).looking_at(Vec3::ZERO, Vec3::Y)));
    let pose = Transform::from_xyz(2.0, 3.0, 12.0).looking_at(Vec3::ZERO, Vec3::Y);
    let camera = stage.camera(PerspectiveProjection::default(), pose);
    (stage, camera)
}

#[test]
fn the_same_scene_gives_the_same_picture_bit_for_bit() {
    let picture = || {
        let (mut stage, camera) = river_stage();
        stage.settle();
        stage.run(0.5);
        stage.picture(camera)
    };
    let (first, second) = (picture(), picture());
    assert!(first.pixels().any(|(_, color)| color.max_element() > 0.01), "there is something to see");
    assert!(first.bits() == second.bits());
}

#[test]
fn water_stands_still_while_virtual_time_is_paused() {
    let (mut stage, camera) = river_stage();
    stage.settle();
    stage.run(0.5);
    let mut pictures_before_and_after_half_a_second = |paused: bool| {
        let mut time = stage.app.world_mut().resource_mut::<Time<Virtual>>();
        if paused {
            time.pause()
        } else {
            time.unpause()
        }
        let before = stage.picture(camera);
        stage.run(0.5);
        (before.bits(), stage.picture(camera).bits())
    };
    let (before, after) = pictures_before_and_after_half_a_second(true);
    assert!(before == after, "paused water moves");
    let (before, after) = pictures_before_and_after_half_a_second(false);
    assert!(before != after, "water moves again");
}

#[test]
fn the_picture_has_no_pixel_that_is_not_a_number() {
    let (mut stage, camera) = river_stage();
    stage.settle();
    stage.run(0.5);
    for (pixel, color) in stage.picture(camera).pixels() {
        assert!(color.is_finite(), "{pixel}: {color}");
    }
}

/// Whether there is water to be asked where the camera looks.
fn is_wet(stage: &mut Stage) -> bool {
    use bevy::ecs::system::RunSystemOnce;
    stage.app.world_mut().run_system_once(|water: WaterQuery| water.sample(Vec3::ZERO).is_some()).unwrap()
}

#[test]
fn water_that_loses_a_component_is_left_out_until_it_has_it_again() {
    let (mut stage, camera) = river_stage();
    let world = stage.app.world_mut();
    let water = world.query_filtered::<Entity, With<Water>>().single(world).unwrap();
    world.entity_mut(water).insert(Visibility::Hidden);
    let without = stage.picture(camera).bits();
    stage.app.world_mut().entity_mut(water).insert(Visibility::Inherited);
    let with = stage.picture(camera).bits();
    assert!(with != without);
    let mut check = |remove: fn(&mut EntityWorldMut), restore: fn(&mut EntityWorldMut), is_water: bool| {
        // In the very frame in which something is to be simulated.
        stage.app.world_mut().write_message(Disturb::push(Vec3::ZERO, 0.5, 0.1));
        remove(&mut stage.app.world_mut().entity_mut(water));
        stage.run(0.2);
        assert_eq!(is_wet(&mut stage), is_water);
        assert!(stage.picture(camera).bits() == without, "it is not drawn");
        restore(&mut stage.app.world_mut().entity_mut(water));
        assert!(stage.picture(camera).bits() != without, "it is drawn again");
    };
    check(|water| _ = water.remove::<WaterFoam>(), |water| _ = water.insert(WaterFoam::default()), true);
    check(|water| _ = water.remove::<WaterOptics>(), |water| _ = water.insert(WaterOptics::RIVER), true);
    check(|water| _ = water.remove::<Water>(), |water| _ = water.insert(Water::new(Vec2::splat(30.0))), false);
}

#[test]
fn no_two_systems_race() {
    use bevy::ecs::schedule::{LogLevel, ScheduleBuildSettings};
    let mut stage = Stage::with(|app| {
        app.add_plugins((WaterPlugin, bevy_freshet::sky::SkyPlugin, bevy_freshet::star_filter::StarFilterPlugin));
        let strict = ScheduleBuildSettings { ambiguity_detection: LogLevel::Error, ..default() };
        let world = app.world_mut();
        world.resource_mut::<Schedules>().configure_schedules(strict.clone());
        app.sub_app_mut(bevy::render::RenderApp).world_mut().resource_mut::<Schedules>().configure_schedules(strict);
    });
    stage.spawn(Water::default());
    stage.app.update();
    stage.app.update();
}

#[test]
fn unusable_settings_neither_panic_nor_draw_anything_wrong() {
    let (mut stage, camera) = river_stage();
    run_on_this_thread(&mut stage.app);
    let before = stage.picture(camera);
    // Waters that cannot be drawn must leave the one that can alone.
    let nan = f32::NAN;
    stage.spawn(Water::new(Vec2::ZERO));
    stage.spawn(Water::new(vec2(nan, 10.0)));
    stage.spawn((Water::new(Vec2::splat(-5.0)), Transform::from_xyz(0.0, 1.0, 0.0)));
    stage.spawn((Water::default(), Transform::from_xyz(nan, 0.0, 0.0)));
    let after = stage.picture(camera);
    assert!(before.bits() == after.bits());
}

/// What is unusable in the next test's water.
const UNUSABLE: &str = "
    WaterWaves::trains WaterWaves::depth WaterWaves::fade_depth WaterFlow::uniform WaterFlow::scale
    WaterSurface::cell WaterSurface::cells WaterSurface::ripples WaterSurface::ripple_size WaterSurface::roughness
    WaterSurface::mesh_error WaterSurface::view_scale
    WaterReflection::resolution WaterReflection::refresh WaterReflection::clip_offset WaterReflection::distance
    WaterReflection::distortion
    WaterOptics::absorption WaterOptics::backscatter WaterOptics::index Fresnel::Simple::correction
    WaterOptics::reflectivity WaterOptics::refraction WaterOptics::dispersion WaterOptics::light_path
    WaterOptics::dull_color WaterOptics::dullness WaterOptics::edge_depth";

#[test]
fn parameters_that_are_not_numbers_are_named_once_and_fall_back_to_sane_ones() {
    let mut stage = Stage::new();
    run_on_this_thread(&mut stage.app);
    stage.app.insert_resource(ClearColor(Color::linear_rgb(0.3, 0.5, 0.7)));
    let (nan, inf) = (f32::NAN, f32::INFINITY);
    let (water, ..) = still_water(Vec2::splat(40.0));
    let train = bevy_freshet::body::Wave { direction: Vec2::splat(nan), wavelength: 0.0, steepness: inf, phase: nan };
    let water = (
        water,
        WaterWaves { trains: vec![train; 12], depth: nan, fade_depth: nan },
        WaterSurface {
            cell: nan,
            cells: 0,
            ripples: inf,
            ripple_size: -1.0,
            roughness: nan,
            mesh_error: nan,
            view_scale: nan,
            ..default()
        },
        WaterReflection { resolution: nan, refresh: 0, clip_offset: nan, distance: -1.0, distortion: nan, ..default() },
        WaterFlow { uniform: Vec2::splat(nan), scale: nan, ..default() },
        WaterOptics {
            absorption: Vec3::splat(nan),
            backscatter: Vec3::splat(-1.0),
            index: nan,
            fresnel: Fresnel::Simple { correction: nan },
            reflectivity: inf,
            refraction: nan,
            dispersion: nan,
            light_path: nan,
            dull_color: LinearRgba::rgb(nan, 0.0, 0.0),
            dullness: nan,
            edge_depth: nan,
            fog: true,
        },
    );
    let water = stage.spawn(water);
    let pose = Transform::from_xyz(0.0, 3.0, 8.0).looking_at(Vec3::ZERO, Vec3::Y);
    let camera = stage.camera(PerspectiveProjection::default(), pose);
    let said = complaints(&mut stage.app, |app| (0..10).for_each(|_| app.update()));
    for field in UNUSABLE.split_whitespace() {
        let field = format!(" {water}: {field} ");
        assert_eq!(said.iter().filter(|line| line.contains(&field)).count(), 1, "{field}in {said:#?}");
    }
    assert_eq!(said.len(), UNUSABLE.split_whitespace().count(), "{said:#?}");
    let picture = stage.picture(camera);
    for (pixel, color) in picture.pixels() {
        assert!(color.is_finite() && color.min_element() >= 0.0, "{pixel}: {color}");
    }
    assert!(picture.at(SIZE.x / 2, SIZE.y / 2).max_element() > 0.0, "the water is drawn");
}

#[test]
fn a_server_without_a_renderer_answers_queries() {
    use bevy::ecs::system::RunSystemOnce;
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, WaterPlugin));
    app.world_mut().spawn((Water::default(), Transform::from_xyz(0.0, 3.0, 0.0)));
    app.finish();
    app.cleanup();
    app.update();
    app.update();
    let sample = app.world_mut().run_system_once(|water: WaterQuery| water.sample(Vec3::ZERO)).unwrap().unwrap();
    assert!((sample.height - 3.0).abs() < 0.2);
    assert_eq!(sample.depth, f32::INFINITY);
}

#[test]
fn a_camera_as_bevy_makes_it_sees_the_same_water() {
    use bevy::{camera::Hdr, core_pipeline::tonemapping::Tonemapping};
    let (mut stage, camera) = river_stage();
    stage.app.insert_resource(ClearColor(Color::linear_rgb(0.3, 0.5, 0.7)));
    stage.app.world_mut().entity_mut(camera).insert(Tonemapping::Reinhard);
    let with_hdr = stage.picture(camera);
    // Without `Hdr` the surface tone-maps itself, and the scene behind it arrives tone-mapped.
    stage.app.world_mut().entity_mut(camera).remove::<Hdr>();
    let without = stage.picture(camera);
    // Below the horizon: a clear colour is tone-mapped with `Hdr` only.
    let below = |((pixel, a), (_, b)): ((UVec2, Vec3), (UVec2, Vec3))| {
        (pixel.y >= SIZE.y / 2).then_some((a - b).abs().max_element())
    };
    let mut differences: Vec<f32> = with_hdr.pixels().zip(without.pixels()).filter_map(below).collect();
    differences.sort_by(f32::total_cmp);
    let (median, high) = (differences[differences.len() / 2], differences[differences.len() * 9 / 10]);
    assert!(median < 0.02 && high < 0.06, "median {median}, nine tenths below {high}");
    assert!(without.at(SIZE.x / 2, SIZE.y * 3 / 4).max_element() > 0.02, "there is water");
}
