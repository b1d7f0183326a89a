//! Presets as text.
use super::{Part, Preset, PresetError, VERSION, copy, setting_fields, settings_type};
use bevy::{
    prelude::*,
    reflect::{
        PartialReflect, ReflectRef, TypeRegistration, TypeRegistry,
        serde::{TypedReflectDeserializer, TypedReflectSerializer},
        structs::StructInfo,
    },
};
use core::fmt;
use ron::{Options, ser::PrettyConfig};
use serde::{
    Serialize,
    de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, Visitor},
    ser::{SerializeMap, SerializeStruct, Serializer},
};
use std::path::Path;

/// The members of a preset file: its header, and the sections.
const MEMBERS: [&str; 4] = ["freshet_preset", "water", "sky", "camera"];

impl Preset {
    /// The text of a preset file.
    ///
    /// # Errors
    /// [`PresetError::Settings`] if a setting has no text form.
    pub fn to_text(&self, registry: &TypeRegistry) -> Result<String, PresetError> {
        // Components one below the other, field by field; what is inside a field on its line.
        let config = PrettyConfig::new().depth_limit(3).new_line("\n");
        let text = ron::ser::to_string_pretty(&Written { preset: self, registry }, config);
        text.map(|text| text + "\n").map_err(PresetError::Settings)
    }

    /// Reads the text of a preset file; `path` is what errors call it.
    ///
    /// # Errors
    /// [`PresetError::Text`] if it is no preset.
    pub fn parse(text: &str, path: &Path, registry: &TypeRegistry) -> Result<Self, PresetError> {
        let mut preset = Self::default();
        let seed = PresetSeed { preset: &mut preset, registry };
        Options::default().from_str_seed(text, seed).map_err(|error| PresetError::Text {
            path: path.into(),
            line: error.span.start.line,
            column: error.span.start.col,
            message: error.code.to_string(),
        })?;
        Ok(preset)
    }
}

struct Written<'a> {
    preset: &'a Preset,
    registry: &'a TypeRegistry,
}

impl Serialize for Written<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Preset { water, sky, camera, .. } = self.preset;
        let mut file = serializer.serialize_struct("Preset", MEMBERS.len())?;
        file.serialize_field(MEMBERS[0], &VERSION)?;
        for (member, parts) in MEMBERS[1..].iter().zip([water, sky, camera]) {
            if !parts.is_empty() {
                file.serialize_field(member, &WrittenSection { parts, registry: self.registry })?;
            }
        }
        file.end()
    }
}

struct WrittenSection<'a> {
    parts: &'a [Part],
    registry: &'a TypeRegistry,
}

impl Serialize for WrittenSection<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut section = serializer.serialize_map(Some(self.parts.len()))?;
        for part in self.parts {
            let name = self.registry.get_type_info(part.component).map(|info| info.type_path_table().short_path());
            section.serialize_entry(name.unwrap_or_default(), &WrittenPart { part, registry: self.registry })?;
        }
        section.end()
    }
}

struct WrittenPart<'a> {
    part: &'a Part,
    registry: &'a TypeRegistry,
}

impl Serialize for WrittenPart<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_struct("Component", self.part.fields.len())?;
        for (name, value) in &self.part.fields {
            fields.serialize_field(name, &TypedReflectSerializer::new(&**value, self.registry))?;
        }
        fields.end()
    }
}

/// A member's or component's name.
struct Key(String);

impl<'de> serde::Deserialize<'de> for Key {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct KeyVisitor;
        impl Visitor<'_> for KeyVisitor {
            type Value = Key;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a name")
            }

            fn visit_str<E>(self, name: &str) -> Result<Key, E> {
                Ok(Key(name.into()))
            }
        }
        deserializer.deserialize_identifier(KeyVisitor)
    }
}

/// Reads a whole file.
struct PresetSeed<'a> {
    preset: &'a mut Preset,
    registry: &'a TypeRegistry,
}

impl<'de> DeserializeSeed<'de> for PresetSeed<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_struct("Preset", &MEMBERS, self)
    }
}

impl<'de> Visitor<'de> for PresetSeed<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a preset `(freshet_preset: 1, water: {…}, sky: {…}, camera: {…})`")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let Self { preset, registry } = self;
        let mut has_version = false;
        while let Some(Key(member)) = map.next_key()? {
            let ignored = &mut preset.ignored;
            let is_camera = member == "camera";
            let parts = match member.as_str() {
                "freshet_preset" => {
                    let version: u32 = map.next_value()?;
                    if !(1..=VERSION).contains(&version) {
                        let message = format_args!("expected a preset of version 1 to {VERSION}, found {version}");
                        return Err(A::Error::custom(message));
                    }
                    has_version = true;
                    continue;
                }
                "water" => &mut preset.water,
                "sky" => &mut preset.sky,
                "camera" => &mut preset.camera,
                _ => {
                    map.next_value::<IgnoredAny>()?;
                    ignored.push(member);
                    continue;
                }
            };
            map.next_value_seed(SectionSeed { parts, is_camera, ignored, registry })?;
        }
        if has_version { Ok(()) } else { Err(A::Error::missing_field("freshet_preset")) }
    }
}

