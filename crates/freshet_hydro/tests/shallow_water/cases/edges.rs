//! What the edges of the domain do to the water.
use super::{Run, ShallowWater, land, still};
use freshet_hydro::{
    shallow_water::{DomainSide, Edge, EdgePart, PointSource, Series},
    waves::GRAVITY,
};
use glam::Vec2;

/// Level of still water over a flat bed at 0, where a level is a depth, m.
const LEVEL: f32 = 1.0;

/// A long wave that runs to an edge does not come back from an open one (a crest) and from one with still water behind
/// it (crest and trough); it comes back as all of itself from a wall or where a discharge is given, and upside down
/// from an edge with a given level.
pub fn reflect(run: Run) {
    println!("edge in the east | incoming (m) | comes back as (%)");
    for (edge, amplitude, expected, within) in [
        (Edge::Open, 0.02, 0.0, 0.01),
        (Edge::Open, 0.2, 0.0, 0.02),
        // None may enter, so a trough meets a wall.
        (Edge::Open, -0.02, 1.0, 0.01),
        (Edge::Still(LEVEL.into()), 0.02, 0.0, 0.01),
        (Edge::Still(LEVEL.into()), -0.02, 0.0, 0.01),
        (Edge::Still(LEVEL.into()), 0.2, 0.0, 0.01),
        (Edge::Still(LEVEL.into()), -0.2, 0.0, 0.01),
        (Edge::Wall, 0.02, 1.0, 0.01),
        (Edge::Wall, -0.02, 1.0, 0.01),
        (Edge::Discharge(0.0.into()), 0.02, 1.0, 0.01),
        (Edge::Discharge(0.0.into()), -0.02, 1.0, 0.01),
        (Edge::Level(LEVEL.into()), 0.02, -1.0, 0.03),
        (Edge::Level(LEVEL.into()), -0.02, -1.0, 0.03),
    ] {
        let back = reflected(run, edge.clone(), amplitude);
        println!("{edge:?} | {amplitude} | {:.2}", 100.0 * back);
        assert!((back - expected).abs() <= within, "{edge:?} {amplitude}: {back}");
    }
}

/// The farthest from rest that the water is after a wave of this `amplitude` (m) has met the edge in the east, as a
/// share of what it was on its way there.
fn reflected(run: Run, edge: Edge, amplitude: f64) -> f64 {
    let mut water = land(400, 3, 1.0, |_, _| 0.0);
    water.set_edge(DomainSide::East, EdgePart::All, edge).expect("a sane edge");
    let (g, level) = (f64::from(GRAVITY), f64::from(LEVEL));
    let rest = (g * level).sqrt();
    let wave = |at: Vec2, _| {
        let depth = level + amplitude * (-0.5 * (f64::from(at.x) / 15.0).powi(2)).exp();
        // A wave that runs east alone: u − 2c is that of rest.
        (depth as f32, Vec2::new((2.0 * ((g * depth).sqrt() - rest)) as f32, 0.0))
    };
    water.set_water(wave).expect("a sane wave");
    run(&mut water, 100.0 / rest);
    let incoming = farthest_from_rest(&water);
    run(&mut water, 200.0 / rest);
    farthest_from_rest(&water) / incoming
}

/// The largest rise or fall of the surface, m.
fn farthest_from_rest(water: &ShallowWater) -> f64 {
    let rises = water.depths().iter().map(|depth| f64::from(depth - LEVEL));
    rises.max_by(|a, b| a.abs().total_cmp(&b.abs())).expect("at least one cell")
}

/// A stream goes on through its edges as if there were none, and a wave on it leaves downstream and upstream.
pub fn a_stream_passes(run: Run) {
    let mut water = land(200, 3, 1.0, |_, _| 0.0);
    for (side, entering) in [(DomainSide::West, 0.8), (DomainSide::East, -0.8)] {
        let stream = Edge::Stream { level: LEVEL.into(), entering: entering.into() };
        water.set_edge(side, EdgePart::All, stream).expect("a sane edge");
    }
    let wave = |at: Vec2, _| (LEVEL + 0.1 * (-0.5 * (at.x / 10.0).powi(2)).exp(), Vec2::new(0.8, 0.0));
    water.set_water(wave).expect("a sane wave");
    run(&mut water, 200.0);
    let speeds = (0..600).map(|index| f64::from((water.velocity(index).x - 0.8).abs())).fold(0.0, f64::max);
    let rise = farthest_from_rest(&water);
    println!("after the wave: {rise:.1e} m, {speeds:.1e} m/s");
    assert!(rise < 5e-4 && speeds < 2e-3);
}

/// A ring that leaves a square at all angles through edges with still water behind them leaves less than 8 % of its
/// height behind.
pub fn a_ring_leaves(run: Run) {
    println!("ring, first as | at the edge (m) | left behind (m) | share (%)");
    for amplitude in [0.1, -0.1] {
        let mut water = land(200, 200, 1.0, |_, _| 0.0);
        for side in DomainSide::ALL {
            water.set_edge(side, EdgePart::All, Edge::Still(LEVEL.into())).expect("a sane level");
        }
        let hump = |at: Vec2, _| still(1.0 + amplitude * (-0.5 * f64::from(at.length_squared()) / 100.0).exp());
        water.set_water(hump).expect("a sane wave");
        let celerity = f64::from(GRAVITY * LEVEL).sqrt();
        run(&mut water, 85.0 / celerity);
        let there = farthest_from_rest(&water).abs();
        run(&mut water, 115.0 / celerity);
        let left = farthest_from_rest(&water).abs();
        println!("{amplitude} | {there:.5} | {left:.5} | {:.1}", 100.0 * left / there);
        assert!(left <= 0.08 * there, "{left} {there}");
    }
}

