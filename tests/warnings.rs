//! Unusable settings are complained about: once, naming the entity and the field.
use crate::{
    said::complaints,
    simulated,
    stage::{SIZE, Stage},
};
use bevy::{
    prelude::*,
    render::{
        RenderPlugin,
        settings::{RenderCreation, WgpuSettings},
    },
    window::ExitCondition,
    winit::WinitPlugin,
};
use bevy_freshet::{body::Wave, prelude::*};

const NAN: f32 = f32::NAN;

/// An app without a renderer.
fn server() -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, WaterPlugin));
    app.finish();
    app.cleanup();
    app
}

fn run(app: &mut App, frames: u32) {
    for _ in 0..frames {
        app.update();
    }
}

/// Panics unless the one complaint names `entity` and each of the `words`.
fn assert_said_once(said: &[String], entity: Entity, words: &[&str]) {
    let [line] = said else { panic!("one complaint was expected: {said:#?}") };
    let entity = format!(" {entity}: ");
    for word in words.iter().chain(&[entity.as_str()]) {
        assert!(line.contains(word), "{word:?} is not in: {line}");
    }
}

/// Ten frames with a `water` and nothing else must bring one complaint with `words`.
fn assert_water_is_refused(water: impl Bundle, words: &[&str]) {
    let mut app = server();
    let water = app.world_mut().spawn((Water::default(), WaterWaves::still())).insert(water).id();
    let said = complaints(&mut app, |app| run(app, 10));
    assert_said_once(&said, water, words);
}

#[test]
fn usable_water_is_not_complained_about() {
    let mut app = server();
    app.world_mut().spawn((Water::default(), WaterOptics::RIVER, WaterFlow::uniform(Vec2::X)));
    app.world_mut().spawn(WaterBed::from_fn(uvec2(60, 60), 2.0, |p| p.x * 0.1).unwrap());
    assert_eq!(complaints(&mut app, |app| run(app, 10)), [""; 0]);
}

#[test]
fn water_of_no_size_is_refused_once() {
    for size in [Vec2::ZERO, vec2(10.0, -1.0), vec2(NAN, 10.0), vec2(f32::INFINITY, 10.0)] {
        assert_water_is_refused(Water::new(size), &["Water::size", "switched off"]);
    }
}

#[test]
fn parameters_that_are_not_numbers_are_refused_once() {
    let train = Wave { direction: Vec2::X, wavelength: NAN, steepness: 0.1, phase: 0.0 };
    assert_water_is_refused(WaterWaves { trains: vec![train], ..WaterWaves::still() }, &["WaterWaves::trains"]);
    assert_water_is_refused(WaterWaves { depth: NAN, ..WaterWaves::still() }, &["WaterWaves::depth", "NaN"]);
    assert_water_is_refused(WaterWaves { fade_depth: NAN, ..WaterWaves::still() }, &["WaterWaves::fade_depth", "NaN"]);
    assert_water_is_refused(WaterFlow::uniform(vec2(NAN, 0.0)), &["WaterFlow::uniform", "NaN"]);
    assert_water_is_refused(WaterFlow { scale: NAN, ..default() }, &["WaterFlow::scale", "NaN"]);
    assert_water_is_refused(Transform::from_xyz(NAN, 0.0, 0.0), &["Transform", "not finite"]);
}

#[test]
fn a_bed_that_does_not_cover_its_water_is_named_once() {
    // Smaller than the water, beside its centre, and across it.
    for (size, place) in [(uvec2(20, 20), Vec3::ZERO), (uvec2(60, 60), Vec3::X * 70.0), (uvec2(10, 90), Vec3::X * 30.0)]
    {
        let mut app = server();
        let water = app.world_mut().spawn(Water::default()).id();
        let bed = WaterBed::from_fn(size, 2.0, |_| -1.0).unwrap();
        let bed = app.world_mut().spawn((bed, Transform::from_translation(place))).id();
        let said = complaints(&mut app, |app| run(app, 10));
        assert_said_once(&said, water, &["Water::size", &format!("bed {bed}")]);
    }
}

#[test]
fn a_bed_elsewhere_is_not_complained_about() {
    let mut app = server();
    app.world_mut().spawn(Water::default());
    let bed = WaterBed::from_fn(uvec2(20, 20), 2.0, |_| -1.0).unwrap();
    app.world_mut().spawn((bed, Transform::from_xyz(200.0, 0.0, 0.0)));
    assert_eq!(complaints(&mut app, |app| run(app, 10)), [""; 0]);
}

#[cfg(feature = "rapier")]
#[test]
fn bodies_of_no_or_infinite_weight_are_named_once() {
    use bevy_rapier3d::prelude::*;
    for (floating, field) in [
        (Floating::with_density(0.0), "Floating::weight (density)"),
        (Floating::with_density(f32::INFINITY), "Floating::weight (density)"),
        (Floating::with_density(NAN), "Floating::weight (density)"),
        (Floating::with_mass(0.0), "Floating::weight (mass)"),
        (Floating::with_mass(f32::INFINITY), "Floating::weight (mass)"),
    ] {
        let mut app = crate::buoyancy::app();
        app.world_mut().spawn((Water::default(), WaterWaves::still()));
        let body =
            app.world_mut().spawn((RigidBody::Dynamic, Collider::ball(0.5), floating, Transform::default())).id();
        let said = complaints(&mut app, |app| run(app, 10));
        assert_said_once(&said, body, &[field]);
        assert!(app.world().get::<Transform>(body).unwrap().translation.is_finite());
    }
}

