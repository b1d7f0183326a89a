//! How far the fields of a water have come, and what is to be done in a frame.
use super::{
    Deposits, FieldPictures, FieldWindow, Simulated, Stroke,
    frame::{FieldFrame, FieldWork, picture},
    numbers::{GpuNumbers, Parts},
    tiles::{Drafts, GpuDeposits},
};
use crate::{
    body::{ResolvedWater, WaterFoam, WaterInteraction},
    report::Reported,
    surface::{GpuSurface, GroundTextures, write_frozen, write_ground, write_water},
};
use bevy::prelude::*;
use core::time::Duration;
use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

/// Duration of a step.
const STEP: Duration = Duration::from_nanos(16_666_667);
/// Most steps in a frame.
const MOST_STEPS: u32 = 8;
/// So many late frames in a row are no hiccup.
const LATE_FRAMES: u32 = 30;
/// Strokes that may wait for a step; of more the oldest are forgotten.
const MOST_STROKES: usize = 4096;
/// After so many times their life, what is left of rings, foam and dye is not worth a step: e⁻¹⁰.
const LIVES: f32 = 10.0;

/// What the fields of a water have come to.
#[derive(Component, Default)]
pub(crate) struct FieldProgress {
    /// Time that no step has used yet.
    owed: Duration,
    /// Late frames in a row.
    late: u32,
    drafts: Drafts,
    strokes: Vec<Stroke>,
    /// For how many more lives rings, foam and dye are worth steps.
    rings_left: f32,
    foam_left: f32,
    dye_left: f32,
    ground: Ground,
    /// Counts the grounds.
    version: u64,
    /// Counts the pictures; the render world says which it has begun to draw.
    generation: u64,
    drawn: Arc<AtomicU64>,
}

/// What the ground stage depends on.
#[derive(Clone, Debug, Default, PartialEq)]
struct Ground {
    window: FieldWindow,
    numbers: GpuNumbers,
    surface: GpuSurface,
    textures: [Option<AssetId<Image>>; 2],
}

/// What was to be done in the last frame is not done again, also for a water that lacks what `step_fields` asks for.
pub(super) fn forget_frames(mut frames: Query<&mut FieldFrame, With<FieldProgress>>) {
    frames.iter_mut().for_each(|mut frame| *frame = FieldFrame::Idle);
}

/// Advances the clock of every water's fields and says what is to be done.
pub(super) fn step_fields(
    time: Res<Time>,
    mut ground: ResMut<GroundTextures>,
    mut images: ResMut<Assets<Image>>,
    mut reported: ResMut<Reported>,
    mut waters: Query<(
        Entity,
        (&WaterInteraction, &WaterFoam, &ResolvedWater, &FieldWindow, Option<&Simulated>),
        (&mut Deposits, &mut FieldProgress, &mut FieldPictures, &mut FieldFrame),
    )>,
) {
    for (entity, (settings, foam, water, window, simulated), fields) in &mut waters {
        let (mut deposits, mut progress, mut pictures, mut frame) = fields;
        *frame = if window.size == UVec2::ZERO {
            switch_off(&mut progress, &mut pictures)
        } else {
            progress.resize(window, &mut pictures, &mut images);
            let simulated = simulated.and_then(|simulated| simulated.pictures.as_ref());
            let settings = Settings { entity, interaction: settings, foam, water, window, simulated };
            let work = progress.advance(
                &settings,
                &mut deposits,
                &pictures,
                time.delta(),
                &mut ground,
                &mut images,
                &mut reported,
            );
            work.map_or(FieldFrame::Idle, |work| FieldFrame::Work(Box::new(work)))
        };
    }
}

/// Everything that the fields of a water are made by.
struct Settings<'a> {
    entity: Entity,
    interaction: &'a WaterInteraction,
    foam: &'a WaterFoam,
    water: &'a ResolvedWater,
    window: &'a FieldWindow,
    simulated: Option<&'a [Handle<Image>; 2]>,
}

fn switch_off(progress: &mut FieldProgress, pictures: &mut FieldPictures) -> FieldFrame {
    if pictures.rings.is_none() {
        return FieldFrame::Idle;
    }
    // Generations go on counting, so that a late word of the render world is not taken for another one.
    let (generation, drawn) = (progress.generation, progress.drawn.clone());
    *progress = FieldProgress { generation, drawn, ..default() };
    *pictures = FieldPictures::default();
    FieldFrame::Off
}

impl FieldProgress {
    /// Whether the clock runs: not until the stages have been made and the pictures are drawn.
    pub fn runs(&self) -> bool {
        self.drawn.load(Ordering::Relaxed) >= self.generation
    }

    /// Makes pictures of the window's size.
    fn resize(&mut self, window: &FieldWindow, pictures: &mut FieldPictures, images: &mut Assets<Image>) {
        let fits = |image: &Handle<Image>| images.get(image).is_some_and(|image| image.size() == window.size);
        if !pictures.rings.as_ref().is_some_and(fits) {
            pictures.rings = Some(images.add(picture("water_rings", window.size)));
            pictures.matter = Some(images.add(picture("water_matter", window.size)));
            self.generation += 1;
        }
    }

