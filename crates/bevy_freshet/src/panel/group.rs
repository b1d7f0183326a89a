//! Groups of controls: each edits one component, through reflection.
use super::{WaterPanel, rows::Row};
use bevy::{
    ecs::reflect::ReflectComponent,
    platform::collections::HashMap,
    prelude::*,
    reflect::{GetPath, PartialReflect, TypeRegistry},
};
use bevy_egui::egui::{self, Response, Ui};
use core::any::TypeId;

/// The entity on which a group's component is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Owner {
    Water,
    Sky,
    /// The camera with the panel.
    Camera,
}

/// The controls of one component.
pub(super) struct Group {
    pub title: &'static str,
    pub owner: Owner,
    pub component: fn() -> TypeId,
    /// Whether a change counts only when the mouse is released: for what is expensive to change.
    pub on_release: bool,
    pub rows: &'static [Row],
}

/// Changes that wait for the mouse to be released, by entity, component and path.
pub(super) type Pending = HashMap<(Entity, TypeId, &'static str), Box<dyn PartialReflect>>;

/// Draws a group for `entity`, and writes what is changed. Nothing where the entity lacks the component.
pub(super) fn draw_group(ui: &mut Ui, world: &mut World, panel: &mut WaterPanel, entity: Entity, group: &Group) {
    let has_it = {
        let registry = world.resource::<AppTypeRegistry>().read();
        current(world, &registry, entity, (group.component)()).is_some()
    };
    if has_it {
        let header = egui::CollapsingHeader::new(group.title).show(ui, |ui| draw_rows(ui, world, panel, entity, group));
        panel.note(ui, group.title, &header.header_response);
    }
}

/// Draws the rows of a group without its header.
pub(super) fn draw_rows(ui: &mut Ui, world: &mut World, panel: &mut WaterPanel, entity: Entity, group: &Group) {
    let registry = world.resource::<AppTypeRegistry>().clone();
    let registry = registry.read();
    for row in group.rows {
        draw_row(ui, world, panel, &registry, entity, group, row);
    }
    if ui.small_button("Defaults").on_hover_text("Sets this group to its defaults.").clicked() {
        set_defaults(world, &registry, entity, group);
    }
}

fn draw_row(
    ui: &mut Ui,
    world: &mut World,
    panel: &mut WaterPanel,
    registry: &TypeRegistry,
    entity: Entity,
    group: &Group,
    row: &Row,
) {
    let component = (group.component)();
    let key = (entity, component, row.path);
    let drawn = {
        let Some(now) = current(world, registry, entity, component) else { return };
        let Ok(now) = now.reflect_path(row.path) else { return };
        row.draw(ui, panel.pending.get(&key).map_or(now, |pending| &**pending))
    };
    let Some((response, value)) = drawn else { return };
    panel.note(ui, row.label, &response);
    response.on_hover_text(row.help());
    let Some(value) = value else { return };
    if group.on_release {
        panel.pending.insert(key, value);
    } else {
        write(world, registry, entity, component, row.path, &*value);
    }
}

impl WaterPanel {
    /// Notes where a control is, if it can be seen.
    pub(super) fn note(&mut self, ui: &Ui, label: &'static str, response: &Response) {
        let egui::Rect { min, max } = response.rect;
        if ui.clip_rect().contains(min) && ui.clip_rect().contains(max) {
            self.places.insert(label, Rect::new(min.x, min.y, max.x, max.y));
        }
    }
}

/// Writes what has waited for the mouse to be released.
pub(super) fn write_pending(world: &mut World, panel: &mut WaterPanel) {
    if panel.pending.is_empty() {
        return;
    }
    let registry = world.resource::<AppTypeRegistry>().clone();
    let registry = registry.read();
    for ((entity, component, path), value) in panel.pending.drain() {
        write(world, &registry, entity, component, path, &*value);
    }
}

fn set_defaults(world: &mut World, registry: &TypeRegistry, entity: Entity, group: &Group) {
    let component = (group.component)();
    let Some(default) = registry.get_type_data::<ReflectDefault>(component).map(ReflectDefault::default) else {
        return;
    };
    for row in group.rows {
        if let Ok(value) = default.reflect_path(row.path) {
            write(world, registry, entity, component, row.path, value);
        }
    }
}

fn current<'w>(
    world: &'w World,
    registry: &TypeRegistry,
    entity: Entity,
    component: TypeId,
) -> Option<&'w dyn Reflect> {
    registry.get_type_data::<ReflectComponent>(component)?.reflect(world.get_entity(entity).ok()?)
}

