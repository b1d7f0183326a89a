//! Heights of many places and the water around swimmers, against samples one by one.
use bevy::{
    ecs::system::RunSystemOnce,
    prelude::*,
    tasks::{ComputeTaskPool, TaskPool},
    time::TimeUpdateStrategy,
    transform::TransformPlugin,
};
use bevy_freshet::{body::Wave, prelude::*};
use core::f32::consts::TAU;
use std::time::{Duration, Instant};

/// An app that only asks the water.
fn app() -> App {
    ComputeTaskPool::get_or_init(TaskPool::default);
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default())).init_asset::<Mesh>();
    app.add_plugins(WaterPlugin).insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    app
}

/// Waves of many lengths whose steepnesses add up to `steepness`.
fn sea(steepness: f32) -> WaterWaves {
    let trains = (0..12).map(|i| Wave {
        direction: Vec2::from_angle(0.5 * i as f32),
        wavelength: 12.0 * 0.7_f32.powi(i),
        steepness: steepness / 12.0,
        phase: 2.4 * i as f32,
    });
    WaterWaves { trains: trains.collect(), fade_depth: 2.0, ..WaterWaves::still() }
}

/// Places all over a water of 60 m × 60 m and beyond it.
fn places(count: usize) -> Vec<Vec3> {
    let at = |i: usize, prime: f32| (i as f32 * prime).fract() * 70.0 - 35.0;
    (0..count).map(|i| vec3(at(i, 0.618_034), 1.0, at(i, 0.754_878))).collect()
}

/// Heights at `places` each within `error`, and those of samples.
fn ask(app: &mut App, places: Vec<Vec3>, error: f32) -> Vec<(Option<f32>, Option<f32>)> {
    let ask = move |water: WaterQuery| {
        let mut heights = vec![Some(f32::NAN); 3];
        water.heights(&places, error, &mut heights);
        assert_eq!(heights.len(), places.len());
        let sampled = places.iter().map(|&place| water.sample(place).map(|sample| sample.height));
        heights.into_iter().zip(sampled).collect::<Vec<_>>()
    };
    app.update();
    app.world_mut().run_system_once(ask).unwrap()
}

/// Largest difference, m, of heights and samples that are there at the same places.
fn worst(found: &[(Option<f32>, Option<f32>)]) -> f32 {
    let wet = found.iter().filter(|(height, _)| height.is_some()).count();
    assert!(wet > found.len() / 4 && wet < found.len());
    let off = found.iter().map(|&(height, sampled)| {
        assert_eq!(height.is_some(), sampled.is_some());
        height.zip(sampled).map_or(0.0, |(height, sampled)| (height - sampled).abs())
    });
    off.fold(0.0, f32::max)
}

/// On open water, over a shelving bed that ends it, beside another water and under ice; turned and moved.
#[test]
fn heights_are_within_the_error_asked_for() {
    for (case, steepness) in
        [("open", 0.2), ("open", 0.6), ("open", 0.8), ("shelving", 0.3), ("two", 0.5), ("ice", 0.3)]
    {
        let mut app = app();
        let pose = Transform::from_xyz(3.0, 1.0, -2.0).with_rotation(Quat::from_rotation_y(0.4));
        let water = app.world_mut().spawn((Water::new(Vec2::splat(60.0)), sea(steepness), pose)).id();
        match case {
            "shelving" => {
                let bed = WaterBed::from_fn(UVec2::splat(90), 1.0, |at| 0.12 * at.x).unwrap();
                app.world_mut().spawn((bed, Transform::from_xyz(3.0, 0.0, -2.0)));
            }
            "two" => {
                _ = app.world_mut().spawn((Water::new(Vec2::splat(30.0)), sea(0.3), Transform::from_xyz(0.0, 1.1, 0.0)))
            }
            "ice" => _ = app.world_mut().entity_mut(water).insert(WaterIce::frozen(0.6)),
            _ => {}
        }
        for error in [1e-3, 1e-2, 1e-1] {
            let worst = worst(&ask(&mut app, places(6000), error));
            println!("{case}, steepness {steepness}: asked for {error} m, {worst} m off");
            assert!(worst <= error, "{case}: {worst} m off, more than {error} m");
        }
        for error in [0.0, -1.0, f32::NAN] {
            assert_eq!(worst(&ask(&mut app, places(500), error)), 0.0, "an error of {error} is none");
        }
    }
}

/// A place has the same height alone and in a batch that many threads share.
#[test]
fn a_batch_is_shared_out_and_stays_the_same() {
    let mut app = app();
    app.world_mut().spawn((Water::new(Vec2::splat(60.0)), sea(0.5)));
    let places = places(5000);
    let together = ask(&mut app, places.clone(), 0.01);
    let alone: Vec<_> = places.chunks(7).flat_map(|few| ask(&mut app, few.to_vec(), 0.01)).collect();
    assert!(together.iter().zip(&alone).all(|(a, b)| a.0 == b.0));
    assert!(ask(&mut app, vec![], 0.01).is_empty());
    assert_eq!(ask(&mut app, vec![Vec3::NAN, Vec3::INFINITY], 0.01), [(None, None); 2]);
}

