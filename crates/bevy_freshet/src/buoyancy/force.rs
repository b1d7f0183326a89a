//! The water's forces, lent to the solver for one step.

use super::{
    body::Body,
    contact::Felt,
    exchange::Exerted,
    floating::{Buoyancy, Floating},
    held::{Step, inertia},
};
use bevy::prelude::*;
use bevy_rapier3d::{
    plugin::{
        RapierConfiguration, TimestepMode,
        context::{RapierContextEntityLink, RapierRigidBodySet},
    },
    prelude::RapierRigidBodyHandle,
    rapier::prelude::RigidBody,
};
use freshet_hydro::load::{BodyState, Fluid, Load, Motion, Pose, Wrench};

/// Share of √(g L), L being the length of a body, above which its speed keeps it from sleep in the water: it lies within 10⁻³ L of its
/// place then. Rapier's own threshold of 0.05 m/s would freeze what drifts in a slow current, or still bobs by a centimetre.
const RESTING_SPEED: f32 = 1e-3;

/// The same for the speed at which its ends turn, if the water rights it, or if it is ten times as fast: a ball may spin slowly for long,
/// as only its skin resists that.
const RESTING_TURN: f32 = 5e-3;

/// Torque of the water, as a share of weight times length, from which on it rights a body.
const RIGHTING: f32 = 1e-4;

/// Change of the water's force, as a share of the body's weight, that wakes it: 2 mm of level under a crate of 20 cm.
const WAKING_SHARE: f32 = 0.01;

/// Change of the water's velocity, m/s, that wakes a body.
const WAKING_VELOCITY: f32 = 0.02;

/// The game's own force and torque in the solver, to be restored after the step, and what the step was.
pub(super) struct Lent {
    force: Vec3,
    torque: Vec3,
    step: Step,
}

/// What the water did to a body when it was last awake.
#[derive(Default)]
pub(super) struct Rest {
    force: Vec3,
    water_velocity: Vec3,
}

impl Rest {
    fn of(load: &Load) -> Self {
        Self { force: load.pressure.force, water_velocity: load.water_velocity }
    }

    /// Whether `now` would move a sleeping body of `weight` (N).
    fn is_disturbed(&self, now: &Self, weight: f32) -> bool {
        self.force.distance(now.force) > WAKING_SHARE * weight
            || self.water_velocity.distance(now.water_velocity) > WAKING_VELOCITY
    }
}

/// Length of the solver's step, s.
fn step_length(mode: &TimestepMode, time: &Time) -> f32 {
    match *mode {
        TimestepMode::Fixed { dt, .. } => dt,
        TimestepMode::Variable { max_dt, time_scale, .. } => (time.delta_secs() * time_scale).min(max_dt),
        TimestepMode::Interpolated { dt, time_scale, .. } => dt * time_scale,
    }
}

fn motion(body: &RigidBody) -> Motion {
    Motion { linear: body.linvel(), angular: body.angvel() }
}

/// What the water does to a body where the solver has `body`.
fn load(state: &mut Body, body: &RigidBody, gravity: Vec3) -> Load {
    let Body { form: Some(form), footprint, drag, submerged, .. } = state else { return Load::default() };
    let before = submerged.replace(0.0);
    if footprint.lattice.is_dry() {
        return Load::default();
    }
    let fluid = Fluid { gravity: (-gravity.y).max(0.0), ..Fluid::default() };
    let at = BodyState {
        pose: Pose { position: body.translation(), rotation: *body.rotation() },
        centre: body.center_of_mass(),
        motion: motion(body),
    };
    let mut load = form.load(&at, &fluid, drag, footprint);
    let share = load.submerged_volume / form.hull.volume();
    *submerged = Some(share);
    load.entering = before.filter(|before| share > *before).map_or(0.0, |before| 1.0 - before / share);
    load
}

/// Gravity and the game's own push.
fn own_push(body: &RigidBody, gravity: Vec3) -> Wrench {
    Wrench { force: gravity * (body.gravity_scale() * body.mass()) + body.user_force(), torque: body.user_torque() }
}

/// The force for the coming step: [`Load::over_step`] with what else acts on `body`.
fn force(load: &Load, body: &RigidBody, others: Wrench, dt: f32) -> Wrench {
    let wrench = load.over_step(&motion(body), &inertia(body), others, dt);
    if wrench.is_finite() { wrench } else { Wrench::ZERO }
}

/// Whether `body`, of this length (m), moves or turns too fast to go to sleep under this torque of the water (N·m).
fn is_moving(body: &RigidBody, length: f32, gravity: f32, torque: f32) -> bool {
    let speed = (gravity * length).sqrt();
    let turn = body.angvel().length() * length;
    let is_righted = torque > RIGHTING * body.mass() * gravity * length;
    body.linvel().length() > RESTING_SPEED * speed
        || turn > 10.0 * RESTING_TURN * speed
        || is_righted && turn > RESTING_TURN * speed
}

