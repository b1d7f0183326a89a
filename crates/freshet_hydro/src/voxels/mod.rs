//! Floating bodies as voxels: a body's volume cut into cells, and what the water does to them.
//!
//! The bounding box of a body is cut into n³ cells, after Anastasov & Tomova, *Dynamic surface rendering of water in
//! liquid and solid state in real-time application*, Aalborg 2015 \[AT15\]. There every cell weighs the same and its
//! push grows with the square root of its depth, so that a sphere floats like a cube and neither at its true draft.
//! Here a [`Cell`] knows the volume, the centroid and the second moments of that part of the *shape* that lies in
//! it, and is submerged in proportion to its depth:
//!
//! * [`VoxelHull`] holds the cells of a shape, its volume, and from the same cells its centre and inertia, so that
//!   weight and buoyancy agree with each other;
//! * [`VoxelHull::load`] gives pressure and drag in a given pose and motion as a [`Load`](crate::load::Load).
//!
//! # Symbols
//!
//! V volume (m³), c centroid (m), C second central moments (m²), k submerged share (0…1), h half height of a cell's
//! column (m), η height of the water surface (m), ρ density of the water (kg/m³), g gravity (m/s²), ŷ up.

mod load;

pub use load::Drag;

use glam::{Mat3, USizeVec3, Vec3};
use thiserror::Error;

/// Most cells along an axis: 16³ cells cost sixty times the default of 4³ and change a draft by less than 0.1 %.
pub const MAX_CELLS_PER_AXIS: usize = 16;

/// Samples along an axis of the whole bounding box that a hull has at least.
const SAMPLES_PER_AXIS: usize = 16;

/// The part of a shape inside one cell of its bounding box, in the body's own frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Volume V of the shape inside the cell, in m³, positive.
    pub volume: f32,
    /// Centroid c of that part, in m.
    pub centroid: Vec3,
    /// Second central moments C of that part: the mean of (x − c)(x − c)ᵀ over its volume, in m².
    pub covariance: Mat3,
}

/// The volume of a body as cells cut to its shape, in the body's own frame.
///
/// ```
/// use freshet_hydro::voxels::VoxelHull;
/// use glam::Vec3;
///
/// let volume = 4.0 / 3.0 * std::f32::consts::PI;
/// let ball = VoxelHull::new([Vec3::NEG_ONE, Vec3::ONE], 4, |p| p.length() - 1.0)?.with_volume(volume)?;
/// assert!((ball.volume() - volume).abs() < 1e-5);
/// # Ok::<(), freshet_hydro::voxels::HullError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct VoxelHull {
    cells: Vec<Cell>,
    volume: f32,
    projected_area: Vec3,
}

/// Why a shape has no hull.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum HullError {
    /// The bounding box is infinite, not a number, or flat.
    #[error("the bounding box {min} … {max} has no finite positive size")]
    Bounds {
        /// Lower corner of the box, in m.
        min: Vec3,
        /// Upper corner of the box, in m.
        max: Vec3,
    },
    /// No sample lies inside the shape: it is hollow, open, or thinner than a sixteenth of its bounding box.
    #[error("no part of the bounding box lies inside the shape")]
    Empty,
    /// The given volume is not a positive finite number.
    #[error("the volume {0} m³ is not positive and finite")]
    Volume(f32),
}

impl VoxelHull {
    /// Cuts a shape into `cells_per_axis`³ cells (clamped to 1…[`MAX_CELLS_PER_AXIS`]) of its bounding box `bounds`
    /// = \[lower corner, upper corner\], in m.
    ///
    /// `distance` gives the signed distance from a point to the shape's surface, in m, negative inside. Each cell is
    /// sampled at the middles of at least 3³ equal parts, and the distance tells how much of a part is covered where
    /// the surface crosses it. A shape that only knows in from out may answer −∞ and +∞, at the price of accuracy.
    ///
    /// # Errors
    /// [`HullError::Bounds`] if the box is no box, [`HullError::Empty`] if nothing is found in it.
    pub fn new(
        bounds: [Vec3; 2],
        cells_per_axis: usize,
        mut distance: impl FnMut(Vec3) -> f32,
    ) -> Result<Self, HullError> {
        let [min, max] = bounds;
        let size = max - min;
        if !(min.is_finite() && max.is_finite() && size.min_element() > 0.0) {
            return Err(HullError::Bounds { min, max });
        }
        let cells_per_axis = cells_per_axis.clamp(1, MAX_CELLS_PER_AXIS);
        let samples_per_cell = SAMPLES_PER_AXIS.div_ceil(cells_per_axis).max(3);
        let samples = cells_per_axis * samples_per_cell;
        let step = size / samples as f32;
        let inverse_width = step.min_element().recip();
        let mut moments = vec![Moments::NONE; cells_per_axis.pow(3)];
        let mut shadow = Shadow::new(samples);
        for index in lattice(samples) {
            let point = min + step * (index.as_vec3() + 0.5);
            let covered = (0.5 - distance(point) * inverse_width).clamp(0.0, 1.0);
            if covered > 0.0 {
                let cell = index / samples_per_cell;
                moments[(cell.z * cells_per_axis + cell.y) * cells_per_axis + cell.x].add(point, covered);
                shadow.add(index, covered);
            }
        }

        let cells: Vec<Cell> = moments.iter().filter_map(|m| m.cell(step)).collect();
        if cells.is_empty() {
            return Err(HullError::Empty);
        }
        Ok(Self { volume: cells.iter().map(|cell| cell.volume).sum(), projected_area: shadow.area(step), cells })
    }

