//! The mirror cameras and their targets.
use super::{
    WaterReflection,
    projection::{clip_plane, mirrored, reflection},
    shadows::SharesShadows,
};
use crate::{
    body::ResolvedWater,
    report::Reported,
    surface::{ViewerData, Viewers},
};
use bevy::{
    camera::{Hdr, RenderTarget, primitives::Aabb},
    core_pipeline::tonemapping::Tonemapping,
    light::cluster::ClusterConfig,
    platform::collections::HashMap,
    prelude::*,
    render::render_resource::TextureFormat,
};

/// Marks a camera that the plugin has made to draw a reflection.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct MirrorCamera {
    /// The camera whose view is mirrored.
    pub viewer: Entity,
    /// World height of the mirror plane, m.
    pub level: f32,
}

/// One mirror per viewing camera and water level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct MirrorKey {
    viewer: Entity,
    /// Millimetres: waters this close in height share a mirror.
    level: i32,
}

impl MirrorKey {
    pub fn new(viewer: Entity, level: f32) -> Self {
        Self { viewer, level: (level * 1000.0).round() as i32 }
    }
}

/// A mirror camera and what its picture shows.
pub(crate) struct Mirror {
    entity: Entity,
    /// The picture.
    pub image: Handle<Image>,
    size: UVec2,
    /// With which the picture was drawn; `None` until it is.
    pub clip_from_world: Option<Mat4>,
    /// Frames since it was drawn.
    age: u32,
}

/// All mirrors.
#[derive(Resource, Default)]
pub(crate) struct Mirrors(pub HashMap<MirrorKey, Mirror>);

/// What a mirror has to show this frame.
struct Wanted {
    level: f32,
    settings: WaterReflection,
    refresh: u32,
}

/// Makes, moves, switches and removes mirror cameras.
pub(crate) fn update_mirrors(
    mut commands: Commands,
    mut mirrors: ResMut<Mirrors>,
    mut images: ResMut<Assets<Image>>,
    mut reported: ResMut<Reported>,
    entities: Query<()>,
    viewers: Viewers,
    waters: Query<(Entity, &ResolvedWater, &WaterReflection, &InheritedVisibility)>,
) {
    let mut seen: HashMap<MirrorKey, (Entity, Wanted)> = HashMap::default();
    for (entity, water, settings, visibility) in &waters {
        if !settings.planar || !visibility.get() || water.half_size == Vec2::ZERO {
            continue;
        }
        let settings = usable_settings(entity, settings, &mut reported);
        for viewer in viewers.iter().filter(|viewer| sees(viewer, water)) {
            if matches!(viewer.projection, Projection::Custom(_)) {
                reported.warn(viewer.entity, "Projection", "is a custom one, of which no reflection can be drawn");
                continue;
            }
            let key = MirrorKey::new(viewer.entity, water.level);
            let wanted = Wanted { level: water.level, refresh: settings.refresh, settings: settings.clone() };
            match seen.get_mut(&key) {
                Some((_, known)) if known.settings.resolution >= settings.resolution => {}
                _ => _ = seen.insert(key, (viewer.entity, wanted)),
            }
        }
    }
    // A game that clears its cameras away takes the mirrors with them.
    mirrors.0.retain(|_, mirror| entities.contains(mirror.entity));
    for (key, (viewer, wanted)) in &seen {
        let Some(viewer) = viewers.get(*viewer) else { continue };
        let size = target_size(&viewer, wanted.settings.resolution);
        let mirror = mirrors.take(*key, &seen).unwrap_or_else(|| Mirror {
            entity: commands.spawn(Name::new("Water mirror camera")).id(),
            image: images.add(target_image(size)),
            size,
            clip_from_world: None,
            age: u32::MAX,
        });
        let mirror = mirrors.0.entry(*key).or_insert(mirror);
        if mirror.size != size {
            mirror.image = images.add(target_image(size));
            (mirror.size, mirror.age, mirror.clip_from_world) = (size, u32::MAX, None);
        }
        draw(&mut commands, mirror, &viewer, wanted);
    }
    mirrors.0.retain(|key, mirror| {
        let keep = seen.contains_key(key);
        if !keep {
            commands.entity(mirror.entity).try_despawn();
        }
        keep
    });
}

