//! A floating body: its hull, built from its colliders or its mesh, and the mass that follows from it.

use super::{
    contact::{Contact, Felt},
    exchange::Exchanging,
    floating::{Buoyancy, BuoyancyModel, Floating, Weight},
    footprint::Footprint,
    force::{Lent, Loan, Rest},
    form::Form,
    held::Held,
    solid::{Flaw, Solid},
};
use crate::report::Reported;
use bevy::{asset::AssetId, prelude::*};
use bevy_rapier3d::{
    parry::{mass_properties::MassProperties, math::Pose, shape::SharedShape},
    plugin::context::{RapierContextColliders, RapierContextEntityLink, RapierRigidBodySet},
    prelude::{MassModifiedEvent, RapierRigidBodyHandle},
    rapier::prelude::{ColliderSet, RigidBody},
};
use freshet_hydro::hull::HullDrag;
use std::{ops::RangeInclusive, sync::Arc};

/// State of a floating body between systems.
#[derive(Component, Default)]
pub(crate) struct Body {
    /// What the hull was built from, and how.
    source: Source,
    made: Option<(BuoyancyModel, usize)>,
    /// Solids of the body, for its bounding box.
    pub(super) solids: Vec<Solid>,
    /// The hull; none until built, or if the body has no volume.
    pub(super) form: Option<Form>,
    /// Mass that `Weight` asks for; none if Rapier's own counts.
    mass: Option<MassProperties>,
    /// Checked settings.
    pub(super) drag: HullDrag,
    /// Share of the hull that was under water in the step before; none before the first.
    pub(super) submerged: Option<f32>,
    /// Water around the body, looked up in this step.
    pub(super) footprint: Footprint,
    /// What the solver is to get for the coming step.
    pub(super) loan: Option<Loan>,
    /// What it has to give back after the step.
    pub(super) lent: Option<Lent>,
    /// What it and simulated water do to each other.
    pub(super) exchanging: Exchanging,
    /// What held the body when it was last awake.
    pub(super) rest: Rest,
    /// What joints and contacts did to it.
    pub(super) held: Held,
    /// What it felt in this step, if it is awake.
    pub(super) felt: Option<Felt>,
    /// How it and the surface met so far.
    pub(super) contact: Contact,
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

impl Body {
    /// Follows the settings and what the hull is built from. False while its mesh still loads.
    fn follow(
        &mut self,
        entity: Entity,
        floating: &Floating,
        source: Source,
        meshes: Option<&Assets<Mesh>>,
        buoyancy: &mut Buoyancy,
        reported: &mut Reported,
    ) -> bool {
        let (model, most) = resolve_model(entity, floating, reported);
        if source != self.source || self.made != Some((model, most)) {
            let mut report = |flaw: Flaw| reported.warn(entity, "Floating: a shape", flaw);
            let Some(solids) = source.solids(meshes, &mut report) else {
                // An empty source asks again in the next step.
                self.source = Source::None;
                return false;
            };
            (self.source, self.made) = (source, Some((model, most)));
            if let Err(problem) = self.build(solids, model, most, &mut report) {
                reported.warn(entity, "Floating", problem);
            }
            match &self.form {
                Some(form) => buoyancy.volume = form.hull.volume(),
                None => *buoyancy = Buoyancy::default(),
            }
        }
        self.drag = resolve_drag(entity, floating, reported);
        self.mass = self.resolve_mass(entity, floating, reported);
        true
    }

    /// Makes the hull of the solids; without any there is none, and the body falls through the water.
    fn build(
        &mut self,
        solids: Vec<Solid>,
        model: BuoyancyModel,
        most: usize,
        report: &mut impl FnMut(Flaw),
    ) -> Result<(), String> {
        self.form = None;
        self.submerged = None;
        self.contact.forget_step();
        self.solids = solids;
        if self.solids.is_empty() {
            return Err("has neither a collider nor a mesh with a volume; the body does not float".into());
        }
        let form = Form::new(&self.solids, model, most, report);
        self.form = Some(form.map_err(|problem| format!("{problem}; the body does not float"))?);
        Ok(())
    }

