//! Things that float: checkered balls, crates, logs and a small boat.
use bevy::{
    asset::RenderAssetUsages,
    image::{ImageAddressMode, ImageSampler, ImageSamplerDescriptor},
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use std::f32::consts::{FRAC_PI_2, TAU};

/// Meshes and materials of the bodies, made once.
#[derive(Resource)]
pub struct Bodies {
    ball: Handle<Mesh>,
    cube: Handle<Mesh>,
    log: Handle<Mesh>,
    hull: Handle<Mesh>,
    deck: Handle<Mesh>,
    checkered: [Handle<StandardMaterial>; 3],
    wood: Handle<StandardMaterial>,
    bark: Handle<StandardMaterial>,
    paint: Handle<StandardMaterial>,
}

const BALL_RADIUS: f32 = 0.45;
const CRATE_SIZE: f32 = 0.9;
const LOG_RADIUS: f32 = 0.22;
const LOG_LENGTH: f32 = 3.2;
/// Length, width and height of the boat's hull, m.
const BOAT: Vec3 = Vec3::new(1.5, 0.7, 4.2);

impl Bodies {
    pub fn new(
        assets: &AssetServer,
        meshes: &mut Assets<Mesh>,
        materials: &mut Assets<StandardMaterial>,
        images: &mut Assets<Image>,
    ) -> Self {
        let checker = images.add(checkerboard());
        let mut checkered = |color: Color| {
            let base_color_texture = Some(checker.clone());
            materials.add(StandardMaterial {
                base_color: color,
                base_color_texture,
                perceptual_roughness: 0.35,
                ..default()
            })
        };
        let checkered = [Color::srgb(0.85, 0.12, 0.1), Color::srgb(0.95, 0.65, 0.1), Color::srgb(0.1, 0.35, 0.75)]
            .map(&mut checkered);
        let bark = assets.load("textures/bark.png");
        let mut plain = |color, roughness: f32| {
            materials.add(StandardMaterial { base_color: color, perceptual_roughness: roughness, ..default() })
        };
        let (wood, paint) = (plain(Color::srgb(0.55, 0.37, 0.2), 0.8), plain(Color::srgb(0.08, 0.27, 0.3), 0.4));
        Self {
            ball: meshes.add(Sphere::new(BALL_RADIUS).mesh().uv(32, 18)),
            cube: meshes.add(crate_mesh()),
            log: meshes.add(Cylinder::new(LOG_RADIUS, LOG_LENGTH)),
            hull: meshes.add(mesh_of(&hull_points(1.0, 0.0), true)),
            deck: meshes.add(mesh_of(&hull_points(0.86, 0.42), false)),
            checkered,
            wood,
            bark: materials.add(StandardMaterial {
                base_color_texture: Some(bark),
                perceptual_roughness: 0.9,
                ..default()
            }),
            paint,
        }
    }

    /// The `i`-th of a mixed lot, at `pose`.
    pub fn spawn(&self, commands: &mut Commands, i: usize, pose: Transform) -> Entity {
        let mut body = commands.spawn((RigidBody::Dynamic, Velocity::default(), pose, Visibility::default()));
        match i % 4 {
            0 | 2 => body.insert((
                Name::new(format!("ball {i}")),
                Collider::ball(BALL_RADIUS),
                Floating::with_density(250.0 + 90.0 * (i % 5) as f32),
                Mesh3d(self.ball.clone()),
                MeshMaterial3d(self.checkered[i / 2 % 3].clone()),
            )),
            1 => body.insert((
                Name::new(format!("crate {i}")),
                Collider::cuboid(CRATE_SIZE / 2.0, CRATE_SIZE / 2.0, CRATE_SIZE / 2.0),
                Floating::with_density(420.0),
                Mesh3d(self.cube.clone()),
                MeshMaterial3d(self.wood.clone()),
            )),
            _ => body.insert((
                Name::new(format!("log {i}")),
                Collider::cylinder(LOG_LENGTH / 2.0, LOG_RADIUS),
                Floating::with_density(620.0),
                Mesh3d(self.log.clone()),
                MeshMaterial3d(self.bark.clone()),
            )),
        };
        if i % 4 == 3 {
            body.insert(pose * Transform::from_rotation(Quat::from_rotation_z(FRAC_PI_2)));
        }
        body.id()
    }

    /// A small open boat.
    pub fn spawn_boat(&self, commands: &mut Commands, pose: Transform) -> Entity {
        let points = hull_points(1.0, 0.0);
        let collider = Collider::convex_hull(&points)
            .unwrap_or_else(|| Collider::cuboid(BOAT.x / 2.0, BOAT.y / 2.0, BOAT.z / 2.0));
        commands
            .spawn((
                Name::new("boat"),
                RigidBody::Dynamic,
                Velocity::default(),
                collider,
                Floating::with_density(260.0),
                Mesh3d(self.hull.clone()),
                MeshMaterial3d(self.paint.clone()),
                pose,
                children![(Mesh3d(self.deck.clone()), MeshMaterial3d(self.wood.clone()))],
            ))
            .id()
    }
}

/// Outline of the boat at gunwale and keel, going round from the bow; `scale` shrinks it, `raise` lifts the keel, m.
fn hull_points(scale: f32, raise: f32) -> Vec<Vec3> {
    const STATIONS: usize = 16;
    let ring = |height: f32, fullness: f32| {
        (0..STATIONS).map(move |i| {
            let angle = i as f32 / STATIONS as f32 * TAU;
            // A pointed bow towards −z and a blunter stern.
            let along = -angle.cos();
            let width = angle.sin().abs().powf(if along < 0.0 { 1.3 } else { 0.7 }) * angle.sin().signum();
            vec3(width * BOAT.x / 2.0 * fullness, height, along * BOAT.z / 2.0 * (0.75 + 0.25 * fullness))
                * vec3(scale, 1.0, scale)
        })
    };
    ring(BOAT.y / 2.0, 1.0).chain(ring(raise - BOAT.y / 2.0, 0.55)).collect()
}

/// Triangles between the two rings of `points` with the lower one closed: the outside of a hull, or (inward) its inside.
fn mesh_of(points: &[Vec3], outward: bool) -> Mesh {
    let n = points.len() as u32 / 2;
    let mut indices = Vec::new();
    let mut add = |a: u32, b: u32, c: u32| indices.extend(if outward { [a, b, c] } else { [a, c, b] });
    for i in 0..n {
        let j = (i + 1) % n;
        add(i, j, n + i);
        add(j, n + j, n + i);
    }
    for i in 1..n - 1 {
        add(n, n + i, n + i + 1);
    }
    let positions: Vec<Vec3> = points.to_vec();
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_indices(Indices::U32(indices))
        .with_duplicated_vertices()
        .with_computed_flat_normals()
}

/// A crate of six planked sides: a cube with a frame along its edges.
fn crate_mesh() -> Mesh {
    let bar = 0.12;
    let side = CRATE_SIZE - bar * 0.5;
    let tinted = |mesh: Mesh, tint: f32| {
        let color = [tint, tint, tint, 1.0];
        let colors = vec![color; mesh.count_vertices()];
        mesh.with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
    };
    let mut mesh = tinted(Mesh::from(Cuboid::from_length(side)), 0.6);
    let reach = (CRATE_SIZE - bar) / 2.0;
    for axis in 0..3 {
        for corner in [vec2(1.0, 1.0), vec2(1.0, -1.0), vec2(-1.0, 1.0), vec2(-1.0, -1.0)] {
            let mut size = Vec3::splat(bar);
            size[axis] = CRATE_SIZE;
            let mut place = Vec3::ZERO;
            place[(axis + 1) % 3] = corner.x * reach;
            place[(axis + 2) % 3] = corner.y * reach;
            let beam = tinted(Mesh::from(Cuboid::from_size(size)).translated_by(place), 1.0);
            if let Err(error) = mesh.merge(&beam) {
                warn!("a crate lacks a beam: {error}");
            }
        }
    }
    mesh
}

/// Light and dark squares that repeat.
fn checkerboard() -> Image {
    const SIZE: u32 = 64;
    // Multiplied with the material's colour: coloured and nearly black squares.
    let texel = |i: u32| {
        let light = (i % SIZE / (SIZE / 8) + i / SIZE / (SIZE / 4)).is_multiple_of(2);
        if light { [255; 4] } else { [28, 28, 28, 255] }
    };
    let data = (0..SIZE * SIZE).flat_map(texel).collect();
    let extent = Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 };
    let usage = RenderAssetUsages::RENDER_WORLD;
    let mut image = Image::new(extent, TextureDimension::D2, data, TextureFormat::Rgba8UnormSrgb, usage);
    let repeat = ImageAddressMode::Repeat;
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: repeat,
        address_mode_v: repeat,
        ..ImageSamplerDescriptor::linear()
    });
    image
}
