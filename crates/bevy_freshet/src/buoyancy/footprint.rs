//! The water around a body, looked up once a step on a lattice over its footprint.

use super::{
    body::Body,
    floating::{BuoyancyModel, Floating},
    solid::bounds,
};
use crate::query::{WaterQuery, WaterSample};
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
    /// Looks up the water at `places`² (at least 2²) points from corner to corner of `area`, whose middle has been looked up; at its
    /// corners only where that is enough: where two places within differ from what the corners say by less than [`FLAT`].
    fn look_up(
        &mut self,
        area: Rect,
        places: usize,
        middle: Option<Surface>,
        mut water: impl FnMut(Vec2) -> Option<Surface>,
    ) {
        self.min = area.min;
        self.size = area.size();
        self.look_up_lattice(2, &mut water);
        let is_near = |within: Vec2, found: Option<Surface>| {
            let (Some(expected), Some(found)) = (self.at(self.min + self.size * within), found) else { return false };
            (expected.height - found.height).abs() <= FLAT * self.size.max_element()
                && expected.velocity.distance(found.velocity) <= EVEN
        };
        // The second lies off all symmetries of the corners and the middle, so that a short wave that fits these shows there.
        const OFF_MIDDLE: Vec2 = vec2(0.31, 0.66);
        if places > 2
            && !(is_near(Vec2::splat(0.5), middle) && is_near(OFF_MIDDLE, water(self.min + self.size * OFF_MIDDLE)))
        {
            self.look_up_lattice(places, &mut water);
        }
    }

    fn look_up_lattice(&mut self, places: usize, water: &mut impl FnMut(Vec2) -> Option<Surface>) {
        self.places = places;
        let step = self.size / (places - 1) as f32;
        self.samples.clear();
        for row in 0..places {
            for column in 0..places {
                self.samples.push(water(self.min + step * Vec2::new(column as f32, row as f32)));
            }
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
fn surface(sample: &WaterSample) -> Option<Surface> {
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
        // Where waters lie above one another the keel under the middle tells which one the body is in: all of it, as far as that reaches.
        let keel = |at: Vec2| vec3(at.x, aabb.mins.y, at.y);
        let middle = water.sample(keel(area.center()));
        let mut own = middle.as_ref().map(|sample| sample.water);
        let moving = |sample: &WaterSample| {
            let found = surface(sample)?;
            Some(Surface { velocity: if floating.current { found.velocity } else { Vec3::ZERO }, ..found })
        };
        state.footprint.lowest = aabb.mins.y;
        state.footprint.look_up(area, places, middle.as_ref().and_then(moving), |at| {
            let found = own.and_then(|own| water.sample_of(own, at)).or_else(|| water.sample(keel(at)))?;
            own = own.or(Some(found.water));
            moving(&found)
        });
        state.footprint.water = own;
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(at: Vec2) -> Option<Surface> {
        Some(Surface { height: 1.0 + 0.5 * at.x - 0.25 * at.y, slope: Vec2::new(0.5, -0.25), velocity: Vec3::X })
    }

    #[test]
    fn a_plane_is_interpolated_exactly() {
        let mut footprint = Footprint::default();
        footprint.look_up(Rect::new(-1.0, 2.0, 3.0, 4.0), 4, plane(Vec2::new(1.0, 3.0)), plane);
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
        footprint.look_up(Rect::new(-1.0, -1.0, 1.0, 1.0), 5, plane(Vec2::ZERO), |at| plane(at).filter(|_| at.x < 0.1));
        assert!(footprint.at(Vec2::new(0.9, 0.0)).is_none());
        let found = footprint.at(Vec2::new(-0.6, 0.2)).unwrap();
        assert!((found.height - 0.65).abs() < 1e-5);
        assert!(!footprint.is_dry());
        footprint.look_up(Rect::new(0.0, 0.0, 0.0, 0.0), 1, None, |_| None);
        assert!(footprint.is_dry() && footprint.at(Vec2::ZERO).is_none());
    }
}
