//! Cube maps in main memory, laid out and oriented as Bevy samples them.

use bevy::{
    math::{IVec2, Vec2, Vec3, ops},
    tasks::{ComputeTaskPool, ParallelSliceMut, TaskPool},
};

/// Six square faces of linear RGB in the order +X −X +Y −Y +Z −Z of the graphics interfaces, rows from the top.
///
/// Graphics interfaces look up cube maps in a left-handed frame, so `skybox.wgsl` and `environment_map.wgsl` of Bevy
/// negate z first. Every direction in this file is a right-handed *world* direction; the negation is done here, once.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cubemap {
    /// Texels along an edge of a face.
    pub size: usize,
    /// Face after face, row after row.
    pub texels: Vec<Vec3>,
}

impl Cubemap {
    /// Evaluates `radiance(texel index, world direction)` at the centre of every texel, on all cores.
    pub fn from_fn(size: usize, radiance: impl Fn(usize, Vec3) -> Vec3 + Sync) -> Self {
        Self { size, texels: texels_from_fn(size, radiance) }
    }

    /// The unit world direction through the centre of a texel.
    pub fn direction(size: usize, index: usize) -> Vec3 {
        let (face, row, column) = (index / (size * size), index / size % size, index % size);
        let uv = (Vec2::new(column as f32, row as f32) + 0.5) * 2.0 / size as f32 - 1.0;
        face_direction(face, uv).normalize()
    }

    /// The texel that a world direction of any length but zero points into.
    pub fn texel_towards(size: usize, direction: Vec3) -> usize {
        let (face, uv) = face_from_direction(direction);
        let cell = ((uv + 1.0) * 0.5 * size as f32).as_ivec2().clamp(IVec2::ZERO, IVec2::splat(size as i32 - 1));
        (face * size + cell.y as usize) * size + cell.x as usize
    }

    /// The solid angle of a texel, in steradians; those of all texels add up to 4π.
    ///
    /// Integral of 1 / (1 + u² + v²)^(3/2) over the texel, from the antiderivative atan(u v / √(1 + u² + v²)).
    pub fn solid_angle(size: usize, index: usize) -> f32 {
        let corner = |column: usize, row: usize| {
            let (u, v) = (2.0 * column as f32 / size as f32 - 1.0, 2.0 * row as f32 / size as f32 - 1.0);
            ops::atan2(u * v, ops::sqrt(1.0 + u * u + v * v))
        };
        let (row, column) = (index / size % size, index % size);
        corner(column + 1, row + 1) - corner(column, row + 1) - corner(column + 1, row) + corner(column, row)
    }

    /// Bilinear sample in a world direction of any length, blended across the edges of the faces as a GPU does.
    pub fn sample(&self, direction: Vec3) -> Vec3 {
        let (face, uv) = face_from_direction(direction);
        let at = (uv + 1.0) * 0.5 * self.size as f32 - 0.5;
        let low = at.floor();
        let weight = at - low;
        let (x, y) = (low.x as i32, low.y as i32);
        let top = self.texel(face, x, y).lerp(self.texel(face, x + 1, y), weight.x);
        let bottom = self.texel(face, x, y + 1).lerp(self.texel(face, x + 1, y + 1), weight.x);
        top.lerp(bottom, weight.y)
    }

    /// A texel of a face or, one step beyond its edge, of the face that lies there.
    fn texel(&self, face: usize, x: i32, y: i32) -> Vec3 {
        let size = self.size as i32;
        if (0..size).contains(&x) && (0..size).contains(&y) {
            return self.texels[(face * self.size + y as usize) * self.size + x as usize];
        }
        let uv = (Vec2::new(x as f32, y as f32) + 0.5) * 2.0 / size as f32 - 1.0;
        self.texels[Self::texel_towards(self.size, face_direction(face, uv))]
    }

    /// The next smaller map, each texel the mean of four. The size must be even.
    pub fn halved(&self) -> Self {
        let size = self.size / 2;
        Self::from_fn(size, |index, _| {
            let (face, row, column) = (index / (size * size), index / size % size, index % size);
            let corner = (face * self.size + 2 * row) * self.size + 2 * column;
            let t = &self.texels;
            0.25 * (t[corner] + t[corner + 1] + t[corner + self.size] + t[corner + self.size + 1])
        })
    }

