//! Silhouettes of bodies at the waterline.
use super::{
    body::{BodyMotion, DisturbsWater},
    push,
    shape::{Flaw, Shape, Shapes},
};
use crate::{
    body::{ResolvedWater, WaterSimulation},
    report::Reported,
    simulation::{Deposits, FieldWindow, SilhouetteCell, Simulated},
};
use bevy::{math::Affine3A, mesh::skinning::SkinnedMesh, prelude::*};
use freshet_hydro::{
    grid::{Grid, Raster},
    silhouette::Section,
    waves::WaveTrain,
};
use std::sync::Arc;

/// Most places along an axis at which the waves are looked up for one body.
const MOST_PLACES: f32 = 9.0;

/// Root mean square error of the height of the waves that is allowed for, as a share of a cell.
const HEIGHT_ERROR: f32 = 0.1;

/// Most that the mean draft of a section can be of the body's depth under water. Where less than a quarter of a body's
/// width still shows, its displaced volume goes to zero with its section, instead of vanishing in one frame when it dives.
const MOST_DRAFT: f32 = 4.0;

/// A mesh of a body and its pose.
type Part = (Arc<Shape>, Affine3A);

/// Finds the meshes of bodies.
#[derive(bevy::ecs::system::SystemParam)]
pub(super) struct Parts<'w, 's> {
    meshes: Query<'w, 's, (&'static Mesh3d, &'static GlobalTransform, Has<SkinnedMesh>)>,
    children: Query<'w, 's, &'static Children>,
    bodies: Query<'w, 's, (), With<DisturbsWater>>,
    assets: Option<Res<'w, Assets<Mesh>>>,
    events: MessageReader<'w, 's, AssetEvent<Mesh>>,
    shapes: Local<'s, Shapes>,
    reported: ResMut<'w, Reported>,
}

impl Parts<'_, '_> {
    /// Collects the meshes of `body`: its own and its descendants', up to those that are bodies themselves.
    fn collect(&mut self, body: Entity, parts: &mut Vec<Part>) {
        parts.clear();
        let Some(assets) = &self.assets else { return };
        let mut open = vec![body];
        while let Some(entity) = open.pop() {
            if let Ok(children) = self.children.get(entity) {
                open.extend(children.iter().filter(|child| !self.bodies.contains(*child)));
            }
            let Ok((mesh, pose, skinned)) = self.meshes.get(entity) else { continue };
            let shape = if skinned { Some(Err(Flaw::Skinned)) } else { self.shapes.get(mesh.id(), assets) };
            match shape {
                Some(Ok(shape)) if pose.affine().is_finite() => parts.push((shape, pose.affine())),
                Some(Err(flaw)) => self.reported.warn(entity, "Mesh3d", flaw),
                _ => {}
            }
        }
    }
}

/// A water and what bodies do to it.
#[derive(bevy::ecs::query::QueryData)]
#[query_data(mutable)]
pub(super) struct Disturbed {
    entity: Entity,
    water: &'static ResolvedWater,
    window: &'static FieldWindow,
    deposits: &'static mut Deposits,
    simulated: Option<(&'static WaterSimulation, &'static mut Simulated)>,
}

impl DisturbedItem<'_, '_> {
    /// The cells of rings and foam, and those of the simulation if bodies push it.
    fn rasters(&self) -> [Option<Raster>; 2] {
        let field = self.window.raster();
        let pushed = self.simulated.as_ref().filter(|(settings, _)| settings.push != 0.0);
        let simulation = pushed.and_then(|(_, simulated)| simulated.raster());
        [(field.size.min_element() > 0).then_some(field), simulation]
    }
}

