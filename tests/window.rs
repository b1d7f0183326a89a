//! The panel in a real window, worked by real input: a slider is dragged with the pointer, and setting and picture follow.
//!
//! Runs under its own X server, Xvfb, with xdotool for hands. Where these are missing it says so and passes.
#![expect(clippy::unwrap_used, reason = "a test may fail by panicking")]

use bevy::{
    camera::RenderTarget,
    core_pipeline::tonemapping::Tonemapping,
    prelude::*,
    render::view::screenshot::{Screenshot, ScreenshotCaptured},
    window::WindowResolution,
};
use bevy_egui::{PrimaryEguiContext, input::EguiWantsInput};
use bevy_freshet::{panel::*, prelude::*, reflection::MirrorCamera};
use std::{
    collections::VecDeque,
    env,
    path::Path,
    process::{Child, Command, ExitCode, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

/// Pixels of the window.
const SIZE: UVec2 = UVec2::new(640, 360);
/// Longest time for the whole script.
const PATIENCE: Duration = Duration::from_secs(240);
/// Tells the process that it is the one with the window.
const INSIDE: &str = "FRESHET_WINDOW_TEST";

fn main() -> ExitCode {
    if env::var_os(INSIDE).is_some() {
        return inside();
    }
    // What cargo asks every test binary.
    if env::args().any(|arg| arg == "--list") {
        return ExitCode::SUCCESS;
    }
    if !cfg!(target_os = "linux") || !["Xvfb", "xdotool"].into_iter().all(is_there) {
        println!("the panel in a window: skipped, as it needs Xvfb and xdotool (`cargo xtask test` installs them)");
        return ExitCode::SUCCESS;
    }
    let (mut server, display) = start_server();
    let status = Command::new(env::current_exe().unwrap()).env("DISPLAY", display).env(INSIDE, "1").status();
    server.kill().unwrap();
    server.wait().unwrap();
    if status.unwrap().success() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn is_there(program: &str) -> bool {
    env::split_paths(&env::var_os("PATH").unwrap_or_default()).any(|folder| folder.join(program).is_file())
}

/// An X server of our own, on the first display that is free.
fn start_server() -> (Child, String) {
    for number in 90..120 {
        let socket = format!("/tmp/.X11-unix/X{number}");
        if Path::new(&socket).exists() {
            continue;
        }
        let screen = format!("{}x{}x24", SIZE.x, SIZE.y);
        let mut server = Command::new("Xvfb")
            .args([&format!(":{number}"), "-screen", "0", &screen, "-nolisten", "tcp"])
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        for _ in 0..100 {
            sleep(Duration::from_millis(100));
            if Path::new(&socket).exists() {
                return (server, format!(":{number}"));
            }
            // Another test was faster.
            if server.try_wait().unwrap().is_some() {
                break;
            }
        }
        _ = server.kill();
        server.wait().unwrap();
    }
    panic!("no X server could be started");
}

/// The app with the window and the script that works it.
fn inside() -> ExitCode {
    let resolution = WindowResolution::new(SIZE.x, SIZE.y).with_scale_factor_override(1.0);
    let window = Window { title: "panel".into(), resolution, position: WindowPosition::At(IVec2::ZERO), ..default() };
    let exit = App::new()
        .add_plugins((
            DefaultPlugins.set(WindowPlugin { primary_window: Some(window), ..default() }),
            WaterPlugin,
            WaterPanelPlugin::default(),
        ))
        .insert_resource(ClearColor(Color::srgb(0.5, 0.7, 0.9)))
        .insert_resource(Script {
            step: 0,
            start: Instant::now(),
            inputs: default(),
            calm: 0,
            pictures: Vec::new(),
            time: 0.0,
        })
        .add_systems(Startup, setup)
        .add_systems(Update, run_script)
        .run();
    match exit {
        AppExit::Success => ExitCode::SUCCESS,
        AppExit::Error(_) => ExitCode::FAILURE,
    }
}

/// The water before a camera of the window, and a second camera that draws to a picture and was there first.
fn setup(mut commands: Commands, mut images: ResMut<Assets<Image>>) {
    let picture = images.add(Image::new_target_texture(
        32,
        32,
        bevy::render::render_resource::TextureFormat::Rgba8UnormSrgb,
        None,
    ));
    commands.spawn((
        Camera3d::default(),
        Camera { order: -5, ..default() },
        RenderTarget::Image(picture.into()),
        NoWater,
    ));
    commands.spawn((Water::default(), WaterOptics { absorption: Vec3::splat(0.1), ..default() }, WaterWaves::still()));
    commands.spawn((DirectionalLight::default(), Transform::default().looking_to(vec3(-0.5, -1.0, -0.4), Vec3::Y)));
    commands.spawn((
        Camera3d::default(),
        Tonemapping::None,
        Transform::from_xyz(0.0, 3.0, 8.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
}

#[derive(Resource)]
struct Script {
    step: usize,
    start: Instant,
    /// Arguments of xdotool, one call after the other.
    inputs: VecDeque<Vec<String>>,
    /// Frames since the last input.
    calm: u32,
    pictures: Vec<Image>,
    /// Simulated time before a step.
    time: f64,
}

/// Frames between inputs, so that the panel sees each of them by itself.
const GAP: u32 = 3;
/// Frames after which the effect of an input is looked for: groups open and close with an animation that moves what is
/// below, and a pipeline may have to be compiled.
const SETTLE: u32 = 10;

/// What is done and expected, one step after the other. A step is asked again until what it waits for is there.
const STEPS: [fn(&mut World, &mut Script) -> Option<()>; 14] = [
    |world, script| {
        // The window may not be on the screen yet when its first frames are drawn.
        (script.start.elapsed() > Duration::from_secs(2)).then_some(())?;
        let switches = place(world, "Switches")?;
        assert_context_is_on_window(world);
        script.click(switches.center());
        Some(())
    },
    |world, _| place(world, "reflection").map(|_| take_picture(world)),
    // A tick with the pointer: the reflection goes out of the picture.
    |world, script| {
        (script.pictures.len() == 1).then_some(())?;
        assert_eq!(reflectivity(world), 1.0);
        let tick = place(world, "reflection")?;
        script.click(tick.min + vec2(8.0, 0.5 * tick.height()));
        Some(())
    },
    |world, _| (reflectivity(world) == 0.0).then(|| take_picture(world)),
    // The group is closed again, so that the slider is in sight.
    |world, script| {
        (script.pictures.len() == 2).then_some(())?;
        assert_picture_changed(&script.pictures[0], &script.pictures[1]);
        save(&script.pictures[1]);
        script.click(place(world, "Switches")?.center());
        Some(())
    },
    |world, script| {
        place(world, "reflection").is_none().then_some(())?;
        script.click(place(world, "Optics")?.center());
        Some(())
    },
    |world, script| {
        let slider = place(world, "Reflectivity")?;
        let at = |x: f32| slider.min + vec2(x, 0.5 * slider.height());
        script.drag(at(4.0), at(104.0));
        Some(())
    },
    |world, _| {
        (reflectivity(world) > 0.8).then_some(())?;
        assert!(world.resource::<WaterTouchBlocked>().0, "the hand that works the panel does not touch the water");
        take_picture(world);
        Some(())
    },
    |world, script| {
        (script.pictures.len() == 3).then_some(())?;
        assert_picture_changed(&script.pictures[1], &script.pictures[2]);
        assert!(place(world, "Simulation").is_none(), "the water is not simulated yet");
        let water = world.query_filtered::<Entity, With<Water>>().single(world).unwrap();
        world.entity_mut(water).insert(WaterSimulation::default());
        Some(())
    },
    // The water is simulated, paused, and taken a step further.
    |world, script| {
        (simulated(world).1.time > 0.0).then_some(())?;
        script.click(place(world, "Simulation")?.center());
        Some(())
    },
    |world, script| {
        script.click(place(world, "Pause simulation")?.center());
        Some(())
    },
    |world, script| {
        let (settings, state) = simulated(world);
        (settings.paused && state.steps == 0).then_some(())?;
        script.time = state.time;
        script.click(place(world, "Step simulation")?.center());
        Some(())
    },
    |world, script| {
        let step = simulated(world).1.time - script.time;
        (step > 0.0).then_some(())?;
        // 45 % of a metre at the speed of waves on 2 m of water.
        assert!((step - 0.45 / (9.81_f64 * 2.0).sqrt()).abs() < 1e-4, "{step} s");
        script.key("F1");
        Some(())
    },
    // Hidden, it takes no input.
    |world, _| {
        (!world.resource::<WaterPanel>().visible).then_some(())?;
        assert!(place(world, "Optics").is_none());
        let egui = world.resource::<EguiWantsInput>();
        assert!(!egui.wants_any_input(), "{egui:?}");
        assert!(!world.resource::<WaterTouchBlocked>().0);
        Some(())
    },
];

/// Hands out the inputs one by one, and goes through the steps.
fn run_script(world: &mut World) {
    world.resource_scope(|world, mut script: Mut<Script>| {
        assert!(script.start.elapsed() < PATIENCE, "step {} does not end", script.step);
        script.calm += 1;
        if script.calm >= GAP
            && let Some(input) = script.inputs.pop_front()
        {
            xdotool(&input);
            script.calm = 0;
        }
        if script.calm < SETTLE || !script.inputs.is_empty() {
            return;
        }
        let Some(step) = STEPS.get(script.step) else {
            println!("the panel in a window: {:.1} s", script.start.elapsed().as_secs_f32());
            world.write_message(AppExit::Success);
            return;
        };
        if step(world, &mut script).is_some() {
            (script.step, script.calm) = (script.step + 1, 0);
        }
    });
}

fn place(world: &World, label: &str) -> Option<Rect> {
    world.resource::<WaterPanel>().place(label)
}

fn assert_context_is_on_window(world: &mut World) {
    let mut contexts = world.query_filtered::<(&RenderTarget, Has<MirrorCamera>), With<PrimaryEguiContext>>();
    let contexts: Vec<_> = contexts.iter(world).collect();
    assert!(matches!(contexts[..], [(RenderTarget::Window(_), false)]), "{contexts:?}");
    let mut mirrors = world.query_filtered::<(), With<MirrorCamera>>();
    assert_eq!(mirrors.iter(world).count(), 1, "there is a mirror that could have been taken");
}

fn reflectivity(world: &mut World) -> f32 {
    world.query::<&WaterOptics>().single(world).unwrap().reflectivity
}

fn simulated(world: &mut World) -> (WaterSimulation, SimulationState) {
    let (settings, state) = world.query::<(&WaterSimulation, &SimulationState)>().single(world).unwrap();
    (settings.clone(), *state)
}

fn xdotool(args: &[String]) {
    assert!(Command::new("xdotool").args(args).status().unwrap().success(), "{args:?}");
}

impl Script {
    fn input(&mut self, args: &[&str]) {
        self.inputs.push_back(args.iter().map(ToString::to_string).collect());
    }

    fn point(&mut self, place: Vec2) {
        self.input(&["mousemove", &place.x.round().to_string(), &place.y.round().to_string()]);
    }

    /// Goes to a place. A pointer that already is there would send no event.
    fn approach(&mut self, place: Vec2) {
        self.point(place - vec2(0.0, 3.0));
        self.point(place);
    }

    fn click(&mut self, place: Vec2) {
        self.approach(place);
        // Press and release at once: what takes longer than 0.8 s is no click, however slow the frames are.
        self.input(&["click", "1"]);
    }

    fn drag(&mut self, from: Vec2, to: Vec2) {
        self.approach(from);
        self.input(&["mousedown", "1"]);
        for i in 1..=4 {
            self.point(from.lerp(to, i as f32 / 4.0));
        }
        self.input(&["mouseup", "1"]);
    }

    /// Without a window manager nobody gives the window the keyboard.
    fn key(&mut self, name: &str) {
        self.input(&["search", "--name", "^panel$", "windowfocus", "key", name]);
    }
}

fn take_picture(world: &mut World) {
    world.spawn(Screenshot::primary_window()).observe(
        |captured: On<ScreenshotCaptured>, mut script: ResMut<Script>| script.pictures.push(captured.image.clone()),
    );
}

/// The water, right of the panel in the lower half, must have changed; the sky above must not.
fn assert_picture_changed(before: &Image, after: &Image) {
    let difference = |x: u32, y: u32| {
        let [before, after] = [before, after].map(|image| image.get_color_at(x, y).unwrap().to_linear().to_vec3());
        (before - after).abs().max_element()
    };
    let water = (0..10).map(|i| difference(SIZE.x - 60 + 5 * i, SIZE.y - 60)).sum::<f32>() / 10.0;
    assert!(water > 0.02, "the water is the same: {water}");
    let sky = difference(SIZE.x - 40, 10);
    assert!(sky < 0.01, "the sky has changed: {sky}");
}

/// Keeps the picture where `FRESHET_WINDOW_PICTURE` says, for looking at.
fn save(picture: &Image) {
    if let Some(path) = env::var_os("FRESHET_WINDOW_PICTURE") {
        picture.clone().try_into_dynamic().unwrap().to_rgb8().save(path).unwrap();
    }
}
