//! Foam on its cells: born where it should be, carried, decaying; and no work while the clock stands still.
use crate::{
    said::{complaints, run_on_this_thread},
    stage::{Picture, SIZE, Stage},
};
use bevy::{
    diagnostic::{DiagnosticPath, DiagnosticsStore},
    prelude::*,
    render::diagnostic::RenderDiagnosticsPlugin,
    time::TimeUpdateStrategy,
};
use bevy_freshet::prelude::*;
use core::time::Duration;
use freshet_hydro::grid::Grid;

/// Width of the picture, m: a pixel is half a cell.
const WIDTH: f32 = 40.0;

/// Water of the picture's width from straight above, which shows its foam.
fn foamy(stage: &mut Stage, foam: WaterFoam, water: impl Bundle) -> (Entity, Entity) {
    let surface = WaterSurface { view: SurfaceView::Foam, ripples: 0.0, ..default() };
    let entity = stage.spawn((Water::new(vec2(WIDTH, 24.0)), WaterWaves::still(), surface, foam));
    stage.app.world_mut().entity_mut(entity).insert(water);
    (entity, stage.camera_above(Vec3::ZERO, WIDTH))
}

/// No foam from anywhere; it would live for 6 s.
fn none() -> WaterFoam {
    WaterFoam { life: 6.0, shore: 0.0, shear: 0.0, breaking: 0.0, speed: 0.0, bodies: 0.0, ..default() }
}

fn place(pixel: UVec2) -> Vec2 {
    (pixel.as_vec2() + 0.5 - SIZE.as_vec2() / 2.0) * (WIDTH / SIZE.x as f32)
}

/// Foam at every pixel's place but near the rim, where the picture of the fields fades.
fn foam(picture: &Picture) -> Vec<(Vec2, f32)> {
    let inner = |place: Vec2| place.abs().cmplt(vec2(17.0, 9.5)).all();
    picture.pixels().map(|(pixel, color)| (place(pixel), color.x)).filter(|(place, _)| inner(*place)).collect()
}

fn total(foam: &[(Vec2, f32)]) -> f32 {
    foam.iter().map(|(_, density)| density).sum()
}

fn centroid(foam: &[(Vec2, f32)]) -> Vec2 {
    foam.iter().map(|(place, density)| *place * *density).sum::<Vec2>() / total(foam)
}

/// A bed below that is drawn, so that the water's edge is not cut.
fn lay(stage: &mut Stage, elevation: impl Fn(Vec2) -> f32) {
    let bed = WaterBed::from_fn(uvec2(84, 52), 0.5, elevation).unwrap();
    stage.spawn(bed);
}

#[test]
fn the_shore_foams_and_the_deep_does_not() {
    let mut stage = Stage::new();
    // A beach towards the west, and a pillar out of deep water.
    lay(&mut stage, |p| (-0.1 * (p.x + 12.0)).max(if p.distance(vec2(6.0, 0.0)) < 2.0 { 1.0 } else { -2.0 }));
    let sources = WaterFoam { shore: 0.5, shore_depth: 0.3, ..none() };
    let (_, camera) = foamy(&mut stage, sources, ());
    stage.settle();
    stage.run(0.5);
    for (place, density) in foam(&stage.picture(camera)) {
        let depth = 0.1 * (place.x + 12.0);
        // The steep sides of the pillar are narrower than a cell.
        if depth > 0.4 && place.distance(vec2(6.0, 0.0)) > 3.0 {
            assert!(density < 1e-3, "{density} at {place}, {depth} m deep");
        } else if (0.03..0.1).contains(&depth) {
            // Still water has the calm share of it: b = 0.5·0.15·(1 − depth/0.3), b T/(1 + b T) with T = 6 s.
            let fed = 0.5 * 0.15 * (1.0 - depth / 0.3) * 6.0;
            let expected = fed / (1.0 + fed);
            assert!((density - expected).abs() < 0.03, "{density} at {place}, expected {expected}");
        }
    }
}

