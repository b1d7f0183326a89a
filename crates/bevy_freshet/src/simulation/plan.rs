//! Which stages run in a frame, in which order, on which buffers.
use super::{
    frame::{FieldFrame, FieldWork},
    stages::{Stage, Stages},
    state::FieldState,
    tiles::TILE,
};
use bevy::{
    prelude::*,
    render::{
        diagnostic::RecordDiagnostics,
        render_asset::RenderAssets,
        render_resource::{
            BindGroup, BindGroupEntries, BindGroupEntry, BindingResource, Buffer, CachedComputePipelineId,
            ComputePassDescriptor, IntoBinding, PipelineCache,
        },
        renderer::{RenderContext, RenderDevice, RenderQueue},
        texture::{FallbackImage, GpuImage},
    },
};
use std::sync::atomic::Ordering;

/// What runs in this frame, for all waters.
#[derive(Resource, Default)]
pub(super) struct FieldPlans {
    /// Buffers that are set to zero first.
    cleared: Vec<Buffer>,
    runs: Vec<Run>,
}

/// One run of a stage.
struct Run {
    pipeline: CachedComputePipelineId,
    groups: Vec<BindGroup>,
    workgroups: UVec2,
}

/// Plans the stages of every water that has something to do.
pub(super) fn plan_fields(
    mut commands: Commands,
    mut plans: ResMut<FieldPlans>,
    stages: Res<Stages>,
    cache: Res<PipelineCache>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    images: Res<RenderAssets<GpuImage>>,
    fallback: Res<FallbackImage>,
    mut waters: Query<(Entity, &FieldFrame, Option<&mut FieldState>)>,
) {
    *plans = FieldPlans::default();
    if waters.is_empty() || !stages.are_ready(&cache) {
        return;
    }
    for (entity, frame, state) in &mut waters {
        let FieldFrame::Work(work) = frame else {
            commands.entity(entity).remove::<FieldState>();
            continue;
        };
        let Some(images) = Images::of(work, &images, &fallback) else { continue };
        let mut fresh = None;
        let state = match state {
            Some(state) if state.fits(work) => state.into_inner(),
            _ => fresh.insert(FieldState::new(&device, work)),
        };
        let surroundings = Surroundings { stages: &stages, cache: &cache, device: &device, images };
        state.upload(work, &device, &queue);
        surroundings.plan(work, state, &mut plans);
        work.drawn.store(work.generation, Ordering::Relaxed);
        if let Some(state) = fresh {
            commands.entity(entity).insert(state);
        }
    }
}

/// The textures of a water.
struct Images<'a> {
    bed: &'a GpuImage,
    flow: &'a GpuImage,
    ice_order: &'a GpuImage,
    simulated: [&'a GpuImage; 2],
    pictures: [&'a GpuImage; 2],
}

impl<'a> Images<'a> {
    /// Nothing while one of them is on its way to the GPU.
    fn of(work: &FieldWork, images: &'a RenderAssets<GpuImage>, fallback: &'a FallbackImage) -> Option<Self> {
        let or_fallback = |id: Option<AssetId<Image>>| id.map_or(Some(&fallback.d2), |id| images.get(id));
        let [rings, matter] = work.pictures;
        Some(Self {
            bed: or_fallback(work.bed)?,
            flow: or_fallback(work.flow)?,
            ice_order: or_fallback(work.ice_order)?,
            simulated: [or_fallback(work.simulated[0])?, or_fallback(work.simulated[1])?],
            pictures: [images.get(rings)?, images.get(matter)?],
        })
    }
}

/// What planning needs to know.
struct Surroundings<'a> {
    stages: &'a Stages,
    cache: &'a PipelineCache,
    device: &'a RenderDevice,
    images: Images<'a>,
}

