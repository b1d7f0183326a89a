//! What a body looks like to the water, in the model that its settings choose.
use super::{
    floating::BuoyancyModel,
    footprint::Footprint,
    solid::{Flaw, Solid, hull_of, voxelize},
};
use freshet_hydro::{
    hull::{Hull, HullDrag, HullPoint},
    load::{BodyState, Fluid, Load},
    samples::SampleHull,
    voxels::{Drag, VoxelHull},
};

/// Share of a hull's length that its edges have at most, so that waves as long as the hull bend the waterline.
const LONGEST_EDGE: f32 = 0.5;

/// Share of critical damping by which a ball of radiation 1 stops heaving, for models without faces: 0.114/0.67.
const DAMPING: f32 = 0.17;

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
    pub fn load(&mut self, body: &BodyState, fluid: &Fluid, drag: &HullDrag, footprint: &Footprint) -> Load {
        // A hull's coefficients hold for its faces; models without faces have the mean of both.
        let whole = Drag { damping: DAMPING * drag.radiation, coefficient: 0.5 * (drag.bluff + drag.fair) };
        let surface = |at| footprint.lattice.at(at);
        match &mut self.model {
            Model::Hull { finer, points } => {
                let hull = if footprint.lattice.is_flat() { &self.hull } else { &*finer };
                hull.load_on(body, fluid, drag, points, &footprint.lattice)
            }
            Model::Voxels(voxels) => voxels.load(body, fluid, &whole, surface),
            Model::Samples(samples) => samples.load(body, fluid, &whole, surface),
        }
    }
}