#[test]
fn no_foam_is_born_under_ice() {
    let mut stage = Stage::new();
    lay(&mut stage, |p| -0.1 * (p.x + 12.0));
    let sources = WaterFoam { shore: 0.5, shore_depth: 0.3, ..none() };
    // The shore is frozen, and the middle not yet.
    let (water, camera) = foamy(&mut stage, sources, WaterIce::frozen(0.4));
    stage.settle();
    stage.run(0.5);
    assert_eq!(total(&foam(&stage.picture(camera))), 0.0);
    stage.app.world_mut().entity_mut(water).remove::<WaterIce>();
    stage.run(0.5);
    assert!(total(&foam(&stage.picture(camera))) > 10.0, "there is foam without ice");
}

#[test]
fn waves_that_run_up_make_more_foam_at_the_shore() {
    let shore = |waves: WaterWaves| {
        let mut stage = Stage::new();
        lay(&mut stage, |p| -0.1 * (p.x + 12.0));
        let sources = WaterFoam { shore: 0.5, shore_depth: 0.3, life: 1.5, ..none() };
        let (_, camera) = foamy(&mut stage, sources, waves);
        stage.settle();
        stage.run(4.0);
        total(&foam(&stage.picture(camera)))
    };
    let (calm, rough) = (shore(WaterWaves::still()), shore(WaterWaves::wind(6.0, 5000.0, Vec2::NEG_X)));
    assert!(calm > 0.0 && rough > 1.3 * calm, "{rough} with waves, {calm} without");
}

/// A map of the current on cells of a metre.
fn map(velocity: impl Fn(Vec2) -> Vec2) -> WaterFlow {
    let size = uvec2(42, 26);
    WaterFlow::from_map(Grid::from_fn(size, 1.0, |cell| velocity(cell.as_vec2() + 0.5 - size.as_vec2() / 2.0)).unwrap())
}

#[test]
fn sheared_water_foams_and_water_that_moves_as_one_does_not() {
    let mut stage = Stage::new();
    // Two streams side by side, whose speeds change over four metres.
    let flow = map(|p| vec2(0.5 + 0.5 * (p.y / 2.0).clamp(-1.0, 1.0), 0.0));
    let (_, camera) = foamy(&mut stage, WaterFoam { shear: 0.5, shear_threshold: 0.05, ..none() }, flow);
    stage.settle();
    stage.run(1.0);
    let foam = foam(&stage.picture(camera));
    for &(place, density) in &foam {
        if place.y.abs() > 3.5 {
            assert!(density < 1e-3, "{density} at {place}, where nothing is sheared");
        } else if place.y.abs() < 0.5 {
            // A shear of 0.25/s: b = 0.5·0.2, T = 6 s.
            assert!((density - 0.6 / 1.6).abs() < 0.01, "{density} at {place}");
        }
    }
}

/// Foam in a patch of fast water, which then is let go.
fn patch(stage: &mut Stage, then: WaterFlow) -> Entity {
    let flow = map(|p| vec2(3.0 * (-0.5 * (p - vec2(-4.0, 1.0)).length_squared() / 4.0).exp(), 0.0));
    let sources = WaterFoam { speed: 0.5, speed_threshold: 1.2, life: 4.0, ..none() };
    let (water, camera) = foamy(stage, sources, flow);
    stage.settle();
    stage.run(1.0 / 60.0);
    stage.app.world_mut().entity_mut(water).insert(then);
    camera
}

#[test]
fn fast_water_foams_and_its_foam_drifts_and_decays() {
    let drift = vec2(0.9, -0.4);
    for (flow, moved) in [(Vec2::ZERO, Vec2::ZERO), (drift, drift * 4.0)] {
        let mut stage = Stage::new();
        let camera = patch(&mut stage, WaterFlow::uniform(flow));
        let before = foam(&stage.picture(camera));
        let slow = before.iter().filter(|(place, _)| place.distance(vec2(-4.0, 1.0)) > 3.5);
        assert!(slow.clone().count() > 1000 && slow.clone().all(|(_, density)| *density < 1e-3));
        assert!(total(&before) > 100.0, "fast water foams: {}", total(&before));
        stage.run(4.0);
        let after = foam(&stage.picture(camera));
        let (left, way) = (total(&after) / total(&before), centroid(&after) - centroid(&before));
        println!("{left} is left after a life, {way} m away");
        assert!((left / (-1.0_f32).exp() - 1.0).abs() < 0.01, "{left} is left after a life");
        assert!(way.distance(moved) < 0.05 * moved.length() + 0.01, "moved {way}, not {moved}");
    }
}

