//! Water arrives later downstream: no place is reached before all places around it, except where water springs up.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::UVec2;

use crate::neighbours::around;

/// Raises arrival times just as far as is needed for a path of never earlier cells from a source to every cell.
///
/// The result is the least, over all paths through the water from any source, of the latest time on the path (the minimax
/// path; priority flood, Barnes et al. 2014): it is unique, whatever the order of visits. `first` holds the step at which
/// each cell is first wet, [`super::NEVER`] for never. Where times lie between the bounds of their steps they still do
/// afterwards, as every cell joins a source through cells that are wet no later.
pub(super) fn run_downstream(times: &mut [f32], first: &[u32], size: UVec2) {
    // The bits of floats from zero up are ordered as their values are.
    let key = |times: &[f32], place: usize| Reverse((times[place].to_bits(), place));
    let mut is_reached = vec![false; times.len()];
    let mut heap = BinaryHeap::new();
    for place in sources(times, first, size) {
        is_reached[place] = true;
        heap.push(key(times, place));
    }
    while let Some(Reverse((_, place))) = heap.pop() {
        for other in around(place, size) {
            if !is_reached[other] && first[other] != super::NEVER {
                is_reached[other] = true;
                times[other] = times[other].max(times[place]);
                heap.push(key(times, other));
            }
        }
    }
}

/// Where water springs up: the earliest cell of every pool that touches no cell wet before it. Pools are cells of the same
/// first step that touch each other.
fn sources(times: &[f32], first: &[u32], size: UVec2) -> Vec<usize> {
    let mut is_seen: Vec<bool> = first.iter().map(|step| *step == super::NEVER).collect();
    let mut sources = Vec::new();
    let mut pool = Vec::new();
    for start in 0..first.len() {
        if is_seen[start] {
            continue;
        }
        is_seen[start] = true;
        pool.push(start);
        let (mut source, mut is_fed) = (start, false);
        while let Some(place) = pool.pop() {
            if (times[place].to_bits(), place) < (times[source].to_bits(), source) {
                source = place;
            }
            for other in around(place, size) {
                is_fed |= first[other] < first[place];
                if first[other] == first[place] && !is_seen[other] {
                    is_seen[other] = true;
                    pool.push(other);
                }
            }
        }
        if !is_fed {
            sources.push(source);
        }
    }
    sources
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::uvec2;

    #[test]
    fn hollows_are_raised_and_springs_are_kept() {
        let never = super::super::NEVER;
        let first = [0, 1, 1, 1, never, 2, 2];
        let mut times = [0.0, 3.0, 1.0, 4.0, f32::NAN, 7.0, 6.0];
        run_downstream(&mut times, &first, uvec2(7, 1));
        assert_eq!(times[..4], [0.0, 3.0, 3.0, 4.0]);
        assert!(times[4].is_nan());
        assert_eq!(times[5..], [7.0, 6.0]);
    }
}
