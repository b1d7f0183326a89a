//! The inspecting views: known water has known colours.
use crate::stage::{Picture, SIZE, Stage, still_water};
use bevy::prelude::*;
use bevy_freshet::prelude::*;
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
    let projection = OrthographicProjection {
        scaling_mode: bevy::camera::ScalingMode::FixedHorizontal { viewport_width: WIDTH },
        far: 100.0,
        ..OrthographicProjection::default_3d()
    };
    let pose = Transform::from_xyz(0.0, 20.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::NEG_Z);
    let camera = stage.camera(Projection::Orthographic(projection), pose);
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
