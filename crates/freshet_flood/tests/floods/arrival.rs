//! Arrival maps of floods whose arrival is known.

use crate::known::{WET, around, arrival, disc, errors, flood, front, ring, roughness, springs};
use freshet_flood::arrival::{ArrivalBuilder, ArrivalError, ArrivalMap, ArrivalOptions};
use freshet_flood::step::{Quantity, Step};
use freshet_hydro::grid::Grid;
use glam::{UVec2, Vec2, uvec2, vec2};
use proptest::prelude::*;

const CENTRE: Vec2 = vec2(50.0, 50.0);
const SIZE: UVec2 = uvec2(101, 101);
/// Cells a second of the fronts below; steps are 60 s apart.
const SPEED: f32 = 0.1;

#[test]
fn the_level_tells_when_a_ring_arrives() {
    let steps = flood(SIZE, 8, 60.0, ring(CENTRE, SPEED));
    // The depth is the threshold 0.2 cells behind the front.
    let truth = |place: Vec2| (place.distance(CENTRE) + 10.0 * WET) / SPEED;
    let (mean, most) = errors(&arrival(&steps, ArrivalOptions::default()), truth, |after| after > 60.0);
    assert!(mean < 0.12 * 60.0 && most < 0.4 * 60.0, "{mean} s, at most {most} s");
}

#[test]
fn a_front_without_levels_runs_evenly_between_the_steps() {
    let steps = flood(SIZE, 8, 60.0, disc(CENTRE, SPEED));
    let truth = |place: Vec2| place.distance(CENTRE) / SPEED;
    let map = arrival(&steps, ArrivalOptions::default());
    // Not in the last interval, whose end nothing tells.
    let (mean, most) = errors(&map, truth, |after| after > 60.0 && after < 360.0);
    assert!(mean < 0.1 * 60.0 && most < 0.35 * 60.0, "{mean} s, at most {most} s");
}

/// The fill of a queue without a Gaussian: within each step the cells are numbered by layers of eight neighbours.
fn plain_fill(steps: &[Step]) -> ArrivalMap {
    let is_wet = |step: &Step, cell: UVec2| *step.get(Quantity::Depth).unwrap().get(cell).unwrap() >= WET;
    let mut after = steps[0].get(Quantity::Depth).unwrap().map(|depth| if *depth >= WET { 0.0 } else { f32::NAN });
    for pair in steps.windows(2) {
        let is_new = |map: &Grid<f32>, cell: UVec2| is_wet(&pair[1], cell) && map.get(cell).unwrap().is_nan();
        let mut layers: Vec<Vec<UVec2>> = Vec::new();
        let mut filled = after.clone();
        loop {
            let touches = |cell: UVec2| around(cell, after.size()).any(|other| !filled.get(other).unwrap().is_nan());
            let mut layer: Vec<UVec2> =
                filled.cells().filter(|cell| is_new(&filled, *cell) && touches(*cell)).collect();
            if layer.is_empty() && layers.is_empty() {
                layer.extend(filled.cells().filter(|cell| is_new(&filled, *cell)).take(1));
            }
            if layer.is_empty() {
                break;
            }
            for cell in &layer {
                let index = filled.index(*cell).unwrap();
                filled.values_mut()[index] = 0.0;
            }
            layers.push(layer);
        }
        for (number, layer) in layers.iter().enumerate() {
            let share = (number + 1) as f64 / layers.len() as f64;
            for cell in layer {
                let index = after.index(*cell).unwrap();
                after.values_mut()[index] = (pair[0].time + share * (pair[1].time - pair[0].time)) as f32;
            }
        }
    }
    ArrivalMap { start: 0.0, after }
}

#[test]
fn fronts_are_rounder_than_those_of_a_plain_fill() {
    // Nine cells a step, so that steps alone do not make a front round.
    let steps = flood(SIZE, 6, 90.0, disc(CENTRE, SPEED));
    let (map, plain) = (arrival(&steps, front(14)), plain_fill(&steps));
    for time in [135.0, 225.0, 315.0] {
        let (ours, theirs) = (roughness(&map, CENTRE, time), roughness(&plain, CENTRE, time));
        assert!(ours < 0.02 && ours < 0.4 * theirs, "at {time} s: {ours}, plain {theirs}");
    }
}

