//! Exact Euclidean distances on a raster.
use glam::UVec2;
use rayon::prelude::*;

/// Farther than any two cells of a raster are apart, squared, and finite: differences of it must not be NaN.
const FAR: f32 = 1e20;

/// Distance, in cells, from the centre of every cell of a raster of `size` to that of the nearest cell that `is_there`;
/// infinite if there is none. Values are stored row by row.
///
/// Felzenszwalb and Huttenlocher (2012), "Distance transforms of sampled functions": the squared distance is a minimum
/// of parabolas, found along every row and then along every column, in linear time.
///
/// # Panics
/// If `is_there` does not hold columns × rows values.
pub fn distance_to(size: UVec2, is_there: &[bool]) -> Vec<f32> {
    let (columns, rows) = (size.x as usize, size.y as usize);
    assert_eq!(is_there.len(), columns * rows, "one value for each cell");
    let mut squares: Vec<f32> = is_there.iter().map(|&there| if there { 0.0 } else { FAR }).collect();
    lower_rows(&mut squares, columns);
    let mut turned = transposed(&squares, columns);
    lower_rows(&mut turned, rows);
    let squares = transposed(&turned, rows);
    squares.into_iter().map(|square| if square < 0.5 * FAR { square.sqrt() } else { f32::INFINITY }).collect()
}

/// Replaces every row `f` by `min over q of f(q) + (p − q)²`.
fn lower_rows(values: &mut [f32], width: usize) {
    values.par_chunks_mut(width.max(1)).for_each(|row| {
        let f = row.to_vec();
        let mut envelope: Vec<(usize, f32)> = Vec::with_capacity(f.len());
        for q in 0..f.len() {
            // Parabolas that lie above the others from where this one cuts them are dropped.
            let from = loop {
                let Some(&(last, last_from)) = envelope.last() else { break f32::NEG_INFINITY };
                let cut = crossing(&f, last, q);
                if cut > last_from {
                    break cut;
                }
                envelope.pop();
            };
            envelope.push((q, from));
        }
        let mut current = 0;
        for (p, value) in row.iter_mut().enumerate() {
            while envelope.get(current + 1).is_some_and(|&(_, from)| from < p as f32) {
                current += 1;
            }
            let q = envelope[current].0;
            *value = f[q] + (p as f32 - q as f32).powi(2);
        }
    });
}

/// Where the parabolas at `a` < `b` cross.
fn crossing(f: &[f32], a: usize, b: usize) -> f32 {
    let (x, y) = (a as f32, b as f32);
    (f[b] - f[a] + (y * y - x * x)) / (2.0 * (y - x))
}

fn transposed(values: &[f32], width: usize) -> Vec<f32> {
    let height = values.len() / width.max(1);
    (0..width).flat_map(|x| (0..height).map(move |y| values[y * width + x])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{IVec2, uvec2};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn distances_are_those_of_a_search_through_all_cells(
            columns in 1_u32..14, rows in 1_u32..14, seed in 0_u64..1000, share in 1_u64..9,
        ) {
            let there: Vec<bool> = (0..u64::from(columns * rows))
                .map(|i| (i + 17).wrapping_mul(seed.wrapping_mul(6_364_136_223_846_793_005) | 1) >> 33 & 7 < share - 1)
                .collect();
            let place = |i: usize| IVec2::new(i as i32 % columns as i32, i as i32 / columns as i32);
            for (i, distance) in distance_to(uvec2(columns, rows), &there).into_iter().enumerate() {
                let nearest = (0..there.len())
                    .filter(|&j| there[j])
                    .map(|j| (place(i) - place(j)).as_vec2().length())
                    .fold(f32::INFINITY, f32::min);
                prop_assert!(distance == nearest || (distance - nearest).abs() < 1e-4, "{i}: {distance}, not {nearest}");
            }
        }
    }
}
