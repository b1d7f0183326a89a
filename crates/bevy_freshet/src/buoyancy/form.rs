//! What a body looks like to the water, in the model that its settings choose.
use super::{
    floating::BuoyancyModel,
    solid::{Flaw, Solid, hull_of, voxelize},
};
use bevy::prelude::*;
use freshet_hydro::{
    hull::{Hull, HullDrag, HullPoint},
    load::{Fluid, Load, Motion, Pose, Surface},
    samples::SampleHull,
    voxels::{Drag, VoxelHull},
};

/// Share of a hull's length that its edges have at most, so that waves as long as the hull bend the waterline.
const LONGEST_EDGE: f32 = 0.5;

/// A hull, and what its model makes of it.
pub(super) struct Form {
    /// The solid: its volume, centre and moments are those of the body in every model.
    pub hull: Hull,
    model: Model,
}

enum Model {
    /// The hull itself, with room for its points.
    Hull(Vec<HullPoint>),
    Voxels(VoxelHull),
    Samples(SampleHull),
}

impl Form {
    /// The hull of `solids` and what the settings make of it.
    pub fn new(
        solids: &[Solid],
        model: BuoyancyModel,
        most: usize,
        report: &mut impl FnMut(Flaw),
    ) -> Result<Self, String> {
        let hull = hull_of(solids, report).map_err(|error| error.to_string())?.simplified(most);
        let model = match model {
            BuoyancyModel::Hull => Model::Hull(Vec::with_capacity(hull.points().len())),
            BuoyancyModel::Voxels { per_axis } => {
                let voxels = voxelize(solids, per_axis).and_then(|voxels| voxels.with_volume(hull.volume()));
                Model::Voxels(voxels.map_err(|error| error.to_string())?)
            }
            BuoyancyModel::Samples { spacing } => Model::Samples(SampleHull::new(&hull, spacing)),
        };
        let longest = LONGEST_EDGE * hull.length();
        let hull = if matches!(model, Model::Hull(_)) { hull.refined(longest, most) } else { hull };
        Ok(Self { hull, model })
    }

    /// What the water does to it; see [`Hull::load`].
    pub fn load(
        &mut self,
        pose: &Pose,
        centre: Vec3,
        motion: &Motion,
        fluid: &Fluid,
        drag: &HullDrag,
        surface: impl FnMut(Vec2) -> Option<Surface>,
    ) -> Load {
        // A hull's coefficients hold for its faces; models without faces have the mean for the body.
        let whole = Drag { damping: drag.radiation, coefficient: 0.5 * (drag.bluff + drag.fair) };
        match &mut self.model {
            Model::Hull(points) => self.hull.load(pose, centre, motion, fluid, drag, points, surface),
            Model::Voxels(voxels) => voxels.load(pose, centre, motion, fluid, &whole, surface),
            Model::Samples(samples) => samples.load(pose, centre, motion, fluid, &whole, surface),
        }
    }
}
