//! Water that the GPU simulates: when its device is lost, beside other waters, and while others read it.
use crate::{
    running::{Falling, START, app_on, state},
    simulated::{all_at, at, basin, run},
    stage::{Hurried, Stage, still_water},
    waves::LEVEL,
};
use bevy::{
    prelude::*,
    render::{
        Render, RenderApp, RenderStartup, RenderSystems,
        error_handler::{RenderErrorHandler, RenderErrorPolicy},
        render_resource::PollType,
        renderer::{RenderDevice, RenderQueue},
    },
};
use bevy_freshet::prelude::*;
use std::time::{Duration, Instant};

/// Levels (m, world) at the middles of the cells of 1 m of a water of `size` (m) at world `x`; nothing where it is dry.
fn levels(app: &mut App, x: f32, size: Vec2) -> Vec<Option<f32>> {
    let cells = size.as_uvec2();
    let place = |i: u32| uvec2(i % cells.x, i / cells.x).as_vec2() + 0.5 - 0.5 * size;
    let places = (0..cells.element_product()).map(|i| place(i) + vec2(x, 0.0));
    all_at(app, places.collect()).into_iter().map(|sample| sample.map(|sample| sample.height)).collect()
}

/// The most by which levels differ, m; those of dry places count as equal.
fn apart(a: &[Option<f32>], b: &[Option<f32>]) -> f32 {
    let off = a.iter().zip(b).map(|(a, b)| match (a, b) {
        (Some(a), Some(b)) => (a - b).abs(),
        (None, None) => 0.0,
        _ => f32::INFINITY,
    });
    off.fold(0.0, f32::max)
}

/// Runs until `water` has simulated `time` (s).
fn run_until(app: &mut App, water: Entity, time: f64) {
    while state(app, water).time < time - 1e-4 {
        app.update();
    }
    assert!((state(app, water).time - time).abs() < 1e-4);
}

/// A frame, after which the water is where it was or later, and all of it is there.
fn frame(falling: &mut Falling) {
    let before = falling.state();
    falling.app.update();
    let now = falling.state();
    assert!(now.time >= before.time && now.late > before.late - 1e-5, "{now:?} after {before:?}");
    assert!(now.error().abs() < 1e-6 * now.volume, "{} m³ of {} m³", now.error(), now.volume);
}

/// In the render app: how many devices the engine has begun with.
#[derive(Resource)]
struct Devices(u32);

/// Lets the engine make another device if one is lost, and counts them.
fn recover(app: &mut App) {
    app.insert_resource(RenderErrorHandler(|_, _, _| RenderErrorPolicy::Recover(default())));
    let render_app = app.sub_app_mut(RenderApp);
    render_app.insert_resource(Devices(0));
    render_app.add_systems(RenderStartup, |mut devices: ResMut<Devices>| devices.0 += 1);
}