impl Surroundings<'_> {
    /// Appends the stages of one water, and says in `state` what its buffers will hold after them.
    fn plan(&self, work: &FieldWork, state: &mut FieldState, plans: &mut FieldPlans) {
        let (stages, runs) = (self.stages, &mut plans.runs);
        let all = workgroups(work.window.size);
        let (silhouettes, tiles) = (work.deposits.silhouettes.len(), work.deposits.tiles.len());
        if state.version != work.ground {
            runs.push(self.run_on_water(&stages.ground, state, &[&state.ground, &state.celerity], all));
        }
        if state.covered {
            plans.cleared.push(state.bodies.clone());
            state.covered = false;
        }
        if silhouettes > 0 {
            let groups = uvec2((silhouettes as u32).div_ceil(64), 1);
            let bound = vec![(&state.silhouettes).into_binding(), state.bodies.as_entire_binding()];
            runs.push(self.run_bound(&stages.bodies, state, bound, groups));
            state.covered = true;
        }
        runs.push(self.run_on_water(&stages.stream, state, &[&state.ground, &state.bodies, &state.stream], all));
        if state.shift(work) != IVec2::ZERO {
            let [[waves, waves_out], [matter, matter_out]] = [&state.waves, &state.matter];
            runs.push(self.run(&stages.shift, state, &[&state.stream, waves, waves_out, matter, matter_out], all));
            state.waves.swap(0, 1);
            state.matter.swap(0, 1);
        }
        if tiles > 0 {
            let mut bound = vec![(&state.tiles).into_binding(), (&state.strokes).into_binding()];
            let fields = [&state.celerity, &state.bodies, &state.waves[0], &state.matter[0]];
            bound.extend(fields.map(|buffer| buffer.as_entire_binding()));
            runs.push(self.run_bound(&stages.deposit, state, bound, uvec2(tiles as u32, 1)));
        }
        self.plan_steps(work, state, runs);
        runs.push(self.compose(state, all));
        (state.window, state.version, state.filled) = (work.window, work.ground, true);
    }

    fn plan_steps(&self, work: &FieldWork, state: &mut FieldState, runs: &mut Vec<Run>) {
        let (stages, all) = (self.stages, workgroups(work.window.size));
        for _ in 0..work.ring_steps {
            for carry in [&stages.carry_x, &stages.carry_z].into_iter().filter(|_| work.drifts) {
                let [from, to] = &state.waves;
                runs.push(self.run(carry, state, &[&state.ground, &state.celerity, from, to], all));
                state.waves.swap(0, 1);
            }
            let [from, to] = &state.waves;
            runs.push(self.run(&stages.rings, state, &[&state.celerity, from, to], all));
            state.waves.swap(0, 1);
        }
        for _ in 0..work.transport_steps {
            let [from, to] = &state.matter;
            let transport = &stages.transport[usize::from(work.is_dyed)];
            runs.push(self.run(transport, state, &[&state.stream, from, to], all));
            state.matter.swap(0, 1);
        }
    }

    fn compose(&self, state: &FieldState, workgroups: UVec2) -> Run {
        let mut bound: Vec<BindingResource> = [&state.ground, &state.bodies, &state.waves[0], &state.matter[0]]
            .map(|buffer| buffer.as_entire_binding())
            .into();
        bound.extend(self.images.pictures.map(|picture| picture.texture_view.into_binding()));
        self.run_bound(&self.stages.compose, state, bound, workgroups)
    }

    /// A run of a stage that binds `buffers` after the numbers.
    fn run(&self, stage: &Stage, state: &FieldState, buffers: &[&Buffer], workgroups: UVec2) -> Run {
        let bound = buffers.iter().map(|buffer| buffer.as_entire_binding()).collect();
        self.run_bound(stage, state, bound, workgroups)
    }

    /// A run of a stage with what it binds after the numbers.
    fn run_bound(&self, stage: &Stage, state: &FieldState, bound: Vec<BindingResource>, workgroups: UVec2) -> Run {
        let numbers = (&state.numbers).into_binding();
        let entry = |(binding, resource)| BindGroupEntry { binding: binding as u32, resource };
        let entries: Vec<_> = core::iter::once(numbers).chain(bound).enumerate().map(entry).collect();
        let layout = self.cache.get_bind_group_layout(&stage.layout);
        let group = self.device.create_bind_group(&*stage.layout.label, &layout, &entries);
        Run { pipeline: stage.pipeline, groups: vec![group], workgroups }
    }

    /// A run of a stage that also reads the water's surface, bed and current.
    fn run_on_water(&self, stage: &Stage, state: &FieldState, buffers: &[&Buffer], workgroups: UVec2) -> Run {
        let mut run = self.run(stage, state, buffers, workgroups);
        let layout = self.cache.get_bind_group_layout(&self.stages.water);
        let Images { bed, flow, ice_order, simulated: [level, slopes], .. } = &self.images;
        let [bed, flow, ice_order, level, slopes] =
            [bed, flow, ice_order, level, slopes].map(|image| &image.texture_view);
        let entries = BindGroupEntries::with_indices((
            (0, &state.surface),
            (8, bed),
            (9, flow),
            (14, ice_order),
            (16, level),
            (17, slopes),
        ));
        run.groups.push(self.device.create_bind_group("water_below", &layout, &entries));
        run
    }
}

/// Workgroups that cover all cells.
fn workgroups(size: UVec2) -> UVec2 {
    uvec2(size.x.div_ceil(TILE), size.y.div_ceil(TILE))
}

/// Runs what is planned.
pub(super) fn run_stages(mut context: RenderContext, plans: Res<FieldPlans>, cache: Res<PipelineCache>) {
    if plans.runs.is_empty() {
        return;
    }
    let diagnostics = context.diagnostic_recorder();
    let diagnostics = diagnostics.as_deref();
    let span = diagnostics.time_span(context.command_encoder(), "water_fields");
    for buffer in &plans.cleared {
        context.command_encoder().clear_buffer(buffer, 0, None);
    }
    {
        let descriptor = ComputePassDescriptor { label: Some("water_fields"), ..default() };
        let mut pass = context.command_encoder().begin_compute_pass(&descriptor);
        for run in &plans.runs {
            let Some(pipeline) = cache.get_compute_pipeline(run.pipeline) else { continue };
            pass.set_pipeline(pipeline);
            for (n, group) in run.groups.iter().enumerate() {
                pass.set_bind_group(n as u32, group, &[]);
            }
            pass.dispatch_workgroups(run.workgroups.x, run.workgroups.y, 1);
        }
    }
    span.end(context.command_encoder());
}
