//! The stage that draws a flood.
use super::{
    super::{
        frame::{ShallowFrame, ShallowWork},
        pictures::level_of,
        stages::Stages,
    },
    textures::Textures,
};
use bevy::{
    prelude::*,
    render::{
        render_asset::RenderAssets,
        render_resource::{
            BindGroup, BindGroupEntries, BindGroupLayoutDescriptor, BindGroupLayoutEntries, ComputePassDescriptor,
            PipelineCache, ShaderStages, ShaderType, TextureSampleType, TextureView, UniformBuffer,
            binding_types::{texture_2d, uniform_buffer},
        },
        renderer::{RenderContext, RenderDevice, RenderQueue},
        texture::GpuImage,
    },
};
use freshet_flood::playback::{Ground, Moment, PlayedInterval, PlayedStep};
use freshet_hydro::shallow_water::WaterCells;
use std::sync::Arc;

/// Bytes that are handed over in a frame of what is shown only later. A step of a million cells takes three frames; so does a small one in tests.
const AHEAD: usize = if cfg!(test) { 1 << 16 } else { 4 << 20 };

/// What the GPU has of a flood.
#[derive(Component)]
pub(in super::super) struct Played {
    ground: Textures<Ground>,
    steps: Textures<PlayedStep>,
    turns: Textures<PlayedInterval>,
    numbers: UniformBuffer<GpuPlayed>,
    size: UVec2,
    /// What was drawn, and the pictures that it was drawn into.
    drawn: Option<(Arc<Moment>, [AssetId<Image>; 2])>,
    /// What is to be drawn in this frame.
    groups: Option<[BindGroup; 2]>,
}

/// What the stage reads, as `played.wgsl` has it.
#[derive(Clone, Debug, Default, ShaderType)]
#[cfg_attr(test, derive(Reflect))]
pub(crate) struct GpuPlayed {
    /// Columns and rows.
    pub size: IVec2,
    /// Side of a cell, m.
    pub cell: f32,
    /// Share of the way from the first step to the second.
    pub share: f32,
    /// Depth from which on a cell is wet, m.
    pub threshold: f32,
    /// Factor on elevations and depths.
    pub factor: f32,
}

/// What the stage binds beside the pictures.
pub(in super::super) fn played_layout() -> BindGroupLayoutDescriptor {
    let depths = texture_2d(TextureSampleType::Float { filterable: false });
    let cells = texture_2d(TextureSampleType::Uint);
    let entries = BindGroupLayoutEntries::sequential(
        ShaderStages::COMPUTE,
        (uniform_buffer::<GpuPlayed>(false), depths, cells, cells, depths),
    );
    BindGroupLayoutDescriptor::new("water_flood", &entries)
}

/// Textures of a lost device are of no use.
pub(in super::super) fn forget_played(mut commands: Commands, played: Query<Entity, With<Played>>) {
    played.iter().for_each(|entity| _ = commands.entity(entity).remove::<Played>());
}

/// Hands over what of every flood is new, and plans its pictures if its time has changed.
pub(in super::super) fn plan_played(
    mut commands: Commands,
    stages: Res<Stages>,
    cache: Res<PipelineCache>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    images: Res<RenderAssets<GpuImage>>,
    mut waters: Query<(Entity, &ShallowFrame, Option<&mut Played>)>,
    orphans: Query<Entity, (With<Played>, Without<ShallowFrame>)>,
) {
    orphans.iter().for_each(|entity| _ = commands.entity(entity).remove::<Played>());
    let is_ready = cache.get_compute_pipeline(stages.show_played).is_some();
    for (entity, frame, played) in &mut waters {
        let ShallowWork::Played(moment, next) = &frame.work else {
            if played.is_some() {
                commands.entity(entity).remove::<Played>();
            }
            continue;
        };
        let [Some(cells), Some(slopes)] = frame.pictures.map(|picture| images.get(picture)) else { continue };
        let mut made = None;
        let played = match played.filter(|played| played.size == moment.size()) {
            Some(played) => played.into_inner(),
            None => made.insert(Played::new(moment.size())),
        };
        played.hold(moment, next.as_ref(), &device, &queue);
        played.groups = None;
        let is_drawn = |(drawn, pictures): &(Arc<Moment>, _)| Arc::ptr_eq(drawn, moment) && *pictures == frame.pictures;
        if is_ready && !played.drawn.as_ref().is_some_and(is_drawn) {
            let views = [cells, slopes].map(|picture| level_of(picture, 0));
            played.groups = played.plan(moment, views, &stages, &cache, &device, &queue);
            played.drawn = played.groups.is_some().then(|| (moment.clone(), frame.pictures));
        }
        if let Some(played) = made {
            commands.entity(entity).insert(played);
        }
    }
}

