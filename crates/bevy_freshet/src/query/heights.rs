//! Heights of the water at many places at once.
use super::{AT_ONCE, WaterQuery, find};
use crate::body::ResolvedWater;
use bevy::{
    prelude::*,
    tasks::{ComputeTaskPool, ParallelSliceMut},
};
use freshet_hydro::waves::{self, HeightSearch};
use std::slice;

/// Places that a thread takes at a time, so that their sum is worth the way to it.
const CHUNK: usize = 256;

/// A water, and how its heights are found.
struct Search<'a> {
    water: &'a ResolvedWater,
    error: f32,
    /// None where only the exact search will do.
    quick: Option<HeightSearch>,
}

impl WaterQuery<'_, '_> {
    /// Replaces `heights` by the world height of the surface at each of `places` (world, m), each within `error` (m, > 0) of that of
    /// [`WaterQuery::sample`], and `None` where that is `None`.
    ///
    /// The larger the error, the less it costs: low waves are left out, and the search for the particle above a place ends sooner. Both are
    /// bounded for the steepest place of the water, so that what is found is mostly ten times nearer. The bound needs waves whose
    /// steepnesses add up to less than 1, and a bed without gaps that does not shelve too steeply for them. Waters with ice, simulated
    /// ones, places where several waters lie above one another, and errors that the search of `sample` has itself are searched as `sample` does. Large batches are
    /// shared out between the threads of the [`ComputeTaskPool`]; a place has the same height in every batch.
    ///
    /// ```
    /// # use bevy::prelude::*;
    /// # use bevy_freshet::prelude::*;
    /// /// Keeps a flock of birds off the waves; a centimetre does not matter to them.
    /// fn fly(water: WaterQuery, mut birds: Query<&mut Transform>, mut heights: Local<Vec<Option<f32>>>) {
    ///     let places: Vec<Vec3> = birds.iter().map(|bird| bird.translation).collect();
    ///     water.heights(&places, 0.01, &mut heights);
    ///     for (mut bird, height) in birds.iter_mut().zip(&*heights) {
    ///         bird.translation.y = bird.translation.y.max(height.unwrap_or(f32::NEG_INFINITY) + 0.3);
    ///     }
    /// }
    /// # bevy::ecs::system::assert_is_system(fly);
    /// ```
    pub fn heights(&self, places: &[Vec3], error: f32, heights: &mut Vec<Option<f32>>) {
        let searches: Vec<Search> = self.waters.iter().map(|(_, water)| Search::new(water, error)).collect();
        let fill = |first: usize, chunk: &mut [Option<f32>]| {
            for (found, places) in chunk.chunks_mut(AT_ONCE).zip(places[first..].chunks(AT_ONCE)) {
                self.fill(&searches, places, found);
            }
        };
        heights.clear();
        heights.resize(places.len(), None);
        match ComputeTaskPool::try_get().filter(|_| places.len() > CHUNK) {
            Some(pool) => _ = heights.par_chunk_map_mut(pool, CHUNK, |index, chunk| fill(index * CHUNK, chunk)),
            None => fill(0, heights),
        }
    }

    /// Finds the heights at up to [`AT_ONCE`] places: all together where they are in one water alone.
    fn fill(&self, searches: &[Search], places: &[Vec3], heights: &mut [Option<f32>]) {
        let around = |place: Vec3| searches.iter().filter(move |search| search.covers(place));
        let sole = |place: Vec3| around(place).next().filter(|_| around(place).nth(1).is_none());
        if let Some(search) = sole(places[0])
            && places.iter().all(|place| search.covers(*place) && around(*place).nth(1).is_none())
        {
            return search.fill(places, heights);
        }
        for (place, height) in places.iter().zip(heights) {
            match sole(*place) {
                Some(search) => search.fill(slice::from_ref(place), slice::from_mut(height)),
                None => *height = self.sample(*place).map(|sample| sample.height),
            }
        }
    }
}

impl<'a> Search<'a> {
    fn new(water: &'a ResolvedWater, error: f32) -> Self {
        let is_plain = water.ice.is_none() && water.simulated.is_none();
        let quick = if is_plain { HeightSearch::new(&water.waves, steepest_fade(water), error) } else { None };
        Self { water, error, quick }
    }

    fn local(&self, place: Vec3) -> Vec2 {
        self.water.local_from_world.transform_point2(place.xz())
    }

    fn covers(&self, place: Vec3) -> bool {
        self.water.covers(self.local(place))
    }

    /// Finds the heights at up to [`AT_ONCE`] places that the water covers.
    fn fill(&self, places: &[Vec3], heights: &mut [Option<f32>]) {
        let mut local = [Vec2::ZERO; AT_ONCE];
        let local = &mut local[..places.len()];
        local.iter_mut().zip(places).for_each(|(local, place)| *local = self.local(*place));
        let Some(quick) = &self.quick else { return self.fill_exactly(local, heights) };
        let elevations = quick.heights(local, |rest| self.water.fade(rest));
        for ((place, elevation), height) in local.iter().zip(elevations).zip(heights) {
            let depth = self.water.ground_depth(*place) + elevation;
            *height = (depth > 0.0).then_some(self.water.level + elevation);
            // Shallower water than the error may be none.
            if depth.abs() <= self.error {
                self.fill_exactly(slice::from_ref(place), slice::from_mut(height));
            }
        }
    }

    fn fill_exactly(&self, local: &[Vec2], heights: &mut [Option<f32>]) {
        for (height, found) in heights.iter_mut().zip(find(self.water, &self.water.waves, local)) {
            *height = found.map(|found| self.water.level + found.elevation);
        }
    }
}

/// Bound of how much the share of the waves differs per distance, 1/m.
fn steepest_fade(water: &ResolvedWater) -> f32 {
    match &water.bed {
        Some(bed) if water.fade_depth > 0.0 => waves::STEEPEST_FADE / water.fade_depth * bed.steepest,
        _ => 0.0,
    }
}
