//! The component [`Sky`].

use super::{Moon, maps::SkyMaps, sun};
use crate::report::Reported;
use bevy::{
    camera::visibility::Visibility,
    ecs::prelude::*,
    light::{CascadeShadowConfig, CascadeShadowConfigBuilder, DirectionalLight},
    math::{Vec3, ops},
    reflect::{Reflect, std_traits::ReflectDefault},
    transform::components::Transform,
};
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// Sun, air and clouds over the scene: spawn one, and put a [`SkyView`](super::SkyView) on each camera that shall see it.
///
/// The entity *is* the sun, and at night the moon: it carries a [`DirectionalLight`], whose colour, illuminance and rotation
/// follow whichever of the two gives more light. They change places when the sun has all but set and the twilight outshines
/// both by a thousand to one, so nothing jumps that one could see.
///
/// Everything else of the light is yours: insert your own [`DirectionalLight`] or [`CascadeShadowConfig`] to turn shadows
/// off or to reach farther. One sky is drawn; further ones only shine.
///
/// Values outside their range are drawn as the nearest one inside, with a warning.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
#[require(SkyMaps, DirectionalLight = sunlight(), CascadeShadowConfig = shadow_cascades(), Transform, Visibility)]
pub struct Sky {
    /// Angle of the sun's centre above the horizon, in radians, −π/2…π/2. Default: 0.61 (35°).
    ///
    /// 0 is sunset; until −0.1 (−6°) one can read outdoors, from −0.3 (−18°) on it is night.
    pub sun_elevation: f32,
    /// Bearing of the sun in radians: 0 is north (−z), growing clockwise to east (+x). Any value. Default: 2.4 (137°).
    pub sun_azimuth: f32,
    /// Haziness of the air, 1…10, no unit. Default: 2.5.
    ///
    /// 2 is a clear day after rain, 3 an ordinary one, 6 and more a hazy one: whiter, with a broader glow around the sun.
    pub turbidity: f32,
    /// Share of the light that the land around reflects, linear RGB, 0…1. Default: 0.14, 0.14, 0.11 (meadow).
    ///
    /// It colours what lies below the horizon, the bases of the clouds and, a little, the sky.
    pub ground_albedo: Vec3,
    /// Share of the sky's plane under cumulus, 0…1. Default: 0.25. Above 0.6 the sun fades, at 1 the sky is overcast.
    pub cloud_cover: f32,
    /// The moon. Default: none.
    pub moon: Option<Moon>,
    /// Factor on the light of the stars, 0…100. Default: 1, as on a clear night far from towns.
    pub stars: f32,
    /// Which clouds and stars: each value gives others. Default: 1.
    pub seed: u32,
    /// Texels along an edge of the visible cube map, 64…2048, rounded up to a power of two. Default: 512.
    ///
    /// Time and memory (64 bytes a texel of a face) grow with its square. Reflections use half of it.
    pub resolution: u32,
}

impl Default for Sky {
    fn default() -> Self {
        Self {
            sun_elevation: 0.61,
            sun_azimuth: 2.4,
            turbidity: 2.5,
            ground_albedo: Vec3::new(0.14, 0.14, 0.11),
            cloud_cover: 0.25,
            moon: None,
            stars: 1.0,
            seed: 1,
            resolution: 512,
        }
    }
}

impl Sky {
    /// The default sky with the sun at an elevation and an azimuth, both in **degrees**.
    pub fn with_sun(elevation_degrees: f32, azimuth_degrees: f32) -> Self {
        Self {
            sun_elevation: elevation_degrees.to_radians(),
            sun_azimuth: azimuth_degrees.to_radians(),
            ..Self::default()
        }
    }

    /// The default sky at midnight with a full moon at an elevation and an azimuth, both in **degrees**.
    pub fn with_full_moon(elevation_degrees: f32, azimuth_degrees: f32) -> Self {
        let moon = Some(Moon::full(elevation_degrees, azimuth_degrees));
        Self { moon, ..Self::with_sun(-40.0, azimuth_degrees + 180.0) }
    }

