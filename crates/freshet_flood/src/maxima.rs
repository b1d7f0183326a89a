//! What a flood amounts to in each cell: greatest depth and speed, time under water, and hazard to people.

use freshet_hydro::grid::Grid;
use rayon::prelude::*;

use crate::arrival::ArrivalMap;
use crate::interpolation::Interval;
use crate::step::{Quantity, Step};

/// Hazard rating to people of water of a depth (m) and speed (m/s), both at least 0; 0 where it is dry.
///
/// ```text
/// HR = d (v + 0.5) + DF,   DF = 0.5 for d ≤ 0.25 m and v ≤ 2 m/s, 1 otherwise
/// ```
/// (Defra and Environment Agency 2006, *Flood Risks to People*, FD2320/FD2321, with the conservative debris factor of the
/// supplementary note of May 2008.) Below 0.75: caution; from 0.75: danger for some; from 1.25: for most; from 2: for all.
pub fn hazard_rating(depth: f32, speed: f32) -> f32 {
    let debris = if depth <= 0.25 && speed <= 2.0 { 0.5 } else { 1.0 };
    if depth > 0.0 { depth * (speed + 0.5) + debris } else { 0.0 }
}

/// What a flood amounts to in each cell, 0 where it is never wet.
#[derive(Clone, Debug, PartialEq)]
pub struct Maxima {
    /// Greatest depth of all steps, m.
    pub depth: Grid<f32>,
    /// Greatest speed of all steps in wet cells, m/s; `None` if the model wrote none.
    pub speed: Option<Grid<f32>>,
    /// Time under water between first and last step, s.
    pub duration: Grid<f32>,
    /// Greatest [`hazard_rating`] of all steps; without speeds that of still water.
    pub hazard: Grid<f32>,
}

/// Gathers [`Maxima`] from steps that come one at a time, all of one shape.
#[derive(Clone, Debug, Default)]
pub struct MaximaBuilder {
    threshold: f32,
    maxima: Option<Maxima>,
    before: Option<(f64, Grid<f32>)>,
    start: f64,
}

impl MaximaBuilder {
    /// Counts cells as wet whose depth is above `threshold`, m.
    pub fn new(threshold: f32) -> Self {
        Self { threshold, ..Self::default() }
    }

    /// Takes the next step. One without depths, or of another shape than the first, is passed over.
    pub fn add(&mut self, step: &Step) {
        let Some(depth) = step.get(Quantity::Depth) else { return };
        let maxima = match self.maxima.as_mut() {
            Some(maxima) if maxima.depth.size() != depth.size() => return,
            Some(maxima) => maxima,
            None => {
                self.start = step.time;
                let nothing = depth.map(|_| 0.0);
                let (depth, duration, hazard) = (nothing.clone(), nothing.clone(), nothing);
                self.maxima.insert(Maxima { depth, speed: None, duration, hazard })
            }
        };
        let speed = step.speed().filter(|speed| speed.size() == depth.size());
        maxima.raise(depth, speed.as_ref(), self.threshold);
        if let Some((time, before)) = self.before.take() {
            maxima.lengthen((time - self.start, before), (step.time - self.start, depth), self.threshold);
        }
        self.before = Some((step.time, depth.clone()));
    }

    /// What the steps so far amount to; `arrival` is the arrival map of the same steps. `None` if there was no step.
    pub fn finish(self, arrival: &ArrivalMap) -> Option<Maxima> {
        let mut maxima = self.maxima?;
        for (duration, arrival) in maxima.duration.values_mut().iter_mut().zip(arrival.after.values()) {
            *duration = if arrival.is_nan() { 0.0 } else { (*duration - arrival).max(0.0) };
        }
        Some(maxima)
    }
}

