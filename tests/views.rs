//! The inspecting views: known water has known colours.
use crate::stage::{Picture, SIZE, Stage, still_water};
use bevy::{ecs::system::RunSystemOnce, prelude::*};
use bevy_freshet::{prelude::*, surface::ViewScale};
use freshet_hydro::grid::Grid;

/// Width of the picture, m: 20 pixels a metre.
const WIDTH: f32 = 16.0;
/// Metres of depth for each metre along x.
const SLOPE: f32 = 2.0;
/// Spacing of the mesh, m.
const CELL: f32 = 0.8;

/// Still water seen from straight above, over a bed that falls along x.
fn scene(stage: &mut Stage, view: SurfaceView, flow: Option<WaterFlow>) -> Picture {
    stage.spawn(WaterBed::from_fn(uvec2(80, 80), 0.5, |p| -SLOPE * (p.x + 8.0)).unwrap());
    let (water, waves, surface, optics) = still_water(Vec2::splat(39.0));
    let water = stage.spawn((water, waves, WaterSurface { view, cell: CELL, cells: 8, ..surface }, optics));
    if let Some(flow) = flow {
        stage.app.world_mut().entity_mut(water).insert(flow);
    }
    let camera = stage.camera_above(Vec3::ZERO, WIDTH);
    stage.picture(camera)
}

/// The pixel whose centre is nearest to a place of the water.
fn pixel_at(place: Vec2) -> UVec2 {
    (place * (SIZE.x as f32 / WIDTH) + SIZE.as_vec2() / 2.0).as_uvec2()
}

fn color_at(picture: &Picture, place: Vec2) -> Vec3 {
    let pixel = pixel_at(place);
    picture.at(pixel.x, pixel.y)
}

#[test]
fn depths_have_the_colours_of_the_legend() {
    let picture = scene(&mut Stage::new(), SurfaceView::Depth, None);
    for (depth, color) in [
        (1.0, vec3(1.0, 1.0, 0.0)),
        (3.0, vec3(0.0, 1.0, 0.0)),
        (7.0, vec3(0.0, 1.0, 1.0)),
        (15.0, vec3(0.0, 0.0, 1.0)),
        (31.0, Vec3::ZERO),
        // Halfway from red to yellow and from yellow to green: log₂(1 + d) = ½ and 3/2.
        (2.0_f32.sqrt() - 1.0, vec3(1.0, 0.5, 0.0)),
        (8.0_f32.sqrt() - 1.0, vec3(0.5, 1.0, 0.0)),
    ] {
        let drawn = color_at(&picture, vec2(depth / SLOPE - 8.0, 1.0));
        // A pixel is 10 cm of depth wide: at a depth of d that is 0.1/((1 + d) ln 2) of a step.
        let tolerance = 0.01 + 0.06 / ((1.0 + depth) * 2.0_f32.ln());
        assert!((drawn - color).abs().max_element() < tolerance, "{depth} m: {drawn}, expected {color}");
    }
}

#[test]
fn currents_have_the_hue_of_their_direction_and_the_brightness_of_their_speed() {
    for (velocity, color) in [
        (vec2(1.0, 0.0), vec3(0.5, 0.0, 0.0)),
        (vec2(0.0, 2.0), vec3(0.5, 1.0, 0.0)),
        (vec2(-0.5, 0.0), vec3(0.0, 0.25, 0.25)),
        (vec2(0.0, -5.0), vec3(0.5, 0.0, 1.0)),
    ] {
        let map = Grid::from_fn(uvec2(20, 20), 2.0, |_| velocity * 0.25).unwrap();
        let mapped = WaterFlow { scale: 4.0, ..WaterFlow::from_map(map) };
        for flow in [WaterFlow::uniform(velocity), mapped] {
            let picture = scene(&mut Stage::new(), SurfaceView::Flow, Some(flow));
            // Tiles of arrows are 2 m: the next power of two above 24 pixels. Between them there is none.
            let between = color_at(&picture, vec2(2.01, 2.01));
            assert!((between - color).abs().max_element() < 0.01, "{velocity}: {between}, expected {color}");
            let shaft = color_at(&picture, vec2(1.01, 1.01));
            assert!(shaft.min_element() > 0.5, "{velocity}: no arrow, {shaft}");
        }
    }
}

