//! Rings, foam and dye against what theory says.
use core::f32::consts::TAU;
use freshet_hydro::fields::{
    Cells,
    foam::{self, FoamSources, Stir},
    rings::{RingStep, Rings, celerity_squared},
    transport::{Stream, Transport, TransportStep},
};
use glam::{IVec2, UVec2, Vec2, Vec4, ivec2, uvec2, vec2};
use proptest::prelude::*;

const DT: f32 = 1.0 / 60.0;
const STILL: RingStep = RingStep { dt: DT, decay: f32::INFINITY, absorbs: [false; 4] };

fn cells(size: UVec2, side: f32) -> Cells {
    Cells { size, side }
}

/// Centre of a cell, m from the corner.
fn place(at: IVec2, side: f32) -> Vec2 {
    (at.as_vec2() + 0.5) * side
}

/// A Gaussian hump of `volume` and standard deviation `radius` around `center`.
fn hump(rings: &mut Rings, center: Vec2, radius: f32, volume: f32) {
    for (i, at) in rings.cells.iter().enumerate() {
        let distance = place(at, rings.cells.side).distance_squared(center);
        let density = (-0.5 * distance / (radius * radius)).exp() / (TAU * radius * radius);
        rings.waves[i].x += volume * density;
    }
}

/// Distance from `from` along `direction` at which the water stands highest, m, between cells by a parabola.
fn crest(rings: &Rings, from: IVec2, direction: IVec2, range: std::ops::Range<i32>) -> f32 {
    let height = |n: i32| rings.cells.index(from + direction * n).map_or(0.0, |i| rings.waves[i].x);
    let top = range.max_by(|a, b| height(*a).total_cmp(&height(*b))).expect("a range of cells");
    let (a, b, c) = (height(top - 1), height(top), height(top + 1));
    (top as f32 + 0.5 * (a - c) / (a - 2.0 * b + c)) * rings.cells.side
}

/// Speed of the ring's crest between two times after the hump, m/s: a hump's crest is not at c t, but moves with c.
fn ring_speed(side: f32, direction: IVec2, steps: [u32; 2]) -> f32 {
    let size = (30.0 / side) as u32 / 2 * 2 + 1;
    let mut rings = Rings::new(cells(UVec2::splat(size), side), 1.2, |_| 50.0, |_| Vec2::ZERO);
    let middle = IVec2::splat(size as i32 / 2);
    hump(&mut rings, place(middle, side), 0.75, 0.1);
    let mut at = steps.map(|_| 0.0);
    for step in 1..=steps[1] {
        rings.step(&STILL);
        if let Some(n) = steps.iter().position(|&s| s == step) {
            at[n] = crest(&rings, middle, direction, 4..size as i32 / 2 - 2) * direction.as_vec2().length();
        }
    }
    (at[1] - at[0]) / ((steps[1] - steps[0]) as f32 * DT)
}

#[test]
fn a_ring_grows_with_its_celerity_in_every_direction_and_on_every_grid() {
    let expected = celerity_squared(TAU / 1.2, 50.0).sqrt();
    assert!((expected - (9.81 * 1.2 / TAU).sqrt()).abs() < 1e-4);
    for (side, direction) in [(0.25, IVec2::X), (0.25, IVec2::NEG_Y), (0.25, IVec2::ONE), (0.125, IVec2::X)] {
        let speed = ring_speed(side, direction, [180, 480]);
        println!("cells of {side} m, towards {direction}: {speed} m/s of {expected}");
        assert!((speed / expected - 1.0).abs() < 0.03, "{side} m, {direction}: {speed} m/s, not {expected}");
    }
}

