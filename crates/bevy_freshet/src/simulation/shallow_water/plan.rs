//! Which stages run in a frame.
use super::{
    frame::ShallowFrame,
    returned,
    stages::{COLUMNS, GROUP, ROWS, Stages},
    state::ShallowState,
};
use bevy::{
    prelude::*,
    render::{
        diagnostic::RecordDiagnostics,
        render_resource::{
            BindGroup, BindGroupEntries, CachedComputePipelineId, ComputePass, ComputePassDescriptor, PipelineCache,
        },
        renderer::{RenderContext, RenderDevice, RenderQueue},
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
    /// Whether there are point sources, and walls.
    variant: [bool; 2],
    steps: u32,
    edges: u32,
    cells: UVec2,
}

/// Plans the steps of every water.
pub(super) fn plan_steps(
    mut commands: Commands,
    mut plans: ResMut<Plans>,
    stages: Res<Stages>,
    cache: Res<PipelineCache>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut waters: Query<(Entity, &ShallowFrame, Option<&mut ShallowState>)>,
    orphans: Query<Entity, (With<ShallowState>, Without<ShallowFrame>)>,
) {
    plans.0.clear();
    for entity in &orphans {
        commands.entity(entity).remove::<ShallowState>();
    }
    if !stages.are_ready(&cache) {
        return;
    }
    for (entity, frame, state) in &mut waters {
        let newer = |state: &ShallowState| frame.start.as_ref().is_some_and(|start| start.version != state.start);
        let mut fresh = None;
        let state = match (state, &frame.start, &frame.ground) {
            (Some(state), ..) if !newer(&state) => state.into_inner(),
            (_, Some(start), Some(ground)) => fresh.insert(ShallowState::new(&device, frame, start, ground)),
            _ => continue,
        };
        if let Some(ground) = frame.ground.as_ref().filter(|ground| ground.version != state.ground) {
            state.set_ground(&device, ground);
        }
        state.upload(frame, &device, &queue);
        if let Some(plan) = plan(entity, frame, state, &stages, &cache, &device) {
            plans.0.push(plan);
        }
        if let Some(state) = fresh {
            commands.entity(entity).insert(state);
        }
    }
}

fn plan(
    entity: Entity,
    frame: &ShallowFrame,
    state: &ShallowState,
    stages: &Stages,
    cache: &PipelineCache,
    device: &RenderDevice,
) -> Option<Plan> {
    let layout = cache.get_bind_group_layout(&stages.layout);
    let numbers = state.numbers.binding()?;
    let edges = state.edges.binding()?;
    let group = |parity: usize| {
        let [from, to] = [&state.states[parity], &state.states[1 - parity]].map(|buffer| buffer.as_entire_binding());
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
        Some(device.create_bind_group("water_shallow", &layout, &entries))
    };
    let size = frame.numbers.size.as_uvec2();
    Some(Plan {
        entity,
        groups: [group(0)?, group(1)?],
        variant: [frame.has_sources, frame.has_walls],
        steps: frame.steps.next_multiple_of(2),
        edges: (2 * (size.x + size.y)).div_ceil(64),
        cells: uvec2(size.x.div_ceil(GROUP * COLUMNS), size.y.div_ceil(ROWS)),
    })
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
        pass.dispatch_workgroups(workgroups.x, workgroups.y, 1);
    };
    dispatch(stages.begin, &plan.groups[0], UVec2::ONE);
    let [sources, walls] = plan.variant.map(usize::from);
    let stage = &stages.steps[sources][walls];
    for step in 0..plan.steps {
        let group = &plan.groups[step as usize % 2];
        dispatch(stage.step, group, plan.cells);
        dispatch(stage.border, group, uvec2(plan.edges, 1));
    }
}
