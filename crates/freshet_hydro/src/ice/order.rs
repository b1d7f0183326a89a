//! Which place freezes when.
use super::distance_to;
use crate::{
    grid::{Grid, GridError},
    noise::fractal_noise,
};
use glam::{UVec2, Vec2};
use rayon::prelude::*;

/// A place of the water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Depth of the still water, m; dry land from 0 down, may be infinite.
    pub depth: f32,
    /// Speed of the current, m/s, ≥ 0.
    pub speed: f32,
}

/// What hinders freezing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freezing {
    /// Distance from the bank over which its shelter is lost, m, > 0: ice grows from there.
    pub bank_reach: f32,
    /// Speed above which no ice grows from the banks, m/s, > 0. In rivers border ice stops at about 0.6 m/s.
    pub flow_limit: f32,
    /// Size of the large unevenness of the front, m, > 0.
    pub unevenness_size: f32,
}

/// Depth, m, over which the heat that the water has stored delays its freezing.
const STORING_DEPTH: f32 = 3.0;
/// Weights of bank, stored heat, current and chance.
const WEIGHTS: [f32; 4] = [1.0, 0.5, 2.0, 0.35];
/// Classes by which resistances are ranked.
const CLASSES: usize = 4096;

/// For every cell of a grid of `size` cells of `cell_size` (m) centred on the water: which part (0…1) of the water has
/// frozen before it. Dry land has 0, as the bank.
///
/// A place resists by its distance from the bank, the heat stored in its depth, and the stirring of its current
/// (∝ speed², the turbulent stress). Its order is its rank among all wet places: the cover grows evenly.
///
/// # Errors
/// [`GridError`] as for [`Grid::new`].
pub fn order_map(
    size: UVec2,
    cell_size: f32,
    freezing: &Freezing,
    site: impl Fn(Vec2) -> Site + Sync,
) -> Result<Grid<f32>, GridError> {
    let cells = Grid::from_fn(size, cell_size, |cell| cell)?;
    let place = |cell: UVec2| cells.position(cell);
    let sites: Vec<Site> = cells.values().par_iter().map(|&cell| site(place(cell))).collect();
    let dry: Vec<bool> = sites.iter().map(|site| site.depth.is_nan() || site.depth <= 0.0).collect();
    let distances = distance_to(size, &dry);
    let mut resistance: Vec<f32> = (cells.values().par_iter(), &sites, &distances)
        .into_par_iter()
        .map(|(&cell, site, distance)| {
            // The bank lies half-way between the last wet and the first dry cell.
            let distance = (distance - 0.5) * cell_size;
            if site.depth > 0.0 { freezing.resistance(site, distance, place(cell)) } else { f32::NAN }
        })
        .collect();
    // Distances along a rasterised bank have steps of a cell.
    for _ in 0..2 {
        resistance = smoothed(&resistance, size.x as usize);
    }
    Grid::new(size, cell_size, ranks(&resistance))
}

impl Freezing {
    fn resistance(&self, site: &Site, distance: f32, place: Vec2) -> f32 {
        let [bank, stored, current, chance] = WEIGHTS;
        let stirring = (site.speed / self.flow_limit).powi(2);
        let uneven = fractal_noise(place / self.unevenness_size, UVec2::splat(1 << 16), 3, 0x1CE);
        bank * (1.0 - libm::expf(-distance.max(0.0) / self.bank_reach))
            + stored * (1.0 - libm::expf(-site.depth / STORING_DEPTH))
            + current * stirring / (1.0 + stirring)
            + chance * uneven
    }
}

/// The mean of each cell and its eight neighbours with weights 4, 2, 1; NaN stays NaN and counts nowhere.
fn smoothed(values: &[f32], width: usize) -> Vec<f32> {
    let height = values.len() / width;
    let at = |x: usize, y: usize| values[y * width + x];
    let mean = |i: usize| {
        let (x, y) = (i % width, i / width);
        if values[i].is_nan() {
            return f32::NAN;
        }
        let (mut sum, mut all) = (0.0, 0.0);
        for v in y.saturating_sub(1)..=(y + 1).min(height - 1) {
            for u in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                let weight = f32::from(2 - x.abs_diff(u) as u8) * f32::from(2 - y.abs_diff(v) as u8);
                if !at(u, v).is_nan() {
                    sum += weight * at(u, v);
                    all += weight;
                }
            }
        }
        sum / all
    };
    (0..values.len()).into_par_iter().map(mean).collect()
}

