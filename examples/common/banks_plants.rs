//! What grows on a bank: reeds, tussocks of grass, bushes, willows and alders. Metres; each stands on the origin.

use super::shape::{Shape, any_direction, between};
use bevy::prelude::*;
use std::f32::consts::TAU;

/// Four bundles of reed on crossed cards, 1.5 to 2 m tall, for the reed texture.
pub fn reed_clump(random: &mut fastrand::Rng) -> Shape {
    let mut shape = Shape::default();
    for i in 0..4 {
        let turn = (i as f32 / 4.0 + random.f32() * 0.2) * TAU * 0.5;
        let right = vec3(turn.cos(), 0.0, turn.sin());
        let foot = any_direction(random).with_y(0.0) * 0.35 - Vec3::Y * 0.1;
        let size = between(random, 1.3, 1.9);
        let lean = any_direction(random).with_y(0.0) * 0.15;
        let tint = Vec3::new(1.0, between(random, 0.92, 1.1), 0.85) * between(random, 0.75, 1.1);
        shape.card(foot, right * size * 0.8, Vec3::Y * size + lean, Vec3::Y + right.cross(Vec3::Y) * 0.3, tint);
    }
    shape
}

/// Arching blades around one root, 0.3 to 0.6 m tall, in plain colours.
pub fn tussock(random: &mut fastrand::Rng) -> Shape {
    let mut shape = Shape::default();
    let hue = random.f32();
    let base = vec3(0.045, 0.060, 0.018);
    let tip = vec3(0.15, 0.20, 0.045).lerp(vec3(0.34, 0.29, 0.11), hue * 0.8);
    for _ in 0..22 {
        let turn = random.f32() * TAU;
        let out = vec3(turn.cos(), 0.0, turn.sin());
        let tall = between(random, 0.25, 0.62);
        let rise = Vec3::Y * tall + out * tall * between(random, 0.05, 0.3);
        let bend = (out - Vec3::Y * 0.6) * tall * between(random, 0.15, 0.6);
        let shade = between(random, 0.75, 1.2);
        shape.blade(out * random.f32() * 0.12 - Vec3::Y * 0.04, rise, bend, 0.017, [base * shade, tip * shade]);
    }
    shape
}

/// A round bush 1 to 1.6 m tall of leafy sprays, for the leaf texture.
pub fn bush(random: &mut fastrand::Rng) -> Shape {
    let mut leaves = Shape::default();
    for _ in 0..5 {
        let middle = any_direction(random).with_y(0.0) * 0.5 + Vec3::Y * between(random, 0.4, 0.8);
        let radius = between(random, 0.4, 0.6);
        sprays(&mut leaves, random, Crown { middle, radius, heart: Vec3::Y * 0.5, droop: 0.1 }, 13, 0.55);
    }
    leaves
}

/// What tells the kinds of tree apart.
pub struct Kind {
    /// Height of the finished tree.
    pub height: f32,
    /// How far the limbs leave the trunk: 0 upright, 1 level.
    pub spread: f32,
    /// How far the leaves hang: 0 stand out, 1 straight down.
    pub droop: f32,
    /// Trunks from one root.
    pub trunks: usize,
    /// Multiplies the colour of the leaves.
    pub tint: Vec3,
}

/// A broad, often many-stemmed tree of the waterside with silvery hanging leaves.
pub const WILLOW: Kind = Kind { height: 7.5, spread: 0.75, droop: 0.65, trunks: 2, tint: vec3(1.05, 1.08, 0.95) };
/// A slender, darker tree with level twigs.
pub const ALDER: Kind = Kind { height: 9.0, spread: 0.45, droop: 0.15, trunks: 1, tint: vec3(0.62, 0.78, 0.55) };

