//! Reads parts of a flood before they are shown, in the background.
use super::{FloodMaps, MapsError};
use bevy::tasks::{AsyncComputeTaskPool, Task, block_on};
use freshet_flood::playback::PlayedInterval;
use std::sync::Arc;

/// What of a flood is in memory.
#[derive(Default)]
pub struct Ahead {
    maps: Option<Arc<FloodMaps>>,
    parts: Vec<Arc<PlayedInterval>>,
    reading: Option<(usize, Task<Result<PlayedInterval, MapsError>>)>,
    /// Parts that cannot be read.
    failed: Vec<usize>,
}

impl Ahead {
    /// The part `wanted`, if it is there; if it `waits` it is, unless it cannot be read. The part `next` is read after it, and all others but
    /// its neighbours are forgotten. With it comes why another part, or this one, cannot be read, once.
    pub fn part(
        &mut self,
        maps: &Arc<FloodMaps>,
        [wanted, next]: [usize; 2],
        waits: bool,
    ) -> (Option<Arc<PlayedInterval>>, Option<MapsError>) {
        if !self.maps.as_ref().is_some_and(|known| Arc::ptr_eq(known, maps)) {
            *self = Self { maps: Some(maps.clone()), ..Self::default() };
        }
        let mut failed = None;
        loop {
            let found = self.get(wanted);
            let missing = !self.failed.contains(&wanted) && found.is_none();
            failed = self.receive(missing && waits).err().or(failed);
            if self.reading.is_none() {
                let is_known = |index: usize| self.failed.contains(&index) || self.get(index).is_some();
                if let Some(index) = [wanted, next].into_iter().find(|index| !is_known(*index)) {
                    self.read(maps.clone(), index);
                }
            }
            if !(missing && waits) {
                self.parts.retain(|part| part.index().abs_diff(wanted) <= 1 || part.index() == next);
                return (found, failed);
            }
        }
    }

    /// Whether a part cannot be read.
    pub fn has_failed(&self, index: usize) -> bool {
        self.failed.contains(&index)
    }

    /// A part, if it is there.
    pub fn get(&self, index: usize) -> Option<Arc<PlayedInterval>> {
        self.parts.iter().find(|part| part.index() == index).cloned()
    }

    fn read(&mut self, maps: Arc<FloodMaps>, index: usize) {
        let known = self.parts.clone();
        let task = AsyncComputeTaskPool::get().spawn(async move { PlayedInterval::read(&maps, &known, index) });
        self.reading = Some((index, task));
    }

    /// Takes what has been read, or waits until it is.
    fn receive(&mut self, waits: bool) -> Result<(), MapsError> {
        let Some((index, task)) = self.reading.take_if(|(_, task)| waits || task.is_finished()) else { return Ok(()) };
        match block_on(task) {
            Ok(part) => {
                self.parts.push(Arc::new(part));
                Ok(())
            }
            Err(error) => {
                self.failed.push(index);
                Err(error)
            }
        }
    }
}
