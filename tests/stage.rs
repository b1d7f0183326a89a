//! A small headless scene whose pixels are read back as linear radiance.
use bevy::{
    app::PluginsState,
    camera::{Hdr, RenderTarget, ScalingMode},
    core_pipeline::tonemapping::Tonemapping,
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
use bevy_freshet::prelude::*;
use std::time::Duration;

/// Size of the pictures that tests measure.
pub const SIZE: UVec2 = UVec2::new(320, 180);

/// An app that draws to pictures.
pub struct Stage {
    pub app: App,
}

/// Linear radiance of every pixel.
pub struct Picture {
    pub size: UVec2,
    texels: Vec<Vec4>,
}

impl Picture {
    pub fn at(&self, x: u32, y: u32) -> Vec3 {
        self.texels[(y * self.size.x + x) as usize].truncate()
    }

    /// Every pixel with its colour.
    pub fn pixels(&self) -> impl Iterator<Item = (UVec2, Vec3)> {
        self.texels
            .iter()
            .enumerate()
            .map(|(i, texel)| (uvec2(i as u32 % self.size.x, i as u32 / self.size.x), texel.truncate()))
    }

    /// The pixels' bits, for comparing pictures exactly.
    pub fn bits(&self) -> Vec<[u32; 4]> {
        self.texels.iter().map(|texel| texel.to_array().map(f32::to_bits)).collect()
    }
}

#[derive(Resource, Default)]
struct Taken(Option<Image>);

/// In the render app: no frame waits for what the GPU has been asked for.
#[derive(Resource)]
pub struct Hurried;

fn wait_for_gpu(device: Res<RenderDevice>) {
    device.poll(PollType::wait_indefinitely()).unwrap();
}

impl Stage {
    /// An empty scene: no light, black clear colour, the clock standing still.
    pub fn new() -> Self {
        Self::with(|app| _ = app.add_plugins(WaterPlugin))
    }

    /// An empty scene with the plugins that `build` adds.
    pub fn with(build: impl FnOnce(&mut App)) -> Self {
        let mut app = App::new();
        app.add_plugins(
            DefaultPlugins
                .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
                .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() })
                .set(AssetPlugin { file_path: "../../assets".into(), ..default() })
                .disable::<PipelinedRenderingPlugin>()
                .disable::<bevy::log::LogPlugin>()
                .disable::<WinitPlugin>(),
        )
        .insert_resource(ClearColor(Color::BLACK))
        .insert_resource(GlobalAmbientLight::NONE)
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO))
        .init_resource::<Taken>();
        build(&mut app);
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            let wait = wait_for_gpu.run_if(not(resource_exists::<Hurried>)).in_set(RenderSystems::PostCleanup);
            render_app.add_systems(Render, wait.ambiguous_with_all());
        }
        while app.plugins_state() == PluginsState::Adding {
            bevy::tasks::tick_global_task_pools_on_main_thread();
        }
        app.finish();
        app.cleanup();
        Self { app }
    }

    pub fn spawn(&mut self, bundle: impl Bundle) -> Entity {
        self.app.world_mut().spawn(bundle).id()
    }

    /// A camera that draws linear radiance to a picture of its own.
    pub fn camera(&mut self, projection: impl Into<Projection>, pose: Transform) -> Entity {
        let target = self.target(SIZE);
        self.spawn((
            Camera3d::default(),
            (Hdr, Tonemapping::None, Msaa::Off),
            RenderTarget::Image(target.into()),
            projection.into(),
            pose,
        ))
    }

    /// A camera 20 m over `center` that looks straight down at a stretch of `width` metres, x to the right and z down.
    pub fn camera_above(&mut self, center: Vec3, width: f32) -> Entity {
        let projection = OrthographicProjection {
            scaling_mode: ScalingMode::FixedHorizontal { viewport_width: width },
            far: 100.0,
            ..OrthographicProjection::default_3d()
        };
        let pose = Transform::from_translation(center + Vec3::Y * 20.0).looking_to(Vec3::NEG_Y, Vec3::NEG_Z);
        self.camera(Projection::Orthographic(projection), pose)
    }

    pub fn target(&mut self, size: UVec2) -> Handle<Image> {
        let image = Image::new_target_texture(size.x, size.y, TextureFormat::Rgba16Float, None);
        self.app.world_mut().resource_mut::<Assets<Image>>().add(image)
    }

    /// A thing of one colour that no light changes.
    pub fn paint(&mut self, mesh: impl Into<Mesh>, color: LinearRgba, pose: Transform) -> Entity {
        let world = self.app.world_mut();
        let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
        let material = StandardMaterial { base_color: color.into(), unlit: true, ..default() };
        let material = world.resource_mut::<Assets<StandardMaterial>>().add(material);
        self.spawn((Mesh3d(mesh), MeshMaterial3d(material), pose))
    }

    /// Runs until nothing waits for a shader any more.
    pub fn settle(&mut self) {
        let mut calm = 0;
        for _ in 0..600 {
            self.app.update();
            let cache = self.app.sub_app(RenderApp).world().resource::<PipelineCache>();
            calm = if cache.waiting_pipelines().next().is_none() { calm + 1 } else { 0 };
            if calm > 5 {
                return;
            }
        }
        panic!("pipelines are still waiting");
    }

    /// Lets the clock run by `seconds` in steps of 1/60 s.
    pub fn run(&mut self, seconds: f64) {
        for _ in 0..(seconds * 60.0).round() as u32 {
            self.step(1.0 / 60.0);
        }
    }

    /// One frame of `seconds`.
    pub fn step(&mut self, seconds: f64) {
        self.app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(seconds)));
        self.app.update();
        self.app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    }

    /// What a camera sees now.
    pub fn picture(&mut self, camera: Entity) -> Picture {
        self.settle();
        let target = self.app.world().get::<RenderTarget>(camera).unwrap().as_image().unwrap().clone();
        self.app.world_mut().spawn(Screenshot::image(target)).observe(
            |captured: On<ScreenshotCaptured>, mut taken: ResMut<Taken>| taken.0 = Some(captured.image.clone()),
        );
        for _ in 0..20 {
            self.app.update();
            if let Some(image) = self.app.world_mut().resource_mut::<Taken>().0.take() {
                return linear(&image);
            }
        }
        panic!("no picture came back");
    }

    /// Where a camera sees a world position, in pixels.
    pub fn project(&self, camera: Entity, position: Vec3) -> Vec2 {
        let world = self.app.world();
        let pose = world.get::<GlobalTransform>(camera).unwrap();
        world.get::<Camera>(camera).unwrap().world_to_viewport(pose, position).unwrap()
    }
}

fn linear(image: &Image) -> Picture {
    assert_eq!(image.texture_descriptor.format, TextureFormat::Rgba16Float);
    let half = |bytes: &[u8]| half::f16::from_le_bytes([bytes[0], bytes[1]]).to_f32();
    let texel = |t: &[u8]| vec4(half(&t[0..2]), half(&t[2..4]), half(&t[4..6]), half(&t[6..8]));
    Picture { size: image.size(), texels: image.data.as_ref().unwrap().chunks_exact(8).map(texel).collect() }
}

/// Water that is a perfect mirror and lets nothing through.
pub fn still_water(size: Vec2) -> (Water, WaterWaves, WaterSurface, WaterOptics) {
    let surface = WaterSurface { ripples: 0.0, sunlight: false, ..default() };
    let optics = WaterOptics { edge_depth: 0.0, absorption: Vec3::ZERO, backscatter: Vec3::ZERO, ..default() };
    (Water::new(size), WaterWaves::still(), surface, optics)
}
