//! What the boat looks like: planks from section to section, and fittings on the deck.
use super::boat::{LENGTH, SECTIONS, section};
use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};

const BOTTOM: Srgba = Srgba::rgb(0.42, 0.07, 0.05);
const SIDE: Srgba = Srgba::rgb(0.03, 0.09, 0.2);
const RAIL: Srgba = Srgba::rgb(0.9, 0.88, 0.82);
const DECK: Srgba = Srgba::rgb(0.62, 0.43, 0.24);

/// The closed surface of the hull: bottom, sides and rails from stern to bow, and a deck over all, so that no water is seen within.
pub fn hull_mesh() -> Mesh {
    let sections: Vec<[Vec3; 4]> = (0..SECTIONS).map(section).collect();
    let mirrored = |point: Vec3| point * vec3(-1.0, 1.0, 1.0);
    // Each is a strip between two lines of points, smooth along itself, and has an edge towards the next.
    let line = |k: usize| sections.iter().map(|section| section[k]).collect::<Vec<_>>();
    let port = |line: &[Vec3]| line.iter().copied().map(mirrored).collect::<Vec<_>>();
    let [keel, chine, rail, sheer] = [0, 1, 2, 3].map(line);
    let mut strips = Vec::new();
    for (lower, upper, color) in [(&keel, &chine, BOTTOM), (&chine, &rail, SIDE), (&rail, &sheer, RAIL)] {
        strips.push((lower.clone(), upper.clone(), color));
        strips.push((port(upper), port(lower), color));
    }
    strips.push((sheer.clone(), port(&sheer), DECK));
    // The transom, and the stem that closes the last section.
    // The transom closes the stern, and a narrow stem the bow.
    let (stern, bow) = (sections[0], sections[SECTIONS - 1]);
    strips.push((stern.to_vec(), port(&stern), SIDE));
    strips.push((port(&bow), bow.to_vec(), RAIL));

    let mut strips = strips.into_iter().map(|(a, b, color)| strip(&a, &b, color));
    let first = strips.next().unwrap_or_else(|| Cuboid::default().into());
    strips.fold(first, |mut mesh, strip| {
        if let Err(problem) = mesh.merge(&strip) {
            warn!("the boat lacks a plank: {problem}");
        }
        mesh
    })
}

/// Triangles between two lines of as many points, seen from where `a` is below `b` and the lines go to the right.
fn strip(a: &[Vec3], b: &[Vec3], color: Srgba) -> Mesh {
    let points: Vec<Vec3> = a.iter().zip(b).flat_map(|(a, b)| [*a, *b]).collect();
    let quads = (0..a.len() as u32 - 1).map(|k| 2 * k);
    let indices = quads.flat_map(|k| [k, k + 2, k + 3, k, k + 3, k + 1]).collect();
    let colors = vec![LinearRgba::from(color).to_f32_array(); points.len()];
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, points)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
        .with_inserted_indices(Indices::U32(indices))
        .with_computed_smooth_normals()
}

/// A box on the deck or behind the stern: size and middle, m, tilt about x, rad, and colour.
type Fitting = (Vec3, Vec3, f32, Srgba);

const DARK: Srgba = Srgba::rgb(0.05, 0.05, 0.06);
const GLASS: Srgba = Srgba::rgb(0.12, 0.2, 0.24);
const SEAT: Srgba = Srgba::rgb(0.75, 0.7, 0.6);

/// Heights are above the deck in the middle of the boat.
const FITTINGS: [Fitting; 13] = [
    // The well: its floor and what is around it.
    (vec3(1.5, 0.02, 2.5), vec3(0.0, 0.01, 0.9), 0.0, SEAT),
    (vec3(0.08, 0.2, 2.6), vec3(0.76, 0.1, 0.9), 0.0, RAIL),
    (vec3(0.08, 0.2, 2.6), vec3(-0.76, 0.1, 0.9), 0.0, RAIL),
    (vec3(1.6, 0.2, 0.08), vec3(0.0, 0.1, 2.17), 0.0, RAIL),
    // Console and windscreen.
    (vec3(1.5, 0.3, 0.4), vec3(0.0, 0.15, -0.5), 0.0, RAIL),
    (vec3(1.4, 0.42, 0.03), vec3(0.0, 0.46, -0.52), -0.45, GLASS),
    // Seats with backs.
    (vec3(0.5, 0.28, 0.45), vec3(-0.36, 0.15, 0.5), 0.0, SIDE),
    (vec3(0.5, 0.4, 0.1), vec3(-0.36, 0.4, 0.75), -0.15, SIDE),
    (vec3(0.5, 0.28, 0.45), vec3(0.36, 0.15, 0.5), 0.0, SIDE),
    (vec3(0.5, 0.4, 0.1), vec3(0.36, 0.4, 0.75), -0.15, SIDE),
    // A hatch on the foredeck.
    (vec3(0.6, 0.05, 0.6), vec3(0.0, 0.02, -1.6), 0.0, RAIL),
    // The engine, and its leg with propeller and rudder.
    (vec3(0.42, 0.55, 0.5), vec3(0.0, 0.28, 2.95), -0.1, DARK),
    (vec3(0.09, 1.0, 0.24), vec3(0.0, -0.45, 2.95), 0.0, DARK),
];

/// Spawns the fittings on `boat`.
pub fn fit_out(
    commands: &mut Commands,
    boat: Entity,
    meshes: &mut Assets<Mesh>,
    materials: &mut Assets<StandardMaterial>,
) {
    let [stern, bow] = [0, SECTIONS - 1].map(|k| section(k)[3]);
    // The deck rises to the bow.
    let deck = Transform::from_xyz(0.0, 0.5 * (stern.y + bow.y), 0.0)
        .with_rotation(Quat::from_rotation_x(((bow.y - stern.y) / LENGTH).atan()));
    for (size, middle, tilt, color) in FITTINGS {
        let pose = Transform::from_translation(middle).with_rotation(Quat::from_rotation_x(tilt));
        let material = StandardMaterial { base_color: color.into(), perceptual_roughness: 0.4, ..default() };
        commands.spawn((
            ChildOf(boat),
            Mesh3d(meshes.add(Cuboid::from_size(size))),
            MeshMaterial3d(materials.add(material)),
            deck * pose,
        ));
    }
}