    /// What is to be done after `delta`; nothing if all stays as it is.
    fn advance(
        &mut self,
        settings: &Settings,
        deposits: &mut Deposits,
        pictures: &FieldPictures,
        delta: Duration,
        textures: &mut GroundTextures,
        images: &mut Assets<Image>,
        reported: &mut Reported,
    ) -> Option<FieldWork> {
        let (mut work, parts, moved) = self.prepare(settings, pictures, textures, images, reported)?;
        // Taken, lest a stroke that nobody clears counts again.
        self.strokes.append(&mut deposits.strokes);
        self.strokes.drain(..self.strokes.len().saturating_sub(MOST_STROKES));
        if !self.runs() {
            return Some(work);
        }
        let steps = self.steps(settings.entity, delta, reported);
        if steps > 0 {
            let silhouettes = deposits.silhouettes.clone();
            let all = Deposits { silhouettes, strokes: core::mem::take(&mut self.strokes) };
            let usable = WaterInteraction::default().rings;
            let rings = settings.interaction.rings;
            let factor = reported.clamp(settings.entity, "WaterInteraction::rings", rings, 0.0..=10.0, usable);
            work.deposits = GpuDeposits::new(settings.window, &all, &mut self.drafts, factor);
            self.keep_alive(&work, settings);
            let run = STEP.as_secs_f32() * steps as f32;
            work.ring_steps = if self.rings_left > 0.0 { steps * parts.rings } else { 0 };
            work.is_dyed = self.dye_left > 0.0;
            let matters = work.is_dyed || self.foam_left > 0.0;
            work.transport_steps = if matters { steps * parts.transport } else { 0 };
            self.rings_left -= run * work.numbers.ring_decay;
            self.foam_left -= run / work.numbers.foam_life;
            self.dye_left -= run * work.numbers.dye_decay;
        } else if moved {
            work.deposits = GpuDeposits::covers(settings.window, deposits);
        }
        work.numbers.silhouettes = work.deposits.silhouettes.len() as u32;
        let works = work.ring_steps + work.transport_steps > 0 || !work.deposits.silhouettes.is_empty();
        (works || moved).then_some(work)
    }

    /// The work of a frame without steps, the parts of a step, and whether the ground has changed.
    fn prepare(
        &mut self,
        settings: &Settings,
        pictures: &FieldPictures,
        textures: &mut GroundTextures,
        images: &mut Assets<Image>,
        reported: &mut Reported,
    ) -> Option<(FieldWork, Parts, bool)> {
        let &Settings { entity, interaction, foam, water, window, simulated } = settings;
        let fastest = match (&water.simulated, &water.flow) {
            (Some(simulated), map) => {
                let around = map.as_ref().filter(|_| simulated.area.is_part());
                simulated.water.fastest().max(around.map_or(0.0, |(map, scale)| textures.fastest(map) * scale.abs()))
            }
            (None, Some((map, scale))) => textures.fastest(map) * scale.abs(),
            (None, None) => 0.0,
        };
        let (numbers, parts) = GpuNumbers::new(entity, interaction, foam, water, window, fastest, reported);
        let mut surface = GpuSurface::default();
        write_water(&mut surface, water);
        let (bed, flow) = write_ground(&mut surface, water, textures, images);
        let ice = write_frozen(&mut surface, water, textures, images);
        let [bed, flow, ice_order] = [bed, flow, ice].map(|texture| texture.map(|texture| texture.id()));
        // Waves move all the time, and ice comes and goes; they do not change the ground.
        let still = GpuSurface { waves: default(), ice_freezing: 0.0, ..surface.clone() };
        let ground = Ground { window: *window, numbers: numbers.clone(), surface: still, textures: [bed, flow] };
        // Simulated water moves all the time.
        let moved = ground != self.ground || water.simulated.is_some();
        if moved {
            self.ground = ground;
            self.version += 1;
        }
        let work = FieldWork {
            window: *window,
            drifts: numbers.drift != Vec2::ZERO || fastest != 0.0,
            numbers,
            surface,
            bed,
            flow,
            ice_order,
            simulated: simulated.map_or([None, None], |pair| pair.each_ref().map(|picture| Some(picture.id()))),
            pictures: [pictures.rings.as_ref()?.id(), pictures.matter.as_ref()?.id()],
            deposits: default(),
            ground: self.version,
            is_dyed: false,
            ring_steps: 0,
            transport_steps: 0,
            generation: self.generation,
            drawn: self.drawn.clone(),
        };
        Some((work, parts, moved))
    }

    /// Whole steps that are due.
    fn steps(&mut self, entity: Entity, delta: Duration, reported: &mut Reported) -> u32 {
        self.owed += delta;
        let due = (self.owed.as_nanos() / STEP.as_nanos()) as u32;
        if due <= MOST_STEPS {
            self.late = 0;
            self.owed -= STEP * due;
            return due;
        }
        self.late += 1;
        self.owed = Duration::ZERO;
        if self.late == LATE_FRAMES {
            let problem = "cannot keep up with the frames: rings, foam and dye run slow; larger or fewer cells help";
            reported.warn(entity, "WaterInteraction", problem);
        }
        MOST_STEPS
    }

    /// Lets rings, foam and dye last as long as what feeds them now will be seen.
    fn keep_alive(&mut self, work: &FieldWork, settings: &Settings) {
        let (numbers, strokes) = (&work.numbers, &work.deposits.strokes);
        let raised = work.deposits.silhouettes.iter().any(|one| one.raise != 0.0);
        if raised || strokes.iter().any(|stroke| stroke.volume != 0.0) {
            self.rings_left = LIVES;
        }
        let open = settings.water.ice.as_ref().is_none_or(|ice| !ice.is_closed());
        let born = settings.water.bed.is_some() && numbers.shore > 0.0
            || work.drifts && (numbers.shear + numbers.breaking + numbers.speed > 0.0)
            || !work.deposits.silhouettes.is_empty() && numbers.bodies > 0.0;
        if settings.foam.amount <= 0.0 {
            self.foam_left = 0.0;
        } else if open && born || strokes.iter().any(|stroke| stroke.foam != 0.0) {
            self.foam_left = LIVES;
        }
        if strokes.iter().any(|stroke| stroke.dye != Vec3::ZERO) {
            self.dye_left = LIVES;
        }
    }
}