#[test]
fn water_springs_up_at_its_sources_only() {
    let two = |place: Vec2, time: f32| {
        let late = ring(vec2(80.0, 30.0), SPEED)(place, time - 100.0);
        ring(vec2(20.0, 60.0), SPEED)(place, time).max(late)
    };
    let map = arrival(&flood(SIZE, 8, 60.0, two), ArrivalOptions::default());
    let springs = springs(&map);
    assert_eq!(springs.len(), 2, "{springs:?}");
    for (spring, source) in springs.iter().zip([vec2(80.0, 30.0), vec2(20.0, 60.0)]) {
        assert!(spring.as_vec2().distance(source) < 4.0, "{springs:?}");
    }
}

#[test]
fn water_goes_around_an_island_and_does_not_come_through_it() {
    // A wall one cell thick from north to south, open at its northern end; behind it the water comes around.
    let wall = |place: Vec2| place.x == 50.0 && place.y > 10.0;
    let gap = vec2(50.0, 5.0);
    let way = move |place: Vec2| {
        if place.x < 50.0 {
            place.distance(vec2(40.0, 50.0))
        } else {
            gap.distance(vec2(40.0, 50.0)) + place.distance(gap)
        }
    };
    let depth = |place: Vec2, time: f32| if !wall(place) && way(place) < SPEED * time { 1.0 } else { 0.0 };
    let map = arrival(&flood(SIZE, 24, 60.0, depth), front(14));
    let at = |x: u32, y: u32| *map.after.get(uvec2(x, y)).unwrap();
    for y in [20, 50, 80] {
        let (before, behind) = (at(49, y), at(51, y));
        assert!(at(50, y).is_nan());
        assert!((before - way(vec2(49.0, y as f32)) / SPEED).abs() < 45.0);
        assert!((behind - way(vec2(51.0, y as f32)) / SPEED).abs() < 45.0, "{behind}");
    }
    assert_eq!(springs(&map).len(), 1);
}

#[test]
fn the_first_wetting_counts_also_where_water_recedes_and_returns() {
    let tide = |place: Vec2, time: f32| (1.0 + (time / 120.0).sin() - 0.05 * place.x).max(0.0);
    let steps = flood(uvec2(60, 5), 30, 30.0, tide);
    let map = arrival(&steps, ArrivalOptions::default());
    for (cell, after) in map.after.iter() {
        let first = steps.iter().position(|step| *step.get(Quantity::Depth).unwrap().get(cell).unwrap() >= WET);
        match first {
            None => assert!(after.is_nan()),
            Some(0) => assert_eq!(*after, 0.0),
            Some(first) => {
                assert!(*after > steps[first - 1].time as f32 && *after <= steps[first].time as f32, "{cell} {after}");
            }
        }
    }
}

#[test]
fn steps_that_do_not_belong_together_are_refused() {
    let step = |time: f64, columns: u32| {
        Step::new(time).with(Quantity::Depth, Grid::from_fn(uvec2(columns, 2), 1.0, |_| 1.0).unwrap())
    };
    let mut builder = ArrivalBuilder::new(ArrivalOptions::default()).unwrap();
    assert_eq!(builder.clone().finish(), Err(ArrivalError::NoSteps));
    builder.add(&step(5.0, 3)).unwrap();
    assert_eq!(builder.add(&Step::new(6.0)), Err(ArrivalError::NoDepth(6.0)));
    assert_eq!(builder.add(&step(5.0, 3)), Err(ArrivalError::Time { found: 5.0, before: 5.0 }));
    assert!(builder.add(&step(f64::NAN, 3)).is_err());
    let message = builder.add(&step(6.0, 4)).unwrap_err().to_string();
    assert_eq!(message, "the step at 6 s has 4 × 2 cells, the first one 3 × 2");
    for (radius, threshold, level_share) in [(101, 0.02, 0.7), (14, 0.0, 0.7), (14, f32::NAN, 0.7), (14, 0.02, 1.1)] {
        assert!(ArrivalBuilder::new(ArrivalOptions { radius, threshold, level_share }).is_err());
    }
}

