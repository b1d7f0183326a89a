//! What the examples share: the command line, and an app with a window or, with `--out`, one that writes a picture.
use bevy::{
    app::PluginsState,
    camera::RenderTarget,
    prelude::*,
    render::{
        Render, RenderApp, RenderPlugin, RenderSystems,
        pipelined_rendering::PipelinedRenderingPlugin,
        render_resource::{PipelineCache, PollType, TextureFormat},
        renderer::RenderDevice,
        view::screenshot::{Screenshot, ScreenshotCaptured},
    },
    time::TimeUpdateStrategy,
    window::ExitCondition,
    winit::WinitPlugin,
};
use clap::Parser;
use std::{
    path::PathBuf,
    time::{Duration, Instant},
};

/// An example of bevy_freshet: in a window, or, with --out, into a picture.
#[derive(Parser, Resource, Clone, Debug)]
pub struct Options {
    /// Frames of 1/60 s to run before the picture is taken.
    #[arg(long, default_value_t = 120, value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: u32,
    /// Width and height of the picture, pixels.
    #[arg(long, default_value = "960x540", value_parser = size)]
    pub size: UVec2,
    /// Write a picture (PNG) here instead of opening a window.
    #[arg(long, value_parser = picture)]
    pub out: Option<PathBuf>,
    /// Which of the example's cameras to look through.
    #[arg(long)]
    pub camera: Option<String>,
    /// Seed of everything random.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

/// A size in pixels as it is typed: `960x540`.
pub fn size(text: &str) -> Result<UVec2, String> {
    let parse = || {
        let (width, height) = text.split_once('x')?;
        Some(uvec2(width.parse().ok()?, height.parse().ok()?))
    };
    parse()
        .filter(|size| (1..=8192).contains(&size.min_element()) && size.max_element() <= 8192)
        .ok_or_else(|| format!("expected WIDTHxHEIGHT between 1x1 and 8192x8192, found {text:?}"))
}

/// Where a picture can be written.
fn picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(".".as_ref());
    if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("png")) {
        return Err("expected a file that ends in .png".into());
    }
    if !folder.is_dir() {
        return Err(format!("there is no folder {}", folder.display()));
    }
    if path.is_dir() {
        return Err("this is a folder".into());
    }
    Ok(path)
}

/// Whether a window can be opened; other systems than Linux always have a display.
fn has_display() -> bool {
    let names = ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"];
    !cfg!(target_os = "linux") || names.iter().any(|name| std::env::var_os(name).is_some_and(|value| !value.is_empty()))
}

/// Ends the program with one line that says what is wrong.
pub fn fail(problem: impl core::fmt::Display) -> ! {
    eprintln!("error: {problem}");
    std::process::exit(2)
}

/// Length of a frame without a window, s: headless runs do not follow the wall clock, so that they repeat.
pub const FRAME: f64 = 1.0 / 60.0;

/// Assets to wait for before the first frame counts.
#[derive(Resource, Default)]
pub struct Loading(pub Vec<UntypedHandle>);

/// The target of the camera: a picture, or nothing for the window.
#[derive(Resource, Clone, Default)]
pub struct Canvas(Option<Handle<Image>>);

impl Canvas {
    /// A component for the example's camera.
    pub fn target(&self) -> RenderTarget {
        self.0.clone().map_or_else(RenderTarget::default, |image| RenderTarget::Image(image.into()))
    }
}

/// An app with Bevy's plugins: in a window, or drawing to a picture if `--out` was given.
pub fn app(title: &str, options: &Options) -> App {
    let mut app = App::new();
    let assets = AssetPlugin { file_path: "../../assets".into(), ..default() };
    if options.out.is_none() {
        if !has_display() {
            fail("there is no display for a window; --out FILE.png writes a picture instead");
        }
        let resolution = options.size.into();
        let window = Window { title: title.into(), resolution, ..default() };
        app.add_plugins(DefaultPlugins.set(assets).set(WindowPlugin { primary_window: Some(window), ..default() }));
        app.insert_resource(Canvas::default());
    } else {
        let windows = WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() };
        app.add_plugins(
            DefaultPlugins
                .set(assets)
                .set(windows)
                .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() })
                .disable::<PipelinedRenderingPlugin>()
                .disable::<WinitPlugin>(),
        )
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app.add_systems(Render, wait_for_gpu.in_set(RenderSystems::PostCleanup).ambiguous_with_all());
        }
        let target = Image::new_target_texture(options.size.x, options.size.y, TextureFormat::Rgba8UnormSrgb, None);
        let target = app.world_mut().resource_mut::<Assets<Image>>().add(target);
        app.insert_resource(Canvas(Some(target)));
    }
    app.init_resource::<Loading>().insert_resource(options.clone()).insert_resource(Time::<Fixed>::from_seconds(FRAME));
    app
}