/// Reads a section: components by their names.
struct SectionSeed<'a> {
    parts: &'a mut Vec<Part>,
    is_camera: bool,
    ignored: &'a mut Vec<String>,
    registry: &'a TypeRegistry,
}

impl<'de> DeserializeSeed<'de> for SectionSeed<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for SectionSeed<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("components `{ \"WaterOptics\": (…), … }`")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let Self { parts, is_camera, ignored, registry } = self;
        while let Some(name) = map.next_key::<String>()? {
            let known = registry.get_with_short_type_path(&name);
            let Some((info, registration)) = known.and_then(|known| Some((settings_type(known, is_camera)?, known)))
            else {
                map.next_value::<IgnoredAny>()?;
                ignored.push(name);
                continue;
            };
            parts.push(map.next_value_seed(PartSeed { info, registration, ignored, registry })?);
        }
        Ok(())
    }
}

/// Reads a component: its fields, with defaults for those that are left out.
struct PartSeed<'a> {
    info: &'static StructInfo,
    registration: &'a TypeRegistration,
    ignored: &'a mut Vec<String>,
    registry: &'a TypeRegistry,
}

impl<'de> DeserializeSeed<'de> for PartSeed<'_> {
    type Value = Part;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Part, D::Error> {
        let name = self.info.type_path_table().short_path();
        deserializer.deserialize_struct(name, self.info.field_names(), self)
    }
}

impl<'de> Visitor<'de> for PartSeed<'_> {
    type Value = Part;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "the fields of {}", self.info.type_path_table().short_path())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Part, A::Error> {
        let Self { info, registration, ignored, registry } = self;
        let component = info.type_path_table().short_path();
        let defaults = registration.data::<ReflectDefault>().map(ReflectDefault::default);
        let Some(Ok(defaults)) = defaults.as_ref().map(|value| value.reflect_ref().as_struct()) else {
            return Err(A::Error::custom(format_args!("{component} has no settings")));
        };
        let mut fields: Vec<_> =
            setting_fields(info).filter_map(|name| Some((name, copy(defaults.field(name)?)))).collect();
        while let Some(Key(name)) = map.next_key()? {
            let known = fields.iter_mut().find(|(known, _)| *known == name);
            let typed = info.field(&name).and_then(|field| registry.get(field.type_id()));
            let (Some((_, field)), Some(typed)) = (known, typed) else {
                map.next_value::<IgnoredAny>()?;
                ignored.push(format!("{component}.{name}"));
                continue;
            };
            let value = map
                .next_value_seed(TypedReflectDeserializer::new(typed, registry))
                .map_err(|error| A::Error::custom(format_args!("{component}.{name}: {error}")))?;
            let may_be_infinite = numbers(&**field).iter().any(|number| number.is_infinite());
            let usable = |number: &f64| number.is_finite() || may_be_infinite && number.is_infinite();
            if let Some(number) = numbers(&*value).iter().find(|number| !usable(number)) {
                let message = format_args!("expected finite numbers for {component}.{name}, found {number}");
                return Err(A::Error::custom(message));
            }
            *field = value;
        }
        Ok(Part { component: registration.type_id(), fields })
    }
}

/// Every floating-point number in a value.
fn numbers(value: &dyn PartialReflect) -> Vec<f64> {
    if let Some(number) = value.try_downcast_ref::<f32>() {
        return vec![f64::from(*number)];
    }
    if let Some(number) = value.try_downcast_ref::<f64>() {
        return vec![*number];
    }
    match value.reflect_ref() {
        ReflectRef::Struct(value) => value.iter_fields().flat_map(|(_, field)| numbers(field)).collect(),
        ReflectRef::TupleStruct(value) => value.iter_fields().flat_map(numbers).collect(),
        ReflectRef::Tuple(value) => value.iter_fields().flat_map(numbers).collect(),
        ReflectRef::List(value) => value.iter().flat_map(numbers).collect(),
        ReflectRef::Array(value) => value.iter().flat_map(numbers).collect(),
        ReflectRef::Enum(value) => value.iter_fields().flat_map(|field| numbers(field.value())).collect(),
        _ => Vec::new(),
    }
}