#[test]
fn water_without_a_camera_is_named_once() {
    let mut stage = Stage::new();
    let water = stage.spawn(Water::default());
    let said = complaints(&mut stage.app, |app| run(app, 55));
    assert_eq!(said, [""; 0], "a camera may still come");
    let said = complaints(&mut stage.app, |app| run(app, 70));
    assert_said_once(&said, water, &["no Camera3d"]);
}

#[test]
fn ground_whose_texture_is_missing_is_named_once_and_plain() {
    let mut stage = Stage::new();
    let mud = Some(stage.app.world().resource::<AssetServer>().load("textures/no_such_texture.png"));
    let shaded = BedShading { level: 2.0, mud, ..default() };
    let bed = stage.spawn((WaterBed::from_fn(uvec2(20, 20), 1.0, |_| 0.0).unwrap(), shaded));
    stage.spawn((DirectionalLight::default(), Transform::default().looking_to(Vec3::NEG_Y, Vec3::X)));
    let above = Transform::from_xyz(0.0, 8.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::NEG_Z);
    let camera = stage.camera(PerspectiveProjection::default(), above);
    let said = complaints(&mut stage.app, |app| {
        // The file is looked for on another thread.
        for _ in 0..50 {
            app.update();
            std::thread::sleep(core::time::Duration::from_millis(2));
        }
    });
    let said: Vec<_> = said.into_iter().filter(|line| line.contains("bevy_freshet")).collect();
    assert_said_once(&said, bed, &["BedShading::mud", "no_such_texture.png"]);
    let ground = stage.picture(camera).at(SIZE.x / 2, SIZE.y / 2);
    assert!(ground.min_element() > 1e-3, "black: {ground}");
}

#[test]
fn without_a_gpu_device_water_is_felt_and_one_warning_says_so() {
    use bevy::ecs::system::RunSystemOnce;
    let no_device = WgpuSettings { backends: None, ..default() };
    let mut app = App::new();
    app.add_plugins((
        DefaultPlugins
            .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
            .set(RenderPlugin { render_creation: RenderCreation::Automatic(Box::new(no_device)), ..default() })
            .disable::<bevy::log::LogPlugin>()
            .disable::<WinitPlugin>(),
        WaterPlugin,
    ));
    let said = complaints(&mut app, |app| {
        app.finish();
        app.cleanup();
        let bed = WaterBed::from_fn(uvec2(60, 60), 2.0, |_| -1.0).unwrap();
        app.world_mut().spawn((bed, BedShading::default()));
        app.world_mut().spawn((Water::default(), WaterWaves::still(), Transform::from_xyz(0.0, 2.0, 0.0)));
        app.world_mut().spawn(Camera3d::default());
        run(app, 10);
    });
    let ours: Vec<_> = said.iter().filter(|line| line.contains("bevy_freshet")).collect();
    assert!(ours.len() == 1 && ours[0].contains("no GPU device"), "{said:#?}");
    let sample = app.world_mut().run_system_once(|water: WaterQuery| water.sample(Vec3::ZERO)).unwrap().unwrap();
    assert_eq!((sample.height, sample.depth), (2.0, 3.0));
}

#[test]
fn a_gpu_that_is_not_there_is_missed_once_and_the_cpu_simulates() {
    for (backend, complaints_expected) in [(SimulationBackend::Gpu, 1), (SimulationBackend::Auto, 0)] {
        let mut app = simulated::server();
        let water = (Water::default(), WaterWaves::still(), WaterSimulation { backend, ..default() });
        let water = app.world_mut().spawn(water).id();
        let said = complaints(&mut app, |app| run(app, 10));
        assert_eq!(said.len(), complaints_expected, "{said:#?}");
        if backend == SimulationBackend::Gpu {
            assert_said_once(&said, water, &["WaterSimulation::backend", "there is no GPU", "the CPU is used"]);
        }
        assert_eq!(app.world().get::<SimulationState>(water).unwrap().backend, SimulationBackend::Cpu);
    }
}

#[test]
fn a_renderer_in_software_is_no_gpu_unless_one_asks_for_it() {
    let mut stage = Stage::new();
    let adapter = stage.app.world().resource::<bevy::render::renderer::RenderAdapterInfo>();
    let is_software = format!("{:?}", adapter.device_type) == "Cpu";
    let automatic = if is_software { SimulationBackend::Cpu } else { SimulationBackend::Gpu };
    use SimulationBackend::{Auto, Cpu, Gpu};
    for (backend, used) in [(Auto, automatic), (Gpu, Gpu), (Cpu, Cpu)] {
        let water = stage.spawn((Water::default(), WaterSimulation { backend, ..default() }));
        stage.run(0.1);
        assert_eq!(stage.app.world().get::<SimulationState>(water).unwrap().backend, used, "{backend:?}");
    }
}