/// Draws the silhouettes of all bodies to the windows of all waters, and lets them push simulated ones.
pub(super) fn draw_silhouettes(
    mut bodies: Query<(Entity, &mut BodyMotion), With<DisturbsWater>>,
    mut waters: Query<Disturbed>,
    mut parts: Parts,
    mut pen: Local<Pen>,
) {
    let Parts { shapes, events, .. } = &mut parts;
    shapes.refresh(events.read());
    for mut water in &mut waters {
        if let Some((_, simulated)) = &mut water.simulated {
            simulated.pushes.clear();
        }
    }
    if waters.iter_mut().all(|water| water.rasters().iter().all(Option::is_none)) {
        return;
    }
    let mut found = Vec::new();
    for (entity, mut motion) in &mut bodies {
        motion.section = None;
        parts.collect(entity, &mut found);
        for mut water in &mut waters {
            if let Some(centroid) = pen.draw(&found, &motion, &mut water, &mut parts.reported) {
                motion.section = Some((water.entity, centroid));
            }
        }
    }
    for mut water in &mut waters {
        merge(&mut water.deposits.silhouettes);
    }
}

/// What drawing needs again and again.
#[derive(Default)]
pub(super) struct Pen {
    section: Section,
    vertices: Vec<Vec3>,
}

/// A section of a body with the water.
struct Cut {
    area: f32,
    centroid: Vec2,
    /// Mean draft, m.
    draft: f32,
}

impl Pen {
    /// Hands a water the cells that a body of `parts` covers, and gives the centroid of its section (local xz, m) if it is within
    /// those of rings and foam.
    fn draw(
        &mut self,
        parts: &[Part],
        motion: &BodyMotion,
        disturbed: &mut DisturbedItem,
        reported: &mut Reported,
    ) -> Option<Vec2> {
        let (water, rasters) = (disturbed.water, disturbed.rasters());
        // Heights in this frame are those over the still surface.
        let surface_from_world = water.pose().compute_affine().inverse();
        let (min, max) = bounds(parts, surface_from_world)?;
        let (lowest, highest) = water.elevations();
        if min.y >= highest || max.y < lowest {
            return None;
        }
        let [field, simulation] = rasters.map(|raster| raster.filter(|raster| raster.meets(min.xz(), max.xz())));
        let finest = [field, simulation].iter().flatten().map(|raster| raster.cell).reduce(f32::min)?;
        let waves = Lattice::over(water, min.xz(), max.xz(), HEIGHT_ERROR * finest);
        self.cut(parts, surface_from_world, &waves);
        let cut = self.measure()?;
        let exchanges = motion.exchanges_with == Some(disturbed.entity);
        if let (Some(raster), Some((settings, simulated))) =
            (simulation.filter(|_| !exchanges), &mut disturbed.simulated)
        {
            let factor = settings.usable_push(disturbed.entity, reported);
            // The uniform current is added to the simulated one: bodies that drift with it push nothing.
            let relative = |cell: SilhouetteCell| SilhouetteCell { velocity: cell.velocity - water.drift, ..cell };
            let cells = self.cells(&raster, &cut, motion, water).map(relative);
            push::push(cells, factor, cut.area, raster.size, &mut simulated.pushes);
        }
        // What the simulation raises need not be raised again.
        let raises = if exchanges && motion.is_resolved { 0.0 } else { 1.0 };
        let field = field?;
        let cells = self.cells(&field, &cut, motion, water);
        disturbed.deposits.silhouettes.extend(cells.map(|cell| SilhouetteCell { draft: raises * cell.draft, ..cell }));
        Some(cut.centroid)
    }

    /// What the last cut has come to; nothing if it is empty.
    fn measure(&self) -> Option<Cut> {
        let (area, centroid) = self.section.area_and_centroid()?;
        let draft = (self.section.volume() / area).clamp(0.0, MOST_DRAFT * self.section.depth());
        Some(Cut { area, centroid, draft })
    }

    /// The wet cells of a raster that the last cut covers.
    fn cells(
        &self,
        raster: &Raster,
        cut: &Cut,
        motion: &BodyMotion,
        water: &ResolvedWater,
    ) -> impl Iterator<Item = SilhouetteCell> {
        let cover = self.section.cover(raster.origin, raster.cell, raster.size);
        let cells: Vec<_> = cover.cells().collect();
        cells.into_iter().filter_map(|(cell, cover)| {
            let place = raster.middle(cell.as_ivec2());
            if water.still_depth(place) <= 0.0 || !water.covers(place) {
                return None;
            }
            let world = water.world_from_local.transform_point2(place);
            let velocity = motion.at(vec3(world.x, water.level, world.y));
            let velocity = water.local_from_world.transform_vector2(velocity.xz());
            Some(SilhouetteCell { cell, cover, draft: cover * cut.draft, velocity })
        })
    }

