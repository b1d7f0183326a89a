//! The terrain: tinted by height and shaded, and under a colouring draped with the colours of the flood.
use crate::viewer::{Coloring, Viewer, percentile};
use bevy::{
    asset::RenderAssetUsages,
    image::ImageSampler,
    math::Affine2,
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};
use bevy_freshet::{flood::FloodState, prelude::*};
use freshet_hydro::{grid::Grid, shallow_water::WaterCells};

/// Cells along a side of a drawn piece.
const PIECE: u32 = 64;

/// Colours from low to high ground, sRGB.
const TINTS: [[f32; 3]; 6] = [
    [0.33, 0.45, 0.34],
    [0.47, 0.58, 0.38],
    [0.68, 0.71, 0.45],
    [0.82, 0.76, 0.54],
    [0.71, 0.57, 0.42],
    [0.90, 0.87, 0.83],
];

/// Pictures of the terrain and what is drawn with them.
#[derive(Resource)]
pub struct Drape {
    /// The colour of every cell under its shade, sRGB.
    shaded: Vec<[u8; 4]>,
    picture: Handle<Image>,
    /// Lit by the sun, and as the picture is.
    materials: [Handle<StandardMaterial>; 2],
    /// What was painted.
    painted: Option<(f64, Coloring)>,
}

/// A drawn piece of the terrain.
#[derive(Component)]
pub struct Piece;

/// Makes the pictures, and spawns the ground and the water.
pub fn setup(
    mut commands: Commands,
    viewer: Res<Viewer>,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let tints = tints(&viewer.terrain);
    let shaded = shaded(&viewer.terrain, &tints);
    let lit = images.add(picture(&viewer.terrain, &shaded, ImageSampler::linear()));
    let picture = images.add(picture(&viewer.terrain, &shaded, ImageSampler::nearest()));
    let extent = viewer.terrain.extent();
    let material = |texture: &Handle<Image>, unlit: bool| StandardMaterial {
        base_color_texture: Some(texture.clone()),
        // Places in metres from the middle.
        uv_transform: Affine2::from_scale_angle_translation(extent.recip(), 0.0, Vec2::splat(0.5)),
        perceptual_roughness: 1.0,
        reflectance: 0.1,
        unlit,
        fog_enabled: !unlit,
        ..default()
    };
    let materials = [materials.add(material(&lit, false)), materials.add(material(&picture, true))];
    commands.insert_resource(Drape { shaded, picture, materials, painted: None });
    commands.spawn((bed(&viewer), Name::new("Terrain")));
    commands.spawn((Flood::water(&viewer.maps), Name::new("Flood")));
}

/// The ground as it is drawn.
fn bed(viewer: &Viewer) -> WaterBed {
    let raised = viewer.terrain.map(|elevation| elevation * viewer.exaggeration);
    WaterBed::new(raised).unwrap_or_else(|problem| crate::common::fail(problem))
}

/// Follows the exaggeration: bed, pieces and water.
pub fn exaggerate(
    mut commands: Commands,
    viewer: Res<Viewer>,
    drape: Res<Drape>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut known: Local<f32>,
    beds: Single<Entity, With<WaterBed>>,
    mut flood: Single<&mut Flood>,
    pieces: Query<Entity, With<Piece>>,
) {
    if *known == viewer.exaggeration {
        return;
    }
    *known = viewer.exaggeration;
    flood.exaggeration = viewer.exaggeration;
    pieces.iter().for_each(|piece| commands.entity(piece).despawn());
    let bed = bed(&viewer);
    let size = viewer.terrain.size();
    let material = drape.material(viewer.coloring);
    for (x, y) in
        (0..size.y).step_by(PIECE as usize).flat_map(|y| (0..size.x).step_by(PIECE as usize).map(move |x| (x, y)))
    {
        if let Some(mesh) = bed.mesh(x..x + PIECE, y..y + PIECE) {
            let piece = (Piece, Mesh3d(meshes.add(mesh)), MeshMaterial3d(material.clone()), ChildOf(*beds));
            commands.spawn(piece);
        }
    }
    commands.entity(*beds).insert(bed);
}

