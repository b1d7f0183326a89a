//! Surface entities and the textures they share.
use super::{
    WaterSurface,
    detail::detail_tile,
    foam::foam_tile,
    gpu::GpuSurface,
    ice_tile::IceTile,
    material::SurfaceMaterial,
    mesh::nested_grid,
    ripples::Ripples,
    shape::{ShapeKey, SurfaceShape},
    viewer::Viewers,
};
use crate::{
    body::{ResolvedWater, WaterFoam, WaterLighting, WaterOptics},
    reflection::WaterReflection,
    report::Reported,
    simulation::{FieldPictures, FieldWindow},
};
use bevy::{
    asset::RenderAssetUsages,
    camera::{primitives::Aabb, visibility::RenderLayers},
    light::{NotShadowCaster, NotShadowReceiver},
    platform::collections::HashSet,
    prelude::*,
    render::{
        render_resource::{Extent3d, TextureDimension, TextureFormat},
        storage::ShaderBuffer,
    },
};
use freshet_hydro::grid::Grid;
use std::sync::Arc;

/// The surface of one water for one viewing camera.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct SurfaceOf {
    pub water: Entity,
    pub viewer: Entity,
}

/// Assets that all surfaces share.
#[derive(Resource)]
pub(crate) struct SurfaceAssets {
    detail: Handle<Image>,
    foam: Handle<Image>,
    /// Those used last come last.
    meshes: Vec<(ShapeKey, Handle<Mesh>)>,
}

/// Meshes kept though no surface uses them: a viewer that rises and sinks comes back to them.
const SPARE_MESHES: usize = 6;

impl FromWorld for SurfaceAssets {
    fn from_world(world: &mut World) -> Self {
        let mut images = world.resource_mut::<Assets<Image>>();
        let (detail, foam) = (images.add(detail_tile()), images.add(foam_tile()));
        Self { detail, foam, meshes: Vec::new() }
    }
}

/// What the shader reads where the bed has no data, m.
const NO_DATA_ELEVATION: f32 = 1e6;

impl SurfaceAssets {
    fn mesh(&mut self, shape: &SurfaceShape, meshes: &mut Assets<Mesh>) -> Mesh3d {
        let key = shape.key();
        let known = self.meshes.iter().position(|(other, _)| *other == key);
        let make = || (key, meshes.add(nested_grid(shape.cell, shape.cells, &shape.coarser)));
        let last = known.map(|at| self.meshes.remove(at)).unwrap_or_else(make);
        let mesh = Mesh3d(last.1.clone());
        self.meshes.push(last);
        mesh
    }

    /// Drops meshes that no surface uses any more, but for the last few.
    fn collect(&mut self) {
        let is_used = |mesh: &Handle<Mesh>| matches!(mesh, Handle::Strong(shared) if Arc::strong_count(shared) > 1);
        let unused = self.meshes.iter().filter(|(_, mesh)| !is_used(mesh)).count();
        let mut surplus = unused.saturating_sub(SPARE_MESHES);
        self.meshes.retain(|(_, mesh)| {
            let keep = is_used(mesh) || surplus == 0;
            surplus -= usize::from(!keep);
            keep
        });
    }
}

/// Beds and flow maps as textures, one for each grid however many waters use it.
#[derive(Resource, Default)]
pub(crate) struct GroundTextures {
    beds: Vec<(Arc<Grid<f32>>, Handle<Image>)>,
    flows: Vec<(Arc<Grid<Vec2>>, Handle<Image>)>,
    /// Largest speed of each flow map, m/s.
    fastest: Vec<(Arc<Grid<Vec2>>, f32)>,
    ice_orders: Vec<(Arc<Grid<f32>>, Handle<Image>)>,
    pub(super) ice_tile: IceTile,
}

impl GroundTextures {
    pub fn bed(&mut self, grid: &Arc<Grid<f32>>, images: &mut Assets<Image>) -> Handle<Image> {
        // Where there is no data there is no water: the shader sees a mountain.
        let texel = |z: &f32| (if z.is_finite() { *z } else { NO_DATA_ELEVATION }).to_le_bytes();
        let image = || {
            let data = grid.values().iter().flat_map(texel).collect();
            grid_image("water_bed", grid.size(), TextureFormat::R32Float, data)
        };
        shared(&mut self.beds, grid, || images.add(image()))
    }

    pub fn flow(&mut self, grid: &Arc<Grid<Vec2>>, images: &mut Assets<Image>) -> Handle<Image> {
        let texel = |v: &Vec2| if v.is_finite() { *v } else { Vec2::ZERO }.to_array().map(f32::to_le_bytes).concat();
        let image = || {
            let data = grid.values().iter().flat_map(texel).collect();
            grid_image("water_flow", grid.size(), TextureFormat::Rg32Float, data)
        };
        shared(&mut self.flows, grid, || images.add(image()))
    }

    /// The order in which a water freezes.
    pub fn ice_order(&mut self, grid: &Arc<Grid<f32>>, images: &mut Assets<Image>) -> Handle<Image> {
        let image = || {
            let data = grid.values().iter().flat_map(|order| order.to_le_bytes()).collect();
            grid_image("water_ice_order", grid.size(), TextureFormat::R32Float, data)
        };
        shared(&mut self.ice_orders, grid, || images.add(image()))
    }