impl Maxima {
    fn raise(&mut self, depth: &Grid<f32>, speed: Option<&Grid<f32>>, threshold: f32) {
        let depths = depth.values();
        self.depth.values_mut().par_iter_mut().zip(depths).for_each(|(most, depth)| *most = most.max(*depth));
        let speed_of = |place: usize| speed.map_or(0.0, |speed| speed.values()[place].max(0.0));
        self.hazard.values_mut().par_iter_mut().zip(depths).enumerate().for_each(|(place, (most, depth))| {
            if *depth >= threshold {
                *most = most.max(hazard_rating(*depth, speed_of(place)));
            }
        });
        if let Some(speed) = speed {
            let most = self.speed.get_or_insert_with(|| speed.map(|_| 0.0)).values_mut();
            most.par_iter_mut().zip(speed.values()).zip(depths).for_each(|((most, speed), depth)| {
                if *depth >= threshold {
                    *most = most.max(*speed);
                }
            });
        }
    }

    /// Adds the time under water between two steps. The interval in which a cell is wet for the first time counts as
    /// its end since the first step, from which the arrival is taken at last.
    fn lengthen(&mut self, before: (f64, Grid<f32>), after: (f64, &Grid<f32>), threshold: f32) {
        let end = after.0 as f32;
        let interval = Interval::new(before, (after.0, after.1.clone()), None, threshold);
        let length = (interval.end - interval.start) as f32;
        let depths = interval.before.values().par_iter().zip(interval.after.values()).zip(interval.turn.values());
        self.duration.values_mut().par_iter_mut().zip(depths).for_each(|(duration, ((before, after), turn))| {
            *duration += match (*before >= threshold, *after >= threshold) {
                (true, true) => length,
                (true, false) => length * turn,
                (false, true) if *duration == 0.0 => end,
                (false, true) => length * (1.0 - turn),
                (false, false) => 0.0,
            };
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrival::{ArrivalBuilder, ArrivalOptions};
    use approx::assert_relative_eq;
    use glam::uvec2;

    #[test]
    fn the_rating_is_that_of_the_guidance() {
        assert_eq!(hazard_rating(0.0, 3.0), 0.0);
        assert_relative_eq!(hazard_rating(0.25, 0.0), 0.625);
        assert_relative_eq!(hazard_rating(0.5, 1.0), 1.75);
        assert_relative_eq!(hazard_rating(1.0, 2.0), 3.5);
        assert_relative_eq!(hazard_rating(0.1, 2.5), 1.3);
    }

    #[test]
    fn water_that_comes_goes_and_returns_is_counted_while_it_is_there() {
        let tide = [[0.5, 0.0], [0.5, 0.2], [0.5, 0.4], [0.5, 0.0], [0.5, 0.0], [0.5, 0.3], [0.5, 0.3]];
        let mut arrival = ArrivalBuilder::new(ArrivalOptions::default()).unwrap();
        let mut maxima = MaximaBuilder::new(0.02);
        for (index, depths) in tide.iter().enumerate() {
            let grid = |values: &[f32]| Grid::new(uvec2(2, 1), 1.0, values.to_vec()).unwrap();
            let speed = grid(&[0.1 * index as f32, if depths[1] > 0.0 { 2.0 } else { 9.0 }]);
            let step = Step::new(100.0 + 60.0 * index as f64);
            let step = step.with(Quantity::Depth, grid(depths)).with(Quantity::Speed, speed);
            arrival.add(&step).unwrap();
            maxima.add(&step);
        }
        let arrival = arrival.finish().unwrap();
        let maxima = maxima.finish(&arrival).unwrap();
        assert_eq!(maxima.depth.values(), [0.5, 0.4]);
        assert_relative_eq!(maxima.speed.unwrap().values()[1], 2.0);
        assert_relative_eq!(maxima.hazard.values()[1], 0.4 * 2.5 + 1.0);
        assert_eq!(maxima.duration.values()[0], 360.0);
        // From the arrival to the second of two wet steps, half of the drying, half of the return, one interval more.
        let first = 120.0 - arrival.after.values()[1];
        assert_relative_eq!(maxima.duration.values()[1], first + 30.0 + 30.0 + 60.0, epsilon = 1e-3);
    }
}
