//! How a hull floats: centre of buoyancy, waterplane, metacentre.
use super::{Hull, HullDrag, faces::Faces, resistance::FaceDrag};
use crate::load::{BodyState, Motion, Pose, Surface};
use glam::{Vec2, Vec3};

/// The area in which the surface cuts a hull, as seen from above.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Waterplane {
    /// Area A, m².
    pub area: f32,
    /// Its centre (x, z), m: the centre of flotation.
    pub centre: Vec2,
    /// Second moments \[∫ x² dA, ∫ z² dA, ∫ x z dA\] about its centre, m⁴.
    pub second_moments: [f32; 3],
}

impl Waterplane {
    /// Smaller and larger second moment of area, m⁴: about the axis along the waterplane and the one across it, whichever way it lies.
    ///
    /// The eigenvalues of the symmetric matrix of the second moments.
    pub fn principal_moments(&self) -> [f32; 2] {
        let [xx, zz, xz] = self.second_moments;
        let (mean, reach) = (0.5 * (xx + zz), (0.5 * (xx - zz)).hypot(xz));
        [(mean - reach).max(0.0), mean + reach]
    }
}

/// How a hull floats in a given pose.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Flotation {
    /// Volume V of the water displaced, m³.
    pub volume: f32,
    /// Centre of the water displaced in the world, m. Its height is exact on water that is flat over the hull.
    pub centre_of_buoyancy: Vec3,
    /// Where the surface cuts the hull; none while it is wholly submerged.
    pub waterplane: Waterplane,
}

impl Flotation {
    /// Height of the transverse metacentre over the centre of buoyancy, m: BM = I/V, I being the smaller second moment of the
    /// waterplane (Bouguer, *Traité du navire*, 1746; Lewis (ed.), *Principles of Naval Architecture* I, 1988, chapter II).
    pub fn metacentric_radius(&self) -> f32 {
        self.waterplane.principal_moments()[0] / self.volume
    }

    /// The transverse metacentre M in the world, m. As long as it lies above the centre of mass a small heel is righted; without a
    /// waterplane it is the centre of buoyancy.
    pub fn metacentre(&self) -> Vec3 {
        self.centre_of_buoyancy + Vec3::Y * self.metacentric_radius()
    }

    /// Height GM of the metacentre over the centre of mass (world, m), m: at a small heel φ the hull is righted by ρ g V GM φ.
    pub fn metacentric_height(&self, centre_of_mass: Vec3) -> f32 {
        self.metacentre().y - centre_of_mass.y
    }
}

impl Hull {
    /// How the hull floats where `pose` puts it, or `None` if it is out of the water.
    ///
    /// `surface` gives the water at a world (x, z), or `None` where there is none. The hull is cut as for [`Hull::load`].
    pub fn flotation(&self, pose: &Pose, surface: impl FnMut(Vec2) -> Option<Surface>) -> Option<Flotation> {
        let body = self.at_rest(pose);
        let mut points = Vec::with_capacity(self.points.len());
        let around = self.look_up(&body, &mut points, surface)?;
        // Nothing resists: only geometry is asked for.
        let drag = FaceDrag::new(&HullDrag::default(), 0.0, 0.0, self.length(), 0.0);
        let sums = self.wetted(&points, Faces::new(Motion::default(), around.base, drag));
        let volume = sums.push().0.y.min(self.volume);
        if volume <= super::load::LEAST_SHARE * self.volume {
            return None;
        }
        let waterplane = sums.waterplane().unwrap_or_default();
        Some(Flotation {
            volume,
            centre_of_buoyancy: body.centre + around.centre_of_buoyancy(&sums),
            waterplane: Waterplane {
                centre: waterplane.centre + Vec2::new(body.centre.x, body.centre.z),
                ..waterplane
            },
        })
    }

    /// A body of this hull that lies still at `pose`, seen from its centroid.
    pub(super) fn at_rest(&self, pose: &Pose) -> BodyState {
        BodyState { pose: *pose, centre: pose.position + pose.rotation * self.centroid, motion: Motion::default() }
    }
}