#[test]
fn still_water_shows_no_current_and_no_arrow() {
    let picture = scene(&mut Stage::new(), SurfaceView::Flow, None);
    assert!(picture.pixels().all(|(_, color)| color == Vec3::ZERO));
}

#[test]
fn arrows_point_downstream() {
    let flow = WaterFlow::uniform(vec2(3.0, 0.0));
    let picture = scene(&mut Stage::new(), SurfaceView::Flow, Some(flow));
    // The head is wider than the shaft: count white rows across both ends of the arrow in the tile from (0, 0) to (2, 2).
    let width =
        |x: f32| (0..40).filter(|i| color_at(&picture, vec2(x, *i as f32 * 0.05 + 0.01)).min_element() > 0.5).count();
    let (tail, head) = (width(0.3), width(1.5));
    assert!(tail >= 1 && head >= tail + 4, "tail {tail} and head {head} pixels wide");
}

#[test]
fn edges_of_the_mesh_are_drawn_where_its_vertices_are() {
    let picture = scene(&mut Stage::new(), SurfaceView::Wireframe, None);
    let green = |place: Vec2| {
        let color = color_at(&picture, place);
        color.y > 0.4 && color.y > 2.0 * color.x.max(color.z)
    };
    // The innermost square reaches 4 cells from the centre, the ring around it has cells twice as large.
    for (cell, corner) in [(CELL, vec2(0.8, -1.6)), (2.0 * CELL, vec2(4.8, 1.6))] {
        let corner = corner + 0.01;
        assert!(green(corner), "no vertex at {corner}");
        assert!(green(corner + vec2(0.25 * cell, 0.0)), "no edge along x at {corner}");
        assert!(green(corner + vec2(0.0, 0.25 * cell)), "no edge along z at {corner}");
        assert!(green(corner + 0.5 * cell), "no diagonal at {corner}");
        assert!(!green(corner + vec2(0.25, 0.75) * cell), "a line inside a triangle at {corner}");
        assert!(!green(corner + vec2(0.75, 0.25) * cell), "a line inside a triangle at {corner}");
    }
}

/// A place 3 m to the right of the middle, where the next tests disturb the water.
const PLACE: Vec2 = vec2(3.0, -1.0);

/// The same water, a metre deep everywhere, a frame after `disturb` did something to it at [`PLACE`].
fn disturbed(view: SurfaceView, disturb: impl FnOnce(&mut Stage, Vec3)) -> Picture {
    let mut stage = Stage::new();
    stage.spawn(WaterBed::from_fn(uvec2(80, 80), 0.5, |_| -1.0).unwrap());
    let (water, waves, surface, optics) = still_water(Vec2::splat(39.0));
    let foam = WaterFoam { shore: 0.0, ..default() };
    stage.spawn((water, waves, WaterSurface { view, ..surface }, optics, foam));
    let camera = stage.camera_above(Vec3::ZERO, WIDTH);
    stage.settle();
    disturb(&mut stage, PLACE.extend(0.0).xzy());
    stage.run(1.0 / 60.0);
    stage.picture(camera)
}

/// Asserts the colours at the middle, at one deviation (1 m) from it, and far from it, where `color` is that of the share of
/// a Gaussian.
fn assert_gaussian(picture: &Picture, color: impl Fn(f32) -> Vec3) {
    for away in [Vec2::ZERO, Vec2::X, Vec2::NEG_Y, vec2(-7.0, 0.0)] {
        let drawn = color_at(picture, PLACE + away + 0.01);
        let expected = color((-0.5 * away.length_squared()).exp());
        assert!((drawn - expected).abs().max_element() < 0.02, "{away} m away: {drawn}, expected {expected}");
    }
}