fn swim(app: &mut App, place: Vec3) -> Option<Submersion> {
    app.update();
    app.world_mut().run_system_once(move |water: WaterQuery| water.swim(place)).unwrap()
}

/// Waves move the water less with depth, as e^(−k d), and not up and down at the bed.
#[test]
fn a_swimmer_feels_waves_fade_with_depth() {
    let mut app = app();
    let wave = Wave { direction: Vec2::X, wavelength: 8.0, steepness: 0.1, phase: 0.7 };
    let waves = WaterWaves { trains: vec![wave], fade_depth: 0.0, ..WaterWaves::still() };
    let pose = Transform::from_xyz(0.0, 2.0, 0.0).with_rotation(Quat::from_rotation_y(0.6));
    let water =
        app.world_mut().spawn((Water::new(Vec2::splat(60.0)), waves, pose, WaterFlow::uniform(vec2(0.4, 0.0)))).id();
    let current = vec3(0.4 * 0.6_f32.cos(), 0.0, -0.4 * 0.6_f32.sin());
    let surface = swim(&mut app, Vec3::ZERO).unwrap().surface;
    for depth in [-0.5, 0.0, 0.3, 1.0, 2.5] {
        let found = swim(&mut app, Vec3::Y * (surface.height - depth)).unwrap();
        let exact = current + (surface.velocity - current) * (-TAU / 8.0 * depth.max(0.0)).exp();
        assert!((found.depth - depth).abs() < 1e-5 && found.above_bed == f32::INFINITY);
        assert!(found.velocity.abs_diff_eq(exact, 1e-4), "{depth} m: {} instead of {exact}", found.velocity);
        assert_eq!(found.is_under_water(), found.depth > 0.0);
    }
    assert!((surface.velocity - current).length() > 0.1, "there are waves");

    let bed = WaterBed::from_fn(UVec2::splat(80), 1.0, |_| 0.5).unwrap();
    app.world_mut().spawn(bed);
    let at_bed = swim(&mut app, Vec3::Y * 0.5).unwrap();
    assert!(at_bed.above_bed.abs() < 1e-5 && at_bed.velocity.y.abs() < 1e-4, "{at_bed:?}");
    assert!((swim(&mut app, Vec3::ZERO).unwrap().above_bed + 0.5).abs() < 1e-5, "in the ground");

    app.world_mut().entity_mut(water).insert(WaterIce { thickness: 0.4, ..WaterIce::frozen(1.0) });
    let below_ice = |app: &mut App, depth: f32| {
        let level = swim(app, Vec3::ZERO).unwrap().surface.height;
        swim(app, Vec3::Y * (level - depth)).unwrap()
    };
    let (within, under) = (below_ice(&mut app, 0.05), below_ice(&mut app, 0.6));
    assert!(within.surface.ice > 0.1 && !within.is_under_water(), "{within:?}");
    assert!(under.is_under_water() && under.velocity.length() < 1e-6, "{under:?}");
    assert_eq!(swim(&mut app, vec3(100.0, 0.0, 0.0)), None);
}

/// What a place costs. `cargo test … what_heights_cost -- --ignored --nocapture`.
#[test]
#[ignore = "measures"]
fn what_heights_cost() {
    println!("| waves | asked | ns per place | of a sample |\n|---|---|---|---|");
    for (name, waves) in [("wind of 3 m/s", WaterWaves::default()), ("12 trains, steepness 0.4", sea(0.4))] {
        let mut app = app();
        app.world_mut().spawn((Water::new(Vec2::splat(100.0)), waves));
        app.update();
        let measure = move |water: WaterQuery| {
            let places = places(100_000);
            let per_place = |time: Instant| time.elapsed().as_nanos() as f64 / places.len() as f64;
            let begun = Instant::now();
            let sum: f32 = places.iter().filter_map(|&place| water.sample(place)).map(|sample| sample.height).sum();
            let sample = per_place(begun);
            println!("| {name} | `sample` | {sample:.0} | 1 (Σ {sum}) |");
            let mut heights = Vec::with_capacity(places.len());
            for error in [1e-3, 1e-2, 1e-1] {
                let begun = Instant::now();
                places.chunks(200).for_each(|few| water.heights(few, error, &mut heights));
                let alone = per_place(begun);
                let begun = Instant::now();
                water.heights(&places, error, &mut heights);
                let shared = per_place(begun);
                println!(
                    "| {name} | {error} m | {alone:.0}, shared {shared:.0} | {:.2}, {:.2} |",
                    alone / sample,
                    shared / sample
                );
            }
        };
        app.world_mut().run_system_once(measure).unwrap();
    }
}
