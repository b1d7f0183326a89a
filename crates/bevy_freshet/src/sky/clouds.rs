//! Fair-weather clouds: cumulus as a field of domes on a level base, and a veil of cirrus above.
//!
//! The shape is found once for a seed and a cover: a ray per texel is marched through the layer, and what it meets is kept
//! as one opacity at one distance. When the sun moves only the light is found anew. Lengths are in km.

use super::{clear::smoothstep, sun::henyey_greenstein};
use bevy::{
    math::{FloatExt, Vec2, Vec3, ops},
    tasks::{ComputeTaskPool, ParallelSliceMut, TaskPool},
};
use noise::{NoiseFn, Perlin};
use std::f32::consts::PI;

/// Height of the level base above the eye.
const BASE: f32 = 1.3;
/// Height of the largest cumulus from base to top.
const TALLEST: f32 = 1.2;
/// Height of the cirrus.
const CIRRUS: f32 = 8.0;
/// Clouds farther than this are hidden by haze.
const FARTHEST: f32 = 70.0;
/// Extinction in the middle of a cumulus, per km: about 60 g of droplets of 8 µm in 200 m³ (Stephens 1978 gives 20…120).
const EXTINCTION: f32 = 45.0;
/// Radius of the Earth.
const EARTH: f32 = 6371.0;

/// What the ray through a texel meets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct CloudTexel {
    /// Share of the light from behind that cumulus holds back, 0…1.
    pub opacity: f32,
    /// Distance of the part that is seen, km.
    pub distance: f32,
    /// Share of the light from behind that cirrus holds back, 0…1.
    pub veil: f32,
}

/// What lights the clouds; per channel, in lux and cd/m².
#[derive(Clone, Copy, Debug)]
pub(super) struct CloudLight {
    /// Unit vector to the sun.
    pub sun_direction: Vec3,
    /// Illuminance by the sun at the height of the cumulus.
    pub sun: Vec3,
    /// Illuminance by the sun at the height of the cirrus.
    pub high_sun: Vec3,
    /// Mean radiance of the sky around them.
    pub sky: Vec3,
    /// Radiance of the ground below them.
    pub ground: Vec3,
}

/// The clouds of one seed and one cover.
pub(super) struct Clouds {
    /// Height of the cloud over each point of the base, mirrored beyond its edge.
    height: Grid<2>,
    /// Billows that eat into the domes, 0…1, mirrored likewise.
    billows: Grid<3>,
    cirrus: Perlin,
    cover: f32,
}

impl Clouds {
    /// Lays out the clouds that hide the share `cover` (0…1) of the base plane.
    pub fn new(seed: u32, cover: f32) -> Self {
        Self {
            height: cumulus_heights(seed, cover),
            billows: billows(seed.wrapping_add(1)),
            cirrus: Perlin::new(seed.wrapping_add(2)),
            cover,
        }
    }

    /// Marches the ray of a unit direction from the ground. `width` is the angle of a texel, in radians.
    pub fn trace(&self, direction: Vec3, width: f32) -> CloudTexel {
        let enter = distance_to_height(direction.y, BASE);
        if direction.y < -0.01 || enter > FARTHEST || self.cover <= 0.0 {
            return CloudTexel::default();
        }
        let leave = distance_to_height(direction.y, BASE + TALLEST);
        let fine = (0.8 * enter * width).max((leave - enter) / 160.0).max(0.02);
        let (mut t, mut empty, mut clear, mut distance) = (enter, 0, 1.0, 0.0);
        while t < leave && clear > 0.01 {
            let density = self.density(along(direction, t), t * width);
            // Long strides through clear air; on meeting a cloud, one stride back and on in short steps.
            if density <= 0.0 {
                empty += 1;
            } else if empty > 4 {
                t -= 3.0 * fine;
                empty = 0;
                continue;
            } else {
                empty = 0;
            }
            let left = clear * ops::exp(-EXTINCTION * fine * density);
            distance += (clear - left) * t;
            clear = left;
            t += if empty > 4 { 4.0 * fine } else { fine };
        }
        let opacity = 1.0 - clear;
        let haze = 1.0 - smoothstep(0.6 * FARTHEST, FARTHEST, enter);
        CloudTexel {
            opacity: opacity * haze,
            distance: if opacity > 0.0 { distance / opacity } else { 0.0 },
            veil: self.veil(direction),
        }
    }

