//! The depth at places over the time of the whole flood.
use bevy::tasks::futures_lite::future::yield_now;
use bevy_freshet::flood::{FloodMaps, MapsError};
use freshet_flood::interpolation::depth_between;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Points on the curve of a cell that turns dry or wet between two steps.
const PARTS: u32 = 16;

/// Depths of a cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Depth at each step, m.
    pub depths: Vec<f32>,
    /// When it turns dry or wet between a step and the next, as a share of the time between them.
    turns: Vec<Option<f32>>,
    threshold: f32,
}

impl Series {
    /// Reads those of `cells`, each step once; `steps` tells how many have been read. It can be dropped between two steps.
    ///
    /// # Errors
    /// [`MapsError`] if a step cannot be read.
    pub async fn read(maps: &FloodMaps, cells: &[usize], steps: &AtomicUsize) -> Result<Vec<Self>, MapsError> {
        let threshold = maps.threshold();
        let mut all = vec![Self { depths: Vec::new(), turns: Vec::new(), threshold }; cells.len()];
        for step in 0..maps.times().len() {
            let depths = maps.depth(step)?;
            for (series, cell) in all.iter_mut().zip(cells) {
                series.depths.push(depths.values().get(*cell).copied().unwrap_or_default());
            }
            if step > 0 {
                Self::read_turns(maps, step - 1, cells, &mut all)?;
            }
            steps.store(step + 1, Ordering::Relaxed);
            yield_now().await;
        }
        Ok(all)
    }

    /// When cells turn between a step and the next one. It depends on the water around them, so that all of the interval is read, but
    /// only if one turns.
    fn read_turns(maps: &FloodMaps, step: usize, cells: &[usize], all: &mut [Self]) -> Result<(), MapsError> {
        let turns =
            |series: &Self| (series.depths[step] < series.threshold) != (series.depths[step + 1] < series.threshold);
        let interval = match all.iter().any(turns) {
            true => Some(maps.interval(step)?),
            false => None,
        };
        for (series, cell) in all.iter_mut().zip(cells) {
            let turn = interval.as_ref().filter(|_| turns(series)).map(|interval| interval.turn.values()[*cell]);
            series.turns.push(turn);
        }
        Ok(())
    }

    /// The depth over time as a line: exact at the steps and at turns, straight where it is, and near its curve elsewhere.
    pub fn line(&self, times: &[f64]) -> Vec<[f64; 2]> {
        let mut line = Vec::new();
        for (step, ends) in times.windows(2).enumerate() {
            let time = |share: f32| ends[0] + f64::from(share) * (ends[1] - ends[0]);
            let point = |share: f32| [time(share), f64::from(self.between(step, share))];
            line.push(point(0.0));
            let Some(turn) = self.turns[step] else { continue };
            let [before, after] = [step, step + 1].map(|step| f64::from(self.depths[step]));
            // Closer together where it is steep: beside the turn. There it leaps between dry and the threshold.
            let steep = (0..PARTS).map(|part| (part as f32 / PARTS as f32).powi(2));
            if self.depths[step] < self.threshold {
                line.push([time(turn), before]);
                line.extend(steep.map(|part| point(turn + (1.0 - turn) * part)));
            } else {
                line.extend(steep.rev().map(|part| point(turn * (1.0 - part))));
                line.push([time(turn), after]);
            }
        }
        if let (Some(time), Some(depth)) = (times.last(), self.depths.last()) {
            line.push([*time, f64::from(*depth)]);
        }
        line
    }

    /// Depth at a share of the way from a step to the next, m.
    fn between(&self, step: usize, share: f32) -> f32 {
        let [before, after] = [step, step + 1].map(|step| self.depths[step]);
        depth_between(before, after, self.turns[step].unwrap_or_default(), share, self.threshold)
    }
}
