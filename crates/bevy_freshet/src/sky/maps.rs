//! Painting the sky: what [`SkyMaps`] holds and when it is made anew.

use super::{
    Sky,
    dome::CloudMap,
    filter,
    firmament::{Firmament, moon_illuminance, sun_illuminance},
    image,
    sun::{self, luminance},
};
use crate::report::Reported;
use bevy::{
    asset::{Assets, Handle},
    color::{Color, LinearRgba},
    ecs::prelude::*,
    image::Image,
    light::DirectionalLight,
    log::error,
    math::{Vec3, ops},
    reflect::{Reflect, std_traits::ReflectDefault},
    transform::components::Transform,
};
use std::f32::consts::{PI, TAU};

/// Sun or moon move this far, in radians, before the sky is painted anew (0.06°, a quarter of a minute of real time).
const REPAINT_ANGLE: f32 = 0.001;

/// Bearings for which the colour of the horizon is kept.
const BEARINGS: usize = 32;

/// What a [`Sky`] looks like: made by the plugin, read by anything that shows, mirrors or scatters it.
///
/// Radiance is linear sRGB; its luminance is in cd/m² once multiplied by [`brightness`](Self::brightness).
#[derive(Component, Clone, Debug, Default, Reflect)]
#[reflect(Component, Default, Debug, Clone)]
pub struct SkyMaps {
    /// Cube map of the sky as seen, with the discs of sun and moon; one level.
    pub visible: Handle<Image>,
    /// Cube map without the discs, blurred for one roughness per level: the `specular_map` of an environment light.
    pub specular: Handle<Image>,
    /// Cube map of irradiance / π: the `diffuse_map` of an environment light.
    pub diffuse: Handle<Image>,
    /// cd/m² per unit in the three maps; the mean luminance of the upper half of the sky.
    pub brightness: f32,
    /// Illuminance of a surface that faces the sun, by the sun alone, in lux per channel.
    pub sun_illuminance: Vec3,
    /// Illuminance of a surface that faces the moon, by the moon alone, in lux per channel.
    pub moon_illuminance: Vec3,
    /// Illuminance of level ground by the sky alone, in lux per channel.
    pub sky_illuminance: Vec3,
    /// Exposure value at ISO 100 with which a camera shows this light as one is used to see it.
    pub ev100: f32,
    horizon: Vec<Vec3>,
}

impl SkyMaps {
    /// Mean radiance of the horizon within 45° of a direction, in cd/m² per linear sRGB channel: the colour of far haze.
    pub fn horizon_color(&self, direction: Vec3) -> Vec3 {
        let (mut sum, mut total) = (Vec3::ZERO, f32::MIN_POSITIVE);
        let level = Vec3::new(direction.x, 0.0, direction.z).normalize_or_zero();
        for (bearing, radiance) in self.horizon.iter().enumerate() {
            let weight = (sun::direction(0.0, bearing_angle(bearing)).dot(level) - 0.7).max(0.0);
            sum += *radiance * weight;
            total += weight;
        }
        sum / total
    }
}

fn bearing_angle(bearing: usize) -> f32 {
    bearing as f32 * TAU / BEARINGS as f32
}

/// Turns and colours every sun, and repaints the first sky when it has changed enough to be seen.
pub(super) fn update_skies(
    mut skies: Query<(Entity, Ref<Sky>, &mut SkyMaps, &mut DirectionalLight, &mut Transform)>,
    mut images: ResMut<Assets<Image>>,
    mut painter: Local<Painter>,
    mut reported: ResMut<Reported>,
) {
    let drawn = skies.iter().map(|(entity, ..)| entity).min();
    for (entity, sky, mut maps, mut light, mut transform) in &mut skies {
        // The next sky takes over when the one that was drawn is gone.
        let takes_over = Some(entity) == drawn && painter.last.is_some_and(|(painted, _)| painted != entity);
        if !sky.is_changed() && !takes_over {
            continue;
        }
        let sky = &sky.usable(entity, &mut reported);
        shine(sky, &mut light, &mut transform);
        if Some(entity) != drawn {
            reported.warn(entity, "Sky", "is not the only one: it shines but another one is drawn");
        } else if painter.is_due(entity, sky) {
            painter.paint(entity, sky, &mut maps, &mut images);
        }
    }
}

