//! A lantern with a candle's light.
use bevy::{light::NotShadowCaster, prelude::*};

/// Luminous intensity of the flame, cd: that of a few candles.
const INTENSITY: f32 = 4.0;
/// Radius of the glass, m.
const RADIUS: f32 = 0.07;
/// Light of 1900 K.
const COLOR: LinearRgba = LinearRgba::rgb(1.0, 0.46, 0.12);

/// Spawns a lantern at `pose`: a ball of glass on a post of `height` metres, and the light in it.
pub fn spawn_lantern(
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    materials: &mut Assets<StandardMaterial>,
    pose: Transform,
    height: f32,
) -> Entity {
    // A ball of radius r and intensity I has the luminance I/(π r²).
    let luminance = INTENSITY / (std::f32::consts::PI * RADIUS * RADIUS);
    let glass = materials.add(StandardMaterial {
        base_color: Color::BLACK,
        emissive: COLOR * luminance,
        emissive_exposure_weight: 1.0,
        ..default()
    });
    let wood = materials.add(StandardMaterial {
        base_color: Color::srgb(0.2, 0.14, 0.1),
        perceptual_roughness: 0.9,
        ..default()
    });
    let light = PointLight {
        color: COLOR.into(),
        intensity: 4.0 * std::f32::consts::PI * INTENSITY,
        range: 60.0,
        radius: RADIUS,
        ..default()
    };
    let top = Transform::from_xyz(0.0, height, 0.0);
    let middle = Transform::from_xyz(0.0, 0.5 * height, 0.0);
    commands
        .spawn((
            Name::new("lantern"),
            pose,
            Visibility::default(),
            children![
                (Mesh3d(meshes.add(Sphere::new(RADIUS))), MeshMaterial3d(glass), NotShadowCaster, top),
                (light, top),
                (Mesh3d(meshes.add(Cylinder::new(0.03, height))), MeshMaterial3d(wood), middle),
            ],
        ))
        .id()
}
