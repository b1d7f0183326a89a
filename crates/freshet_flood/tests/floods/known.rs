//! Floods whose arrival is known, and what is measured of arrival maps.

use freshet_flood::arrival::{ArrivalBuilder, ArrivalMap, ArrivalOptions};
use freshet_flood::step::{Quantity, Step};
use freshet_hydro::grid::Grid;
use glam::{UVec2, Vec2, uvec2, vec2};

/// Depth from which on a cell is wet, m.
pub const WET: f32 = 0.02;

/// Steps at whole multiples of `interval` seconds from 0 on, with the depth at a place (in cells) and time.
pub fn flood(size: UVec2, count: u32, interval: f64, depth: impl Fn(Vec2, f32) -> f32) -> Vec<Step> {
    let step = |index: u32| {
        let time = f64::from(index) * interval;
        let grid = Grid::from_fn(size, 5.0, |cell| depth(cell.as_vec2(), time as f32)).unwrap();
        Step::new(time).with(Quantity::Depth, grid)
    };
    (0..count).map(step).collect()
}

pub fn arrival(steps: &[Step], options: ArrivalOptions) -> ArrivalMap {
    let mut builder = ArrivalBuilder::new(options).unwrap();
    for step in steps {
        builder.add(step).unwrap();
    }
    builder.finish().unwrap()
}

/// Options without levels: J11's front.
pub fn front(radius: u32) -> ArrivalOptions {
    ArrivalOptions { radius, level_share: 0.0, ..ArrivalOptions::default() }
}

/// Water that spreads evenly from a place at `speed` cells a second, as deep as 0.1 m for each cell behind the front.
pub fn ring(centre: Vec2, speed: f32) -> impl Fn(Vec2, f32) -> f32 {
    move |place, time| (0.1 * (speed * time - place.distance(centre))).clamp(0.0, 2.0)
}

/// As [`ring`], with 1 m of water everywhere: its level tells nothing.
pub fn disc(centre: Vec2, speed: f32) -> impl Fn(Vec2, f32) -> f32 {
    move |place, time| if place.distance(centre) < speed * time { 1.0 } else { 0.0 }
}

/// Mean and greatest difference from the `truth` (seconds by cell), of the cells that are wet and picked.
pub fn errors(map: &ArrivalMap, truth: impl Fn(Vec2) -> f32, is_picked: impl Fn(f32) -> bool) -> (f32, f32) {
    let cells = map.after.iter().filter(|(_, after)| !after.is_nan());
    let errors = cells.map(|(cell, after)| (after, (after - truth(cell.as_vec2())).abs()));
    let errors: Vec<f32> = errors.filter(|(after, _)| is_picked(**after)).map(|(_, error)| error).collect();
    (errors.iter().sum::<f32>() / errors.len() as f32, errors.iter().copied().fold(0.0, f32::max))
}

/// How far the area reached before `time` is from a circle around `centre`: standard deviation of the radii of 24 sectors
/// of equal angle over their mean.
pub fn roughness(map: &ArrivalMap, centre: Vec2, time: f32) -> f32 {
    const SECTORS: usize = 24;
    let mut areas = [0.0_f32; SECTORS];
    for (cell, after) in map.after.iter() {
        // A cell counts by its part before the isochrone, so that the raster itself is not measured.
        for (x, y) in (0..16).map(|part| (part % 4, part / 4)) {
            let corner = vec2(x as f32, y as f32) * 0.25 - 0.375;
            let place = cell.as_vec2() + corner;
            let ahead = sample(map, place);
            if !after.is_nan() && ahead < time {
                let angle = (place - centre).to_angle().rem_euclid(std::f32::consts::TAU);
                areas[((angle / std::f32::consts::TAU * SECTORS as f32) as usize).min(SECTORS - 1)] += 1.0 / 16.0;
            }
        }
    }
    let radii = areas.map(|area| (2.0 * area * SECTORS as f32 / std::f32::consts::TAU).sqrt());
    let mean = radii.iter().sum::<f32>() / SECTORS as f32;
    (radii.iter().map(|radius| (radius - mean).powi(2)).sum::<f32>() / SECTORS as f32).sqrt() / mean
}

/// The arrival between cells; never counts as late.
fn sample(map: &ArrivalMap, place: Vec2) -> f32 {
    let (size, last) = (map.after.size(), 1e9);
    let floor = place.max(Vec2::ZERO).floor();
    let part = (place - floor).clamp(Vec2::ZERO, Vec2::ONE);
    let at = |x: u32, y: u32| {
        let cell = (floor.as_uvec2() + uvec2(x, y)).min(size - 1);
        map.after.get(cell).copied().filter(|after| !after.is_nan()).unwrap_or(last)
    };
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    mix(mix(at(0, 0), at(1, 0), part.x), mix(at(0, 1), at(1, 1), part.x), part.y)
}

/// Cells around a cell.
pub fn around(cell: UVec2, size: UVec2) -> impl Iterator<Item = UVec2> {
    let (from, to) = (cell.saturating_sub(UVec2::ONE), (cell + 1).min(size - 1));
    (from.y..=to.y).flat_map(move |y| (from.x..=to.x).map(move |x| uvec2(x, y))).filter(move |other| *other != cell)
}

/// One cell of each place that is reached before all places around it.
pub fn springs(map: &ArrivalMap) -> Vec<UVec2> {
    let size = map.after.size();
    let mut is_seen = map.after.map(|after| after.is_nan());
    let mut springs = Vec::new();
    for start in map.after.cells() {
        let mut level = vec![start];
        let mut is_lowest = !is_seen.get(start).unwrap();
        while let Some(cell) = level.pop() {
            let here = map.after.get(cell).unwrap();
            for other in around(cell, size) {
                let there = map.after.get(other).unwrap();
                is_lowest &= there.is_nan() || there >= here;
                let index = is_seen.index(other).unwrap();
                if there == here && !std::mem::replace(&mut is_seen.values_mut()[index], true) {
                    level.push(other);
                }
            }
        }
        let index = is_seen.index(start).unwrap();
        is_seen.values_mut()[index] = true;
        springs.extend(is_lowest.then_some(start));
    }
    springs
}