impl Mirrors {
    /// Takes out the mirror of `key`, or else one of the same viewer that has lost its level: a level that rises keeps
    /// its mirror.
    fn take(&mut self, key: MirrorKey, wanted: &HashMap<MirrorKey, (Entity, Wanted)>) -> Option<Mirror> {
        if let Some(mirror) = self.0.remove(&key) {
            return Some(mirror);
        }
        let lost = |other: &&MirrorKey| other.viewer == key.viewer && !wanted.contains_key(*other);
        let nearest = self.0.keys().filter(lost).min_by_key(|other| (other.level.abs_diff(key.level), other.level));
        let nearest = *nearest?;
        self.0.remove(&nearest)
    }
}

fn usable_settings(entity: Entity, settings: &WaterReflection, reported: &mut Reported) -> WaterReflection {
    if settings.refresh == 0 {
        reported.warn(entity, "WaterReflection::refresh", "is 0; 1 is used");
    }
    WaterReflection {
        resolution: reported.clamp(entity, "WaterReflection::resolution", settings.resolution, 0.05..=1.0, 0.5),
        clip_offset: reported.clamp(entity, "WaterReflection::clip_offset", settings.clip_offset, 0.0..=1.0, 0.02),
        refresh: settings.refresh.max(1),
        ..settings.clone()
    }
}

/// Whether the viewer's frustum meets the water's rectangle, seen from above.
fn sees(viewer: &ViewerData, water: &ResolvedWater) -> bool {
    let above = viewer.pose.translation().y > water.level;
    let area = Aabb { half_extents: water.half_size.extend(0.5).xzy().into(), ..default() };
    let place = water.pose().compute_affine();
    // An orthographic eye may lie anywhere along its rays: what counts is that it looks down.
    let above = above || matches!(viewer.projection, Projection::Orthographic(_)) && viewer.pose.forward().y < 0.0;
    above && viewer.projection.compute_frustum(viewer.pose).intersects_obb(&area, &place, true, false)
}

fn target_size(viewer: &ViewerData, resolution: f32) -> UVec2 {
    (viewer.viewport.as_vec2() * resolution).round().as_uvec2().max(UVec2::splat(4))
}

/// Linear radiance, with alpha 0 where nothing is mirrored.
fn target_image(size: UVec2) -> Image {
    let mut image = Image::new_target_texture(size.x, size.y, TextureFormat::Rgba16Float, None);
    image.texture_descriptor.label = Some("water_mirror");
    image
}

/// Sets the mirror camera for this frame, or switches it off if there is nothing to draw or the picture is young enough.
fn draw(commands: &mut Commands, mirror: &mut Mirror, viewer: &ViewerData, wanted: &Wanted) {
    mirror.age = mirror.age.saturating_add(1);
    let due = mirror.age >= wanted.refresh;
    let pose = Transform::from_matrix(reflection(wanted.level) * viewer.pose.to_matrix());
    let global = GlobalTransform::from(pose);
    let aspect = mirror.size.x as f32 / mirror.size.y as f32;
    let plane = clip_plane(&global, wanted.level - wanted.settings.clip_offset);
    let projection = mirrored(viewer.projection, plane, aspect);
    if projection.is_none() {
        // Nothing can be mirrored from here, so an old picture would be wrong.
        (mirror.age, mirror.clip_from_world) = (u32::MAX, None);
    }
    let Some(projection) = projection.filter(|_| due) else {
        let order = viewer.camera.order - 1;
        commands.entity(mirror.entity).try_insert(Camera { is_active: false, order, ..default() });
        return;
    };
    mirror.age = 0;
    mirror.clip_from_world = Some(projection.get_clip_from_view() * global.to_matrix().inverse());
    let layers = wanted.settings.layers.clone().or_else(|| viewer.layers.cloned()).unwrap_or_default();
    let mut camera = commands.entity(mirror.entity);
    camera.try_insert((
        MirrorCamera { viewer: viewer.entity, level: wanted.level },
        Camera3d::default(),
        Camera {
            order: viewer.camera.order - 1,
            clear_color: ClearColorConfig::Custom(Color::NONE),
            invert_culling: true,
            ..default()
        },
        RenderTarget::Image(mirror.image.clone().into()),
        (Hdr, Tonemapping::None, Msaa::Off),
        layers,
        pose,
        global,
        viewer.exposure.copied().unwrap_or_default(),
    ));
    // Clusters in depth follow the near plane, which the oblique one of an orthographic mirror is not: one cluster has
    // all point lights.
    if matches!(projection, Projection::Custom(_)) {
        camera.try_insert(ClusterConfig::Single);
    }
    if wanted.settings.own_shadows || wanted.settings.layers.is_some() {
        camera.try_remove::<SharesShadows>();
    } else {
        camera.try_insert(SharesShadows { viewer: viewer.entity });
    }
    camera.try_insert(projection);
    viewer.insert_lighting(&mut camera);
}
