//! How well steps tell what happens between them: keeps every n-th step, guesses the others in four ways and compares them
//! with what was left out.

use std::error::Error;

use freshet_flood::arrival::{ArrivalBuilder, ArrivalMap, ArrivalOptions};
use freshet_flood::interpolation::Interval;
use freshet_flood::step::{Quantity, Step};
use freshet_flood::waterline::USUAL_THRESHOLD;
use freshet_hydro::grid::Grid;

/// The ways of guessing; the last one is the library's.
pub const WAYS: [&str; 5] =
    ["step before", "step after", "linear blending", "front without levels", "front and levels"];

/// Wet areas guessed and true, and the error of the depths in either.
#[derive(Clone, Copy, Debug, Default)]
pub struct Score {
    both: f64,
    guessed: f64,
    real: f64,
    squares: f64,
    cells: f64,
}

impl Score {
    fn add(&mut self, guess: f32, truth: f32) {
        let (is_guessed, is_real) = (guess >= USUAL_THRESHOLD, truth >= USUAL_THRESHOLD);
        self.both += f64::from(u8::from(is_guessed && is_real));
        self.guessed += f64::from(u8::from(is_guessed));
        self.real += f64::from(u8::from(is_real));
        if is_guessed || is_real {
            self.squares += f64::from(guess - truth).powi(2);
            self.cells += 1.0;
        }
    }

    /// Overlap of the wet areas: 2 · common / (guessed + real), 1 at best.
    pub fn f1(&self) -> f64 {
        2.0 * self.both / (self.guessed + self.real)
    }

    /// Root of the mean square error of the depth, m.
    pub fn error(&self) -> f64 {
        (self.squares / self.cells).sqrt()
    }
}

/// How one way of guessing did.
#[derive(Clone, Debug, Default)]
pub struct Row {
    /// F1 of each step that was left out.
    pub steps: Vec<f64>,
    /// All cells of all steps together.
    pub all: Score,
    /// As `all`, without the first interval, before which there is no water to come from.
    pub later: Score,
    /// As `all`, of the cells alone that are dry at one of the steps kept around and wet at the other.
    pub turning: Score,
}

fn arrival_of(steps: &[Grid<f32>], level_share: f32) -> Result<ArrivalMap, Box<dyn Error>> {
    let mut builder = ArrivalBuilder::new(ArrivalOptions { level_share, ..ArrivalOptions::default() })?;
    for (time, depth) in steps.iter().enumerate() {
        builder.add(&Step::new(time as f64).with(Quantity::Depth, depth.clone()))?;
    }
    Ok(builder.finish()?)
}

/// The guesses at a time, in the order of [`WAYS`].
fn guesses(level: &Interval, front: &Interval, time: f64) -> [Vec<f32>; 5] {
    let (before, after, share) = (level.before.values(), level.after.values(), level.share(time));
    let blend = before.iter().zip(after).map(|(before, after)| before + (after - before) * share).collect();
    let [front, level] = [front, level].map(|interval| interval.depth_at(time).into_values());
    [before.to_vec(), after.to_vec(), blend, front, level]
}

/// Keeps one of `every` steps, which follow each other in equal times, and scores the [`WAYS`] of guessing the others.
pub fn scores(steps: &[Grid<f32>], every: usize) -> Result<[Row; 5], Box<dyn Error>> {
    let kept: Vec<Grid<f32>> = steps.iter().step_by(every).cloned().collect();
    let (front, level) = (arrival_of(&kept, 0.0)?, arrival_of(&kept, ArrivalOptions::default().level_share)?);
    let mut rows: [Row; 5] = Default::default();
    for (index, pair) in kept.windows(2).enumerate() {
        let time = index as f64;
        let [front, level] = [&front, &level].map(|arrival| {
            Interval::new((time, pair[0].clone()), (time + 1.0, pair[1].clone()), Some(arrival), USUAL_THRESHOLD)
        });
        let turns =
            |place: usize| (pair[0].values()[place] >= USUAL_THRESHOLD) != (pair[1].values()[place] >= USUAL_THRESHOLD);
        for part in 1..every {
            let truth = steps[index * every + part].values();
            let guesses = guesses(&level, &front, time + part as f64 / every as f64);
            for (row, guess) in rows.iter_mut().zip(guesses) {
                let mut step = Score::default();
                for (place, (guess, truth)) in guess.into_iter().zip(truth).enumerate() {
                    step.add(guess, *truth);
                    row.all.add(guess, *truth);
                    if index > 0 {
                        row.later.add(guess, *truth);
                    }
                    if turns(place) {
                        row.turning.add(guess, *truth);
                    }
                }
                row.steps.push(step.f1());
            }
        }
    }
    Ok(rows)
}
