//! Where and what the surface mirrors.
use crate::stage::{Picture, SIZE, Stage, still_water};
use bevy::{camera::Viewport, prelude::*};
use bevy_freshet::prelude::*;

const LEVEL: f32 = 0.5;
const RED: LinearRgba = LinearRgba::rgb(1.0, 0.0, 0.0);
const GREEN: LinearRgba = LinearRgba::rgb(0.0, 1.0, 0.0);

/// Half size of the boxes.
const BOX: Vec3 = Vec3::new(0.8, 0.6, 0.5);
const RED_AT: Vec3 = Vec3::new(-2.0, LEVEL + 1.0, -3.0);
const GREEN_AT: Vec3 = Vec3::new(2.2, LEVEL + 1.4, -2.0);

/// Two boxes over still water that shows nothing but its reflection, and two under it.
fn scene(stage: &mut Stage) -> Entity {
    let (water, waves, surface, optics) = still_water(Vec2::splat(60.0));
    let surface = WaterSurface { view: SurfaceView::Reflection, ..surface };
    let water = stage.spawn((water, waves, surface, optics, Transform::from_xyz(0.0, LEVEL, 0.0)));
    for (color, place) in [(RED, RED_AT), (GREEN, GREEN_AT)] {
        stage.paint(Cuboid::from_size(BOX * 2.0), color, Transform::from_translation(place));
    }
    for place in [vec3(0.0, LEVEL - 1.0, 1.0), vec3(-2.0, LEVEL - 0.7, -3.0)] {
        stage.paint(Cuboid::from_size(BOX * 2.0), LinearRgba::BLUE, Transform::from_translation(place));
    }
    water
}

/// The rectangle of pixels that hold more than half of `channel`, as (first, one past the last).
fn bounds(picture: &Picture, channel: usize) -> Option<(Vec2, Vec2)> {
    let lit = picture.pixels().filter(|(_, color)| color[channel] > 0.5).map(|(pixel, _)| pixel.as_vec2());
    lit.fold(None, |bounds, pixel| {
        let (low, high) = bounds.unwrap_or((pixel, pixel + 1.0));
        Some((low.min(pixel), high.max(pixel + 1.0)))
    })
}

