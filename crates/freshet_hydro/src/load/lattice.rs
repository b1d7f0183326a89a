//! The water over a rectangle, looked up at a few places.
use super::Surface;
use crate::{hull::SurfacePlane, waves::WaveField};
use glam::{Vec2, vec2};

/// How many places are looked up at once.
const AT_ONCE: usize = WaveField::AT_ONCE;

/// Deviation from what the corners say, as a share of the lattice, up to which the water counts as flat.
const FLAT: f32 = 1e-3;

/// The same for its velocity, m/s.
const EVEN: f32 = 0.01;

/// Water on an n × n lattice that spans a rectangle of the xz plane. A body has many more points than the lattice has
/// places, and a search for the wave above a place costs more than a point.
#[derive(Debug, Clone, Default)]
pub struct SurfaceLattice {
    min: Vec2,
    size: Vec2,
    /// 1/size, 1/m.
    per_size: Vec2,
    places: usize,
    samples: Vec<Option<Surface>>,
}

impl SurfaceLattice {
    /// Looks up the water at `places`² (at least 2²) points between two opposite `corners` (xz, m), the lesser one first; at the four corners
    /// only where that is enough: where two places within differ from what those say by less than 10⁻³ of the size and 1 cm/s. `water`
    /// answers for up to [`WaveField::AT_ONCE`] places.
    pub fn look_up(
        &mut self,
        corners: [Vec2; 2],
        places: usize,
        mut water: impl FnMut(&[Vec2], &mut [Option<Surface>]),
    ) {
        (self.min, self.size) = (corners[0], corners[1] - corners[0]);
        self.per_size = self.size.max(Vec2::splat(f32::MIN_POSITIVE)).recip();
        // The second lies off all symmetries of the corners and the middle, so that a short wave that fits these shows there.
        const WITHIN: [Vec2; 2] = [Vec2::splat(0.5), vec2(0.31, 0.66)];
        let [a, b, c, d] = [0, 1, 2, 3].map(|corner| self.place(corner, 2));
        let within = WITHIN.map(|share| self.min + self.size * share);
        let mut found = [None; 6];
        water(&[a, b, c, d, within[0], within[1]], &mut found);
        self.places = 2;
        self.samples.clear();
        self.samples.extend_from_slice(&found[..4]);
        let is_near = |place: Vec2, found: Option<Surface>| {
            let (Some(expected), Some(found)) = (self.at(place), found) else { return false };
            (expected.height - found.height).abs() <= FLAT * self.size.max_element()
                && expected.velocity.distance(found.velocity) <= EVEN
        };
        // Where the water ends between the corners, it does so somewhere.
        let says_all = found.iter().all(Option::is_some)
            && within.iter().zip(&found[4..]).all(|(place, found)| is_near(*place, *found));
        if places > 2 && !says_all {
            self.look_up_lattice(places, &mut water);
        }
    }

    /// Place of a sample, m, of a lattice of this many places along each side.
    fn place(&self, index: usize, places: usize) -> Vec2 {
        let step = self.size / (places - 1) as f32;
        self.min + step * vec2((index % places) as f32, (index / places) as f32)
    }

    fn look_up_lattice(&mut self, places: usize, water: &mut impl FnMut(&[Vec2], &mut [Option<Surface>])) {
        self.places = places;
        self.samples.clear();
        self.samples.resize(places * places, None);
        let mut first = 0;
        while first < self.samples.len() {
            let count = AT_ONCE.min(self.samples.len() - first);
            let at: [Vec2; AT_ONCE] = std::array::from_fn(|index| self.place(first + index, places));
            water(&at[..count], &mut self.samples[first..first + count]);
            first += count;
        }
    }

    /// The plane through its corners; level, if some are dry, and nothing if all are.
    pub fn plane(&self) -> Option<SurfacePlane> {
        let last = self.places.checked_sub(1)?;
        let corner = |row: usize, column: usize| self.samples.get(row * self.places + column).copied().flatten();
        let corners = [corner(0, 0), corner(0, last), corner(last, 0), corner(last, last)];
        let count = corners.iter().flatten().count();
        let mean = corners.iter().flatten().map(|water| water.height).sum::<f32>() / count.max(1) as f32;
        let slope = match corners.map(|water| water.map(|water| water.height)) {
            [Some(a), Some(b), Some(c), Some(d)] => {
                vec2(b + d - a - c, c + d - a - b) / (2.0 * self.size.max(Vec2::splat(f32::MIN_POSITIVE)))
            }
            _ => Vec2::ZERO,
        };
        let height = mean - slope.dot(self.min + 0.5 * self.size);
        // Steeper is no surface, but the brim of a pond.
        (count > 0 && slope.length() < 1.0).then_some(SurfacePlane { height, slope })
    }