#[test]
fn water_that_is_not_simulated_has_no_foam() {
    let mut stage = Stage::new();
    lay(&mut stage, |p| -0.1 * (p.x + 12.0));
    let off = WaterInteraction { enabled: false, ..default() };
    let (water, camera) = foamy(&mut stage, WaterFoam { shore: 0.5, ..none() }, off);
    stage.settle();
    stage.run(0.5);
    assert_eq!(total(&foam(&stage.picture(camera))), 0.0);
    // It may be switched on and off at any time.
    let mut switch = |enabled: bool| {
        stage.app.world_mut().get_mut::<WaterInteraction>(water).unwrap().enabled = enabled;
        stage.run(0.5);
        total(&foam(&stage.picture(camera)))
    };
    assert!(switch(true) > 0.0);
    assert_eq!(switch(false), 0.0);
}

#[test]
fn nothing_runs_while_the_clock_stands_still() {
    let mut stage = Stage::with(|app| _ = app.add_plugins((WaterPlugin, RenderDiagnosticsPlugin)));
    lay(&mut stage, |p| -0.1 * (p.x + 12.0));
    let (_, camera) = foamy(&mut stage, WaterFoam::default(), ());
    stage.settle();
    let runs = |stage: &mut Stage| {
        // What was measured comes back some frames later.
        (0..10).for_each(|_| stage.app.update());
        let path = DiagnosticPath::from_components(["render", "water_fields", "elapsed_cpu"]);
        let store = stage.app.world().resource::<DiagnosticsStore>();
        store.get(&path).and_then(|diagnostic| diagnostic.measurement()).map(|last| last.time)
    };
    stage.run(0.2);
    let running = runs(&mut stage);
    assert!(running.is_some(), "the stages run");
    assert_eq!(runs(&mut stage), running, "and no more when time stands still");
    stage.app.world_mut().resource_mut::<Time<Virtual>>().pause();
    stage.run(0.2);
    assert_eq!(runs(&mut stage), running, "nor when it is paused");
    stage.app.world_mut().resource_mut::<Time<Virtual>>().unpause();
    stage.run(0.2);
    assert_ne!(runs(&mut stage), running, "but again afterwards");
    // A camera that moves over a water that fits into the window changes nothing either.
    let running = runs(&mut stage);
    stage.app.world_mut().get_mut::<Transform>(camera).unwrap().translation.x = 9.0;
    assert_eq!(runs(&mut stage), running);
}

/// What is unusable in the next test's water.
const UNUSABLE: &str = "
    WaterInteraction::cell WaterInteraction::cells WaterInteraction::rings WaterInteraction::wavelength
    WaterInteraction::decay WaterInteraction::spreading WaterInteraction::dye_life
    WaterFoam::life WaterFoam::shore WaterFoam::shore_depth WaterFoam::shear WaterFoam::shear_threshold
    WaterFoam::speed WaterFoam::speed_threshold WaterFoam::bodies";

#[test]
fn unusable_settings_are_named_once_and_the_fields_stay_numbers() {
    let mut stage = Stage::new();
    run_on_this_thread(&mut stage.app);
    lay(&mut stage, |p| -0.1 * (p.x + 12.0));
    let nan = f32::NAN;
    let interaction = WaterInteraction {
        cell: nan,
        cells: 0,
        rings: -1.0,
        wavelength: 0.0,
        decay: nan,
        spreading: f32::INFINITY,
        dye_life: -3.0,
        ..default()
    };
    let sources = WaterFoam {
        life: 0.0,
        shore: nan,
        shore_depth: 0.0,
        shear: nan,
        shear_threshold: nan,
        speed: f32::INFINITY,
        speed_threshold: -1.0,
        bodies: nan,
        ..default()
    };
    let (water, camera) = foamy(&mut stage, sources, (interaction, WaterFlow::uniform(vec2(0.5, 0.2))));
    let said = complaints(&mut stage.app, |app| {
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(20)));
        (0..30).for_each(|_| app.update());
    });
    for field in UNUSABLE.split_whitespace() {
        let field = format!(" {water}: {field} ");
        assert_eq!(said.iter().filter(|line| line.contains(&field)).count(), 1, "{field}in {said:#?}");
    }
    assert_eq!(said.len(), UNUSABLE.split_whitespace().count(), "{said:#?}");
    assert!(stage.picture(camera).pixels().all(|(_, color)| color.is_finite() && color.max_element() <= 1.0));
}
