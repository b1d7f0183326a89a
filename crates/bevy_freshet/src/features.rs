//! The parts of a water that can be switched off one by one, to see what each of them does and costs.
use crate::{
    body::{Fresnel, WaterFlow, WaterFoam, WaterIce, WaterInteraction, WaterOptics, WaterWaves},
    reflection::WaterReflection,
    surface::WaterSurface,
};
use bevy::prelude::*;

/// A part of a water that can be switched off.
///
/// Switching changes nothing but the settings that the part's documentation names, so a user's own settings and the
/// switches go together.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Feature {
    /// Reflection of sky and scene: [`WaterOptics::reflectivity`] and the mirror, [`WaterReflection::planar`].
    Reflection,
    /// Bending of what is seen through the surface: [`WaterOptics::refraction`].
    Refraction,
    /// Different refraction per colour: [`WaterOptics::dispersion`].
    Dispersion,
    /// Reflection that depends on the angle: [`WaterOptics::fresnel`]. Off, half of the light is reflected at every angle.
    Fresnel,
    /// The current, drawn and felt: [`WaterFlow`].
    Flow,
    /// Glitter of sun, moon and lamps: [`WaterSurface::sunlight`].
    Light,
    /// The camera's fog on the water: [`WaterOptics::fog`].
    Fog,
    /// Waves, drawn and felt: [`WaterWaves::trains`].
    Waves,
    /// Fine ripples: [`WaterSurface::ripples`].
    Ripples,
    /// The soft edge at the waterline: [`WaterOptics::edge_depth`].
    Edge,
    /// Foam: [`WaterFoam::amount`].
    Foam,
    /// Rings around bodies: [`WaterInteraction::rings`].
    Rings,
    /// All simulated fields, rings, foam and dye: [`WaterInteraction::enabled`].
    Interaction,
    /// Ice, drawn and felt: [`WaterIce`]. On a water that never had any, half of the winter has passed.
    Ice,
}

/// The settings of a water that features change.
#[derive(Clone, Debug)]
struct Settings {
    optics: WaterOptics,
    surface: WaterSurface,
    waves: WaterWaves,
    reflection: WaterReflection,
    foam: WaterFoam,
    interaction: WaterInteraction,
    flow: Option<WaterFlow>,
    ice: Option<WaterIce>,
}

/// Beside a water with which features were switched: what they had before.
#[derive(Component, Clone, Debug)]
struct Remembered(Settings);

impl Default for Remembered {
    /// What a feature gets that is switched on before it ever was off.
    fn default() -> Self {
        Self(Settings {
            // As in real water.
            optics: WaterOptics { dispersion: 0.006, ..default() },
            surface: default(),
            waves: default(),
            reflection: default(),
            foam: default(),
            interaction: default(),
            flow: None,
            ice: Some(WaterIce::frozen(0.5)),
        })
    }
}