    /// The same cells, scaled in volume to add up to `volume`, in m³: for shapes whose exact volume is known.
    ///
    /// # Errors
    /// [`HullError::Volume`] if `volume` is not positive and finite.
    pub fn with_volume(mut self, volume: f32) -> Result<Self, HullError> {
        if !(volume.is_finite() && volume > 0.0) {
            return Err(HullError::Volume(volume));
        }
        let scale = volume / self.volume;
        for cell in &mut self.cells {
            cell.volume *= scale;
        }
        self.volume = volume;
        Ok(self)
    }

    /// The cells that hold a part of the shape.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// Volume of the whole shape, in m³.
    pub fn volume(&self) -> f32 {
        self.volume
    }

    /// Area of the shape's shadow along each of the body's axes, in m²: what a current from that side meets.
    pub fn projected_area(&self) -> Vec3 {
        self.projected_area
    }

    /// The edge of a cube of this volume, in m: the length by which small and large bodies compare.
    pub fn length(&self) -> f32 {
        libm::cbrtf(self.volume)
    }

    /// Centroid of the whole shape, in m: where a homogeneous body has its centre of mass.
    pub fn centroid(&self) -> Vec3 {
        self.cells.iter().map(|cell| cell.centroid * cell.volume).sum::<Vec3>() / self.volume
    }

    /// Inertia about the centroid of a homogeneous body of mass 1 kg, in m². The parallel-axis theorem over the cells:
    /// I = tr(M)·1 − M with M = Σ V (C + (c − c₀)(c − c₀)ᵀ)/ΣV.
    pub fn unit_inertia(&self) -> Mat3 {
        let centre = self.centroid();
        let mut moments = Mat3::ZERO;
        for cell in &self.cells {
            moments += (cell.covariance + outer(cell.centroid - centre)) * (cell.volume / self.volume);
        }
        Mat3::from_diagonal(Vec3::splat(trace(&moments))) - moments
    }
}

/// All points of a lattice with `n` points a side, x fastest.
fn lattice(n: usize) -> impl Iterator<Item = USizeVec3> {
    (0..n * n * n).map(move |i| USizeVec3::new(i % n, i / n % n, i / (n * n)))
}

/// The matrix v vᵀ.
fn outer(v: Vec3) -> Mat3 {
    Mat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// Sum of the diagonal.
fn trace(m: &Mat3) -> f32 {
    m.x_axis.x + m.y_axis.y + m.z_axis.z
}

/// Running weight, mean and scatter of the samples in one cell (West, *Updating mean and variance estimates*, 1979),
/// exact far from the origin too.
#[derive(Clone, Copy)]
struct Moments {
    weight: f32,
    mean: Vec3,
    scatter: Mat3,
}

impl Moments {
    const NONE: Self = Self { weight: 0.0, mean: Vec3::ZERO, scatter: Mat3::ZERO };

    fn add(&mut self, point: Vec3, weight: f32) {
        let before = self.weight;
        self.weight += weight;
        let from_mean = point - self.mean;
        self.mean += from_mean * (weight / self.weight);
        self.scatter += outer(from_mean) * (weight * before / self.weight);
    }

    /// The cell, if it holds any sample. A sample stands for a box of size `step`, whose own variance step²/12
    /// makes the moments of a full cell exact.
    fn cell(&self, step: Vec3) -> Option<Cell> {
        (self.weight > 0.0).then(|| Cell {
            volume: self.weight * step.element_product(),
            centroid: self.mean,
            covariance: self.scatter * self.weight.recip() + Mat3::from_diagonal(step * step / 12.0),
        })
    }
}

/// How much of each column of samples along each axis the shape covers.
struct Shadow {
    samples: usize,
    covered: [Vec<f32>; 3],
}

impl Shadow {
    fn new(samples: usize) -> Self {
        Self { samples, covered: std::array::from_fn(|_| vec![0.0; samples * samples]) }
    }

    fn add(&mut self, i: USizeVec3, covered: f32) {
        let columns = [i.y * self.samples + i.z, i.z * self.samples + i.x, i.x * self.samples + i.y];
        for (shadow, column) in self.covered.iter_mut().zip(columns) {
            shadow[column] = covered.max(shadow[column]);
        }
    }

    fn area(&self, step: Vec3) -> Vec3 {
        let [x, y, z] = [0, 1, 2].map(|axis: usize| self.covered[axis].iter().sum::<f32>());
        Vec3::new(x * step.y * step.z, y * step.z * step.x, z * step.x * step.y)
    }
}

#[cfg(test)]
mod tests;