    /// Drops the textures of grids that nothing else uses.
    fn collect(&mut self) {
        self.beds.retain(|(grid, _)| Arc::strong_count(grid) > 1);
        self.ice_orders.retain(|(grid, _)| Arc::strong_count(grid) > 1);
        // Held here twice: beside the texture and beside the largest speed.
        self.flows.retain(|(grid, _)| Arc::strong_count(grid) > 2);
        self.fastest.retain(|(grid, _)| Arc::strong_count(grid) > 1);
    }

    /// Largest speed of a flow map, m/s.
    pub fn fastest(&mut self, grid: &Arc<Grid<Vec2>>) -> f32 {
        shared(&mut self.fastest, grid, || {
            grid.values().iter().filter(|v| v.is_finite()).map(|v| v.length()).fold(0.0, f32::max)
        })
    }
}

/// What is known of `grid`, made when it is asked for the first time.
fn shared<T, U: Clone>(known: &mut Vec<(Arc<Grid<T>>, U)>, grid: &Arc<Grid<T>>, make: impl FnOnce() -> U) -> U {
    if let Some((_, of_grid)) = known.iter().find(|(other, _)| Arc::ptr_eq(other, grid)) {
        return of_grid.clone();
    }
    let of_grid = make();
    known.push((grid.clone(), of_grid.clone()));
    of_grid
}

fn grid_image(label: &'static str, size: UVec2, format: TextureFormat, data: Vec<u8>) -> Image {
    let extent = Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 };
    let mut image = Image::new(extent, TextureDimension::D2, data, format, RenderAssetUsages::default());
    image.texture_descriptor.label = Some(label);
    image
}

/// Waters of which nothing is missing that [`Water`](crate::body::Water) brings: a game can remove it.
type Drawable = (
    With<Ripples>,
    With<WaterOptics>,
    With<WaterReflection>,
    With<WaterFoam>,
    With<WaterLighting>,
    With<FieldWindow>,
    With<FieldPictures>,
);

/// Spawns, shapes and despawns surface entities so that there is one for every water and viewing camera.
pub(crate) fn sync_surfaces(
    mut commands: Commands,
    mut assets: ResMut<SurfaceAssets>,
    mut ground: ResMut<GroundTextures>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<SurfaceMaterial>>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
    mut reported: ResMut<Reported>,
    viewers: Viewers,
    waters: Query<(Entity, &WaterSurface, &ResolvedWater, &InheritedVisibility, Option<&RenderLayers>), Drawable>,
    mut surfaces: Query<(Entity, &SurfaceOf, &mut SurfaceShape)>,
) {
    ground.collect();
    assets.collect();
    let mut missing: HashSet<SurfaceOf> = viewers
        .iter()
        .flat_map(|viewer| waters.iter().map(move |water| SurfaceOf { water: water.0, viewer: viewer.entity }))
        .collect();
    for (entity, surface, mut shape) in &mut surfaces {
        let water = waters.get(surface.water).ok().filter(|_| missing.remove(surface));
        let (Some((water, settings, resolved, visibility, layers)), Some(viewer)) =
            (water, viewers.get(surface.viewer))
        else {
            commands.entity(entity).try_despawn();
            continue;
        };
        let wanted = SurfaceShape::new(water, settings, resolved, &viewer, &mut reported);
        if *shape != wanted {
            commands.entity(entity).try_insert(assets.mesh(&wanted, &mut meshes));
            *shape = wanted;
        }
        let shown = visibility.get() && resolved.half_size != Vec2::ZERO;
        let visible = if shown { Visibility::Visible } else { Visibility::Hidden };
        commands.entity(entity).try_insert((visible, place(resolved), layers.cloned().unwrap_or_default()));
    }
    for surface in missing {
        let (Ok((water, settings, resolved, ..)), Some(viewer)) =
            (waters.get(surface.water), viewers.get(surface.viewer))
        else {
            continue;
        };
        let shape = SurfaceShape::new(water, settings, resolved, &viewer, &mut reported);
        let mut buffer = ShaderBuffer::from(GpuSurface::default());
        buffer.buffer_description.label = Some("water_surface");
        commands.spawn((
            Name::new("Water surface"),
            surface,
            assets.mesh(&shape, &mut meshes),
            shape,
            MeshMaterial3d(materials.add(SurfaceMaterial {
                surface: buffers.add(buffer),
                mirror: None,
                sky: None,
                sky_light: None,
                detail: assets.detail.clone(),
                bed: None,
                flow: None,
                field_rings: None,
                field_matter: None,
                foam: assets.foam.clone(),
                ice_order: None,
                ice_tile: None,
                simulated: None,
                simulated_slopes: None,
            })),
            // Placed and shown from the next frame on, when it is written for the first time.
            Visibility::Hidden,
            place(resolved),
            (NotShadowCaster, NotShadowReceiver),
        ));
    }
}

/// Pose and bounds of a surface: its vertices are placed by the shader, so the bounds are what culling knows of it.
fn place(water: &ResolvedWater) -> (Transform, GlobalTransform, Aabb) {
    let (lowest, highest) = water.elevations();
    let pose = water.pose();
    // Crests lean over by their amplitude; a centimetre for what is rounded.
    let half = water.half_size + highest + 0.01;
    let corner = |side: Vec2, height: f32| vec3(side.x, height, side.y);
    (pose, pose.into(), Aabb::from_min_max(corner(-half, lowest - 0.01), corner(half, highest + 0.01)))
}