/// The steps with columns and rows exchanged, or mirrored along x.
fn turned(steps: &[Step], from: impl Fn(UVec2) -> UVec2, size: UVec2) -> Vec<Step> {
    let turn = |step: &Step| {
        let depth = step.get(Quantity::Depth).unwrap();
        Step::new(step.time)
            .with(Quantity::Depth, Grid::from_fn(size, 5.0, |cell| *depth.get(from(cell)).unwrap()).unwrap())
    };
    steps.iter().map(turn).collect()
}

fn bits(map: &ArrivalMap) -> Vec<u32> {
    map.after.values().iter().map(|after| after.to_bits()).collect()
}

/// Depths of a few steps without any sense.
fn any_flood() -> impl Strategy<Value = Vec<Step>> {
    (2_u32..14, 2_u32..14, 1_usize..6).prop_flat_map(|(columns, rows, count)| {
        let depth = prop_oneof![3 => Just(0.0_f32), 1 => Just(f32::NAN), 3 => 0.0_f32..0.1, 3 => 0.0_f32..3.0];
        let depths = prop::collection::vec(prop::collection::vec(depth, (columns * rows) as usize), count);
        depths.prop_map(move |depths| {
            let step = |(index, depths)| {
                let depth = Grid::new(uvec2(columns, rows), 5.0, depths).unwrap();
                Step::new(100.0 + 30.0 * index as f64).with(Quantity::Depth, depth)
            };
            depths.into_iter().enumerate().map(step).collect()
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_flood_arrives_between_its_steps_and_from_its_sources(steps in any_flood()) {
        let map = arrival(&steps, ArrivalOptions::default());
        for (cell, after) in map.after.iter() {
            let depth = |step: &Step| *step.get(Quantity::Depth).unwrap().get(cell).unwrap();
            match steps.iter().position(|step| depth(step) >= WET) {
                None => prop_assert!(after.is_nan()),
                Some(0) => prop_assert_eq!(*after, 0.0),
                Some(first) => {
                    let end = (steps[first].time - steps[0].time) as f32;
                    prop_assert!(*after > end - 30.0 && *after <= end);
                }
            }
        }
        // Wherever a cell is reached before its neighbours, no cell around it was wet at the step before.
        for spring in springs(&map) {
            let here = *map.after.get(spring).unwrap();
            let first = (here / 30.0).ceil();
            for other in around(spring, map.after.size()) {
                let there = *map.after.get(other).unwrap();
                prop_assert!(there.is_nan() || there >= here);
                prop_assert!(first == 0.0 || there.is_nan() || (there / 30.0).ceil() >= first);
            }
        }
    }

    #[test]
    fn neither_threads_nor_the_order_of_cells_matter(steps in any_flood(), radius in 0_u32..20) {
        let options = ArrivalOptions { radius, ..ArrivalOptions::default() };
        let size = steps[0].get(Quantity::Depth).unwrap().size();
        let map = arrival(&steps, options);
        for threads in [1, 2, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            prop_assert!(bits(&map) == bits(&pool.install(|| arrival(&steps, options))));
        }
        let mirror = |cell: UVec2| uvec2(size.x - 1 - cell.x, cell.y);
        let mirrored = arrival(&turned(&steps, mirror, size), options);
        for (cell, after) in map.after.iter() {
            prop_assert_eq!(after.to_bits(), mirrored.after.get(mirror(cell)).unwrap().to_bits());
        }
        let swapped = arrival(&turned(&steps, |cell| uvec2(cell.y, cell.x), uvec2(size.y, size.x)), options);
        for (cell, after) in map.after.iter() {
            prop_assert_eq!(after.to_bits(), swapped.after.get(uvec2(cell.y, cell.x)).unwrap().to_bits());
        }
    }
}
