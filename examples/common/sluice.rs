//! A dike across the valley, full to the brim behind it, and a sluice that lets the water out over the plain.
use bevy::prelude::*;
use bevy_freshet::prelude::*;

/// Where the dike crosses the valley, z, and between which x; m.
const DIKE: f32 = 140.0;
const ENDS: [f32; 2] = [-301.0, 301.0];
/// Where the river passes it.
const SLUICE: [f32; 2] = [-136.0, -94.0];
/// Level of the water behind it and crest of the dike, m over the river's still level.
const BEHIND: f32 = 1.8;
const CREST: f32 = 2.4;
/// Where the gate is when it is open, m over the still level: under the bed.
const OPEN: f32 = -4.0;
const THICKNESS: f32 = 4.0;
/// Simulated time at which the gate begins to sink, and in which it does so, s.
const OPENS: f32 = 5.0;
const OPENING: f32 = 30.0;

/// The gate: its place and crest follow the clock of the river.
#[derive(Component)]
pub struct Gate;

/// What is wet in the beginning.
pub fn start() -> SimulationStart {
    // From the northern edge of the land to the dike.
    let (north, half_width) = (-452.0, 300.0);
    SimulationStart::Column {
        at: vec2(0.0, 0.5 * (north + DIKE)),
        half_size: vec2(half_width, 0.5 * (DIKE - north)),
        level: BEHIND,
    }
}

/// The dike and its closed gate, as the water feels them.
pub fn walls() -> WaterWalls {
    let wall = |from, to| WaterWall { from: vec2(from, DIKE), to: vec2(to, DIKE), crest: CREST };
    WaterWalls { walls: vec![wall(SLUICE[0], SLUICE[1]), wall(ENDS[0], SLUICE[0]), wall(SLUICE[1], ENDS[1])] }
}

/// Spawns what is seen of them, at the world height `level` of the river.
pub fn spawn_dike(
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    materials: &mut Assets<StandardMaterial>,
    level: f32,
) {
    let height = CREST - OPEN;
    let mut block = |from: f32, to: f32, rises: f32, color: Color| {
        let size = vec3(to - from, height, THICKNESS);
        let place = Transform::from_xyz(0.5 * (from + to), level + CREST + rises - 0.5 * height, DIKE);
        let material = materials.add(StandardMaterial { base_color: color, perceptual_roughness: 0.95, ..default() });
        (Mesh3d(meshes.add(Cuboid::from_size(size))), MeshMaterial3d(material), place)
    };
    let concrete = Color::srgb(0.42, 0.41, 0.39);
    commands.spawn((Name::new("dike"), block(ENDS[0], SLUICE[0], 0.15, concrete)));
    commands.spawn((Name::new("dike"), block(SLUICE[1], ENDS[1], 0.15, concrete)));
    commands.spawn((Name::new("gate"), Gate, block(SLUICE[0], SLUICE[1], 0.0, Color::srgb(0.25, 0.17, 0.12))));
}

/// Lets the gate sink into its bed.
pub fn open(mut rivers: Query<(&SimulationState, &mut WaterWalls)>, mut gates: Query<&mut Transform, With<Gate>>) {
    for (state, mut walls) in &mut rivers {
        let share = ((state.time as f32 - OPENS) / OPENING).clamp(0.0, 1.0);
        let crest = CREST + share * (OPEN - CREST);
        let Some(gate) = walls.walls.first().filter(|gate| gate.crest != crest) else { continue };
        let sunk = crest - gate.crest;
        walls.walls[0].crest = crest;
        for mut gate in &mut gates {
            gate.translation.y += sunk;
        }
    }
}
