//! Heights of waves within a stated error, for less than the exact search costs.
use super::{INVERSION_TOLERANCE, WaveField, search::Search};
use glam::Vec2;

/// Finds the height of a [`WaveField`] above places within a stated error: the lowest waves are left out, and the search for the particle
/// above a place ends as soon as what remains of it cannot matter.
///
/// With L the bound of how much displacements differ per distance of two particles (Σ k A, and what the fading of the waves adds),
///
/// * a particle that is found s beside the place is at most s/(1 − L) off, and its height s L/(1 − L);
/// * trains left out, whose amplitudes add up to a, shift the height by at most a/(1 − L).
#[derive(Clone, Debug, PartialEq)]
pub struct HeightSearch {
    /// The waves that count.
    waves: WaveField,
    /// How far beside the place a particle may be, m.
    tolerance: f32,
}

impl HeightSearch {
    /// A search in `waves` whose heights differ by at most `error` (m) from those over [`WaveField::particle_above`], whose own error counts in,
    /// but for the rounding of `f32`.
    ///
    /// `fading` (1/m, ≥ 0) bounds how much the waves' fade differs per distance. `None` if so small an error is not to be had for less, or
    /// cannot be bounded, because the surface may fold: then ask [`WaveField::particle_above`].
    pub fn new(waves: &WaveField, fading: f32, error: f32) -> Option<Self> {
        let bound = |waves: &WaveField| waves.total_steepness() + waves.total_amplitude() * fading;
        let contraction = bound(waves);
        if contraction.is_nan() || contraction >= 1.0 {
            return None;
        }
        let unfinished = waves.unfinished(contraction);
        let of_exact = contraction / (1.0 - contraction) * unfinished.max(INVERSION_TOLERANCE);
        let room = error - of_exact;
        if room.is_nan() || room <= of_exact {
            return None;
        }
        if waves.total_amplitude() <= room {
            return Some(Self { waves: WaveField::default(), tolerance: 0.0 });
        }
        let mut kept = waves.clone();
        kept.trains.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
        let mut left_out = 0.0;
        while let Some(lowest) = kept.trains.pop() {
            let amplitude = left_out + lowest.amplitude;
            // The other half of the room is the search's.
            if amplitude > 0.5 * room * (1.0 - bound(&kept)) {
                kept.trains.push(lowest);
                break;
            }
            left_out = amplitude;
        }
        let contraction = bound(&kept);
        let tolerance = (room * (1.0 - contraction) - left_out) / contraction.max(f32::MIN_POSITIVE);
        (kept.unfinished(contraction) <= tolerance).then_some(Self { waves: kept, tolerance })
    }

    /// Heights of the waves above up to [`WaveField::AT_ONCE`] places (xz, m), at least one, over still water, m; `fade` is their share at a
    /// particle at rest. What belongs to no place is that of the first.
    pub fn heights(&self, places: &[Vec2], fade: impl FnMut(Vec2) -> f32) -> [f32; WaveField::AT_ONCE] {
        if self.waves.trains.is_empty() {
            return [0.0; WaveField::AT_ONCE];
        }
        let mut search = Search::new(places, self.tolerance);
        search.run(&self.waves.trains, fade);
        search.heights.0
    }
}

#[cfg(test)]
mod tests {
    use super::super::Wave;
    use super::*;

    /// Waves of many lengths of this steepness in all.
    fn sea(steepness: f32) -> WaveField {
        let waves: Vec<_> = (0..12)
            .map(|i| Wave {
                direction: Vec2::from_angle(i as f32 * 0.9),
                wavelength: 9.0 * 0.7_f32.powi(i),
                steepness: steepness / 12.0,
                phase: i as f32 * 2.4,
            })
            .collect();
        WaveField::at(&waves, 4.0, 11.0)
    }

    fn places() -> impl Iterator<Item = Vec2> {
        (0..4000).map(|i| Vec2::new((i % 63) as f32 * 0.37 - 11.0, (i / 63) as f32 * 0.41 - 13.0))
    }

    #[test]
    fn heights_are_within_the_error_asked_for() {
        let shore = |at: Vec2| 1.0 / (1.0 + (0.1 * at.x).exp());
        for steepness in [0.1, 0.4, 0.7, 0.85] {
            let field = sea(steepness);
            for error in [1e-3, 1e-2, 1e-1] {
                for (fading, fade) in [(0.0, None), (0.025, Some(shore))] {
                    let fade = |at| fade.map_or(1.0, |fade| fade(at));
                    let search = HeightSearch::new(&field, fading, error);
                    let Some(search) = search else {
                        assert!(error < 0.1 && steepness > 0.6, "no search for {error} m of {steepness}");
                        continue;
                    };
                    let off = |places: &[Vec2]| {
                        let exact = field.particles_above(places, fade).map(|particle| particle.displacement.y);
                        let found = search.heights(places, fade);
                        std::array::from_fn::<_, 8, _>(|lane| (exact[lane] - found[lane]).abs())
                    };
                    let places: Vec<Vec2> = places().collect();
                    let worst = places.chunks(8).flat_map(off).fold(0.0, f32::max);
                    assert!(worst <= error, "{worst} m off, more than {error} m at steepness {steepness}");
                }
            }
        }
    }

    /// What a larger error buys: fewer waves, and in the end none.
    #[test]
    fn an_error_allowed_saves_waves() {
        let field = sea(0.3);
        let kept = |error: f32| HeightSearch::new(&field, 0.0, error).map(|search| search.waves.trains.len());
        assert_eq!(kept(0.0), None);
        assert!(kept(1e-3) > kept(1e-2) && kept(1e-2) > kept(1e-1));
        let height = field.total_amplitude();
        assert_eq!((kept(1.1 * height), kept(f32::INFINITY)), (Some(0), Some(0)));
        assert!(kept(0.5 * height) > Some(0));
    }

    #[test]
    fn what_cannot_be_bounded_is_refused() {
        for (steepness, fading, error) in
            [(0.95, 1.0, 0.1), (1.2, 0.0, 1.0), (0.3, f32::INFINITY, 0.1), (0.3, 0.0, f32::NAN), (0.3, 0.0, -1.0)]
        {
            assert_eq!(HeightSearch::new(&sea(steepness), fading, error), None);
        }
        let still = HeightSearch::new(&WaveField::default(), f32::INFINITY, 1e-3);
        assert!(still.is_none_or(|still| still.heights(&[Vec2::ONE], |_| 1.0) == [0.0; 8]));
    }
}
