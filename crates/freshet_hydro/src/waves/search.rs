//! The search for the particles above places, eight places at once.
use super::{WaveTrain, sums};
use crate::lanes::{LANES, Lanes};
use glam::Vec2;
use pulp::{Arch, Simd, WithSimd};

/// Most steps of a search.
const MAX_STEPS: u32 = 96;

/// How often they contract at least: one of two does.
pub(super) const LEAST_CONTRACTIONS: u32 = MAX_STEPS / 2 - 1;

/// Solves `x₀ + D(x₀) = place` by Newton's method, for eight places. A step that does not bring place and particle nearer, in steep waves,
/// is taken back, and one of the fixed-point iteration comes in its place: that contracts by the sum of the steepnesses, which is below 1
/// for a surface without loops.
pub(super) struct Search {
    /// Of the places.
    count: usize,
    places: [Lanes; 2],
    /// How far beside its place a particle may be, m².
    tolerance: Lanes,
    /// The particles at rest.
    pub rest: [Lanes; 2],
    /// Their heights over still water, m.
    pub heights: Lanes,
    /// Where the fixed-point iteration goes from the nearest particle so far, and how far beside its place that was, m².
    contracted: [Lanes; 2],
    least: Lanes,
}

impl Search {
    /// A search for the particles within `tolerance` (m), or rounding, of `places`, of which there are 1 to 8.
    pub fn new(places: &[Vec2], tolerance: f32) -> Self {
        let mut lanes = [Lanes::splat(places[0].x), Lanes::splat(places[0].y)];
        for (lane, place) in places.iter().enumerate() {
            (lanes[0].0[lane], lanes[1].0[lane]) = (place.x, place.y);
        }
        let rounding = (lanes[0].abs() + lanes[1].abs()) * (2.0 * f32::EPSILON);
        let tolerance = rounding.at_least(tolerance);
        Self {
            count: places.len(),
            places: lanes,
            tolerance: tolerance * tolerance,
            rest: lanes,
            heights: Lanes::ZERO,
            contracted: lanes,
            least: Lanes::splat(f32::INFINITY),
        }
    }

    /// The particle at rest in a lane.
    pub fn rest(&self, lane: usize) -> Vec2 {
        Vec2::new(self.rest[0].0[lane], self.rest[1].0[lane])
    }

    /// Searches to the end; `fade` is the share of the waves at a particle at rest. Returns that share at what was found; the last
    /// iterate counts as found where there is no better one.
    pub fn run(&mut self, trains: &[WaveTrain], mut fade: impl FnMut(Vec2) -> f32) -> Lanes {
        let mut fades = Lanes::ZERO;
        for _ in 0..MAX_STEPS {
            fades = Lanes::splat(fade(self.rest(0)));
            for lane in 1..self.count {
                fades.0[lane] = fade(self.rest(lane));
            }
            if self.step(trains, fades) {
                break;
            }
        }
        fades
    }

    /// Takes a step with the shares of the waves at the particles. True if all of them were found. Not generic, so that it is compiled
    /// here, whoever calls it and however that is compiled.
    fn step(&mut self, trains: &[WaveTrain], fades: Lanes) -> bool {
        Arch::new().dispatch(Step { search: self, trains, fades })
    }
}

struct Step<'a> {
    search: &'a mut Search,
    trains: &'a [WaveTrain],
    fades: Lanes,
}

impl WithSimd for Step<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        let Self { search, trains, fades } = self;
        let (moved, stretch) = sums::displacement(trains, search.rest, fades);
        search.heights = moved.y;
        let beside = [search.rest[0] + moved.x - search.places[0], search.rest[1] + moved.z - search.places[1]];
        let error = beside[0] * beside[0] + beside[1] * beside[1];
        let determinant = stretch.determinant();
        let newton = stretch.adjugate_mul(beside).map(|step| step / determinant);
        let mut found = true;
        for lane in 0..LANES {
            let error = error.0[lane];
            // What is not a number is not searched for.
            let is_found = error.is_nan() || error <= search.tolerance.0[lane];
            found &= is_found;
            let is_nearer = error < search.least.0[lane];
            search.least.0[lane] = if is_nearer { error } else { f32::INFINITY };
            let goes = determinant.0[lane] > 0.0;
            for axis in 0..2 {
                let (rest, beside) = (search.rest[axis].0[lane], beside[axis].0[lane]);
                let kept = if is_nearer { rest - beside } else { search.contracted[axis].0[lane] };
                search.contracted[axis].0[lane] = kept;
                let next = if is_nearer && goes { rest - newton[axis].0[lane] } else { kept };
                search.rest[axis].0[lane] = if is_found { rest } else { next };
            }
        }
        found
    }
}