/// Destroys the device, and returns the number of frames until the engine has made another one; each is `frame`.
fn lose_device<T>(of: &mut T, app: impl Fn(&T) -> &App, mut frame: impl FnMut(&mut T)) -> u32 {
    let devices = |app: &App| app.sub_app(RenderApp).world().resource::<Devices>().0;
    let before = devices(app(of));
    let lost = app(of).world().resource::<RenderDevice>();
    lost.wgpu_device().destroy();
    lost.poll(PollType::wait_indefinitely()).unwrap();
    for frames in 1..2000 {
        frame(of);
        if devices(app(of)) > before {
            return frames;
        }
        // No frame is drawn meanwhile, and the engine makes the device beside them.
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("there is no other device");
}

/// The loss is a real one: the device is destroyed, the engine notices, makes another one and runs `RenderStartup` again.
#[test]
fn a_water_outlives_the_device_that_simulates_it() {
    let source = WaterSource { at: vec2(6.0, 2.0), radius: 2.0, rate: 3.0.into() };
    let sources = WaterSources { sources: vec![source] };
    let mut falling = Falling::on(SimulationBackend::Gpu);
    falling.app.world_mut().entity_mut(falling.water).insert(sources.clone());
    recover(&mut falling.app);
    run(&mut falling.app, 1.0);
    for _ in 0..2 {
        let before = falling.state();
        let without = lose_device(&mut falling, |falling| &falling.app, frame);
        (0..60).for_each(|_| frame(&mut falling));
        let now = falling.state();
        println!("{without} frames without a device: {} s, then {} s and {} s late", before.time, now.time, now.late);
        assert!(now.time > before.time + 0.5 && now.backend == SimulationBackend::Gpu, "{now:?}");
        // No time is lost: what is not simulated makes it late. It begins again some frames after the device is there.
        let gone = now.time + now.late - before.time - before.late;
        let asked = f64::from(without + 60) / 60.0;
        assert!(gone <= asked && gone > asked - 0.1, "{gone} s of {asked} s");
    }
    falling.settings().paused = true;
    let state = falling.calm();
    let found = levels(&mut falling.app, 0.0, Vec2::splat(20.0));
    let mut twin = Falling::on(SimulationBackend::Cpu);
    twin.app.world_mut().entity_mut(twin.water).insert(sources);
    run_until(&mut twin.app, twin.water, state.time);
    let off = apart(&found, &levels(&mut twin.app, 0.0, Vec2::splat(20.0)));
    println!("{off:e} m from a water that has lost nothing, {:e} m³ too much", state.error());
    assert!(off < 1e-4, "{off}");
}

#[test]
fn the_picture_outlives_the_device_too() {
    let mut stage = Stage::new();
    recover(&mut stage.app);
    stage.paint(Sphere::new(0.5), LinearRgba::RED, Transform::from_xyz(2.0, LEVEL, 0.0));
    let (.., surface, optics) = still_water(Vec2::ZERO);
    stage.spawn((
        basin(WaterSimulation { start: START, backend: SimulationBackend::Gpu, ..default() }),
        WaterSurface { view: SurfaceView::Height, ..surface },
        optics,
    ));
    stage.settle();
    stage.run(0.5);
    let camera = stage.camera_above(vec3(0.0, LEVEL, 0.0), 6.0);
    let before = stage.picture(camera);
    lose_device(&mut stage, |stage| &stage.app, |stage| stage.app.update());
    assert!(stage.picture(camera).bits() == before.bits(), "while the clock stands still the water does");
    stage.run(0.5);
    assert!(stage.picture(camera).bits() != before.bits(), "and then it falls on");
}

/// Sizes (m), starts and places (world x) of three waters.
fn three() -> [(Vec2, SimulationStart, f32); 3] {
    let column = |at, reach| SimulationStart::Column { at, half_size: Vec2::splat(reach), level: 0.0 };
    [
        (vec2(40.0, 30.0), column(vec2(-12.0, 5.0), 9.0), 0.0),
        (vec2(1.0, 30.0), column(vec2(0.0, -10.0), 8.0), 50.0),
        (vec2(12.0, 20.0), SimulationStart::Dry, 100.0),
    ]
}

/// State and levels of those of the three waters that are `asked` for, after two seconds; or after as long as `times` say.
fn together(backend: SimulationBackend, asked: &[usize], times: &[f64]) -> Vec<(SimulationState, Vec<Option<f32>>)> {
    let mut app = app_on(backend);
    let waters = asked.iter().map(|&i| {
        let (size, start, x) = three()[i];
        let settings = WaterSimulation { start, backend, ..default() };
        app.world_mut()
            .spawn((Water::new(size), WaterWaves::still(), settings, Transform::from_xyz(x, LEVEL, 0.0)))
            .id()
    });
    let waters: Vec<_> = waters.collect();
    if times.is_empty() {
        run(&mut app, 2.0);
    }
    waters.iter().zip(times).for_each(|(&water, &time)| run_until(&mut app, water, time));
    for &water in &waters {
        app.world_mut().get_mut::<WaterSimulation>(water).unwrap().paused = true;
    }
    run(&mut app, 0.5);
    let found = asked.iter().zip(&waters).map(|(&i, &water)| {
        let (size, _, x) = three()[i];
        (state(&app, water), levels(&mut app, x, size))
    });
    found.collect()
}

#[test]
fn waters_that_are_simulated_at_once_do_not_know_of_each_other() {
    let all = together(SimulationBackend::Gpu, &[0, 1, 2], &[]);
    let times: Vec<f64> = all.iter().map(|(state, _)| state.time).collect();
    let twins = together(SimulationBackend::Cpu, &[0, 1, 2], &times);
    for (i, (state, levels)) in all.iter().enumerate() {
        let alone = together(SimulationBackend::Gpu, &[i], &[]);
        let (off, twin) = (apart(levels, &alone[0].1), apart(levels, &twins[i].1));
        println!("{} cells, {} s: {off:e} m from alone, {twin:e} m from the CPU's", state.cells, state.time);
        assert_eq!((state, levels), (&alone[0].0, &alone[0].1), "it is as if it were alone");
        assert!(state.time > 1.5 && twin < 1e-4, "{twin}");
    }
    assert_eq!(
        all.iter().map(|(state, _)| state.cells).collect::<Vec<_>>(),
        [uvec2(40, 30), uvec2(1, 30), uvec2(12, 20)]
    );
    assert!(all[2].1.iter().all(Option::is_none), "what is dry stays dry");
}

/// Frames wait for the GPU as those of a window do: for what was asked two frames ago.
fn as_in_a_window(app: &mut App) {
    let mut asked = std::collections::VecDeque::new();
    let wait = move |device: Res<RenderDevice>, queue: Res<RenderQueue>| {
        asked.push_back(queue.submit([]));
        if asked.len() > 2 {
            device.poll(PollType::Wait { submission_index: asked.pop_front(), timeout: None }).unwrap();
        }
    };
    let render_app = app.sub_app_mut(RenderApp);
    render_app.insert_resource(Hurried);
    render_app.add_systems(Render, wait.in_set(RenderSystems::PostCleanup).ambiguous_with_all());
}

/// A wide basin in which a column falls, on the GPU.
fn wide(app: &mut App, cells: f32) -> Entity {
    let start = SimulationStart::Column { at: Vec2::ZERO, half_size: Vec2::splat(cells / 4.0), level: 0.0 };
    let settings = WaterSimulation { start, backend: SimulationBackend::Gpu, ..default() };
    app.world_mut().spawn(basin(settings)).insert(Water::new(Vec2::splat(cells))).id()
}

/// How many frames old the state is that is known of a water that runs.
fn age_in_frames(app: &mut App, water: Entity) -> f32 {
    while state(app, water).time < 0.5 {
        app.update();
    }
    let ages: Vec<f32> = (0..20)
        .map(|_| {
            app.update();
            let sample = at(app, 0.0, 0.0).unwrap();
            assert!(sample.height.is_finite() && sample.age == state(app, water).age, "{sample:?}");
            60.0 * sample.age
        })
        .collect();
    assert!(ages.iter().all(|age| (age - ages[0]).abs() < 1e-3), "{ages:?}");
    ages[0]
}

/// A copy comes back when the device is asked for news, which here nobody does but the submission of the next frame: if something
/// waited for it, the state would be as young as it is where the test itself waits at the end of every frame.
#[test]
fn nothing_waits_for_the_state_that_is_read() {
    let ages = [false, true].map(|hurried| {
        let mut falling = Falling::on(SimulationBackend::Gpu);
        if hurried {
            falling.app.sub_app_mut(RenderApp).insert_resource(Hurried);
        }
        age_in_frames(&mut falling.app, falling.water)
    });
    println!("{} frames old where somebody waits for it, {} where nobody does", ages[0], ages[1]);
    assert!((ages[0] - 1.0).abs() < 1e-3 && ages[1] > 1.999, "{ages:?}");
}

/// Whether something reads the water in every fixed step.
#[derive(Resource)]
struct Reads(bool);

fn read(reads: Res<Reads>, water: WaterQuery) {
    if reads.0 {
        let heights = (0..64).filter_map(|i| water.sample(vec3(2.0 * i as f32 - 64.0, LEVEL, i as f32)));
        std::hint::black_box(heights.map(|sample| sample.height).sum::<f32>());
    }
}

#[test]
#[ignore = "measures"]
fn what_reading_costs() {
    let mut app = app_on(SimulationBackend::Gpu);
    as_in_a_window(&mut app);
    app.insert_resource(Reads(false)).add_systems(FixedUpdate, read);
    let water = wide(&mut app, 256.0);
    run(&mut app, 1.0);
    println!("{:>8} {:>12} {:>12} {:>8}", "block", "unread", "read", "ratio");
    let mut spent = [Vec::new(), Vec::new()];
    for block in 0..40 {
        for reads in [false, true] {
            app.insert_resource(Reads(reads));
            for _ in 0..10 {
                let start = Instant::now();
                app.update();
                spent[usize::from(reads)].push(start.elapsed());
            }
        }
        if block % 8 == 7 {
            let [unread, read] = spent.each_mut().map(|spent| median(spent));
            println!("{:>8} {unread:>12.2?} {read:>12.2?} {:>8.4}", block + 1, read.div_duration_f64(unread));
        }
    }
    let [unread, read] = spent.each_mut().map(|spent| median(spent));
    assert!(state(&app, water).time > 1.0 && read < unread.mul_f32(1.03), "{read:?} of {unread:?}");
}

fn median(spent: &mut [Duration]) -> Duration {
    spent.sort();
    spent[spent.len() / 2]
}