#[test]
fn foam_is_as_white_as_it_is_dense() {
    let picture = disturbed(SurfaceView::Foam, |stage, place| {
        // A Gaussian of density d in its middle has the volume 2 π σ² d.
        stage.app.world_mut().write_message(Disturb::at(place, 1.0).with_foam(0.6 * core::f32::consts::TAU));
    });
    assert_gaussian(&picture, |share| Vec3::splat(0.6 * share));
}

#[test]
fn dye_has_the_colour_that_a_metre_of_it_lets_through() {
    let absorption = vec3(0.2, 0.6, 1.2);
    let picture = disturbed(SurfaceView::Dye, |stage, place| {
        // In a metre of water as above.
        let volume = core::f32::consts::TAU;
        stage.app.world_mut().write_message(Disturb::dye(place, 1.0, absorption, volume));
    });
    assert_gaussian(&picture, |share| Vec3::exp(-absorption * share));
}

#[test]
fn rings_are_green_where_they_rise_and_blue_where_they_fall() {
    for (depth, color) in [(-0.04, Vec3::Y), (0.04, Vec3::Z)] {
        let picture = disturbed(SurfaceView::Interaction, |stage, place| {
            stage.app.world_mut().write_message(Disturb::push(place, 1.0, depth));
        });
        // 5 cm are full.
        assert_gaussian(&picture, |share| color * (0.8 * share));
    }
}

#[test]
fn bodies_are_red_where_they_cut_the_water() {
    let picture = disturbed(SurfaceView::Interaction, |stage, place| {
        // Without a material it is not drawn, and one sees the water that it covers.
        let mesh = stage.app.world_mut().resource_mut::<Assets<Mesh>>().add(Cuboid::new(2.0, 1.0, 1.0));
        stage.spawn((Mesh3d(mesh), DisturbsWater, Transform::from_translation(place)));
    });
    for (away, cover) in [(Vec2::ZERO, 1.0), (vec2(0.6, 0.0), 1.0), (vec2(1.4, 0.0), 0.0), (vec2(0.0, 0.9), 0.0)] {
        let drawn = color_at(&picture, PLACE + away).x;
        assert!((drawn - cover).abs() < 0.02, "{away} m away: {drawn}, expected {cover}");
    }
}

/// Colours of the scale at its ends and in the middle, linear.
const SCALE: [Vec3; 3] = [vec3(0.1015, 0.0338, 0.1721), vec3(0.0097, 0.3710, 0.4748), vec3(0.8118, 0.8349, 0.2951)];

/// The colour of a value on the scale of a view.
fn on_scale(view: SurfaceView, value: f32) -> Vec3 {
    let scale = view.scale().unwrap();
    ViewScale::color((value - scale.low) / (scale.high - scale.low)).to_vec3()
}

fn assert_color(drawn: Vec3, expected: Vec3, what: &str) {
    assert!((drawn - expected).abs().max_element() < 0.02, "{what}: {drawn}, expected {expected}");
}

#[test]
fn the_scale_goes_from_dark_violet_over_teal_to_light_yellow() {
    // Computed apart from this crate, from Oklab's definition.
    for (share, color) in [(0.0, SCALE[0]), (0.5, SCALE[1]), (1.0, SCALE[2])] {
        assert!((ViewScale::color(share).to_vec3() - color).abs().max_element() < 1e-4, "{share}");
    }
}

#[test]
fn a_mapped_current_has_the_colours_of_its_speed_and_froude_number() {
    for speed in [0.5_f32, 3.0, 7.0] {
        let flow = || Some(WaterFlow::uniform(vec2(0.6, -0.8) * speed));
        let picture = scene(&mut Stage::new(), SurfaceView::Speed, flow());
        assert_color(color_at(&picture, Vec2::ONE), on_scale(SurfaceView::Speed, speed), "speed");
        let picture = scene(&mut Stage::new(), SurfaceView::Froude, flow());
        for x in [-6.0, -2.0, 5.0] {
            // The bed falls along x; the middle of a pixel is at 0.025 m.
            let depth = SLOPE * (x + 0.025 + 8.0);
            let froude = speed / (9.81 * depth).sqrt();
            assert_color(color_at(&picture, vec2(x, 1.0)), on_scale(SurfaceView::Froude, froude), "Froude number");
        }
    }
    for view in [SurfaceView::Level, SurfaceView::Age] {
        let picture = scene(&mut Stage::new(), view, None);
        assert_color(color_at(&picture, Vec2::ONE), on_scale(view, 0.0), "what is not simulated");
    }
}