/// Replaces each value by the share of smaller ones, in classes and linear within a class; NaN by 0.
fn ranks(values: &[f32]) -> Vec<f32> {
    let known = || values.iter().copied().filter(|value| !value.is_nan());
    let (low, high) = known().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    let per_class = (high - low).max(f32::MIN_POSITIVE) / CLASSES as f32;
    let class = |value: f32| ((value - low) / per_class).clamp(0.0, CLASSES as f32);
    let mut smaller = vec![0_u32; CLASSES + 1];
    for value in known() {
        smaller[(class(value) as usize).min(CLASSES - 1) + 1] += 1;
    }
    for i in 0..CLASSES {
        smaller[i + 1] += smaller[i];
    }
    let all = smaller[CLASSES].max(1) as f32;
    let rank = |value: &f32| {
        if value.is_nan() {
            return 0.0;
        }
        let i = (class(*value) as usize).min(CLASSES - 1);
        let (below, upto) = (smaller[i] as f32, smaller[i + 1] as f32);
        (below + (upto - below) * (class(*value) - i as f32)) / all
    };
    values.iter().map(rank).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ice::{Winter, cover};
    use glam::uvec2;

    const FREEZING: Freezing = Freezing { bank_reach: 8.0, flow_limit: 0.6, unevenness_size: 12.0 };

    /// A straight channel 40 m wide along z that runs fastest in its middle, between dry banks.
    fn channel(place: Vec2) -> Site {
        let across = 1.0 - (place.x / 20.0).powi(2);
        Site { depth: 2.0 * across, speed: 0.9 * across.max(0.0) }
    }

    #[test]
    fn banks_freeze_before_mid_stream() {
        let map = order_map(uvec2(64, 64), 1.0, &FREEZING, channel).expect("a grid");
        let mean = |x: f32| (-30..30).map(|z| map.sample(Vec2::new(x, z as f32))).sum::<f32>() / 60.0;
        let orders = [19.0, 13.0, 7.0, 0.0].map(mean);
        assert!(orders.windows(2).all(|pair| pair[0] < pair[1] - 0.1), "{orders:?}");
        assert_eq!(map.sample(Vec2::new(30.0, 0.0)), 0.0, "dry land counts as bank");
    }

    #[test]
    fn slow_water_freezes_before_fast_water_of_the_same_depth_and_bank() {
        let site = |p: Vec2| Site { depth: 1.5, speed: if p.x > 0.0 { 0.9 } else { 0.05 } };
        let map = order_map(uvec2(64, 64), 1.0, &FREEZING, site).expect("a grid");
        let half = |sign: f32| {
            let of = map.iter().filter(|&(cell, _)| map.position(cell).x * sign > 2.0).map(|(_, order)| *order);
            of.fold((1.0_f32, 0.0_f32), |(first, last), order| (first.min(order), last.max(order)))
        };
        assert!(half(-1.0).1 < half(1.0).0, "{:?} {:?}", half(-1.0), half(1.0));
    }

    #[test]
    fn cover_grows_evenly_with_the_control() {
        let map = order_map(uvec2(64, 64), 1.0, &FREEZING, channel).expect("a grid");
        let wet: Vec<f32> =
            map.iter().filter(|&(cell, _)| channel(map.position(cell)).depth > 0.0).map(|(_, order)| *order).collect();
        let covered = |freezing: f32| {
            let winter = Winter { freezing, thickest: 0.3 };
            wet.iter().map(|&order| cover(winter.thickness(order))).sum::<f32>() / wet.len() as f32
        };
        for i in 1..9 {
            let freezing = i as f32 * 0.1;
            let expected = (freezing - 0.013) / 0.8;
            assert!((covered(freezing) - expected.min(1.0)).abs() < 0.02, "{freezing}: {}", covered(freezing));
        }
    }

    #[test]
    fn water_without_banks_freezes_in_patches() {
        let map = order_map(uvec2(50, 30), 2.0, &FREEZING, |_| Site { depth: f32::INFINITY, speed: 0.0 });
        let map = map.expect("a grid");
        let values = map.values();
        assert!(values.iter().all(|order| (0.0..=1.0).contains(order)));
        let early = values.iter().filter(|&&order| order < 0.5).count();
        assert!((early as f32 / values.len() as f32 - 0.5).abs() < 0.02);
    }

    #[test]
    fn land_and_a_single_cell_are_no_trouble() {
        let dry = |_: Vec2| Site { depth: f32::NEG_INFINITY, speed: 0.0 };
        assert!(
            order_map(uvec2(9, 5), 1.0, &FREEZING, dry).expect("a grid").values().iter().all(|&order| order == 0.0)
        );
        let one = order_map(UVec2::ONE, 1.0, &FREEZING, channel).expect("a grid");
        assert!(one.values()[0].is_finite());
    }

    /// How long the largest map takes, for whoever wants to know: `cargo test -p freshet_hydro map_takes -- --ignored
    /// --nocapture`.
    #[test]
    #[ignore = "a measurement"]
    fn the_largest_map_takes() {
        for size in [128, 256, 384, 512] {
            let start = std::time::Instant::now();
            let map = order_map(UVec2::splat(size), 40.0 / size as f32, &FREEZING, channel);
            println!("{size}²: {:.1} ms, {}", start.elapsed().as_secs_f64() * 1e3, map.is_ok());
        }
    }
}
