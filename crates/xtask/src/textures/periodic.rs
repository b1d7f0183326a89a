//! Noise with period 1 in both directions, so that a picture made of it tiles without seams.

use std::f64::consts::TAU;

use fastrand::Rng;
use noise::{NoiseFn, Perlin};

/// A sum of octaves of Perlin noise, each of twice the frequency and half the amplitude of the one before.
///
/// The unit square is bent into a torus in four dimensions, where opposite edges meet.
pub struct Fractal {
    /// Each with the middle of its torus.
    octaves: Vec<(Perlin, [f64; 4])>,
    frequency: [f64; 2],
}

impl Fractal {
    /// Noise whose coarsest features repeat `frequency` times along x and y.
    pub fn new(rng: &mut Rng, frequency: [f64; 2], octaves: usize) -> Self {
        let octaves =
            (0..octaves).map(|_| (Perlin::new(rng.u32(..)), std::array::from_fn(|_| 100.0 * rng.f64()))).collect();
        Self { octaves, frequency }
    }

    /// The noise at a point, about −1 to 1.
    pub fn at(&self, [x, y]: [f64; 2]) -> f64 {
        let ((sin_x, cos_x), (sin_y, cos_y)) = (libm::sincos(TAU * x), libm::sincos(TAU * y));
        let mut sum = 0.0;
        let mut gain = 1.0;
        for (octave, middle) in &self.octaves {
            let [radius_x, radius_y] = self.frequency.map(|frequency| frequency / (gain * TAU));
            let (a, b, c, d) = (radius_x * cos_x, radius_x * sin_x, radius_y * cos_y, radius_y * sin_y);
            // Turned out of line with the noise's lattice, which would show as streaks along x and y.
            let turned = [a + b + c + d, a + b - c - d, a - b + c - d, a - b - c + d];
            sum += gain * octave.get(std::array::from_fn::<_, 4, _>(|i| middle[i] + turned[i] / 2.0));
            gain /= 2.0;
        }
        sum
    }
}

/// A random field of waves of nearly one length and direction.
///
/// Where two of them come out of step the crests fork, as those of wind and water ripples in sand do.
pub struct Ripples {
    /// Whole numbers of waves across the square along x and y, and a phase.
    waves: Vec<([f64; 2], f64)>,
}

impl Ripples {
    /// `count` waves whose numbers lie within `spread` of `mean`.
    pub fn new(rng: &mut Rng, mean: [f64; 2], spread: f64, count: usize) -> Self {
        let mut wave = || {
            let number = mean.map(|mean| (mean + spread * (rng.f64() + rng.f64() - 1.0)).round());
            (number, TAU * rng.f64())
        };
        Self { waves: (0..count).map(|_| wave()).collect() }
    }

    /// Phase in radians (0 on a crest) and amplitude, with a mean square of 1, of the ripples at a point.
    pub fn at(&self, [x, y]: [f64; 2]) -> (f64, f64) {
        let (mut sine, mut cosine) = (0.0, 0.0);
        for ([along_x, along_y], phase) in &self.waves {
            let (sin, cos) = libm::sincos(TAU * (along_x * x + along_y * y) + phase);
            sine += sin;
            cosine += cos;
        }
        (libm::atan2(sine, cosine), (sine * sine + cosine * cosine).sqrt() / (self.waves.len() as f64).sqrt())
    }
}

/// Points strewn over the square, one somewhere in each box of a grid.
pub struct Cells {
    /// Boxes along x and y.
    boxes: [usize; 2],
    points: Vec<[f64; 2]>,
}

/// The cell a point lies in; lengths in units of the grid's boxes.
pub struct Nearest {
    /// Which cell it is.
    pub index: usize,
    /// From the cell's point to the point asked for.
    pub offset: [f64; 2],
    /// The length of `offset`.
    pub distance: f64,
    /// How much farther the second nearest cell's point is: 0 on the border between two cells.
    pub border: f64,
}

impl Cells {
    /// `boxes[0]` × `boxes[1]` cells.
    pub fn new(rng: &mut Rng, boxes: [usize; 2]) -> Self {
        let points = (0..boxes[0] * boxes[1]).map(|_| [rng.f64(), rng.f64()]).collect();
        Self { boxes, points }
    }

    /// How many cells there are.
    pub fn count(&self) -> usize {
        self.points.len()
    }

    /// The cell around a point.
    pub fn nearest(&self, point: [f64; 2]) -> Nearest {
        let [columns, rows] = self.boxes.map(|count| count as isize);
        let [x, y] = [point[0] * columns as f64, point[1] * rows as f64];
        let (column, row) = (x.floor() as isize, y.floor() as isize);
        let mut nearest = Nearest { index: 0, offset: [0.0; 2], distance: f64::INFINITY, border: 0.0 };
        let mut second = f64::INFINITY;
        for (row, column) in (row - 2..=row + 2).flat_map(|row| (column - 2..=column + 2).map(move |c| (row, c))) {
            let index = (row.rem_euclid(rows) * columns + column.rem_euclid(columns)) as usize;
            let [in_x, in_y] = self.points[index];
            let offset = [x - column as f64 - in_x, y - row as f64 - in_y];
            let distance = (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
            if distance < nearest.distance {
                second = nearest.distance;
                nearest = Nearest { index, offset, distance, border: 0.0 };
            } else {
                second = second.min(distance);
            }
        }
        nearest.border = second - nearest.distance;
        nearest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_repeats_after_one_unit() {
        let mut rng = Rng::with_seed(1);
        let fractal = Fractal::new(&mut rng, [3.0, 7.0], 4);
        let ripples = Ripples::new(&mut rng, [4.0, 9.0], 3.0, 12);
        let cells = Cells::new(&mut rng, [5, 3]);
        for _ in 0..100 {
            let [x, y] = [rng.f64(), rng.f64()];
            for moved in [[x + 1.0, y], [x, y + 1.0]] {
                assert!((fractal.at([x, y]) - fractal.at(moved)).abs() < 1e-9);
                assert!((ripples.at([x, y]).1 - ripples.at(moved).1).abs() < 1e-9);
                let (cell, same) = (cells.nearest([x, y]), cells.nearest(moved));
                assert_eq!(cell.index, same.index);
                assert!((cell.border - same.border).abs() < 1e-9);
            }
        }
    }
}