    /// Cuts the meshes with the waves.
    fn cut(&mut self, parts: &[Part], surface_from_world: Affine3A, waves: &Lattice) {
        self.section.clear();
        for (shape, pose) in parts {
            let surface_from_mesh = surface_from_world * *pose;
            self.vertices.clear();
            self.vertices.extend(shape.vertices.iter().map(|&vertex| {
                let vertex = surface_from_mesh.transform_point3(vertex);
                // Grids take finite places only.
                if vertex.is_finite() { vertex - Vec3::Y * waves.at(vertex.xz()) } else { Vec3::NAN }
            }));
            let mirrored = surface_from_mesh.matrix3.determinant() < 0.0;
            let turned = |&[a, b, c]: &[u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
            self.section.add(&self.vertices, shape.triangles.iter().map(turned));
        }
    }
}

/// Corners of the box around all parts, in the frame of the surface.
fn bounds(parts: &[Part], surface_from_world: Affine3A) -> Option<(Vec3, Vec3)> {
    let bounds = parts.iter().map(|(shape, pose)| {
        let surface_from_mesh = surface_from_world * *pose;
        let center = surface_from_mesh.transform_point3(shape.center);
        let half = Mat3::from(surface_from_mesh.matrix3.abs()) * shape.half;
        (center - half, center + half)
    });
    bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).filter(|(min, max)| min.is_finite() && max.is_finite())
}

/// Heights of the waves around a body, looked up at a few places: a search in the waves costs more than many triangles.
#[derive(Default)]
struct Lattice {
    center: Vec2,
    /// None on level water.
    heights: Option<Grid<f32>>,
}

impl Lattice {
    /// Heights over the still surface between the corners `min` and `max`, right within `error` (m) except under large
    /// bodies.
    ///
    /// Linear interpolation of A cos(k x) over a step h errs by `h² k² A / 8` at most; the trains' errors are independent.
    fn over(water: &ResolvedWater, min: Vec2, max: Vec2, error: f32) -> Self {
        let trains = &water.waves.trains;
        let curvature = |train: &WaveTrain| train.wave_vector.length_squared() * train.amplitude;
        let curvature = (0.5 * trains.iter().map(|train| curvature(train).powi(2)).sum::<f32>()).sqrt();
        if curvature <= 0.0 && water.ice.is_none() {
            return Self::default();
        }
        let (center, size) = (0.5 * (min + max), max - min);
        let least = size.max_element() / (MOST_PLACES - 1.0);
        // The front of ice is a step of its own.
        let widest = if water.ice.is_some() { least } else { (8.0 * error / curvature).sqrt() };
        let step = widest.max(least).min(size.max_element());
        let places = (size / step).ceil() + 1.0;
        let place = |cell: UVec2| center + (cell.as_vec2() + 0.5 - places / 2.0) * step;
        let heights = Grid::from_fn(places.as_uvec2(), step, |cell| water.surface(place(cell)));
        Self { center, heights: heights.ok() }
    }

    /// Height at local `place`, bilinear.
    fn at(&self, place: Vec2) -> f32 {
        self.heights.as_ref().map_or(0.0, |heights| heights.sample(place - self.center))
    }
}

/// Puts what several bodies say of one cell together: covers add up to one at most, drafts add up, velocities are averaged
/// by cover.
fn merge(cells: &mut Vec<SilhouetteCell>) {
    cells.sort_by_key(|cell| (cell.cell.y, cell.cell.x));
    cells.dedup_by(|next, kept| {
        let same = next.cell == kept.cell;
        if same {
            let cover = kept.cover + next.cover;
            kept.velocity = kept.velocity.lerp(next.velocity, next.cover / cover);
            kept.cover = cover;
            kept.draft += next.draft;
        }
        same
    });
    cells.iter_mut().for_each(|cell| cell.cover = cell.cover.min(1.0));
}
