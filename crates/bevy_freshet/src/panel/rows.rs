//! Controls for reflected fields: a row of the panel edits one field of one component.
use super::WaterPanel;
use crate::body::Fresnel;
use bevy::{
    ecs::reflect::ReflectComponent,
    platform::collections::HashMap,
    prelude::*,
    reflect::{GetPath, PartialReflect, ReflectRef, TypeRegistry, enums::DynamicEnum, enums::DynamicVariant},
};
use bevy_egui::egui::{self, ComboBox, DragValue, Response, Slider, Ui};
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

/// The control of one field.
pub(super) struct Row {
    pub label: &'static str,
    /// Path of the field in its component.
    pub path: &'static str,
    /// What the control offers, in shown units.
    range: [f64; 2],
    unit: &'static str,
    tip: &'static str,
    /// Shown value for one of the field's.
    factor: f64,
    logarithmic: bool,
}

/// A number, vector or colour.
pub(super) const fn row(
    label: &'static str,
    path: &'static str,
    range: [f64; 2],
    unit: &'static str,
    tip: &'static str,
) -> Row {
    Row { label, path, range, unit, tip, factor: 1.0, logarithmic: false }
}

/// A yes or no, or a choice.
pub(super) const fn choice(label: &'static str, path: &'static str, tip: &'static str) -> Row {
    row(label, path, [0.0, 1.0], "", tip)
}

impl Row {
    /// The same for a field in radians that is shown in degrees.
    pub const fn degrees(self) -> Self {
        Self { factor: 180.0 / core::f64::consts::PI, ..self }
    }

    /// The same with equal ways for equal ratios.
    pub const fn logarithmic(self) -> Self {
        Self { logarithmic: true, ..self }
    }

    /// Draws the control for `value`; what it was changed to, if it was. `None` inside where there is no control for the
    /// type.
    pub fn draw(&self, ui: &mut Ui, value: &dyn PartialReflect) -> Option<(Response, Option<Box<dyn PartialReflect>>)> {
        if let Some(&number) = value.try_downcast_ref::<f32>() {
            let (response, number) = self.slider(ui, f64::from(number));
            return Some((response, number.map(|number| boxed(number as f32))));
        }
        if let Some(&number) = value.try_downcast_ref::<u32>() {
            let (response, number) = self.slider_of(ui, f64::from(number), |slider| slider.integer());
            return Some((response, number.map(|number| boxed(number as u32))));
        }
        if let Some(mut on) = value.try_downcast_ref::<bool>().copied() {
            let response = ui.checkbox(&mut on, self.label);
            return Some(changed(response, on));
        }
        if let Some(vector) = value.try_downcast_ref::<Vec2>() {
            let (response, [x, y]) = self.numbers(ui, vector.to_array(), ["x ", "z "]);
            return Some(changed(response, vec2(x, y)));
        }
        if let Some(vector) = value.try_downcast_ref::<Vec3>() {
            let (response, numbers) = self.numbers(ui, vector.to_array(), ["r ", "g ", "b "]);
            return Some(changed(response, Vec3::from_array(numbers)));
        }
        if let Some(color) = value.try_downcast_ref::<LinearRgba>() {
            let mut rgb = [color.red, color.green, color.blue];
            let response = ui.horizontal(|ui| {
                let response = ui.color_edit_button_rgb(&mut rgb);
                ui.label(self.label);
                response
            });
            return Some(changed(response.inner, LinearRgba::rgb(rgb[0], rgb[1], rgb[2])));
        }
        if let Some(mut fresnel) = value.try_downcast_ref::<Fresnel>().copied() {
            let response = fresnel_choice(ui, self.label, &mut fresnel);
            return Some(changed(response, fresnel));
        }
        if let Some(&number) = value.try_downcast_ref::<Option<f32>>() {
            return Some(self.optional(ui, number));
        }
        self.units(ui, value)
    }

