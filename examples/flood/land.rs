//! The ground: its bed, its tints by height, and the tiles on which they are drawn.
use crate::{
    drape::{Drape, Georeferenced},
    paint::{Paint, TerrainMaterial},
    relief::Relief,
    terrain::{self, Block, Ground, Tree},
    viewer::{Coloring, Viewer, percentile},
};
use bevy::{prelude::*, render::renderer::RenderDevice};
use bevy_freshet::prelude::*;
use freshet_hydro::grid::Grid;

/// Colours from low to high ground, sRGB.
const TINTS: [[f32; 3]; 6] = [
    [0.33, 0.45, 0.34],
    [0.47, 0.58, 0.38],
    [0.68, 0.71, 0.45],
    [0.82, 0.76, 0.54],
    [0.71, 0.57, 0.42],
    [0.90, 0.87, 0.83],
];

/// Colour of the sides of the block, sRGB.
const EARTH: Color = Color::srgb(0.36, 0.30, 0.25);

/// Height of the block below the lowest ground, as a share of its shorter side.
const PLINTH: f32 = 0.02;

/// How the ground is drawn.
#[derive(Resource)]
pub struct Land {
    /// Of the ground.
    pub lit: Handle<TerrainMaterial>,
    /// Of the sides: in the sun, and beside colours that must be exact.
    sides: [Handle<StandardMaterial>; 2],
    /// Cells from one pixel of its textures to the next: more than 1 where the device has no textures large enough.
    pub step: u32,
}

/// The image that lies on the ground, until it does.
#[derive(Resource)]
pub struct Cover(pub Option<Georeferenced>);

/// A side of the block.
#[derive(Component)]
pub struct Side;

/// Makes the textures and the tree of tiles, and spawns the ground and the water.
pub fn setup(
    mut commands: Commands,
    viewer: Res<Viewer>,
    arguments: Res<crate::Arguments>,
    mut cover: ResMut<Cover>,
    device: Option<Res<RenderDevice>>,
    mut images: ResMut<Assets<Image>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut terrains: ResMut<Assets<TerrainMaterial>>,
) {
    let largest = device.map_or(8192, |device| device.limits().max_texture_dimension_2d);
    let tints = Tints::new(&viewer.terrain);
    let drape = Drape::new(&viewer.terrain, viewer.maps.georeference(), cover.0.take(), largest.min(8192));
    let step = viewer.terrain.size().max_element().div_ceil(largest);
    let relief = Relief::new(&viewer, &tints.normals, step, &mut images);
    let lit = StandardMaterial {
        base_color_texture: Some(images.add(drape.texture(&tints))),
        normal_map_texture: Some(relief.texture().clone()),
        perceptual_roughness: 1.0,
        reflectance: 0.1,
        ..default()
    };
    let extension = Paint::new(&viewer, &drape.cells(&tints), &mut images);
    let lit = terrains.add(TerrainMaterial { base: lit, extension });
    let plain = |unlit| StandardMaterial {
        base_color: EARTH,
        perceptual_roughness: 1.0,
        unlit,
        fog_enabled: !unlit,
        ..default()
    };
    let sides = [materials.add(plain(false)), materials.add(plain(true))];

    let scale = Transform::from_scale(vec3(1.0, viewer.exaggeration, 1.0));
    let block = commands.spawn((Block, scale, Name::new("Terrain"))).id();
    let tree = Tree::new(viewer.terrain.clone());
    let lowest = tree.bounds(tree.root()).heights.x;
    let base = lowest - PLINTH * viewer.terrain.extent().min_element() / viewer.exaggeration;
    let walls = meshes.add(terrain::walls(&viewer.terrain, base));
    commands.spawn((Side, Mesh3d(walls), MeshMaterial3d(sides[0].clone()), ChildOf(block)));
    commands.insert_resource(Ground::new(tree, block, lit.clone(), arguments.tolerance));
    commands.insert_resource(relief);
    commands.insert_resource(Land { lit, sides, step });
    commands.spawn((bed(&viewer), Name::new("Bed")));
    commands.spawn((Flood::water(&viewer.maps), Name::new("Flood")));
}

/// The ground as the water has it.
fn bed(viewer: &Viewer) -> WaterBed {
    let raised = viewer.terrain.map(|elevation| elevation * viewer.exaggeration);
    WaterBed::new(raised).unwrap_or_else(|problem| crate::common::fail(problem))
}

/// Follows the exaggeration: bed, block and water.
pub fn exaggerate(
    mut commands: Commands,
    viewer: Res<Viewer>,
    beds: Single<Entity, With<WaterBed>>,
    mut flood: Single<&mut Flood>,
    mut block: Single<&mut Transform, With<Block>>,
) {
    if flood.exaggeration != viewer.exaggeration {
        flood.exaggeration = viewer.exaggeration;
        block.scale.y = viewer.exaggeration;
        commands.entity(*beds).insert(bed(&viewer));
    }
}

/// Beside colours that must be exact the sides are not lit either.
pub fn dress(
    viewer: Res<Viewer>,
    land: Res<Land>,
    mut sides: Query<&mut MeshMaterial3d<StandardMaterial>, With<Side>>,
) {
    for mut side in &mut sides {
        let is_exact = viewer.coloring != Coloring::Water;
        side.set_if_neq(MeshMaterial3d(land.sides[usize::from(is_exact)].clone()));
    }
}

/// Colours by elevation, under light from the north-west, 45° high, as maps have it.
pub struct Tints {
    /// The lowest and the highest hundredth, m.
    range: Vec2,
    normals: Grid<Vec3>,
}

impl Tints {
    fn new(terrain: &Grid<f32>) -> Self {
        let range = [0.01, 0.99].map(|share| percentile(terrain.values().to_vec(), share));
        Self { range: range.into(), normals: freshet_flood::terrain::normals(terrain) }
    }

    /// Colour of ground at an elevation (m), sRGB, without light.
    pub fn tint(&self, elevation: f32) -> Vec3 {
        let [low, high] = self.range.to_array();
        let share = ((elevation - low) / (high - low).max(1e-3)).clamp(0.0, 1.0) * (TINTS.len() - 1) as f32;
        let index = (share as usize).min(TINTS.len() - 2);
        let [a, b] = [TINTS[index], TINTS[index + 1]].map(Vec3::from_array);
        a.lerp(b, share - index as f32)
    }

    /// Share of the light at a cell, a bit less than 1 on level ground, with four times its heights.
    pub fn shade(&self, cell: UVec2) -> f32 {
        let normal = self.normals.get(cell).copied().unwrap_or(Vec3::Y);
        let normal = vec3(4.0 * normal.x, normal.y, 4.0 * normal.z).normalize();
        0.45 + 0.75 * normal.dot(vec3(-0.5, 0.707, -0.5)).max(0.0)
    }
}
