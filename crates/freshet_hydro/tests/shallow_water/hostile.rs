//! Whatever is asked for, there is a clear error or a finite state whose book is right.
use super::cases::{land, still};
use freshet_hydro::{
    grid::{Grid, GridError},
    shallow_water::{
        CLOSED, Displaced, DomainSide, Edge, EdgePart, PointSource, Push, Restored, Series, ShallowWater,
        ShallowWaterError,
    },
};
use glam::{UVec2, Vec2};

/// Every depth is finite and not negative, every velocity finite, and the volume is what the book says, within `share`
/// of what has passed.
fn assert_sane(water: &ShallowWater, share: f64) {
    let finite = |index: usize| {
        let depth = water.depths()[index];
        depth.is_finite() && depth >= 0.0 && water.velocity(index).is_finite()
    };
    assert!((0..water.depths().len()).all(finite));
    let balance = water.balance();
    let passed =
        balance.before + balance.rain + balance.sources.abs() + balance.left.iter().map(|left| left.abs()).sum::<f64>();
    let off = (water.volume() - balance.expected()).abs();
    assert!(off <= share * passed.max(1e-6), "{} m³, expected {}", water.volume(), balance.expected());
}

fn flat(columns: u32, rows: u32) -> ShallowWater {
    land(columns, rows, 1.0, |_, _| 0.0)
}

/// A bed with a cell that is NaN, infinite or a thousand kilometres high is refused, and the message names the cell.
#[test]
fn a_bed_that_is_not_finite_is_refused() {
    for found in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e6, f32::MAX] {
        let mut bed = Grid::new(UVec2::new(4, 3), 1.0, vec![0.0_f32; 12]).expect("a valid shape");
        let mut water = ShallowWater::new(&bed).expect("a finite bed");
        water.fill(1.0).expect("a sane level");
        bed.values_mut()[6] = found;
        let refused = ShallowWater::new(&bed).expect_err("a bed that is not finite");
        assert!(matches!(refused, ShallowWaterError::Bed { column: 2, row: 1, .. }), "{refused}");
        assert!(refused.to_string().contains("column 2, row 1"));
        assert!(matches!(water.set_bed(&bed), Err(ShallowWaterError::Bed { column: 2, row: 1, .. })));
        assert_eq!(water.bed(), [0.0; 12]);
    }
    let other = Grid::new(UVec2::new(3, 4), 1.0, vec![0.0_f32; 12]).expect("a valid shape");
    let refused = flat(4, 3).set_bed(&other);
    assert!(matches!(refused, Err(ShallowWaterError::Size { .. })), "{refused:?}");
}

/// There is no domain without cells, or with cells without a size.
#[test]
fn a_domain_has_cells() {
    assert_eq!(Grid::new(UVec2::new(0, 4), 1.0, Vec::<f32>::new()), Err(GridError::Empty(UVec2::new(0, 4))));
    assert!(Grid::new(UVec2::ONE, 0.0, vec![0.0_f32]).is_err());
    assert!(Grid::new(UVec2::ONE, f32::NAN, vec![0.0_f32]).is_err());
}

/// Domains of one row, one column or one cell work, with all kinds of edges and wrapped around.
#[test]
fn thin_domains_work() {
    for (columns, rows) in [(1, 1), (1, 7), (7, 1), (2, 2), (1, 600), (600, 1)] {
        for periodic in [false, true] {
            let stream = Edge::Stream { level: 1.2.into(), entering: 0.7.into() };
            for edge in [
                Edge::Wall,
                Edge::Open,
                Edge::Still(1.5.into()),
                stream,
                Edge::Level(0.5.into()),
                Edge::Discharge(1.0.into()),
            ] {
                let mut water = flat(columns, rows);
                water.set_periodic(periodic, periodic);
                water.set_water(|at, _| still(1.0 + 0.3 * f64::from(at.x.sin() + at.y.cos()))).expect("sane");
                for side in DomainSide::ALL {
                    water.set_edge(side, EdgePart::All, edge.clone()).expect("a sane edge");
                }
                water.set_rain(1e-4).expect("a sane rain");
                assert_eq!(water.advance(20.0, 100_000).left, 0.0, "{columns} × {rows} {edge:?}");
                assert_sane(&water, 1e-6);
            }
        }
    }
}

/// Water on a step of the bed of 1 km falls down without a scratch.
#[test]
fn water_falls_down_a_kilometre() {
    let mut water = land(40, 8, 10.0, |x, _| if x < 0.0 { 1000.0 } else { 0.0 });
    water.set_water(|at, _| still(if at.x < 0.0 { 20.0 } else { 0.0 })).expect("a sane depth");
    let advance = water.advance(120.0, 200_000);
    println!("a step of 1 km: {} steps for 120 s, fastest {} m/s", advance.steps, water.fastest_signal());
    assert_eq!(advance.left, 0.0);
    assert_sane(&water, 1e-6);
    assert!(water.depths()[39] > 1.0);
}