#[test]
fn a_ring_comes_back_from_a_bank_upright_and_as_if_from_its_mirror_image() {
    let (side, bank) = (0.25, 40);
    // A bank along z, beyond which the land is dry; without it the ring's mirror image would come from behind it.
    let mut walled =
        Rings::new(cells(uvec2(80, 81), side), 1.2, |at| if at.x < bank { 9.0 } else { -1.0 }, |_| Vec2::ZERO);
    let mut mirrored = Rings::new(cells(uvec2(80, 81), side), 1.2, |_| 9.0, |_| Vec2::ZERO);
    let source = place(ivec2(24, 40), side);
    hump(&mut walled, source, 0.6, 0.05);
    walled
        .waves
        .iter_mut()
        .enumerate()
        .filter(|(i, _)| *i as i32 % 80 >= bank)
        .for_each(|(_, wave)| *wave = Vec2::ZERO);
    hump(&mut mirrored, source, 0.6, 0.05);
    hump(&mut mirrored, vec2(2.0 * bank as f32 * side - source.x, source.y), 0.6, 0.05);
    for _ in 0..300 {
        walled.step(&STILL);
        mirrored.step(&STILL);
    }
    let highest = mirrored.waves.iter().map(|wave| wave.x).fold(0.0, f32::max);
    for (i, at) in walled.cells.iter().enumerate().filter(|(_, at)| at.x < bank) {
        let (a, b) = (walled.waves[i].x, mirrored.waves[i].x);
        assert!((a - b).abs() < 1e-3 * highest, "{at}: {a} behind a bank, {b} with a mirror image");
    }
    // The crest on its way back, upright, after the way to the bank and from there.
    let back = crest(&walled, ivec2(bank - 1, 40), IVec2::NEG_X, 1..16) + 0.5 * side;
    let way = bank as f32 * side - source.x + back;
    let expected = celerity_squared(TAU / 1.2, 9.0).sqrt() * 300.0 * DT;
    assert!((way - expected).abs() < 0.05 * expected, "after {way} m, expected {expected} m");
    let height = walled.waves[walled.cells.index(ivec2(bank - 1 - (back / side) as i32, 40)).expect("a cell")].x;
    assert!(height > 0.0, "a wall turns no crest into a trough");
}

#[test]
fn a_ring_holds_the_volume_that_raised_it() {
    let land = |at: IVec2| if (at - ivec2(30, 12)).length_squared() < 50 { -0.5 } else { 0.4 };
    let mut rings = Rings::new(cells(uvec2(47, 31), 0.2), 1.2, land, |_| Vec2::ZERO);
    let mut heights = vec![0.0; rings.cells.count()];
    // A body half on a bank: only what it displaces in the water counts.
    let mut displaced = 0.0;
    for at in [ivec2(21, 12), ivec2(22, 12), ivec2(22, 13), ivec2(23, 13), ivec2(10, 0), ivec2(24, 14)] {
        let i = rings.cells.index(at).expect("a cell");
        heights[i] = 0.3;
        displaced += if land(at) > 0.0 { 0.3 * f64::from(rings.cells.area()) } else { 0.0 };
    }
    rings.raise(&heights);
    assert!((rings.volume() / displaced - 1.0).abs() < 1e-5, "{} m³ of {displaced}", rings.volume());
    // No spike: a single raised cell is left with a quarter of its height.
    let alone = rings.cells.index(ivec2(10, 0)).expect("a cell");
    assert!((rings.waves[alone].x - 0.3 * 0.5 * 0.75).abs() < 1e-6);
    for _ in 0..2000 {
        rings.step(&STILL);
    }
    assert!((rings.volume() / displaced - 1.0).abs() < 1e-4, "{} m³ of {displaced}", rings.volume());
}

#[test]
fn rings_decay_to_one_over_e_in_their_time() {
    let mut rings = Rings::new(cells(uvec2(40, 30), 0.25), 1.2, |_| 2.0, |_| Vec2::ZERO);
    hump(&mut rings, vec2(5.0, 4.0), 0.6, 0.1);
    rings.spread(&STILL);
    let before = rings.energy(DT);
    for _ in 0..120 {
        rings.step(&RingStep { decay: 4.0, ..STILL });
    }
    // Energy goes with the square of the amplitude: over 2 s of a decay of 4 s by 1/e.
    let left = rings.energy(DT) / before;
    assert!((left * 1f64.exp() - 1.0).abs() < 0.01, "{left}");
}