/// A tide of 1 m in a basin 200 m long: the water beside the edge stands at the level of the edge, and the whole basin
/// follows.
pub fn a_tide_is_followed(run: Run) {
    let tide = Series::Tide { mean: 2.0, amplitude: 0.5, period: 1200.0, high_water: 600.0 };
    let mut water = land(100, 3, 2.0, |_, _| 0.0);
    water.set_manning(0.03).expect("a sane roughness");
    water.fill(1.5).expect("a sane level");
    water.set_edge(DomainSide::East, EdgePart::All, Edge::Level(tide.clone())).expect("a sane tide");
    println!("tide: time (s) | given (m) | beside the edge | at the far end");
    let (mut worst, mut far) = (0.0_f32, 0.0_f32);
    for turn in 1..=40 {
        run(&mut water, 60.0);
        let given = tide.at(water.time());
        let (near, end) = (water.depths()[99], water.depths()[0]);
        (worst, far) = (worst.max((near - given).abs()), far.max((end - given).abs()));
        if turn % 5 == 0 {
            println!("{} | {given:.4} | {near:.4} | {end:.4}", turn * 60);
        }
    }
    println!("off by at most {worst:.4} m beside the edge, {far:.4} m at the far end");
    assert!(worst <= 0.003 && far <= 0.06, "{worst} {far}");
}

/// A discharge onto dry land enters to the last litre, and through the lowest bed.
pub fn a_discharge_enters_dry_land(run: Run) {
    let mut water = land(60, 41, 1.0, |x, z| 0.02 * z * z - 0.05 * x);
    water.set_edge(DomainSide::West, EdgePart::All, Edge::Discharge(5.0.into())).expect("a sane discharge");
    println!("5 m³/s onto dry land: time (s) | entered (m³) | there (m³)");
    for turn in 1..=5 {
        run(&mut water, 2.0);
        let entered = -water.balance().left[DomainSide::West as usize];
        println!("{} | {entered:.6} | {:.6}", 2 * turn, water.volume());
        assert!((entered / f64::from(10 * turn) - 1.0).abs() <= 1e-6, "{entered}");
        assert!((water.volume() / entered - 1.0).abs() <= 1e-6, "{}", water.volume());
    }
    let column = |row: usize| water.depths()[row * 60];
    assert!(column(20) > 0.1 && column(0) == 0.0 && column(40) == 0.0, "only the bottom of the valley carries it");
}

/// A discharge that is taken, and a drain: they get what there is and no more; no depth falls below zero, and the book
/// is right.
pub fn no_more_is_taken_than_there_is(run: Run) {
    println!("taken by | asked for (m³) | there was | taken | left");
    for drain in [false, true] {
        let mut water = land(30, 20, 1.0, |x, _| 0.05 * x);
        water.fill(0.2).expect("a sane level");
        if drain {
            let sink = PointSource { at: Vec2::new(-10.0, 0.0), radius: 3.0, rate: (-20.0).into() };
            water.set_sources(vec![sink]).expect("a sane drain");
        } else {
            water.set_edge(DomainSide::West, EdgePart::All, Edge::Discharge((-20.0).into())).expect("a sane discharge");
        }
        let before = water.volume();
        for _ in 0..60 {
            run(&mut water, 1.0);
            assert!(water.depths().iter().all(|depth| *depth >= 0.0));
            assert!((water.volume() - water.balance().expected()).abs() <= 1e-6 * before);
        }
        let taken = before - water.volume();
        let name = if drain { "a drain" } else { "an edge" };
        println!("{name} | 1200 | {before:.2} | {taken:.2} | {:.3}", water.volume());
        assert!(taken <= before && taken > 0.9 * before, "{taken}");
    }
}

/// An edge that is given for some cells of a side is there and nowhere else.
pub fn a_part_of_a_side(run: Run) {
    for side in DomainSide::ALL {
        let mut water = land(24, 24, 1.0, |_, _| 0.0);
        water.set_edge(side, EdgePart::Cells(5..9), Edge::Level(1.0.into())).expect("cells of the side");
        run(&mut water, 0.01);
        let wet: Vec<usize> = (0..24 * 24).filter(|&index| water.depths()[index] > 1e-6).collect();
        let expected: Vec<usize> = (5..9)
            .map(|k| match side {
                DomainSide::West => k * 24,
                DomainSide::East => k * 24 + 23,
                DomainSide::North => k,
                DomainSide::South => 23 * 24 + k,
            })
            .collect();
        assert_eq!(wet, expected, "{side:?}");
        let entered = water.balance().left.map(|left| left < 0.0);
        assert_eq!(entered, DomainSide::ALL.map(|other| other == side));
    }
}
