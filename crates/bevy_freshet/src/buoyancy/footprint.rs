//! The water around a body, looked up once a step on a lattice over its footprint.

use super::{
    body::Body,
    floating::{BuoyancyModel, Floating},
    solid::bounds,
};
use crate::query::{AT_ONCE, WaterQuery, WaterSample};
use bevy::prelude::*;
use bevy_rapier3d::{
    plugin::context::{RapierContextEntityLink, RapierRigidBodySet},
    prelude::RapierRigidBodyHandle,
};
use freshet_hydro::{hull::SurfacePlane, load::Surface};

/// Places along each side of the lattice under a hull: waves as long as the hull are seen, much shorter ones are not.
const PLACES: usize = 4;

/// Deviation from what the corners say, as a share of the footprint, up to which the water counts as flat.
const FLAT: f32 = 1e-3;

/// The same for its velocity, m/s.
const EVEN: f32 = 0.01;

/// Water on an n × n lattice that spans a rectangle of the xz plane. A body has many more cells than the lattice has
/// places, and a search for the wave above a place costs more than a cell.
#[derive(Default)]
pub(super) struct Footprint {
    min: Vec2,
    size: Vec2,
    places: usize,
    samples: Vec<Option<Surface>>,
    /// Height of the body's lowest point, m.
    pub(super) lowest: f32,
    /// The water that the body is in or over.
    pub(super) water: Option<Entity>,
}

impl Footprint {
    /// Looks up the water at `places`² (at least 2²) points from corner to corner of `area`; at its corners only where that is enough: where
    /// two places within differ from what the corners say by less than [`FLAT`]. `water` answers for up to [`AT_ONCE`] places.
    fn look_up(&mut self, area: Rect, places: usize, mut water: impl FnMut(&[Vec2], &mut [Option<Surface>])) {
        (self.min, self.size) = (area.min, area.size());
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
        if places > 2 && !within.iter().zip(&found[4..]).all(|(place, found)| is_near(*place, *found)) {
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
    pub(super) fn plane(&self) -> Option<SurfacePlane> {
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
    pub(super) fn is_flat(&self) -> bool {
        self.places == 2
    }

    /// Whether no place has water.
    pub(super) fn is_dry(&self) -> bool {
        self.samples.iter().all(Option::is_none)
    }

    /// The place of the footprint that is nearest to `place`.
    pub(super) fn nearest(&self, place: Vec2) -> Vec2 {
        place.clamp(self.min, self.min + self.size)
    }

    /// Water at `place`, bilinear between the four places around it. Where some of them are dry the wet ones count,
    /// and nothing if they are the smaller part.
    pub(super) fn at(&self, place: Vec2) -> Option<Surface> {
        if self.samples.is_empty() {
            return None;
        }
        let cells = (self.places - 1) as f32;
        let at =
            ((place - self.min) / self.size.max(Vec2::splat(f32::MIN_POSITIVE))).clamp(Vec2::ZERO, Vec2::ONE) * cells;
        let first = at.floor().min(Vec2::splat(cells - 1.0));
        let part = at - first;
        let corner = first.y as usize * self.places + first.x as usize;
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

/// The surface as the hull wants it, if the sample is sound.
fn surface_of(sample: &WaterSample) -> Option<Surface> {
    let slope = -sample.normal.xz() / sample.normal.y;
    let sound = sample.height.is_finite() && slope.is_finite() && sample.velocity.is_finite();
    sound.then_some(Surface { height: sample.height, slope, velocity: sample.velocity })
}

/// Looks up the water around every floating body, asleep or not: that is how sleepers learn that the water moved.
pub(super) fn sample_water(
    mut bodies: Query<(&Floating, &RapierRigidBodyHandle, &RapierContextEntityLink, &mut Body)>,
    contexts: Query<&RapierRigidBodySet>,
    water: WaterQuery,
) {
    // Bodies do not know of each other here: the order in which threads take them changes nothing.
    bodies.par_iter_mut().for_each(|(floating, handle, link, mut state)| {
        let state = &mut *state;
        let Some(body) = contexts.get(link.0).ok().and_then(|set| set.bodies.get(handle.0)) else { return };
        if state.form.is_none() || !body.is_enabled() {
            return;
        }
        let aabb = bounds(&state.solids, body.position());
        let area = Rect::from_corners(aabb.mins.xz(), aabb.maxs.xz());
        let places = match floating.model {
            BuoyancyModel::Voxels { per_axis } => per_axis.clamp(2, 16) as usize,
            _ => PLACES,
        };
        // Where waters lie above one another the keel under the middle tells which one the body is in: all of it, as far as that reaches, and
        // beyond only what else reaches up to the keel. What lies far below the brim of a pond is not in it.
        let keel = |at: Vec2| vec3(at.x, aabb.mins.y, at.y);
        let mut own = water.water_at(keel(area.center()));
        state.footprint.lowest = aabb.mins.y;
        state.footprint.look_up(area, places, |places, surfaces| {
            let found = own.map_or_else(Default::default, |own| water.samples_of(own, places));
            for ((place, surface), found) in places.iter().zip(surfaces).zip(found) {
                let reaches = |other: &WaterSample| own.is_none() || other.height > aabb.mins.y;
                let found = found.or_else(|| water.sample(keel(*place)).filter(reaches));
                own = own.or(found.as_ref().map(|found| found.water));
                *surface = found.as_ref().and_then(surface_of).map(|found| Surface {
                    velocity: if floating.current { found.velocity } else { Vec3::ZERO },
                    ..found
                });
            }
        });
        state.footprint.water = own.filter(|_| !state.footprint.is_dry());
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Looks up one place after the other.
    fn each(water: impl Fn(Vec2) -> Option<Surface>) -> impl FnMut(&[Vec2], &mut [Option<Surface>]) {
        move |places, found| found.iter_mut().zip(places).for_each(|(found, place)| *found = water(*place))
    }

    fn plane(at: Vec2) -> Option<Surface> {
        Some(Surface { height: 1.0 + 0.5 * at.x - 0.25 * at.y, slope: Vec2::new(0.5, -0.25), velocity: Vec3::X })
    }

    #[test]
    fn a_plane_is_interpolated_exactly() {
        let mut footprint = Footprint::default();
        footprint.look_up(Rect::new(-1.0, 2.0, 3.0, 4.0), 4, each(plane));
        for at in [Vec2::new(-1.0, 2.0), Vec2::new(3.0, 4.0), Vec2::new(0.3, 3.7)] {
            let (found, exact) = (footprint.at(at).unwrap(), plane(at).unwrap());
            assert!((found.height - exact.height).abs() < 1e-5);
            assert!(found.slope.abs_diff_eq(exact.slope, 1e-5) && found.velocity.abs_diff_eq(exact.velocity, 1e-5));
        }
    }

    /// Half the footprint over land: dry there, and the wet half undisturbed.
    #[test]
    fn a_shore_ends_the_water() {
        let mut footprint = Footprint::default();
        footprint.look_up(Rect::new(-1.0, -1.0, 1.0, 1.0), 5, each(|at| plane(at).filter(|_| at.x < 0.1)));
        assert!(footprint.at(Vec2::new(0.9, 0.0)).is_none());
        let found = footprint.at(Vec2::new(-0.6, 0.2)).unwrap();
        assert!((found.height - 0.65).abs() < 1e-5);
        assert!(!footprint.is_dry());
        footprint.look_up(Rect::new(0.0, 0.0, 0.0, 0.0), 1, each(|_| None));
        assert!(footprint.is_dry() && footprint.at(Vec2::ZERO).is_none());
    }
}
