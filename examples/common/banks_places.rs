//! Where things stand on a bank: places found by elevation, steepness and patches of noise.

use super::shape::between;
use bevy::prelude::*;
use noise::{NoiseFn, Perlin};
use std::f32::consts::{PI, TAU};

/// Where things may stand.
pub struct Site<'a> {
    /// Elevation of the ground at x, z, in metres; NaN where there is none.
    pub height: &'a dyn Fn(f32, f32) -> f32,
    /// Elevation of the water, in metres.
    pub water_level: f32,
    /// The part of the xz plane to be dressed.
    pub area: Rect,
    /// Another number gives another bank.
    pub seed: u64,
}

/// Places for things of one sort: the ground's elevation above the water and its steepness, and how densely they stand.
pub struct Habitat {
    /// Metres above the water.
    pub elevation: [f32; 2],
    /// Least and largest slope of the ground, as rise over run.
    pub slope: [f32; 2],
    /// Metres between the cells of which each may hold one.
    pub spacing: f32,
    /// Share of the land that patches cover, 0…1, and their size in metres.
    pub patches: (f32, f32),
    /// No more than this many.
    pub most: usize,
}

/// A point of the ground.
pub struct Place {
    foot: Vec3,
    normal: Vec3,
    /// How well things grow here, 0…1.
    vigour: f32,
}

impl Place {
    /// A pose for what grows straight up, larger where things grow well.
    pub fn upright(&self, random: &mut fastrand::Rng, size: f32) -> Transform {
        let turn = Quat::from_rotation_y(random.f32() * TAU);
        let size = size * (0.6 + 0.4 * self.vigour);
        let tall = between(random, 0.9, 1.1);
        Transform::from_translation(self.foot).with_rotation(turn).with_scale(vec3(size, size * tall, size))
    }

    /// A pose for what lies in the ground.
    pub fn half_sunk(&self, random: &mut fastrand::Rng, size: f32) -> Transform {
        let tilt = Quat::from_rotation_arc(Vec3::Y, self.normal) * Quat::from_rotation_y(random.f32() * TAU);
        let roll = Quat::from_rotation_z(between(random, -0.3, 0.3)) * Quat::from_rotation_x(PI * random.f32() * 0.1);
        let sunk = self.foot - self.normal * size * between(random, 0.02, 0.14);
        Transform::from_translation(sunk).with_rotation(tilt * roll).with_scale(Vec3::splat(size))
    }
}

impl Site<'_> {
    /// One place at most in every cell of a grid, within patches of noise, where the ground suits.
    pub fn scatter(&self, habitat: &Habitat, sort: u64) -> Vec<Place> {
        let mut random = fastrand::Rng::with_seed(self.seed.wrapping_mul(31).wrapping_add(sort));
        let noise = Perlin::new(random.u32(..));
        let (share, size) = habitat.patches;
        let cells = (self.area.size() / habitat.spacing).ceil().as_uvec2();
        let mut places = Vec::new();
        for (row, column) in (0..cells.y).flat_map(|row| (0..cells.x).map(move |column| (row, column))) {
            let jitter = vec2(random.f32(), random.f32());
            let at = self.area.min + (vec2(column as f32, row as f32) + jitter) * habitat.spacing;
            let field = noise.get((at / size).as_dvec2().to_array()) as f32;
            // The logistic curve turns the bell-shaped values of the noise into about even ones.
            let rank = 1.0 / (1.0 + (-field / 0.16).exp());
            // Patches thin out, and their plants grow smaller, towards the edge.
            let vigour = ((rank - (1.0 - share)) / (0.5 * share)).clamp(0.0, 1.0);
            if random.f32() < vigour {
                places.extend(self.place(at, vigour).filter(|place| habitat.suits(place, self.water_level)));
            }
        }
        random.shuffle(&mut places);
        places.truncate(habitat.most);
        places
    }

    /// The ground at a point, if there is any.
    fn place(&self, at: Vec2, vigour: f32) -> Option<Place> {
        const STEP: f32 = 0.5;
        let height = |x: f32, z: f32| (self.height)(at.x + x, at.y + z);
        let rise = vec2(height(STEP, 0.0) - height(-STEP, 0.0), height(0.0, STEP) - height(0.0, -STEP));
        let normal = vec3(-rise.x, 2.0 * STEP, -rise.y).normalize();
        let foot = vec3(at.x, height(0.0, 0.0), at.y);
        (foot.is_finite() && normal.is_finite()).then_some(Place { foot, normal, vigour })
    }
}

impl Habitat {
    fn suits(&self, place: &Place, water_level: f32) -> bool {
        let slope = place.normal.xz().length() / place.normal.y;
        let within = |value: f32, [low, high]: [f32; 2]| (low..=high).contains(&value);
        within(place.foot.y - water_level, self.elevation) && within(slope, self.slope)
    }
}
