//! The water's force over a time step.
use super::{Load, Motion, Spatial, Wrench};
use glam::{Mat3, Vec3};

/// What the solver knows of a body, in world axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// 1/kg along each axis, zero along locked ones.
    pub inverse_mass: Vec3,
    /// 1/(kg·m²), zero about locked axes.
    pub inverse_inertia: Mat3,
}

impl Load {
    /// The constant force and torque that stand for the water during the next `dt` seconds, more than 0.
    ///
    /// Resistance acts at the velocity that the body will have at the end of the step (linearly implicit Euler), so that it can slow a
    /// body down but never turn it around, however light the body and however long the step. Added mass A makes the body as heavy as it
    /// is in water, and that part of it which is new is at rest in the stream: it takes its momentum from the body, never more than
    /// there is.
    ///
    /// With M the mass, E the resistance, K the stiffness, V and U the motions of body and water, P all other forces, and V + δ the
    /// motion at the end of the step:
    ///
    /// (M + A + dt E + θ dt² K) δ = dt (pressure + stream + P − E V − θ dt K (V − U)) + εA (U − V),
    ///
    /// and the answer is what gives M that δ. The share θ of the stiffness that is taken at the end of the step is none for bodies that
    /// bob slowly, for which the solver's own step conserves energy, and nearly all for those that would bob within a few steps.
    ///
    /// `others` is gravity and whatever else acts on the body: without it a falling body would meet the drag of a floating one, and one
    /// that a rope holds would pull it as if it were let go. At rest in balance the answer is the pressure itself, without an error that depends on `dt`.
    pub fn over_step(&self, motion: &Motion, body: &Inertia, others: Wrench, dt: f32) -> Wrench {
        let water = Motion { linear: self.water_velocity, angular: Vec3::ZERO };
        let relative = Motion { linear: motion.linear - water.linear, angular: motion.angular };
        let end_share = self.end_share(body, dt);
        let spring = self.stiffness * (end_share * dt);
        let constant = self.pressure + self.stream;
        let resisted = self.resistance.times(motion) + spring.times(&relative);
        let entering = (self.added_mass * self.entering).times(&relative);
        let impulse = (constant + others - resisted) * dt - entering;
        let change = solve(body, &(self.added_mass + (self.resistance + spring) * dt), impulse);
        let later = Motion { linear: motion.linear + change.linear, angular: motion.angular + change.angular };
        let moved = Motion { linear: later.linear - water.linear, angular: later.angular };
        let carried = self.added_mass.times(&change) + entering;
        constant - self.resistance.times(&later) - spring.times(&moved) - carried * dt.recip()
    }

    /// θ = s²/(1 + s²) with s = ω dt, ω² being the greater of K/(m + a) in heave and a bound of it in roll and pitch: the sum of the
    /// eigenvalues of (I + a′)⁻¹ K.
    fn end_share(&self, body: &Inertia, dt: f32) -> f32 {
        // K/(m + a) = K m⁻¹/(1 + a m⁻¹) holds for a locked axis too.
        let by_mass = body.inverse_mass.y;
        let heave = self.stiffness.linear.y_axis.y * by_mass / (1.0 + self.added_mass.linear.y_axis.y * by_mass);
        let trace = |matrix: Mat3| matrix.x_axis.x + matrix.y_axis.y + matrix.z_axis.z;
        let turned = body.inverse_inertia * self.stiffness.angular;
        let roll = trace(turned) / (1.0 + trace(body.inverse_inertia * self.added_mass.angular) / 3.0);
        let s = dt * dt * heave.max(roll);
        if s > 0.0 { s / (1.0 + s) } else { 0.0 }
    }
}

/// δ with (M + Q) δ = `impulse`: (1 + M⁻¹ Q) δ = M⁻¹ impulse, by its Schur complement.
fn solve(body: &Inertia, q: &Spatial, impulse: Wrench) -> Motion {
    let by_mass = Mat3::from_diagonal(body.inverse_mass);
    let by_inertia = body.inverse_inertia;
    let (linear, angular) = (by_mass * impulse.force, by_inertia * impulse.torque);
    let ll_inverse = (Mat3::IDENTITY + by_mass * q.linear).inverse();
    let la = by_mass * q.coupling.transpose();
    let al = by_inertia * q.coupling;
    let aa = Mat3::IDENTITY + by_inertia * q.angular;
    let schur = aa - al * ll_inverse * la;
    let angular = schur.inverse() * (angular - al * (ll_inverse * linear));
    Motion { linear: ll_inverse * (linear - la * angular), angular }
}
