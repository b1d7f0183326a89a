//! Bodies that take up room in the water.
use super::{Run, fastest, land, push::momentum, still};
use freshet_hydro::{
    grid::Raster,
    hull::{Columns, Hull, SurfacePlane},
    shallow_water::{Displaced, Displacement, ShallowWater},
    waves::GRAVITY,
};
use glam::{Affine3A, IVec2, Quat, Vec2, Vec3};

/// A box of 2 × 1.6 m.
fn ferry() -> Hull {
    Hull::cuboid(Vec3::new(1.0, 1.0, 0.8)).expect("a box")
}

/// Puts the hull, turned by `turn` about y, with its keel at this elevation into water whose level is 0 there.
fn put(water: &mut ShallowWater, hull: &Hull, at: Vec2, turn: f32, keel: f32) -> Vec<Displaced> {
    let (size, cell) = (water.size(), water.cell_size());
    let raster = Raster { origin: -0.5 * cell * size.as_vec2(), cell, size };
    let pose = Affine3A::from_rotation_translation(Quat::from_rotation_y(turn), Vec3::new(at.x, 1.0 + keel, at.y));
    let mut columns = Columns::default();
    columns.rasterise(hull, pose, &SurfacePlane::default(), &raster);
    let room = |at: IVec2| (at.cmpge(IVec2::ZERO).all() && at.cmplt(size.as_ivec2()).all()).then_some(1.4);
    let mut displacement = Displacement::default();
    displacement.add(columns.cells().map(|(cell_of, volume)| (cell_of, volume / (cell * cell))), room);
    water.set_displaced(displacement.cells()).expect("sane");
    assert!((water.displaced_volume() - columns.volume()).abs() < 2e-5 * f64::from(cell * cell));
    displacement.cells().to_vec()
}

/// Level of the cell at (x, z), m.
fn level(water: &ShallowWater, at: Vec2) -> f32 {
    let cell = (at / water.cell_size() + 0.5 * water.size().as_vec2()).as_uvec2();
    water.level((cell.y * water.size().x + cell.x) as usize)
}

/// A body that goes down slowly in a closed basin raises its level by V/A everywhere; lifted out, it leaves what there was.
pub fn a_body_that_is_lowered_raises_the_level(run: Run) {
    let hull = ferry();
    let mut water = land(64, 48, 0.25, |_, _| -2.0);
    water.fill(0.0).expect("sane");
    let before = water.volume();
    let lower = |water: &mut ShallowWater, run: Run, keel: &dyn Fn(f32) -> f32| {
        for step in 1..=200 {
            put(water, &hull, Vec2::new(0.4, -0.3), 0.3, keel(step as f32 / 200.0));
            run(water, 0.1);
        }
    };
    // Without a jolt at the end, which would leave waves.
    let smooth = |t: f32| 0.5 - 0.5 * (std::f32::consts::PI * t).cos();
    lower(&mut water, &mut *run, &|t| -0.5 * smooth(t));
    let expected = 0.5 * 2.0 * 1.6 / (16.0 * 12.0);
    let levels = |water: &ShallowWater| {
        let all = (0..water.depths().len()).map(|index| water.level(index));
        all.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], level| [low.min(level), high.max(level)])
    };
    let [low, high] = levels(&water);
    // What still sloshes goes both ways.
    println!("level {low:.6}…{high:.6} m of {expected:.6} m, {:e} m/s", fastest(&water));
    let mean = (water.volume() + water.displaced_volume()) / (16.0 * 12.0) - 2.0;
    assert!((mean / f64::from(expected) - 1.0).abs() < 1e-5, "{mean}");
    assert!((low / expected - 1.0).abs() < 0.04 && (high / expected - 1.0).abs() < 0.04);
    assert!((water.volume() / before - 1.0).abs() < 1e-9);
    lower(&mut water, run, &|t| -0.5 + 0.5 * smooth(t));
    let [low, high] = levels(&water);
    println!("lifted out: {low:e}…{high:e} m");
    assert!(low > -5e-4 && high < 5e-4 && water.displaced_volume() == 0.0);
    assert!((water.volume() / before - 1.0).abs() < 1e-9);
}

/// Still water around a body at rest stays still to the last bit.
pub fn a_resting_body_leaves_still_water_still(run: Run) {
    let mut water = land(48, 40, 0.25, |x, z| -1.5 + 0.4 * (0.9 * x).sin() * (0.7 * z).cos());
    put(&mut water, &ferry(), Vec2::new(0.37, -0.21), 0.5, -0.6);
    water.fill(0.0).expect("sane");
    run(&mut water, 10.0);
    println!("{:e} m/s", fastest(&water));
    assert!(fastest(&water) < 1e-6);
}