/// A billion cubic metres a second enter, and a billion are taken; the state stays finite.
#[test]
fn an_ocean_a_second_enters_and_leaves() {
    for rate in [1e9_f32, -1e9] {
        let mut water = flat(64, 64);
        water.fill(2.0).expect("a sane level");
        water.set_edge(DomainSide::West, EdgePart::All, Edge::Discharge(rate.into())).expect("a finite discharge");
        water.advance(0.05, 2000);
        println!("{rate:e} m³/s at an edge: {:.4e} m³ at {:.4} s", water.volume(), water.time());
        assert_sane(&water, 1e-6);
        let mut water = flat(64, 64);
        water.fill(2.0).expect("a sane level");
        let source = PointSource { at: Vec2::ZERO, radius: 5.0, rate: rate.into() };
        water.set_sources(vec![source]).expect("a finite rate");
        water.advance(0.05, 2000);
        println!("{rate:e} m³/s from a source: {:.4e} m³ at {:.4} s", water.volume(), water.time());
        assert_sane(&water, 1e-6);
    }
}

/// An hour is asked for and ten steps are allowed: what is left is said, and what was done is right.
#[test]
fn a_budget_of_steps_is_kept() {
    let mut water = flat(64, 64);
    water.set_water(|at, _| still(if at.x < 0.0 { 3.0 } else { 0.0 })).expect("a sane depth");
    let advance = water.advance(3600.0, 10);
    assert_eq!(advance.steps, 10);
    assert!(advance.left > 3500.0 && (advance.time + advance.left - 3600.0).abs() < 1e-6, "{advance:?}");
    assert!((water.time() - advance.time).abs() < 1e-9);
    assert_sane(&water, 1e-6);
    for duration in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(water.advance(duration, 10).steps, 0, "{duration}");
    }
    assert_eq!(water.advance(1.0, 0).left, 1.0);
}

/// An `advance` that fits into one step takes one step.
#[test]
fn a_short_advance_is_one_step() {
    let mut water = flat(8, 8);
    water.set_water(|at, _| still(1.0 + 0.01 * f64::from(at.x))).expect("a sane depth");
    for duration in [0.05, 0.01, 1.0 / 60.0, 1.0 / 120.0, 0.1, 1e-3, 0.037] {
        let steps = water.advance(duration, 100).steps;
        assert_eq!(steps, 1, "{duration} s took {steps} steps");
    }
}

/// A state in which a number is not finite, as a broken file or card may bring it back, heals in one step, and the rest
/// of the water is there.
#[test]
fn a_damaged_state_heals() {
    for number in 0..4 {
        for damage in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -3.0, f32::MAX] {
            let mut water = flat(20, 20);
            water.fill(1.0).expect("a sane level");
            let mut cells: Vec<[f32; 4]> = water.conserved().collect();
            cells[210][number] = damage;
            let (time, fastest_signal, balance) = (0.0, water.fastest_signal(), water.balance());
            water.restore(cells.into_iter(), Restored { time, fastest_signal, balance });
            water.advance(1e9, 200);
            let finite = |index: usize| water.depths()[index] >= 0.0 && water.velocity(index).is_finite();
            assert!((0..400).all(finite) && water.depths().iter().all(|depth| depth.is_finite()), "{number} {damage}");
            println!("number {number} of a cell is {damage}: {:.3} m³ of 400", water.volume());
        }
    }
}

/// Rain below zero is no rain.
#[test]
fn negative_rain_is_none() {
    let mut water = flat(8, 8);
    water.fill(1.0).expect("a sane level");
    water.set_rain(-1.0).expect("a finite rain");
    water.advance(10.0, 1000);
    assert_eq!(water.balance().rain, 0.0);
    assert_eq!(water.volume(), 64.0);
}

