//! What lands in the deposits of a water, against bodies and rain in closed form.
mod bodies;
mod strokes;

use super::{DisturbsWater, InteractionPlugin};
use crate::{
    body::{BodyPlugin, Water, WaterInteraction, WaterWaves},
    simulation::{Deposits, FieldWindow, SilhouetteCell, Stroke},
};
use bevy::{prelude::*, time::TimeUpdateStrategy, transform::TransformPlugin};
use core::time::Duration;

const CELL: f32 = 0.1;
const LEVEL: f32 = 1.3;
const FRAME: f32 = 1.0 / 60.0;
/// A window of 12.8 m × 12.8 m in the middle of the water.
const WINDOW: FieldWindow = FieldWindow { first: IVec2::splat(-64), size: UVec2::splat(128), cell: CELL };
/// Water that is neither at the origin nor aligned with the world.
const PLACE: Vec3 = vec3(31.0, LEVEL, -17.0);
const YAW: f32 = 0.7;

struct Pond {
    app: App,
    water: Entity,
}

impl Pond {
    fn new(waves: WaterWaves) -> Self {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default()))
            .init_asset::<Mesh>()
            .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(FRAME)))
            .add_plugins((BodyPlugin, InteractionPlugin));
        app.finish();
        app.cleanup();
        let pose = Transform::from_translation(PLACE).with_rotation(Quat::from_rotation_y(YAW));
        let water = app.world_mut().spawn((Water::new(Vec2::splat(40.0)), waves, WINDOW, pose)).id();
        app.update();
        Self { app, water }
    }

    fn still() -> Self {
        Self::new(WaterWaves::still())
    }

    /// A body of `mesh` at `pose` in the frame of the water.
    fn body(&mut self, mesh: impl Into<Mesh>, pose: Transform) -> Entity {
        let mesh = self.app.world_mut().resource_mut::<Assets<Mesh>>().add(mesh);
        let bundle = (DisturbsWater, Mesh3d(mesh), self.world(pose));
        self.app.world_mut().spawn(bundle).id()
    }

    fn world(&self, pose: Transform) -> Transform {
        *self.app.world().get::<Transform>(self.water).unwrap() * pose
    }

    fn deposits(&mut self) -> Deposits {
        self.app.update();
        self.app.world().get::<Deposits>(self.water).unwrap().clone()
    }

    fn cells(&mut self) -> Vec<SilhouetteCell> {
        self.deposits().silhouettes
    }

    fn strokes(&mut self) -> Vec<Stroke> {
        let strokes = self.deposits().strokes;
        // There is no step here that takes them.
        self.app.world_mut().entity_mut(self.water).insert(Deposits::default());
        strokes
    }

    fn set(&mut self, interaction: WaterInteraction) {
        self.app.world_mut().entity_mut(self.water).insert(interaction);
    }

    fn stop_the_clock(&mut self) {
        self.app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    }
}

fn assert_near(found: f32, exact: f32, share: f32, what: &str) {
    assert!((found - exact).abs() <= share * exact.abs(), "{what}: {found} instead of {exact}");
}

fn at(x: f32, y: f32, z: f32) -> Transform {
    Transform::from_xyz(x, y, z)
}
