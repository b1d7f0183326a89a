//! The hull of a floating body: built from its colliders or its mesh, and the mass that follows from it.

use super::{
    floating::{Buoyancy, Floating, Weight},
    footprint::Footprint,
    force::{Lent, Rest},
    solid::{Flaw, Solid, voxelize},
};
use crate::report::Reported;
use bevy::{asset::AssetId, prelude::*};
use bevy_rapier3d::{
    parry::{mass_properties::MassProperties, math::Pose, shape::SharedShape},
    plugin::context::{RapierContextColliders, RapierContextEntityLink, RapierRigidBodySet},
    prelude::{MassModifiedEvent, RapierRigidBodyHandle},
    rapier::prelude::{ColliderSet, RigidBody},
};
use freshet_hydro::voxels::{Drag, VoxelHull};
use std::sync::Arc;

/// State of a floating body between systems.
#[derive(Component, Default)]
pub(crate) struct Hull {
    /// What the hull was built from.
    source: Source,
    /// Solids of the body, for its bounding box.
    pub(super) solids: Vec<Solid>,
    /// Cells; none until built, or if the body has no volume.
    pub(super) voxels: Option<VoxelHull>,
    /// Mass that `Weight` asks for, kg; none if Rapier's own counts.
    mass: Option<f32>,
    /// Checked settings.
    pub(super) drag: Drag,
    /// Water around the body, looked up in this step.
    pub(super) footprint: Footprint,
    /// What the solver has to give back after the step.
    pub(super) lent: Option<Lent>,
    /// What held the body when it was last awake.
    pub(super) rest: Rest,
}

/// What a hull is built from: it is stale when this has changed.
#[derive(Default, PartialEq)]
enum Source {
    /// Nothing yet.
    #[default]
    None,
    /// The shapes of the body's colliders.
    Colliders(Vec<Part>),
    /// A mesh and the scale of its entity.
    Mesh(AssetId<Mesh>, Vec3),
}

/// The shape of a collider in the body's frame. Shapes are equal if they are the same allocation, which this keeps alive.
struct Part {
    pose: Pose,
    shape: SharedShape,
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.pose == other.pose && Arc::ptr_eq(&self.shape.0, &other.shape.0)
    }
}

impl Source {
    /// What `body` is to be built from: its colliders with substance, as the solver has them, scaled, children and all,
    /// or else its mesh.
    fn of(body: &RigidBody, colliders: &ColliderSet, mesh: Option<&Mesh3d>, scale: Vec3) -> Self {
        let parts: Vec<Part> = body
            .colliders()
            .iter()
            .filter_map(|handle| colliders.get(*handle))
            .filter(|collider| collider.is_enabled() && !collider.is_sensor())
            .map(|collider| Part {
                pose: collider.position_wrt_parent().copied().unwrap_or(Pose::IDENTITY),
                shape: collider.shared_shape().clone(),
            })
            .collect();
        match mesh {
            _ if !parts.is_empty() => Self::Colliders(parts),
            Some(mesh) => Self::Mesh(mesh.id(), scale),
            None => Self::None,
        }
    }

    /// The solids of this source; none yet, if its mesh is still loading.
    fn solids(&self, meshes: Option<&Assets<Mesh>>, report: &mut impl FnMut(Flaw)) -> Option<Vec<Solid>> {
        let mut solids = Vec::new();
        match self {
            Self::None => {}
            Self::Colliders(parts) => {
                for part in parts {
                    Solid::collect(&part.shape, part.pose, &mut solids, report);
                }
            }
            Self::Mesh(id, scale) => solids.extend(Solid::from_mesh(meshes?.get(*id)?, *scale, report)),
        }
        Some(solids)
    }
}

impl Hull {
    /// Cuts the solids into voxels; without any there is no hull, and the body falls through the water.
    fn build(&mut self, solids: Vec<Solid>, cells_per_axis: u32) -> Result<(), String> {
        self.voxels = None;
        self.solids = solids;
        if self.solids.is_empty() {
            return Err("has neither a collider nor a mesh with a volume; the body does not float".into());
        }
        let hull =
            voxelize(&self.solids, cells_per_axis).map_err(|error| format!("{error}; the body does not float"))?;
        self.voxels = Some(hull);
        Ok(())
    }

