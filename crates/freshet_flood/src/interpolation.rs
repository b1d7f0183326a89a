//! The depth of a flood at any time between two steps.
//!
//! Blending two steps fades new water in everywhere at once. Here each cell that changes between dry and wet does so at a
//! moment of its own, its *turn*: a front moves. What a cell needs is local, so that a shader can draw it from three
//! textures. With depths d₀ and d₁ at the steps, the threshold w between dry and wet, the share s of the way from the first
//! step to the second, and the turn f as such a share:
//! ```text
//! s ≤ 0:                  d = d₀
//! s ≥ 1:                  d = d₁
//! wets,  d₀ < w ≤ d₁:     d = d₀ for s < f,   w + (d₁ − w) √((s − f) / (1 − f)) from then on
//! dries, d₁ < w ≤ d₀:     d = w + (d₀ − w) √((f − s) / f) for s ≤ f,   d₁ after that
//! otherwise:              d = d₀ + (d₁ − d₀) s
//! ```
//! The depth is that of the data at the steps, rises or falls all the way in between, and never leaves what is between d₀ and
//! d₁: what is dry at both steps stays dry. By definition a cell has the depth w when it turns. The root is the steep
//! beginning of a front; of the powers 1, ½ and 0.3 it errs least on a flood with every second step left out.
//!
//! A cell that is wet for the first time turns at its arrival ([`ArrivalMap`]). One that dries, or is wet anew, turns when
//! the level of the water around it passes its bed, as far as the steps tell, drawn towards the middle of the interval as
//! arrivals are: f = 0.7 f_level + 0.15, and ½ where the level tells nothing. Over the same bed a cell dries before what is
//! deeper than it, and a pool that dries up altogether dries last where it is deepest.

use freshet_hydro::grid::Grid;
use rayon::prelude::*;

use crate::arrival::{ArrivalMap, ArrivalOptions};
use crate::step::{Quantity, Step};
use crate::waterline::{Pools, wettings};

/// Depth in metres of a cell at the share `share` (0…1) of the way between two steps where its depth is `before` and
/// `after`; it turns dry or wet, if it does, at the share `turn`. See the [module](self) for the formula.
///
/// Depths that are no number count as 0.
pub fn depth_between(before: f32, after: f32, turn: f32, share: f32, threshold: f32) -> f32 {
    let (before, after) = (before.max(0.0), after.max(0.0));
    let grown = |full: f32, part: f32| threshold + (full - threshold) * part.clamp(0.0, 1.0).sqrt();
    if share <= 0.0 {
        before
    } else if share >= 1.0 {
        after
    } else if before < threshold && after >= threshold {
        if share < turn { before } else { grown(after, (share - turn) / (1.0 - turn).max(f32::MIN_POSITIVE)) }
    } else if before >= threshold && after < threshold {
        if share > turn { after } else { grown(before, (turn - share) / turn.max(f32::MIN_POSITIVE)) }
    } else {
        before + (after - before) * share
    }
}

/// Two steps that follow one another and what happens between them: what a viewer keeps while it plays that part.
#[derive(Clone, Debug, PartialEq)]
pub struct Interval {
    /// Time of the first step, s since the beginning of the data.
    pub start: f64,
    /// Time of the second step, s, after `start`.
    pub end: f64,
    /// Depths at the first step, m.
    pub before: Grid<f32>,
    /// Depths at the second step, m, of the same shape.
    pub after: Grid<f32>,
    /// When a cell turns dry or wet, as a share 0…1 of the time between the steps; 0 where it does not turn.
    pub turn: Grid<f32>,
    /// Depth in metres from which on a cell is wet.
    pub threshold: f32,
}

impl Interval {
    /// What happens between `before` at the time `start` and `after` at the later time `end`, in seconds.
    ///
    /// Without an arrival map, or with one of another shape, cells that are wet for the first time are treated as those
    /// that are wet again. Rasters of different shapes have nothing between them: the first one stays.
    pub fn new(
        (start, before): (f64, Grid<f32>),
        (end, after): (f64, Grid<f32>),
        arrival: Option<&ArrivalMap>,
        threshold: f32,
    ) -> Self {
        let size = before.size();
        let after = if after.size() == size { after } else { before.clone() };
        let mut turn = before.map(|_| 0.0);
        let turns = turn.values_mut();
        for wetting in wettings(before.values(), after.values(), size, threshold, Pools::Basins) {
            turns[wetting.place] = turn_from_level(wetting.share);
        }
        for drying in wettings(after.values(), before.values(), size, threshold, Pools::Basins) {
            turns[drying.place] = turn_from_level(1.0 - drying.share);
        }
        let mut interval = Self { start, end, before, after, turn, threshold };
        if let Some(arrival) = arrival.filter(|arrival| arrival.after.size() == size) {
            interval.follow(arrival);
        }
        interval
    }

    /// Lets the cells that are wet for the first time turn at their arrival.
    fn follow(&mut self, arrival: &ArrivalMap) {
        let (start, length) = ((self.start - arrival.start) as f32, (self.end - self.start) as f32);
        let depths = self.before.values().par_iter().zip(self.after.values()).zip(arrival.after.values());
        let is_wet = |depth: &f32| *depth >= self.threshold;
        self.turn.values_mut().par_iter_mut().zip(depths).for_each(|(turn, ((before, after), arrival))| {
            // Water that came at an earlier step comes again.
            if !is_wet(before) && is_wet(after) && *arrival > start {
                *turn = ((arrival - start) / length).min(1.0);
            }
        });
    }

