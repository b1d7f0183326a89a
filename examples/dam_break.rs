//! A column of water falls over real terrain: it is simulated, drawn as it is simulated, and carries crates along.
mod common;

use bevy::{camera::Hdr, light::CascadeShadowConfigBuilder, prelude::*};
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use clap::Parser;
use common::{Canvas, Loading, Options};

/// World height at which the simulation measures its levels, m above the sea.
const LEVEL: f32 = 0.8;

fn main() -> AppExit {
    let mut app = common::app("bevy_freshet: dam break", &Options::parse());
    app.add_plugins((RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule(), WaterPlugin, SkyPlugin))
        .insert_resource(TimestepMode::Fixed { dt: common::FRAME as f32, substeps: 1 })
        .add_systems(Startup, (setup, crates));
    #[cfg(feature = "panel")]
    app.add_plugins(bevy_freshet::panel::WaterPanelPlugin::default());
    common::run(app)
}

fn setup(mut commands: Commands, assets: Res<AssetServer>, mut loading: ResMut<Loading>, canvas: Res<Canvas>) {
    // The ground: a tidal river and its marsh, 600 m × 904 m.
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/terrain/tidal_river_2m.asc");
    let bed = WaterBed::from_file(file).unwrap_or_else(|problem| common::fail(problem)).filled(2.0);
    let collider = ground_collider(&bed);
    let [mud, sand, grass] = ["mud", "sand", "grass"].map(|name| assets.load(format!("textures/{name}.png")));
    loading.0.extend([&mud, &sand, &grass].map(|texture| texture.clone().untyped()));
    let shading = BedShading { level: LEVEL, mud: Some(mud), sand: Some(sand), grass: Some(grass), ..default() };
    commands.spawn((bed, shading, RigidBody::Fixed, collider));

    // 128 m × 96 m of it are simulated in cells of 1 m. Nothing is wet but a column of 24 m × 40 m, 5 m high.
    commands.spawn((
        Water::new(vec2(128.0, 96.0)),
        WaterSimulation {
            cell_size: 1.0,
            start: SimulationStart::Column { at: vec2(-40.0, 0.0), half_size: vec2(12.0, 20.0), level: 5.0 },
            ..default()
        },
        WaterEdges { parts: DomainSide::ALL.map(|side| WaterEdge::all(side, Edge::Open)).into(), ..default() },
        WaterOptics::MUDDY,
        // Foam where the front breaks, and not wherever the water is fast.
        WaterFoam { speed: 0.0, ..default() },
        Transform::from_xyz(-20.0, LEVEL, 40.0),
    ));

    // The sky lights the scene; its sun casts shadows.
    let cascades = CascadeShadowConfigBuilder { maximum_distance: 250.0, ..default() }.build();
    commands.spawn((Sky::default(), DirectionalLight { shadow_maps_enabled: true, ..default() }, cascades));
    commands.spawn((
        Camera3d::default(),
        Hdr,
        canvas.target(),
        SkyView::default(),
        Transform::from_xyz(-6.0, 9.0, 74.0).looking_at(vec3(-44.0, 1.0, 38.0), Vec3::Y),
    ));
}

/// The ground that bodies stand on.
fn ground_collider(bed: &WaterBed) -> Collider {
    let (grid, size) = (bed.elevations(), bed.elevations().size());
    // Rapier wants columns of rising z, one after the other.
    let heights = (0..size.x).flat_map(|x| (0..size.y).map(move |z| uvec2(x, z)));
    let heights = heights.map(|cell| grid.get(cell).copied().unwrap_or_default()).collect();
    let extent = (size.as_vec2() - 1.0) * grid.cell_size();
    Collider::heightfield(heights, size.y as usize, size.x as usize, vec3(extent.x, 1.0, extent.y))
}

/// Crates in the way of the water.
fn crates(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut materials: ResMut<Assets<StandardMaterial>>) {
    let (mesh, wood) = (meshes.add(Cuboid::from_length(1.6)), materials.add(Color::srgb(0.72, 0.45, 0.2)));
    for k in 0..12 {
        commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(0.8, 0.8, 0.8),
            Floating::with_density(350.0),
            Mesh3d(mesh.clone()),
            MeshMaterial3d(wood.clone()),
            Transform::from_xyz(-30.0 + 6.0 * (k % 4) as f32, 5.0, 30.0 + 7.0 * (k / 4) as f32),
        ));
    }
}