/// Numbers that are not finite, or out of range, are refused, and change nothing.
#[test]
fn numbers_out_of_range_are_refused() {
    let mut water = flat(8, 8);
    water.fill(1.0).expect("a sane level");
    for depth in [f32::NAN, f32::INFINITY, -0.1, 1e7] {
        assert!(water.set_water(|_, _| (depth, Vec2::ZERO)).is_err(), "{depth}");
    }
    for speed in [f32::NAN, f32::INFINITY, 1e5] {
        assert!(water.set_water(|_, _| (1.0, Vec2::new(0.0, speed))).is_err(), "{speed}");
    }
    assert!(water.fill(f32::NAN).is_err() && water.fill(f32::INFINITY).is_err());
    for number in [f32::NAN, f32::INFINITY, -1.0] {
        assert!(water.set_manning(number).is_err() && water.set_courant(number).is_err(), "{number}");
    }
    for number in [f32::NAN, f32::INFINITY, 1e30] {
        let push = |strength: f32, speed: f32| Push {
            cell: UVec2::ZERO,
            strength,
            velocity: Vec2::new(speed, 0.0),
            ..Default::default()
        };
        assert!(water.set_pushes(&[push(number, 1.0)]).is_err() && water.set_pushes(&[push(1.0, number)]).is_err());
    }
    for number in [f32::NAN, f32::INFINITY, -1.0] {
        assert!(water.set_displaced(&[Displaced { cell: UVec2::ZERO, depth: number }]).is_err(), "{number}");
        let force = Vec2::new(0.0, if number < 0.0 { 1e7 } else { number });
        assert!(water.set_pushes(&[Push { force, ..Default::default() }]).is_err(), "{number}");
    }
    assert!(water.set_displaced(&[Displaced { cell: UVec2::splat(1000), depth: 1.0 }]).is_err());
    assert!(water.set_pushes(&[Push { cell: UVec2::splat(1000), ..Default::default() }]).is_err());
    for number in [f32::NAN, f32::INFINITY] {
        assert!(water.set_rain(number).is_err(), "{number}");
        let source = |at: Vec2, radius: f32, rate: f32| vec![PointSource { at, radius, rate: rate.into() }];
        assert!(water.set_sources(source(Vec2::new(number, 0.0), 1.0, 1.0)).is_err());
        assert!(water.set_sources(source(Vec2::ZERO, number, 1.0)).is_err());
        assert!(water.set_sources(source(Vec2::ZERO, 1.0, number)).is_err());
        let stream = Edge::Stream { level: 1.0.into(), entering: number.into() };
        for edge in [Edge::Still(number.into()), stream, Edge::Level(number.into()), Edge::Discharge(number.into())] {
            assert!(water.set_edge(DomainSide::West, EdgePart::All, edge).is_err());
        }
    }
    assert!(water.set_edge(DomainSide::West, EdgePart::All, Edge::Level(Series::Table(Vec::new()))).is_err());
    water.advance(1.0, 100);
    assert_eq!(water.volume(), 64.0);
    assert_eq!(water.balance().expected(), 64.0);
}

/// A wall with a crest that is no number, or on a cell that is not there, is refused.
#[test]
fn walls_out_of_range_are_refused() {
    let mut water = flat(8, 6);
    assert!(water.set_wall(UVec2::new(3, 3), DomainSide::East, f32::NAN).is_err());
    for outside in [UVec2::new(8, 0), UVec2::new(0, 6), UVec2::new(u32::MAX, u32::MAX)] {
        assert!(water.set_wall(outside, DomainSide::East, 1.0).is_err());
    }
    // A face at the rim is an edge, and stays one.
    water.fill(1.0).expect("a sane level");
    water.set_edge(DomainSide::East, EdgePart::All, Edge::Open).expect("a sane edge");
    water.set_wall(UVec2::new(7, 2), DomainSide::East, CLOSED).expect("a cell of the domain");
    water.set_wall(UVec2::new(0, 2), DomainSide::West, CLOSED).expect("a cell of the domain");
    water.advance(5.0, 1000);
    assert_sane(&water, 1e-6);
}

/// Cells that a side does not have are refused with the number that it has.
#[test]
fn edges_beyond_a_side_are_refused() {
    let mut water = flat(8, 6);
    for cells in [5..7, 6..6, 0..0, 7..9, 0..u32::MAX] {
        let refused = water.set_edge(DomainSide::East, EdgePart::Cells(cells.clone()), Edge::Open);
        assert_eq!(refused, Err(ShallowWaterError::EdgeCells { cells, count: 6 }));
    }
    #[expect(clippy::reversed_empty_ranges, reason = "what a user may ask for by mistake")]
    let refused = water.set_edge(DomainSide::North, EdgePart::Cells(5..2), Edge::Open);
    assert!(refused.is_err());
}

/// A source outside gives nothing, one with a huge radius gives the same everywhere.
#[test]
fn sources_anywhere_are_booked() {
    let mut water = flat(16, 16);
    let source = |at: Vec2, radius: f32, rate: f32| PointSource { at, radius, rate: rate.into() };
    water
        .set_sources(vec![
            source(Vec2::new(1e30, -1e30), 1.0, 5.0),
            source(Vec2::ZERO, 1e30, 2.0),
            source(Vec2::new(7.9, 0.0), 3.0, 1.0),
        ])
        .expect("finite sources");
    water.advance(10.0, 10_000);
    println!("sources: {:.6} m³ of 30", water.balance().sources);
    assert!((water.balance().sources - 30.0).abs() < 1e-4);
    assert_sane(&water, 1e-6);
}
