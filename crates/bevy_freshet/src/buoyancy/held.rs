//! What holds a body beside the water: joints and contacts, which the solver finds in the step itself.
//!
//! Water that moves with a body leaves it less of a push that accelerates it, and all of one that does not: a buoy on its mooring pulls with all
//! of its drag. How much it will accelerate cannot be known before the solver has found the forces of joints and contacts, so the mean of the
//! last steps is taken. For a body that is held fast the error of that shrinks by a share of m/(m + a)/2 from step to step, a being its added mass; and
//! one that strikes the ground hands it the momentum of its added mass as well, some steps later.

use bevy::prelude::*;
use bevy_rapier3d::rapier::prelude::RigidBody;
use freshet_hydro::load::{Inertia, Motion, Wrench};

/// A step of a body, to be compared with what came of it.
pub(super) struct Step {
    /// How the body moved before.
    pub motion: Motion,
    /// All that pushed it, but for joints and contacts.
    pub pushed: Wrench,
    /// Length of the step, s.
    pub length: f32,
}

/// Share of the last step in the mean: ropes that go slack and taut pull in every other one.
const NEWEST: f32 = 0.5;

/// What joints and contacts did in the last steps, as a mean that forgets.
#[derive(Default)]
pub(super) struct Held(pub Wrench);

impl Held {
    /// Learns from how `body` moves after `step`.
    pub fn learn(&mut self, step: &Step, body: &RigidBody) {
        let inertia = inertia(body);
        let free = Vec3::select(inertia.inverse_mass.cmpgt(Vec3::ZERO), Vec3::ONE, Vec3::ZERO);
        let needed = (body.linvel() - step.motion.linear) * (body.mass() / step.length);
        // Where an axis is locked nothing is known of the torques.
        // In double precision, as the determinant of an inertia goes with the fifteenth power of the length.
        let inverse_inertia = inertia.inverse_inertia.as_dmat3();
        let turns = inverse_inertia.determinant() > 0.0;
        let acceleration = (body.angvel() - step.motion.angular) / step.length;
        let turned = || (inverse_inertia.inverse() * acceleration.as_dvec3()).as_vec3();
        let held = Wrench {
            force: (needed - step.pushed.force) * free,
            torque: if turns { turned() - step.pushed.torque } else { Vec3::ZERO },
        };
        self.0 = if held.is_finite() { self.0 * (1.0 - NEWEST) + held * NEWEST } else { Wrench::ZERO };
    }

    pub fn forget(&mut self) {
        *self = Self::default();
    }
}

/// What the solver knows of `body`.
pub(super) fn inertia(body: &RigidBody) -> Inertia {
    let mass = body.mass_properties();
    let inertia = mass.effective_world_inv_inertia;
    Inertia {
        inverse_mass: mass.effective_inv_mass,
        inverse_inertia: Mat3::from_cols(
            Vec3::new(inertia.m11, inertia.m12, inertia.m13),
            Vec3::new(inertia.m12, inertia.m22, inertia.m23),
            Vec3::new(inertia.m13, inertia.m23, inertia.m33),
        ),
    }
}
