//! Reads the depths of gauges in the background.
use super::{Depths, Gauges, Series};
use crate::viewer::Viewer;
use bevy::{
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on},
};
use bevy_freshet::flood::MapsError;
use egui_plot::PlotPoint;
use std::sync::{
    Arc,
    atomic::{AtomicUsize, Ordering},
};

/// What is being read.
pub struct Reading {
    cells: Vec<usize>,
    steps: Arc<AtomicUsize>,
    task: Task<Result<Vec<Series>, MapsError>>,
}

impl Reading {
    /// How many steps have been read.
    pub fn steps(&self) -> usize {
        self.steps.load(Ordering::Relaxed)
    }
}

/// Takes what has been read, and begins to read what has not: all gauges that wait, in one go.
pub fn read(viewer: Res<Viewer>, mut gauges: ResMut<Gauges>) {
    let gauges = gauges.bypass_change_detection();
    if gauges.reading.is_none() {
        gauges.reading = begin(&viewer, gauges);
    }
    let waits = gauges.is_headless;
    let Some(Reading { cells, task, .. }) = gauges.reading.take_if(|it| waits || it.task.is_finished()) else { return };
    let result = block_on(task);
    if let Err(problem) = &result {
        error!("the depths at the marked places: {problem}");
    }
    for gauge in &mut gauges.list {
        let Some(index) = cells.iter().position(|cell| *cell == gauge.cell) else { continue };
        gauge.depths = match &result {
            Ok(all) => {
                let line = all[index].line(viewer.maps.times());
                Depths::Read(all[index].clone(), line.into_iter().map(PlotPoint::from).collect())
            }
            Err(problem) => Depths::Failed(problem.to_string()),
        };
    }
}

/// Begins to read the gauges that nothing is known of, if there are some.
fn begin(viewer: &Viewer, gauges: &Gauges) -> Option<Reading> {
    let unread = gauges.list.iter().filter(|gauge| matches!(gauge.depths, Depths::Unread));
    let cells: Vec<usize> = unread.map(|gauge| gauge.cell).collect();
    if cells.is_empty() {
        return None;
    }
    let steps = Arc::new(AtomicUsize::new(0));
    let (maps, wanted, counted) = (viewer.maps.clone(), cells.clone(), steps.clone());
    let task = AsyncComputeTaskPool::get().spawn(async move { Series::read(&maps, &wanted, &counted).await });
    Some(Reading { cells, steps, task })
}
