//! Messages of bodies that go into the water, under it and out of it, and of the splashes that they make.

use super::{body::Body, floating::Floating};
use bevy::{ecs::system::SystemParam, prelude::*};

/// A [`Floating`] body at the moment in which it passes the surface of a water.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Clone, Debug, PartialEq)]
pub struct Passage {
    /// The body.
    pub body: Entity,
    /// The entity with the [`Water`](crate::body::Water).
    pub water: Entity,
    /// Speed of the body into the water along the normal of its surface, relative to the water, m/s: that at the first touch for
    /// [`Entered`], and then not negative; mostly negative for [`Left`].
    pub speed: f32,
    /// Volume under water in this step, m³.
    pub submerged_volume: f32,
    /// Volume of the whole hull, m³.
    pub volume: f32,
}

/// A [`Floating`] body has come into the water: with 1 % of its volume, or with half of what it floats with if that is less.
///
/// Once, until it has [`Left`]. A body that begins in the water enters it in its first step with speed 0. As all messages of bodies it
/// is written in the fixed step, after the solver, and tells the place from which that began; sleeping bodies have none.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_freshet::prelude::*;
/// fn hear(mut entered: MessageReader<Entered>, mut splashes: MessageReader<Splash>) {
///     for passage in entered.read() {
///         info!("{} meets the water at {} m/s", passage.body, passage.speed);
///     }
///     for splash in splashes.read() {
///         info!("{} litres of spray at {}", 1000.0 * splash.volume, splash.place);
///     }
/// }
/// # App::new().add_message::<Entered>().add_message::<Splash>().add_systems(Update, hear).update();
/// ```
#[derive(Message, Reflect, Deref, Clone, Copy, Debug, PartialEq)]
#[reflect(Clone, Debug, PartialEq)]
pub struct Entered(pub Passage);

/// A [`Floating`] body that had [`Entered`] a water is wholly out of it.
///
/// Also when the water is gone. It is not said of a body that is despawned, and not when one water passes into another.
#[derive(Message, Reflect, Deref, Clone, Copy, Debug, PartialEq)]
#[reflect(Clone, Debug, PartialEq)]
pub struct Left(pub Passage);

/// A [`Floating`] body is wholly under water: 99.9 % of it, and again after less than 95 % have been.
#[derive(Message, Reflect, Deref, Clone, Copy, Debug, PartialEq)]
#[reflect(Clone, Debug, PartialEq)]
pub struct Submerged(pub Passage);

/// A [`Floating`] body has struck the water, at its entry or later, as a bow does in waves.
///
/// An impact splashes if the volume V̇ that goes under per second meets the water at a normal speed U of V̇ U ≥ ¼ g V, V being the volume of
/// the hull: a cube of edge L must fall flat at ½ √(g L), from a height of L/8, and what is lowered, or bobs, makes no
/// splash. The impact is over, and this is written once, when V̇ U is less than a quarter of that or all of the hull is under; [`Entered`] comes
/// with the first touch.
#[derive(Message, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Clone, Debug, PartialEq)]
pub struct Splash {
    /// The body.
    pub body: Entity,
    /// The entity with the [`Water`](crate::body::Water).
    pub water: Entity,
    /// Place on the surface in the world over the middle of what went under water, m.
    pub place: Vec3,
    /// Upward unit normal of the surface there.
    pub normal: Vec3,
    /// Speed of the body into the water along the normal, relative to the water, when they met, m/s, > 0.
    pub speed: f32,
    /// Volume that went under water in the impact, m³, > 0.
    pub volume: f32,
}

/// Writes the messages of bodies.
#[derive(SystemParam)]
pub(super) struct Tell<'w> {
    pub entered: MessageWriter<'w, Entered>,
    pub left: MessageWriter<'w, Left>,
    pub submerged: MessageWriter<'w, Submerged>,
    pub splashes: MessageWriter<'w, Splash>,
}

/// Tells what the bodies that are awake have met in this step.
pub(super) fn tell_contacts(mut bodies: Query<(Entity, &mut Body), With<Floating>>, mut tell: Tell) {
    for (entity, mut body) in &mut bodies {
        let Some(felt) = body.felt.take() else { continue };
        let Body { form: Some(form), footprint, contact, .. } = &mut *body else { continue };
        contact.follow(entity, form.hull.volume(), &felt, footprint, &mut tell);
    }
}