    /// Whether its corners say all.
    pub fn is_flat(&self) -> bool {
        self.places == 2
    }

    /// Whether no place has water.
    pub fn is_dry(&self) -> bool {
        self.samples.iter().all(Option::is_none)
    }

    /// The place of the lattice that is nearest to `place`.
    pub fn nearest(&self, place: Vec2) -> Vec2 {
        place.clamp(self.min, self.min + self.size)
    }

    /// Water at `place`, bilinear between the four places around it. Where some of them are dry the wet ones count,
    /// and nothing if they are the smaller part.
    pub fn at(&self, place: Vec2) -> Option<Surface> {
        if self.samples.is_empty() {
            return None;
        }
        let cells = (self.places - 1) as f32;
        let at = ((place - self.min) * self.per_size).clamp(Vec2::ZERO, Vec2::ONE) * cells;
        // Whole parts of what is not negative.
        let (column, row) = ((at.x as usize).min(self.places - 2), (at.y as usize).min(self.places - 2));
        let part = at - vec2(column as f32, row as f32);
        let corner = row * self.places + column;
        let weights = [
            (corner, (1.0 - part.x) * (1.0 - part.y)),
            (corner + 1, part.x * (1.0 - part.y)),
            (corner + self.places, (1.0 - part.x) * part.y),
            (corner + self.places + 1, part.x * part.y),
        ];
        let mut wet = 0.0;
        let mut sum = Surface::default();
        for (index, weight) in weights {
            if let Some(Some(water)) = self.samples.get(index) {
                wet += weight;
                sum.height += weight * water.height;
                sum.slope += weight * water.slope;
                sum.velocity += weight * water.velocity;
            }
        }
        (wet >= 0.5).then(|| Surface { height: sum.height / wet, slope: sum.slope / wet, velocity: sum.velocity / wet })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Looks up one place after the other.
    fn each(water: impl Fn(Vec2) -> Option<Surface>) -> impl FnMut(&[Vec2], &mut [Option<Surface>]) {
        move |places, found| found.iter_mut().zip(places).for_each(|(found, place)| *found = water(*place))
    }

    fn plane(at: Vec2) -> Option<Surface> {
        Some(Surface { height: 1.0 + 0.5 * at.x - 0.25 * at.y, slope: Vec2::new(0.5, -0.25), velocity: Vec3::X })
    }

    #[test]
    fn a_plane_is_interpolated_exactly() {
        let mut lattice = SurfaceLattice::default();
        lattice.look_up([vec2(-1.0, 2.0), vec2(3.0, 4.0)], 4, each(plane));
        for at in [Vec2::new(-1.0, 2.0), Vec2::new(3.0, 4.0), Vec2::new(0.3, 3.7)] {
            let (found, exact) = (lattice.at(at).unwrap(), plane(at).unwrap());
            assert!((found.height - exact.height).abs() < 1e-5);
            assert!(found.slope.abs_diff_eq(exact.slope, 1e-5) && found.velocity.abs_diff_eq(exact.velocity, 1e-5));
        }
    }

    /// A little more than half of it has water, which the corners and the middle do not tell.
    #[test]
    fn where_water_ends_is_looked_for_between_the_corners() {
        let mut lattice = SurfaceLattice::default();
        let shelf = |at: Vec2| plane(Vec2::ZERO).filter(|_| at.x < 3.1);
        lattice.look_up([Vec2::ZERO, Vec2::splat(4.0)], 4, each(shelf));
        assert!(!lattice.is_flat());
        assert!(lattice.at(vec2(3.0, 1.0)).is_some() && lattice.at(vec2(3.5, 1.0)).is_none());
    }

    /// Half the lattice over land: dry there, and the wet half undisturbed.
    #[test]
    fn a_shore_ends_the_water() {
        let mut lattice = SurfaceLattice::default();
        lattice.look_up([vec2(-1.0, -1.0), vec2(1.0, 1.0)], 5, each(|at| plane(at).filter(|_| at.x < 0.1)));
        assert!(lattice.at(Vec2::new(0.9, 0.0)).is_none());
        let found = lattice.at(Vec2::new(-0.6, 0.2)).unwrap();
        assert!((found.height - 0.65).abs() < 1e-5);
        assert!(!lattice.is_dry());
        lattice.look_up([Vec2::ZERO; 2], 1, each(|_| None));
        assert!(lattice.is_dry() && lattice.at(Vec2::ZERO).is_none());
    }
}
