//! What a game does to the water at a place, once.
use crate::{
    body::ResolvedWater,
    query::WaterQuery,
    report::Reported,
    simulation::{Deposits, FieldWindow, NARROWEST, REACH, Stroke},
};
use bevy::prelude::*;
use core::f32::consts::TAU;

/// Disturbs the water at a place, once: a message for a stone that falls in, a splash, a blot of dye.
///
/// The effect has the shape of a Gaussian. Values that are not usable are warned of and bounded; where there is no water
/// nothing happens.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_freshet::prelude::*;
/// fn throw_a_stone(mut disturb: MessageWriter<Disturb>) {
///     // A dent of 8 cm, and a little foam.
///     disturb.write(Disturb::push(vec3(3.0, 0.0, -2.0), 0.3, 0.08).with_foam(0.1));
/// }
/// ```
#[derive(Message, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Clone, Debug, PartialEq)]
pub struct Disturb {
    /// The water that is meant; `None` is the one that [`WaterQuery::sample`] finds at the place.
    pub water: Option<Entity>,
    /// Where, in the world, m. Its height only tells waters above one another apart.
    pub place: Vec3,
    /// Radius (standard deviation), m, 0.001…1000. Not narrower than ¾ of a cell of the water's
    /// [`WaterInteraction::cell`](crate::body::WaterInteraction::cell) in effect.
    pub radius: f32,
    /// Volume by which the surface is raised, m³, −10⁶…10⁶; negative presses it down.
    pub volume: f32,
    /// Foam, m² of full cover, 0…10⁶.
    pub foam: f32,
    /// Dye: absorption (1/m) times volume of dyed water (m³), per channel, 0…10⁹.
    pub dye: Vec3,
}

impl Disturb {
    /// Nothing yet, at `place` (world, m), in a `radius` (m).
    pub const fn at(place: Vec3, radius: f32) -> Self {
        Self { water: None, place, radius, volume: 0.0, foam: 0.0, dye: Vec3::ZERO }
    }

    /// A drop of `volume` (m³) that falls in at `place`: a mound of its own diameter.
    pub fn drop(place: Vec3, volume: f32) -> Self {
        // A sphere of this volume has the diameter (6 V / π)^⅓.
        let radius = 0.5 * ops::cbrt(volume.abs() * 12.0 / TAU);
        Self { volume, ..Self::at(place, radius) }
    }

    /// A push that dents the water by `depth` (m) in its middle; negative lifts it. A Gaussian of that height has the
    /// volume `2 π σ² depth`.
    pub fn push(place: Vec3, radius: f32, depth: f32) -> Self {
        Self { volume: -TAU * radius * radius * depth, ..Self::at(place, radius) }
    }

    /// `volume` (m³) of a liquid with `absorption` (1/m), which
    /// [`absorption_from_color`](super::absorption_from_color) gives for a colour. The level stays.
    pub fn dye(place: Vec3, radius: f32, absorption: Vec3, volume: f32) -> Self {
        Self { dye: absorption * volume, ..Self::at(place, radius) }
    }

    /// Adds `foam`, m² of full cover.
    pub fn with_foam(self, foam: f32) -> Self {
        Self { foam, ..self }
    }

    /// Meant for `water`, whatever else is there.
    pub fn on(self, water: Entity) -> Self {
        Self { water: Some(water), ..self }
    }

    /// The stroke on `water`, with usable numbers.
    fn stroke(&self, entity: Entity, water: &ResolvedWater, reported: &mut Reported) -> Stroke {
        Stroke {
            place: water.local_from_world.transform_point2(self.place.xz()),
            radius: reported.clamp(entity, "Disturb::radius", self.radius, 1e-3..=1e3, 0.2),
            volume: reported.clamp(entity, "Disturb::volume", self.volume, -1e6..=1e6, 0.0),
            foam: reported.clamp(entity, "Disturb::foam", self.foam, 0.0..=1e6, 0.0),
            dye: reported.clamp3(entity, "Disturb::dye", self.dye, 0.0..=1e9, Vec3::ZERO),
        }
    }
}

/// Adds a stroke to the deposits of a water, if it reaches the window.
pub(super) fn deposit(window: &FieldWindow, deposits: &mut Deposits, stroke: Stroke) {
    if window.size.min_element() == 0 {
        return;
    }
    let stroke = Stroke { radius: stroke.radius.max(NARROWEST * window.cell), ..stroke };
    let (first, reach) = (window.origin(), REACH * stroke.radius);
    let last = first + window.extent();
    if stroke.place.cmpge(first - reach).all() && stroke.place.cmple(last + reach).all() {
        deposits.strokes.push(stroke);
    }
}

/// Hands the messages to the waters that they meet.
pub(super) fn apply_disturbances(
    mut messages: MessageReader<Disturb>,
    query: WaterQuery,
    mut waters: Query<(&ResolvedWater, &FieldWindow, &mut Deposits)>,
    mut reported: ResMut<Reported>,
    mut complained: Local<bool>,
) {
    for disturb in messages.read() {
        if !disturb.place.is_finite() {
            // There is no entity to name, nor to remember the complaint by.
            if !core::mem::replace(&mut *complained, true) {
                warn!("Disturb::place is {}; it is left out", disturb.place);
            }
            continue;
        }
        let found = disturb.water.or_else(|| query.sample(disturb.place).map(|sample| sample.water));
        let Some(entity) = found else { continue };
        let Ok((water, window, mut deposits)) = waters.get_mut(entity) else { continue };
        let stroke = disturb.stroke(entity, water, &mut reported);
        deposit(window, &mut deposits, stroke);
    }
}