    /// The mass that the settings ask for, if they do: that of a homogeneous hull, with its centre moved if they say so.
    fn resolve_mass(&self, entity: Entity, floating: &Floating, reported: &mut Reported) -> Option<MassProperties> {
        let hull = &self.form.as_ref()?.hull;
        let volume = hull.volume();
        let mass = match floating.weight {
            Weight::Density(density) => {
                volume * reported.clamp(entity, "Floating::weight (density)", density, 1.0..=3e4, 500.0)
            }
            Weight::Mass(mass) => reported.clamp(entity, "Floating::weight (mass)", mass, 1e-6..=1e12, 500.0 * volume),
            Weight::Rapier => return None,
        };
        let center = floating.center_of_mass.unwrap_or(hull.centroid());
        let center = if center.is_finite() {
            center
        } else {
            reported.warn(entity, "Floating::center_of_mass", "is not finite; the hull's own counts");
            hull.centroid()
        };
        Some(MassProperties::with_inertia_matrix(center, mass, hull.unit_inertia() * mass))
    }

    /// The edge of a cube of the hull's volume, m.
    pub(super) fn length(&self) -> f32 {
        self.form.as_ref().map_or(0.0, |form| form.hull.length())
    }

    /// Gives `body` this mass in place of its colliders'.
    fn apply_mass(properties: MassProperties, body: &mut RigidBody, colliders: &mut ColliderSet) {
        for handle in body.colliders() {
            if let Some(collider) = colliders.get_mut(*handle) {
                collider.set_density(0.0);
            }
        }
        body.set_additional_mass_properties(properties, true);
        body.recompute_mass_properties_from_colliders(colliders);
    }
}

/// Checked model, and how many triangles a hull may have.
fn resolve_model(entity: Entity, floating: &Floating, reported: &mut Reported) -> (BuoyancyModel, usize) {
    let mut whole = |field, value: u32, range: RangeInclusive<f32>, usual| {
        reported.clamp(entity, field, value as f32, range, usual) as u32
    };
    let most = whole("Floating::max_triangles", floating.max_triangles, 12.0..=20_000.0, 400.0);
    let model = match floating.model {
        BuoyancyModel::Hull => BuoyancyModel::Hull,
        BuoyancyModel::Voxels { per_axis } => {
            BuoyancyModel::Voxels { per_axis: whole("BuoyancyModel::Voxels::per_axis", per_axis, 1.0..=16.0, 4.0) }
        }
        BuoyancyModel::Samples { spacing } => BuoyancyModel::Samples {
            spacing: reported.clamp(entity, "BuoyancyModel::Samples::spacing", spacing, 1e-3..=1e3, 0.1),
        },
    };
    (model, most as usize)
}

/// Checked drag settings.
fn resolve_drag(entity: Entity, floating: &Floating, reported: &mut Reported) -> HullDrag {
    let usual = HullDrag::default();
    let mut clamp = |field, value, most, usual| reported.clamp(entity, field, value, 0.0..=most, usual);
    HullDrag {
        friction: clamp("Floating::friction", floating.friction, 100.0, usual.friction),
        bluff: clamp("Floating::bluff_drag", floating.bluff_drag, 100.0, usual.bluff),
        fair: clamp("Floating::fair_drag", floating.fair_drag, 100.0, usual.fair),
        radiation: clamp("Floating::radiation", floating.radiation, 10.0, usual.radiation),
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
        &mut Body,
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
    for (entity, floating, handle, link, mesh, transform, mut state, mut buoyancy) in &mut bodies {
        let Ok((mut set, mut colliders)) = contexts.get_mut(link.0) else { continue };
        let Some(body) = set.bodies.get(handle.0) else { continue };

        if matches!(state.source, Source::Mesh(id, _) if modified.contains(&id)) {
            state.source = Source::None;
        }
        let source = Source::of(body, &colliders.colliders, mesh, transform.scale());
        if (source != state.source || floating.is_changed())
            && !state.follow(entity, &floating, source, meshes.as_deref(), &mut buoyancy, &mut reported)
        {
            continue;
        }

        // Also when a game has since given the body another mass: `Weight` decides.
        let differs = |wanted: &MassProperties| {
            let mass = wanted.mass();
            let off_center = body.local_center_of_mass().distance(wanted.local_com);
            (body.mass() - mass).abs() > 1e-4 * mass || off_center > 1e-3 * state.length()
        };
        if let Some(mass) = state.mass.filter(|mass| body.is_dynamic() && differs(mass))
            && let Some(body) = set.bodies.get_mut(handle.0)
        {
            Body::apply_mass(mass, body, &mut colliders.colliders);
            mass_modified.write(entity.into());
        }
    }
}