#[test]
fn an_absorbing_rim_sends_little_back() {
    let absorbed = |absorbs: [bool; 4]| {
        let mut rings = Rings::new(cells(uvec2(96, 96), 0.25), 1.2, |_| 9.0, |_| Vec2::ZERO);
        hump(&mut rings, Vec2::splat(12.0), 0.6, 0.1);
        rings.spread(&STILL);
        let before = rings.energy(DT);
        (0..1800).for_each(|_| rings.step(&RingStep { absorbs, ..STILL }));
        rings.energy(DT) / before
    };
    assert!(absorbed([false; 4]) > 0.99);
    let left = absorbed([true; 4]);
    assert!(left < 2e-3, "{left} of the energy is left");
}

#[test]
fn rings_drift_with_the_current() {
    let drift = vec2(0.8, -0.5);
    let mut rings = Rings::new(cells(uvec2(121, 121), 0.25), 1.2, |_| 9.0, |_| drift);
    hump(&mut rings, place(IVec2::splat(60), 0.25), 0.75, 0.1);
    let alone = {
        let mut still = rings.clone();
        still.current.fill(Vec2::ZERO);
        (0..360).for_each(|_| still.step(&STILL));
        still
    };
    (0..360).for_each(|_| rings.step(&STILL));
    // Where the ring's middle is: the centroid of its energy.
    let middle = |rings: &Rings| {
        let weighted = |sum: (Vec2, f32), (i, at): (usize, IVec2)| {
            let weight = rings.waves[i].x.powi(2);
            (sum.0 + weight * place(at, 0.25), sum.1 + weight)
        };
        let (sum, weight) = rings.cells.iter().enumerate().fold((Vec2::ZERO, 0.0), weighted);
        sum / weight
    };
    let moved = middle(&rings) - middle(&alone);
    assert!(moved.distance(drift * 6.0) < 0.02 * 6.0, "moved {moved} m, not {}", drift * 6.0);
    let height = |rings: &Rings| rings.waves.iter().map(|wave| wave.x).fold(0.0, f32::max);
    let kept = height(&rings) / height(&alone);
    println!("{kept} of the height is left after 6 s of drift");
    assert!(kept > 0.9, "{kept} of the height is left");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn the_energy_of_rings_is_kept_between_banks(
        seed in proptest::collection::vec(-0.2_f32..0.2, 24 * 17), banks in proptest::collection::vec(0_i32..24, 6),
        depth in 0.05_f32..5.0, tight: bool,
    ) {
        let land = |at: IVec2| banks.iter().any(|&b| (at - ivec2(b, b * 7 % 17)).abs().max_element() < 2);
        let depth = |at: IVec2| if land(at) { -0.3 } else { depth * (1.0 + 0.5 * (at.x as f32).sin()) };
        // As fast as the scheme allows, or as usual.
        let side = if tight { celerity_squared(TAU / 3.0, 9.0).sqrt() * DT / 0.7 } else { 0.25 };
        let mut rings = Rings::new(cells(uvec2(24, 17), side), 3.0, depth, |_| Vec2::ZERO);
        rings.raise(&seed);
        rings.spread(&STILL);
        let mut last = rings.energy(DT);
        prop_assert!(last >= 0.0);
        for step in 0..400 {
            rings.step(&STILL);
            let energy = rings.energy(DT);
            prop_assert!((energy - last).abs() <= 1e-4 * last, "step {step}: {last} became {energy}");
            last = energy;
        }
    }

    /// A current that runs into a bank or into other depths does work on waves; one that only carries them does none.
    #[test]
    fn the_energy_of_drifting_rings_never_grows(
        seed in proptest::collection::vec(-0.2_f32..0.2, 24 * 17), flow in (-1.5_f32..1.5, -1.5_f32..1.5), depth in 0.05_f32..5.0,
    ) {
        let mut rings = Rings::new(cells(uvec2(24, 17), 0.25), 3.0, |_| depth, |_| flow.into());
        rings.raise(&seed);
        rings.spread(&STILL);
        let first = rings.energy(DT);
        for step in 0..400 {
            rings.step(&RingStep { absorbs: [true; 4], ..STILL });
            let energy = rings.energy(DT);
            prop_assert!(energy <= first * 1.001, "step {step}: {first} became {energy}");
        }
        prop_assert!(rings.energy(DT) < 0.05 * first);
    }
}

const LASTING: TransportStep = TransportStep { dt: DT, spreading: 0.0, dye_life: f32::INFINITY, foam_life: 1e30 };

