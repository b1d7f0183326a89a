//! No water is lost, and none is made.
use super::{Run, terrain};
use freshet_hydro::{
    grid::Grid,
    shallow_water::{DomainSide, Edge, EdgePart, PointSource, Restored, Series},
};
use glam::Vec2;

/// A closed basin with the terrain of a tidal river whose bed is tilted to and fro 100 times, while a spring and a
/// drain at opposite ends run in turns: after 100 000 steps of sloshing the volume is still what the book says, and
/// what depths show.
pub fn in_a_basin_that_is_shaken(run: Run) {
    let level_bed = terrain::bed();
    let mut water = terrain::land();
    water.fill(1.0).expect("a sane level");
    let before = water.volume();
    let (mut worst, mut debt, mut fastest) = (0.0_f64, 0.0_f64, 0.0_f32);
    for turn in 0..100 {
        water.set_bed(&tilted(&level_bed, turn)).expect("a finite bed");
        let rate = if turn % 2 == 0 { 5.0 } else { 0.0 };
        water.set_sources(spring_and_drain(rate)).expect("sane sources");
        run(&mut water, 65.0);
        assert!(water.depths().iter().all(|depth| depth.is_finite() && *depth >= 0.0));
        let area = f64::from(water.cell_size()).powi(2);
        let seen = water.depths().iter().map(|&depth| f64::from(depth)).sum::<f64>() * area;
        worst = worst.max((water.volume() - water.balance().expected()).abs() / before);
        debt = debt.max((seen - water.volume()).abs() / before);
        fastest = fastest.max(water.fastest_signal());
    }
    println!("shaken basin: volume (m³) | off the book by | depths off the volume by | fastest signal (m/s)");
    println!("{before:.1} | {worst:.1e} | {debt:.1e} | {fastest:.1}");
    assert!(worst <= 5e-7 && debt <= 1e-7, "{worst} {debt}");
}

/// The bed, m, of the basin tilted by 1.5 m in a direction that changes from turn to turn.
fn tilted(level: &Grid<f32>, turn: usize) -> Grid<f32> {
    let direction = Vec2::from_angle(2.4 * turn as f32) * (1.5 / 128.0);
    Grid::from_fn(level.size(), level.cell_size(), |cell| {
        level.get(cell).expect("a cell of the grid") + direction.dot(level.position(cell))
    })
    .expect("a valid shape")
}

/// What gives `rate` (m³/s) in the north and takes as much in the south.
fn spring_and_drain(rate: f32) -> Vec<PointSource> {
    let source = |z: f32, rate: f32| PointSource { at: Vec2::new(8.0, z), radius: 6.0, rate: rate.into() };
    vec![source(-56.0, rate), source(56.0, -rate)]
}

/// A river that enters in the south, a tide in the east, an open edge in the north, rain, a spring and a drain: what
/// there is, is what there was and what came, less what left.
pub fn with_inflow_tide_and_rain(run: Run) {
    let mut water = terrain::land();
    water.fill(0.5).expect("a sane level");
    water.set_manning(0.03).expect("a sane roughness");
    let tide = Series::Tide { mean: 0.3, amplitude: 0.8, period: 900.0, high_water: 450.0 };
    for (side, edge) in [
        (DomainSide::South, Edge::Discharge(Series::Table(vec![(0.0, 0.0), (300.0, 30.0), (900.0, 10.0)]))),
        (DomainSide::East, Edge::Level(tide)),
        (DomainSide::North, Edge::Open),
        (DomainSide::West, Edge::Still(1.2.into())),
    ] {
        water.set_edge(side, EdgePart::All, edge).expect("a sane edge");
    }
    water.set_rain(100e-3 / 3600.0).expect("a sane rain");
    water.set_sources(spring_and_drain(2.0)).expect("sane sources");
    println!("time (s) | volume (m³) | rain | sources | left W, E, N, S | passed | off the book, of what passed");
    let (mut passed, mut last) = (0.0, water.balance());
    for turn in 1..=90 {
        run(&mut water, 20.0);
        let now = water.balance();
        passed += (now.rain - last.rain) + (now.sources - last.sources).abs();
        passed += now.left.iter().zip(last.left).map(|(now, last)| (now - last).abs()).sum::<f64>();
        last = now;
        let off = (water.volume() - now.expected()) / passed;
        if turn % 15 == 0 {
            let [west, east, north, south] = now.left;
            println!(
                "{} | {:.1} | {:.1} | {:.1} | {west:.1}, {east:.1}, {north:.1}, {south:.1} | {passed:.1} | {off:.1e}",
                turn * 20,
                water.volume(),
                now.rain,
                now.sources
            );
        }
        assert!(off.abs() <= 1e-6, "{off}");
        assert!(water.depths().iter().all(|depth| depth.is_finite() && *depth >= 0.0));
    }
    let rain = 1800.0 * 100e-3 / 3600.0 * 128.0 * 128.0;
    assert!((last.rain / rain - 1.0).abs() < 1e-6, "{}", last.rain);
    // 300 s to 30 m³/s, then 600 s to 10 m³/s, then 900 s at that.
    let river = 4500.0 + 12_000.0 + 9000.0;
    assert!((-last.left[DomainSide::South as usize] / river - 1.0).abs() < 1e-3, "{}", last.left[3]);
}

/// One damaged cell (NaN, infinite or absurd) counts as dry and infects nobody: a step later every number is finite, and what is
/// far from it is as it would have been.
pub fn a_poisoned_cell_infects_nobody(run: Run) {
    for poison in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX] {
        for number in 0..4 {
            let mut water = super::land(24, 20, 1.0, |x, _| 0.05 * x);
            water.set_manning(0.03).expect("a sane roughness");
            water.fill(1.0).expect("a sane level");
            let mut healthy = water.clone();
            let restored = Restored { time: 0.0, fastest_signal: water.fastest_signal(), balance: water.balance() };
            let cells: Vec<[f32; 4]> = water.conserved().collect();
            let damaged = cells.into_iter().enumerate().map(|(index, mut cell)| {
                if index == 10 * 24 + 12 {
                    cell[number] = poison;
                }
                cell
            });
            water.restore(damaged, restored);
            run(&mut water, 0.5);
            run(&mut healthy, 0.5);
            assert!(water.conserved().flatten().all(f32::is_finite), "{poison} as number {number}");
            let corner = (water.depths()[0] - healthy.depths()[0]).abs();
            assert!(corner < 1e-5, "{poison} as number {number}: {corner}");
        }
    }
}