impl Played {
    fn new(size: UVec2) -> Self {
        let mut numbers = UniformBuffer::default();
        numbers.set_label(Some("water_flood_numbers"));
        let (ground, steps, turns) = (Textures::new(size), Textures::new(size), Textures::new(size));
        Self { ground, steps, turns, numbers, size, drawn: None, groups: None }
    }

    /// Rows of a part's second step and of its turns that are there.
    #[cfg(test)]
    pub fn rows(&self, part: &Arc<PlayedInterval>) -> [u32; 2] {
        [self.steps.rows(&part.steps[1]), self.turns.rows(part)]
    }

    /// Whether its pictures are drawn in this frame.
    pub fn is_new(&self) -> bool {
        self.groups.is_some()
    }

    /// Keeps room for the steps around a moment and for those of the `next` interval, which are handed over little by little.
    fn hold(
        &mut self,
        moment: &Moment,
        next: Option<&Arc<PlayedInterval>>,
        device: &RenderDevice,
        queue: &RenderQueue,
    ) {
        let shown = moment.interval();
        let next = next.filter(|next| next.size == self.size);
        let parts: Vec<_> = [shown].into_iter().chain(next).collect();
        let steps: Vec<_> = parts.iter().flat_map(|part| &part.steps).collect();
        self.ground.keep(&[&shown.ground], device);
        self.steps.keep(&steps, device);
        self.turns.keep(&parts, device);
        let Some(next) = next else { return };
        let mut left = AHEAD;
        next.steps.iter().for_each(|step| self.steps.fill(step, &mut left, queue));
        self.turns.fill(next, &mut left, queue);
    }

    /// What the stage binds to draw a moment; all of what that takes is handed over.
    fn plan(
        &mut self,
        moment: &Moment,
        pictures: [TextureView; 2],
        stages: &Stages,
        cache: &PipelineCache,
        device: &RenderDevice,
        queue: &RenderQueue,
    ) -> Option<[BindGroup; 2]> {
        let part = moment.interval();
        self.numbers.set(GpuPlayed {
            size: self.size.as_ivec2(),
            cell: part.cell_size,
            share: moment.share(),
            threshold: part.threshold,
            factor: moment.factor(),
        });
        self.numbers.write_buffer(device, queue);
        let ground = self.ground.view(&part.ground, queue)?;
        let [before, after] = &part.steps;
        let before = self.steps.view(before, queue)?.clone();
        let after = self.steps.view(after, queue)?;
        let turns = self.turns.view(part, queue)?;
        let numbers = self.numbers.binding()?;
        let layout = cache.get_bind_group_layout(&stages.played_layout);
        let entries = BindGroupEntries::sequential((numbers, ground, &before, after, turns));
        let flood = device.create_bind_group("water_flood", &layout, &entries);
        let layout = cache.get_bind_group_layout(&stages.pictures);
        let entries = BindGroupEntries::sequential((&pictures[0], &pictures[1]));
        Some([flood, device.create_bind_group("water_flood_pictures", &layout, &entries)])
    }
}

/// Draws what is planned.
pub(in super::super) fn run_played(
    mut context: RenderContext,
    stages: Res<Stages>,
    cache: Res<PipelineCache>,
    waters: Query<&Played>,
) {
    let mut planned = waters.iter().filter_map(|played| Some((played.size, played.groups.as_ref()?))).peekable();
    let Some(pipeline) = cache.get_compute_pipeline(stages.show_played).filter(|_| planned.peek().is_some()) else {
        return;
    };
    let descriptor = ComputePassDescriptor { label: Some("water_flood"), ..default() };
    let mut pass = context.command_encoder().begin_compute_pass(&descriptor);
    pass.set_pipeline(pipeline);
    for (size, groups) in planned {
        pass.set_bind_group(0, &groups[0], &[]);
        pass.set_bind_group(1, &groups[1], &[]);
        pass.dispatch_workgroups(size.x.div_ceil(8), size.y.div_ceil(8), 1);
    }
}
