//! Floating bodies as points on their surface, after Stegen, *Simulating real-time interactions between water and dynamic objects*,
//! Howest 2022 \[S22\].
//!
//! Points are scattered over the faces, none nearer to another than a spacing; each carries the same share of the volume and is pushed
//! up by its weight in water once it is under the surface. Kept so that the error of [`Hull`] and
//! [`voxels`](crate::voxels) can be compared with it.
use crate::{
    hull::Hull,
    load::{BodyState, Fluid, Load, Surface},
    voxels::Drag,
};
use glam::{Mat3, Vec2, Vec3};

/// Most points of a body.
pub const MAX_POINTS: usize = 4096;
/// Candidates for each point that would fit.
const CANDIDATES: usize = 12;

/// A body as points on its surface, in its own frame.
#[derive(Debug, Clone, PartialEq)]
pub struct SampleHull {
    points: Vec<Vec3>,
    volume: f32,
    /// Mean area of the body's shadow, m²: a quarter of a convex body's surface (Cauchy).
    shadow: f32,
    length: f32,
}

impl SampleHull {
    /// Scatters points over `hull`, none nearer to another than `spacing` (m, positive; 0.2 of the body's length if it is not). The same
    /// hull gets the same points.
    pub fn new(hull: &Hull, spacing: f32) -> Self {
        let spacing = if spacing > 0.0 { spacing } else { 0.2 * hull.length() };
        let faces: Vec<[Vec3; 3]> = hull.triangles()[..hull.shared()]
            .iter()
            .map(|triangle| triangle.map(|index| hull.points()[index as usize]))
            .collect();
        let areas: Vec<f32> = faces.iter().map(|[a, b, c]| 0.5 * (*b - *a).cross(*c - *a).length()).collect();
        let area: f32 = areas.iter().sum();
        let wanted = (CANDIDATES as f32 * area / (spacing * spacing)).clamp(32.0, (4 * MAX_POINTS) as f32);
        let mut points: Vec<Vec3> = Vec::new();
        let mut candidate = 0.0_f32;
        for ([a, b, c], area_of) in faces.iter().zip(&areas) {
            let first = candidate;
            candidate += wanted * area_of / area;
            for k in first.ceil() as usize..candidate.ceil() as usize {
                let [u, v] = quasi_random(k);
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                let point = *a + (*b - *a) * u + (*c - *a) * v;
                let is_free = points.iter().all(|other| other.distance_squared(point) >= spacing * spacing);
                if is_free && points.len() < MAX_POINTS {
                    points.push(point);
                }
            }
        }
        Self { points, volume: hull.volume(), shadow: 0.25 * hull.area(), length: hull.length() }
    }

    /// The points, m.
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// What the water does to `body`, about its centre of mass.
    pub fn load(
        &self,
        body: &BodyState,
        fluid: &Fluid,
        drag: &Drag,
        mut surface: impl FnMut(Vec2) -> Option<Surface>,
    ) -> Load {
        let world_from_body = body.world_from_body();
        let (origin, centre) = (body.origin(), body.centre);
        let volume = self.volume / self.points.len().max(1) as f32;
        let linear = fluid.density * 2.0 * drag.damping * (fluid.gravity / self.length).sqrt() * volume;
        let quadratic = 0.5 * fluid.density * drag.coefficient * self.shadow * volume / self.volume;
        let mut load = Load::default();
        for point in &self.points {
            let arm = origin + world_from_body * *point;
            let Some(water) = surface(Vec2::new(centre.x + arm.x, centre.z + arm.z)) else { continue };
            if centre.y + arm.y > water.height {
                continue;
            }
            load.pressure.add_at(Vec3::Y * (fluid.density * fluid.gravity * volume), arm);
            let speed = body.passed_by(water.velocity, arm).length();
            let resistance = Mat3::from_diagonal(Vec3::splat(linear + quadratic * speed));
            load.resistance.add_at(resistance, arm);
            load.stream.add_at(resistance * water.velocity, arm);
            load.submerged_volume += volume;
            load.water_velocity += water.velocity * volume;
        }
        if load.submerged_volume > 0.0 {
            load.water_velocity /= load.submerged_volume;
        }
        load
    }
}

/// A point of the unit square; any run of them lies evenly (Roberts' R₂ sequence: multiples of 1/φ and 1/φ², φ³ = φ + 1).
fn quasi_random(k: usize) -> [f32; 2] {
    [0.754_877_666_246_693, 0.569_840_290_998_053].map(|step: f64| (0.5 + step * k as f64).fract() as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        load::Pose,
        waves::{GRAVITY, WATER_DENSITY},
    };

    #[test]
    fn points_keep_their_distance_and_share_the_volume() {
        let hull = Hull::cuboid(Vec3::new(1.0, 0.3, 0.5)).expect("a box");
        let spacing = 0.2;
        let samples = SampleHull::new(&hull, spacing);
        assert!(samples.points().len() > 60, "{} points", samples.points().len());
        for (k, point) in samples.points().iter().enumerate() {
            assert!(samples.points()[..k].iter().all(|other| other.distance(*point) >= spacing));
            let off = (point.abs() / Vec3::new(1.0, 0.3, 0.5)).max_element() - 1.0;
            assert!(off.abs() < 1e-5, "{point} is on the surface");
        }
        let pose = Pose { position: Vec3::NEG_Y * 5.0, ..Pose::default() };
        let body = BodyState { pose, centre: pose.position, ..BodyState::default() };
        let load = samples.load(&body, &Fluid::default(), &Drag::default(), |_| Some(Surface::default()));
        let push = WATER_DENSITY * GRAVITY * hull.volume();
        assert!((load.pressure.force.y / push - 1.0).abs() < 1e-4 && load.pressure.force.x == 0.0);
        assert_eq!(SampleHull::new(&hull, f32::NAN), SampleHull::new(&hull, 0.2 * hull.length()));
    }
}
