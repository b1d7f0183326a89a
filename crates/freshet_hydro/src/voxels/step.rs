//! The water's force over a time step.

use glam::{Mat3, Vec3};

use super::load::{Load, Motion, Wrench};

impl Load {
    /// The constant force and torque that stand for the water during the next `dt` seconds.
    ///
    /// Drag is evaluated at the velocity that the body will have at the end of the step (linearly implicit Euler),
    /// so that it can slow a body down but never turn it around, however light the body and however long the step.
    /// With M the mass matrix, E the resistance, U the water's and V the body's motion, P all other forces:
    ///
    /// V' = (M + dt E)⁻¹ (M V + dt (pressure + E U + P)), and the answer is pressure + E U − E V'.
    ///
    /// * `inverse_mass`, 1/kg, and `inverse_inertia`, 1/(kg·m²), are in world axes, zero along locked ones;
    /// * `others` is gravity and whatever else acts on the body, contacts excepted: without it a falling body
    ///   would meet the drag of a floating one.
    ///
    /// At rest in balance the answer is the pressure itself, without an error that depends on `dt`.
    pub fn over_step(
        &self,
        motion: &Motion,
        inverse_mass: Vec3,
        inverse_inertia: Mat3,
        others: Wrench,
        dt: f32,
    ) -> Wrench {
        let constant = self.pressure + self.stream;
        let total = constant + others;
        let linear = motion.linear + dt * inverse_mass * total.force;
        let angular = motion.angular + dt * (inverse_inertia * total.torque);

        // (1 + dt M⁻¹ E) V' = [linear, angular], solved by its Schur complement.
        let by_mass = Mat3::from_diagonal(dt * inverse_mass);
        let by_inertia = inverse_inertia * dt;
        let ll_inverse = (Mat3::IDENTITY + by_mass * self.resistance.linear).inverse();
        let la = by_mass * self.resistance.coupling.transpose();
        let al = by_inertia * self.resistance.coupling;
        let aa = Mat3::IDENTITY + by_inertia * self.resistance.angular;
        let schur = aa - al * ll_inverse * la;
        let angular = schur.inverse() * (angular - al * (ll_inverse * linear));
        let linear = ll_inverse * (linear - la * angular);

        constant + self.resistance.apply(&Motion { linear, angular })
    }
}
