//! Simulated water that is paused, taken step by step and begun anew, and what it says of itself: on either backend.
use crate::{
    said::complaints,
    simulated::{at, basin, run, server},
    stage::Stage,
    waves::LEVEL,
};
use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_freshet::{body::Balance, prelude::*};
use std::time::Duration;

/// A column that falls in a basin of 20 m × 20 m.
pub const START: SimulationStart =
    SimulationStart::Column { at: vec2(-10.0, 0.0), half_size: vec2(10.0, 20.0), level: 0.0 };
/// Its volume, m³.
const VOLUME: f64 = 10.0 * 20.0 * 2.0;

/// An app in which a column falls, and its water.
pub struct Falling {
    pub app: App,
    pub water: Entity,
    backend: SimulationBackend,
}

/// A server, or an app with a renderer for the GPU; a frame is a fixed step of 1/60 s.
pub fn app_on(backend: SimulationBackend) -> App {
    if backend != SimulationBackend::Gpu {
        return server();
    }
    let mut stage = Stage::new();
    stage.settle();
    let step = Duration::from_secs_f64(1.0 / 60.0);
    stage.app.insert_resource(Time::<Fixed>::from_duration(step));
    stage.app.insert_resource(TimeUpdateStrategy::ManualDuration(step));
    stage.app
}

pub fn state(app: &App, water: Entity) -> SimulationState {
    *app.world().get::<SimulationState>(water).unwrap()
}

impl Falling {
    pub fn on(backend: SimulationBackend) -> Self {
        let mut app = app_on(backend);
        let water = app.world_mut().spawn(basin(WaterSimulation { start: START, backend, ..default() })).id();
        Self { app, water, backend }
    }

    pub fn settings(&mut self) -> Mut<'_, WaterSimulation> {
        self.app.world_mut().get_mut::<WaterSimulation>(self.water).unwrap()
    }

    pub fn state(&self) -> SimulationState {
        state(&self.app, self.water)
    }

    /// Runs for so long that whatever is on its way has come back.
    pub fn calm(&mut self) -> SimulationState {
        run(&mut self.app, 0.5);
        self.state()
    }
}

fn on_both(test: impl Fn(Falling)) {
    for backend in [SimulationBackend::Cpu, SimulationBackend::Gpu] {
        test(Falling::on(backend));
    }
}

#[test]
fn a_water_that_is_paused_stands_still_and_owes_nothing_for_it() {
    on_both(|mut falling| {
        run(&mut falling.app, 1.0);
        falling.settings().paused = true;
        let before = falling.calm();
        assert!(before.time > 0.5 && before.backend == falling.backend, "{before:?}");
        let sample = at(&mut falling.app, 1.0, 0.0);
        run(&mut falling.app, 2.0);
        assert_eq!(falling.state(), before);
        assert!(sample.is_some() && at(&mut falling.app, 1.0, 0.0) == sample);
        assert_eq!((before.steps, before.age), (0, 0.0));
        falling.settings().paused = false;
        run(&mut falling.app, 0.5);
        let gone = falling.state().time - before.time;
        assert!(gone > 0.3 && gone < 0.51, "nothing is made up for: {gone} s");
        assert!(falling.state().late < 0.06, "{:?}", falling.state());
    });
}

#[test]
fn a_step_takes_the_time_of_one_step() {
    on_both(|mut falling| {
        run(&mut falling.app, 1.0);
        falling.app.world_mut().trigger(StepSimulation(falling.water));
        falling.settings().paused = true;
        let paused = falling.calm();
        let volume = paused.volume;
        for _ in 0..3 {
            let before = falling.state();
            falling.app.world_mut().trigger(StepSimulation(falling.water));
            let after = falling.calm();
            let step = after.time - before.time;
            // 0.45 of a cell for the fastest signal, which is somewhere between that on 1 m and that of the front of 2 m.
            assert!((0.04..0.15).contains(&step), "{step}");
            // What the Courant number allowed; on the CPU the newest step.
            let allowed = if after.backend == SimulationBackend::Gpu { 0.9999 * before.step } else { after.step };
            assert!((step - allowed).abs() < 1e-5 * step, "{step} s of {allowed} s");
            assert!((after.volume - volume).abs() < 1e-6 * volume && after.error().abs() < 1e-6 * volume, "{after:?}");
        }
        let before = falling.state();
        for _ in 0..4 {
            falling.app.world_mut().trigger(StepSimulation(falling.water));
        }
        let four = falling.calm().time - before.time;
        assert!((0.16..0.6).contains(&four), "{four}");
    });
}

#[test]
fn a_reset_brings_the_start_back() {
    on_both(|mut falling| {
        run(&mut falling.app, 2.0);
        let fallen = falling.state();
        assert!(fallen.time > 1.0);
        falling.settings().paused = true;
        falling.app.world_mut().trigger(ResetSimulation(falling.water));
        let state = falling.calm();
        assert_eq!((state.time, state.late, state.steps), (0.0, 0.0, 0), "{state:?}");
        assert_eq!((state.volume, state.error()), (VOLUME, 0.0));
        assert_eq!(state.balance, Balance { before: VOLUME, ..default() });
        assert_eq!(at(&mut falling.app, 1.0, 0.0), None, "the column has not fallen");
        assert!((at(&mut falling.app, -1.0, 0.0).unwrap().height - LEVEL).abs() < 1e-6);
        falling.settings().paused = false;
        run(&mut falling.app, 2.0);
        let again = falling.state();
        // It falls as before; on the GPU some frames later or earlier.
        assert!((again.time - fallen.time).abs() < 0.2, "{again:?} after {fallen:?}");
        assert!(at(&mut falling.app, 1.0, 0.0).is_some());
    });
}