/// Sets what the sky decides about its light, and nothing else of it: it is the brighter one of sun and moon.
fn shine(sky: &Sky, light: &mut DirectionalLight, transform: &mut Transform) {
    let (sun, moon) = (sun_illuminance(sky), moon_illuminance(sky));
    let (color, direction) = match sky.moon {
        Some(there) if luminance(moon) > luminance(sun) => (moon, there.direction()),
        _ => (sun, sky.direction_to_sun()),
    };
    light.illuminance = luminance(color);
    // The light's colour times its illuminance must be `color`.
    let unit = if light.illuminance > 0.0 { color / light.illuminance } else { Vec3::ONE };
    light.color = Color::LinearRgba(LinearRgba::rgb(unit.x, unit.y, unit.z));
    transform.rotation = Transform::default().looking_to(-direction, Vec3::Z).rotation;
}

/// What was painted last, and the parts that serve again.
#[derive(Default)]
pub(super) struct Painter {
    last: Option<(Entity, Sky)>,
    clouds: Option<(Sky, CloudMap)>,
}

impl Painter {
    fn is_due(&self, entity: Entity, sky: &Sky) -> bool {
        let Some((painted, last)) = self.last else {
            return true;
        };
        let has_moved = |from: Vec3, to: Vec3| from.angle_between(to) > REPAINT_ANGLE;
        let moon_moved = match (last.moon, sky.moon) {
            (Some(last), Some(moon)) => {
                has_moved(last.direction(), moon.direction()) || (last.phase - moon.phase).abs() > REPAINT_ANGLE
            }
            (last, moon) => last != moon,
        };
        let moved = moon_moved || has_moved(last.direction_to_sun(), sky.direction_to_sun());
        let elsewhere = Sky { sun_elevation: sky.sun_elevation, sun_azimuth: sky.sun_azimuth, moon: sky.moon, ..last };
        moved || painted != entity || elsewhere != *sky
    }

    fn paint(&mut self, entity: Entity, sky: &Sky, maps: &mut SkyMaps, images: &mut Assets<Image>) {
        let clouds = self.clouds(sky);
        let firmament = match Firmament::new(sky, clouds) {
            Ok(firmament) => firmament,
            Err(reason) => return error!("the sky of entity {entity} cannot be painted: {reason}"),
        };
        let visible = firmament.with_discs(sky, clouds);
        self.last = Some((entity, *sky));
        let half = filter::pyramid(firmament.radiance.halved());
        let (sun, moon) = (sun_illuminance(sky), moon_illuminance(sky));
        let direct = luminance(sun) * sky.sun_elevation.sin().max(0.0)
            + luminance(moon) * sky.moon.map_or(0.0, |moon| moon.elevation.sin().max(0.0));

        let sky_illuminance = half[0].integrate(|d| d.y.max(0.0));
        let brightness = (luminance(sky_illuminance) / PI).max(1e-6);
        let scale = 1.0 / brightness;
        *maps = SkyMaps {
            visible: replaced(images, &maps.visible, image::cube_image("sky_visible", &[visible], scale)),
            specular: replaced(
                images,
                &maps.specular,
                image::cube_image("sky_specular", &filter::specular(&half), scale),
            ),
            diffuse: replaced(
                images,
                &maps.diffuse,
                image::cube_image("sky_diffuse", &[filter::diffuse(&half)], scale),
            ),
            brightness,
            sun_illuminance: sun,
            moon_illuminance: moon,
            sky_illuminance,
            ev100: exposure_value(luminance(sky_illuminance), direct),
            horizon: (0..BEARINGS).map(|b| firmament.air(sun::direction(0.005, bearing_angle(b)))).collect(),
        };
    }

    /// The clouds of this seed, cover and resolution; traced only when one of the three is new.
    fn clouds(&mut self, sky: &Sky) -> &CloudMap {
        let same = |a: &Sky| (a.seed, a.cloud_cover, a.resolution) == (sky.seed, sky.cloud_cover, sky.resolution);
        let kept = self.clouds.take().filter(|(of, _)| same(of));
        &self.clouds.insert(kept.unwrap_or_else(|| (*sky, CloudMap::new(sky)))).1
    }
}