    /// Weighted sum over the sphere: ∫ L(ω) weight(ω) dω.
    pub fn integrate(&self, weight: impl Fn(Vec3) -> f32) -> Vec3 {
        let texel = |(index, radiance): (usize, &Vec3)| {
            *radiance * (weight(Self::direction(self.size, index)) * Self::solid_angle(self.size, index))
        };
        self.texels.iter().enumerate().map(texel).sum()
    }
}

/// Evaluates a function of texel index and world direction for all texels of a cube map, on all cores.
pub(super) fn texels_from_fn<T: Copy + Default + Send>(size: usize, texel: impl Fn(usize, Vec3) -> T + Sync) -> Vec<T> {
    let mut texels = vec![T::default(); 6 * size * size];
    let rows = (16 * size).min(texels.len());
    texels.par_chunk_map_mut(ComputeTaskPool::get_or_init(TaskPool::new), rows, |chunk, row| {
        for (column, out) in row.iter_mut().enumerate() {
            let index = chunk * rows + column;
            *out = texel(index, Cubemap::direction(size, index));
        }
    });
    texels
}

/// World direction (not normalised) of a point of a face, `uv` in −1…1 with v down.
fn face_direction(face: usize, uv: Vec2) -> Vec3 {
    let (u, v) = (uv.x, uv.y);
    let left_handed = match face {
        0 => Vec3::new(1.0, -v, -u),
        1 => Vec3::new(-1.0, -v, u),
        2 => Vec3::new(u, 1.0, v),
        3 => Vec3::new(u, -1.0, -v),
        4 => Vec3::new(u, -v, 1.0),
        _ => Vec3::new(-u, -v, -1.0),
    };
    left_handed * Vec3::new(1.0, 1.0, -1.0)
}

/// Inverse of [`face_direction`] for a direction of any length but zero.
fn face_from_direction(direction: Vec3) -> (usize, Vec2) {
    let d = direction * Vec3::new(1.0, 1.0, -1.0);
    let a = d.abs();
    if a.x >= a.y && a.x >= a.z {
        (usize::from(d.x < 0.0), Vec2::new(-d.z * d.x.signum(), -d.y) / a.x)
    } else if a.y >= a.z {
        (2 + usize::from(d.y < 0.0), Vec2::new(d.x, d.z * d.y.signum()) / a.y)
    } else {
        (4 + usize::from(d.z < 0.0), Vec2::new(d.x * d.z.signum(), -d.y) / a.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::PI;

    #[test]
    fn a_direction_finds_its_own_texel() {
        let size = 8;
        for index in 0..6 * size * size {
            assert_eq!(Cubemap::texel_towards(size, Cubemap::direction(size, index)), index);
        }
    }

    #[test]
    fn faces_lie_where_bevy_looks_for_them() {
        // Bevy samples (x, y, −z): world −z (forward of an unturned camera) is the layer +Z, number 4.
        assert_eq!(face_from_direction(Vec3::NEG_Z).0, 4);
        assert_eq!(face_from_direction(Vec3::Z).0, 5);
        assert_eq!(face_from_direction(Vec3::X).0, 0);
        // Looking at −z, world +x is to the right: the upper right texel of layer 4 looks up and right.
        let corner = Cubemap::direction(2, 4 * 4 + 1);
        assert!(corner.x > 0.0 && corner.y > 0.0 && corner.z < 0.0);
    }

    #[test]
    fn texels_cover_the_sphere() {
        for size in [1, 2, 16] {
            let total: f32 = (0..6 * size * size).map(|i| Cubemap::solid_angle(size, i)).sum();
            assert!((total - 4.0 * PI).abs() < 1e-4, "{total}");
        }
        let up = Cubemap::from_fn(32, |_, _| Vec3::ONE).integrate(|d| d.y.max(0.0));
        assert!((up.x - PI).abs() < 1e-2, "{up}");
    }

    #[test]
    fn samples_reproduce_a_smooth_field() {
        let map = Cubemap::from_fn(64, |_, d| d);
        // The last lies on the edge of two faces.
        for direction in [Vec3::new(0.3, 0.5, -0.8), Vec3::new(-0.9, -0.2, 0.1), Vec3::new(0.7, 0.7, 0.4)] {
            assert!(map.sample(direction).distance(direction.normalize()) < 5e-3, "{direction}");
        }
    }
}