/// Wood and leaves of a tree.
pub fn tree(random: &mut fastrand::Rng, kind: &Kind) -> (Shape, Shape) {
    let mut wood = Shape::default();
    let mut crowns = Vec::new();
    for trunk in 0..kind.trunks {
        let lean = if kind.trunks > 1 {
            let turn = (trunk as f32 + random.f32() * 0.6) / kind.trunks as f32 * TAU;
            vec3(turn.cos(), 0.0, turn.sin()) * 0.45
        } else {
            any_direction(random).with_y(0.0) * 0.08
        };
        let limb = Limb {
            base: Vec3::NEG_Y * 0.3,
            rise: (Vec3::Y + lean) * kind.height * between(random, 0.68, 0.78),
            radius: kind.height * 0.022,
            level: 0,
        };
        grow(&mut wood, &mut crowns, random, kind, &limb);
    }
    let heart = crowns.iter().sum::<Vec3>() / crowns.len().max(1) as f32;
    let mut leaves = Shape::default();
    for middle in crowns {
        let radius = between(random, 0.10, 0.14) * kind.height;
        let crown = Crown { middle, radius, heart, droop: kind.droop };
        sprays(&mut leaves, random, crown, 11, 0.15 * kind.height);
    }
    leaves.tint(kind.tint);
    (wood, leaves)
}

struct Limb {
    base: Vec3,
    rise: Vec3,
    radius: f32,
    level: usize,
}

/// Draws a limb and the limbs that leave it; the ends of the finest, and of the rest, carry crowns.
fn grow(wood: &mut Shape, crowns: &mut Vec<Vec3>, random: &mut fastrand::Rng, kind: &Kind, limb: &Limb) {
    let sway = any_direction(random) * limb.rise.length() * 0.06;
    let at = |t: f32| limb.base + limb.rise * t + sway * (t * std::f32::consts::PI * 1.5).sin();
    let rings = [5, 4, 2][limb.level];
    let points: Vec<(Vec3, f32)> = (0..=rings)
        .map(|i| i as f32 / rings as f32)
        .map(|t| (at(t), limb.radius * (1.0 - 0.75 * t) * if limb.level == 0 && t == 0.0 { 1.5 } else { 1.0 }))
        .collect();
    wood.tube(&points, [7, 4, 3][limb.level], Vec3::ONE);
    crowns.push(at(1.0));
    if limb.level == 2 {
        return;
    }
    let count = [8, 3][limb.level];
    let phase = random.f32();
    for child in 0..count {
        let t = 0.32 + 0.6 * (child as f32 + random.f32() * 0.7) / count as f32;
        // The golden angle keeps limbs out of each other's shade.
        let turn = (phase + child as f32 * 0.381_97) * TAU;
        let out = vec3(turn.cos(), 0.0, turn.sin());
        let upward = limb.rise.normalize_or(Vec3::Y).lerp(Vec3::Y, 0.3);
        let length = limb.rise.length() * between(random, 0.34, 0.48) * (1.15 - 0.6 * t);
        let child = Limb {
            base: at(t),
            rise: (upward * (1.0 - kind.spread) + out * (0.35 + kind.spread)).normalize_or(Vec3::Y) * length * 1.25,
            radius: limb.radius * (1.0 - 0.75 * t) * 0.55,
            level: limb.level + 1,
        };
        grow(wood, crowns, random, kind, &child);
    }
}

/// A ball of leaves.
struct Crown {
    middle: Vec3,
    radius: f32,
    /// Middle of the whole plant: leaves are darker towards it and lit as if they lay on a surface around it.
    heart: Vec3,
    droop: f32,
}

fn sprays(leaves: &mut Shape, random: &mut fastrand::Rng, crown: Crown, count: usize, size: f32) {
    for _ in 0..count {
        let out = any_direction(random);
        let foot = crown.middle + out * crown.radius * between(random, 0.2, 0.9);
        let from_heart = foot - crown.heart;
        let up = (out + Vec3::Y * 0.35).normalize_or(Vec3::Y).lerp(Vec3::NEG_Y, crown.droop * random.f32());
        let right = up.cross(any_direction(random)).normalize_or(Vec3::X);
        let size = size * between(random, 0.75, 1.2);
        let normal = from_heart.normalize_or(Vec3::Y) + out * 0.6 + Vec3::Y * 0.5;
        // Light is lost on the way in and down.
        let depth = (from_heart.length() / (crown.radius * 4.0)).min(1.0);
        let light = (0.45 + 0.4 * depth + 0.2 * out.y) * between(random, 0.85, 1.15);
        let hue = vec3(between(random, 0.9, 1.15), 1.0, between(random, 0.8, 1.0));
        leaves.card(foot - up * size * 0.3, right * size, up.normalize_or(Vec3::Y) * size, normal, hue * light);
    }
}