impl Drape {
    fn material(&self, coloring: Coloring) -> Handle<StandardMaterial> {
        self.materials[usize::from(coloring != Coloring::Water)].clone()
    }
}

/// Gives the terrain the material of the colouring.
pub fn dress(
    viewer: Res<Viewer>,
    drape: Res<Drape>,
    mut pieces: Query<&mut MeshMaterial3d<StandardMaterial>, With<Piece>>,
) {
    let material = drape.material(viewer.coloring);
    for mut piece in &mut pieces {
        if piece.0 != material {
            piece.0 = material.clone();
        }
    }
}

/// Paints the wet cells in the colours of the colouring.
pub fn paint(
    viewer: Res<Viewer>,
    mut drape: ResMut<Drape>,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    state: Single<&FloodState>,
) {
    let Some(moment) = state.moment() else { return };
    let time = moment.time();
    if viewer.coloring == Coloring::Water || drape.painted == Some((time, viewer.coloring)) {
        return;
    }
    let cells = drape.shaded.iter().enumerate();
    let pixels = cells.flat_map(|(index, shaded)| {
        let cell = moment.cell(index);
        let wet = (cell.y > 0.0).then(|| viewer.color(index, cell.y / viewer.exaggeration, cell.zw().length()));
        wet.flatten().map_or(*shaded, |color| Srgba::from(color).to_u8_array())
    });
    let data = pixels.collect();
    if let Some(mut picture) = images.get_mut(&drape.picture) {
        picture.data = Some(data);
    }
    // A new texture wants a new bind group.
    if let Some(mut material) = materials.get_mut(&drape.materials[1]) {
        material.base_color_texture = Some(drape.picture.clone());
    }
    drape.painted = Some((time, viewer.coloring));
}

fn picture(terrain: &Grid<f32>, pixels: &[[u8; 4]], sampler: ImageSampler) -> Image {
    let size = terrain.size();
    let extent = Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 };
    let usages = RenderAssetUsages::all();
    let format = TextureFormat::Rgba8UnormSrgb;
    let mut image = Image::new(extent, TextureDimension::D2, pixels.concat(), format, usages);
    image.sampler = sampler;
    image
}

/// Colours by elevation, between the lowest and highest hundredth.
fn tints(terrain: &Grid<f32>) -> Vec<[u8; 4]> {
    let known: Vec<f32> = terrain.values().iter().copied().filter(|z| z.is_finite()).collect();
    let (low, high) = (percentile(known.clone(), 0.01), percentile(known, 0.99));
    let tint = |elevation: &f32| {
        let share = ((elevation - low) / (high - low).max(1e-3)).clamp(0.0, 1.0) * (TINTS.len() - 1) as f32;
        let index = (share as usize).min(TINTS.len() - 2);
        let [a, b] = [TINTS[index], TINTS[index + 1]].map(Vec3::from_array);
        let color = a.lerp(b, share - index as f32);
        Srgba::rgb(color.x, color.y, color.z).to_u8_array()
    };
    terrain.values().iter().map(tint).collect()
}

/// Tints under light from the north-west, 45° high, as maps have it.
fn shaded(terrain: &Grid<f32>, tints: &[[u8; 4]]) -> Vec<[u8; 4]> {
    let light = vec3(-0.5, 0.707, -0.5);
    let normals = freshet_flood::terrain::normals(&terrain.map(|elevation| 4.0 * elevation));
    let shade = |(tint, normal): (&[u8; 4], &Vec3)| {
        let share = 0.45 + 0.75 * normal.dot(light).max(0.0);
        let [r, g, b, a] = *tint;
        let [r, g, b] = [r, g, b].map(|channel| (f32::from(channel) * share).min(255.0) as u8);
        [r, g, b, a]
    };
    tints.iter().zip(normals.values()).map(shade).collect()
}
