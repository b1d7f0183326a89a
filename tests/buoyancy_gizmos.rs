//! Debug drawing of floating bodies, measured in pictures.

use crate::{
    buoyancy::{LEVEL, is_asleep},
    stage::{Picture, Stage, still_water},
};
use bevy::{camera::ScalingMode, prelude::*};
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;

/// Half the size of the box, m; it floats by half.
const HALF: Vec3 = Vec3::new(1.5, 0.4, 0.6);

/// What nothing else in the picture has.
const WATERLINE: Color = Color::LinearRgba(LinearRgba::rgb(0.0, 1.0, 0.0));

/// A box at rest on still water, seen from the side in a picture 8 m wide.
struct Scene {
    stage: Stage,
    camera: Entity,
    body: Entity,
}

impl Scene {
    fn new(floating: Floating) -> Self {
        let mut stage = Stage::with(|app| {
            app.insert_resource(TimestepMode::Fixed { dt: 1.0 / 60.0, substeps: 1 })
                .insert_resource(Time::<Fixed>::from_hz(60.0))
                .add_plugins((WaterPlugin, RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule()));
        });
        stage.spawn((still_water(Vec2::splat(60.0)), Transform::from_xyz(0.0, LEVEL, 0.0)));
        let body = stage.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(HALF.x, HALF.y, HALF.z),
            floating,
            Transform::from_xyz(0.0, LEVEL, 0.0),
        ));
        let projection = OrthographicProjection {
            scaling_mode: ScalingMode::FixedHorizontal { viewport_width: 8.0 },
            ..OrthographicProjection::default_3d()
        };
        let pose = Transform::from_xyz(0.0, LEVEL + 0.5, 10.0);
        let camera = stage.camera(Projection::Orthographic(projection), pose);
        stage.run(0.2);
        Self { stage, camera, body }
    }

    /// Draws nothing but waterlines, of all bodies or only of those that ask for it.
    fn only_waterlines(&mut self, draw_all: bool) {
        let mut store = self.stage.app.world_mut().resource_mut::<GizmoConfigStore>();
        let (_, gizmos) = store.config_mut::<BuoyancyGizmos>();
        *gizmos = BuoyancyGizmos {
            draw_all,
            waterline: Some(WATERLINE),
            buoyancy: None,
            resistance: None,
            weight: None,
            center_of_buoyancy: None,
            metacenter: None,
            ..default()
        };
    }

    /// Where the picture has the waterline's colour.
    fn drawn(&mut self) -> Vec<UVec2> {
        green(&self.stage.picture(self.camera))
    }

    /// Where a place of the world is in the picture.
    fn pixel(&self, place: Vec3) -> Vec2 {
        self.stage.project(self.camera, place)
    }
}

fn green(picture: &Picture) -> Vec<UVec2> {
    picture.pixels().filter(|(_, color)| color.y > 0.5 && color.x + color.z < 0.2).map(|(pixel, _)| pixel).collect()
}

/// From the side the four lines are one: from end to end of the box, at the level of the water and nowhere else.
#[test]
fn the_waterline_is_drawn_where_the_box_meets_the_water() {
    let mut scene = Scene::new(Floating::with_density(499.0));
    scene.only_waterlines(true);
    let drawn = scene.drawn();
    let [from, to] = [-1.0, 1.0].map(|side| scene.pixel(vec3(side * HALF.x, LEVEL, HALF.z)));
    for x in from.x.ceil() as u32 + 1..to.x as u32 - 1 {
        assert!(drawn.iter().any(|pixel| pixel.x == x), "nothing at x = {x}");
    }
    for pixel in drawn {
        let off = (pixel.as_vec2() + 0.5 - from).y.abs();
        assert!(off < 2.0, "{pixel} is {off} pixels off the level");
        assert!((from.x - 2.0..to.x + 2.0).contains(&(pixel.x as f32)), "{pixel} is beyond the box");
    }
}

/// Off without having been asked for; one body on its own; off again.
#[test]
fn nothing_is_drawn_that_is_not_switched_on() {
    let mut scene = Scene::new(Floating::with_density(499.0));
    let plain = scene.stage.picture(scene.camera).bits();
    scene.only_waterlines(false);
    assert!(scene.stage.picture(scene.camera).bits() == plain);
    scene.stage.app.world_mut().entity_mut(scene.body).insert(ShowBuoyancyGizmo::default());
    assert!(!scene.drawn().is_empty());
    scene.stage.app.world_mut().resource_mut::<GizmoConfigStore>().config_mut::<BuoyancyGizmos>().0.enabled = false;
    assert!(scene.stage.picture(scene.camera).bits() == plain);
}