#[test]
fn a_new_start_begins_anew_on_both() {
    on_both(|mut falling| {
        run(&mut falling.app, 1.0);
        falling.settings().start = SimulationStart::Dry;
        let state = falling.calm();
        assert_eq!((state.volume, state.balance), (0.0, Balance::default()));
        assert_eq!(at(&mut falling.app, -9.0, 0.0), None);
        // As many cells as before in one direction would fit into the old buffers; more do not.
        falling.settings().start = SimulationStart::Still;
        falling.settings().cell_size = 0.5;
        let state = falling.calm();
        assert_eq!((state.cells, state.cell_size, state.volume), (uvec2(40, 40), 0.5, 2.0 * VOLUME));
    });
}

#[test]
fn the_book_of_volumes_closes() {
    on_both(|mut falling| {
        let part = |side, edge| WaterEdge::all(side, edge);
        let sources = vec![
            WaterSource { at: vec2(3.0, 2.0), radius: 2.0, rate: 3.0.into() },
            WaterSource { at: vec2(-3.0, -6.0), radius: 1.0, rate: (-0.5).into() },
        ];
        let parts = vec![part(DomainSide::East, Edge::Open), part(DomainSide::West, Edge::Discharge(2.0.into()))];
        let mut water = falling.app.world_mut().entity_mut(falling.water);
        water.insert((WaterEdges { parts, ..default() }, WaterSources { sources }));
        falling.settings().rain = 500.0;
        run(&mut falling.app, 5.0);
        let state = falling.state();
        let Balance { before, rain, sources, left: [west, east, north, south] } = state.balance;
        assert_eq!((before, north, south), (VOLUME, 0.0, 0.0));
        let near = |value: f64, expected: f64| (value - expected).abs() < 1e-3 * expected.abs();
        // 500 mm/h on 400 m², and 2 m³/s from the west.
        assert!(near(rain, 400.0 * 0.5 / 3600.0 * state.time), "{state:?}");
        assert!(near(west, -2.0 * state.time) && east > 1.0, "{state:?}");
        // The drain takes what it asks for, or less.
        assert!((2.499..=3.0).contains(&(sources / state.time)), "{state:?}");
        let passed = rain + sources - west + east;
        assert!(state.error().abs() < 1e-5 * passed, "{} m³ of {passed} m³", state.error());
        println!("{:?}: {:e} m³ of {passed} m³ in {} s", falling.backend, state.error(), state.time);
    });
}

#[test]
fn sources_that_come_and_go_stay_in_the_book() {
    on_both(|mut falling| {
        falling.settings().rain = 500.0;
        run(&mut falling.app, 1.0);
        let spring = WaterSource { at: vec2(3.0, 2.0), radius: 2.0, rate: 3.0.into() };
        falling.app.world_mut().entity_mut(falling.water).insert(WaterSources { sources: vec![spring] });
        let begins = falling.state().time;
        run(&mut falling.app, 2.0);
        falling.app.world_mut().entity_mut(falling.water).insert(WaterSources::default());
        let ends = falling.state().time;
        run(&mut falling.app, 1.0);
        let state = falling.state();
        // What is asked of the GPU takes effect some frames later.
        assert!((state.balance.sources - 3.0 * (ends - begins)).abs() < 0.5, "{state:?}");
        assert!(state.balance.sources > 5.0 && state.balance.rain > 0.15, "{state:?}");
        assert!(state.error().abs() < 1e-4, "{} m³", state.error());
    });
}

#[test]
fn a_water_that_cannot_keep_up_runs_late_and_says_so_once() {
    on_both(|mut falling| {
        falling.settings().speed = 100.0;
        falling.settings().max_steps = 2;
        let mut before = SimulationState::default();
        let said = complaints(&mut falling.app, |app| {
            for _ in 0..8 {
                run(app, 0.25);
                let now = state(app, falling.water);
                assert!(now.late > before.late && now.time > before.time && now.steps <= 2, "{now:?}");
                before = now;
            }
        });
        let about = format!(" {}: WaterSimulation::max_steps ", falling.water);
        assert_eq!(said.iter().filter(|line| line.contains(&about)).count(), 1, "{said:#?}");
        // 200 s were asked for, but for the frames before it began.
        assert!((before.time + before.late - 200.0).abs() < 10.0 && before.late > 150.0, "{before:?}");
        falling.settings().speed = 1.0;
        falling.settings().max_steps = 64;
        let state = falling.calm();
        println!("{:?}: {} s late after {} s, {:e} m³", falling.backend, state.late, state.time, state.error());
        assert!((state.volume - VOLUME).abs() < 1e-6 * VOLUME && state.error().abs() < 1e-6 * VOLUME, "{state:?}");
        for i in -9..=9 {
            let depth = at(&mut falling.app, i as f32, 0.0).unwrap().depth;
            assert!((0.5..1.5).contains(&depth), "{depth} m; it settles to 1 m");
        }
    });
}

#[test]
fn what_is_asked_of_other_entities_is_not_heard() {
    let mut app = server();
    let water = app.world_mut().spawn(Water::default()).id();
    app.world_mut().trigger(StepSimulation(water));
    app.world_mut().trigger(ResetSimulation(water));
    run(&mut app, 0.1);
    let mut simulated = app.world_mut().entity_mut(water);
    simulated.insert(WaterSimulation::default());
    assert_eq!(simulated.get::<SimulationState>(), Some(&SimulationState::default()));
    simulated.remove::<WaterSimulation>();
    app.world_mut().flush();
    assert!(!app.world().entity(water).contains::<SimulationState>());
}