    /// Mass (kg) that the settings ask for, if they do.
    fn resolve_mass(&self, entity: Entity, weight: Weight, reported: &mut Reported) -> Option<f32> {
        let volume = self.voxels.as_ref()?.volume();
        match weight {
            Weight::Density(density) => {
                Some(volume * reported.clamp(entity, "Floating::weight (density)", density, 1.0..=3e4, 500.0))
            }
            Weight::Mass(mass) => {
                let fallback = 500.0 * volume;
                Some(reported.clamp(entity, "Floating::weight (mass)", mass, 1e-6..=1e12, fallback))
            }
            Weight::Rapier => None,
        }
    }

    /// Gives `body` the mass, centre and inertia of a homogeneous hull, in place of its colliders'.
    fn apply_mass(&self, mass: f32, body: &mut RigidBody, colliders: &mut ColliderSet) {
        let Some(hull) = &self.voxels else { return };
        for handle in body.colliders() {
            if let Some(collider) = colliders.get_mut(*handle) {
                collider.set_density(0.0);
            }
        }
        let properties = MassProperties::with_inertia_matrix(hull.centroid(), mass, hull.unit_inertia() * mass);
        body.set_additional_mass_properties(properties, true);
        body.recompute_mass_properties_from_colliders(colliders);
    }
}

/// Checked drag settings.
fn resolve_drag(entity: Entity, floating: &Floating, reported: &mut Reported) -> Drag {
    let usual = Drag::default();
    let drag = floating.drag_coefficient;
    Drag {
        damping: reported.clamp(entity, "Floating::damping", floating.damping, 0.0..=10.0, usual.damping),
        coefficient: reported.clamp(entity, "Floating::drag_coefficient", drag, 0.0..=100.0, usual.coefficient),
    }
}

/// Builds the hulls of new bodies and of those whose shape has changed, and sets masses.
pub(super) fn build_hulls(
    mut bodies: Query<(
        Entity,
        Ref<Floating>,
        &RapierRigidBodyHandle,
        &RapierContextEntityLink,
        Option<&Mesh3d>,
        &GlobalTransform,
        &mut Hull,
        &mut Buoyancy,
    )>,
    mut contexts: Query<(&mut RapierRigidBodySet, &mut RapierContextColliders)>,
    meshes: Option<Res<Assets<Mesh>>>,
    mut mesh_events: MessageReader<AssetEvent<Mesh>>,
    mut mass_modified: MessageWriter<MassModifiedEvent>,
    mut reported: ResMut<Reported>,
) {
    let modified: Vec<AssetId<Mesh>> = mesh_events
        .read()
        .filter_map(|event| if let AssetEvent::Modified { id } = event { Some(*id) } else { None })
        .collect();
    for (entity, floating, handle, link, mesh, transform, mut hull, mut buoyancy) in &mut bodies {
        let Ok((mut set, mut colliders)) = contexts.get_mut(link.0) else { continue };
        let Some(body) = set.bodies.get(handle.0).filter(|body| body.is_dynamic()) else { continue };

        if matches!(hull.source, Source::Mesh(id, _) if modified.contains(&id)) {
            hull.source = Source::None;
        }
        let source = Source::of(body, &colliders.colliders, mesh, transform.scale());
        if source != hull.source || floating.is_changed() {
            let mut report = |flaw: Flaw| reported.warn(entity, "Floating: a shape", flaw);
            let Some(solids) = source.solids(meshes.as_deref(), &mut report) else {
                // The mesh still loads. An empty source asks again in the next step.
                hull.source = Source::None;
                continue;
            };
            hull.source = source;
            if let Err(problem) = hull.build(solids, floating.cells_per_axis) {
                reported.warn(entity, "Floating", problem);
            }
            hull.drag = resolve_drag(entity, &floating, &mut reported);
            hull.mass = hull.resolve_mass(entity, floating.weight, &mut reported);
            buoyancy.volume = hull.voxels.as_ref().map_or(0.0, VoxelHull::volume);
        }

        // Also when a game has since given the body another mass: `Weight` decides.
        if let Some(mass) = hull.mass.filter(|mass| (body.mass() - mass).abs() > 1e-4 * mass)
            && let Some(body) = set.bodies.get_mut(handle.0)
        {
            hull.apply_mass(mass, body, &mut colliders.colliders);
            mass_modified.write(entity.into());
        }
    }
}