/// Where foam and dye are, m.
fn centroid(transport: &Transport, channel: usize) -> Vec2 {
    let sum = |sum: (Vec2, f32), (i, at): (usize, IVec2)| {
        let density = transport.matter[i][channel];
        (sum.0 + density * place(at, transport.cells.side), sum.1 + density)
    };
    let (sum, total) = transport.cells.iter().enumerate().fold((Vec2::ZERO, 0.0), sum);
    sum / total
}

fn spill(transport: &mut Transport, center: Vec2, radius: f32, matter: Vec4) {
    for (i, at) in transport.cells.iter().enumerate() {
        let distance = place(at, transport.cells.side).distance_squared(center);
        transport.matter[i] += matter * (-0.5 * distance / (radius * radius)).exp();
    }
}

#[test]
fn dye_and_foam_are_kept_and_move_with_the_flow() {
    let velocity = vec2(0.9, 0.4);
    let stream = |_| Stream { velocity, depth: 1.0, birth: 0.0 };
    let mut transport = Transport::new(cells(uvec2(120, 80), 0.25), LASTING.foam_life, stream);
    spill(&mut transport, vec2(6.0, 6.0), 0.6, Vec4::new(0.8, 1.0, 2.0, 0.5));
    let (before, from) = (transport.total(), [0, 1, 2, 3].map(|channel| centroid(&transport, channel)));
    for _ in 0..600 {
        transport.step(&TransportStep { spreading: 0.01, ..LASTING });
    }
    let ratio = transport.total() / before;
    assert!((ratio - 1.0).abs().max_element() < 1e-4, "{ratio} is left");
    for (channel, from) in from.iter().enumerate() {
        let moved = centroid(&transport, channel) - *from;
        assert!(moved.distance(velocity * 10.0) < 0.01 * 10.0 * velocity.length(), "channel {channel} moved {moved} m");
    }
    let peak = transport.matter.iter().map(|matter| matter.x).fold(0.0, f32::max);
    println!("{} of the peak of foam is left after 10 s", peak / 0.8);
    assert!(peak > 0.4, "the scheme smears: {peak} is left of 0.8");
}

#[test]
fn dye_spreads_as_the_diffusion_equation_says() {
    let mut transport =
        Transport::new(cells(uvec2(101, 101), 0.25), 1e30, |_| Stream { depth: 1.0, ..Default::default() });
    let (center, radius, spreading) = (Vec2::splat(12.625), 0.8, 0.1);
    spill(&mut transport, center, radius, Vec4::ONE);
    (0..600).for_each(|_| transport.step(&TransportStep { spreading, ..LASTING }));
    let variance = transport.cells.iter().enumerate().fold((0.0, 0.0), |(sum, total), (i, at)| {
        let dye = transport.matter[i].y;
        (sum + dye * (place(at, 0.25).x - center.x).powi(2), total + dye)
    });
    let (variance, expected) = (variance.0 / variance.1, radius * radius + 2.0 * spreading * 10.0);
    assert!((variance / expected - 1.0).abs() < 0.01, "variance {variance} m², not {expected}");
}

#[test]
fn nothing_crosses_banks_and_everything_may_leave_the_water() {
    let bank = |at: IVec2| if at.y < 20 { 1.0 } else { -0.2 };
    // Against the bank, where the current may be as wrong as it likes.
    let into = Stream { velocity: vec2(0.0, 0.7), ..Default::default() };
    let mut walled = Transport::new(cells(uvec2(40, 40), 0.25), 1e30, |at| Stream { depth: bank(at), ..into });
    spill(&mut walled, vec2(5.0, 2.5), 0.5, Vec4::ONE);
    walled.matter.iter_mut().skip(20 * 40).for_each(|matter| *matter = Vec4::ZERO);
    let before = walled.total();
    (0..600).for_each(|_| walled.step(&TransportStep { spreading: 0.05, ..LASTING }));
    assert!((walled.total() / before - 1.0).abs().max_element() < 1e-4);
    assert!(walled.matter.iter().skip(20 * 40).all(|matter| *matter == Vec4::ZERO), "land stays dry");
    assert!(walled.matter.iter().all(|matter| matter.min_element() > -1e-6), "no density is negative");

    let mut open = Transport::new(cells(uvec2(40, 40), 0.25), 1e30, |at| Stream {
        depth: if at.y < 20 { 1.0 } else { -1e6 },
        ..into
    });
    spill(&mut open, vec2(5.0, 2.5), 0.5, Vec4::ONE);
    (0..900).for_each(|_| open.step(&LASTING));
    assert!(open.total().max_element() < 1e-3, "the river leaves its map: {} is left", open.total());
}