/// Writes one field, and with it marks the component as changed.
fn write(
    world: &mut World,
    registry: &TypeRegistry,
    entity: Entity,
    component: TypeId,
    path: &str,
    value: &dyn PartialReflect,
) {
    let Some(reflect) = registry.get_type_data::<ReflectComponent>(component) else { return };
    let Ok(mut entity) = world.get_entity_mut(entity) else { return };
    let Some(mut component) = reflect.reflect_mut(&mut entity) else { return };
    if let Ok(field) = component.reflect_path_mut(path)
        && let Err(error) = field.try_apply(value)
    {
        warn!("{path} cannot be set: {error}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        body::{
            Fresnel, Water, WaterEdges, WaterFlow, WaterIce, WaterOptics, WaterSimulation, WaterSources, WaterWalls,
        },
        panel::{groups::GROUPS, simulation::SETTINGS},
        preset,
        sky::Sky,
    };

    fn groups() -> impl Iterator<Item = &'static Group> {
        GROUPS.iter().chain([&SETTINGS])
    }

    fn registry() -> AppTypeRegistry {
        App::new().world().resource::<AppTypeRegistry>().clone()
    }

    #[test]
    fn every_row_finds_its_field_and_its_default_is_within_range() {
        let registry = registry();
        let registry = registry.read();
        for group in groups() {
            let default = registry.get_type_data::<ReflectDefault>((group.component)()).unwrap().default();
            for row in group.rows {
                let path = format!("{} {}", group.title, row.path);
                let value = default.reflect_path(row.path).unwrap_or_else(|error| panic!("{path}: {error}"));
                assert!(!row.tip.is_empty() && row.tip.ends_with('.'), "{path} is not explained");
                if let Some(number) = value.try_downcast_ref::<f32>().filter(|number| number.is_finite()) {
                    let shown = f64::from(*number) * row.factor;
                    assert!((row.range[0] - 1e-6..=row.range[1] + 1e-6).contains(&shown), "{path}: {shown}");
                }
            }
        }
    }

    #[test]
    fn every_setting_has_a_row_or_a_section_of_its_own() {
        // Drawn by `waves.rs`, `simulation.rs` and the choice of views; layers are the game's.
        let elsewhere = ["trains", "start", "area", "paused", "view", "layers"];
        let registry = registry();
        let registry = registry.read();
        for group in groups() {
            let info = registry.get_type_info((group.component)()).unwrap().as_struct().unwrap();
            for field in info.field_names().iter().filter(|field| !elsewhere.contains(field)) {
                let has_row = group.rows.iter().any(|row| row.path == *field);
                assert!(has_row, "{}::{field}", group.title);
            }
        }
        // And every component that presets save has a group, or is drawn by `around.rs`.
        let mut world = App::new();
        let world = world.world_mut();
        let simulation = WaterSimulation::default();
        let water = world.spawn((Water::default(), WaterFlow::default(), WaterIce::default(), simulation)).id();
        let around = [TypeId::of::<WaterEdges>(), TypeId::of::<WaterSources>(), TypeId::of::<WaterWalls>()];
        let scene = preset::PresetScene { water, sky: None, camera: None };
        for component in preset::Preset::of(world, scene).components() {
            let has_group = groups().any(|group| (group.component)() == component);
            assert!(has_group || around.contains(&component), "{component:?}");
        }
    }

    #[test]
    fn a_group_writes_one_field_and_resets_all() {
        let mut app = App::new();
        let changed = WaterOptics { refraction: 0.3, edge_depth: 2.0, fresnel: Fresnel::Schlick, ..default() };
        let water = app.world_mut().spawn(changed).id();
        let registry = registry();
        let registry = registry.read();
        let group = GROUPS.iter().find(|group| (group.component)() == TypeId::of::<WaterOptics>()).unwrap();
        write(app.world_mut(), &registry, water, (group.component)(), "index", &1.5_f32);
        let expected = WaterOptics { index: 1.5, ..changed };
        assert_eq!(*app.world().get::<WaterOptics>(water).unwrap(), expected);
        set_defaults(app.world_mut(), &registry, water, group);
        assert_eq!(*app.world().get::<WaterOptics>(water).unwrap(), WaterOptics::default());
        // Of a wrong type, of a gone entity: nothing happens.
        write(app.world_mut(), &registry, water, (group.component)(), "index", &true);
        app.world_mut().despawn(water);
        write(app.world_mut(), &registry, water, (group.component)(), "index", &1.5_f32);
    }

    #[test]
    fn the_expensive_sky_is_set_when_the_mouse_is_released() {
        assert!(GROUPS.iter().any(|group| (group.component)() == TypeId::of::<Sky>() && group.on_release));
    }
}
