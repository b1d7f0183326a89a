//! Rows of numbers of a strip of columns, and the blocks in which loops go over them.
use super::scheme::{Flux, Side};

/// Cells that a loop takes at once. Their number is fixed, so that the compiler knows that blocks do not overlap.
pub(super) const LANES: usize = 16;
/// Most columns of a strip, so that its rows stay in the processor's nearest caches.
pub(super) const COLUMNS: usize = 1024;
/// Where the own cells of a strip begin in its rows: after a block for the cells west of it, and room for their neighbours.
pub(super) const FIRST: usize = 2 * LANES;
/// Values in a row: room, a block of cells beyond, the strip, and the same in the east.
pub(super) const SPAN: usize = FIRST + COLUMNS + 2 * LANES;

pub(super) type Values = [f32; SPAN];
pub(super) type Block = [f32; LANES];

/// The block of a row that begins at `at`.
#[inline(always)]
pub(super) fn block(values: &Values, at: usize) -> &Block {
    values[at..].first_chunk().expect("rows have room for the last block")
}

/// The block of a row that begins at `at`, for writing.
#[inline(always)]
pub(super) fn block_mut(values: &mut Values, at: usize) -> &mut Block {
    values[at..].first_chunk_mut().expect("rows have room for the last block")
}

/// The whole blocks of `values`, and the rest.
#[inline(always)]
pub(super) fn blocks(values: &[f32]) -> (&[Block], &[f32]) {
    values.as_chunks()
}

/// A block that begins with these values; zeros follow.
#[inline(always)]
pub(super) fn padded(values: &[f32]) -> Block {
    let mut block = [0.0; LANES];
    block[..values.len()].copy_from_slice(values);
    block
}

/// Rows of bed (m), depth (m), level (m) and the velocity (m/s) along and across the row.
#[derive(Clone)]
pub(super) struct Cells {
    pub bed: Values,
    pub depth: Values,
    pub level: Values,
    pub u: Values,
    pub v: Values,
    /// See [`slowed_by_friction`](super::scheme::slowed_by_friction), for half a step.
    pub slowed: Values,
}

/// Rows of what is at one side of faces.
#[derive(Clone)]
pub(super) struct Sides {
    pub depth: Values,
    pub level: Values,
    pub normal: Values,
    pub tangential: Values,
}

/// Rows of fluxes through faces.
#[derive(Clone)]
pub(super) struct Fluxes {
    pub mass: Values,
    pub before: Values,
    pub after: Values,
    pub tangential: Values,
}

/// What the row of cells at hand shows to faces half a step later.
#[derive(Clone, Default)]
pub(super) struct Faces {
    pub west: Sides,
    pub east: Sides,
    pub north: Sides,
}

/// What is kept of a row of cells until the next one has been seen.
#[derive(Clone)]
pub(super) struct Kept {
    /// What it shows to its southern faces half a step later.
    pub south: Sides,
    /// g h ∂η/∂x Δx, m²/s².
    pub push_x: Values,
    /// g h ∂η/∂z Δx, m²/s².
    pub push_z: Values,
    /// See [`brokenness`](super::scheme::brokenness).
    pub broken: Values,
}

const ZEROS: Values = [0.0; SPAN];

impl Default for Cells {
    fn default() -> Self {
        Self { bed: ZEROS, depth: ZEROS, level: ZEROS, u: ZEROS, v: ZEROS, slowed: [1.0; SPAN] }
    }
}

impl Default for Sides {
    fn default() -> Self {
        Self { depth: ZEROS, level: ZEROS, normal: ZEROS, tangential: ZEROS }
    }
}

impl Default for Fluxes {
    fn default() -> Self {
        Self { mass: ZEROS, before: ZEROS, after: ZEROS, tangential: ZEROS }
    }
}

impl Default for Kept {
    fn default() -> Self {
        Self { south: Sides::default(), push_x: ZEROS, push_z: ZEROS, broken: ZEROS }
    }
}

impl Sides {
    /// Depth, level, normal and tangential velocity of a block.
    #[inline(always)]
    pub fn block(&self, at: usize) -> (&Block, &Block, &Block, &Block) {
        (block(&self.depth, at), block(&self.level, at), block(&self.normal, at), block(&self.tangential, at))
    }

    #[inline(always)]
    pub fn block_mut(&mut self, at: usize) -> (&mut Block, &mut Block, &mut Block, &mut Block) {
        (
            block_mut(&mut self.depth, at),
            block_mut(&mut self.level, at),
            block_mut(&mut self.normal, at),
            block_mut(&mut self.tangential, at),
        )
    }

    pub fn get(&self, k: usize) -> Side {
        Side { depth: self.depth[k], level: self.level[k], normal: self.normal[k], tangential: self.tangential[k] }
    }
}

impl Fluxes {
    pub fn set(&mut self, k: usize, flux: Flux) {
        self.mass[k] = flux.mass;
        self.before[k] = flux.before;
        self.after[k] = flux.after;
        self.tangential[k] = flux.tangential;
    }
}