/// Puts an image in the place of an earlier one, so that those who hold the handle see the new one.
fn replaced(images: &mut Assets<Image>, handle: &Handle<Image>, image: Image) -> Handle<Image> {
    if *handle == Handle::default() {
        return images.add(image);
    }
    if let Err(reason) = images.insert(handle, image) {
        error!("the sky cannot be repainted: {reason}");
    }
    handle.clone()
}

/// Exposure value for a scene on level ground under `sky` lux and `direct` lux of sun and moon.
///
/// Metered as ISO 2720 does incident light, EV = log₂(E / 3.3 lx), but never so long that the sky, of mean luminance L,
/// comes out more than 1.7 stops above middle grey, EV = log₂(8 L) − 1.7: that is what keeps a low sun golden. In the dark
/// a picture is left darker than by day, as it is seen: by a third of a stop for each stop below 100 lx, five at most.
fn exposure_value(sky: f32, direct: f32) -> f32 {
    let ground = (sky + direct).max(1e-4);
    let incident = ops::log2(ground / 3.3);
    let reflected = ops::log2(8.0 * sky.max(1e-4) / PI) - 1.7;
    let dark = ops::log2(100.0 / ground).max(0.0);
    incident.max(reflected) + (dark / 3.0).min(5.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::{Moon, SkyPlugin, SkyView, cubemap::Cubemap};
    use bevy::{
        camera::Exposure,
        light::{EnvironmentMapLight, Skybox},
        prelude::{App, AssetApp, AssetPlugin, MinimalPlugins, TransformPlugin},
    };
    use half::f16;

    const PLAIN: fn(f32) -> Sky = |degrees| Sky { cloud_cover: 0.0, resolution: 64, ..Sky::with_sun(degrees, 70.0) };

    /// An app without a renderer, its sky and a camera-like entity that sees it.
    fn app(sky: Sky) -> (App, Entity, Entity) {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, AssetPlugin::default(), TransformPlugin, SkyPlugin)).init_asset::<Image>();
        let sky = app.world_mut().spawn(sky).id();
        let view = app.world_mut().spawn(SkyView::default()).id();
        app.update();
        (app, sky, view)
    }

    fn texels(app: &App, handle: &Handle<Image>) -> Vec<u8> {
        let images = app.world().resource::<Assets<Image>>();
        images.get(handle).unwrap().data.clone().unwrap()
    }

    /// World direction of the brightest texel of the first level.
    fn brightest(app: &App, handle: &Handle<Image>) -> Vec3 {
        let images = app.world().resource::<Assets<Image>>();
        let (size, levels) = {
            let image = images.get(handle).unwrap();
            (image.width() as usize, image.texture_descriptor.mip_level_count)
        };
        let bytes = texels(app, handle);
        let face_bytes = bytes.len() / 6;
        let value = |index: usize| {
            let (face, texel) = (index / (size * size), index % (size * size));
            let at = face * face_bytes + texel * 8;
            f16::from_le_bytes([bytes[at + 2], bytes[at + 3]]).to_f32()
        };
        assert!(levels >= 1);
        let best = (0..6 * size * size).max_by(|a, b| value(*a).total_cmp(&value(*b))).unwrap();
        Cubemap::direction(size, best)
    }

    #[test]
    fn moving_the_sun_moves_light_sky_and_mirrors() {
        let (mut app, sky, view) = app(PLAIN(40.0));
        for (elevation, azimuth) in [(40.0, 70.0), (12.0, 250.0), (65.0, 160.0)] {
            let moved = Sky { sun_azimuth: f32::to_radians(azimuth), ..PLAIN(elevation) };
            *app.world_mut().get_mut::<Sky>(sky).unwrap() = moved;
            app.update();
            let world = app.world();
            let to_sun = moved.direction_to_sun();
            let shines = world.get::<Transform>(sky).unwrap().forward();
            assert!(shines.dot(-to_sun) > 0.999_99);
            let maps = world.get::<SkyMaps>(sky).unwrap();
            // A texel of 64 a face is at most 1.8° wide.
            assert!(brightest(&app, &maps.visible).angle_between(to_sun) < 0.025);
            assert!(brightest(&app, &maps.specular).angle_between(to_sun) < 0.05);
            let seen = world.get::<Skybox>(view).unwrap();
            assert_eq!((seen.image.as_ref(), seen.brightness), (Some(&maps.visible), maps.brightness));
            let environment = world.get::<EnvironmentMapLight>(view).unwrap();
            assert_eq!((&environment.specular_map, environment.intensity), (&maps.specular, maps.brightness));
            assert_eq!(world.get::<Exposure>(view).unwrap().ev100, maps.ev100);
        }
    }

    /// At dusk the light turns from the setting sun to the moon. What jumps must be lost in the light of the sky.
    #[test]
    fn the_light_passes_from_sun_to_moon_unseen() {
        let moon = Some(Moon::full(30.0, 300.0));
        let (mut turns, mut last) = (0, Vec3::ZERO);
        for step in 0..=600 {
            let sky = Sky { moon, ..PLAIN(2.0 - 0.01 * step as f32) };
            let (mut light, mut transform) = (DirectionalLight::default(), Transform::default());
            shine(&sky, &mut light, &mut transform);
            let towards = transform.back().as_vec3();
            if step > 0 && last.angle_between(towards) > 0.1 {
                turns += 1;
                let ground = sun::ground_illuminance(sky.sun_elevation);
                assert!(light.illuminance < 5e-3 * ground, "{} of {ground} lx", light.illuminance);
            }
            last = towards;
        }
        assert_eq!(turns, 1);
        assert!(last.distance(Moon::full(30.0, 300.0).direction()) < 1e-5);
    }

    #[test]
    fn the_light_keeps_what_the_user_set() {
        let (mut app, _, _) = app(PLAIN(30.0));
        let own = DirectionalLight { shadow_maps_enabled: false, shadow_depth_bias: 0.7, ..Default::default() };
        let sun = app.world_mut().spawn((PLAIN(20.0), own)).id();
        app.update();
        let light = app.world().get::<DirectionalLight>(sun).unwrap();
        assert!(!light.shadow_maps_enabled && light.shadow_depth_bias == 0.7);
        assert!((40_000.0..70_000.0).contains(&light.illuminance), "{}", light.illuminance);
        let color = light.color.to_linear();
        assert!(color.red > color.green && color.green > color.blue);
    }

    #[test]
    fn the_same_sky_has_the_same_bytes() {
        let sky = Sky { cloud_cover: 0.4, ..PLAIN(25.0) };
        let ((a, sky_a, _), (b, sky_b, _)) = (app(sky), app(sky));
        let (maps_a, maps_b) = (a.world().get::<SkyMaps>(sky_a).unwrap(), b.world().get::<SkyMaps>(sky_b).unwrap());
        assert_eq!(texels(&a, &maps_a.visible), texels(&b, &maps_b.visible));
        assert_eq!(texels(&a, &maps_a.specular), texels(&b, &maps_b.specular));
    }

    #[test]
    fn a_smaller_step_than_one_can_see_is_not_painted() {
        let (mut app, sky, _) = app(PLAIN(30.0));
        let painted = |app: &App| app.world().get_entity(sky).unwrap().get_ref::<SkyMaps>().unwrap().last_changed();
        let before = painted(&app);
        app.world_mut().get_mut::<Sky>(sky).unwrap().sun_elevation += 0.5 * REPAINT_ANGLE;
        app.update();
        let again = painted(&app);
        app.world_mut().get_mut::<Sky>(sky).unwrap().sun_elevation += REPAINT_ANGLE;
        app.update();
        assert_eq!(before, again);
        assert_ne!(again, painted(&app));
    }

    #[test]
    fn a_senseless_sky_is_painted_all_the_same() {
        let (app, sky, _) = app(Sky { sun_elevation: f32::NAN, turbidity: -3.0, ..PLAIN(0.0) });
        let maps = app.world().get::<SkyMaps>(sky).unwrap();
        assert!(maps.brightness > 0.0 && maps.ev100.is_finite() && maps.horizon_color(Vec3::X).is_finite());
        let halves = texels(&app, &maps.visible);
        assert!(halves.as_chunks::<2>().0.iter().all(|half| f16::from_le_bytes(*half).is_finite()));
    }
}