/// A column that has fallen for a second in a basin 2 m deep.
fn fallen(view: SurfaceView, settings: WaterSimulation) -> (Stage, Picture) {
    let mut stage = Stage::new();
    stage.app.insert_resource(Time::<Fixed>::from_hz(60.0));
    let (water, waves, surface, optics) = still_water(Vec2::splat(16.0));
    let start = SimulationStart::Column { at: vec2(-8.0, 0.0), half_size: vec2(7.0, 9.0), level: 1.5 };
    let surface = WaterSurface { view, cell: 0.1, mesh_error: 0.0, ..surface };
    stage.spawn((water, waves, surface, optics, WaterSimulation { cell_size: 0.5, start, ..settings }));
    let camera = stage.camera_above(Vec3::ZERO, WIDTH);
    stage.settle();
    stage.run(1.0);
    let picture = stage.picture(camera);
    (stage, picture)
}

#[test]
fn simulated_water_has_the_colours_of_its_numbers_on_both_backends() {
    for backend in [SimulationBackend::Cpu, SimulationBackend::Gpu] {
        let settings = WaterSimulation { backend, ..default() };
        for view in [SurfaceView::Level, SurfaceView::Speed, SurfaceView::Froude] {
            let (mut stage, picture) = fallen(view, settings.clone());
            let mut values = Vec::new();
            for place in [vec2(-7.0, 1.0), vec2(-4.0, -2.0), vec2(-2.5, 0.0), vec2(0.5, 1.0)] {
                // The middle of its pixel.
                let place = (pixel_at(place).as_vec2() + 0.5 - SIZE.as_vec2() / 2.0) * (WIDTH / SIZE.x as f32);
                let sample = move |water: WaterQuery| water.sample(place.extend(0.0).xzy());
                let sample = stage.app.world_mut().run_system_once(sample).unwrap().unwrap();
                let speed = sample.velocity.xz().length();
                let value = match view {
                    SurfaceView::Level => sample.height,
                    SurfaceView::Speed => speed,
                    _ => speed / (9.81 * sample.depth).sqrt(),
                };
                values.push(value);
                assert_color(
                    color_at(&picture, place),
                    on_scale(view, value),
                    &format!("{backend:?} {view:?} {place}"),
                );
            }
            let range = values.iter().fold([f32::MAX, f32::MIN], |[low, high], &v| [low.min(v), high.max(v)]);
            assert!(range[1] - range[0] > 0.3, "{view:?}: {values:?}");
        }
    }
}

#[test]
fn a_state_that_comes_late_has_the_colour_of_its_age() {
    // So many steps as it would need are not allowed.
    for (speed, age) in [(1e3, 0.25), (1.0, 0.0)] {
        let settings = WaterSimulation { backend: SimulationBackend::Gpu, speed, max_steps: 2, ..default() };
        let (_, picture) = fallen(SurfaceView::Age, settings);
        assert_color(color_at(&picture, vec2(-7.0, 1.0)), on_scale(SurfaceView::Age, age), "age");
    }
}

#[test]
fn a_factor_widens_the_scale_of_a_view() {
    let mut stage = Stage::new();
    let (water, waves, surface, optics) = still_water(Vec2::splat(39.0));
    let surface = WaterSurface { view: SurfaceView::Speed, view_scale: 0.5, ..surface };
    stage.spawn((water, waves, surface, optics, WaterFlow::uniform(vec2(1.0, 0.0))));
    let camera = stage.camera_above(Vec3::ZERO, WIDTH);
    assert_color(color_at(&stage.picture(camera), Vec2::ONE), SCALE[1], "1 of 2 m/s");
}
