//! How a body meets the surface of the water, from step to step.

use super::{
    footprint::Footprint,
    messages::{Entered, Left, Passage, Splash, Submerged, Tell},
};
use bevy::prelude::*;
use freshet_hydro::{
    load::{Load, Motion, Surface},
    waves::{GRAVITY, WATER_DENSITY},
};

/// Share of its volume that a body has under water when it has [`Entered`] …
const IN: f32 = 0.01;

/// … or this share of what it floats with, if that is less: the lightest ball enters as well.
const IN_OF_DRAFT: f32 = 0.5;

/// Share of its volume under water from which on a body is [`Submerged`]: all of it, but for rounding.
const UNDER: f32 = 0.999;

/// Share below which it has come up, and may be submerged anew.
const UP: f32 = 0.95;

/// Volume that goes under per second times the speed at which it meets the water, as a share of g V, from which on an impact splashes.
const SPLASH: f32 = 0.25;

/// The same below which an impact is over.
const LULL: f32 = 0.25 * SPLASH;

/// What a body felt of the water in a step, and how it moved before the solver took it.
pub(super) struct Felt {
    pub load: Load,
    /// Centre of mass in the world, m.
    pub center: Vec3,
    pub motion: Motion,
    /// kg.
    pub mass: f32,
    /// Length of the step, s.
    pub step: f32,
}

/// How a body and the surface met in the step before, and what has been said of that.
#[derive(Default)]
pub(super) struct Contact {
    is_in: bool,
    is_under: bool,
    /// The water that it was in last.
    water: Option<Entity>,
    before: Option<Before>,
    touch: Option<Touch>,
    impact: Option<Impact>,
}

/// The step before.
struct Before {
    wet: Wet,
    /// Centre of mass, m, and its velocity, m/s.
    center: Vec3,
    velocity: Vec3,
    /// Height of the lowest point over the surface, m; infinite without water.
    gap: f32,
    /// How fast body and water move, m/s.
    pace: f32,
}

/// The part under water.
#[derive(Clone, Copy, Default)]
struct Wet {
    /// m³.
    volume: f32,
    /// Volume times the place of its middle from the centre of mass, in world xz, m⁴.
    moment: Vec2,
}

/// The last time that the body came from the dry.
struct Touch {
    /// m/s.
    speed: f32,
    /// s.
    age: f32,
}

/// An impact under way.
struct Impact {
    from: Wet,
    /// m/s.
    speed: f32,
    /// Whether it was hard enough for a splash.
    is_hard: bool,
}

/// Where the body meets the surface.
struct Meeting {
    place: Vec3,
    normal: Vec3,
    /// Into the water, m/s.
    speed: f32,
}

impl Felt {
    fn wet(&self) -> Wet {
        let Load { pressure, submerged_volume: volume, .. } = self.load;
        // The push acts at the middle of what is under water, straight up but for the slope of the surface.
        let push = pressure.force.y;
        let arm = if push > 0.0 { vec2(pressure.torque.z, -pressure.torque.x) / push } else { Vec2::ZERO };
        Wet { volume, moment: volume * arm }
    }

    /// The surface over the middle of what came under water between `from` and `to`, and how `motion` meets it.
    fn meeting(&self, footprint: &Footprint, [from, to]: [Wet; 2], motion: Motion) -> Meeting {
        let grown = to.volume - from.volume;
        let arm = if grown > 0.0 { (to.moment - from.moment) / grown } else { Vec2::ZERO };
        let at = footprint.lattice.nearest(self.center.xz() + arm);
        let dry = Surface { height: footprint.lowest, ..default() };
        let water = footprint.lattice.at(at).or_else(|| footprint.lattice.at(self.center.xz())).unwrap_or(dry);
        let place = vec3(at.x, water.height, at.y);
        let normal = vec3(-water.slope.x, 1.0, -water.slope.y).normalize();
        let velocity = motion.linear + motion.angular.cross(place - self.center);
        Meeting { place, normal, speed: (water.velocity - velocity).dot(normal) }
    }
}

impl Before {
    fn new(felt: &Felt, footprint: &Footprint) -> Self {
        let (center, velocity) = (felt.center, felt.motion.linear);
        let none = Surface { height: f32::NEG_INFINITY, ..default() };
        let water = footprint.lattice.at(center.xz()).unwrap_or(none);
        let pace = velocity.length() + water.velocity.length();
        Self { wet: felt.wet(), center, velocity, gap: footprint.lowest - water.height, pace }
    }

    /// Whether body or water was put elsewhere before `now`: their velocities do not take them so far.
    fn is_elsewhere(&self, now: &Self, step: f32, length: f32) -> bool {
        let way = 2.0 * self.pace.max(now.pace) * step + 0.5 * length;
        self.center.distance(now.center) > way || (self.gap - now.gap).abs() > way
    }

