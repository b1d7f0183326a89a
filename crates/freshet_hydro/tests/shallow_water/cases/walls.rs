//! Thin walls between cells, weirs and gates, and a bed that is changed under the water.
use super::{Run, ShallowWater, bed_grid, fastest, land, still};
use freshet_hydro::{
    shallow_water::{CLOSED, DomainSide, Edge, EdgePart},
    waves::GRAVITY,
};
use glam::{UVec2, Vec2};

/// Columns and rows of the pond.
const COUNT: u32 = 40;

/// A flat pond of 40 × 40 cells of 1 m with a staircase of thin walls from the north to the south; cells left of it are
/// wet.
fn divided(crest: f32) -> ShallowWater {
    let mut water = land(COUNT, COUNT, 1.0, |x, z| 0.01 * x + 0.2 * (0.3 * z).sin());
    set_walls(&mut water, crest);
    water
}

/// The first column right of the staircase, in a row.
fn step_of(row: u32) -> u32 {
    12 + row / 4
}

fn is_left(index: usize) -> bool {
    (index as u32 % COUNT) < step_of(index as u32 / COUNT)
}

fn set_walls(water: &mut ShallowWater, crest: f32) {
    for row in 0..COUNT {
        let right = step_of(row);
        // A face is that of the cell on either of its sides.
        let (cell, side) = if row % 2 == 0 { (right, DomainSide::West) } else { (right - 1, DomainSide::East) };
        water.set_wall(UVec2::new(cell, row), side, crest).expect("a cell of the pond");
        if row > 0 && step_of(row - 1) < right {
            let (cell, side) = if row % 8 == 0 { (row, DomainSide::North) } else { (row - 1, DomainSide::South) };
            water.set_wall(UVec2::new(right - 1, cell), side, crest).expect("a cell of the pond");
        }
    }
}

/// Behind a thin closed wall it stays dry to the last bit, 3 m beside still water and beside a wave that breaks on the
/// wall, and still water before the wall stays still.
pub fn a_closed_wall_leaks_nothing(run: Run) {
    println!("closed wall, water left of it | wet cells right of it | max |u| (m/s) | volume drift");
    for wave in [0.0, 2.0_f32] {
        let mut water = divided(CLOSED);
        let pond = |at: Vec2, bed: f32| {
            let cell = (at + COUNT as f32 / 2.0).floor().as_uvec2();
            let rise = wave * (-0.02 * (at - Vec2::new(-15.0, 0.0)).length_squared()).exp();
            if cell.x < step_of(cell.y) { still(f64::from(3.0 + rise - bed)) } else { still(0.0) }
        };
        water.set_water(pond).expect("a sane level");
        let before = water.volume();
        let duration = 5000.0 * 0.45 / f64::from(water.fastest_signal());
        run(&mut water, duration);
        let wet = (0..water.depths().len()).filter(|&index| !is_left(index) && water.depths()[index] != 0.0).count();
        let drift = water.volume() / before - 1.0;
        let speed = fastest(&water);
        println!("3 m, wave {wave} m | {wet} | {speed:.1e} | {drift:.1e}");
        assert_eq!(wet, 0);
        assert!(drift.abs() <= 1e-7, "{drift}");
        assert!(wave > 0.0 || speed <= 10.0 * f32::EPSILON * (GRAVITY * 3.0).sqrt(), "{speed}");
    }
}

/// A weir keeps water below its crest, and lets pass what stands above it, over its whole length.
pub fn a_weir_holds_what_is_below_its_crest(run: Run) {
    println!("weir with its crest at 1 m: level left before (m) | mean level left after | wet cells right");
    for level in [0.95_f64, 1.5] {
        let mut water = divided(1.0);
        let pond = |at: Vec2, bed: f32| {
            let cell = (at + COUNT as f32 / 2.0).floor().as_uvec2();
            still(if cell.x < step_of(cell.y) { level - f64::from(bed) } else { 0.0 })
        };
        water.set_water(pond).expect("a sane level");
        let before = water.volume();
        run(&mut water, 600.0);
        let left: Vec<usize> = (0..water.depths().len()).filter(|&index| is_left(index)).collect();
        let mean = left.iter().map(|&index| water.level(index)).sum::<f32>() / left.len() as f32;
        let wet = (0..water.depths().len()).filter(|&index| !is_left(index) && water.depths()[index] > 0.0).count();
        println!("{level} | {mean:.4} | {wet}");
        assert!((water.volume() / before - 1.0).abs() <= 1e-7);
        if level < 1.0 {
            assert!(wet == 0 && f64::from(mean - 0.95).abs() < 1e-5, "{wet} {mean}");
        } else {
            assert!(wet > 700 && (mean - 1.0).abs() < 0.02, "{wet} {mean}");
        }
    }
}

