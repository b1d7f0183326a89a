//! From a list of triangles to a surface whose triangles share their points.

use super::{HullError, bounds};
use glam::{DVec3, IVec3, Vec3};
use std::collections::{BTreeMap, HashMap};

/// Points nearer than this share of the bounding box's diagonal are one: ten times what an `f32` is rounded by.
const TOLERANCE: f64 = 1e-6;

/// Points without doubles, and the triangles between them.
///
/// Triangles with two corners in one point are dropped: their other two edges close upon each other. Thin ones between three points
/// are kept, since their neighbours hang on them.
pub(super) fn welded(points: &[Vec3], triangles: &[[u32; 3]]) -> Result<(Vec<Vec3>, Vec<[u32; 3]>), HullError> {
    check(points, triangles)?;
    let mut used = vec![false; points.len()];
    triangles.as_flattened().iter().for_each(|&point| used[point as usize] = true);
    let mut weld = Weld::new(points.iter().zip(&used).filter_map(|(&point, &used)| used.then_some(point)));
    let merged: Vec<u32> =
        points.iter().zip(&used).map(|(&point, &used)| if used { weld.index(point) } else { 0 }).collect();
    let triangles = triangles
        .iter()
        .map(|triangle| triangle.map(|point| merged[point as usize]))
        .filter(|&[a, b, c]| a != b && b != c && c != a);
    Ok((weld.points, without_doubles(triangles)))
}

fn check(points: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), HullError> {
    if triangles.is_empty() {
        return Err(HullError::NoTriangles);
    }
    if let Some(point) = points.iter().position(|point| !point.is_finite()) {
        return Err(HullError::NotFinite(point));
    }
    let beyond = |&point: &u32| point as usize >= points.len();
    match triangles.as_flattened().iter().position(beyond) {
        Some(corner) => Err(HullError::Index {
            triangle: corner / 3,
            point: triangles.as_flattened()[corner],
            points: points.len(),
        }),
        None => Ok(()),
    }
}

/// Points met so far, in the cells of a lattice.
struct Weld {
    points: Vec<Vec3>,
    cells: HashMap<IVec3, Vec<u32>>,
    origin: DVec3,
    tolerance: f64,
}

impl Weld {
    fn new(points: impl Iterator<Item = Vec3>) -> Self {
        let [min, max] = bounds(&points.collect::<Vec<_>>()).map(|corner| corner.as_dvec3());
        // Far from the origin points are coarser than the body is small; the last limit keeps the division defined.
        let coarse = min.abs().max(max.abs()).max_element() * f64::from(f32::EPSILON);
        let tolerance = ((max - min).length() * TOLERANCE).max(coarse).max(f64::MIN_POSITIVE);
        Self { points: Vec::new(), cells: HashMap::new(), origin: min, tolerance }
    }

    /// The index of the first point met here, which may be this one.
    ///
    /// Cells are four tolerances wide. Two points that are one may still lie in neighbouring cells, so all cells are searched that
    /// the tolerance reaches into: up to eight.
    fn index(&mut self, point: Vec3) -> u32 {
        let place = (point.as_dvec3() - self.origin) / (4.0 * self.tolerance);
        let (low, high) = ((place - 0.25).floor().as_ivec3(), (place + 0.25).floor().as_ivec3());
        for cell in cells(low, high) {
            let here = self.cells.get(&cell).into_iter().flatten();
            for &other in here {
                let apart = (self.points[other as usize].as_dvec3() - point.as_dvec3()).abs().max_element();
                if apart <= self.tolerance {
                    return other;
                }
            }
        }
        let index = self.points.len() as u32;
        self.points.push(point);
        self.cells.entry(place.floor().as_ivec3()).or_default().push(index);
        index
    }
}

/// All cells of a small block.
fn cells(low: IVec3, high: IVec3) -> impl Iterator<Item = IVec3> {
    (low.z..=high.z)
        .flat_map(move |z| (low.y..=high.y).flat_map(move |y| (low.x..=high.x).map(move |x| IVec3::new(x, y, z))))
}

/// The triangles without those that lie on each other.
///
/// Two triangles on the same points are a wall between two parts that touch, and go both; unless the whole mesh is of such pairs:
/// then it is one that was given twice, or with a back side, and one of each stays.
fn without_doubles(triangles: impl Iterator<Item = [u32; 3]>) -> Vec<[u32; 3]> {
    let triangles: Vec<_> = triangles.collect();
    let mut times = BTreeMap::<[u32; 3], usize>::new();
    for &triangle in &triangles {
        *times.entry(sorted(triangle)).or_default() += 1;
    }
    let all_paired = times.values().all(|times| times % 2 == 0);
    let mut kept = Vec::with_capacity(triangles.len());
    for triangle in triangles {
        // The first of each stays, if any; what is left of its count is zero then.
        let times = times.entry(sorted(triangle)).or_default();
        if all_paired && *times > 0 || *times % 2 == 1 {
            kept.push(triangle);
            *times = 0;
        }
    }
    kept
}

fn sorted(mut triangle: [u32; 3]) -> [u32; 3] {
    triangle.sort_unstable();
    triangle
}
