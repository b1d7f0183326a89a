//! How water resists a hull: skin friction, pressure on faces that the water strikes or leaves, and waves sent out.
use crate::lanes::{Lanes, Vectors};

/// Kinematic viscosity ν of water at 20 °C, m²/s.
pub const VISCOSITY: f32 = 1.0e-6;

/// Below this Reynolds number skin friction follows a laminar layer, above it the line of ships.
const LAMINAR: f32 = 2e4;

/// Share of the waves of a face that moves up and down which one has that moves along the surface.
const SURGE: f32 = 0.15;

/// How strongly water resists a hull.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HullDrag {
    /// Factor on skin friction, ≥ 0, default 1: above 1 for rough or overgrown hulls.
    pub friction: f32,
    /// Pressure coefficient of faces that meet or leave the water squarely, ≥ 0, default 1.05: the drag coefficient of a cube across a
    /// face (Hoerner, *Fluid-Dynamic Drag*, 1965).
    pub bluff: f32,
    /// Pressure coefficient of faces that lean away from the water's way, ≥ 0, default 0.72: with that of squarely met ones it gives a
    /// ball 0.47 (Hoerner). Less for well-formed hulls.
    pub fair: f32,
    /// Strength of the waves that a moving hull sends out, ≥ 0, default 0.67: a level face near the surface that moves up or down at v
    /// is resisted by this · ρ √(g L) v per area, L being the edge of a cube of the hull's volume, and an upright one that moves along
    /// the surface by 0.15 of it. A half-submerged ball then stops heaving by 0.11 of critical damping.
    pub radiation: f32,
}

impl Default for HullDrag {
    fn default() -> Self {
        Self { friction: 1.0, bluff: 1.05, fair: 0.72, radiation: 0.67 }
    }
}

/// Skin friction coefficient at a Reynolds number: C_f = 0.075/(log₁₀ Re − 2)² (8th International Towing Tank Conference, Madrid 1957),
/// and below Re = 2·10⁴, where that line rises without bounds, ∝ Re^(−½) as for a laminar layer.
pub fn friction_coefficient(reynolds: f32) -> f32 {
    let ship = |reynolds: f32| 0.075 / (libm::log10f(reynolds) - 2.0).powi(2);
    if reynolds >= LAMINAR { ship(reynolds) } else { ship(LAMINAR) * (LAMINAR / reynolds.max(1e-6)).sqrt() }
}

/// What all faces of a hull in a step share.
pub(super) struct FaceDrag {
    /// Of skin friction, per area and tangential speed, N·s²/m⁴.
    friction: f32,
    /// Of pressure, per area and normal speed, N·s²/m⁴.
    bluff: f32,
    fair: f32,
    /// Of waves, per area, N·s/m³.
    radiation: f32,
    /// 1/L, by which waves fade with depth, 1/m.
    per_length: f32,
}

impl FaceDrag {
    /// `speed` (m/s) of the hull through the water and its `length` (m) make its Reynolds number.
    pub fn new(drag: &HullDrag, density: f32, gravity: f32, length: f32, speed: f32) -> Self {
        Self {
            friction: 0.5 * density * drag.friction * friction_coefficient(speed * length / VISCOSITY),
            // Half of it where the water is met, half where it leaves.
            bluff: 0.25 * density * drag.bluff,
            fair: 0.25 * density * drag.fair,
            radiation: drag.radiation * density * (gravity * length).sqrt(),
            per_length: length.recip(),
        }
    }

    /// What faces with these normals at this mean depth (m), which the water passes at `relative` (m/s), answer that with, N·s/m per m²:
    /// in every direction, and along the normal beyond that.
    ///
    /// Newton's law of resistance, p ∝ (w · n)², with a coefficient that grows with how squarely a face is met. Waves that a face
    /// sends out fade with its depth, like exp(−d/L) to the third order.
    #[inline(always)]
    pub fn at(&self, normal: Vectors, depth: Lanes, relative: Vectors) -> [Lanes; 2] {
        let across = relative.dot(normal).abs();
        let square = relative.dot(relative).at_least(1e-30);
        let squarely = across * across / square;
        let pressure = (Lanes::splat(self.fair) + squarely * (self.bluff - self.fair)) * across;
        let x = depth * self.per_length;
        let one = Lanes::splat(1.0);
        let fading = one + x * (one + x * (Lanes::splat(0.5) + x * (1.0 / 6.0)));
        let tangential = square.sqrt() * self.friction;
        // Faces that push water up and down send waves out; those that part it hardly do at low speed.
        let heaving = normal.y * normal.y * (1.0 - SURGE) + Lanes::splat(SURGE);
        [tangential, pressure + heaving * self.radiation / fading - tangential]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of the line: 10⁶ → 4.6875e-3, 10⁷ → 3.0e-3, 10⁹ → 1.5306e-3.
    #[test]
    fn friction_follows_the_line_of_1957() {
        for (reynolds, coefficient) in [(1e6, 4.6875e-3), (1e7, 3.0e-3), (1e9, 1.530_6e-3)] {
            assert!((friction_coefficient(reynolds) / coefficient - 1.0).abs() < 1e-4);
        }
        let below_and_above = [1.999e4, 2.001e4].map(friction_coefficient);
        assert!((below_and_above[0] / below_and_above[1] - 1.0).abs() < 2e-3, "the two laws meet");
        assert!(friction_coefficient(0.0).is_finite());
    }
}
