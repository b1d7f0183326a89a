//! Which stages run in a frame.
use super::{
    frame::{GpuWork, ShallowFrame, ShallowWork},
    pictures::level_of,
    returned,
    stages::{COLUMNS, GROUP, ROWS, Stages},
    state::ShallowState,
};
use bevy::{
    prelude::*,
    render::{
        diagnostic::RecordDiagnostics,
        render_asset::RenderAssets,
        render_resource::{
            BindGroup, BindGroupEntries, CachedComputePipelineId, ComputePass, ComputePassDescriptor, PipelineCache,
        },
        renderer::{RenderContext, RenderDevice, RenderQueue},
        texture::GpuImage,
    },
};

/// What runs in this frame, for all waters.
#[derive(Resource, Default)]
pub(super) struct Plans(Vec<Plan>);

/// The steps of one water.
struct Plan {
    entity: Entity,
    /// Of even and odd steps.
    groups: [BindGroup; 2],
    pictures: BindGroup,
    /// Of even and odd steps, if bodies push.
    pushes: Option<[BindGroup; 2]>,
    /// How many cells they push.
    pushed: u32,
    /// Cells of the bed that bodies enter and leave, and how many there are.
    raise: Option<(BindGroup, u32)>,
    /// Whether there are point sources, and walls.
    variant: [bool; 2],
    steps: u32,
    edges: u32,
    cells: UVec2,
    texels: UVec2,
}

/// Plans the steps of every water.
pub(super) fn plan_steps(
    mut commands: Commands,
    mut plans: ResMut<Plans>,
    stages: Res<Stages>,
    cache: Res<PipelineCache>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    images: Res<RenderAssets<GpuImage>>,
    mut waters: Query<(Entity, &ShallowFrame, Option<&mut ShallowState>)>,
    orphans: Query<Entity, (With<ShallowState>, Without<ShallowFrame>)>,
) {
    plans.0.clear();
    for entity in &orphans {
        commands.entity(entity).remove::<ShallowState>();
    }
    let is_ready = stages.are_ready(&cache);
    for (entity, frame, state) in &mut waters {
        let ShallowWork::Gpu(work) = &frame.work else {
            if state.is_some() {
                commands.entity(entity).remove::<ShallowState>();
            }
            continue;
        };
        let [Some(level), Some(slopes)] = frame.pictures.map(|picture| images.get(picture)) else { continue };
        if work.steps == 0 || !is_ready {
            continue;
        }
        let newer = |state: &ShallowState| work.start.as_ref().is_some_and(|start| start.version != state.start);
        let mut fresh = None;
        let state = match (state, &work.start, &work.ground) {
            (Some(state), ..) if !newer(&state) => state.into_inner(),
            (_, Some(start), Some(ground)) => fresh.insert(ShallowState::new(&device, work, start, ground)),
            _ => continue,
        };
        if let Some(ground) = work.ground.as_ref().filter(|ground| ground.version != state.ground) {
            state.set_ground(&device, ground, work.has_sources);
        }
        state.upload(work, &device, &queue);
        let surroundings = Surroundings { stages: &stages, cache: &cache, device: &device };
        plans.0.extend(surroundings.plan(entity, work, state, [level, slopes]));
        if let Some(state) = fresh {
            commands.entity(entity).insert(state);
        }
    }
}

/// What planning needs to know.
struct Surroundings<'a> {
    stages: &'a Stages,
    cache: &'a PipelineCache,
    device: &'a RenderDevice,
}