    /// The share of the way from the first step to the second at a time, 0 before and 1 after them.
    pub fn share(&self, time: f64) -> f32 {
        ((time - self.start) / (self.end - self.start)).clamp(0.0, 1.0) as f32
    }

    /// Depths at a time in seconds, m; those of the nearer step outside the interval.
    pub fn depth_at(&self, time: f64) -> Grid<f32> {
        let share = self.share(time);
        let cells = self.before.values().par_iter().zip(self.after.values()).zip(self.turn.values());
        let depth = |((before, after), turn): ((&f32, &f32), &f32)| {
            depth_between(*before, *after, *turn, share, self.threshold)
        };
        let mut depth = cells.map(depth).collect::<Vec<_>>().into_iter();
        self.before.map(|_| depth.next().unwrap_or_default())
    }
}

/// Another quantity between two steps: blended where both steps have it and are wet, that of the one that is wet where a
/// cell turns, and `dry` where the depth at that time, `depth`, is below the threshold. None if one of the steps
/// lacks it.
pub fn quantity_at(
    interval: &Interval,
    (before, after): (&Step, &Step),
    quantity: Quantity,
    (time, depth): (f64, &Grid<f32>),
    dry: f32,
) -> Option<Grid<f32>> {
    let (first, second) = (before.get(quantity)?, after.get(quantity)?);
    let share = interval.share(time);
    let is_wet = |grid: &Grid<f32>, place: usize| grid.values()[place] >= interval.threshold;
    let value = |place: usize| {
        let (first, second) = (first.values()[place], second.values()[place]);
        match (is_wet(&interval.before, place), is_wet(&interval.after, place)) {
            _ if !is_wet(depth, place) => dry,
            (true, true) => first + (second - first) * share,
            (true, false) => first,
            _ => second,
        }
    };
    let values = (0..depth.values().len()).map(value).collect();
    Grid::new(depth.size(), depth.cell_size(), values).ok()
}

/// The turn of a cell past whose bed the level goes at the share `level`, NaN if it tells nothing.
fn turn_from_level(level: f32) -> f32 {
    let weight = ArrivalOptions::default().level_share;
    if level.is_nan() { 0.5 } else { weight * level + (1.0 - weight) * 0.5 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::uvec2;
    use proptest::prelude::*;

    fn row(depths: &[f32]) -> Grid<f32> {
        Grid::new(uvec2(depths.len() as u32, 1), 1.0, depths.to_vec()).unwrap()
    }

    #[test]
    fn a_front_passes_the_cells_in_turn() {
        let arrival = ArrivalMap { start: 10.0, after: row(&[0.0, 2.0, 5.0, 9.0, f32::NAN]) };
        let steps = (row(&[1.0, 0.0, 0.0, 0.0, 0.0]), row(&[1.0, 1.0, 1.0, 1.0, 0.0]));
        let interval = Interval::new((10.0, steps.0), (20.0, steps.1), Some(&arrival), 0.02);
        for (time, wet) in [(10.0, 1), (11.9, 1), (12.1, 2), (14.9, 2), (15.1, 3), (19.0, 4), (20.0, 4), (99.0, 4)] {
            let depth = interval.depth_at(time);
            assert_eq!(depth.values().iter().filter(|depth| **depth >= 0.02).count(), wet, "{time}");
        }
    }

    #[test]
    fn a_beach_dries_from_the_top() {
        let beach = |level: f32| row(&[0.0, 0.1, 0.2, 0.3, 0.4].map(|bed| (level - bed).max(0.0)));
        let interval = Interval::new((0.0, beach(0.45)), (1.0, beach(0.05)), None, 1e-6);
        let wet = |time: f64| interval.depth_at(time).values().iter().filter(|depth| **depth > 0.0).count();
        let counts: Vec<usize> = (0..=10).map(|tenth| wet(f64::from(tenth) / 10.0)).collect();
        assert!(counts.is_sorted_by(|a, b| a >= b), "{counts:?}");
        assert_eq!((counts[0], counts[5], counts[10]), (5, 3, 1));
        // 0.35 of the way the level passes the cell at 0.3 m; a share of 0.3 is drawn to the middle.
        assert!((interval.turn.values()[3] - (0.7 * 0.375 + 0.15)).abs() < 1e-5);
    }

    #[test]
    fn other_shapes_and_missing_values_do_no_harm() {
        let interval = Interval::new((0.0, row(&[1.0, f32::NAN])), (1.0, row(&[2.0])), None, 0.02);
        assert_eq!(interval.depth_at(0.5).values(), [1.0, 0.0]);
    }

    proptest! {
        #[test]
        fn depths_stay_between_the_steps_and_move_one_way(
            before in prop_oneof![Just(0.0_f32), 0.0_f32..0.1, 0.0_f32..9.0],
            after in prop_oneof![Just(0.0_f32), 0.0_f32..0.1, 0.0_f32..9.0],
            turn in prop_oneof![Just(0.0_f32), Just(1.0_f32), 0.0_f32..=1.0],
        ) {
            let at = |share: f32| depth_between(before, after, turn, share, 0.02);
            prop_assert_eq!((at(0.0), at(1.0)), (before, after));
            let depths: Vec<f32> = (0..=50).map(|part| at(part as f32 / 50.0)).collect();
            if before <= after {
                prop_assert!(depths.is_sorted(), "{depths:?}");
            } else {
                prop_assert!(depths.is_sorted_by(|a, b| a >= b), "{depths:?}");
            }
            let (least, most) = (before.min(after), before.max(after));
            prop_assert!(depths.iter().all(|depth| (least..=most).contains(depth)), "{depths:?}");
        }
    }
}
