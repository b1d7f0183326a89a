//! What touches the water, as a game sees it: rays, clicks, fingers, and the bodies that disturb it by themselves.
use crate::said::complaints;
use bevy::{
    camera::RenderTarget,
    ecs::system::RunSystemOnce,
    input::{
        InputPlugin,
        touch::{TouchInput, TouchPhase},
    },
    prelude::*,
    render::{
        RenderPlugin,
        settings::{RenderCreation, WgpuSettings},
    },
    time::TimeUpdateStrategy,
    window::{ExitCondition, WindowResolution},
    winit::WinitPlugin,
};
use bevy_freshet::{prelude::*, query::WaterHit};
use std::time::Duration;

const LEVEL: f32 = 2.0;

/// An app without a renderer, 60 frames a second.
fn server() -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), InputPlugin, WaterPlugin))
        .init_asset::<Mesh>()
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(1.0 / 60.0)));
    app.finish();
    app.cleanup();
    app
}

/// Deep water of 60 m × 60 m that is moved and turned.
fn sea(app: &mut App, waves: WaterWaves) -> Entity {
    let pose = Transform::from_xyz(5.0, LEVEL, -3.0).with_rotation(Quat::from_rotation_y(0.4));
    let water = app.world_mut().spawn((Water::new(Vec2::splat(60.0)), waves, pose)).id();
    app.update();
    app.update();
    water
}

fn raycast(app: &mut App, ray: Ray3d, max: f32) -> Option<WaterHit> {
    app.world_mut().run_system_once(move |water: WaterQuery| water.raycast(ray, max)).unwrap()
}

fn ray(from: Vec3, to: Vec3) -> Ray3d {
    Ray3d::new(from, Dir3::new(to - from).unwrap())
}

/// The first place where a ray comes to the other side of the surface, by steps of a millimetre.
fn first_crossing(app: &mut App, ray: Ray3d, max: f32) -> Option<f32> {
    let find = move |water: WaterQuery| {
        let above = |t: f32| {
            let point = ray.get_point(t);
            water.sample(point).map(|sample| point.y - sample.height)
        };
        let mut last: Option<f32> = None;
        (0..(max * 1e3) as u32).map(|i| i as f32 * 1e-3).find(|t| {
            let now = above(*t);
            let crossed = matches!((last, now), (Some(a), Some(b)) if a * b <= 0.0);
            last = now;
            crossed
        })
    };
    app.world_mut().run_system_once(find).unwrap()
}

#[test]
fn rays_meet_the_waves_within_a_millimetre() {
    let mut app = server();
    let water = sea(&mut app, WaterWaves { fade_depth: 0.0, ..WaterWaves::wind(6.0, 4000.0, Vec2::X) });
    let mut hits = 0;
    for i in 0..24 {
        let angle = i as f32 * 0.7;
        // From above, steep to flat, and from below.
        let height = [6.0, 3.0, 1.5, -4.0][i % 4];
        let from = vec3(5.0 + angle.cos(), LEVEL + height, -3.0 + angle.sin());
        let to = vec3(5.0 + 9.0 * (angle * 1.3).cos(), LEVEL, -3.0 + 9.0 * (angle * 1.3).sin());
        let ray = ray(from, to);
        let exact = first_crossing(&mut app, ray, 14.0);
        let found = raycast(&mut app, ray, 14.0);
        assert_eq!(exact.is_some(), found.is_some(), "ray {i}: {exact:?}, {found:?}");
        let (Some(exact), Some(found)) = (exact, found) else { continue };
        hits += 1;
        assert!((found.distance - exact).abs() < 1.5e-3, "ray {i}: {} m instead of {exact} m", found.distance);
        assert!((found.position.y - found.surface.height).abs() < 1e-3, "ray {i}: {found:?}");
        assert_eq!(found.surface.water, water);
    }
    assert!(hits > 20, "{hits} rays met the water");
}

