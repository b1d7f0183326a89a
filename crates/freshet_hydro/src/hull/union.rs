//! Several hulls as one body.

use super::convex::Convex;
use super::inside::winding;
use super::{Hull, HullError, boxes_meet, corners};
use glam::{DVec3, Vec3};

/// Most intersections of parts in a union: each costs about as many triangles as a part.
const MOST_SHARED: usize = 64;

/// Triangles of a part at which is asked whether it lies in another.
const PROBES: usize = 512;

/// Several hulls as one body, by [`Hull::union`].
#[derive(Debug, Clone, PartialEq)]
pub struct Union {
    /// The body.
    pub hull: Hull,
    /// Pairs of parts that overlap but count twice where they do, because one of them is not convex or there are too many overlaps.
    /// Zero if the volume is right.
    pub doubled: usize,
}

/// A convex solid that counts once, or is to be taken away once.
struct Signed {
    solid: Convex,
    negative: bool,
}

impl Hull {
    /// Several hulls as one body, which holds what any of them holds.
    ///
    /// Where convex parts overlap, what they have in common is taken away once, by triangles from [`Hull::shared`] on, and what three
    /// of them have in common comes back: the volume of a union is Σ|A| − Σ|A∩B| + Σ|A∩B∩C| − … (inclusion and exclusion). A part
    /// that is not convex is added as it is, and so is one whose overlaps with the parts before it would make more than 64
    /// intersections in all; [`Union::doubled`] counts what overlaps such parts. Faces that touch are no overlap.
    ///
    /// # Errors
    /// [`HullError::NoTriangles`] without parts, [`HullError::Flat`] if the volume is beyond an `f32`.
    pub fn union(parts: Vec<Hull>) -> Result<Union, HullError> {
        if parts.is_empty() {
            return Err(HullError::NoTriangles);
        }
        let (shared, whole) = overlaps(&parts);
        let doubled = doubled(&parts, &whole);
        let mut points = Vec::new();
        let [mut outer, mut inner] = [Vec::new(), Vec::new()];
        for part in &parts {
            let first = points.len() as u32;
            points.extend_from_slice(&part.points);
            let moved = part.triangles.iter().map(|triangle| triangle.map(|point| first + point));
            outer.extend(moved.clone().take(part.shared));
            inner.extend(moved.skip(part.shared));
        }
        for Signed { solid, negative } in &shared {
            solid.append(&mut points, if *negative { &mut inner } else { &mut outer }, *negative);
        }
        let shared = outer.len();
        outer.append(&mut inner);
        Ok(Union { hull: Self::measured(points, outer, shared)?, doubled })
    }
}

/// What the parts have in common, with its signs, and which parts were left out of that and count in full.
fn overlaps(parts: &[Hull]) -> (Vec<Signed>, Vec<bool>) {
    let mut solids = Vec::new();
    let mut shared = Vec::<Signed>::new();
    let mut whole = vec![false; parts.len()];
    for (part, whole) in parts.iter().zip(&mut whole) {
        let Some(solid) = Convex::of(part) else {
            *whole = true;
            continue;
        };
        let with_parts = solids.iter().filter_map(|other| solid.intersection(other)).map(|solid| (solid, true));
        let with_shared = shared.iter().filter_map(|other| Some((solid.intersection(&other.solid)?, !other.negative)));
        let room = MOST_SHARED - shared.len();
        let new: Vec<_> = with_parts.chain(with_shared).take(room + 1).collect();
        if new.len() > room {
            *whole = true;
            continue;
        }
        shared.extend(new.into_iter().map(|(solid, negative)| Signed { solid, negative }));
        solids.push(solid);
    }
    (shared, whole)
}

/// How many pairs of parts overlap of which one counts in full.
fn doubled(parts: &[Hull], whole: &[bool]) -> usize {
    let pairs = (0..parts.len()).flat_map(|second| (0..second).map(move |first| (first, second)));
    pairs.filter(|&(a, b)| (whole[a] || whole[b]) && overlap(&parts[a], &parts[b])).count()
}

/// Whether two parts hold something in common: whether a point just below the surface of one lies in the other.
fn overlap(a: &Hull, b: &Hull) -> bool {
    boxes_meet(a.bounds(), b.bounds()) && (reaches_into(a, b) || reaches_into(b, a))
}

fn reaches_into(a: &Hull, b: &Hull) -> bool {
    // A thousandth of the smaller part is far more than rounding, and less than an overlap that matters.
    let depth = 1e-3 * f64::from(a.length().min(b.length()));
    let room = b.bounds();
    let surface = a.clone().refined(0.2 * b.length(), PROBES);
    let step = surface.triangles.len().div_ceil(PROBES);
    surface.triangles.iter().step_by(step).any(|&triangle| {
        let [p, q, r] = corners(&surface.points, triangle);
        let inward = (r - p).cross(q - p).normalize_or_zero();
        let probe: DVec3 = (p + q + r) / 3.0 + depth * inward;
        let place: Vec3 = probe.as_vec3();
        boxes_meet([place, place], room) && winding(&b.points, &b.triangles, probe) > 0.5
    })
}
