//! Bodies where waters lie above one another.
use crate::buoyancy::{LEVEL, app, assert_near, body, read, run};
use bevy::{ecs::system::RunSystemOnce, prelude::*};
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use freshet_hydro::waves::WATER_DENSITY;

/// Level of the pond that hangs over the lake, m.
const POND: f32 = LEVEL + 12.0;

/// A pond of 20 m, 3 m deep, over a lake of 400 m, 6 m deep, with their beds: lake and pond.
fn terraces(app: &mut App) -> [Entity; 2] {
    [(LEVEL, 400.0, 6.0), (POND, 20.0, 3.0)].map(|(level, size, depth)| {
        let bed = WaterBed::from_fn(UVec2::splat(42), size / 40.0, |_| 0.0).unwrap();
        app.world_mut().spawn((bed, Transform::from_xyz(0.0, level - depth, 0.0)));
        let pose = Transform::from_xyz(0.0, level, 0.0);
        app.world_mut().spawn((Water::new(Vec2::splat(size)), WaterWaves::still(), pose)).id()
    })
}

/// Balls let go in the pond, beside it, and in the air between its bed and the lake.
#[test]
fn a_ball_floats_in_the_water_that_it_falls_into() {
    let mut app = app();
    let [lake, pond] = terraces(&mut app);
    let places = [vec3(2.0, POND + 1.0, 2.0), vec3(15.0, POND + 1.0, 0.0), vec3(-4.0, POND - 5.0, 3.0)];
    let balls = places.map(|place| {
        let ball = app.world_mut().spawn(body(Collider::ball(0.4), Floating::default(), 0.0)).id();
        app.world_mut().get_mut::<Transform>(ball).unwrap().translation = place;
        ball
    });
    run(&mut app, 40.0);
    let heights = balls.map(|ball| read::<Transform>(&app, ball).translation.y);
    for (found, level) in heights.into_iter().zip([POND, LEVEL, LEVEL]) {
        assert!((found - level).abs() < 5e-3, "{heights:?}");
    }

    let depths = [(1.0, pond, 1.0), (3.2, pond, 3.2), (5.0, lake, -7.0), (13.0, lake, 1.0), (17.5, lake, 5.5)];
    for (below_pond, water, depth) in depths {
        let place = vec3(1.0, POND - below_pond, 1.0);
        let found = app.world_mut().run_system_once(move |water: WaterQuery| water.swim(place)).unwrap().unwrap();
        assert_eq!(found.surface.water, water, "{below_pond} m below the pond");
        assert_near(found.depth, depth, 1e-5, "depth");
        let above_bed = if water == pond { 3.0 - below_pond } else { 18.0 - below_pond };
        assert!((found.above_bed - above_bed).abs() < 1e-4, "{} {above_bed}", found.above_bed);
        assert_eq!(found.is_under_water(), depth > 0.0);
    }
}

/// A raft at the pond's brim floats on the pond alone: where that ends there is none under it, and not the lake.
#[test]
fn a_raft_at_the_brim_is_in_one_water() {
    let mut app = app();
    let [_, pond] = terraces(&mut app);
    let raft = app.world_mut().spawn(body(Collider::cuboid(2.0, 0.25, 2.0), Floating::default(), 0.0)).id();
    let axes = LockedAxes::ROTATION_LOCKED | LockedAxes::TRANSLATION_LOCKED_X;
    app.world_mut().entity_mut(raft).insert((axes, Transform::from_xyz(8.9, POND, 0.0)));
    run(&mut app, 20.0);
    let height = read::<Transform>(&app, raft).translation.y;
    // 3.1 of its 4 m are carried, as deep as that takes; where the water ends is known to a fraction of a place of the lattice.
    let draft = 0.5 * 500.0 / WATER_DENSITY * 4.0 / 3.1;
    let found = POND - (height - 0.25);
    println!("draft {found:.3} m at the brim, {draft:.3} m by what is over the pond");
    assert!((found / draft - 1.0).abs() < 0.1);
    assert!(app.world().get_entity(pond).is_ok());
}
