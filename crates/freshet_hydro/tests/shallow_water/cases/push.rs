//! Bodies that push the water.
use super::{Run, land, place, still};
use freshet_hydro::shallow_water::{Push, ShallowWater};
use glam::{UVec2, Vec2};

/// A round body of this radius (m) and draft (m) whose middle is at `at`, with the drag coefficient 1.
fn disc(water: &ShallowWater, at: Vec2, radius: f64, draft: f64, velocity: Vec2) -> Vec<Push> {
    let length = std::f64::consts::PI.sqrt() * radius;
    let cover = |index: usize| {
        let [x, z] = place(water, index);
        let offset = |k: u32| (f64::from(k) + 0.5) / 16.0 - 0.5;
        let is_inside = |k: u32| {
            let cell_size = f64::from(water.cell_size());
            let (x, z) = (x + offset(k % 16) * cell_size, z + offset(k / 16) * cell_size);
            (x - f64::from(at.x)).hypot(z - f64::from(at.y)) < radius
        };
        (0..256).filter(|&k| is_inside(k)).count() as f64 / 256.0
    };
    let columns = water.size().x;
    let push = |index: usize| Push {
        cell: UVec2::new(index as u32 % columns, index as u32 / columns),
        strength: (0.5 * cover(index) * draft / length) as f32,
        velocity,
        ..Push::default()
    };
    (0..water.depths().len()).map(push).filter(|push| push.strength > 0.0).collect()
}

/// Volume times velocity of all water, m⁴/s.
pub(super) fn momentum(water: &ShallowWater) -> [f64; 2] {
    let area = f64::from(water.cell_size()).powi(2);
    let of_cell = |index: usize| {
        let velocity = water.velocity(index).as_dvec2() * f64::from(water.depths()[index]);
        [velocity.x * area, velocity.y * area]
    };
    (0..water.depths().len()).map(of_cell).fold([0.0; 2], |sum, cell| [sum[0] + cell[0], sum[1] + cell[1]])
}

/// Still water gets the momentum of the drag law, in the direction of the body, whatever the size of a cell.
pub fn by_the_drag_of_a_body(run: Run) {
    let (radius, draft, duration) = (3.0, 0.5, 0.05);
    let velocity = Vec2::new(-1.2, 1.6);
    let exact = 0.5 * std::f64::consts::PI.sqrt() * radius * draft * 2.0 * duration;
    for cell_size in [0.5_f32, 1.0, 2.0] {
        let count = (40.0 / cell_size) as u32;
        let mut water = land(count, count, cell_size, |_, _| -8.0);
        water.set_periodic(true, true);
        water.fill(0.0).expect("sane");
        let before = water.volume();
        water.set_pushes(&disc(&water, Vec2::new(0.3, -0.2), radius, draft, velocity)).expect("sane");
        run(&mut water, duration);
        let gained = momentum(&water);
        let errors = [0, 1].map(|axis| gained[axis] / (exact * f64::from(velocity[axis])) - 1.0);
        println!("cells of {cell_size} m: momentum off by {:.2} % and {:.2} %", 100.0 * errors[0], 100.0 * errors[1]);
        assert!(errors.iter().all(|error| error.abs() < 0.01));
        assert!((water.volume() / before - 1.0).abs() < 1e-9);
    }
}

/// A body that is towed raises the water before it and lowers it behind, evenly on both sides, and moves no volume.
pub fn a_bow_wave_and_a_trough(run: Run) {
    let mut water = land(120, 60, 0.5, |_, _| -1.5);
    water.fill(0.0).expect("sane");
    let before = water.volume();
    let velocity = Vec2::new(1.5, 0.0);
    for step in 0..80 {
        let at = Vec2::new(-10.0, 0.0) + velocity * (0.1 * step as f32);
        water.set_pushes(&disc(&water, at, 2.0, 0.6, velocity)).expect("sane");
        run(&mut water, 0.1);
    }
    let level = |column: u32, row: u32| water.level((row * 120 + column) as usize);
    // The body is at x = 2 m: column 64.
    let (bow, stern) = (level(70, 30), level(57, 30));
    let lopsided = (0..120).map(|column| (level(column, 20) - level(column, 39)).abs()).fold(0.0, f32::max);
    let wake = water.velocity(30 * 120 + 56).x;
    println!("bow {bow:.4} m, stern {stern:.4} m, wake {wake:.3} m/s, sides differ by {lopsided:e} m");
    assert!(bow > 0.006 && stern < -0.005 && wake > 0.15);
    assert!(lopsided < 1e-5);
    assert!((water.volume() / before - 1.0).abs() < 1e-7);
}

/// A body that goes with the water does nothing to it, however strong; one that stands in it takes its speed and no more.
pub fn a_body_that_drifts_leaves_no_trace(run: Run) {
    let current = Vec2::new(0.7, -0.4);
    let mut water = land(40, 40, 1.0, |_, _| -2.0);
    water.set_periodic(true, true);
    water.set_water(|_, _| (2.0, current)).expect("sane");
    let mut body = disc(&water, Vec2::ZERO, 4.0, 1.0, current);
    body.iter_mut().for_each(|push| push.strength *= 1e6);
    water.set_pushes(&body).expect("sane");
    run(&mut water, 5.0);
    let off = (0..1600).map(|index| (water.velocity(index) - current).length()).fold(0.0, f32::max);
    assert!(off < 1e-5, "{off}");

    water.set_water(|_, _| still(2.0)).expect("sane");
    body.iter_mut().for_each(|push| push.velocity = Vec2::new(3.0, 0.0));
    water.set_pushes(&body).expect("sane");
    run(&mut water, 0.02);
    let fastest = super::fastest(&water);
    assert!(fastest > 2.9 && fastest < 3.001, "{fastest}");
}