impl Feature {
    /// Every feature.
    pub const ALL: [Self; 14] = [
        Self::Reflection,
        Self::Refraction,
        Self::Dispersion,
        Self::Fresnel,
        Self::Flow,
        Self::Light,
        Self::Fog,
        Self::Waves,
        Self::Ripples,
        Self::Edge,
        Self::Foam,
        Self::Rings,
        Self::Interaction,
        Self::Ice,
    ];

    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Reflection => "reflection",
            Self::Refraction => "refraction",
            Self::Dispersion => "dispersion",
            Self::Fresnel => "Fresnel",
            Self::Flow => "flow",
            Self::Light => "light",
            Self::Fog => "fog",
            Self::Waves => "waves",
            Self::Ripples => "ripples",
            Self::Edge => "edge",
            Self::Foam => "foam",
            Self::Rings => "rings",
            Self::Interaction => "interaction",
            Self::Ice => "ice",
        }
    }

    /// What it does, in a sentence.
    pub const fn effect(self) -> &'static str {
        match self {
            Self::Reflection => "Sky and scene in the water; off, no mirror is drawn either.",
            Self::Refraction => "Bending of what is seen through the surface.",
            Self::Dispersion => "Different refraction per colour.",
            Self::Fresnel => "Reflection that depends on the angle; off, half of the light is reflected everywhere.",
            Self::Flow => "The current, drawn and felt.",
            Self::Light => "Glitter of sun, moon and lamps.",
            Self::Fog => "The camera's fog on the water.",
            Self::Waves => "Waves, drawn and felt.",
            Self::Ripples => "Fine ripples.",
            Self::Edge => "The soft edge at the waterline.",
            Self::Foam => "Foam.",
            Self::Rings => "Rings around bodies.",
            Self::Interaction => "All simulated fields: rings, foam and dye.",
            Self::Ice => "Ice, drawn and felt.",
        }
    }

    /// Whether the feature acts on a water. Without a water nothing does.
    pub fn is_on(self, water: EntityRef) -> bool {
        let Some(mut settings) = Settings::of(water) else { return false };
        // What switching off would change is on.
        self.exchange(&mut settings, &mut Remembered::default().0, false)
    }

    /// Switches the feature of a water. Off, its settings are remembered; on, they come back, as they were or, if they
    /// were off from the beginning, with their defaults. Does nothing where the feature already is as wanted, or where
    /// there is no water.
    ///
    /// With [`Commands`]: `commands.entity(water).queue(move |mut water: EntityWorldMut| feature.switch(false, &mut water))`.
    pub fn switch(self, on: bool, water: &mut EntityWorldMut) {
        let Some(mut settings) = Settings::of(water.as_readonly()) else { return };
        let mut remembered = water.take::<Remembered>().unwrap_or_default();
        if self.exchange(&mut settings, &mut remembered.0, on) {
            settings.write(water);
        }
        water.insert(remembered);
    }

    /// Switches in `now` with the memory `kept`; whether that changed anything.
    fn exchange(self, now: &mut Settings, kept: &mut Settings, on: bool) -> bool {
        match self {
            Self::Reflection => {
                let changes = set(&mut now.optics.reflectivity, &mut kept.optics.reflectivity, 0.0, on);
                if changes && on {
                    now.reflection.planar = kept.reflection.planar;
                } else if changes {
                    kept.reflection.planar = core::mem::replace(&mut now.reflection.planar, false);
                }
                changes
            }
            Self::Refraction => set(&mut now.optics.refraction, &mut kept.optics.refraction, 0.0, on),
            Self::Dispersion => set(&mut now.optics.dispersion, &mut kept.optics.dispersion, 0.0, on),
            Self::Fresnel => {
                set(&mut now.optics.fresnel, &mut kept.optics.fresnel, Fresnel::Constant { share: 0.5 }, on)
            }
            Self::Flow => exchange(&mut now.flow, &mut kept.flow, on),
            Self::Light => set(&mut now.surface.sunlight, &mut kept.surface.sunlight, false, on),
            Self::Fog => set(&mut now.optics.fog, &mut kept.optics.fog, false, on),
            Self::Waves => set(&mut now.waves.trains, &mut kept.waves.trains, Vec::new(), on),
            Self::Ripples => set(&mut now.surface.ripples, &mut kept.surface.ripples, 0.0, on),
            Self::Edge => set(&mut now.optics.edge_depth, &mut kept.optics.edge_depth, 0.0, on),
            Self::Foam => set(&mut now.foam.amount, &mut kept.foam.amount, 0.0, on),
            Self::Rings => set(&mut now.interaction.rings, &mut kept.interaction.rings, 0.0, on),
            Self::Interaction => set(&mut now.interaction.enabled, &mut kept.interaction.enabled, false, on),
            Self::Ice => exchange(&mut now.ice, &mut kept.ice, on),
        }
    }
}

/// Switches one value; whether that changed it.
fn set<T: PartialEq + Clone>(now: &mut T, kept: &mut T, off: T, on: bool) -> bool {
    if on != (*now == off) {
        return false;
    }
    if on {
        *now = kept.clone();
    } else {
        *kept = core::mem::replace(now, off);
    }
    true
}

/// Switches a component as a whole, so that neither surface nor bodies ask for it any more; whether that changed it.
fn exchange<T: Clone>(now: &mut Option<T>, kept: &mut Option<T>, on: bool) -> bool {
    if on == now.is_some() || (on && kept.is_none()) {
        return false;
    }
    if on {
        now.clone_from(kept);
    } else {
        *kept = now.take();
    }
    true
}

impl Settings {
    fn of(water: EntityRef) -> Option<Self> {
        Some(Self {
            optics: *water.get()?,
            surface: *water.get()?,
            waves: water.get::<WaterWaves>()?.clone(),
            reflection: water.get::<WaterReflection>()?.clone(),
            foam: *water.get()?,
            interaction: *water.get()?,
            flow: water.get().cloned(),
            ice: water.get().copied(),
        })
    }

