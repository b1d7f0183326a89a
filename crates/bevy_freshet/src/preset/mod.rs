//! Settings of a water, of the sky over it and of the camera before it, kept in a text file.
//!
//! A preset is a file in RON, meant to be read and written by people:
//!
//! ```ron
//! // A calm evening.
//! (
//!     freshet_preset: 1,
//!     water: {
//!         "WaterOptics": (absorption: (0.38, 0.17, 0.46), edge_depth: 0.2),
//!         "WaterSurface": (ripples: 0.01),
//!     },
//!     sky: { "Sky": (sun_elevation: 0.1) },
//! )
//! ```
//!
//! - Components that a file does not name stay as they are. Of those that it names, fields that are left out get their
//!   defaults. So a file gives the same water whatever was set before, as far as it speaks of it.
//! - What this version does not know is left out, and [`Preset::ignored`] tells.
//! - Numbers must be finite, but where the default is infinite.
//! - A file that cannot be read changes nothing.
//!
//! Every reflected component of this crate is saved, but those of place and shape ([`Water`](crate::body::Water),
//! [`WaterBed`](crate::body::WaterBed)) and fields that belong to the scene: textures, maps, render layers, and what is
//! inspected ([`SurfaceView`](crate::surface::SurfaceView)). Of the camera, the `Transform` is saved too.
mod error;
mod text;

pub use error::PresetError;

use bevy::{
    ecs::reflect::ReflectComponent,
    prelude::*,
    reflect::{PartialReflect, ReflectMut, TypeInfo, TypeRegistration, TypeRegistry, structs::StructInfo},
};
use core::any::TypeId;
use std::{fs, path::Path};

/// The newest form of preset files that is read, and the one that is written.
pub const VERSION: u32 = 1;

/// The entities whose settings go together in a preset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PresetScene {
    /// The entity with [`Water`](crate::body::Water).
    pub water: Entity,
    /// The entity with [`Sky`](crate::sky::Sky), if it counts.
    pub sky: Option<Entity>,
    /// The camera, if its view counts.
    pub camera: Option<Entity>,
}

/// Settings, independent of any world.
#[derive(Debug, Default)]
pub struct Preset {
    water: Vec<Part>,
    sky: Vec<Part>,
    camera: Vec<Part>,
    ignored: Vec<String>,
}

/// The settings of one component.
#[derive(Debug)]
struct Part {
    component: TypeId,
    /// Every field that is a setting, in the order of the component.
    fields: Vec<(&'static str, Box<dyn PartialReflect>)>,
}

impl Preset {
    /// The settings of a scene as they are. Entities that do not exist have none.
    pub fn of(world: &World, scene: PresetScene) -> Self {
        let registry = world.resource::<AppTypeRegistry>().read();
        let parts = |entity: Option<Entity>, is_camera: bool| -> Vec<Part> {
            let Some(Ok(entity)) = entity.map(|entity| world.get_entity(entity)) else { return Vec::new() };
            let components = entity.archetype().components().iter();
            let types = components.filter_map(|id| world.components().get_info(*id)?.type_id());
            let known = types.filter_map(|id| registry.get(id));
            let mut parts: Vec<_> = known.filter_map(|known| part_of(entity, known, is_camera)).collect();
            // The order of components in memory is nothing to rely on.
            parts.sort_by_key(|(name, _)| *name);
            parts.into_iter().map(|(_, part)| part).collect()
        };
        Self {
            water: parts(Some(scene.water), false),
            sky: parts(scene.sky, false),
            camera: parts(scene.camera, true),
            ignored: Vec::new(),
        }
    }

    /// Sets a scene to this preset. Components that are missing are inserted; entities that do not exist, and those that
    /// `scene` leaves out, are passed over.
    pub fn apply(&self, world: &mut World, scene: PresetScene) {
        let registry = world.resource::<AppTypeRegistry>().clone();
        let registry = registry.read();
        let sections = [(Some(scene.water), &self.water), (scene.sky, &self.sky), (scene.camera, &self.camera)];
        for (entity, parts) in sections {
            let Some(Ok(mut entity)) = entity.map(|entity| world.get_entity_mut(entity)) else { continue };
            for part in parts {
                part.apply(&mut entity, &registry);
            }
        }
    }

    /// Reads a preset. The registry is in the resource [`AppTypeRegistry`].
    ///
    /// # Errors
    /// [`PresetError`] naming the file and, if it is no preset, line, column and what was expected.
    pub fn read(path: impl AsRef<Path>, registry: &TypeRegistry) -> Result<Self, PresetError> {
        let path = path.as_ref();
        let text = fs::read_to_string(path).map_err(|source| PresetError::Read { path: path.into(), source })?;
        Self::parse(&text, path, registry)
    }