    /// Velocity with which the lowest point met the surface before `now`, m/s: that at its share of a `step` (s) of constant
    /// acceleration. However the solver steps, half-way the velocity is what has moved the body.
    fn velocity_at_touch(&self, now: &Self, step: f32) -> Vec3 {
        let share = self.gap / (self.gap - now.gap);
        if !share.is_finite() {
            return now.velocity;
        }
        (now.center - self.center) / step + (share.clamp(0.0, 1.0) - 0.5) * (now.velocity - self.velocity)
    }
}

impl Touch {
    /// Whether its speed still tells how the body came: gravity changes that of a fall by √(g L) in √(L/g).
    fn is_recent(&self, length: f32) -> bool {
        self.age * self.age * GRAVITY <= length
    }
}

impl Contact {
    /// Forgets the step before: the hull is another one now.
    pub fn forget_step(&mut self) {
        (self.before, self.touch, self.impact) = (None, None, None);
    }

    /// Tells what happened to `body`, whose hull holds `volume` (m³), before it felt this.
    pub fn follow(&mut self, body: Entity, volume: f32, felt: &Felt, footprint: &Footprint, tell: &mut Tell) {
        self.water = footprint.water.or(self.water);
        let Some(water) = self.water else { return };
        let length = volume.cbrt();
        let now = Before::new(felt, footprint);
        let wet = now.wet;
        let before = self.before.take().filter(|before| !before.is_elsewhere(&now, felt.step, length));
        let from = before.as_ref().map_or(wet, |before| before.wet);
        let meeting = felt.meeting(footprint, [from, wet], felt.motion);
        let speed = match &before {
            // Nothing is known of how a body came that begins in the water.
            None => {
                (self.touch, self.impact) = (None, None);
                0.0
            }
            Some(before) => self.speed(before, &now, felt, footprint, length).unwrap_or(meeting.speed),
        };
        self.before = Some(now);

        let passage = |speed| Passage { body, water, speed, submerged_volume: wet.volume, volume };
        let share = wet.volume / volume;
        let enough = IN.min(IN_OF_DRAFT * felt.mass / (WATER_DENSITY * volume));
        if !self.is_in && share >= enough {
            self.is_in = true;
            tell.entered.write(Entered(passage(speed.max(0.0))));
        }
        if !self.is_under && share >= UNDER {
            self.is_under = true;
            tell.submerged.write(Submerged(passage(speed)));
        }
        if let Some(impact) = self.impact_over([from, wet], &meeting, speed, felt.step, volume) {
            let reached = if wet.volume > from.volume { wet } else { from };
            let Meeting { place, normal, .. } = felt.meeting(footprint, [impact.from, reached], felt.motion);
            let volume = reached.volume - impact.from.volume;
            tell.splashes.write(Splash { body, water, place, normal, speed: impact.speed, volume });
        }
        self.is_under &= share >= UP;
        if self.is_in && wet.volume == 0.0 {
            self.is_in = false;
            tell.left.write(Left(passage(meeting.speed)));
        }
    }

    /// The speed of the first touch, m/s, if that is now or was not long ago.
    fn speed(&mut self, before: &Before, now: &Before, felt: &Felt, footprint: &Footprint, length: f32) -> Option<f32> {
        if before.wet.volume == 0.0 && now.wet.volume > 0.0 {
            let motion = Motion { linear: before.velocity_at_touch(now, felt.step), ..felt.motion };
            let speed = felt.meeting(footprint, [before.wet, now.wet], motion).speed;
            self.touch = Some(Touch { speed, age: 0.0 });
        } else if let Some(touch) = &mut self.touch {
            touch.age += felt.step;
        }
        self.touch.as_ref().filter(|touch| touch.is_recent(length)).map(|touch| touch.speed)
    }

    /// Follows an impact; gives it when it is over, if it was hard.
    fn impact_over(
        &mut self,
        [from, to]: [Wet; 2],
        meeting: &Meeting,
        speed: f32,
        step: f32,
        volume: f32,
    ) -> Option<Impact> {
        let slam = (to.volume - from.volume).max(0.0) / step * meeting.speed / (GRAVITY * volume);
        // A hull that has just touched may have so little in the water that its impact is only to come.
        let touches = from.volume == 0.0 && to.volume > 0.0;
        let is_under = to.volume >= UNDER * volume;
        if slam >= LULL || touches {
            let impact = self.impact.get_or_insert(Impact { from, speed, is_hard: false });
            if slam >= SPLASH && !impact.is_hard {
                // What touched while it rose may have been struck since.
                (impact.is_hard, impact.speed) = (true, if speed > 0.0 { speed } else { meeting.speed });
            }
            if !is_under {
                return None;
            }
        }
        self.impact.take().filter(|impact| impact.is_hard)
    }
}
