//! The drawn ground: mud, sand and grass by height over the water and by slope.
mod material;
mod textures;

use crate::{body::WaterBed, report::Reported};
use bevy::{
    asset::embedded_asset, ecs::relationship::Relationship, material::OpaqueRendererMethod, prelude::*,
    render::RenderApp,
};
use material::{BedExtension, BedMaterial, GpuBed};

/// Draws the [`WaterBed`] beside it, in pieces that are culled one by one. Each texture is optional: without it the
/// ground has one colour there.
///
/// Textures are sRGB colours with the height of the relief in the alpha channel, and tile. Their mip levels are made when
/// they are loaded.
#[derive(Component, Reflect, Clone, Debug)]
#[reflect(Component, Default, Clone, Debug)]
pub struct BedShading {
    /// World height of the water that the bands of ground follow, m. Default 0.
    pub level: f32,
    /// Ground below the water and just above it.
    pub mud: Option<Handle<Image>>,
    /// Beaches, steep banks, and patches under water.
    pub sand: Option<Handle<Image>>,
    /// Level ground above the water.
    pub grass: Option<Handle<Image>>,
    /// Size of a tile of each texture, m, > 0. Default 3.
    pub tile: f32,
    /// Height of the relief in the textures, m, 0…0.5. Default 0.05.
    pub relief: f32,
}

impl Default for BedShading {
    fn default() -> Self {
        Self { level: 0.0, mud: None, sand: None, grass: None, tile: 3.0, relief: 0.05 }
    }
}

/// A drawn piece of a bed: a child of the entity with the [`WaterBed`].
#[derive(Component, Clone, Copy, Debug)]
pub struct BedChunk;

/// The material of all pieces of a bed.
#[derive(Component)]
struct BedDrawing(Handle<BedMaterial>);

/// Cells along one side of a piece.
const CHUNK_CELLS: u32 = 32;

/// Draws beds. Does nothing in an app without a GPU device.
pub(crate) struct BedPlugin;

impl Plugin for BedPlugin {
    fn build(&self, app: &mut App) {
        if app.get_sub_app(RenderApp).is_none() {
            return;
        }
        embedded_asset!(app, "bed.wgsl");
        app.add_plugins(MaterialPlugin::<BedMaterial>::default())
            .init_resource::<textures::PreparedTextures>()
            .add_systems(Update, (shade_beds, textures::prepare_textures).chain())
            .add_observer(stop_drawing::<BedShading>)
            .add_observer(stop_drawing::<WaterBed>);
    }
}

/// Takes away material and pieces of a bed that is no longer one, or no longer drawn.
fn stop_drawing<C: Component>(
    removed: On<Remove, C>,
    mut commands: Commands,
    chunks: Query<(Entity, &ChildOf), With<BedChunk>>,
) {
    for (chunk, _) in chunks.iter().filter(|(_, parent)| parent.get() == removed.entity) {
        commands.entity(chunk).try_despawn();
    }
    commands.entity(removed.entity).try_remove::<BedDrawing>();
}

/// Makes material and pieces anew for beds that have changed.
fn shade_beds(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<BedMaterial>>,
    mut reported: ResMut<Reported>,
    beds: Query<(Entity, Ref<WaterBed>, Ref<BedShading>, Option<&BedDrawing>)>,
    chunks: Query<(Entity, &ChildOf), With<BedChunk>>,
) {
    for (entity, bed, shading, drawing) in &beds {
        if !bed.is_changed() && !shading.is_changed() {
            continue;
        }
        let uniform = GpuBed {
            level: reported.clamp(entity, "BedShading::level", shading.level, -1e5..=1e5, 0.0),
            tile: reported.clamp(entity, "BedShading::tile", shading.tile, 1e-3..=1e4, 3.0),
            relief: reported.clamp(entity, "BedShading::relief", shading.relief, 0.0..=0.5, 0.05),
        };
        let known = drawing.map(|drawing| drawing.0.clone());
        let material = known.unwrap_or_else(|| {
            materials.add(BedMaterial {
                base: StandardMaterial {
                    perceptual_roughness: 0.95,
                    reflectance: 0.3,
                    // The layers have no deferred shader.
                    opaque_render_method: OpaqueRendererMethod::Forward,
                    ..default()
                },
                extension: BedExtension::default(),
            })
        });
        if let Some(mut material) = materials.get_mut(&material) {
            material.extension.bed = uniform;
        }
        commands.entity(entity).try_insert(BedDrawing(material.clone()));
        if bed.is_changed() || drawing.is_none() {
            for (chunk, _) in chunks.iter().filter(|(_, parent)| parent.get() == entity) {
                commands.entity(chunk).try_despawn();
            }
            spawn_chunks(&mut commands, &mut meshes, entity, &bed, &material);
        }
    }
}

fn spawn_chunks(
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    entity: Entity,
    bed: &WaterBed,
    material: &Handle<BedMaterial>,
) {
    let size = bed.elevations().size();
    for row in (0..size.y).step_by(CHUNK_CELLS as usize) {
        for column in (0..size.x).step_by(CHUNK_CELLS as usize) {
            if let Some(mesh) = bed.mesh(column..column + CHUNK_CELLS, row..row + CHUNK_CELLS) {
                commands.spawn((
                    Name::new("Bed"),
                    BedChunk,
                    Mesh3d(meshes.add(mesh)),
                    MeshMaterial3d(material.clone()),
                    ChildOf(entity),
                ));
            }
        }
    }
}
