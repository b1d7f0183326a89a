//! Rain on the water.
use super::disturb::deposit;
use crate::{
    body::{ResolvedWater, WaterInteraction},
    report::Reported,
    simulation::{Deposits, FieldProgress, FieldWindow, Stroke},
};
use bevy::prelude::*;
use fastrand::Rng;
use freshet_hydro::rain::Rain;

/// Most drops, on average, that reach a window in a frame. More rain falls in fewer, larger strokes.
const MOST_DROPS: f32 = 256.0;

/// Lets the drops of the frame fall.
///
/// Places are random, counts follow Poisson's distribution, and both depend on nothing but the virtual clock and the
/// water's entity, so that runs repeat. A drop opens a crater, and the rebound throws up a jet of about the same volume:
/// strokes of both signs, so that the mean level stays. Where one stroke stands for n drops, its volume is √n craters:
/// energy goes with the square of the volume, so the energy of the waves is that of all drops.
pub(super) fn fall(
    time: Res<Time>,
    mut waters: Query<(Entity, &WaterInteraction, &ResolvedWater, &FieldWindow, &FieldProgress, &mut Deposits)>,
    mut reported: ResMut<Reported>,
) {
    for (entity, interaction, water, window, progress, mut deposits) in &mut waters {
        let rate = reported.clamp(entity, "WaterInteraction::rain", interaction.rain, 0.0..=500.0, 0.0);
        let Some(rain) = Rain::of_rate(rate).filter(|_| window.size.min_element() > 0 && progress.runs()) else {
            continue;
        };
        let drops = rain.drops * window.extent().element_product() * time.delta_secs();
        let strokes = drops.min(MOST_DROPS);
        let volume = rain.crater_volume * (drops / strokes).sqrt();
        let mut random = Rng::with_seed(time.elapsed().as_nanos() as u64 ^ entity.to_bits().rotate_left(17));
        for _ in 0..poisson(strokes, &mut random) {
            let place = window.origin() + window.extent() * vec2(random.f32(), random.f32());
            let volume = if random.bool() { volume } else { -volume };
            if water.covers(place) && water.still_depth(place) > 0.0 {
                // As narrow as the cells allow.
                let stroke = Stroke { place, radius: 0.0, volume, foam: 0.0, dye: Vec3::ZERO };
                deposit(window, &mut deposits, stroke);
            }
        }
    }
}

/// A number of Poisson's distribution of this `mean` (0…700): how many uniform numbers it takes until their product falls
/// below exp(−mean) (Knuth 1969, vol. 2, 3.4.1).
fn poisson(mean: f32, random: &mut Rng) -> u32 {
    let limit = f64::exp(-f64::from(mean));
    let (mut count, mut product) = (0, random.f64());
    while product > limit {
        count += 1;
        product *= random.f64();
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_variance_are_those_of_poisson() {
        let mut random = Rng::with_seed(7);
        for mean in [0.3_f32, 5.0, 256.0] {
            let n = 4000;
            let counts: Vec<f32> = (0..n).map(|_| poisson(mean, &mut random) as f32).collect();
            let average = counts.iter().sum::<f32>() / n as f32;
            let variance = counts.iter().map(|c| (c - average).powi(2)).sum::<f32>() / n as f32;
            // Five standard errors.
            assert!((average - mean).abs() < 5.0 * (mean / n as f32).sqrt(), "{average} for {mean}");
            assert!((variance / mean - 1.0).abs() < 0.15, "variance {variance} for {mean}");
        }
    }
}