    /// Density 0…1 at a point; billows finer than `blur` (km) are left out.
    fn density(&self, point: Vec3, blur: f32) -> f32 {
        let above = point.y - BASE;
        let height = self.height.sample([point.x, point.z]);
        if above <= 0.0 || above >= height {
            return 0.0;
        }
        let dome = ((height - above) / (0.1 + 0.45 * height)).min(1.0) * smoothstep(0.0, 0.12, above);
        let sharp = 1.0 - smoothstep(0.03, 0.15, blur);
        let eaten = if sharp > 0.0 { 0.8 * sharp * self.billows.sample(point.to_array()) } else { 0.0 };
        ((dome - eaten) / (1.0 - eaten)).max(0.0)
    }

    /// Optical depth from a point towards the sun: six samples, each standing for a longer stretch.
    fn depth_to_sun(&self, point: Vec3, sun: Vec3) -> f32 {
        const STRETCHES: [f32; 6] = [0.03, 0.05, 0.09, 0.16, 0.30, 0.55];
        let mut start = 0.0;
        let mut depth = 0.0;
        for stretch in STRETCHES {
            depth += stretch * self.density(point + sun * (start + 0.5 * stretch), 0.3 * stretch);
            start += stretch;
        }
        depth * EXTINCTION
    }

    /// Streaks of ice 8 km up, drawn out by the wind.
    fn veil(&self, direction: Vec3) -> f32 {
        let t = distance_to_height(direction.y, CIRRUS);
        let haze = 1.0 - smoothstep(30.0, 110.0, t);
        if haze <= 0.0 {
            return 0.0;
        }
        let at = Vec2::new(direction.x, direction.z) * t;
        let wind = Vec2::new(0.82, 0.57);
        let (along, across) = (at.dot(wind), at.perp_dot(wind));
        let bend = fbm(&self.cirrus, Vec2::new(along, across) / 30.0, 2);
        let field = fbm(&self.cirrus, Vec2::new(along / 26.0, across / 13.0) + 7.3, 3);
        let fibres = fbm(&self.cirrus, Vec2::new(along / 16.0 + bend, across / 2.6 + 2.5 * bend), 5);
        let amount = smoothstep(-0.15, 0.6, field + 0.9 * self.cover - 0.35);
        0.55 * haze * amount * smoothstep(-0.35, 0.7, fibres)
    }

    /// Radiance of the cumulus seen through a texel, in cd/m² per channel, as if it were opaque.
    pub fn radiance(&self, direction: Vec3, texel: &CloudTexel, light: &CloudLight) -> Vec3 {
        let point = along(direction, texel.distance);
        let depth = self.depth_to_sun(point, light.sun_direction);
        let toward = direction.dot(light.sun_direction);
        // Light scattered many times leaves a cloud of optical depth τ in all directions: a share 1 / (1 + ¾ (1 − g) τ)
        // (two-stream, Bohren 1987) with g = 0.85. Once-scattered light makes the bright rim around the sun.
        let many = 0.85 / PI / (1.0 + 0.11 * depth);
        let once = (0.5 * henyey_greenstein(0.85, toward) + 0.1 * henyey_greenstein(0.3, toward))
            * ops::exp(-depth)
            * texel.opacity;
        let high = ((point.y - BASE) / 0.8).clamp(0.0, 1.0);
        light.sun * (many + once) + light.sky * 0.6.lerp(1.0, high) + light.ground * 0.6.lerp(0.1, high)
    }

    /// Radiance of cirrus, in cd/m² per channel, as if it were opaque: thin, so it scatters once and mostly forward.
    pub fn veil_radiance(direction: Vec3, light: &CloudLight) -> Vec3 {
        let toward = direction.dot(light.sun_direction);
        light.high_sun * (0.10 + 0.6 * henyey_greenstein(0.75, toward)) + light.sky * 0.7
    }
}