#[test]
fn rays_miss_what_is_not_there() {
    let mut app = server();
    assert_eq!(raycast(&mut app, Ray3d::new(Vec3::Y, Dir3::NEG_Y), 1e9), None, "no water");
    sea(&mut app, WaterWaves::still());
    let down = Ray3d::new(vec3(5.0, LEVEL + 10.0, -3.0), Dir3::NEG_Y);
    assert!((raycast(&mut app, down, f32::INFINITY).unwrap().distance - 10.0).abs() < 1e-4);
    let flat = ray(vec3(5.0, LEVEL + 1.0, -3.0), vec3(25.0, LEVEL, -3.0));
    assert!((raycast(&mut app, flat, 100.0).unwrap().position.x - 25.0).abs() < 1e-2);
    for (ray, max) in [
        (down, 9.9),
        (Ray3d::new(down.origin, Dir3::Y), 1e9),
        (Ray3d::new(down.origin, Dir3::X), 1e9),
        (Ray3d::new(vec3(500.0, 10.0, 0.0), Dir3::NEG_Y), 1e9),
        (Ray3d::new(Vec3::NAN, Dir3::NEG_Y), 1e9),
        (down, f32::NAN),
        (down, -1.0),
    ] {
        assert_eq!(raycast(&mut app, ray, max), None, "{ray:?} to {max}");
    }
    // Where land rises above the water.
    let bed = WaterBed::from_fn(uvec2(80, 80), 1.0, |p| if p.x > 0.0 { 1.0 } else { -3.0 }).unwrap();
    app.world_mut().spawn((bed, Transform::from_xyz(5.0, LEVEL, -3.0)));
    app.update();
    assert_eq!(raycast(&mut app, Ray3d::new(vec3(15.0, 9.0, -3.0), Dir3::NEG_Y), 1e9), None);
    assert!(raycast(&mut app, Ray3d::new(vec3(-5.0, 9.0, -3.0), Dir3::NEG_Y), 1e9).is_some());
}

/// An app with a window of 200 × 100 pixels that nobody sees, a camera above still water, and no GPU.
fn window() -> (App, Entity, Entity) {
    let mut app = App::new();
    let no_gpu = RenderCreation::Automatic(Box::new(WgpuSettings { backends: None, ..default() }));
    let window = Window { resolution: WindowResolution::new(200, 100), ..default() };
    app.add_plugins(
        DefaultPlugins
            .set(WindowPlugin { primary_window: Some(window), exit_condition: ExitCondition::DontExit, ..default() })
            .set(RenderPlugin { render_creation: no_gpu, ..default() })
            .disable::<bevy::log::LogPlugin>()
            .disable::<WinitPlugin>(),
    )
    .add_plugins(WaterPlugin)
    .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(1.0 / 60.0)));
    app.finish();
    app.cleanup();
    let water = sea(&mut app, WaterWaves::still());
    let pose = Transform::from_xyz(5.0, LEVEL + 10.0, -3.0).looking_to(Vec3::NEG_Y, Vec3::NEG_Z);
    // At 90° and 10 m away, 100 pixels are 20 m.
    let lens = PerspectiveProjection { fov: core::f32::consts::FRAC_PI_2, ..default() };
    let target = RenderTarget::default();
    app.world_mut().spawn((Camera3d::default(), target, Projection::from(lens), pose, WaterTouch::default()));
    let window = app.world_mut().query_filtered::<Entity, With<Window>>().single(app.world()).unwrap();
    app.update();
    app.update();
    (app, window, water)
}

fn point(app: &mut App, window: Entity, at: Vec2) {
    app.world_mut().get_mut::<Window>(window).unwrap().set_cursor_position(Some(at));
}

fn hold(app: &mut App, button: MouseButton) {
    app.world_mut().resource_mut::<ButtonInput<MouseButton>>().press(button);
}

/// What is sent in one frame.
fn frame(app: &mut App) -> Vec<Disturb> {
    app.world_mut().resource_mut::<Messages<Disturb>>().clear();
    app.update();
    app.world_mut().resource_mut::<Messages<Disturb>>().drain().collect()
}

