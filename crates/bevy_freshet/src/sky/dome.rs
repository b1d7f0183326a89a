//! The whole sky as one picture: air, clouds and, where wanted, the solar disc.

use super::{
    Sky,
    clear::{ClearSky, smoothstep},
    clouds::{CloudLight, CloudTexel, Clouds},
    cubemap::{Cubemap, texels_from_fn},
    sun::{self, SOLAR_RADIUS, luminance},
};
use bevy::math::{FloatExt, Vec3, ops};
use std::f32::consts::{FRAC_PI_2, PI};

/// How far the horizon dips 1.5 km up, the angle √(2 H / R) in radians.
const CUMULUS_DIP: f32 = 0.022;
/// The same 8 km up.
const CIRRUS_DIP: f32 = 0.050;

/// Clouds as seen through every texel of a cube map; kept while the sun moves.
pub(super) struct CloudMap {
    /// Texels along an edge of a face.
    pub size: usize,
    clouds: Clouds,
    texels: Vec<CloudTexel>,
}

impl CloudMap {
    /// Lays out the clouds of a sane sky and traces them at its resolution.
    pub fn new(sky: &Sky) -> Self {
        let size = sky.resolution as usize;
        let clouds = Clouds::new(sky.seed, sky.cloud_cover);
        let width = FRAC_PI_2 / size as f32;
        let texels = texels_from_fn(size, |_, direction| clouds.trace(direction, width));
        Self { size, clouds, texels }
    }
}

/// How far a cover (0…1) is from fair weather to a closed layer, 0…1.
fn overcast(cover: f32) -> f32 {
    smoothstep(0.6, 1.0, cover)
}

/// The share of the sun's light that a scene under a cover (0…1) gets: fair-weather clouds let it through between them.
pub(super) fn direct_share(cover: f32) -> f32 {
    1.0.lerp(0.02, overcast(cover))
}

/// Everything that lights a scene under one position of the sun.
pub(super) struct Dome {
    /// Radiance of sky and ground without the solar disc, cd/m² per channel.
    pub radiance: Cubemap,
    /// Illuminance of a surface that faces the sun, lux per channel.
    pub sun_illuminance: Vec3,
    clear: ClearSky,
    overcast: f32,
    light: CloudLight,
}

impl Dome {
    /// Lights the clouds and paints the sky. `clear` and `map` must be those of `sky`.
    pub fn new(clear: ClearSky, map: &CloudMap, sky: &Sky) -> Self {
        // Clouds see a sun that is higher by the dip of their horizon, through what haze lies above them.
        let beam = |dip: f32, haze: f32| {
            let elevation = sky.sun_elevation + dip;
            sun::beam(elevation, 1.0 + haze * (sky.turbidity - 1.0)) * sun::visible_share(elevation)
        };
        let light = CloudLight {
            sun_direction: clear.sun_direction.with_y(clear.sun_direction.y.max(0.0) + CUMULUS_DIP).normalize(),
            sun: beam(CUMULUS_DIP, 0.5),
            high_sun: beam(CIRRUS_DIP, 0.1),
            sky: clear.sky_illuminance / PI,
            ground: clear.ground,
        };
        let mut dome = Self {
            radiance: Cubemap { size: map.size, texels: Vec::new() },
            sun_illuminance: clear.sun_illuminance * direct_share(sky.cloud_cover),
            clear,
            overcast: overcast(sky.cloud_cover),
            light,
        };
        // Koschmieder's law with the visibility of the turbidity, about 60 km for 2 and 20 km for 6.
        let clarity = -sky.turbidity / 110.0;
        dome.radiance = Cubemap::from_fn(map.size, |index, direction| {
            let air = dome.air(direction);
            let texel = &map.texels[index];
            let veiled = air.lerp(Clouds::veil_radiance(direction, &dome.light), texel.veil);
            if texel.opacity <= 0.0 {
                return veiled;
            }
            let cloud = map.clouds.radiance(direction, texel, &dome.light);
            let seen = air.lerp(cloud, ops::exp(clarity * texel.distance));
            veiled.lerp(seen, texel.opacity)
        });
        dome
    }

    /// Radiance without clouds; a closed cover leaves it grey and dim.
    pub fn air(&self, direction: Vec3) -> Vec3 {
        let radiance = self.clear.radiance(direction);
        radiance.lerp(Vec3::splat(0.55 * luminance(radiance)), 0.9 * self.overcast)
    }

    /// The sky with the solar disc, its edge smoothed over the texels it crosses, dimmed by the clouds before it.
    pub fn with_disc(&self, map: &CloudMap) -> Cubemap {
        let size = map.size;
        let disc = sun::disc_radiance(self.sun_illuminance);
        let reach = ops::cos(SOLAR_RADIUS + 2.0 / size as f32);
        Cubemap::from_fn(size, |index, direction| {
            let radiance = self.radiance.texels[index];
            if direction.dot(self.clear.sun_direction) < reach {
                return radiance;
            }
            let cloud = &map.texels[index];
            let through = (1.0 - cloud.opacity) * (1.0 - cloud.veil);
            radiance + disc * (through * disc_share(self.clear.sun_direction, direction, size))
        })
    }
}

/// The share of a texel that the disc covers, from 8 × 8 directions in it.
fn disc_share(sun: Vec3, direction: Vec3, size: usize) -> f32 {
    const SAMPLES: usize = 8;
    // Faces are square to their axis: a step of a texel is longer across it than the angle it covers.
    let axis = direction.abs().max_element();
    let (right, up) = direction.any_orthonormal_pair();
    let step = 2.0 / size as f32 * axis;
    let offset = |i: usize| ((i as f32 + 0.5) / SAMPLES as f32 - 0.5) * step;
    let inside = |i: usize, j: usize| {
        let d = (direction + right * offset(i) + up * offset(j)).normalize();
        d.dot(sun) > ops::cos(SOLAR_RADIUS)
    };
    let hits = (0..SAMPLES).flat_map(|i| (0..SAMPLES).map(move |j| (i, j))).filter(|(i, j)| inside(*i, *j)).count();
    hits as f32 / (SAMPLES * SAMPLES) as f32
}