#[test]
fn foam_decays_at_its_rate_and_dye_fades_at_its_own() {
    let mut transport = Transport::new(cells(uvec2(20, 20), 0.5), 3.0, |_| Stream { depth: 1.0, ..Default::default() });
    spill(&mut transport, vec2(5.0, 5.0), 1.0, Vec4::ONE);
    let before = transport.total();
    (0..120).for_each(|_| transport.step(&TransportStep { foam_life: 3.0, dye_life: 5.0, ..LASTING }));
    let left = transport.total() / before;
    assert!((left.x / (-2.0_f32 / 3.0).exp() - 1.0).abs() < 0.01, "{left}");
    assert!((left.y / (-2.0_f32 / 5.0).exp() - 1.0).abs() < 0.01, "{left}");
}

#[test]
fn foam_rests_where_birth_and_decay_balance_and_never_covers_more_than_all() {
    let (birth, life) = (0.7, 6.0);
    let rest = foam::equilibrium(birth, life);
    let mut density = 0.0;
    for _ in 0..6000 {
        density = foam::after(density, birth, life, DT);
    }
    assert!((density - rest).abs() < 1e-4 && rest < 1.0);
    assert_eq!(foam::equilibrium(0.0, life), 0.0);
    // An unreasonably stormy place in one long step.
    assert!(foam::after(0.0, 1e4, 1e3, 1.0) <= 1.0);
}

#[test]
fn foam_is_born_where_its_criteria_hold_and_nowhere_else() {
    let sources = FoamSources {
        shore: 0.15,
        shore_depth: 0.2,
        shear: 0.2,
        shear_threshold: 0.25,
        breaking: 0.5,
        breaking_threshold: 0.1,
        speed: 0.1,
        speed_threshold: 1.2,
        bodies: 1.0,
    };
    let calm = Stir { depth: 2.0, crest: 0.3, shear: 0.2, convergence: 0.05, speed: 1.1, rim: 0.0, slip: 3.0 };
    assert_eq!(sources.birth(&calm), 0.0);
    let (shore, breaking) = (Stir { depth: 0.05, crest: -0.1, ..calm }, Stir { depth: 0.05, ..calm });
    assert!((sources.birth(&shore) - 0.15 * 0.75 * foam::CALM_SHORE).abs() < 1e-6);
    assert!((sources.birth(&breaking) - 0.15 * 0.75).abs() < 1e-6, "waves that run up make all of the shore's foam");
    assert!((sources.birth(&Stir { shear: 1.25, ..calm }) - 0.2).abs() < 1e-6);
    assert!((sources.birth(&Stir { convergence: 0.5, ..calm }) - 0.2).abs() < 1e-6);
    assert!((sources.birth(&Stir { speed: 2.2, ..calm }) - 0.1).abs() < 1e-6);
    assert!((sources.birth(&Stir { rim: 0.5, ..calm }) - 1.5).abs() < 1e-6);
    assert_eq!(sources.birth(&Stir { depth: 0.0, ..breaking }), 0.0, "no foam on land");
    // Water that runs together from both sides, and water that only turns.
    assert_eq!(foam::convergence(vec2(-0.5, 0.1), vec2(0.2, -0.25)), 0.75);
    assert_eq!(foam::convergence(vec2(0.0, 1.0), vec2(-1.0, 0.0)), 0.0);
    // Simple shear counts in full, a turn as a whole not at all.
    assert_eq!(foam::shear(Vec2::ZERO, vec2(0.8, 0.0)), 0.8);
    assert_eq!(foam::shear(vec2(0.0, 0.5), vec2(-0.5, 0.0)), 0.0);
}