#[test]
fn a_click_dents_the_water_under_the_pointer() {
    let (mut app, window, water) = window();
    point(&mut app, window, vec2(120.0, 40.0));
    assert_eq!(frame(&mut app), [], "nothing is pressed");
    hold(&mut app, MouseButton::Left);
    let sent = frame(&mut app);
    let [dent] = sent[..] else { panic!("{sent:?}") };
    let exact = vec3(5.0 + 4.0, LEVEL, -3.0 - 2.0);
    assert!(dent.place.distance(exact) < 0.01, "{}", dent.place);
    assert_eq!((dent.water, dent.dye), (Some(water), Vec3::ZERO));
    assert!(dent.volume < 0.0 && dent.foam > 0.0);

    // Held still it does no more; dragged it does, once a radius.
    assert_eq!(frame(&mut app), []);
    point(&mut app, window, vec2(121.0, 40.0));
    assert_eq!(frame(&mut app), [], "0.2 m are less than the radius");
    point(&mut app, window, vec2(123.0, 40.0));
    assert_eq!(frame(&mut app).len(), 1);

    // Blocked, outside the window, and while the clock stands still, nothing.
    app.insert_resource(WaterTouchBlocked(true));
    point(&mut app, window, vec2(60.0, 40.0));
    assert_eq!(frame(&mut app), []);
    app.insert_resource(WaterTouchBlocked(false));
    point(&mut app, window, vec2(300.0, 40.0));
    assert_eq!(frame(&mut app), []);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    point(&mut app, window, vec2(60.0, 40.0));
    assert_eq!(frame(&mut app), []);
}

#[test]
fn the_right_button_spills_dye_as_long_as_it_is_held() {
    let (mut app, window, _) = window();
    point(&mut app, window, vec2(100.0, 50.0));
    hold(&mut app, MouseButton::Right);
    let touch = WaterTouch::default();
    for _ in 0..3 {
        let sent = frame(&mut app);
        let [blot] = sent[..] else { panic!("{sent:?}") };
        let exact = touch.dye * touch.dye_rate / 60.0;
        assert!((blot.dye - exact).length() < 1e-4 * exact.length(), "{} instead of {exact}", blot.dye);
        assert_eq!(blot.volume, 0.0);
    }
}

#[test]
fn each_finger_dents_the_water() {
    let (mut app, window, _) = window();
    for (id, position) in [(1, vec2(60.0, 50.0)), (2, vec2(140.0, 50.0))] {
        app.world_mut().write_message(TouchInput { phase: TouchPhase::Started, position, window, force: None, id });
    }
    let mut places: Vec<f32> = frame(&mut app).iter().map(|dent| dent.place.x - 5.0).collect();
    places.sort_by(f32::total_cmp);
    assert!(places.len() == 2 && (places[0] + 8.0).abs() < 0.01 && (places[1] - 8.0).abs() < 0.01, "{places:?}");
}

#[cfg(feature = "rapier")]
#[test]
fn floating_bodies_disturb_the_water_by_themselves() {
    let mut app = server();
    let body = app.world_mut().spawn(Floating::default()).id();
    assert!(app.world().get::<DisturbsWater>(body).is_some());
}

#[test]
fn unusable_settings_are_named_once() {
    let mut app = server();
    let water = sea(&mut app, WaterWaves::still());
    let leak = DyesWater { rate: f32::NAN, absorption: Vec3::splat(-1.0), radius: 0.0 };
    let body = app.world_mut().spawn((leak, Transform::from_xyz(5.0, LEVEL - 1.0, -3.0))).id();
    let said = complaints(&mut app, |app| {
        for _ in 0..5 {
            for place in [Vec3::NAN, vec3(5.0, LEVEL, -3.0)] {
                app.world_mut().write_message(Disturb { volume: f32::INFINITY, ..Disturb::at(place, 0.5) });
            }
            app.update();
        }
    });
    let expected = [
        format!("{body}: DyesWater::absorption"),
        format!("{body}: DyesWater::rate"),
        format!("{body}: DyesWater::radius"),
        format!("{water}: Disturb::volume"),
        "Disturb::place".into(),
    ];
    assert_eq!(said.len(), expected.len(), "{said:#?}");
    for words in expected {
        assert!(said.iter().any(|line| line.contains(&words)), "{words:?} is not in {said:#?}");
    }
}