/// Over a thin weir runs between what a broken dam lets pass, 8/27 √g H^(3/2) for the head H above the crest, and a little
/// more than critical flow carries, (2/3)^(3/2) √g H^(3/2).
pub fn flow_over_a_weir(run: Run) {
    println!("weir, head (m) | q (m²/s) | q / √(g H³), which is 0.544 for critical flow");
    let found = [0.1, 0.2, 0.5, 1.0].map(|head| flow_over_obstacle(run, head, false));
    assert!(found.iter().all(|found| (0.29..0.6).contains(found)), "{found:?}");
}

/// The same over a dike that is one cell wide, with a lower bed behind it.
pub fn flow_over_a_dike(run: Run) {
    println!("dike of one cell, head (m) | q (m²/s) | q / √(g H³), which is 0.544 for critical flow");
    let found = [0.1, 0.2, 0.5, 1.0].map(|head| flow_over_obstacle(run, head, true));
    assert!(found.iter().all(|found| (0.29..0.6).contains(found)), "{found:?}");
}

/// q / √(g H³) of steady flow from water that is kept `head` (m) above an obstacle 1 m high, which is a dike or a thin
/// wall.
fn flow_over_obstacle(run: Run, head: f64, dike: bool) -> f64 {
    let mut water = land(80, 2, 1.0, |x, _| if dike && (0.0..1.0).contains(&x) { 1.0 } else { 0.0 });
    if !dike {
        for row in 0..2 {
            water.set_wall(UVec2::new(40, row), DomainSide::West, 1.0).expect("a cell of the channel");
        }
    }
    let level = 1.0 + head;
    water.set_water(|at, _| still(if at.x < 0.0 { level } else { 0.0 })).expect("a sane depth");
    let reservoir = Edge::Level((level as f32).into());
    water.set_edge(DomainSide::West, EdgePart::All, reservoir).expect("a sane level");
    water.set_edge(DomainSide::East, EdgePart::All, Edge::Open).expect("a sane edge");
    run(&mut water, 300.0);
    let before = water.balance().left[DomainSide::East as usize];
    run(&mut water, 60.0);
    let discharge = (water.balance().left[DomainSide::East as usize] - before) / 60.0 / 2.0;
    let coefficient = discharge / (f64::from(GRAVITY) * head.powi(3)).sqrt();
    println!("{head} | {discharge:.4} | {coefficient:.4}");
    coefficient
}

/// A closed gate that is opened lets the water run as if there had never been one.
pub fn an_open_gate_leaves_no_trace(run: Run) {
    let dam = |at: Vec2, bed: f32| still(if at.x < -5.0 { f64::from(2.0 - bed) } else { 0.0 });
    let mut gated = divided(CLOSED);
    let mut free = land(COUNT, COUNT, 1.0, |x, z| 0.01 * x + 0.2 * (0.3 * z).sin());
    for water in [&mut gated, &mut free] {
        water.set_water(dam).expect("a sane level");
    }
    let before = gated.volume();
    set_walls(&mut gated, f32::NEG_INFINITY);
    for _ in 0..5 {
        run(&mut gated, 2.0);
        run(&mut free, 2.0);
        let difference = |(gated, free): (&f32, &f32)| (gated - free).abs();
        let worst = gated.depths().iter().zip(free.depths()).map(difference).fold(0.0, f32::max);
        assert!(worst <= 1e-5, "{worst}");
        assert!((gated.volume() / before - 1.0).abs() <= 1e-7);
    }
    let reached = (0..free.depths().len()).filter(|&index| !is_left(index) && free.depths()[index] > 0.01).count();
    assert!(reached > 500, "{reached}");
}

/// The bed rises and falls under running water, and the volume stays what it was.
pub fn a_moving_bed_keeps_the_volume(run: Run) {
    let bed = |heave: f64| bed_grid(COUNT, COUNT, 1.0, move |x, z| 0.02 * z + heave * (-0.02 * (x * x + z * z)).exp());
    let mut water = ShallowWater::new(&bed(0.0)).expect("a finite bed");
    water.fill(0.3).expect("a sane level");
    let before = water.volume();
    let mut worst = 0.0_f64;
    for turn in 0..50 {
        let depths = water.depths().to_vec();
        water.set_bed(&bed(2.0 * f64::from(turn % 5) - 4.0)).expect("a bed of the same size");
        assert_eq!(water.depths(), depths);
        run(&mut water, 2.0);
        worst = worst.max((water.volume() / before - 1.0).abs());
    }
    println!("bed heaved 50 times by up to 8 m: volume off by {worst:.1e}");
    assert!(worst <= 1e-7, "{worst}");
}