    /// Writes a preset. The file is replaced as a whole or, if that fails, stays as it was.
    ///
    /// # Errors
    /// [`PresetError`] naming the file if it cannot be written.
    pub fn write(&self, path: impl AsRef<Path>, registry: &TypeRegistry) -> Result<(), PresetError> {
        let path = path.as_ref();
        let text = self.to_text(registry)?;
        let unfinished = path.with_extension("ron.unfinished");
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        folder
            .map_or(Ok(()), fs::create_dir_all)
            .and_then(|()| fs::write(&unfinished, text))
            .and_then(|()| fs::rename(&unfinished, path))
            .map_err(|source| {
                // What could not become the preset is of no use; that it cannot be removed either changes nothing.
                _ = fs::remove_file(&unfinished);
                PresetError::Write { path: path.into(), source }
            })
    }

    /// The components of which there are settings.
    #[cfg(all(test, feature = "panel"))]
    pub(crate) fn components(&self) -> impl Iterator<Item = TypeId> {
        [&self.water, &self.sky, &self.camera].into_iter().flatten().map(|part| part.component)
    }

    /// What a file held that this version does not know, as `WaterOptics.colour`.
    pub fn ignored(&self) -> &[String] {
        &self.ignored
    }
}

impl Part {
    fn apply(&self, entity: &mut EntityWorldMut, registry: &TypeRegistry) {
        let Some(registration) = registry.get(self.component) else { return };
        let (Some(reflect), Some(default)) =
            (registration.data::<ReflectComponent>(), registration.data::<ReflectDefault>())
        else {
            return;
        };
        if !reflect.contains(entity.as_readonly()) {
            reflect.insert(entity, default.default().as_partial_reflect(), registry);
        }
        let Some(mut component) = reflect.reflect_mut(&mut *entity) else { return };
        let ReflectMut::Struct(component) = component.reflect_mut() else { return };
        for (name, value) in &self.fields {
            let Some(field) = component.field_mut(name) else { continue };
            // Applying to a list keeps its surplus.
            if let ReflectMut::List(list) = field.reflect_mut() {
                list.drain();
            }
            if let Err(error) = field.try_apply(&**value) {
                warn!("{}: {name} is not taken from the preset: {error}", registration.type_info().type_path());
            }
        }
    }
}

/// The settings of a component of `entity`, with its name, if they belong into presets.
fn part_of(entity: EntityRef, registration: &TypeRegistration, is_camera: bool) -> Option<(&'static str, Part)> {
    let info = settings_type(registration, is_camera)?;
    let component = registration.data::<ReflectComponent>()?.reflect(entity)?.reflect_ref().as_struct().ok()?;
    let fields = setting_fields(info).filter_map(|name| Some((name, copy(component.field(name)?)))).collect();
    Some((info.type_path_table().short_path(), Part { component: info.type_id(), fields }))
}

/// A copy of a field: of its own type, so that it is written as its type wants.
fn copy(field: &dyn PartialReflect) -> Box<dyn PartialReflect> {
    field.reflect_clone().map_or_else(|_| field.to_dynamic(), |field| field.into_partial_reflect())
}

/// The structure of a component whose fields belong into presets.
fn settings_type(registration: &TypeRegistration, is_camera: bool) -> Option<&'static StructInfo> {
    let path = registration.type_info().type_path();
    let ours = path.starts_with("bevy_freshet::") && !path.starts_with("bevy_freshet::bed::");
    let of_the_scene = [TypeId::of::<crate::body::Water>(), TypeId::of::<crate::body::WaterBed>()];
    let is_view = is_camera && registration.type_id() == TypeId::of::<Transform>();
    let is_saved = ours && !of_the_scene.contains(&registration.type_id()) || is_view;
    let is_component = registration.contains::<ReflectComponent>() && registration.contains::<ReflectDefault>();
    match registration.type_info() {
        TypeInfo::Struct(info) if is_saved && is_component => Some(info),
        _ => None,
    }
}

/// The fields of a component that are settings and do not belong to the scene.
fn setting_fields(info: &'static StructInfo) -> impl Iterator<Item = &'static str> {
    const OF_THE_SCENE: [(&str, &str); 5] = [
        ("WaterSurface", "view"),
        ("WaterSurface", "view_scale"),
        ("WaterReflection", "layers"),
        ("WaterSimulation", "area"),
        ("WaterSimulation", "paused"),
    ];
    let component = info.type_path_table().short_path();
    info.field_names().iter().copied().filter(move |field| !OF_THE_SCENE.contains(&(component, field)))
}

#[cfg(test)]
mod tests;
