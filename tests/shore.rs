//! The water's edge.
use crate::stage::{SIZE, Stage, still_water};
use bevy::prelude::*;
use bevy_freshet::prelude::*;

/// Metres of depth for each metre along x.
const SLOPE: f32 = 0.1;

/// A beach that falls along x and crosses the level at x = 0, drawn by the [`WaterBed`]'s own mesh, seen from above.
fn beach(stage: &mut Stage, view: SurfaceView) -> Entity {
    let bed = WaterBed::from_fn(uvec2(40, 40), 0.5, |p| -SLOPE * p.x).unwrap();
    let mesh = bed.mesh(0..40, 0..40).unwrap();
    stage.paint(mesh, LinearRgba::WHITE, Transform::IDENTITY);
    stage.spawn(bed);
    let (water, waves, surface, optics) = still_water(Vec2::splat(18.0));
    let optics = WaterOptics { edge_depth: 0.3, reflectivity: 0.0, absorption: Vec3::splat(1e3), ..optics };
    stage.spawn((water, waves, WaterSurface { view, ..surface }, optics));
    stage.camera_above(Vec3::ZERO, 12.0)
}

/// World x of the centre of a column of pixels.
fn x_of(column: u32) -> f32 {
    ((column as f32 + 0.5) / SIZE.x as f32 - 0.5) * 12.0
}

#[test]
fn opacity_grows_with_depth_from_nothing_at_the_waterline() {
    let mut stage = Stage::new();
    let camera = beach(&mut stage, SurfaceView::Water);
    let picture = stage.picture(camera);
    // Black water over a white beach: darkness is the water's opacity.
    let opacity: Vec<f32> = (0..SIZE.x).map(|column| 1.0 - picture.at(column, SIZE.y / 2).x).collect();
    for column in 1..SIZE.x as usize {
        assert!(opacity[column] >= opacity[column - 1] - 1e-3, "column {column} is less opaque than the one before");
    }
    for (column, &opacity) in opacity.iter().enumerate() {
        let depth = SLOPE * x_of(column as u32);
        if depth < 0.0 {
            assert!(opacity < 1e-3, "dry land at {depth} m is wet: {opacity}");
        } else {
            let t = (depth / 0.3).min(1.0);
            let expected = t * t * (3.0 - 2.0 * t);
            assert!((opacity - expected).abs() < 0.02, "{depth} m: {opacity}, expected {expected}");
        }
    }
}

#[test]
fn the_waterline_lies_where_the_ground_crosses_the_level() {
    let mut stage = Stage::new();
    let camera = beach(&mut stage, SurfaceView::Fresnel);
    // A hard edge: the first pixel of water is the waterline.
    let world = stage.app.world_mut();
    let water = world.query_filtered::<Entity, With<Water>>().single(world).unwrap();
    world.get_mut::<WaterOptics>(water).unwrap().edge_depth = 0.0;
    let picture = stage.picture(camera);
    for row in 0..SIZE.y {
        let first = (0..SIZE.x).find(|&column| picture.at(column, row).z < 0.5).expect("there is water");
        let pixels = x_of(first) / 12.0 * SIZE.x as f32;
        assert!(pixels.abs() <= 1.0, "row {row}: the waterline is {pixels} pixels off");
    }
}
