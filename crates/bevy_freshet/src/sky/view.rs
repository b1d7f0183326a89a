//! Cameras under the sky.

use super::{Sky, SkyMaps};
use bevy::{
    camera::Exposure,
    color::{Color, LinearRgba},
    ecs::prelude::*,
    light::{AmbientLight, EnvironmentMapLight, Skybox},
    pbr::{DistanceFog, FogFalloff},
    reflect::{Reflect, std_traits::ReflectDefault},
    transform::components::GlobalTransform,
};

/// Shows the [`Sky`] to a camera: put it next to `Camera3d`, at any time.
///
/// It keeps four other components up to date: [`Skybox`], [`EnvironmentMapLight`], [`Exposure`] and, if wanted,
/// [`DistanceFog`]. The rotations of the first two are left to you. Bevy's even [`AmbientLight`] is off for this camera, as
/// the sky lights the shade; insert your own to have both. A camera without `SkyView`, such as a minimap, stays as it is.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
#[require(Skybox, EnvironmentMapLight, Exposure, AmbientLight = no_ambient_light())]
pub struct SkyView {
    /// Distance in metres, above 0, at which haze in the colour of the horizon leaves 5 % of the contrast. Default: `None`,
    /// which leaves any fog of the camera alone.
    pub visibility: Option<f32>,
    /// Follow the light with the [`Exposure`], this many stops brighter (+) or darker (−). Default: `Some(0.0)`.
    /// `None` leaves the exposure alone.
    pub exposure: Option<f32>,
}

impl Default for SkyView {
    fn default() -> Self {
        Self { visibility: None, exposure: Some(0.0) }
    }
}

/// At night Bevy's default of 80 cd/m² would outshine everything.
fn no_ambient_light() -> AmbientLight {
    AmbientLight { brightness: 0.0, ..AmbientLight::default() }
}

/// Hands the maps and the exposure to the cameras.
pub(super) fn show_sky(
    maps: Query<(Entity, &SkyMaps), With<Sky>>,
    mut views: Query<(&SkyView, &mut Skybox, &mut EnvironmentMapLight, &mut Exposure)>,
) {
    let Some(maps) = drawn(&maps) else { return };
    for (view, mut skybox, mut environment, mut exposure) in &mut views {
        if skybox.image.as_ref() != Some(&maps.visible) || skybox.brightness != maps.brightness {
            skybox.image = Some(maps.visible.clone());
            skybox.brightness = maps.brightness;
        }
        if environment.specular_map != maps.specular || environment.intensity != maps.brightness {
            environment.diffuse_map = maps.diffuse.clone();
            environment.specular_map = maps.specular.clone();
            environment.intensity = maps.brightness;
        }
        if let Some(stops) = view.exposure
            && exposure.ev100 != maps.ev100 - stops
        {
            exposure.ev100 = maps.ev100 - stops;
        }
    }
}

/// Gives the haze of each camera the colour of the horizon it looks at.
pub(super) fn tint_fog(
    maps: Query<(Entity, &SkyMaps), With<Sky>>,
    mut views: Query<(Entity, &SkyView, &Exposure, &GlobalTransform, Option<&mut DistanceFog>)>,
    mut commands: Commands,
) {
    let Some(maps) = drawn(&maps) else { return };
    for (entity, view, exposure, transform, fog) in &mut views {
        let Some(visibility) = view.visibility.filter(|v| *v > 0.0) else {
            continue;
        };
        // Bevy's fog is not exposed by the shader.
        let color = maps.horizon_color(transform.forward().as_vec3()) * exposure.exposure();
        let wanted = DistanceFog {
            color: Color::LinearRgba(LinearRgba::rgb(color.x, color.y, color.z)),
            falloff: FogFalloff::from_visibility(visibility),
            ..DistanceFog::default()
        };
        match fog {
            Some(mut fog) => {
                fog.color = wanted.color;
                fog.falloff = wanted.falloff;
            }
            None => {
                commands.entity(entity).try_insert(wanted);
            }
        }
    }
}

/// The maps of the sky that is drawn, once they are painted.
fn drawn<'a>(maps: &'a Query<(Entity, &SkyMaps), With<Sky>>) -> Option<&'a SkyMaps> {
    let (_, maps) = maps.iter().min_by_key(|(entity, _)| *entity)?;
    (maps.brightness > 0.0).then_some(maps)
}