/// What the solver is to get for the coming step.
pub(super) struct Loan {
    /// Of the water.
    wrench: Wrench,
    /// Gravity and the game's own push.
    own: Wrench,
    /// Whether the body may not sleep.
    wakes: bool,
}

/// Computes the forces on all bodies, and which sleepers wake because their water has changed. Bodies do not know of each other here: the
/// order in which threads take them changes nothing.
pub(super) fn find_forces(
    mut floating: Query<(&RapierRigidBodyHandle, &RapierContextEntityLink, &mut Body, &mut Buoyancy), With<Floating>>,
    contexts: Query<(&RapierRigidBodySet, &RapierConfiguration)>,
    mode: Res<TimestepMode>,
    time: Res<Time>,
) {
    let dt = step_length(&mode, &time);
    floating.par_iter_mut().for_each(|(handle, link, mut state, mut buoyancy)| {
        let state = &mut *state;
        state.loan = None;
        let Ok((set, config)) = contexts.get(link.0) else { return };
        let Some(body) = set.bodies.get(handle.0) else { return };
        let steps = config.physics_pipeline_active && dt > 0.0;
        let has_mass = !body.is_dynamic() || body.mass() > 0.0;
        if !(steps && body.is_enabled() && state.form.is_some() && has_mass) {
            state.exchanging.felt = None;
            return;
        }
        let load = load(state, body, config.gravity);
        let rest = Rest::of(&load);
        let sleeps = body.is_dynamic() && body.is_sleeping();
        if sleeps && !state.rest.is_disturbed(&rest, body.mass() * config.gravity.length()) {
            return;
        }
        state.rest = rest;
        let own = own_push(body, config.gravity);
        let wrench = force(&load, body, own + state.held.0, dt);
        let pressure = load.pressure.force;
        state.exchanging.felt = Some(Exerted { pressure, resistance: wrench.force - pressure });
        buoyancy.set_if_neq(told(state, body, &load, &wrench, buoyancy.volume));
        let wakes = body.is_sleeping()
            || (load.submerged_volume > 0.0
                && is_moving(body, state.length(), config.gravity.length(), wrench.torque.length()));
        state.felt =
            Some(Felt { load, center: body.center_of_mass(), motion: motion(body), mass: body.mass(), step: dt });
        state.loan = body.is_dynamic().then_some(Loan { wrench, own, wakes });
    });
}

/// What a game is told of the water's force on `body`.
fn told(state: &Body, body: &RigidBody, load: &Load, wrench: &Wrench, volume: f32) -> Buoyancy {
    let height = state.footprint.lattice.at(body.center_of_mass().xz()).map(|water| water.height);
    Buoyancy {
        volume,
        submerged_volume: load.submerged_volume,
        draft: height.map_or(0.0, |height| (height - state.footprint.lowest).max(0.0)),
        force: wrench.force,
        torque: wrench.torque,
        water_velocity: load.water_velocity,
    }
}

/// Lends the forces to the solver.
pub(super) fn lend_forces(
    mut floating: Query<(&RapierRigidBodyHandle, &RapierContextEntityLink, &mut Body), With<Floating>>,
    mut contexts: Query<&mut RapierRigidBodySet>,
    mode: Res<TimestepMode>,
    time: Res<Time>,
) {
    let dt = step_length(&mode, &time);
    for (handle, link, mut state) in &mut floating {
        let Some(Loan { wrench, own, wakes }) = state.loan.take() else { continue };
        if !wakes && wrench == Wrench::ZERO {
            state.held.forget();
            continue;
        }
        let Ok(mut set) = contexts.get_mut(link.0) else { continue };
        let Some(body) = set.bodies.get_mut(handle.0) else { continue };
        if wakes {
            body.wake_up(true);
        }
        let step = Step { motion: motion(body), pushed: own + wrench, length: dt };
        state.lent = Some(Lent { force: body.user_force(), torque: body.user_torque(), step });
        body.add_force(wrench.force, false);
        body.add_torque(wrench.torque, false);
    }
}

/// Restores each body's own forces in the solver after the step, and learns what else held it.
pub(super) fn take_forces_back(
    mut floating: Query<(&RapierRigidBodyHandle, &RapierContextEntityLink, &mut Body)>,
    mut contexts: Query<&mut RapierRigidBodySet>,
) {
    for (handle, link, mut state) in &mut floating {
        let Some(lent) = state.lent.take() else { continue };
        let Ok(mut set) = contexts.get_mut(link.0) else { continue };
        let Some(body) = set.bodies.get_mut(handle.0) else { continue };
        state.held.learn(&lent.step, body);
        body.reset_forces(false);
        body.reset_torques(false);
        body.add_force(lent.force, false);
        body.add_torque(lent.torque, false);
    }
}