/// Distance along a ray that climbs with sine `rise` until it is `height` above a round Earth.
fn distance_to_height(rise: f32, height: f32) -> f32 {
    // y(t) = t sin + t² cos² / 2R, solved for t without cancellation.
    let curvature = (1.0 - rise * rise) / (2.0 * EARTH);
    2.0 * height / (rise + ops::sqrt(rise * rise + 4.0 * curvature * height))
}

/// The point of a ray after `t` km: x and z on the base plane, y above the ground of a round Earth.
fn along(direction: Vec3, t: f32) -> Vec3 {
    let drop = (1.0 - direction.y * direction.y) / (2.0 * EARTH) * t * t;
    direction * t + Vec3::Y * drop
}

/// Height of the cumulus over every point of the base, the rarest heights being the tallest.
fn cumulus_heights(seed: u32, cover: f32) -> Grid<2> {
    let noise = Perlin::new(seed);
    let mut grid = Grid::<2>::from_fn(1024, 0.06, |[x, z]| {
        let p = Vec2::new(x, z);
        let warp = Vec2::new(fbm(&noise, p / 2.3 + 31.7, 2), fbm(&noise, p / 2.3 - 12.1, 2));
        let places = fbm(&noise, p / 2.6 + 0.35 * warp, 3) + 0.5 * fbm(&noise, p / 13.0 + 5.5, 2);
        places + 0.42 * (0.5 - billow(&noise, p / 1.1 + 0.5 * warp, 4))
    });
    let mut sorted = grid.values.clone();
    sorted.sort_unstable_by(f32::total_cmp);
    let quantile = |share: f32| sorted[(share * (sorted.len() - 1) as f32) as usize];
    let (threshold, spread) = (quantile(1.0 - cover), quantile(0.98) - quantile(0.3));
    for value in &mut grid.values {
        let excess = ((*value - threshold) / spread).max(0.0);
        *value = TALLEST * (1.0 - ops::exp(-1.7 * excess));
    }
    grid
}

/// Rounded lumps with creases between them, the texture of a cauliflower.
fn billows(seed: u32) -> Grid<3> {
    let noise = Perlin::new(seed);
    Grid::<3>::from_fn(64, 0.022, |[x, y, z]| {
        let (mut sum, mut weight, mut frequency) = (0.0, 0.55, 2.6_f64);
        for _ in 0..3 {
            let at = [x, y, z].map(|v| f64::from(v) * frequency);
            sum += weight * (noise.get(at) as f32).abs() * 1.8;
            weight *= 0.5;
            frequency *= 2.1;
        }
        (1.6 - 2.6 * sum).clamp(0.0, 1.0)
    })
}

/// Sum of octaves, each half as strong and twice as fine; about −1…1.
fn fbm(noise: &Perlin, at: Vec2, octaves: usize) -> f32 {
    octave_sum(noise, at, octaves, |n| n)
}

/// The same of the absolute value, 0…1: 0 in the creases.
fn billow(noise: &Perlin, at: Vec2, octaves: usize) -> f32 {
    octave_sum(noise, at, octaves, |n| 1.0 - n.abs() * 1.6)
}

fn octave_sum(noise: &Perlin, at: Vec2, octaves: usize, shape: impl Fn(f32) -> f32) -> f32 {
    let (mut sum, mut weight, mut total, mut at) = (0.0, 1.0, 0.0, at);
    for _ in 0..octaves {
        sum += weight * shape(noise.get([f64::from(at.x), f64::from(at.y)]) as f32);
        total += weight;
        weight *= 0.5;
        // Turning the octaves hides the lattice of the noise.
        at = Vec2::new(0.8, 0.6).rotate(at) * 2.03 + 3.1;
    }
    sum / total
}

/// Samples of a field on a square lattice around the origin, mirrored beyond its edges so that it never ends or jumps.
struct Grid<const D: usize> {
    size: usize,
    spacing: f32,
    values: Vec<f32>,
}

