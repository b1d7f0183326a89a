//! How far the water has come between two steps: shares of the way from the old front to the new one.
//!
//! All cells that are first wet at one step form a band, as wide as the front ran. A cell at the distance p from the water
//! before and n from the water after it, both through the band, is p / (p + n) of the way. Distances solve the eikonal
//! equation |∇D| = 1 (fast marching, Sethian 1996, first order), so that fronts are round and not eight-cornered: with the
//! lesser of the distances to west and east, a, and to north and south, b,
//! ```text
//! (D − a)² + (D − b)² = 1,   or D = min(a, b) + 1 where one of them is too far,   or a diagonal neighbour's + √2
//! ```
//! Only what is nearer counts, so the order of cells at the same distance does not matter.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f32::consts::SQRT_2;

use glam::UVec2;

use super::NEVER;
use crate::neighbours::around;

/// The share 0…1 of the way at which each cell lies, ½ where nothing tells it and where the cell is never wet.
///
/// Without water after it, as at the last step, a band ends at its farthest cell. Without water before it, where water
/// springs up, it begins at the cell that is farthest from the water after it.
pub(super) fn shares(first: &[u32], size: UVec2) -> Vec<f32> {
    let (before, after) = rayon::join(
        || distances(first, size, |other, here| other < here),
        || distances(first, size, |other, here| other > here && other != NEVER),
    );
    let mut shares = vec![f32::NAN; first.len()];
    for start in 0..first.len() {
        if !shares[start].is_nan() {
            continue;
        }
        shares[start] = match before[start] / (before[start] + after[start]) {
            _ if first[start] == NEVER || first[start] == 0 => 0.5,
            _ if before[start].is_infinite() || after[start].is_infinite() => {
                fill_band(&mut shares, start, first, size, (&before, &after));
                continue;
            }
            share => share,
        };
    }
    shares
}

/// Gives the cells of a band that ends or begins nowhere their shares.
fn fill_band(shares: &mut [f32], start: usize, first: &[u32], size: UVec2, (before, after): (&[f32], &[f32])) {
    // Any number marks a cell of the band as found.
    shares[start] = 0.5;
    let mut band = vec![start];
    let mut done = 0;
    while let Some(place) = band.get(done).copied() {
        done += 1;
        for other in around(place, size) {
            if first[other] == first[place] && shares[other].is_nan() {
                shares[other] = 0.5;
                band.push(other);
            }
        }
    }
    // The front lies between the farthest cell and the next one.
    let farthest = |distances: &[f32]| 0.5 + band.iter().map(|place| distances[*place]).fold(0.0, f32::max);
    let (far_before, far_after) = (farthest(before), farthest(after));
    for place in band {
        shares[place] = match (far_before.is_finite(), far_after.is_finite()) {
            (true, false) => before[place] / far_before,
            (false, true) => 1.0 - after[place] / far_after,
            _ => 0.5,
        };
    }
}

/// Distances in cells through bands from the neighbours that are starts, told by the first steps of the neighbour and of the
/// cell; infinite where no way leads.
fn distances(first: &[u32], size: UVec2, is_start: impl Fn(u32, u32) -> bool) -> Vec<f32> {
    let mut distances = vec![f32::INFINITY; first.len()];
    let is_in_band = |place: usize| first[place] != NEVER && first[place] != 0;
    // The bits of floats from zero up are ordered as their values are.
    let mut heap: BinaryHeap<Reverse<(u32, usize)>> = BinaryHeap::new();
    for place in (0..first.len()).filter(|place| is_in_band(*place)) {
        if around(place, size).any(|other| is_start(first[other], first[place])) {
            distances[place] = solved(&distances, first, size, place, &is_start);
            heap.push(Reverse((distances[place].to_bits(), place)));
        }
    }
    while let Some(Reverse((bits, place))) = heap.pop() {
        // Shorter ways were found since.
        if bits != distances[place].to_bits() {
            continue;
        }
        for other in around(place, size) {
            if first[other] == first[place] && distances[other] > distances[place] {
                let distance = solved(&distances, first, size, other, &is_start);
                if distance < distances[other] {
                    distances[other] = distance;
                    heap.push(Reverse((distance.to_bits(), other)));
                }
            }
        }
    }
    distances
}

/// The distance of a cell by those of its neighbours, 0 for starts.
fn solved(distances: &[f32], first: &[u32], size: UVec2, place: usize, is_start: &impl Fn(u32, u32) -> bool) -> f32 {
    let columns = size.x as usize;
    let (mut a, mut b, mut diagonal) = (f32::INFINITY, f32::INFINITY, f32::INFINITY);
    for other in around(place, size) {
        let distance = match first[other] {
            step if is_start(step, first[place]) => 0.0,
            step if step == first[place] => distances[other],
            _ => continue,
        };
        let nearest = match other.abs_diff(place) {
            _ if other / columns == place / columns => &mut a,
            rows if rows == columns => &mut b,
            _ => &mut diagonal,
        };
        *nearest = nearest.min(distance);
    }
    let straight = if (a - b).abs() < 1.0 {
        (a + b + (2.0 - (a - b) * (a - b)).sqrt()) / 2.0
    } else {
        // Also where one of them, or both, are infinite.
        a.min(b) + 1.0
    };
    straight.min(diagonal + SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use glam::{Vec2, uvec2};

    #[test]
    fn a_channel_is_divided_evenly_from_front_to_front() {
        let first = [0, 1, 1, 1, 2, 2, NEVER, 3, 3];
        let shares = shares(&first, uvec2(9, 1));
        assert_eq!(shares[1..4], [0.25, 0.5, 0.75]);
        // The last band before the gap ends behind its farthest cell. Beyond the gap nothing tells anything.
        assert_relative_eq!(shares[4], 0.4);
        assert_relative_eq!(shares[5], 0.8);
        assert_eq!(shares[7..], [0.5, 0.5]);
    }

    #[test]
    fn distances_are_round() {
        let size = uvec2(81, 81);
        let centre = Vec2::splat(40.0);
        let radius = |place: usize| uvec2(place as u32 % 81, place as u32 / 81).as_vec2().distance(centre);
        let first: Vec<u32> = (0..81 * 81).map(|place| u32::from(radius(place) > 3.0)).collect();
        let distances = distances(&first, size, |other, here| other < here);
        for (place, distance) in distances.iter().enumerate().filter(|(place, _)| radius(*place) > 3.0) {
            // A circle of cells is half a cell off here and there, and the scheme is of first order.
            assert!(
                (distance - (radius(place) - 2.7)).abs() < 0.5 + 0.03 * radius(place),
                "{distance} {}",
                radius(place)
            );
        }
    }

    #[test]
    fn new_water_spreads_from_what_is_farthest_from_its_front() {
        let first: Vec<u32> = (0..21 * 21).map(|place| if place % 21 < 9 { 1 } else { 2 }).collect();
        let shares = shares(&first, uvec2(21, 21));
        assert!(shares[10 * 21] < 0.06 && shares[10 * 21 + 8] > 0.85);
    }
}