/// A body that drifts with an even current disturbs nothing, wherever in the cells it is.
pub fn a_body_that_drifts_leaves_no_trace(run: Run) {
    let current = Vec2::new(0.7, -0.4);
    let mut water = land(48, 40, 0.25, |_, _| -2.0);
    water.set_periodic(true, true);
    put(&mut water, &ferry(), Vec2::new(-1.5, 1.0), 0.3, -0.4);
    let bed = water.bed().to_vec();
    let mut index = 0;
    let all = |_, _| {
        index += 1;
        (-bed[index - 1], current)
    };
    water.set_water(all).expect("sane");
    let dt = 1.0 / 60.0;
    for step in 1..=240 {
        put(&mut water, &ferry(), Vec2::new(-1.5, 1.0) + current * (step as f32 * dt), 0.3, -0.4);
        run(&mut water, f64::from(dt));
    }
    let off = (0..water.depths().len()).map(|index| water.level(index).abs()).fold(0.0, f32::max);
    let faster = (0..water.depths().len()).map(|index| (water.velocity(index) - current).length()).fold(0.0, f32::max);
    println!("level off by {off:.4} m, velocity by {faster:.4} m/s");
    assert!(off < 0.01 && faster < 0.012);
}

/// A body that falls in sends out a ring of the volume that it displaces, at √(g d).
pub fn a_ring_holds_what_was_displaced(run: Run) {
    let (depth, draft) = (0.5_f32, 0.05);
    let mut water = land(160, 160, 0.25, |_, _| -f64::from(depth));
    water.fill(0.0).expect("sane");
    let (near, far) = (Vec2::new(6.0, 0.0), Vec2::new(14.0, 0.0));
    let mut heights = [Vec::new(), Vec::new()];
    let dt = 0.05;
    for step in 1..=150_i32 {
        let keel = -draft * (step as f32 / 6.0).min(1.0);
        put(&mut water, &ferry(), Vec2::ZERO, 0.0, keel);
        run(&mut water, f64::from(dt));
        for (heights, at) in heights.iter_mut().zip([near, far]) {
            heights.push(level(&water, at));
        }
    }
    // When the front has a quarter of its height.
    let arrival = |heights: &[f32]| {
        let quarter = 0.25 * heights.iter().copied().fold(0.0, f32::max);
        let after = heights.iter().position(|height| *height > quarter).expect("it arrives");
        let before = if after > 0 { heights[after - 1] } else { 0.0 };
        (after as f32 + (quarter - before) / (heights[after] - before)) * dt
    };
    let speed = 8.0 / (arrival(&heights[1]) - arrival(&heights[0]));
    let expected = (GRAVITY * depth).sqrt();
    let cell = f64::from(water.cell_size()).powi(2);
    let ring: f64 = (0..water.depths().len()).map(|index| f64::from(water.level(index)) * cell).sum();
    let displaced = f64::from(draft) * 2.0 * 1.6;
    println!("front at {speed:.3} m/s of {expected:.3} m/s; ring of {ring:.5} m³ for {displaced:.5} m³");
    assert!((speed / expected - 1.0).abs() < 0.03 && (ring / displaced - 1.0).abs() < 1e-4);
}

/// What the water gains is the reaction that is said of the body, and about what presses on it: ρ g ∫ D ∇η.
pub fn what_pushes_the_body_pushes_the_water_back(run: Run) {
    let mut water = land(160, 80, 0.25, |_, _| -1.0);
    water.fill(0.0).expect("sane");
    let (dt, speed) = (1.0 / 60.0, 1.0);
    let (mut pressed, mut reaction) = (0.0, 0.0);
    for step in 1..=180 {
        let own = put(&mut water, &ferry(), Vec2::new(-3.0 + speed * step as f32 * dt, 0.0), 0.0, -0.3);
        let area = f64::from(water.cell_size()).powi(2);
        // As the body meets the water: where it has just gone to, before that answers.
        let press = |(index, [ground, bed]): (usize, [f32; 2])| {
            let slope = (water.level(index + 1) - water.level(index - 1)) / (2.0 * water.cell_size());
            f64::from(GRAVITY * (bed - ground) * slope) * area
        };
        pressed += water.raised().map(press).sum::<f64>() * f64::from(dt);
        reaction += f64::from(water.reaction(&own, f64::from(dt)).x * dt);
        run(&mut water, f64::from(dt));
    }
    let gained = momentum(&water)[0];
    let (bow, stern) = (level(&water, Vec2::new(1.5, 0.0)), level(&water, Vec2::new(-1.5, 0.0)));
    println!(
        "the water gained {gained:.5} m⁴/s, of {reaction:.5} said and {pressed:.4} pressed; bow {bow:.4} m, stern {stern:.4} m"
    );
    assert!(bow > 0.004 && stern < -0.002);
    assert!((gained / reaction - 1.0).abs() < 1e-3 && (pressed / gained - 1.0).abs() < 0.1);
}

/// What a body does to the water east and north of it, its mirror image does west and south.
pub fn mirrored_bodies_make_mirrored_waves(run: Run) {
    let sail = |run: Run, sign: f32| {
        let mut water = land(60, 60, 0.25, |_, _| -1.0);
        water.set_water(|_, _| still(1.0)).expect("sane");
        for step in 1..=60 {
            let at = Vec2::new(-1.0 + 0.02 * step as f32, 0.5 - 0.01 * step as f32);
            put(&mut water, &ferry(), sign * at, 0.3, -0.3);
            run(&mut water, 1.0 / 60.0);
        }
        water
    };
    let (one, other) = (sail(&mut *run, 1.0), sail(run, -1.0));
    let last = one.depths().len() - 1;
    let off = (0..=last).map(|index| (one.level(index) - other.level(last - index)).abs()).fold(0.0, f32::max);
    println!("mirror images differ by {off:e} m");
    assert!(off < 1e-4);
}
