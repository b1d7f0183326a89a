//! All that shines above: what the sun makes of air and clouds, what the moon makes of them, and the stars.

use super::{
    Moon, Sky,
    clear::ClearSky,
    cubemap::Cubemap,
    dome::{self, CloudMap, Dome},
    moon::LUNAR_RADIUS,
    stars::add_stars,
    sun::{self, SOLAR_RADIUS},
};
use bevy::math::Vec3;
use hw_skymodel::rgb::Error;

/// The moon is left out of the air where it adds less than this share to the light of the ground.
const UNSEEN: f32 = 1e-3;

/// The lit sky of a moment.
pub(super) struct Firmament {
    /// Radiance of sky and ground without the discs of sun and moon, cd/m² per channel.
    pub radiance: Cubemap,
    sun: Dome,
    /// The sky as if the moon were the sun, and moonlight as a share of sunlight.
    moonlit: Option<(Dome, Vec3)>,
}

impl Firmament {
    /// Paints a sane sky; `clouds` must be its own.
    ///
    /// # Errors
    /// Turbidity or albedo out of the sky model's range.
    pub fn new(sky: &Sky, clouds: &CloudMap) -> Result<Self, Error> {
        let sun = dome(sky, clouds)?;
        // Air and clouds are linear in the light that they get.
        let moonlit = match sky.moon.filter(|moon| is_seen(moon, sky)) {
            Some(moon) => {
                let as_sun = Sky { sun_elevation: moon.elevation, sun_azimuth: moon.azimuth, ..*sky };
                Some((dome(&as_sun, clouds)?, moon.light()))
            }
            None => None,
        };
        let mut radiance = sun.radiance.clone();
        if let Some((moon, share)) = &moonlit {
            for (sum, texel) in radiance.texels.iter_mut().zip(&moon.radiance.texels) {
                *sum += *texel * *share;
            }
        }
        let direct = dome::direct_share(sky.cloud_cover);
        add_stars(&mut radiance, sky.seed, |texel, direction| {
            let air = sun::transmittance(direction.y.asin(), sky.turbidity);
            air * (sky.stars * direct * clouds.clearness(texel))
        });
        Ok(Self { radiance, sun, moonlit })
    }

    /// Radiance without clouds and stars.
    pub fn air(&self, direction: Vec3) -> Vec3 {
        let moonlit = self.moonlit.as_ref().map(|(dome, share)| dome.air(direction) * *share);
        self.sun.air(direction) + moonlit.unwrap_or_default()
    }

    /// The sky with the discs of sun and moon, dimmed by the clouds before them.
    pub fn with_discs(&self, sky: &Sky, clouds: &CloudMap) -> Cubemap {
        let to_sun = sky.direction_to_sun();
        let sun = Disc {
            direction: to_sun,
            radius: SOLAR_RADIUS,
            radiance: sun::disc_radiance(sun_illuminance(sky)),
            shape: |_: Vec3| true,
        };
        let mut map = self.radiance.clone();
        sun.paint(&mut map, clouds);
        if let Some(moon) = sky.moon {
            Disc {
                direction: moon.direction(),
                radius: LUNAR_RADIUS,
                radiance: moon.disc_radiance(moon_illuminance(sky)),
                shape: |direction: Vec3| moon.is_lit(direction, to_sun),
            }
            .paint(&mut map, clouds);
        }
        map
    }
}

fn dome(sky: &Sky, clouds: &CloudMap) -> Result<Dome, Error> {
    let clear = ClearSky::new(sky.sun_elevation, sky.sun_azimuth, sky.turbidity, sky.ground_albedo)?;
    Ok(Dome::new(clear, clouds, sky))
}

fn is_seen(moon: &Moon, sky: &Sky) -> bool {
    let moonlight = sun::ground_illuminance(moon.elevation) * sun::luminance(moon.light());
    moonlight > UNSEEN * sun::ground_illuminance(sky.sun_elevation)
}

/// Illuminance of a surface that faces the sun, in lux per channel, averaged over what the clouds let through.
pub(super) fn sun_illuminance(sky: &Sky) -> Vec3 {
    beam(sky.sun_elevation, sky)
}

/// The same for a surface that faces the moon.
pub(super) fn moon_illuminance(sky: &Sky) -> Vec3 {
    sky.moon.map_or(Vec3::ZERO, |moon| beam(moon.elevation, sky) * moon.light())
}

/// The direct light of a disc as bright as the sun.
fn beam(elevation: f32, sky: &Sky) -> Vec3 {
    sun::beam(elevation, sky.turbidity) * (sun::visible_share(elevation) * dome::direct_share(sky.cloud_cover))
}

/// Sun or moon as seen.
struct Disc<S: Fn(Vec3) -> bool> {
    direction: Vec3,
    /// Angular radius, radians.
    radius: f32,
    /// cd/m² per channel.
    radiance: Vec3,
    /// Which directions within the disc shine.
    shape: S,
}

impl<S: Fn(Vec3) -> bool> Disc<S> {
    /// Adds the disc to a map, its edge smoothed over the texels it crosses.
    fn paint(&self, map: &mut Cubemap, clouds: &CloudMap) {
        let size = map.size;
        let reach = (self.radius + 2.0 / size as f32).cos();
        for (index, radiance) in map.texels.iter_mut().enumerate() {
            let direction = Cubemap::direction(size, index);
            if direction.dot(self.direction) >= reach {
                *radiance += self.radiance * (clouds.clearness(index) * self.share(direction, size));
            }
        }
    }

    /// The share of a texel that shines, from 8 × 8 directions in it.
    fn share(&self, direction: Vec3, size: usize) -> f32 {
        const SAMPLES: usize = 8;
        let inside = self.radius.cos();
        // Faces are square to their axis: a step of a texel is longer across it than the angle it covers.
        let axis = direction.abs().max_element();
        let (right, up) = direction.any_orthonormal_pair();
        let step = 2.0 / size as f32 * axis;
        let offset = |i: usize| ((i as f32 + 0.5) / SAMPLES as f32 - 0.5) * step;
        let shines = |i: usize, j: usize| {
            let d = (direction + right * offset(i) + up * offset(j)).normalize();
            d.dot(self.direction) > inside && (self.shape)(d)
        };
        let hits = (0..SAMPLES).flat_map(|i| (0..SAMPLES).map(move |j| (i, j))).filter(|(i, j)| shines(*i, *j)).count();
        hits as f32 / (SAMPLES * SAMPLES) as f32
    }
}
