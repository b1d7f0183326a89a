//! The whole sky under one light as one picture: air and clouds.

use super::{
    Sky,
    clear::{ClearSky, smoothstep},
    clouds::{CloudLight, CloudTexel, Clouds},
    cubemap::{Cubemap, texels_from_fn},
    sun::{self, luminance},
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

    /// Share of the light from behind the clouds that a texel lets through.
    pub fn clearness(&self, texel: usize) -> f32 {
        let CloudTexel { opacity, veil, .. } = self.texels[texel];
        (1.0 - opacity) * (1.0 - veil)
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

/// What air and clouds make of the sun in one position.
pub(super) struct Dome {
    /// Radiance of sky and ground without disc and stars, cd/m² per channel.
    pub radiance: Cubemap,
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
}