/// Where the mirror image of a box must appear: its mirrored corners, seen by the camera.
fn expected(stage: &Stage, camera: Entity, center: Vec3) -> (Vec2, Vec2) {
    let corners = (0..8).map(|i| {
        let sign = vec3((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32) * 2.0 - 1.0;
        let corner = center + sign * BOX;
        stage.project(camera, vec3(corner.x, 2.0 * LEVEL - corner.y, corner.z))
    });
    corners.fold((Vec2::MAX, Vec2::MIN), |(low, high), p| (low.min(p), high.max(p)))
}

/// The boxes themselves hide their mirror images from steep cameras; only what lies on water counts.
fn hide_boxes_from(stage: &mut Stage, camera: Entity) {
    use bevy::camera::visibility::RenderLayers;
    let world = stage.app.world_mut();
    let things: Vec<Entity> =
        world.query_filtered::<Entity, (With<Mesh3d>, With<MeshMaterial3d<StandardMaterial>>)>().iter(world).collect();
    for thing in things {
        world.entity_mut(thing).insert(RenderLayers::layer(1));
    }
    world.entity_mut(camera).insert(RenderLayers::layer(0));
    let waters: Vec<Entity> = world.query_filtered::<Entity, With<Water>>().iter(world).collect();
    for water in waters {
        world.get_mut::<WaterReflection>(water).unwrap().layers = Some(RenderLayers::from_layers(&[0, 1]));
    }
}

fn assert_mirrored(stage: &mut Stage, camera: Entity) {
    let picture = stage.picture(camera);
    for (channel, center) in [(0, RED_AT), (1, GREEN_AT)] {
        let (low, high) = bounds(&picture, channel).expect("the box is mirrored");
        let (expected_low, expected_high) = expected(stage, camera, center);
        let error = (low - expected_low).abs().max((high - expected_high).abs()).max_element();
        assert!(error <= 1.5, "channel {channel}: {low}…{high}, expected {expected_low}…{expected_high}");
    }
    let blue = picture.pixels().map(|(_, color)| color.z).fold(0.0, f32::max);
    assert!(blue < 1e-3, "something under water is mirrored: {blue}");
}

fn perspective() -> Projection {
    PerspectiveProjection { fov: 0.9, ..default() }.into()
}

fn level_pose() -> Transform {
    Transform::from_xyz(0.0, LEVEL + 2.0, 8.0).looking_at(vec3(0.0, LEVEL, -2.0), Vec3::Y)
}

#[test]
fn level_view_sees_boxes_where_geometry_puts_them() {
    let mut stage = Stage::new();
    scene(&mut stage);
    let camera = stage.camera(perspective(), level_pose());
    hide_boxes_from(&mut stage, camera);
    assert_mirrored(&mut stage, camera);
}

#[test]
fn steep_view_sees_boxes_where_geometry_puts_them() {
    let mut stage = Stage::new();
    scene(&mut stage);
    let pose = Transform::from_xyz(1.0, LEVEL + 9.0, 4.0).looking_at(vec3(0.0, LEVEL, -2.0), Vec3::Y);
    let camera = stage.camera(perspective(), pose);
    hide_boxes_from(&mut stage, camera);
    assert_mirrored(&mut stage, camera);
}

#[test]
fn view_straight_down_sees_boxes_where_geometry_puts_them() {
    let mut stage = Stage::new();
    scene(&mut stage);
    let pose = Transform::from_xyz(0.0, LEVEL + 9.0, -2.0).looking_to(Vec3::NEG_Y, Vec3::NEG_Z);
    let camera = stage.camera(perspective(), pose);
    hide_boxes_from(&mut stage, camera);
    assert_mirrored(&mut stage, camera);
}

#[test]
fn orthographic_view_sees_boxes_where_geometry_puts_them() {
    let mut stage = Stage::new();
    scene(&mut stage);
    let projection = OrthographicProjection {
        scaling_mode: bevy::camera::ScalingMode::FixedVertical { viewport_height: 9.0 },
        ..OrthographicProjection::default_3d()
    };
    let pose = Transform::from_xyz(3.0, LEVEL + 8.0, 8.0).looking_at(vec3(0.0, LEVEL, -2.0), Vec3::Y);
    let camera = stage.camera(Projection::Orthographic(projection), pose);
    hide_boxes_from(&mut stage, camera);
    assert_mirrored(&mut stage, camera);
}

#[test]
fn two_cameras_at_once_have_a_mirror_each() {
    let mut stage = Stage::new();
    scene(&mut stage);
    let first = stage.camera(perspective(), level_pose());
    let other = Transform::from_xyz(-5.0, LEVEL + 3.0, 7.0).looking_at(vec3(0.0, LEVEL, -2.0), Vec3::Y);
    let second = stage.camera(perspective(), other);
    stage.app.world_mut().get_mut::<Camera>(second).unwrap().order = 10;
    hide_boxes_from(&mut stage, first);
    hide_boxes_from(&mut stage, second);
    assert_mirrored(&mut stage, first);
    assert_mirrored(&mut stage, second);
}

#[test]
fn split_screen_mirrors_in_its_own_half() {
    let mut stage = Stage::new();
    scene(&mut stage);
    let camera = stage.camera(perspective(), level_pose());
    let viewport = Viewport { physical_position: uvec2(SIZE.x / 2, 0), physical_size: SIZE / uvec2(2, 1), ..default() };
    stage.app.world_mut().get_mut::<Camera>(camera).unwrap().viewport = Some(viewport);
    hide_boxes_from(&mut stage, camera);
    let picture = stage.picture(camera);
    let (low, high) = bounds(&picture, 0).expect("the red box is mirrored");
    let (expected_low, expected_high) = expected(&stage, camera, RED_AT);
    let error = (low - expected_low).abs().max((high - expected_high).abs()).max_element();
    assert!(error <= 1.5, "{low}…{high}, expected {expected_low}…{expected_high}");
}

#[test]
fn a_resized_target_gets_a_mirror_of_its_size() {
    let mut stage = Stage::new();
    scene(&mut stage);
    let camera = stage.camera(perspective(), level_pose());
    hide_boxes_from(&mut stage, camera);
    assert_mirrored(&mut stage, camera);
    let target = stage.target(uvec2(200, 240));
    stage.app.world_mut().entity_mut(camera).insert(bevy::camera::RenderTarget::Image(target.into()));
    assert_mirrored(&mut stage, camera);
}

#[test]
fn without_planar_reflection_nothing_is_mirrored() {
    let mut stage = Stage::new();
    let water = scene(&mut stage);
    let camera = stage.camera(perspective(), level_pose());
    hide_boxes_from(&mut stage, camera);
    stage.app.world_mut().get_mut::<WaterReflection>(water).unwrap().planar = false;
    let picture = stage.picture(camera);
    assert_eq!(bounds(&picture, 0), None);
    assert_eq!(bounds(&picture, 1), None);
}

#[test]
fn an_eye_under_water_has_no_mirror() {
    let mut stage = Stage::new();
    scene(&mut stage);
    let camera = stage.camera(perspective(), level_pose());
    stage.picture(camera);
    let mirrors = |stage: &mut Stage| {
        let world = stage.app.world_mut();
        world.query::<(&bevy_freshet::reflection::MirrorCamera, &Camera)>().iter(world).count()
    };
    assert_eq!(mirrors(&mut stage), 1);
    let below = Transform::from_xyz(0.0, LEVEL - 2.0, 8.0).looking_at(vec3(0.0, LEVEL, -2.0), Vec3::Y);
    *stage.app.world_mut().get_mut::<Transform>(camera).unwrap() = below;
    stage.picture(camera);
    assert_eq!(mirrors(&mut stage), 0);
}

#[test]
fn the_sky_is_mirrored_where_nothing_is_drawn() {
    let mut stage = Stage::new();
    let (water, waves, surface, optics) = still_water(Vec2::splat(60.0));
    let surface = WaterSurface { view: SurfaceView::Reflection, ..surface };
    stage.spawn((water, waves, surface, optics));
    stage.app.insert_resource(ClearColor(Color::linear_rgb(0.2, 0.4, 0.6)));
    let camera =
        stage.camera(perspective(), Transform::from_xyz(0.0, 3.0, 0.0).looking_to(vec3(0.0, -1.0, -1.0), Vec3::Y));
    let seen = stage.picture(camera).at(SIZE.x / 2, SIZE.y / 2);
    assert!(seen.distance(vec3(0.2, 0.4, 0.6)) < 2e-3, "{seen}");
}

#[test]
fn a_mirror_refreshed_every_fourth_frame_shows_the_same_still_scene() {
    let scene_with = |refresh: u32| {
        let mut stage = Stage::new();
        let water = scene(&mut stage);
        stage.app.world_mut().get_mut::<WaterReflection>(water).unwrap().refresh = refresh;
        let camera = stage.camera(perspective(), level_pose());
        hide_boxes_from(&mut stage, camera);
        let picture = stage.picture(camera);
        let mut drawn = 0;
        for _ in 0..40 {
            stage.app.update();
            let world = stage.app.world_mut();
            let mut mirrors = world.query_filtered::<&Camera, With<bevy_freshet::reflection::MirrorCamera>>();
            drawn += u32::from(mirrors.single(world).unwrap().is_active);
        }
        (picture, drawn)
    };
    let ((always, in_all), (seldom, in_some)) = (scene_with(1), scene_with(4));
    assert_eq!((in_all, in_some), (40, 10), "frames of 40 in which the mirror is drawn");
    assert!(bounds(&always, 0).is_some(), "the red box is mirrored");
    for ((pixel, always), (_, seldom)) in always.pixels().zip(seldom.pixels()) {
        assert!(always.distance(seldom) < 1e-3, "{pixel}: {always} and {seldom}");
    }
}

/// A lit wall behind the water, and a beam before it that throws its shadow on it.
fn scene_with_shadow(stage: &mut Stage) -> Entity {
    let water = scene(stage);
    let world = stage.app.world_mut();
    let white = world.resource_mut::<Assets<StandardMaterial>>().add(Color::WHITE);
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    let [wall, beam] = [vec3(30.0, 8.0, 0.5), vec3(4.0, 0.8, 0.4)].map(|size| meshes.add(Cuboid::from_size(size)));
    for (mesh, place) in [(wall, vec3(0.0, LEVEL + 4.2, -9.0)), (beam, vec3(0.0, LEVEL + 4.0, -6.0))] {
        stage.spawn((Mesh3d(mesh), MeshMaterial3d(white.clone()), Transform::from_translation(place)));
    }
    let sun = DirectionalLight { illuminance: 10_000.0, shadow_maps_enabled: true, ..default() };
    stage.spawn((sun, Transform::default().looking_to(vec3(0.2, -0.6, -1.0), Vec3::Y)));
    water
}

#[test]
fn a_mirror_shows_shadows_of_the_sun_from_the_maps_of_its_viewer() {
    use bevy::{pbr::ViewLightEntities, render::RenderApp};
    let mut stage = Stage::new();
    let water = scene_with_shadow(&mut stage);
    let camera = stage.camera(perspective(), level_pose());
    let mut picture = |own_shadows| {
        stage.app.world_mut().get_mut::<WaterReflection>(water).unwrap().own_shadows = own_shadows;
        let picture = stage.picture(camera);
        let world = stage.app.sub_app_mut(RenderApp).world_mut();
        let passes: usize = world.query::<&ViewLightEntities>().iter(world).map(|view| view.lights.len()).sum();
        (picture, passes)
    };
    let ((own, passes), (shared, fewer)) = (picture(true), picture(false));
    assert_eq!((passes, fewer), (8, 4), "four cascades for each view, and for both together");
    let world = stage.app.world_mut();
    world.query::<&mut DirectionalLight>().single_mut(world).unwrap().shadow_maps_enabled = false;
    let without = stage.picture(camera);
    // Above this row is the wall, below it are mirror images.
    let shore = stage.project(camera, vec3(0.0, LEVEL, -8.7)).y as u32;
    let mut shaded = UVec2::ZERO;
    for ((pixel, own), ((_, shared), (_, without))) in own.pixels().zip(shared.pixels().zip(without.pixels())) {
        if without.x > 1.5 * own.x {
            shaded += if pixel.y < shore { UVec2::X } else { UVec2::Y };
        }
        if pixel.y < shore {
            assert_eq!(own, shared, "{pixel}: the viewer's own shadows");
        }
    }
    assert!(shaded.min_element() > 300, "pixels in the shadow, and in its mirror image: {shaded}");
    let differing =
        own.pixels().zip(shared.pixels()).filter(|((_, own), (_, shared))| own.distance(*shared) > 0.05 * own.length());
    let differing = differing.count() as u32;
    // Texels of the two maps lie differently along the rim of the shadow.
    assert!(differing < shaded.y / 4, "{differing} pixels differ of {shaded} in the shadow");
}
