//! Bodies that push the water.
use super::{
    FILM, ShallowWater, ShallowWaterError, number,
    scheme::{DEEPEST, FASTEST, max, per_depth, sane},
};
use crate::waves::GRAVITY;
use glam::{UVec2, Vec2};

/// What a body does to the water of one cell while it is in it: the quadratic drag between the two, and a given force.
///
/// ```text
/// ∂(h u)/∂t = s |v − u| (v − u) + f        s = ½ C D/L
/// ```
///
/// with the velocity v of the body, its drag coefficient C, its length L (m) and the depth D (m) of what it displaces, averaged over
/// the cell. Over all cells of a body of draft D that covers L² it sums to ½ ρ C (L D) |v − u| (v − u), whatever the size of a cell.
///
/// It moves no volume, and by the drag water is never faster than the body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Push {
    /// Column and row of the cell.
    pub cell: UVec2,
    /// ½ C D/L, from 0 to 10⁶.
    pub strength: f32,
    /// Velocity v of the body (x, z), m/s.
    pub velocity: Vec2,
    /// Force f on the water (x, z) per area and density, m²/s², below 10⁶.
    pub force: Vec2,
}

/// Strengths and forces from this on are taken for a mistake.
const STRONGEST: f32 = 1e6;

impl ShallowWater {
    /// Replaces what bodies do to the water in every step from now on. What is said of one cell is put together: strengths and forces
    /// add up, and velocities are averaged by strength.
    ///
    /// # Errors
    /// [`ShallowWaterError::Number`] if a cell is outside, a strength is negative or not below 10⁶, a force is not below that, or a velocity is not below 10 km/s.
    pub fn set_pushes(&mut self, pushes: &[Push]) -> Result<(), ShallowWaterError> {
        for push in pushes {
            if push.cell.cmpge(self.size()).any() {
                return Err(number("the cell of a push", "inside the domain", push.cell.max_element() as f32));
            }
            if !(0.0..STRONGEST).contains(&push.strength) {
                return Err(number("the strength of a push", "not negative and below 10⁶", push.strength));
            }
            if !(push.velocity.is_finite() && push.velocity.abs().max_element() < FASTEST) {
                return Err(number("the speed of a push", "finite and below 10 km/s", push.velocity.length()));
            }
            if !(push.force.is_finite() && push.force.abs().max_element() < STRONGEST) {
                return Err(number("the force of a push", "finite and below 10⁶", push.force.length()));
            }
        }
        self.pushes.clear();
        self.pushes.extend(pushes.iter().filter(|push| push.strength > 0.0 || push.force != Vec2::ZERO));
        self.pushes.sort_by_key(|push| (push.cell.y, push.cell.x));
        self.pushes.dedup_by(|next, kept| {
            let same = next.cell == kept.cell;
            if same {
                kept.strength += next.strength;
                kept.force += next.force;
                let share = if next.strength > 0.0 { next.strength / kept.strength } else { 0.0 };
                kept.velocity = kept.velocity.lerp(next.velocity, share);
            }
            same
        });
        Ok(())
    }

    /// What bodies do to the water, each cell once.
    pub fn pushes(&self) -> &[Push] {
        &self.pushes
    }

    /// Lets bodies act for `dt` (s) on the state after a step.
    pub(super) fn push(&mut self, dt: f32) {
        for push in &self.pushes {
            let index = push.cell.y as usize * self.size.0 + push.cell.x as usize;
            let depth = max(sane(self.now.depth[index], DEEPEST), 0.0);
            if depth < FILM {
                continue;
            }
            let factor = per_depth(depth);
            let speed = |discharge: f32| sane(discharge * factor, FASTEST);
            let u = speed(self.now.discharge_x[index]);
            let w = speed(self.now.discharge_z[index]);
            let (from_u, from_w) = (u - push.velocity.x, w - push.velocity.y);
            let kept = kept_of_difference(push.strength * factor * dt, (from_u * from_u + from_w * from_w).sqrt());
            let gained = push.force * (factor * dt);
            let u = sane(push.velocity.x + from_u * kept + gained.x, FASTEST);
            let w = sane(push.velocity.y + from_w * kept + gained.y, FASTEST);
            self.now.discharge_x[index] = depth * u;
            self.now.discharge_z[index] = depth * w;
            self.fastest = max(self.fastest, max(u.abs(), w.abs()) + (GRAVITY * depth).sqrt());
        }
    }
}

/// Share of a difference in velocity that is left after a quadratic drag of `rate` (s/m, s Δt/h) on it, fully implicit: the root of
/// w = w₀ − rate |w| w.
fn kept_of_difference(rate: f32, difference: f32) -> f32 {
    2.0 / (1.0 + (1.0 + 4.0 * rate * difference).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use glam::uvec2;

    #[test]
    fn bodies_that_meet_in_a_cell_push_it_together() {
        let bed = Grid::new(uvec2(4, 4), 1.0, vec![-1.0; 16]).expect("a valid shape");
        let mut water = ShallowWater::new(&bed).expect("a finite bed");
        let push = |strength, velocity, force| Push { cell: uvec2(2, 1), strength, velocity, force };
        let still = Push { cell: uvec2(1, 1), ..Push::default() };
        let both = [push(1.0, Vec2::X, Vec2::Y), still, push(3.0, Vec2::Y, Vec2::Y), push(0.0, Vec2::X, Vec2::X)];
        water.set_pushes(&both).expect("sane");
        assert_eq!(water.pushes(), [push(4.0, Vec2::new(0.25, 0.75), Vec2::new(1.0, 2.0))]);
    }
}