/// Without a window nothing else keeps the CPU from running ahead of the GPU.
fn wait_for_gpu(device: Res<RenderDevice>) {
    if let Err(error) = device.poll(PollType::wait_indefinitely()) {
        error!("the GPU does not answer: {error}");
    }
}

/// Runs the app: in its window, or for the asked number of frames and a picture.
pub fn run(mut app: App) -> AppExit {
    let options = app.world().resource::<Options>().clone();
    let Some(out) = &options.out else { return app.run() };
    start(&mut app);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(FRAME)));
    let mut milliseconds: Vec<f64> = (0..options.frames)
        .map(|_| {
            let start = Instant::now();
            app.update();
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    milliseconds.sort_by(f64::total_cmp);
    if let Some(median) = milliseconds.get(milliseconds.len() / 2) {
        println!("{} frames of {}x{}, median {median:.1} ms", options.frames, options.size.x, options.size.y);
    }
    let saved = screenshot(&mut app).and_then(|picture| picture.save(out).map_err(|error| error.to_string()));
    match saved {
        Ok(()) => AppExit::Success,
        Err(problem) => {
            error!("{}: {problem}", out.display());
            AppExit::error()
        }
    }
}

/// Starts an app without a window, up to its first frame with everything loaded.
pub fn start(app: &mut App) {
    while app.plugins_state() == PluginsState::Adding {
        bevy::tasks::tick_global_task_pools_on_main_thread();
    }
    app.finish();
    app.cleanup();
    warm_up(app);
}

/// Most frames to wait for assets and shaders.
const WARM_UP: u32 = 2000;

/// Runs with the clock standing still until all assets are there and no pipeline waits for a shader.
fn warm_up(app: &mut App) {
    let mut calm = 0;
    for _ in 0..WARM_UP {
        app.update();
        let world = app.world();
        let assets = world.resource::<AssetServer>();
        let loaded = world.resource::<Loading>().0.iter().all(|handle| {
            let state = assets.load_state(handle);
            state.is_loaded() || state.is_failed()
        });
        let compiled = app
            .get_sub_app(RenderApp)
            .is_none_or(|render| render.world().resource::<PipelineCache>().waiting_pipelines().next().is_none());
        calm = if loaded && compiled { calm + 1 } else { 0 };
        // New pipelines may be asked for a few frames after the last texture arrived.
        if calm > 8 {
            return;
        }
    }
    warn!("not everything was loaded after {WARM_UP} frames");
}

/// The picture once it has come back from the GPU.
#[derive(Resource, Default)]
struct Taken(Option<Image>);

/// What the camera sees, once it has come back from the GPU; no time passes.
///
/// # Errors
/// That there is no picture.
pub fn screenshot(app: &mut App) -> Result<image::RgbImage, String> {
    let Some(target) = app.world().resource::<Canvas>().0.clone() else { return Err("there is no canvas".into()) };
    app.init_resource::<Taken>();
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    app.world_mut()
        .spawn(Screenshot::image(target))
        .observe(|captured: On<ScreenshotCaptured>, mut taken: ResMut<Taken>| taken.0 = Some(captured.image.clone()));
    for _ in 0..20 {
        app.update();
        if let Some(image) = app.world_mut().resource_mut::<Taken>().0.take() {
            return image.try_into_dynamic().map(|picture| picture.to_rgb8()).map_err(|error| error.to_string());
        }
    }
    Err("no picture came back; is there a GPU device?".into())
}
