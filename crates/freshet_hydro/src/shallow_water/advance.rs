//! The clock: as many steps as the fastest signal asks for.
use super::{Forcing, ShallowWater, step, strip::Numbers};
use crate::waves::GRAVITY;
use std::mem;

/// Part of a duration that is not worth a step: Δt is rounded to an `f32`.
const LEAST: f64 = 1e-7;

/// Speed of waves, m/s, on water of 1 mm, from which on it counts as wet.
const SLOWEST: f32 = 0.1;

/// What [`ShallowWater::advance`] did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Advance {
    /// Steps taken.
    pub steps: u32,
    /// Time simulated, s.
    pub time: f64,
    /// Time asked for that is left, s: above zero if the steps did not suffice.
    pub left: f64,
}

impl ShallowWater {
    /// Simulates `duration` (s) in at most `max_steps` steps. A duration that is not finite or not above zero does nothing.
    pub fn advance(&mut self, duration: f64, max_steps: u32) -> Advance {
        let mut advance = Advance::default();
        if !(duration.is_finite() && duration > 0.0) {
            return advance;
        }
        while advance.steps < max_steps && duration - advance.time > duration * LEAST {
            advance.time += self.step(duration - advance.time);
            advance.steps += 1;
        }
        advance.left = (duration - advance.time).max(0.0);
        if advance.left <= duration * LEAST {
            advance.left = 0.0;
        }
        advance
    }

    /// Duration, s, of the step that the Courant number allows now; no longer than over land that is just wet. An
    /// [`advance`](ShallowWater::advance) by it is one step.
    pub fn next_step(&mut self) -> f64 {
        let Forcing { entering, longest_step, .. } = self.forcing();
        let signal = self.courant * self.cell_size / self.fastest.max(entering).max(SLOWEST);
        // A hair less, so that rounding makes no two steps of it.
        0.9999 * f64::from(signal.min(longest_step))
    }

    /// Takes one step of at most `most` (s), which the Courant number may shorten. Returns its duration, s.
    pub fn step(&mut self, most: f64) -> f64 {
        if !(most.is_finite() && most > 0.0) {
            return 0.0;
        }
        let Forcing { rain, entering, longest_step, .. } = self.forcing();
        let dt = self.choose_dt(most, entering, longest_step);
        let numbers = Numbers { dt, ratio: dt / self.cell_size, drag: GRAVITY * self.manning * self.manning, rain };
        let around = step::Surround {
            size: self.size,
            bed: &self.bed,
            crests: self.crests.as_ref(),
            edges: &self.edges.cells,
            periodic: self.edges.periodic,
            sources: &self.rates,
        };
        let tally = step::step(&mut self.next, &self.now, &around, numbers, &mut self.rows);
        mem::swap(&mut self.now, &mut self.next);
        self.fastest = tally.fastest;
        self.push(dt);
        self.time += f64::from(dt);
        self.book(&tally, numbers);
        f64::from(dt)
    }

    /// Δt, s: the Courant number's, at most `most`, and such that what is left of `most` needs no tiny step.
    fn choose_dt(&self, most: f64, entering: f32, longest_step: f32) -> f32 {
        let signal = self.courant * self.cell_size / self.fastest.max(entering).max(1e-20);
        let longest = f64::from(signal.min(longest_step));
        let steps = (most / longest).ceil().max(1.0);
        if steps > 2.0 { longest as f32 } else { (most / steps) as f32 }
    }

    /// Sets the rates of the point sources at this time, in m/s for every cell.
    pub(super) fn update_rates(&mut self) {
        let area = self.cell_size * self.cell_size;
        for (_, footprint) in &self.sources {
            for &(cell, _) in &footprint.0 {
                self.rates[cell] = 0.0;
            }
        }
        for (source, footprint) in &self.sources {
            let rate = source.rate.at(self.time);
            for &(cell, share) in &footprint.0 {
                self.rates[cell] += rate * share / area;
            }
        }
    }

    fn book(&mut self, tally: &step::Tally, numbers: Numbers) {
        let cell = f64::from(self.cell_size);
        for (left, through) in self.balance.left.iter_mut().zip(tally.left) {
            *left += f64::from(numbers.dt) * cell * through;
        }
        let rain = f64::from(numbers.dt * numbers.rain) * self.bed.len() as f64;
        self.balance.rain += rain * cell * cell;
        if !self.rates.is_empty() {
            self.balance.sources += (tally.given - rain) * cell * cell;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use glam::{Vec2, uvec2};

    #[test]
    fn the_next_step_is_one_step_and_as_long_as_the_courant_number_allows() {
        let bed = Grid::new(uvec2(30, 20), 0.5, vec![-1.0; 600]).expect("a valid shape");
        let mut water = ShallowWater::new(&bed).expect("a finite bed");
        // Over dry land it is that on water of 1 mm.
        assert!((water.next_step() - 0.9999 * 0.45 * 0.5 / 0.1).abs() < 1e-6);
        water.set_water(|at, _| (if at.x < 0.0 { 1.5 } else { 0.2 }, Vec2::ZERO)).expect("sane water");
        for _ in 0..100 {
            let step = water.next_step();
            let allowed = 0.45 * 0.5 / f64::from(water.fastest_signal());
            assert!((step / allowed - 0.9999).abs() < 1e-6, "{step} s of {allowed} s");
            let advance = water.advance(step, 9);
            assert_eq!((advance.steps, advance.left), (1, 0.0));
        }
    }
}
