//! The water of a flood at a time.

use std::sync::Arc;

use freshet_hydro::shallow_water::{FieldSample, WET, WaterCells, sample};
use glam::{UVec2, Vec2, Vec4, vec4};

use super::PlayedInterval;
use crate::interpolation::depth_between;

/// The water of a flood at a time between two steps.
#[derive(Clone, Debug)]
pub struct Moment {
    interval: Arc<PlayedInterval>,
    time: f64,
    share: f32,
    factor: f32,
    rate: Option<Rate>,
}

/// How fast the time passes.
#[derive(Clone, Copy, Debug)]
struct Rate {
    /// The share of the way at another time, by which rises are judged.
    other: f32,
    /// One over the time from that one to this one, s.
    per_second: f32,
}

impl Moment {
    /// The water at `time` (s in the data), with elevations and depths `factor` times as high.
    pub fn new(interval: Arc<PlayedInterval>, time: f64, factor: f32) -> Self {
        Self { share: interval.share(time), interval, time, factor, rate: None }
    }

    /// The same water, rising as it does while the time passes from `before` (s in the data) to its own in `elapsed` seconds.
    pub fn rising_since(self, before: f64, elapsed: f64) -> Self {
        let [start, end] = [&self.interval.steps[0], &self.interval.steps[1]].map(|step| step.time);
        // Only this interval is known: at its beginning what comes next counts.
        let other = before.clamp(start, end);
        let other = if other == self.time { (2.0 * self.time - before).clamp(start, end) } else { other };
        let seconds = elapsed * (self.time - other) / (self.time - before);
        let rate = Rate { other: self.interval.share(other), per_second: seconds.recip() as f32 };
        let is_usable = rate.per_second.is_finite() && rate.other != self.share;
        Self { rate: is_usable.then_some(rate), ..self }
    }

    /// The same water, which does not rise.
    pub fn standing(&self) -> Self {
        Self { rate: None, ..self.clone() }
    }

    /// The steps that it lies between.
    pub fn interval(&self) -> &Arc<PlayedInterval> {
        &self.interval
    }

    /// Its time, s in the data.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The share of the way from the first step to the second.
    pub fn share(&self) -> f32 {
        self.share
    }

    /// Factor on elevations and depths.
    pub fn factor(&self) -> f32 {
        self.factor
    }

    /// Whether its level has a velocity.
    pub fn is_rising(&self) -> bool {
        self.rate.is_some()
    }

    /// Lowest and highest level that wet cells have between the steps, m; 0 if all is dry.
    pub fn levels(&self) -> (f32, f32) {
        let bounds = self.interval.bounds;
        (self.factor * bounds.lowest, self.factor * bounds.highest)
    }

    /// Steeper than this no slope is between the steps.
    pub fn steepest(&self) -> f32 {
        self.factor * self.interval.bounds.steepest
    }

    /// Greatest speed at both steps, m/s.
    pub fn fastest(&self) -> f32 {
        self.interval.bounds.fastest
    }

    /// The water at local (x, z) in metres from the middle, `age` (s) later: `None` where all cells around it are dry.
    pub fn sample(&self, place: Vec2, age: f32) -> Option<FieldSample> {
        sample(self, place, age)
    }

    /// A cell at a share of the way.
    fn cell_at(&self, index: usize, share: f32) -> Vec4 {
        let PlayedInterval { steps, turn, threshold, ground, .. } = &*self.interval;
        let [before, after] = [steps[0].cells[index], steps[1].cells[index]];
        let ground = ground.elevations[index];
        let depth = depth_between(before.depth, after.depth, turn[index], share, *threshold);
        if depth < *threshold {
            return vec4(self.factor * ground, 0.0, 0.0, 0.0);
        }
        let velocity = match (before.depth >= *threshold, after.depth >= *threshold) {
            (true, true) => before.velocity().lerp(after.velocity(), share),
            (true, false) => before.velocity(),
            _ => after.velocity(),
        };
        vec4(self.factor * (ground + depth), self.factor * depth, velocity.x, velocity.y)
    }
}

impl WaterCells for Moment {
    fn size(&self) -> UVec2 {
        self.interval.size
    }

    fn cell_size(&self) -> f32 {
        self.interval.cell_size
    }

    fn cell(&self, index: usize) -> Vec4 {
        self.cell_at(index, self.share)
    }

    fn rising(&self, index: usize) -> f32 {
        let Some(rate) = self.rate else { return 0.0 };
        let (now, then) = (self.cell(index), self.cell_at(index, rate.other));
        if now.y > WET && then.y > WET { (now.x - then.x) * rate.per_second } else { 0.0 }
    }
}