impl Surroundings<'_> {
    fn plan(&self, entity: Entity, work: &GpuWork, state: &ShallowState, pictures: [&GpuImage; 2]) -> Option<Plan> {
        let layout = self.cache.get_bind_group_layout(&self.stages.layout);
        let numbers = state.numbers.binding()?;
        let edges = state.edges.binding()?;
        let group = |parity: usize| {
            let [from, to] =
                [&state.states[parity], &state.states[1 - parity]].map(|buffer| buffer.as_entire_binding());
            let parity = state.parities[parity].binding()?;
            let entries = BindGroupEntries::sequential((
                numbers.clone(),
                parity,
                state.clock.as_entire_binding(),
                from,
                to,
                state.bed.as_entire_binding(),
                edges.clone(),
                state.leaving.as_entire_binding(),
                state.extras.as_entire_binding(),
                state.given.as_entire_binding(),
            ));
            Some(self.device.create_bind_group("water_shallow", &layout, &entries))
        };
        let views = pictures.map(|picture| level_of(picture, 0));
        let pictures = self.device.create_bind_group(
            "water_shallow_pictures",
            &self.cache.get_bind_group_layout(&self.stages.pictures),
            &BindGroupEntries::sequential((&views[0], &views[1])),
        );
        let size = work.numbers.size.as_uvec2();
        Some(Plan {
            entity,
            groups: [group(0)?, group(1)?],
            pictures,
            pushes: if work.pushes.is_empty() { None } else { Some([self.push(state, 0)?, self.push(state, 1)?]) },
            pushed: work.pushes.len() as u32,
            raise: self.raise(state),
            variant: [work.has_sources, work.has_walls],
            steps: work.steps.next_multiple_of(2),
            edges: 2 * (size.x + size.y),
            cells: uvec2(size.x.div_ceil(GROUP.x * COLUMNS), size.y.div_ceil(GROUP.y * ROWS)),
            texels: uvec2(size.x.div_ceil(8), size.y.div_ceil(8)),
        })
    }

    /// What the pushes of a step bind: they change what the step has written.
    fn push(&self, state: &ShallowState, parity: usize) -> Option<BindGroup> {
        let layout = self.cache.get_bind_group_layout(&self.stages.push_layout);
        let entries = BindGroupEntries::sequential((
            state.parities[parity].binding()?,
            state.clock.as_entire_binding(),
            state.states[1 - parity].as_entire_binding(),
            state.pushes.binding()?,
        ));
        Some(self.device.create_bind_group("water_shallow_push", &layout, &entries))
    }

    /// What changes the bed, if there is anything to change.
    fn raise(&self, state: &ShallowState) -> Option<(BindGroup, u32)> {
        let count = state.raising.get().len() as u32;
        let layout = self.cache.get_bind_group_layout(&self.stages.raise_layout);
        let raising = state.raising.binding().filter(|_| count > 0)?;
        let entries = BindGroupEntries::sequential((state.bed.as_entire_binding(), raising));
        Some((self.device.create_bind_group("water_shallow_raise", &layout, &entries), count))
    }
}

/// Runs what is planned, and copies what it comes to.
pub(super) fn run_steps(
    mut context: RenderContext,
    plans: Res<Plans>,
    stages: Res<Stages>,
    cache: Res<PipelineCache>,
    device: Res<RenderDevice>,
    mut states: Query<&mut ShallowState>,
) {
    if plans.0.is_empty() {
        return;
    }
    let diagnostics = context.diagnostic_recorder();
    let diagnostics = diagnostics.as_deref();
    let span = diagnostics.time_span(context.command_encoder(), "water_shallow");
    {
        let descriptor = ComputePassDescriptor { label: Some("water_shallow"), ..default() };
        let mut pass = context.command_encoder().begin_compute_pass(&descriptor);
        for plan in &plans.0 {
            run(plan, &stages, &cache, &mut pass);
        }
    }
    for plan in &plans.0 {
        if let Ok(mut state) = states.get_mut(plan.entity) {
            returned::copy(&mut state, &device, context.command_encoder());
        }
    }
    span.end(context.command_encoder());
}

fn run(plan: &Plan, stages: &Stages, cache: &PipelineCache, pass: &mut ComputePass) {
    let mut dispatch = |stage: CachedComputePipelineId, group: &BindGroup, workgroups: UVec2| {
        let Some(pipeline) = cache.get_compute_pipeline(stage) else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.set_bind_group(1, &plan.pictures, &[]);
        pass.dispatch_workgroups(workgroups.x, workgroups.y, 1);
    };
    let workgroups = |count: u32| uvec2(count.div_ceil(64), 1);
    if let Some((group, count)) = &plan.raise {
        dispatch(stages.raise, group, workgroups(*count));
    }
    dispatch(stages.begin, &plan.groups[0], UVec2::ONE);
    let [sources, walls] = plan.variant.map(usize::from);
    let stage = &stages.steps[sources][walls];
    for step in 0..plan.steps {
        let group = &plan.groups[step as usize % 2];
        dispatch(stage.step, group, plan.cells);
        dispatch(stage.border, group, workgroups(plan.edges));
        if let Some(pushes) = &plan.pushes {
            dispatch(stages.push, &pushes[step as usize % 2], workgroups(plan.pushed));
        }
    }
    dispatch(stages.show[walls], &plan.groups[0], plan.texels);
}
