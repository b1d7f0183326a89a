use super::*;
use crate::viewer::Coloring;
use bevy::tasks::block_on;
use bevy_freshet::flood::FloodMaps;
use std::{
    path::Path,
    sync::{Arc, atomic::AtomicUsize},
};

fn viewer() -> Viewer {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/flood/played");
    let maps = Arc::new(FloodMaps::open(folder).expect("the sample"));
    Viewer::new(maps, Coloring::Water, 1.0).expect("the sample")
}

/// Cells of the sample: some that are wet first, and always dry ones.
fn cells(viewer: &Viewer) -> Vec<usize> {
    (0..viewer.terrain.values().len()).step_by(997).collect()
}

fn series(viewer: &Viewer, cells: &[usize]) -> Vec<Series> {
    let steps = AtomicUsize::new(0);
    let all = block_on(Series::read(&viewer.maps, cells, &steps)).expect("all steps");
    assert_eq!(steps.into_inner(), viewer.maps.times().len());
    all
}

#[test]
fn a_series_has_the_depths_of_the_steps() {
    let viewer = viewer();
    let cells = cells(&viewer);
    let all = series(&viewer, &cells);
    assert!(all.iter().any(|series| series.depths.iter().any(|depth| *depth > 0.5)), "no cell is wet");
    for step in 0..viewer.maps.times().len() {
        let depths = viewer.maps.depth(step).expect("a step");
        for (series, cell) in all.iter().zip(&cells) {
            assert_eq!(series.depths[step], depths.values()[*cell], "step {step}, cell {cell}");
        }
    }
}

#[test]
fn a_line_is_that_of_the_flood_between_its_steps() {
    let viewer = viewer();
    let (cells, times) = (cells(&viewer), viewer.maps.times());
    let all = series(&viewer, &cells);
    let lines: Vec<_> = all.iter().map(|series| series.line(times)).collect();
    assert!(lines.iter().all(|line| line.is_sorted_by(|a, b| a[0] <= b[0])), "time goes on");
    assert!(lines.iter().any(|line| line.len() > times.len()), "no cell is wetted");
    for time in (0..40).map(|part| times[0] + (times[times.len() - 1] - times[0]) * f64::from(part) / 39.0) {
        let depths = viewer.maps.depth_at(time).expect("steps");
        let step = viewer.maps.step_before(time).min(times.len() - 2);
        for ((line, series), cell) in lines.iter().zip(&all).zip(&cells) {
            let (found, expected) = (at(line, time), f64::from(depths.values()[*cell]));
            // Chords of a square root between sixteenths of its end leave out 1/64 of that, beside the turn.
            let allowed = 1e-3 + f64::from(series.depths[step].max(series.depths[step + 1])) / 64.0;
            assert!((found - expected).abs() < allowed, "cell {cell}, {time} s: {found}, not {expected}");
        }
    }
}

/// The value of a line of points at a time.
fn at(line: &[[f64; 2]], time: f64) -> f64 {
    let next = line.partition_point(|point| point[0] <= time).clamp(1, line.len() - 1);
    let [[t0, d0], [t1, d1]] = [line[next - 1], line[next]];
    if t1 > t0 { d0 + (d1 - d0) * ((time - t0) / (t1 - t0)).clamp(0.0, 1.0) } else { d1 }
}

#[test]
fn places_are_those_of_the_map() {
    let viewer = viewer();
    for index in cells(&viewer) {
        let size = viewer.terrain.size();
        let cell = uvec2(index as u32 % size.x, index as u32 / size.x);
        let middle = (cell.as_vec2() + 0.5) * viewer.terrain.cell_size() - 0.5 * viewer.terrain.extent();
        let place = viewer.on_map(middle);
        assert_eq!(viewer.cell_on_map(place), Ok(index));
        assert!(viewer.in_world(place).distance(middle) < 1e-3);
    }
    let outside = viewer.cell_on_map(DVec2::new(-1.0, 3.0));
    assert!(outside.is_err_and(|problem| problem.contains("E 0 to 600") && problem.contains("found E -1 N 3")));
}

#[test]
fn places_are_read_as_they_are_typed() {
    assert_eq!(place("2100.5, -480"), Ok(DVec2::new(2100.5, -480.0)));
    for text in ["", "3", "3,x", "3,4,5", "NaN,1"] {
        assert!(place(text).is_err_and(|problem| problem.contains("easting")), "{text}");
    }
}

#[test]
fn a_table_has_a_column_for_each_gauge() {
    let viewer = viewer();
    let times = viewer.maps.times();
    let mut gauges = Gauges::default();
    for place in [DVec2::new(300.5, 450.0), DVec2::new(10.0, 12.0)] {
        gauges.add(place, viewer.cell_on_map(place).expect("a place inside"));
    }
    gauges.add(DVec2::new(300.6, 450.1), gauges.list[0].cell);
    assert_eq!(gauges.list.len(), 2, "a cell has one gauge");
    let known = series(&viewer, &[gauges.list[0].cell]).remove(0);
    let last = *known.depths.last().expect("a step");
    gauges.list[0].depths = Depths::Read(known, Vec::new());
    let table = csv::table(times, &gauges.list);
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines[0], "time s,depth m at E 300.5 N 450,depth m at E 10 N 12");
    assert_eq!(lines.len(), 1 + times.len());
    assert_eq!(lines[times.len()], format!("{},{last:.4},", times[times.len() - 1]));
}
