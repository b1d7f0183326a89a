//! The same water on any number of threads, to the last bit.
use super::cases::{land, still};
use freshet_hydro::shallow_water::{Balance, DomainSide, Edge, EdgePart, PointSource, ShallowWater};
use glam::{UVec2, Vec2};

/// What a simulation comes to: depths, velocities and the book.
type Outcome = (Vec<u32>, Vec<[u32; 2]>, Balance);

/// Islands, a river, a tide, an open edge, rain, a spring, a drain and a wall on a domain of this size come to the same
/// bits with 1, 2, 3 and 5 threads.
fn on_any_number_of_threads(columns: u32, rows: u32, steps: u32) {
    let [alone, others @ ..] = [1, 2, 3, 5].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool of threads");
        pool.install(|| outcome(archipelago(columns, rows), steps))
    });
    for other in others {
        assert!(other == alone, "{columns} × {rows}");
    }
    let wet = alone.0.iter().filter(|&&depth| f32::from_bits(depth) > 0.02).count();
    println!("{columns} × {rows}, {steps} steps: {wet} cells deeper than 2 cm, the same bits on 1, 2, 3 and 5 threads");
    assert!(wet > alone.0.len() / 4 && wet < alone.0.len() * 9 / 10, "{wet} of {}", alone.0.len());
}

fn archipelago(columns: u32, rows: u32) -> ShallowWater {
    let mut water = land(columns, rows, 2.0, |x, z| 1.5 * (0.05 * x).sin() * (0.07 * z).cos() + 0.002 * x);
    water.set_manning(0.02).expect("a sane roughness");
    let pools =
        |at: Vec2, bed: f32| still(f64::from((0.3 - bed).max(0.0)) + if at.x < 0.0 && bed < 0.0 { 0.7 } else { 0.0 });
    water.set_water(pools).expect("a sane state");
    for (side, edge) in [
        (DomainSide::West, Edge::Discharge(40.0.into())),
        (DomainSide::East, Edge::Level(0.4.into())),
        (DomainSide::North, Edge::Open),
        (DomainSide::South, Edge::Still(1.1.into())),
    ] {
        water.set_edge(side, EdgePart::All, edge).expect("a sane edge");
    }
    water.set_rain(1e-5).expect("a sane rain");
    let source = |x: f32, rate: f32| PointSource { at: Vec2::new(x, 3.0), radius: 9.0, rate: rate.into() };
    water.set_sources(vec![source(-20.0, 8.0), source(20.0, -6.0)]).expect("sane sources");
    for row in 0..rows / 2 {
        water.set_wall(UVec2::new(columns / 2, row), DomainSide::West, 0.9).expect("a cell of the domain");
    }
    water
}

fn outcome(mut water: ShallowWater, steps: u32) -> Outcome {
    let advance = water.advance(1e6, steps);
    assert_eq!(advance.steps, steps);
    let bits = |index| water.velocity(index).to_array().map(f32::to_bits);
    let velocities = (0..water.depths().len()).map(bits).collect();
    (water.depths().iter().map(|depth| depth.to_bits()).collect(), velocities, water.balance())
}

/// On a domain of several bands of rows and several strips of columns, and on one of less than a band.
#[test]
fn the_same_bits_on_any_number_of_threads() {
    on_any_number_of_threads(1100, 200, 60);
    on_any_number_of_threads(130, 261, 300);
    on_any_number_of_threads(50, 30, 300);
}

/// The state does not depend on into how many parts of a strip or band the domain falls: a row of a wide domain is a
/// row of a narrow one, as far as no signal from beyond can have come.
#[test]
fn strips_and_bands_leave_no_seams() {
    let pond = |columns: u32, rows: u32| {
        let mut water = land(columns, rows, 1.0, |_, _| 0.0);
        let middle = Vec2::new(columns as f32, rows as f32) / 2.0;
        // Counted from the north-west, where both domains are the same.
        let hump = |at: Vec2, _| {
            let from_hump = at + middle - Vec2::new(1000.0, 60.0);
            still(1.0 + 0.5 * f64::from((-0.01 * from_hump.length_squared()).exp()))
        };
        water.set_water(hump).expect("a sane wave");
        water.advance(1e6, 60);
        water
    };
    let (narrow, wide) = (pond(1100, 130), pond(2200, 260));
    // One step carries news by two cells at most, and 60 steps by 120.
    for row in 0..10 {
        let part =
            |water: &ShallowWater, columns: usize| water.depths()[row * columns + 900..row * columns + 980].to_vec();
        assert_eq!(part(&narrow, 1100), part(&wide, 2200), "row {row}");
    }
}

/// A wave is the same over a seam of strips, which are 1024 columns wide, as in the middle of one.
#[test]
fn a_wave_over_a_seam_is_one_elsewhere() {
    let around = |column: usize| {
        let mut water = land(1400, 70, 1.0, |_, _| 0.0);
        water.set_manning(0.03).expect("a sane roughness");
        let hump = |at: Vec2, _| {
            let from_hump = at + Vec2::new(700.0, 35.0) - Vec2::new(column as f32, 20.0);
            still(1.0 + 0.5 * f64::from((-0.01 * from_hump.length_squared()).exp()))
        };
        water.set_water(hump).expect("a sane wave");
        water.advance(1e6, 60);
        (0..70).map(|row| water.depths()[row * 1400 + column - 60..][..120].to_vec()).collect::<Vec<_>>()
    };
    assert_eq!(around(512), around(1024));
}
