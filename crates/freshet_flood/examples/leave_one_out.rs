//! How well steps tell what happens between them: keeps every n-th step of a folder of depths, guesses the others in four
//! ways and compares them with what was left out.
//!
//! `cargo run -p freshet_flood --example leave_one_out -- FOLDER/dm*.asc`

use std::error::Error;

use freshet_flood::arrival::{ArrivalBuilder, ArrivalMap, ArrivalOptions};
use freshet_flood::esri_ascii::EsriGrid;
use freshet_flood::interpolation::Interval;
use freshet_flood::step::{Quantity, Step};
use freshet_flood::waterline::USUAL_THRESHOLD;
use freshet_hydro::grid::Grid;

/// Overlap of two wet areas.
#[derive(Clone, Copy, Default)]
struct Score {
    both: f64,
    guessed: f64,
    true_: f64,
    squares: f64,
    cells: f64,
}

impl Score {
    /// 2 · common / (guessed + true), over the cells that `counts` picks.
    fn add(&mut self, guess: &[f32], truth: &[f32], counts: impl Fn(usize) -> bool) {
        for (place, (guess, truth)) in guess.iter().zip(truth).enumerate().filter(|(place, _)| counts(*place)) {
            let (is_guessed, is_true) = (*guess > USUAL_THRESHOLD, *truth > USUAL_THRESHOLD);
            self.both += f64::from(u8::from(is_guessed && is_true));
            self.guessed += f64::from(u8::from(is_guessed));
            self.true_ += f64::from(u8::from(is_true));
            if is_guessed || is_true {
                self.squares += f64::from(guess - truth).powi(2);
                self.cells += 1.0;
            }
        }
    }

    fn f1(&self) -> f64 {
        2.0 * self.both / (self.guessed + self.true_)
    }

    fn error(&self) -> f64 {
        (self.squares / self.cells).sqrt()
    }
}

const WAYS: [&str; 5] = ["step before", "step after", "linear blending", "front of the Gaussian alone", "front and level"];

fn arrival_of(steps: &[Grid<f32>], level_share: f32) -> Result<ArrivalMap, Box<dyn Error>> {
    let mut builder = ArrivalBuilder::new(ArrivalOptions { level_share, ..ArrivalOptions::default() })?;
    for (time, depth) in steps.iter().enumerate() {
        builder.add(&Step::new(time as f64).with(Quantity::Depth, depth.clone()))?;
    }
    Ok(builder.finish()?)
}

fn guesses(interval: &Interval, front: &Interval, time: f64) -> [Vec<f32>; 5] {
    let (before, after) = (interval.before.values(), interval.after.values());
    let share = interval.share(time);
    let blend = before.iter().zip(after).map(|(before, after)| before + (after - before) * share).collect();
    let [front, both] = [front, interval].map(|interval| interval.depth_at(time).into_values());
    [before.to_vec(), after.to_vec(), blend, front, both]
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut steps = Vec::new();
    for path in std::env::args().skip(1) {
        steps.push(EsriGrid::read(path)?.grid.map(|depth| depth.max(0.0)));
    }
    for every in [2, 3, 4] {
        let kept: Vec<Grid<f32>> = steps.iter().step_by(every).cloned().collect();
        let (front, both) = (arrival_of(&kept, 0.0)?, arrival_of(&kept, 0.7)?);
        let mut all = [Score::default(); 5];
        let mut changing = [Score::default(); 5];
        let mut means = [(0.0, 0.0); 5];
        for (index, pair) in kept.windows(2).enumerate() {
            let interval = |arrival: &ArrivalMap| {
                let steps = ((index as f64, pair[0].clone()), (index as f64 + 1.0, pair[1].clone()));
                Interval::new(steps.0, steps.1, Some(arrival), USUAL_THRESHOLD)
            };
            let (front, both) = (interval(&front), interval(&both));
            for part in 1..every {
                let truth = steps[index * every + part].values();
                let guesses = guesses(&both, &front, index as f64 + part as f64 / every as f64);
                let (before, after) = (pair[0].values(), pair[1].values());
                let changes = |place: usize| (before[place] > USUAL_THRESHOLD) != (after[place] > USUAL_THRESHOLD);
                for (way, guess) in guesses.iter().enumerate() {
                    let mut one = Score::default();
                    one.add(guess, truth, |_| true);
                    means[way].0 += one.f1();
                    means[way].1 += f64::from(u8::from(index > 0)) * one.f1();
                    all[way].add(guess, truth, |_| true);
                    changing[way].add(guess, truth, changes);
                }
            }
        }
        let count = ((kept.len() - 1) * (every - 1)) as f64;
        println!("one step of {every} kept: F1 of wet cells, mean of steps | without the first interval | of all cells together");
        println!("  | of the cells that turn in between | error of the depth in wet cells, m");
        for way in 0..5 {
            println!(
                "{:28} {:.4} | {:.4} | {:.4} | {:.4} | {:.4}",
                WAYS[way],
                means[way].0 / count,
                means[way].1 / (count - (every - 1) as f64),
                all[way].f1(),
                changing[way].f1(),
                all[way].error()
            );
        }
    }
    Ok(())
}