/// The waterline is that of the hull, whatever finds the forces, and stays while the body sleeps.
#[test]
fn every_model_and_a_sleeper_show_their_waterline() {
    for model in [BuoyancyModel::Voxels { per_axis: 4 }, BuoyancyModel::Samples { spacing: 0.2 }] {
        let mut scene = Scene::new(Floating { model, ..Floating::with_density(499.0) });
        scene.only_waterlines(true);
        assert!(!scene.drawn().is_empty(), "{model:?}");
    }
    let mut scene = Scene::new(Floating::with_density(499.0));
    scene.only_waterlines(true);
    scene.stage.run(20.0);
    assert!(is_asleep(&mut scene.stage.app, scene.body));
    assert!(!scene.drawn().is_empty());
}

#[test]
fn a_body_in_the_air_has_nothing_drawn() {
    let mut scene = Scene::new(Floating::with_density(499.0));
    scene.stage.app.world_mut().resource_mut::<GizmoConfigStore>().config_mut::<BuoyancyGizmos>().1.draw_all = true;
    let afloat = scene.stage.picture(scene.camera).bits();
    scene.stage.app.world_mut().get_mut::<Transform>(scene.body).unwrap().translation.y = LEVEL + 50.0;
    scene.stage.run(0.1);
    let away = scene.stage.picture(scene.camera).bits();
    scene.stage.app.world_mut().resource_mut::<GizmoConfigStore>().config_mut::<BuoyancyGizmos>().1.draw_all = false;
    assert!(afloat != away && away == scene.stage.picture(scene.camera).bits());
}

/// Arrows along the vertical through the middle: the weight down from the centre of mass, as long as the hull's length, and the push up
/// as far from the centre of buoyancy.
#[test]
fn arrows_have_the_length_of_their_forces() {
    let mut scene = Scene::new(Floating::with_density(499.0));
    scene.only_waterlines(true);
    let length = (8.0 * HALF.element_product()).cbrt();
    for (weight, buoyancy, from, way) in [(Some(WATERLINE), None, 0.0, -length), (None, Some(WATERLINE), -0.2, length)]
    {
        let mut store = scene.stage.app.world_mut().resource_mut::<GizmoConfigStore>();
        let gizmos = store.config_mut::<BuoyancyGizmos>().1;
        (gizmos.waterline, gizmos.weight, gizmos.buoyancy) = (None, weight, buoyancy);
        let drawn = scene.drawn();
        let rows = drawn.iter().map(|pixel| pixel.y as f32 + 0.5);
        let (top, bottom) = (rows.clone().fold(f32::INFINITY, f32::min), rows.fold(0.0, f32::max));
        let [start, end] = [from, from + way].map(|height| scene.pixel(Vec3::Y * (LEVEL + height)).y);
        assert!((top - start.min(end)).abs() < 3.0, "{top} instead of {start} or {end}");
        assert!((bottom - start.max(end)).abs() < 3.0, "{bottom} instead of {start} or {end}");
    }
}

#[test]
fn settings_that_nothing_can_be_drawn_with_do_no_harm() {
    let mut scene = Scene::new(Floating::with_density(499.0));
    let mut store = scene.stage.app.world_mut().resource_mut::<GizmoConfigStore>();
    *store.config_mut::<BuoyancyGizmos>().1 =
        BuoyancyGizmos { draw_all: true, force_scale: f32::NAN, marker_size: f32::NEG_INFINITY, ..default() };
    let picture = scene.stage.picture(scene.camera);
    assert!(picture.pixels().all(|(_, color)| color.is_finite()));
}

/// A server has no gizmos: the switch is there all the same, and bodies float.
#[test]
fn a_server_without_gizmos_floats_bodies() {
    let mut app = crate::buoyancy::app();
    let world = app.world_mut();
    world.spawn((Water::new(Vec2::splat(60.0)), WaterWaves::still(), Transform::from_xyz(0.0, LEVEL, 0.0)));
    let body = crate::buoyancy::body(Collider::ball(0.5), Floating::default(), 0.0);
    let body = world.spawn((body, ShowBuoyancyGizmo::default())).id();
    crate::buoyancy::run(&mut app, 1.0);
    assert!(app.world().get::<Buoyancy>(body).unwrap().force.y > 0.0);
    assert!(!app.world().contains_resource::<GizmoConfigStore>());
}
