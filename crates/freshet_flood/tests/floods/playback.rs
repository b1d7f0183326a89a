//! A flood at any moment: what is between its bounds, how it rises, and what it shares.
use freshet_flood::{
    maps::FloodMaps,
    playback::{BANK, Moment, PlayedInterval},
};
use freshet_hydro::shallow_water::{WET, WaterCells};
use glam::{Vec2, Vec4Swizzles, vec2};
use std::{path::Path, sync::Arc};

fn flood() -> FloodMaps {
    FloodMaps::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/flood/played")).unwrap()
}

/// The parts `indices` of a flood, each knowing those before it.
fn parts(maps: &FloodMaps, indices: &[usize]) -> Vec<Arc<PlayedInterval>> {
    let mut parts = Vec::new();
    for index in indices {
        parts.push(Arc::new(PlayedInterval::read(maps, &parts, *index).unwrap()));
    }
    parts
}

#[test]
fn no_moment_leaves_the_bounds_of_its_interval() {
    let maps = flood();
    for part in parts(&maps, &[0, 2, 7, 11, 12]) {
        let [start, end] = [part.steps[0].time, part.steps[1].time];
        let cells = part.turn.len();
        let (mut steepest, mut fastest) = (0.0_f32, 0.0_f32);
        for share in [0.0, 0.1, 0.35, 0.5, 0.77, 1.0] {
            let moment = Moment::new(part.clone(), start + share * (end - start), 1.5);
            let (lowest, highest) = moment.levels();
            for index in (0..cells).filter(|index| moment.cell(*index).y > WET) {
                let cell = moment.cell(index);
                assert!((lowest - 1e-4..=highest + 1e-4).contains(&cell.x), "{cell} of {lowest}…{highest}");
                steepest = steepest.max(moment.slope(index).length());
                fastest = fastest.max(cell.zw().length());
            }
            assert!(steepest <= moment.steepest() * 1.0001 && fastest <= moment.fastest() * 1.0001);
        }
        let bounds = Moment::new(part.clone(), start, 1.5);
        println!("{steepest} of {}, {fastest} of {}", bounds.steepest(), bounds.fastest());
        assert!(bounds.fastest() <= 1.01 * fastest.max(1e-3) && bounds.steepest() < 6.0 * steepest.max(1e-3));
    }
}

#[test]
fn it_rises_as_the_level_does_while_the_time_passes() {
    let maps = flood();
    let part = parts(&maps, &[5]).remove(0);
    let start = part.steps[0].time;
    // Sixty seconds of the data pass in one; at the beginning of the interval only what comes is known.
    for (before, time) in [(start + 59.0, start + 60.0), (start - 1.0, start), (start + 61.0, start + 60.0)] {
        let speed = (time - before).signum() * 60.0;
        let moment = Moment::new(part.clone(), time, 1.0).rising_since(before, (time - before) / speed);
        let later = Moment::new(part.clone(), time + 0.25, 1.0);
        let mut risen = 0;
        for index in 0..part.turn.len() {
            let (now, then) = (moment.cell(index), later.cell(index));
            // What turns within a second has no rate.
            let is_steady = part.steps.iter().all(|step| step.cells[index].depth >= part.threshold);
            if is_steady {
                let expected = (then.x - now.x) / 0.25 * speed as f32;
                assert!((moment.rising(index) - expected).abs() < 1e-2, "{} for {expected}", moment.rising(index));
                risen += usize::from(expected.abs() > 0.02);
            }
        }
        assert!(risen > 100, "{risen} cells");
    }
    // What stands does not rise, and a time that has not passed makes no rate.
    let standing = Moment::new(part.clone(), start + 9.0, 1.0);
    assert!(!standing.is_rising() && !standing.rising_since(start + 9.0, 1.0).is_rising());
}

#[test]
fn intervals_beside_one_another_share_a_step_and_all_share_the_ground() {
    let maps = flood();
    let parts = parts(&maps, &[3, 4, 9]);
    assert!(Arc::ptr_eq(&parts[0].steps[1], &parts[1].steps[0]));
    assert!(parts.iter().all(|part| Arc::ptr_eq(&part.ground, &parts[0].ground)));
}

#[test]
fn the_last_step_stands_and_there_is_none_behind_it() {
    let maps = flood();
    let last = maps.times().len() - 1;
    let part = parts(&maps, &[last]).remove(0);
    let [early, late] = [0.0, 1e9].map(|time| Moment::new(part.clone(), time, 1.0));
    assert!((0..part.turn.len()).all(|index| early.cell(index) == late.cell(index)));
    assert!(PlayedInterval::read(&maps, &[], last + 1).is_err());
}

#[test]
fn places_are_looked_up_as_cells_are() {
    let maps = flood();
    let part = parts(&maps, &[8]).remove(0);
    let moment = Moment::new(part.clone(), part.steps[0].time + 20.0, 1.0);
    let size = part.size.as_vec2();
    let mut wet = 0;
    for index in 0..part.turn.len() {
        let at = vec2((index % part.size.x as usize) as f32, (index / part.size.x as usize) as f32);
        let found = moment.sample((at + 0.5 - 0.5 * size) * part.cell_size, 0.0);
        let cell = moment.cell(index);
        // Of a dry cell the wet ones around it may say something.
        if cell.y > WET {
            let found = found.unwrap();
            assert!((found.level - cell.x).abs() < 1e-3 && (found.velocity - cell.zw()).length() < 1e-3);
            wet += 1;
        }
        assert!(cell.x < BANK || cell.y == 0.0);
    }
    assert!(wet > 1000 && moment.sample(Vec2::ZERO, 0.0).is_some_and(|sample| sample.level.is_finite()));
}