impl<const D: usize> Grid<D> {
    fn from_fn(size: usize, spacing: f32, value: impl Fn([f32; D]) -> f32 + Sync) -> Self {
        let mut values = vec![0.0; size.pow(D as u32)];
        let chunk = values.len() / 64;
        values.par_chunk_map_mut(ComputeTaskPool::get_or_init(TaskPool::new), chunk, |i, part| {
            for (offset, out) in part.iter_mut().enumerate() {
                let index = i * chunk + offset;
                *out = value(std::array::from_fn(|axis| {
                    let cell = index / size.pow(axis as u32) % size;
                    (cell as f32 - 0.5 * (size - 1) as f32) * spacing
                }));
            }
        });
        Self { size, spacing, values }
    }

    /// Linear interpolation at a point, coordinates in the unit of `spacing`.
    fn sample(&self, at: [f32; D]) -> f32 {
        let half = 0.5 * (self.size - 1) as f32;
        let cells = at.map(|x| {
            let cell = x / self.spacing + half;
            let low = cell as i32 - i32::from(cell < 0.0);
            (self.mirror(low), self.mirror(low + 1), cell - low as f32)
        });
        let mut sum = 0.0;
        for corner in 0..1_usize << D {
            let (mut index, mut weight, mut stride) = (0, 1.0, 1);
            for (axis, (low, high, share)) in cells.iter().enumerate() {
                let upper = corner >> axis & 1 == 1;
                index += stride * if upper { *high } else { *low };
                weight *= if upper { *share } else { 1.0 - share };
                stride *= self.size;
            }
            sum += weight * self.values[index];
        }
        sum
    }

    /// … 2 1 0 0 1 2 … for a power of two.
    fn mirror(&self, cell: i32) -> usize {
        let cell = cell as usize & (2 * self.size - 1);
        cell.min(2 * self.size - 1 - cell)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cover_is_the_share_of_the_plane_under_cloud() {
        for cover in [0.0, 0.25, 0.6, 1.0] {
            let heights = cumulus_heights(3, cover).values;
            let covered = heights.iter().filter(|h| **h > 0.0).count() as f32 / heights.len() as f32;
            assert!((covered - cover).abs() < 0.01, "{cover}: {covered}");
        }
    }

    #[test]
    fn no_cover_is_a_clear_sky() {
        let clouds = Clouds::new(1, 0.0);
        assert_eq!(clouds.trace(Vec3::new(0.1, 0.9, 0.2).normalize(), 0.01), CloudTexel::default());
    }

    #[test]
    fn the_same_seed_gives_the_same_clouds() {
        let at = |seed: u32| Clouds::new(seed, 0.5).trace(Vec3::new(0.3, 0.4, -0.5).normalize(), 0.01);
        assert_eq!(at(5), at(5));
    }

    #[test]
    fn rays_meet_the_layer_on_a_round_earth() {
        assert!((distance_to_height(1.0, 2.0) - 2.0).abs() < 1e-4);
        // Over the horizon: t² / 2R = H.
        assert!((distance_to_height(0.0, 1.2) - (2.0 * EARTH * 1.2_f32).sqrt()).abs() < 0.1);
        let d = Vec3::new(0.9, 0.1, 0.3).normalize();
        assert!((along(d, distance_to_height(d.y, 1.2)).y - 1.2).abs() < 1e-3);
    }

    #[test]
    fn a_grid_has_no_seam() {
        let grid = Grid::<2>::from_fn(8, 0.5, |[x, z]| x + 2.0 * z);
        assert!((grid.sample([0.3, -0.7]) - (0.3 - 1.4)).abs() < 1e-5);
        let edge = 1.75;
        assert!((grid.sample([edge - 0.01, 0.0]) - grid.sample([edge + 0.01, 0.0])).abs() < 0.02);
        assert!((grid.sample([edge + 1.0, 0.0]) - grid.sample([edge - 0.5, 0.0])).abs() < 1e-5);
    }
}
