//! Disturbances, leaks and rain.
use super::{CELL, FRAME, Pond, WINDOW, assert_near, at};
use crate::{
    body::WaterInteraction,
    interaction::{Disturb, DyesWater, absorption_from_color},
    simulation::{FieldWindow, Stroke},
};
use bevy::prelude::*;
use core::f32::consts::PI;
use freshet_hydro::rain::Rain;

#[test]
fn disturbances_reach_their_water() {
    let mut pond = Pond::still();
    let there = pond.world(at(1.5, 0.0, -2.0)).translation;
    let pushed = Disturb::push(there, 0.4, 0.1).with_foam(0.2);
    let far = pond.world(at(15.0, 0.0, 0.0)).translation;
    let nowhere = pond.world(at(50.0, 0.0, 0.0)).translation;
    for disturb in [
        pushed,
        Disturb::dye(there, 0.001, vec3(1.0, 2.0, 3.0), 0.5).on(pond.water),
        Disturb::drop(far, 0.1),
        Disturb::drop(nowhere, 0.1),
        Disturb::drop(Vec3::NAN, 0.1),
        Disturb { volume: f32::NAN, dye: Vec3::splat(-1.0), ..Disturb::at(there, f32::NAN) },
    ] {
        pond.app.world_mut().write_message(disturb);
    }
    let strokes = pond.strokes();
    let [push, dye, bad] = strokes[..] else { panic!("{strokes:?}") };
    assert!(push.place.abs_diff_eq(vec2(1.5, -2.0), 1e-4));
    assert_eq!((push.radius, push.foam), (0.4, 0.2));
    assert_near(push.volume, -2.0 * PI * 0.16 * 0.1, 1e-5, "volume of a dent");
    assert_eq!((dye.dye, dye.volume), (vec3(0.5, 1.0, 1.5), 0.0));
    assert_near(dye.radius, 0.75 * CELL, 1e-5, "narrowest radius");
    assert_eq!((bad.volume, bad.foam, bad.dye), (0.0, 0.0, Vec3::ZERO));
    assert!(bad.radius > 0.0);
    assert_eq!(pond.strokes(), [], "each works once");

    pond.stop_the_clock();
    pond.app.world_mut().write_message(pushed);
    assert_eq!(pond.strokes(), [], "nothing happens while the clock stands still");
}

#[test]
fn bodies_leak_dye_where_they_touch_the_water() {
    let mut pond = Pond::still();
    let source = DyesWater { absorption: vec3(10.0, 20.0, 30.0), rate: 0.06, radius: 0.3 };
    // Afloat with its origin in the air; drowned, without a mesh; high and dry.
    let afloat = pond.body(Cuboid::new(1.0, 1.0, 1.0), at(2.0, 0.4, 1.0));
    pond.app.world_mut().entity_mut(afloat).insert(source);
    for pose in [at(-1.0, -3.0, 0.5), at(-1.0, 0.5, 0.5)] {
        let pose = pond.world(pose);
        pond.app.world_mut().spawn((source, pose));
    }
    let strokes = pond.strokes();
    let mut places: Vec<Vec2> = strokes.iter().map(|stroke| stroke.place).collect();
    places.sort_by(|a, b| a.x.total_cmp(&b.x));
    assert_eq!(places.len(), 2, "{strokes:?}");
    assert!(places[0].abs_diff_eq(vec2(-1.0, 0.5), 1e-4) && places[1].abs_diff_eq(vec2(2.0, 1.0), 1e-4), "{places:?}");
    for stroke in &strokes {
        assert!((stroke.dye - vec3(0.01, 0.02, 0.03)).length() < 1e-6, "{}", stroke.dye);
        assert_eq!((stroke.radius, stroke.volume), (0.3, 0.0));
    }
    pond.stop_the_clock();
    assert_eq!(pond.strokes(), []);
}

#[test]
fn colours_come_back_through_the_liquid() {
    let absorption = absorption_from_color(LinearRgba::rgb(0.5, 0.1, 1.0), 0.2);
    let seen = (-absorption * 0.2).map(f32::exp);
    assert!(seen.abs_diff_eq(vec3(0.5, 0.1, 1.0), 1e-5), "{seen}");
    assert!(absorption_from_color(Color::BLACK, 0.0).is_finite());
}

/// Strokes of `frames` frames of rain at `rate` mm/h.
fn rain(pond: &mut Pond, rate: f32, frames: u32) -> Vec<Stroke> {
    pond.set(WaterInteraction { rain: rate, ..default() });
    (0..frames).flat_map(|_| pond.strokes()).collect()
}

#[test]
fn as_many_drops_fall_as_the_rain_has() {
    // A drizzle of so few drops that each is a stroke.
    let mut pond = Pond::still();
    let window = FieldWindow { first: IVec2::splat(-8), size: UVec2::splat(16), cell: CELL };
    pond.app.world_mut().entity_mut(pond.water).insert(window);
    let (rate, frames) = (0.5, 300);
    let drops = Rain::of_rate(rate).unwrap();
    let strokes = rain(&mut pond, rate, frames);
    let mean = drops.drops * window.extent().element_product() * frames as f32 * FRAME;
    // Five standard deviations of a Poisson count.
    assert!((strokes.len() as f32 - mean).abs() < 5.0 * mean.sqrt(), "{} drops instead of {mean}", strokes.len());
    assert!(strokes.iter().all(|s| (s.volume.abs() / drops.crater_volume - 1.0).abs() < 1e-5));
    let (first, last) = (window.origin(), window.origin() + window.extent());
    assert!(strokes.iter().all(|s| s.place.cmpge(first).all() && s.place.cmple(last).all()));
    // Spread evenly, and as many up as down.
    let centre = strokes.iter().map(|s| s.place).sum::<Vec2>() / strokes.len() as f32;
    let deviation = window.extent().x / (12.0 * strokes.len() as f32).sqrt();
    assert!(centre.length() < 5.0 * deviation, "{centre}");
    let balance: f32 = strokes.iter().map(|s| s.volume.signum()).sum();
    assert!(balance.abs() < 5.0 * (strokes.len() as f32).sqrt(), "{balance}");
}

#[test]
fn a_downpour_keeps_its_energy_in_few_strokes() {
    let mut pond = Pond::still();
    let (rate, frames) = (50.0, 60);
    let strokes = rain(&mut pond, rate, frames);
    assert!(strokes.len() < 300 * frames as usize);
    let drops = Rain::of_rate(rate).unwrap();
    let energy: f32 = strokes.iter().map(|s| s.volume * s.volume).sum();
    let count = drops.drops * WINDOW.extent().element_product() * frames as f32 * FRAME;
    assert_near(energy, count * drops.crater_volume * drops.crater_volume, 0.04, "sum of squares");
}

#[test]
fn rain_repeats_and_stops() {
    let (a, b) = (rain(&mut Pond::still(), 5.0, 3), rain(&mut Pond::still(), 5.0, 3));
    assert_eq!(a, b, "two runs have the same rain");
    let mut pond = Pond::still();
    let frames = [rain(&mut pond, 5.0, 1), rain(&mut pond, 5.0, 1)];
    assert_ne!(frames[0], frames[1], "two frames have not");
    assert_eq!(rain(&mut pond, 0.0, 5), []);
    assert_eq!(rain(&mut pond, f32::NAN, 5), []);
    pond.stop_the_clock();
    assert_eq!(rain(&mut pond, 100.0, 5), [], "no rain while the clock stands still");
}
