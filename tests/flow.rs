//! The pattern of ripples runs with the current, and never jumps.
use crate::stage::{Picture, SIZE, Stage, still_water};
use bevy::{
    math::{DMat2, DVec2},
    prelude::*,
};
use bevy_freshet::prelude::*;
use freshet_hydro::grid::Grid;

/// Height of the view from above, m.
const VIEW: f32 = 2.25;

/// Time between two pictures, s.
const STEP: f64 = 1.0 / 240.0;

/// A level water with a mapped current, whose normals are seen from straight above.
fn stream(current: Vec2) -> (Stage, Entity) {
    let mut stage = Stage::new();
    let (water, waves, surface, optics) = still_water(Vec2::splat(60.0));
    let surface = WaterSurface { ripples: 0.05, view: SurfaceView::Normal, ..surface };
    let map = Grid::from_fn(UVec2::splat(30), 2.0, |_| current).unwrap();
    stage.spawn((water, waves, surface, optics, WaterFlow::from_map(map)));
    let camera = stage.camera_above(Vec3::ZERO, VIEW * SIZE.x as f32 / SIZE.y as f32);
    (stage, camera)
}

/// The two channels of a picture that hold slopes, without ripples of a few pixels, whose differences between pixels
/// are not their gradients.
fn smooth_slopes(picture: &Picture) -> Vec<Vec2> {
    let mut texels: Vec<Vec2> = picture.pixels().map(|(_, color)| color.xz()).collect();
    for stride in [1, SIZE.x as usize] {
        for _ in 0..12 {
            let old = texels.clone();
            for i in stride..old.len() - stride {
                texels[i] = 0.25 * old[i - stride] + 0.5 * old[i] + 0.25 * old[i + stride];
            }
        }
    }
    texels
}

/// Mean displacement from `before` to `after` in metres, x to the right and y down: least squares of
/// `∂I/∂t = −d·∇I` over both slopes (Lucas and Kanade 1981).
fn displacement(before: &Picture, after: &Picture) -> Vec2 {
    let (before, after) = (smooth_slopes(before), smooth_slopes(after));
    let width = SIZE.x as usize;
    let mean = |i: usize| (0.5 * (before[i] + after[i])).as_dvec2();
    let (mut square, mut product) = (DMat2::ZERO, DVec2::ZERO);
    for y in 4..SIZE.y as usize - 4 {
        for i in (y * width + 4)..(y * width + width - 4) {
            // Central differences of the fourth order.
            let gradient = |step: usize| {
                (8.0 * (mean(i + step) - mean(i - step)) - (mean(i + 2 * step) - mean(i - 2 * step))) / 12.0
            };
            let (along, down) = (gradient(1), gradient(width));
            let change = (after[i] - before[i]).as_dvec2();
            for channel in 0..2 {
                let gradient = DVec2::new(along[channel], down[channel]);
                square += DMat2::from_cols(gradient * gradient.x, gradient * gradient.y);
                product -= gradient * change[channel];
            }
        }
    }
    (square.inverse() * product).as_vec2() * (VIEW / SIZE.y as f32)
}

/// Mean displacement of the pattern in [`STEP`], at several times.
fn displacements(current: Vec2) -> Vec<Vec2> {
    let (mut stage, camera) = stream(current);
    stage.run(0.1);
    (0..6)
        .map(|_| {
            let before = stage.picture(camera);
            stage.step(STEP);
            let after = stage.picture(camera);
            stage.run(0.3);
            displacement(&before, &after)
        })
        .collect()
}

/// What the current adds to the ripples' own way is `v Δt`, at any time.
#[test]
fn the_pattern_runs_with_the_current() {
    let current = vec2(1.1, -0.6);
    let still = displacements(Vec2::ZERO);
    let own = still.iter().sum::<Vec2>() / still.len() as f32;
    for moved in displacements(current) {
        let error = ((moved - own) / STEP as f32).distance(current) / current.length();
        println!("{} m/s, {:.1} % off", (moved - own) / STEP as f32, error * 100.0);
        assert!(error < 0.1, "{} m/s, expected {current}", (moved - own) / STEP as f32);
    }
}

/// Frames over more than one cycle of the two phases: nothing is seen where one begins anew.
#[test]
fn no_frame_jumps() {
    let (mut stage, camera) = stream(vec2(1.2, 0.0));
    stage.run(0.1);
    let mut before = stage.picture(camera);
    let mut changes: Vec<f32> = (0..40)
        .map(|_| {
            stage.run(1.0 / 15.0);
            let after = stage.picture(camera);
            let change = before.pixels().zip(after.pixels()).map(|(a, b)| a.1.distance_squared(b.1)).sum::<f32>();
            before = after;
            change.sqrt()
        })
        .collect();
    changes.sort_by(f32::total_cmp);
    let (median, largest) = (changes[changes.len() / 2], changes[changes.len() - 1]);
    println!("largest change between frames {:.2} × the median", largest / median);
    assert!(largest < 1.5 * median, "{largest} {median}");
}
