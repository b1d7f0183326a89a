//! A wooden footbridge on piles, round which the water parts.
use bevy::prelude::*;
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;

/// Height of the deck over the water, m.
const DECK: f32 = 1.9;
const WIDTH: f32 = 1.8;
/// Largest distance between two pairs of piles, m.
const SPAN: f32 = 4.5;
const PILE_RADIUS: f32 = 0.16;
/// How far piles reach into the ground, m.
const BURIED: f32 = 1.0;

/// Where a bridge stands.
pub struct Site<'a> {
    /// World xz of its ends.
    pub ends: [Vec2; 2],
    /// World height of the water, m.
    pub water_level: f32,
    /// World height of the ground at x and z, m.
    pub height: &'a dyn Fn(f32, f32) -> f32,
}

/// Spawns the bridge: one mesh of timber that is walked on, and the piles, each a body of its own.
pub fn spawn_bridge(
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    materials: &mut Assets<StandardMaterial>,
    site: &Site,
) {
    let [from, to] = site.ends;
    let (middle, length) = (from.midpoint(to), from.distance(to));
    let along = (to - from) / length;
    let turn = Quat::from_rotation_arc(Vec3::X, vec3(along.x, 0.0, along.y));
    let wood = StandardMaterial { base_color: Color::srgb(0.36, 0.29, 0.22), perceptual_roughness: 0.9, ..default() };
    let wood = materials.add(wood);
    let deck_height = site.water_level + DECK;

    commands.spawn((
        Name::new("bridge"),
        Mesh3d(meshes.add(timber(length))),
        MeshMaterial3d(wood.clone()),
        (RigidBody::Fixed, Collider::cuboid(length / 2.0, 0.06, WIDTH / 2.0)),
        Transform::from_xyz(middle.x, deck_height, middle.y).with_rotation(turn),
    ));
    let spans = (length / SPAN).ceil();
    for i in 0..=spans as u32 {
        for side in [-1.0, 1.0] {
            let foot = from.lerp(to, i as f32 / spans) + along.perp() * (side * WIDTH * 0.4);
            let bottom = (site.height)(foot.x, foot.y).min(site.water_level) - BURIED;
            let top = deck_height + if i == 0 || i as f32 == spans { 1.05 } else { -0.12 };
            commands.spawn((
                // A body that stands still disturbs the water all the same: the current foams around it.
                (Name::new("pile"), DisturbsWater),
                Mesh3d(meshes.add(Cylinder::new(PILE_RADIUS, top - bottom))),
                MeshMaterial3d(wood.clone()),
                (RigidBody::Fixed, Collider::cylinder((top - bottom) / 2.0, PILE_RADIUS)),
                Transform::from_xyz(foot.x, (top + bottom) / 2.0, foot.y),
            ));
        }
    }
}

/// Planks, the beams under them and the railings of a bridge along x, its deck at y = 0.
fn timber(length: f32) -> Mesh {
    let mut shade = fastrand::Rng::with_seed(7);
    let mut beam = |size: Vec3, place: Vec3| {
        let tint = 0.75 + 0.5 * shade.f32();
        let mesh = Mesh::from(Cuboid::from_size(size)).translated_by(place);
        let colors = vec![[tint, tint, tint, 1.0]; mesh.count_vertices()];
        mesh.with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
    };
    let mut parts = Vec::new();
    for side in [-0.8, 0.8_f32] {
        let z = side * WIDTH / 2.0;
        parts.push(beam(vec3(length, 0.2, 0.12), vec3(0.0, -0.14, z)));
        for height in [0.55, 1.0] {
            parts.push(beam(vec3(length, 0.08, 0.05), vec3(0.0, height, z * 1.15)));
        }
    }
    let posts = (length / 2.2).ceil();
    for i in 0..=posts as u32 {
        for side in [-0.92, 0.92] {
            let x = length * (i as f32 / posts - 0.5) * 0.995;
            parts.push(beam(vec3(0.09, 1.15, 0.09), vec3(x, 0.48, side * WIDTH / 2.0)));
        }
    }
    let planks = (length / 0.2) as u32;
    for i in 0..planks {
        let x = length * ((i as f32 + 0.5) / planks as f32 - 0.5);
        parts.push(beam(vec3(length / planks as f32 - 0.012, 0.045, WIDTH), vec3(x, 0.0, 0.0)));
    }
    let mut parts = parts.into_iter();
    let mut mesh = parts.next().unwrap_or_else(|| Cuboid::default().into());
    for part in parts {
        if let Err(error) = mesh.merge(&part) {
            warn!("the bridge lacks a beam: {error}");
        }
    }
    mesh
}
