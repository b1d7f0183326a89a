//! What a body looks like to the water, in the model that its settings choose.
use super::{
    floating::BuoyancyModel,
    footprint::Footprint,
    solid::{Flaw, Solid, hull_of, voxelize},
};
use bevy::prelude::*;
use freshet_hydro::{
    hull::{Hull, HullDrag, HullPoint},
    load::{Fluid, Load, Motion, Pose},
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
    /// The hull itself, with room for its points, and with more of them for water that bends.
    Hull {
        finer: Hull,
        points: Vec<HullPoint>,
    },
    Voxels(VoxelHull),
    Samples(SampleHull),
}

impl Form {
    /// The hull of `solids`, of `most` triangles, and what `model` makes of it.
    pub fn new(
        solids: &[Solid],
        model: BuoyancyModel,
        most: usize,
        report: &mut impl FnMut(Flaw),
    ) -> Result<Self, String> {
        let hull = hull_of(solids, report).map_err(|error| error.to_string())?.simplified(most);
        let model = match model {
            BuoyancyModel::Hull => {
                let finer = hull.clone().refined(LONGEST_EDGE * hull.length(), most);
                Model::Hull { points: Vec::with_capacity(finer.points().len()), finer }
            }
            BuoyancyModel::Voxels { per_axis } => {
                let voxels = voxelize(solids, per_axis).and_then(|voxels| voxels.with_volume(hull.volume()));
                Model::Voxels(voxels.map_err(|error| error.to_string())?)
            }
            BuoyancyModel::Samples { spacing } => Model::Samples(SampleHull::new(&hull, spacing)),
        };
        Ok(Self { hull, model })
    }

    /// What the water of `footprint` does to it; see [`Hull::load`].
    pub fn load(
        &mut self,
        pose: &Pose,
        centre: Vec3,
        motion: &Motion,
        fluid: &Fluid,
        drag: &HullDrag,
        footprint: &Footprint,
    ) -> Load {
        // A hull's coefficients hold for its faces; models without faces have the mean, and such a share of critical damping as a hull
        // of that radiation comes to.
        let whole = Drag { damping: 0.3 * drag.radiation, coefficient: 0.5 * (drag.bluff + drag.fair) };
        let surface = |at| footprint.at(at);
        match &mut self.model {
            Model::Hull { finer, points } => {
                let hull = if footprint.is_flat() { &self.hull } else { &*finer };
                hull.load(pose, centre, motion, fluid, drag, points, surface)
            }
            Model::Voxels(voxels) => voxels.load(pose, centre, motion, fluid, &whole, surface),
            Model::Samples(samples) => samples.load(pose, centre, motion, fluid, &whole, surface),
        }
    }
}
