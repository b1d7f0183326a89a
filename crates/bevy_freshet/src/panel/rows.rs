//! Controls for reflected values: a row of the panel edits one field of one component.
use crate::{body::Fresnel, sky::Moon};
use bevy::{
    prelude::*,
    reflect::{
        PartialReflect, ReflectRef,
        enums::{DynamicEnum, DynamicVariant},
    },
};
use bevy_egui::egui::{self, ComboBox, DragValue, Response, Slider, Ui};

/// The control of one field.
pub(super) struct Row {
    pub label: &'static str,
    /// Path of the field in its component.
    pub path: &'static str,
    /// What the control offers, in shown units.
    pub range: [f64; 2],
    unit: &'static str,
    pub tip: &'static str,
    /// Shown value for one of the field's.
    pub factor: f64,
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

    /// What it means, with range and unit.
    pub fn help(&self) -> String {
        let Self { tip, range: [low, high], unit, .. } = self;
        if unit.is_empty() && *low == 0.0 && *high == 1.0 {
            (*tip).into()
        } else {
            format!("{tip}\n{low}…{high}{}", suffix(unit))
        }
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
            // Places have axes, spectra have channels.
            let names = if self.unit == "m" { ["x ", "y ", "z "] } else { ["r ", "g ", "b "] };
            let (response, numbers) = self.numbers(ui, vector.to_array(), names);
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
        if let Some(mut moon) = value.try_downcast_ref::<Option<Moon>>().copied() {
            let response = moon_choice(ui, self.label, &mut moon);
            return Some(changed(response, moon));
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
            let label = ui.label(format!("{} {}", self.label, self.unit));
            parts.into_iter().reduce(|all, part| all | part).unwrap_or(label)
        });
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

/// A box to tick, and the moon's angles in degrees if there is one.
fn moon_choice(ui: &mut Ui, label: &str, moon: &mut Option<Moon>) -> Response {
    let mut is_up = moon.is_some();
    let mut response = ui.checkbox(&mut is_up, label);
    *moon = is_up.then(|| moon.unwrap_or_default());
    if let Some(moon) = moon {
        for (name, angle, range) in [
            ("Moon elevation", &mut moon.elevation, -90.0..=90.0),
            ("Moon azimuth", &mut moon.azimuth, 0.0..=360.0),
            ("Moon phase", &mut moon.phase, 0.0..=180.0),
        ] {
            let mut degrees = angle.to_degrees();
            let slider = Slider::new(&mut degrees, range).clamping(egui::SliderClamping::Edits).suffix("°").text(name);
            let part = ui.add(slider);
            if part.changed() {
                *angle = degrees.to_radians();
            }
            response |= part;
        }
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