    /// Unit vector from the scene to the sun.
    pub fn direction_to_sun(&self) -> Vec3 {
        sun::direction(self.sun_elevation, self.sun_azimuth)
    }

    /// The nearest sky that can be drawn; complains about each field that had to be changed for it.
    pub(super) fn usable(&self, entity: Entity, reported: &mut Reported) -> Self {
        let usual = Self::default();
        let mut within = |field, value, range, fallback| reported.clamp(entity, field, value, range, fallback);
        let azimuth = within("Sky::sun_azimuth", self.sun_azimuth, -1e6..=1e6, usual.sun_azimuth);
        let moon = self.moon.map(|moon| {
            let usual = Moon::default();
            let azimuth = within("Moon::azimuth", moon.azimuth, -1e6..=1e6, usual.azimuth);
            Moon {
                elevation: within("Moon::elevation", moon.elevation, -FRAC_PI_2..=FRAC_PI_2, usual.elevation),
                azimuth: ops::rem_euclid(azimuth, TAU),
                phase: within("Moon::phase", moon.phase, 0.0..=PI, usual.phase),
            }
        });
        Self {
            sun_elevation: within(
                "Sky::sun_elevation",
                self.sun_elevation,
                -FRAC_PI_2..=FRAC_PI_2,
                usual.sun_elevation,
            ),
            sun_azimuth: ops::rem_euclid(azimuth, TAU),
            turbidity: within("Sky::turbidity", self.turbidity, 1.0..=10.0, usual.turbidity),
            cloud_cover: within("Sky::cloud_cover", self.cloud_cover, 0.0..=1.0, usual.cloud_cover),
            moon,
            stars: within("Sky::stars", self.stars, 0.0..=100.0, usual.stars),
            resolution: within("Sky::resolution", self.resolution as f32, 64.0..=2048.0, 512.0) as u32,
            ground_albedo: reported.clamp3(
                entity,
                "Sky::ground_albedo",
                self.ground_albedo,
                0.0..=1.0,
                usual.ground_albedo,
            ),
            seed: self.seed,
        }
        .with_whole_faces()
    }

    /// Halving the faces down to one texel needs a power of two.
    fn with_whole_faces(self) -> Self {
        Self { resolution: self.resolution.next_power_of_two(), ..self }
    }
}

/// A light that casts shadows; its brightness is set from the sky.
fn sunlight() -> DirectionalLight {
    DirectionalLight { shadow_maps_enabled: true, ..DirectionalLight::default() }
}

/// Shadows for a scene of the size of a river: three cascades, sharp for 15 m, ending at 200 m.
fn shadow_cascades() -> CascadeShadowConfig {
    CascadeShadowConfigBuilder {
        num_cascades: 3,
        first_cascade_far_bound: 15.0,
        maximum_distance: 200.0,
        ..CascadeShadowConfigBuilder::default()
    }
    .build()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sane_sky_is_left_alone() {
        assert_eq!(Sky::default().usable(Entity::PLACEHOLDER, &mut Reported::default()), Sky::default());
    }

    #[test]
    fn senseless_values_are_replaced() {
        let bad = Sky {
            sun_elevation: f32::NAN,
            sun_azimuth: f32::INFINITY,
            turbidity: 40.0,
            ground_albedo: Vec3::new(-1.0, f32::NAN, 2.0),
            cloud_cover: -0.5,
            moon: Some(Moon { elevation: f32::NAN, azimuth: 7.0, phase: -1.0 }),
            stars: f32::INFINITY,
            resolution: 0,
            seed: 0,
        };
        let usable = bad.usable(Entity::PLACEHOLDER, &mut Reported::default());
        assert_eq!(usable.sun_elevation, Sky::default().sun_elevation);
        assert_eq!((usable.turbidity, usable.cloud_cover, usable.resolution), (10.0, 0.0, 64));
        assert_eq!(usable.stars, 100.0);
        let moon = usable.moon.unwrap();
        assert_eq!((moon.elevation, moon.azimuth, moon.phase), (Moon::default().elevation, 7.0 - TAU, 0.0));
        assert_eq!(usable, usable.usable(Entity::PLACEHOLDER, &mut Reported::default()));
    }
}
