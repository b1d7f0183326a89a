//! A Gaussian mean over cells that water connects.
//!
//! Each pass replaces every wet cell by the mean of itself and its four neighbours, a dry neighbour counting as the cell
//! itself. Over open water n passes are a Gaussian of variance 0.4 n along either axis; around obstacles they are the heat
//! kernel of the wet domain, whose distances run through the water: nothing crosses a dike, however thin, and no neighbour
//! counts more because it lies along a row. Cells are bounded after every pass, so that what is known of a cell is known to
//! its neighbours in the next one.
//!
//! A pass reads one raster and writes another, so the result does not depend on threads.

use glam::UVec2;
use rayon::prelude::*;

/// Variance along an axis that one pass adds, in cells²: two of five cells lie one cell away.
const VARIANCE_OF_A_PASS: f32 = 0.4;

/// How many standard deviations a radius of influence holds: 99.7 % of a Gaussian.
const DEVIATIONS: f32 = 3.0;

/// The number of passes for a radius in cells: (radius / 3)² / 0.4, so 54 for 14 and 14 for 7.
pub(super) fn passes(radius: u32) -> u32 {
    ((radius as f32 / DEVIATIONS).powi(2) / VARIANCE_OF_A_PASS).round() as u32
}

/// A value and its bounds. All are NaN in cells that take no part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounded {
    pub value: f32,
    pub least: f32,
    pub most: f32,
}

/// The values after a number of passes, row by row; `cells` has `size`.
pub(super) fn diffused(cells: &[Bounded], size: UVec2, passes: u32) -> Vec<f32> {
    let columns = size.x as usize;
    let mut values = padded(cells, columns);
    let mut next = values.clone();
    let stride = columns + 2;
    for _ in 0..passes {
        let rows = next[stride..].par_chunks_exact_mut(stride).zip(cells.par_chunks_exact(columns));
        rows.enumerate().for_each(|(row, (next, bounds))| {
            let around = &values[row * stride..(row + 3) * stride];
            let (north, around) = around.split_at(stride);
            let (here, south) = around.split_at(stride);
            mean_of_five(&mut next[1..=columns], north, here, south, bounds);
        });
        std::mem::swap(&mut values, &mut next);
    }
    values[stride..].chunks_exact(stride).take(size.y as usize).flat_map(|row| &row[1..=columns]).copied().collect()
}

/// The values with a border of cells that take no part.
fn padded(cells: &[Bounded], columns: usize) -> Vec<f32> {
    let border = vec![f32::NAN; columns + 2];
    let mut values = border.clone();
    for row in cells.chunks_exact(columns) {
        values.push(f32::NAN);
        values.extend(row.iter().map(|cell| cell.value));
        values.push(f32::NAN);
    }
    values.extend(border);
    values
}

/// One row of one pass. `north`, `here` and `south` have one cell more at both ends.
fn mean_of_five(next: &mut [f32], north: &[f32], here: &[f32], south: &[f32], bounds: &[Bounded]) {
    for (x, (next, bounds)) in next.iter_mut().zip(bounds).enumerate() {
        let centre = here[x + 1];
        let or_centre = |value: f32| if value.is_nan() { centre } else { value };
        let (west, east) = (or_centre(here[x]), or_centre(here[x + 2]));
        let (north, south) = (or_centre(north[x + 1]), or_centre(south[x + 1]));
        // Opposite neighbours first: a mirrored flood has the mirrored result to the last bit.
        let mean = (centre + ((west + east) + (north + south))) * 0.2;
        *next = match mean {
            mean if mean < bounds.least => bounds.least,
            mean if mean > bounds.most => bounds.most,
            mean => mean,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use glam::uvec2;

    fn free(value: f32) -> Bounded {
        Bounded { value, least: f32::NEG_INFINITY, most: f32::INFINITY }
    }

    const NONE: Bounded = Bounded { value: f32::NAN, least: f32::NAN, most: f32::NAN };

    #[test]
    fn a_point_becomes_a_round_gaussian() {
        let size = uvec2(61, 61);
        let cells: Vec<Bounded> =
            (0..61 * 61).map(|place| free(if place == 30 * 61 + 30 { 1.0 } else { 0.0 })).collect();
        let values = diffused(&cells, size, passes(14));
        let variance = 0.4 * 54.0;
        let gaussian =
            |x: f32, y: f32| (-(x * x + y * y) / (2.0 * variance)).exp() / (std::f32::consts::TAU * variance);
        for (place, value) in values.iter().enumerate() {
            let (x, y) = ((place % 61) as f32 - 30.0, (place / 61) as f32 - 30.0);
            assert_relative_eq!(*value, gaussian(x, y), epsilon = 0.02 * gaussian(0.0, 0.0));
        }
        assert_relative_eq!(values.iter().sum::<f32>(), 1.0, epsilon = 1e-4);
    }

    #[test]
    fn nothing_crosses_a_diagonal_dike() {
        let dike = |x: u32, y: u32| match x.cmp(&y) {
            std::cmp::Ordering::Less => free(1.0),
            std::cmp::Ordering::Equal => NONE,
            std::cmp::Ordering::Greater => free(5.0),
        };
        let cells: Vec<Bounded> = (0..20).flat_map(|y| (0..20).map(move |x| dike(x, y))).collect();
        let values = diffused(&cells, uvec2(20, 20), 54);
        for (before, after) in cells.iter().zip(values) {
            assert!(before.value.is_nan() == after.is_nan());
            assert!(after.is_nan() || (before.value - after).abs() < 1e-5);
        }
    }

    #[test]
    fn bounds_hold() {
        let cells: Vec<Bounded> =
            (0..30).map(|x| Bounded { value: x as f32, least: x as f32, most: x as f32 }).collect();
        let values = diffused(&cells, uvec2(30, 1), 10);
        assert!(values.iter().enumerate().all(|(x, value)| *value == x as f32));
        assert_eq!((passes(14), passes(7), passes(0)), (54, 14, 0));
    }
}