    fn write(self, water: &mut EntityWorldMut) {
        water.insert((self.optics, self.surface, self.waves, self.reflection, self.foam, self.interaction));
        write_optional(self.flow, water);
        write_optional(self.ice, water);
    }
}

/// Gives the water a component, or takes it.
fn write_optional<C: Component>(component: Option<C>, water: &mut EntityWorldMut) {
    match component {
        Some(component) => _ = water.insert(component),
        None => _ = water.remove::<C>(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::{
        platform::collections::HashSet,
        reflect::{TypeInfo, Typed},
    };

    /// A water whose features are all on.
    fn water(world: &mut World) -> EntityWorldMut<'_> {
        let optics = WaterOptics { dispersion: 0.01, refraction: 0.7, ..default() };
        world.spawn((crate::body::Water::default(), optics, WaterFlow::uniform(Vec2::X), WaterIce::frozen(0.7)))
    }

    /// What a water is set to, as text.
    fn settings(water: &EntityWorldMut) -> String {
        format!("{:?}", Settings::of(water.as_readonly()).unwrap())
    }

    #[test]
    fn every_feature_is_listed_once_under_a_name_of_its_own() {
        let TypeInfo::Enum(info) = Feature::type_info() else { panic!("a feature is an enum") };
        let names: HashSet<_> = Feature::ALL.map(Feature::name).into_iter().collect();
        assert_eq!((Feature::ALL.len(), names.len()), (info.variant_len(), info.variant_len()));
    }

    #[test]
    fn switching_off_and_on_again_restores_every_setting() {
        let mut world = World::new();
        let mut water = water(&mut world);
        let before = settings(&water);
        for feature in Feature::ALL {
            assert!(feature.is_on(water.as_readonly()), "{feature:?}");
            feature.switch(false, &mut water);
            assert!(!feature.is_on(water.as_readonly()), "{feature:?}");
            assert_ne!(settings(&water), before, "{feature:?}");
            // A second time must not remember what "off" is.
            feature.switch(false, &mut water);
            feature.switch(true, &mut water);
            assert_eq!(settings(&water), before, "{feature:?}");
        }
    }

    #[test]
    fn features_do_not_meddle_with_each_other() {
        let mut world = World::new();
        let mut water = water(&mut world);
        let before = settings(&water);
        for feature in Feature::ALL {
            feature.switch(false, &mut water);
        }
        assert!(Feature::ALL.iter().all(|feature| !feature.is_on(water.as_readonly())));
        for (i, feature) in Feature::ALL.into_iter().enumerate() {
            feature.switch(true, &mut water);
            let on = Feature::ALL.iter().filter(|feature| feature.is_on(water.as_readonly())).count();
            assert_eq!(on, i + 1, "{feature:?}");
        }
        assert_eq!(settings(&water), before);
    }

    #[test]
    fn a_mirror_that_is_off_from_the_beginning_stays_off() {
        let mut world = World::new();
        let mut water = water(&mut world);
        water.insert(WaterReflection { planar: false, ..default() });
        Feature::Reflection.switch(false, &mut water);
        Feature::Reflection.switch(true, &mut water);
        assert!(!water.get::<WaterReflection>().unwrap().planar);
    }

    #[test]
    fn what_was_off_from_the_beginning_comes_with_its_default() {
        let mut world = World::new();
        let mut water = world.spawn(crate::body::Water::default());
        Feature::Dispersion.switch(true, &mut water);
        assert_eq!(water.get::<WaterOptics>().unwrap().dispersion, 0.006);
        assert!(!Feature::Ice.is_on(water.as_readonly()));
        Feature::Ice.switch(true, &mut water);
        assert_eq!(water.get::<WaterIce>().unwrap().freezing, 0.5);
        // There is no default current.
        Feature::Flow.switch(true, &mut water);
        assert!(!Feature::Flow.is_on(water.as_readonly()));
    }

    #[test]
    fn an_entity_without_water_is_left_alone() {
        let mut world = World::new();
        let mut other = world.spawn_empty();
        Feature::Foam.switch(false, &mut other);
        assert!(!other.contains::<Remembered>() && !Feature::Foam.is_on(other.as_readonly()));
    }
}
