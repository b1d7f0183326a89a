//! Long runs, and things that come and go all the time.
use crate::{said::complaints, stage::Stage};
use bevy::{camera::RenderTarget, light::DirectionalLightShadowMap, prelude::*, time::TimeUpdateStrategy};
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use core::time::Duration;
use freshet_hydro::grid::Grid;

const FRAME: Duration = Duration::from_micros(16_667);

/// A rendering scene with physics, whose clock runs by a frame with every update.
fn stage() -> Stage {
    let mut stage = Stage::with(|app| {
        app.add_plugins((RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule(), WaterPlugin))
            .insert_resource(TimestepMode::Fixed { dt: FRAME.as_secs_f32(), substeps: 1 })
            .insert_resource(Time::<Fixed>::from_duration(FRAME))
            .insert_resource(DirectionalLightShadowMap { size: 256 });
    });
    stage.app.insert_resource(TimeUpdateStrategy::ManualDuration(FRAME));
    stage
}

/// A camera whose pictures are small, looking along the river.
fn camera(stage: &mut Stage) -> Entity {
    let pose = Transform::from_xyz(2.0, 3.0, 14.0).looking_at(Vec3::ZERO, Vec3::Y);
    let camera = stage.camera(PerspectiveProjection::default(), pose);
    let target = stage.target(uvec2(160, 90));
    stage.app.world_mut().entity_mut(camera).insert(RenderTarget::Image(target.into()));
    camera
}

/// A channel along z with its water.
fn bed() -> WaterBed {
    WaterBed::from_fn(uvec2(31, 31), 1.0, |p| 0.05 * p.x * p.x - 1.0).unwrap()
}

fn water() -> impl Bundle {
    // The current of a parabolic channel, along z.
    let speed = |cell: UVec2| vec2(0.0, (1.0 - 0.05 * (cell.x as f32 - 15.0).powi(2)).max(0.0));
    let flow = Grid::from_fn(uvec2(31, 31), 1.0, speed).unwrap();
    (Water::new(Vec2::splat(30.0)), WaterOptics::RIVER, WaterFlow::from_map(flow))
}

fn body(i: u32) -> impl Bundle {
    let place = vec3((i % 5) as f32 - 2.0, 1.0 + (i / 25) as f32, (i / 5 % 5) as f32 - 2.0);
    (RigidBody::Dynamic, Collider::ball(0.2), Floating::with_density(400.0), Transform::from_translation(place))
}

fn light() -> impl Bundle {
    let sun = DirectionalLight { illuminance: 3000.0, shadow_maps_enabled: true, ..default() };
    (sun, Transform::from_xyz(1.0, 2.0, -2.0).looking_at(Vec3::ZERO, Vec3::Y))
}

/// Number of entities in the main and in the render world.
fn entities(app: &mut App) -> (usize, usize) {
    let count = |world: &mut World| world.query::<Entity>().iter(world).count();
    (count(app.world_mut()), count(app.sub_app_mut(bevy::render::RenderApp).world_mut()))
}

/// Despawns what the last frame has spawned, spawns the same anew, and draws a frame.
fn churn(app: &mut App, spawned: &mut Vec<Entity>, spawn: &mut impl FnMut(&mut World) -> Vec<Entity>) {
    for entity in spawned.drain(..) {
        app.world_mut().despawn(entity);
    }
    *spawned = spawn(app.world_mut());
    app.update();
}

/// Lets things come and go for 60 frames: nothing may be complained about, and nothing may stay.
fn assert_leaves_nothing_behind(stage: &mut Stage, mut spawn: impl FnMut(&mut World) -> Vec<Entity>) {
    let mut spawned = Vec::new();
    let mut leave = |app: &mut App, frames: u32| {
        for _ in 0..frames {
            churn(app, &mut spawned, &mut spawn);
        }
        churn(app, &mut spawned, &mut |_| Vec::new());
        (0..5).for_each(|_| app.update());
        entities(app)
    };
    stage.settle();
    // What is made once and kept is made in the first frames.
    let before = leave(&mut stage.app, 5);
    let mut after = before;
    let said = complaints(&mut stage.app, |app| after = leave(app, 60));
    assert_eq!(said, [""; 0]);
    assert_eq!(after, before, "entities in the main and the render world");
}

#[test]
fn fifty_bodies_come_and_go_every_frame() {
    let mut stage = stage();
    camera(&mut stage);
    stage.spawn((bed(), BedShading::default()));
    stage.spawn(water());
    stage.spawn(light());
    assert_leaves_nothing_behind(&mut stage, |world| (0..50).map(|i| world.spawn(body(i)).id()).collect());
}

#[test]
fn waters_beds_and_cameras_come_and_go_every_frame() {
    let mut stage = stage();
    let first = camera(&mut stage);
    stage.spawn(light());
    stage.spawn(body(0));
    let target = stage.app.world().get::<RenderTarget>(first).unwrap().clone();
    assert_leaves_nothing_behind(&mut stage, |world| {
        let pose = Transform::from_xyz(-2.0, 4.0, 12.0).looking_at(Vec3::ZERO, Vec3::Y);
        let water = world.spawn(water()).id();
        let bed = world.spawn((bed(), BedShading::default())).id();
        let pond = world.spawn((Water::new(Vec2::splat(4.0)), Transform::from_xyz(0.0, 1.0, 0.0))).id();
        let camera =
            world.spawn((Camera3d::default(), Msaa::Off, Camera { order: 1, ..default() }, target.clone(), pose)).id();
        vec![water, bed, pond, camera]
    });
}

#[test]
fn water_is_drawn_with_and_without_multisampling() {
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let mut stage = stage();
        let camera = camera(&mut stage);
        stage.app.world_mut().entity_mut(camera).insert(msaa);
        stage.spawn(water());
        stage.spawn(light());
        let said = complaints(&mut stage.app, |app| (0..10).for_each(|_| app.update()));
        assert_eq!(said, [""; 0], "{msaa:?}");
        let picture = stage.picture(camera);
        let water = picture.at(80, 60);
        assert!(water.max_element() > 1e-3 && water.is_finite(), "{msaa:?}: {water}");
    }
}

#[test]
fn six_hundred_frames_pass_without_a_warning() {
    let mut stage = stage();
    let camera = camera(&mut stage);
    stage.spawn((bed(), BedShading::default()));
    stage.spawn(water());
    stage.spawn(light());
    for i in 0..10 {
        stage.spawn(body(i));
    }
    let said = complaints(&mut stage.app, |app| (0..600).for_each(|_| app.update()));
    assert_eq!(said, [""; 0]);
    let picture = stage.picture(camera);
    assert!(picture.pixels().all(|(_, color)| color.is_finite()));
    assert!(picture.pixels().any(|(_, color)| color.max_element() > 0.01), "there is something to see");
}
