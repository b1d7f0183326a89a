//! When the waterline passes a cell between two steps, as far as the water's level tells.
//!
//! A cell that is dry at one step and wet with the depth d at the next lies d below the level there. Where the water
//! around it rises by Δη in between, evenly, the level passes the cell's bed
//! ```text
//! s = 1 − d / Δη
//! ```
//! of the way from the first step to the second; s = 0 if the cell lies below the first level already, so that it had
//! only to wait for the front. No terrain is needed: over a bed that does not move, Δη is the change of depth of the cells
//! that are wet at both steps, carried into the others layer by layer, each cell taking the mean of the up to eight
//! around it that know one.
//!
//! Where the water around does not rise, the level tells nothing. A pool that has no such cell may be told to be a basin, in
//! which Δη is the greatest depth: so water dries up, and comes back. Where water springs up for the first time it does not
//! fill the land from its deepest place, but spreads over it. A cell that dries is one that wets with time running backwards.

use glam::UVec2;
use rayon::prelude::*;

use crate::neighbours::around;

/// Depth in metres from which on a cell counts as wet, unless something else is asked for: the film that models leave on dry
/// land is thinner, and the first class of incremental files is often this.
pub const USUAL_THRESHOLD: f32 = 0.02;

/// What is known of pools that no water wet at both steps touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pools {
    /// Nothing.
    Unknown,
    /// Their level rises evenly from their deepest place.
    Basins,
}

/// A cell that is dry before and wet after, and what its water tells of the time in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Wetting {
    /// Its place in the rasters.
    pub place: usize,
    /// When the level passes its bed, as a share 0…1 of the way from the first to the second raster; NaN if the level
    /// tells nothing.
    pub share: f32,
}

/// The cells that wet from depths `before` to depths `after`, in the order of the rasters, which have `size`.
///
/// Depths that are no number count as dry. Given the later raster first, these are the cells that dry, and shares count
/// backwards.
pub(crate) fn wettings(before: &[f32], after: &[f32], size: UVec2, threshold: f32, pools: Pools) -> Vec<Wetting> {
    // Not so where a depth is no number.
    let is_wet = |depth: f32| depth >= threshold;
    let wets = |place: &usize| !is_wet(before[*place]) && is_wet(after[*place]);
    let places: Vec<usize> = (0..after.len()).into_par_iter().filter(wets).collect();
    if places.is_empty() {
        return Vec::new();
    }
    let rise = |(before, after): (&f32, &f32)| match is_wet(*before) && is_wet(*after) {
        true => after - before,
        false => f32::NAN,
    };
    let mut rises: Vec<f32> = before.par_iter().zip(after).map(rise).collect();
    spread(&mut rises, &places, size, wets);
    if pools == Pools::Basins {
        fill_basins(&mut rises, &places, size, after);
    }
    let share = |rise: f32, depth: f32| if rise > 0.0 { (1.0 - depth / rise).max(0.0) } else { f32::NAN };
    places.into_iter().map(|place| Wetting { place, share: share(rises[place], after[place]) }).collect()
}

/// Carries `rises` into the cells that wet, layer by layer.
fn spread(rises: &mut [f32], places: &[usize], size: UVec2, wets: impl Fn(&usize) -> bool) {
    let knows = |rises: &[f32], place: usize| around(place, size).any(|other| !rises[other].is_nan());
    let mut layer: Vec<usize> = places.iter().copied().filter(|place| knows(rises, *place)).collect();
    while !layer.is_empty() {
        // A layer is computed before any of it is stored, so that the order of its cells does not matter.
        let means: Vec<f32> = layer.par_iter().map(|place| mean_around(rises, *place, size)).collect();
        for (place, mean) in layer.iter().zip(means) {
            rises[*place] = mean;
        }
        let beyond = layer.iter().flat_map(|place| around(*place, size));
        let mut next: Vec<usize> = beyond.filter(|place| rises[*place].is_nan() && wets(place)).collect();
        next.sort_unstable();
        next.dedup();
        layer = next;
    }
}

/// The mean of the known values around a cell.
fn mean_around(values: &[f32], place: usize, size: UVec2) -> f32 {
    let known = around(place, size).map(|other| values[other]).filter(|value| !value.is_nan());
    // In f64 the sum of eight is exact for depths of a flood, so that a mirrored flood has the mirrored mean.
    let (sum, count) = known.fold((0.0, 0_u8), |(sum, count), value| (sum + f64::from(value), count + 1));
    (sum / f64::from(count)) as f32
}

/// Gives every pool that nothing was carried into its greatest depth as the rise.
fn fill_basins(rises: &mut [f32], places: &[usize], size: UVec2, depths: &[f32]) {
    for place in places {
        if !rises[*place].is_nan() {
            continue;
        }
        // Stands for “in the pool, depth not known yet” while the pool is being gathered.
        rises[*place] = 0.0;
        let mut pool = vec![*place];
        let mut done = 0;
        while let Some(inside) = pool.get(done).copied() {
            done += 1;
            // Places are in ascending order, so a search tells which neighbours wet.
            for other in around(inside, size).filter(|other| places.binary_search(other).is_ok()) {
                if rises[other].is_nan() {
                    rises[other] = 0.0;
                    pool.push(other);
                }
            }
        }
        let deepest = pool.iter().fold(0.0_f32, |deepest, inside| deepest.max(depths[*inside]));
        for inside in pool {
            rises[inside] = deepest;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use glam::uvec2;

    /// Depths over a beach that rises by 0.1 m a cell, under a level in metres above its first cell.
    fn beach(level: f32) -> Vec<f32> {
        (0..20).map(|cell| (level - 0.1 * cell as f32).max(0.0)).collect()
    }

    #[test]
    fn a_level_that_rises_evenly_wets_a_beach_when_it_passes_each_cell() {
        let wet = wettings(&beach(0.55), &beach(1.55), uvec2(20, 1), 1e-6, Pools::Unknown);
        let places: Vec<usize> = wet.iter().map(|wetting| wetting.place).collect();
        assert_eq!(places, (6..16).collect::<Vec<_>>());
        for wetting in wet {
            assert_relative_eq!(wetting.share, 0.1 * wetting.place as f32 - 0.55, epsilon = 1e-5);
        }
    }

    #[test]
    fn drying_is_wetting_backwards() {
        let dries = wettings(&beach(0.55), &beach(1.55), uvec2(20, 1), 1e-6, Pools::Unknown);
        assert_eq!(dries.len(), 10);
        assert!(wettings(&beach(1.55), &beach(0.55), uvec2(20, 1), 1e-6, Pools::Unknown).is_empty());
    }

    #[test]
    fn a_pool_may_fill_like_a_basin_from_its_deepest_cell() {
        let after = [0.0, 0.5, 1.0, 0.25, 0.0, f32::NAN];
        let shares = |pools: Pools| -> Vec<f32> {
            wettings(&[0.0; 6], &after, uvec2(6, 1), 0.02, pools).iter().map(|wetting| wetting.share).collect()
        };
        assert_eq!(shares(Pools::Basins), [0.5, 0.0, 0.75]);
        assert!(shares(Pools::Unknown).iter().all(|share| share.is_nan()));
    }

    #[test]
    fn level_water_that_does_not_rise_tells_nothing() {
        let wet = wettings(&[1.0, 0.0, 0.0], &[1.0, 1.0, 1.0], uvec2(3, 1), 0.02, Pools::Unknown);
        assert!(wet.len() == 2 && wet.iter().all(|wetting| wetting.share.is_nan()));
    }
}
