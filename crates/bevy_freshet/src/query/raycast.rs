//! Where a ray meets the waves.
use super::{WaterQuery, WaterSample, samples};
use crate::body::ResolvedWater;
use bevy::{math::Vec3A, prelude::*};

/// Height over the surface, m, at which a ray has met it.
const TOLERANCE: f32 = 2e-5;
/// Most steps towards the surface. A ray that grazes crests takes small ones.
const MAX_STEPS: u32 = 256;

/// Slope, over that within the water, of a simulated surface between its shore and where it is put under the ground.
const SHORE: f32 = 2.0;

/// Where a ray meets the water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaterHit {
    /// Distance from the origin of the ray, m.
    pub distance: f32,
    /// World position, m.
    pub position: Vec3,
    /// The water there.
    pub surface: WaterSample,
}

impl WaterQuery<'_, '_> {
    /// The nearest place, at most `max` (m, may be infinite) away, where `ray` (world) meets the surface of a water, from
    /// above or from below, within a millimetre. `None` if it meets none, or if ground is there above the water.
    ///
    /// Nothing but water is asked: what else stands in the way is for the game to find.
    pub fn raycast(&self, ray: Ray3d, max: f32) -> Option<WaterHit> {
        self.waters
            .iter()
            .filter_map(|(entity, water)| {
                let distance = meet(water, ray, max)?;
                let position = ray.get_point(distance);
                let surface = samples(entity, water, &water.waves, &[position.xz()])[0].take()?;
                Some(WaterHit { distance, position, surface })
            })
            .min_by(|a, b| a.distance.total_cmp(&b.distance).then(a.surface.water.cmp(&b.surface.water)))
    }
}

/// Distance at which `ray` meets the surface of `water`.
///
/// From a height h over the surface a ray can go `h / (|d_y| + |d_xz| s)` without meeting it, where s is the surface's
/// steepest slope (sphere tracing, Hart 1996).
fn meet(water: &ResolvedWater, ray: Ray3d, max: f32) -> Option<f32> {
    let local_from_world = water.pose().compute_affine().inverse();
    let origin = local_from_world.transform_point3a(ray.origin.into());
    let direction = local_from_world.transform_vector3a(ray.direction.as_vec3().into());
    let height = |t: f32| {
        let point = origin + direction * t;
        point.y - water.surface(Vec3::from(point).xz())
    };

    let (lowest, highest) = water.elevations();
    let half = vec3(water.half_size.x, highest.max(-lowest) + TOLERANCE, water.half_size.y);
    let (from, to) = inside_box(origin, direction, half.into(), max)?;
    let pace = direction.y.abs() + Vec3::from(direction).xz().length() * steepest_slope(water);
    let first = height(from);
    let (mut t, mut above) = (from, first);
    for _ in 0..MAX_STEPS {
        if above.abs() < TOLERANCE {
            return Some(t);
        }
        let next = (t + above.abs() / pace).min(to);
        let then = height(next);
        if then * first <= 0.0 {
            return Some(bisect(t, next, first, height));
        }
        if next >= to {
            return None;
        }
        (t, above) = (next, then);
    }
    None
}

/// Where `height` loses the sign of `first`, between `from` and `to`.
fn bisect(mut from: f32, mut to: f32, first: f32, height: impl Fn(f32) -> f32) -> f32 {
    for _ in 0..24 {
        let middle = 0.5 * (from + to);
        if height(middle) * first > 0.0 {
            from = middle;
        } else {
            to = middle;
        }
    }
    to
}

/// Bound of the slope of the surface. The slope of the sum of all trains is at most Σ k A against particles at rest, which
/// are squeezed to a share of 1 − Σ k A at most; where the waves fade over a shelving bed or at the front of ice a little is added.
fn steepest_slope(water: &ResolvedWater) -> f32 {
    let steepness = water.waves.total_steepness().min(0.95);
    let shelving = if water.bed.is_some() || water.ice.is_some() { 0.3 } else { 0.0 };
    let simulated = water.simulated.as_ref().map_or(0.0, |simulated| simulated.water.steepest() + SHORE);
    steepness / (1.0 - steepness) + shelving + simulated
}

/// Where a ray from `origin` is inside the box from −`half` to `half`, at most `max` away.
fn inside_box(origin: Vec3A, direction: Vec3A, half: Vec3A, max: f32) -> Option<(f32, f32)> {
    if !origin.is_finite() || max.is_nan() {
        return None;
    }
    let (mut from, mut to) = (0.0_f32, max);
    for axis in 0..3 {
        if direction[axis] == 0.0 {
            if origin[axis].abs() > half[axis] {
                return None;
            }
            continue;
        }
        let (a, b) = ((-half[axis] - origin[axis]) / direction[axis], (half[axis] - origin[axis]) / direction[axis]);
        (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
    }
    (from <= to).then_some((from, to))
}
