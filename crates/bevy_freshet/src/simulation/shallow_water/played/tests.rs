//! The stage against its twin.
use super::{
    super::{
        super::tests::{readback, stage::Stage},
        StagesPlugin, frame,
    },
    stage::GpuPlayed,
    *,
};
use bevy::render::RenderApp;
use freshet_flood::{maps::FloodMaps, playback::Moment};
use freshet_hydro::shallow_water::{WET, WaterCells};
use std::path::Path;

/// A flood that the stage draws.
struct Drawn {
    stage: Stage,
    entity: Entity,
    maps: FloodMaps,
    parts: Vec<Arc<PlayedInterval>>,
    pictures: [Handle<Image>; 2],
}

impl Drawn {
    fn new() -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/flood/played");
        let maps = FloodMaps::open(folder).unwrap();
        let mut stage = Stage::with(|app| _ = app.add_plugins(StagesPlugin));
        let mut images = stage.app.world_mut().resource_mut::<Assets<Image>>();
        let pictures = frame::pictures(maps.georeference().size).map(|image| images.add(image));
        let entity = stage.spawn(());
        Self { stage, entity, maps, parts: Vec::new(), pictures }
    }

    fn part(&mut self, index: usize) -> Arc<PlayedInterval> {
        if let Some(part) = self.parts.iter().find(|part| part.index() == index) {
            return part.clone();
        }
        let part = Arc::new(PlayedInterval::read(&self.maps, &self.parts, index).unwrap());
        self.parts.push(part.clone());
        part
    }

    /// Draws a moment, and hands over what comes next in so many frames.
    fn draw(&mut self, moment: &Arc<Moment>, next: Option<Arc<PlayedInterval>>, frames: u32) {
        let work = ShallowWork::Played(moment.clone(), next);
        let frame = ShallowFrame { work, pictures: self.pictures.each_ref().map(Handle::id) };
        self.stage.app.world_mut().entity_mut(self.entity).insert(frame);
        self.stage.settle();
        (0..frames).for_each(|_| self.stage.app.update());
    }

    /// Rows of a part's second step and of its turns that the GPU has.
    fn rows(&mut self, part: &Arc<PlayedInterval>) -> [u32; 2] {
        let world = self.stage.app.sub_app_mut(RenderApp).world_mut();
        world.query::<&Played>().single(world).unwrap().rows(part)
    }

    /// Level, depth and velocity of every cell in the picture, and its slope.
    fn cells(&mut self) -> Vec<(Vec4, Vec2)> {
        let size = self.maps.georeference().size;
        let [cells, slopes] = self.pictures.each_ref().map(|picture| readback::read(&mut self.stage, picture));
        let single = |texel: &[u8], at: usize| f32::from_le_bytes([0, 1, 2, 3].map(|byte| texel[at + byte]));
        let cells =
            readback::texels(&cells, size, 16).map(|cell| Vec4::from_array([0, 4, 8, 12].map(|at| single(cell, at))));
        cells.zip(readback::texels(&slopes, size, 8).map(|slope| readback::halves(slope).xy())).collect()
    }

    /// Fails where the picture is not that of `moment`; says how many cells are wet.
    fn compare(&mut self, moment: &Moment) -> usize {
        let (drawn, columns) = (self.cells(), moment.size().x as usize);
        let mut wet = 0;
        for (index, (cell, slope)) in drawn.iter().enumerate() {
            let (expected, at) = (moment.cell(index), (index % columns, index / columns));
            if expected.y > WET {
                wet += 1;
                assert!((*cell - expected).abs().max_element() < 2e-5, "{at:?}: {cell} for {expected}");
                let off = (*slope - moment.slope(index)).abs().max_element();
                assert!(off < 1e-3 * (1.0 + slope.length()), "{at:?}: {slope} for {}", moment.slope(index));
            } else {
                assert_eq!((cell.x, cell.y, *slope), (expected.x, expected.y, Vec2::ZERO), "{at:?}");
            }
        }
        wet
    }
}

#[test]
fn a_flood_is_drawn_as_its_twin_has_it() {
    let mut drawn = Drawn::new();
    let times = drawn.maps.times().to_vec();
    // At steps and between them, forwards, backwards, and far away.
    for (index, share, factor) in
        [(3, 0.0, 1.0), (3, 0.3, 1.0), (4, 0.0, 1.0), (4, 0.8, 2.5), (2, 0.5, 1.0), (10, 0.99, 1.0), (11, 1.0, 1.0)]
    {
        let part = drawn.part(index);
        let time = times[index] + share * (times[index + 1] - times[index]);
        let moment = Arc::new(Moment::new(part, time, factor));
        drawn.draw(&moment, None, 1);
        let wet = drawn.compare(&moment);
        assert!(wet > 300, "{time} s: {wet} cells");
    }
}

#[test]
fn what_comes_next_is_there_when_it_comes() {
    let mut drawn = Drawn::new();
    let (first, next) = (drawn.part(5), drawn.part(6));
    let times = drawn.maps.times().to_vec();
    drawn.draw(&Arc::new(Moment::new(first, times[5] + 1.0, 1.0)), Some(next.clone()), 20);
    assert_eq!(drawn.rows(&next), [next.size.y; 2], "it is not handed over in time");
    let moment = Arc::new(Moment::new(next, times[6] + 30.0, 1.0));
    drawn.draw(&moment, None, 1);
    assert!(drawn.compare(&moment) > 300);
}

#[test]
fn what_is_written_for_the_stage_is_what_it_reads() {
    crate::layout::assert_same_layout::<GpuPlayed, _>(include_str!("played.wgsl"), "Numbers");
}
