//! Particles at the surface: where they are, how fast, and how the surface lies there.
use super::{WaveField, WaveTrain, search::Search, sums};
use crate::lanes::{LANES, Lanes, Vectors};
use glam::{Vec2, Vec3};
use pulp::{Arch, Simd, WithSimd};

/// Horizontal accuracy of [`WaveField::particle_above`], m. With slopes below 1 the height is as good.
pub const INVERSION_TOLERANCE: f32 = 1e-4;

/// A particle at the surface of waves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Particle {
    /// Where it rests in still water (xz, m).
    pub rest: Vec2,
    /// Displacement from there, m.
    pub displacement: Vec3,
    /// Velocity, m/s.
    pub velocity: Vec3,
    /// Upward unit normal of the surface, for a locally constant fade.
    ///
    /// With `s = Σ f kᵢ Aᵢ sin θᵢ` and `J = ∂x/∂x₀ = 1 − Σ f k̂k̂ᵀ k A cos θ` the slope is `−J⁻¹ s`.
    pub normal: Vec3,
}

impl WaveField {
    /// How many particles are found at the cost of one.
    pub const AT_ONCE: usize = LANES;

    /// The particle that rests at `rest` (xz, m); `fade` is its [`shallow_fade`](super::shallow_fade).
    pub fn particle(&self, rest: Vec2, fade: f32) -> Particle {
        particles(&self.trains, [rest.x, rest.y].map(Lanes::splat), Lanes::splat(fade))[0]
    }

    /// The particle that is now above `place` (xz, m), or within [`INVERSION_TOLERANCE`] of that; `fade` is the share of the waves at a
    /// particle at rest.
    pub fn particle_above(&self, place: Vec2, fade: impl FnMut(Vec2) -> f32) -> Particle {
        self.particles_above(&[place], fade)[0]
    }

    /// The particles above up to [`WaveField::AT_ONCE`] places, at least one: see [`WaveField::particle_above`]. Those of missing places are
    /// above the first.
    pub fn particles_above(&self, places: &[Vec2], mut fade: impl FnMut(Vec2) -> f32) -> [Particle; Self::AT_ONCE] {
        let mut search = Search::new(places, INVERSION_TOLERANCE);
        let fades = search.run(&self.trains, &mut fade);
        particles(&self.trains, search.rest, fades)
    }
}

/// Not generic, so that it is compiled here, whoever calls it and however that is compiled.
fn particles(trains: &[WaveTrain], rest: [Lanes; 2], fades: Lanes) -> [Particle; LANES] {
    let motion = Arch::new().dispatch(Motion { trains, rest, fades });
    let vector = |of: &Vectors, lane: usize| Vec3::new(of.x.0[lane], of.y.0[lane], of.z.0[lane]);
    std::array::from_fn(|lane| Particle {
        rest: Vec2::new(rest[0].0[lane], rest[1].0[lane]),
        displacement: vector(&motion.displacement, lane),
        velocity: vector(&motion.velocity, lane),
        normal: vector(&motion.across, lane).normalize_or(Vec3::Y),
    })
}

struct Motion<'a> {
    trains: &'a [WaveTrain],
    rest: [Lanes; 2],
    fades: Lanes,
}

struct Moved {
    displacement: Vectors,
    velocity: Vectors,
    /// Across the surface, of any length.
    across: Vectors,
}

impl WithSimd for Motion<'_> {
    type Output = Moved;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Moved {
        let sums::Motion { displacement, velocity, slope, stretch } = sums::motion(self.trains, self.rest, self.fades);
        // (∂x × ∂z) of the parametric surface, turned upward: no division, so a cusp is harmless.
        let [x, z] = stretch.adjugate_mul(slope);
        Moved { displacement, velocity, across: Vectors { x: -x, y: stretch.determinant(), z: -z } }
    }
}
