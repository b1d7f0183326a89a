//! The project's real river, loaded and asked as a game does.
use bevy::{ecs::system::RunSystemOnce, prelude::*};
use bevy_freshet::prelude::*;
use std::path::Path;

/// World height of the river, m.
const LEVEL: f32 = 0.8;
/// What the flow map was made for, m³/s.
const DISCHARGE: f32 = 25.0;
/// Distance of the places at which a section is measured, m.
const STEP: f32 = 0.1;

/// Asks `question` of the river's [`WaterQuery`].
fn ask<T: 'static>(question: impl FnOnce(&WaterQuery) -> T + Send + Sync + 'static) -> T {
    let terrain = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/terrain");
    let bed = WaterBed::from_file(terrain.join("tidal_river_2m.asc")).unwrap();
    let flow = WaterFlow::from_file(terrain.join("tidal_river_flow.png")).unwrap();
    let size = bed.elevations().size().as_vec2() * bed.elevations().cell_size();
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, WaterPlugin));
    app.world_mut().spawn(bed);
    app.world_mut().spawn((Water::new(size), WaterWaves::still(), flow, Transform::from_xyz(0.0, LEVEL, 0.0)));
    app.finish();
    app.cleanup();
    app.update();
    let mut question = Some(question);
    app.world_mut().run_system_once(move |water: WaterQuery| question.take().unwrap()(&water)).unwrap()
}

/// Depth and velocity at a place; none on land.
fn at(water: &WaterQuery, place: Vec2) -> Option<(f32, Vec2)> {
    let sample = water.sample(vec3(place.x, LEVEL, place.y))?;
    Some((sample.depth, sample.velocity.xz()))
}

/// Places from `middle` towards `direction` until the land.
fn to_the_bank<'a>(
    water: &'a WaterQuery,
    middle: Vec2,
    direction: Vec2,
) -> impl Iterator<Item = (Vec2, f32, Vec2)> + 'a {
    (0..2000).map_while(move |i| {
        let place = middle + direction * ((i as f32 + 0.5) * STEP);
        at(water, place).map(|(depth, velocity)| (place, depth, velocity))
    })
}

/// Points of a way with the current, 60 m apart.
fn way_downstream(water: &WaterQuery) -> Vec<Vec2> {
    let mut place = vec2(-42.0, -80.0);
    let mut points = Vec::new();
    for i in 0..6000 {
        let Some((_, velocity)) = at(water, place).filter(|(_, velocity)| velocity.length() > 0.05) else { break };
        if i % 240 == 0 {
            points.push(place);
        }
        place += velocity.normalize() * 0.25;
    }
    points
}

#[test]
fn every_section_of_the_river_carries_its_discharge() {
    let sections = ask(|water| {
        let points = way_downstream(water);
        let discharge = |&middle: &Vec2| {
            let along = at(water, middle).unwrap().1.normalize();
            let through = |(_, depth, velocity): (Vec2, f32, Vec2)| velocity.dot(along) * depth * STEP;
            let half = |direction: Vec2| to_the_bank(water, middle, direction).map(through).sum::<f32>();
            (middle, half(along.perp()) + half(-along.perp()))
        };
        points.iter().map(discharge).collect::<Vec<_>>()
    });
    assert!(sections.len() >= 8, "the way ends early: {sections:?}");
    for (middle, discharge) in sections {
        println!("{middle}: {discharge} m³/s");
        assert!((discharge / DISCHARGE - 1.0).abs() < 0.05, "{middle}: {discharge} m³/s");
    }
}

/// The waterline between a `wet` place and a `dry` one.
fn waterline(water: &WaterQuery, mut wet: Vec2, mut dry: Vec2) -> Vec2 {
    for _ in 0..20 {
        let middle = wet.midpoint(dry);
        *if at(water, middle).is_some() { &mut wet } else { &mut dry } = middle;
    }
    wet
}

#[test]
fn the_river_stands_still_at_its_banks() {
    let banks = ask(|water| {
        let banks = way_downstream(water).into_iter().flat_map(|middle| {
            let across = at(water, middle).unwrap().1.normalize().perp();
            [across, -across].map(|direction| {
                let (last, ..) = to_the_bank(water, middle, direction).last().unwrap();
                let place = waterline(water, last, last + direction * STEP);
                (place, at(water, place).unwrap())
            })
        });
        // Deep water ends where the terrain's data does: that is no bank.
        banks.filter(|(_, (depth, _))| *depth < 0.01).collect::<Vec<_>>()
    });
    assert!(banks.len() >= 40, "{} banks", banks.len());
    for (place, (depth, velocity)) in banks {
        assert!(velocity.length() < 1e-3, "{place}: {velocity} m/s at a depth of {depth} m");
    }
}