    fn slider(&self, ui: &mut Ui, value: f64) -> (Response, Option<f64>) {
        self.slider_of(ui, value, |slider| slider)
    }

    fn slider_of(&self, ui: &mut Ui, value: f64, of: impl FnOnce(Slider<'_>) -> Slider<'_>) -> (Response, Option<f64>) {
        let mut shown = value * self.factor;
        let slider = Slider::new(&mut shown, self.range[0]..=self.range[1])
            // Values from elsewhere are shown as they are.
            .clamping(egui::SliderClamping::Edits)
            .logarithmic(self.logarithmic)
            .smallest_positive(self.range[1] * 1e-4)
            .suffix(suffix(self.unit))
            .text(self.label);
        let response = ui.add(of(slider));
        let value = response.changed().then(|| shown / self.factor);
        (response, value)
    }

    fn numbers<const N: usize>(&self, ui: &mut Ui, mut values: [f32; N], names: [&str; N]) -> (Response, [f32; N]) {
        let speed = (self.range[1] - self.range[0]) * 2e-3;
        let response = ui.horizontal(|ui| {
            let parts: Vec<Response> = values
                .iter_mut()
                .zip(names)
                .map(|(value, name)| {
                    let range = self.range[0]..=self.range[1];
                    ui.add(DragValue::new(value).speed(speed).range(range).prefix(name).max_decimals(4))
                })
                .collect();
            parts.into_iter().reduce(|all, part| all | part).unwrap_or_else(|| ui.label(self.label))
        });
        ui.indent(self.path, |ui| ui.weak(format!("{} {}", self.label, self.unit)));
        (response.inner, values)
    }

    /// A value that may be absent: a box to tick, and the slider if it is there.
    fn optional(&self, ui: &mut Ui, value: Option<f32>) -> (Response, Option<Box<dyn PartialReflect>>) {
        let mut is_some = value.is_some();
        let Some(number) = value else {
            let response = ui.checkbox(&mut is_some, self.label);
            let middle = 0.5 * (self.range[0] + self.range[1]) / self.factor;
            return changed(response, is_some.then_some(middle as f32));
        };
        ui.horizontal(|ui| {
            let tick = ui.checkbox(&mut is_some, "");
            let (slider, edited) = self.slider(ui, f64::from(number));
            let number = edited.map_or(number, |edited| edited as f32);
            changed(tick | slider, is_some.then_some(number))
        })
        .inner
    }

    /// The choice between the variants of an enum without data.
    fn units(&self, ui: &mut Ui, value: &dyn PartialReflect) -> Option<(Response, Option<Box<dyn PartialReflect>>)> {
        let ReflectRef::Enum(current) = value.reflect_ref() else { return None };
        let names = value.get_represented_type_info()?.as_enum().ok()?.variant_names();
        let mut chosen = current.variant_name();
        let before = chosen;
        let response = ComboBox::from_label(self.label).selected_text(chosen).show_ui(ui, |ui| {
            for name in names {
                ui.selectable_value(&mut chosen, name, *name);
            }
        });
        let variant = || boxed(DynamicEnum::new(chosen, DynamicVariant::Unit));
        Some((response.response, (chosen != before).then(variant)))
    }
}

/// The modes of reflection with their number, where they have one.
fn fresnel_choice(ui: &mut Ui, label: &str, fresnel: &mut Fresnel) -> Response {
    const MODES: [(&str, Fresnel); 5] = [
        ("exact", Fresnel::Exact),
        ("Schlick", Fresnel::Schlick),
        ("reciprocal", Fresnel::Reciprocal),
        ("simple", Fresnel::Simple { correction: 1.8 }),
        ("constant", Fresnel::Constant { share: 0.5 }),
    ];
    let is_same = |mode: &Fresnel, other: &Fresnel| core::mem::discriminant(mode) == core::mem::discriminant(other);
    let name = MODES.iter().find(|(_, mode)| is_same(mode, fresnel)).map_or("", |(name, _)| name);
    let before = *fresnel;
    let mut response = ComboBox::from_label(label)
        .selected_text(name)
        .show_ui(ui, |ui| {
            for (name, mode) in MODES {
                if ui.selectable_label(is_same(&mode, &before), name).clicked() && !is_same(&mode, &before) {
                    *fresnel = mode;
                }
            }
        })
        .response;
    match fresnel {
        Fresnel::Simple { correction } => _ = ui.add(Slider::new(correction, 0.0..=2.0).text("correction")),
        Fresnel::Constant { share } => _ = ui.add(Slider::new(share, 0.0..=1.0).text("share")),
        Fresnel::Exact | Fresnel::Schlick | Fresnel::Reciprocal => {}
    }
    if *fresnel != before {
        response.mark_changed();
    }
    response
}

fn boxed(value: impl PartialReflect) -> Box<dyn PartialReflect> {
    Box::new(value)
}

fn changed(response: Response, value: impl PartialReflect) -> (Response, Option<Box<dyn PartialReflect>>) {
    let value = response.changed().then(|| boxed(value));
    (response, value)
}

/// A unit behind its number.
fn suffix(unit: &str) -> String {
    match unit {
        "" | "°" => unit.into(),
        _ => format!(" {unit}"),
    }
}

/// Changes that wait for the mouse to be released, by entity, component and path.
pub(super) type Pending = HashMap<(Entity, TypeId, &'static str), Box<dyn PartialReflect>>;

/// Draws a group for `entity`, and writes what is changed. Nothing where the entity lacks the component.
pub(super) fn draw_group(ui: &mut Ui, world: &mut World, panel: &mut WaterPanel, entity: Entity, group: &Group) {
    let registry = world.resource::<AppTypeRegistry>().clone();
    let registry = registry.read();
    if current(world, &registry, entity, (group.component)()).is_none() {
        return;
    }
    let header = egui::CollapsingHeader::new(group.title).show(ui, |ui| {
        for row in group.rows {
            draw_row(ui, world, panel, &registry, entity, group, row);
        }
        if ui.small_button("Defaults").on_hover_text("Sets this group to its defaults.").clicked() {
            set_defaults(world, &registry, entity, group);
        }
    });
    panel.note(ui, group.title, &header.header_response);
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

impl Row {
    /// What it means, with range and unit.
    fn help(&self) -> String {
        let Self { tip, range: [low, high], unit, .. } = self;
        if *unit == "" && *low == 0.0 && *high == 1.0 {
            (*tip).into()
        } else {
            format!("{tip}\n{low}…{high}{}", suffix(unit))
        }
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
    use crate::{body::WaterOptics, panel::groups::GROUPS, preset, sky::Sky};

    fn registry() -> AppTypeRegistry {
        App::new().world().resource::<AppTypeRegistry>().clone()
    }

    #[test]
    fn every_row_finds_its_field_and_its_default_is_within_range() {
        let registry = registry();
        let registry = registry.read();
        for group in GROUPS {
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
        // Drawn by `waves.rs` and by the choice of views; layers are the game's.
        let elsewhere = ["trains", "view", "layers"];
        let registry = registry();
        let registry = registry.read();
        for group in GROUPS {
            let info = registry.get_type_info((group.component)()).unwrap().as_struct().unwrap();
            for field in info.field_names().iter().filter(|field| !elsewhere.contains(field)) {
                let has_row = group.rows.iter().any(|row| row.path == *field);
                assert!(has_row, "{}::{field}", group.title);
            }
        }
        // And every component that presets save has a group.
        let mut world = App::new();
        let world = world.world_mut();
        let water = world.spawn((crate::body::Water::default(), crate::body::WaterFlow::default())).id();
        let scene = preset::PresetScene { water, sky: None, camera: None };
        for component in preset::Preset::of(world, scene).components() {
            assert!(GROUPS.iter().any(|group| (group.component)() == component), "{component:?}");
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
