//! Rows of a strip of columns: the scheme, one operation after the other along whole rows, so that the compiler turns each
//! loop into vector instructions.
use super::scheme::{
    DEEPEST, FASTEST, FILM, Flux, Side, brokenness, face_bed, half_slope, kept_by_friction, max, per_depth, riemann,
    sane, wall,
};
use crate::waves::GRAVITY;

/// Cells beyond a strip that its cells need.
pub(super) const HALO: usize = 2;
/// Most columns of a strip, so that its rows stay in the processor's nearest cache.
pub(super) const COLUMNS: usize = 512;
/// Values in a row: the strip, its halos, and room for the last block.
pub(super) const SPAN: usize = COLUMNS + 2 * LANES;
/// Cells that a loop takes at once. Their number is fixed, so that the compiler knows that blocks do not overlap.
const LANES: usize = 16;

pub(super) type Values = [f32; SPAN];
type Block = [f32; LANES];

/// The block of a row that begins at `at`.
#[inline(always)]
fn block(values: &Values, at: usize) -> &Block {
    values[at..].first_chunk().expect("rows have room for the last block")
}

/// The block of a row that begins at `at`, for writing.
#[inline(always)]
fn block_mut(values: &mut Values, at: usize) -> &mut Block {
    values[at..].first_chunk_mut().expect("rows have room for the last block")
}

/// Rows of depth (m), level (m) and the velocity (m/s) along and across the row.
#[derive(Clone)]
pub(super) struct Cells {
    pub depth: Values,
    pub level: Values,
    pub u: Values,
    pub v: Values,
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

/// What a row of cells shows to its faces half a step later, and how its own slope pushes it.
#[derive(Clone)]
pub(super) struct Faces {
    pub west: Sides,
    pub east: Sides,
    pub north: Sides,
    pub south: Sides,
    /// g h ∂η/∂x Δx, m²/s².
    pub push_x: Values,
    /// g h ∂η/∂z Δx, m²/s².
    pub push_z: Values,
    /// See [`brokenness`].
    pub broken: Values,
}

/// Rows of the four conserved numbers of a state.
#[derive(Clone)]
pub(super) struct StateRows {
    /// Depth, m.
    pub depth: Values,
    /// What the depth cannot hold: rounding, and volume that left twice, m.
    pub carry: Values,
    /// Discharge along x, m²/s.
    pub discharge_x: Values,
    /// Discharge along z, m²/s.
    pub discharge_z: Values,
}

/// Numbers of one step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Numbers {
    /// Δt, s.
    pub dt: f32,
    /// Δt/Δx, s/m.
    pub ratio: f32,
    /// g n², m^(1/3) · n².
    pub drag: f32,
    /// Rain, m/s.
    pub rain: f32,
}

impl Default for Cells {
    fn default() -> Self {
        Self { depth: [0.0; SPAN], level: [0.0; SPAN], u: [0.0; SPAN], v: [0.0; SPAN] }
    }
}

impl Default for StateRows {
    fn default() -> Self {
        Self { depth: [0.0; SPAN], carry: [0.0; SPAN], discharge_x: [0.0; SPAN], discharge_z: [0.0; SPAN] }
    }
}

impl Default for Sides {
    fn default() -> Self {
        Self { depth: [0.0; SPAN], level: [0.0; SPAN], normal: [0.0; SPAN], tangential: [0.0; SPAN] }
    }
}

impl Default for Fluxes {
    fn default() -> Self {
        Self { mass: [0.0; SPAN], before: [0.0; SPAN], after: [0.0; SPAN], tangential: [0.0; SPAN] }
    }
}

impl Default for Faces {
    fn default() -> Self {
        Self {
            west: Sides::default(),
            east: Sides::default(),
            north: Sides::default(),
            south: Sides::default(),
            push_x: [0.0; SPAN],
            push_z: [0.0; SPAN],
            broken: [0.0; SPAN],
        }
    }
}

impl Sides {
    /// Depth, level, normal and tangential velocity of a block.
    #[inline(always)]
    fn block(&self, at: usize) -> (&Block, &Block, &Block, &Block) {
        (block(&self.depth, at), block(&self.level, at), block(&self.normal, at), block(&self.tangential, at))
    }

    #[inline(always)]
    fn block_mut(&mut self, at: usize) -> (&mut Block, &mut Block, &mut Block, &mut Block) {
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

impl Cells {
    /// Depth, level and velocity of the cells `range` from a row of the state over its `bed`.
    #[inline(always)]
    pub fn load(&mut self, state: &StateRows, bed: &Values, range: (usize, usize)) {
        for at in (range.0..range.1).step_by(LANES) {
            let (h, z) = (block(&state.depth, at), block(bed, at));
            let (qx, qz) = (block(&state.discharge_x, at), block(&state.discharge_z, at));
            let (depth, level) = (block_mut(&mut self.depth, at), block_mut(&mut self.level, at));
            let (u, v) = (block_mut(&mut self.u, at), block_mut(&mut self.v, at));
            for k in 0..LANES {
                let d = max(sane(h[k], DEEPEST), 0.0);
                let factor = per_depth(d);
                depth[k] = d;
                level[k] = d + z[k];
                u[k] = sane(qx[k] * factor, FASTEST);
                v[k] = sane(qz[k] * factor, FASTEST);
            }
        }
    }
}

impl Faces {
    /// Limited slopes, carried half a step ahead by the equations in primitive form (Hancock), in the cells `range` of the
    /// row `here` between its neighbours.
    #[inline(always)]
    pub fn reconstruct(&mut self, north: &Cells, here: &Cells, south: &Cells, range: (usize, usize), numbers: Numbers) {
        for at in (range.0..range.1).step_by(LANES) {
            self.reconstruct_block(north, here, south, at, numbers);
        }
    }

    #[inline(always)]
    fn reconstruct_block(&mut self, north: &Cells, here: &Cells, south: &Cells, at: usize, numbers: Numbers) {
        // Several short loops: of one long one the compiler makes no vector instructions.
        macro_rules! slopes {
            ($field:ident) => {{
                let (mut x, mut z) = ([0.0; LANES], [0.0; LANES]);
                let (w, c, e) = (block(&here.$field, at - 1), block(&here.$field, at), block(&here.$field, at + 1));
                let (n, s) = (block(&north.$field, at), block(&south.$field, at));
                for k in 0..LANES {
                    x[k] = half_slope(c[k] - w[k], e[k] - c[k]);
                }
                for k in 0..LANES {
                    z[k] = half_slope(c[k] - n[k], s[k] - c[k]);
                }
                (c, x, z)
            }};
        }
        let (h, hx, hz) = slopes!(depth);
        let (l, lx, lz) = slopes!(level);
        let (u, ux, uz) = slopes!(u);
        let (v, vx, vz) = slopes!(v);

        // ∂h/∂t = −∇·(h u), ∂u/∂t = −u·∇u − g ∇η over Δt/2, where a slope is half the difference over Δx.
        let step = numbers.ratio;
        let (mut risen, mut u_then, mut v_then) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for k in 0..LANES {
            risen[k] = -step * (u[k] * hx[k] + v[k] * hz[k] + h[k] * (ux[k] + vz[k]));
        }
        for k in 0..LANES {
            u_then[k] = u[k] - step * (u[k] * ux[k] + v[k] * uz[k] + GRAVITY * lx[k]);
        }
        for k in 0..LANES {
            v_then[k] = v[k] - step * (u[k] * vx[k] + v[k] * vz[k] + GRAVITY * lz[k]);
        }
        if numbers.drag > 0.0 {
            for k in 0..LANES {
                let speed = (u_then[k] * u_then[k] + v_then[k] * v_then[k]).sqrt();
                let kept = kept_by_friction(h[k], h[k] * speed, 0.5 * numbers.dt, numbers.drag);
                u_then[k] *= kept;
                v_then[k] *= kept;
            }
        }
        let (u_w, u_e) = (block(&here.u, at - 1), block(&here.u, at + 1));
        let (v_n, v_s) = (block(&north.v, at), block(&south.v, at));
        let broken = block_mut(&mut self.broken, at);
        for k in 0..LANES {
            broken[k] = brokenness(h[k], (u_w[k] - u_e[k]) + (v_n[k] - v_s[k]));
        }
        let now = Now { depth: h, level: l, risen: &risen };
        let bed = |cells: &Cells, at: usize| -> Block {
            let (level, depth) = (block(&cells.level, at), block(&cells.depth, at));
            core::array::from_fn(|k| level[k] - depth[k])
        };
        let (before, after) = (self.west.block_mut(at), self.east.block_mut(at));
        let beds = (&bed(here, at - 1), &bed(here, at + 1));
        show_sides(
            before,
            after,
            block_mut(&mut self.push_x, at),
            &now,
            (&hx, &lx),
            (&u_then, &ux),
            (&v_then, &vx),
            beds,
        );
        let (before, after) = (self.north.block_mut(at), self.south.block_mut(at));
        let beds = (&bed(north, at), &bed(south, at));
        show_sides(
            before,
            after,
            block_mut(&mut self.push_z, at),
            &now,
            (&hz, &lz),
            (&v_then, &vz),
            (&u_then, &uz),
            beds,
        );
    }
}

type SideBlocks<'a> = (&'a mut Block, &'a mut Block, &'a mut Block, &'a mut Block);

/// Depth and level of a block of cells, and how far they rise in half a step.
struct Now<'a> {
    depth: &'a Block,
    level: &'a Block,
    risen: &'a Block,
}

/// What cells show at two opposite sides, from their slopes (of depth and level) and their velocities along and across the
/// normal with their slopes; `beds` are the elevations of the two neighbours.
#[inline(always)]
fn show_sides(
    before: SideBlocks,
    after: SideBlocks,
    push: &mut Block,
    now: &Now,
    (hs, ls): (&Block, &Block),
    (n, ns): (&Block, &Block),
    (t, ts): (&Block, &Block),
    beds: (&Block, &Block),
) {
    let (h, l) = (now.depth, now.level);
    for k in 0..LANES {
        let bed = l[k] - h[k];
        let rises = max((beds.0[k] - bed).abs(), (beds.1[k] - bed).abs());
        let (shown_b, lift_b) = face_bed((l[k] - ls[k]) - (h[k] - hs[k]), bed, beds.0[k], h[k] < rises);
        let (shown_a, lift_a) = face_bed((l[k] + ls[k]) - (h[k] + hs[k]), bed, beds.1[k], h[k] < rises);
        let (h1, l1) = (h[k] + now.risen[k], l[k] + now.risen[k]);
        // The bed of a face stays where it is, also where the water would fall below it.
        let (depth_b, level_b) = (max(h1 - hs[k], 0.0), max((l1 - ls[k]) + lift_b, shown_b));
        let (depth_a, level_a) = (max(h1 + hs[k], 0.0), max((l1 + ls[k]) + lift_a, shown_a));
        before.0[k] = depth_b;
        before.1[k] = level_b;
        after.0[k] = depth_a;
        after.1[k] = level_a;
        push[k] = (0.5 * GRAVITY) * (depth_b + depth_a) * (level_a - level_b);
    }
    for k in 0..LANES {
        before.2[k] = n[k] - ns[k];
        after.2[k] = n[k] + ns[k];
        before.3[k] = t[k] - ts[k];
        after.3[k] = t[k] + ts[k];
    }
}

/// Sides and brokenness of the cells before or after faces.
#[derive(Clone, Copy)]
pub(super) struct Beside<'a> {
    pub sides: &'a Sides,
    pub broken: &'a Values,
}

impl Fluxes {
    /// Fluxes through the faces `k` of `range` between the cells `k` before and `k + shift` after them, over `crests` if there are
    /// any.
    #[inline(always)]
    pub fn solve(
        &mut self,
        before: Beside,
        after: Beside,
        shift: usize,
        range: (usize, usize),
        crests: Option<&Values>,
    ) {
        match crests {
            None => self.solve_over(before, after, shift, range, |_| f32::NEG_INFINITY),
            Some(crests) => {
                self.solve_over(before, after, shift, range, |k| crests[k]);
                let (before, after) = (before.sides, after.sides);
                for k in (range.0..range.1).filter(|&k| crests[k] == f32::INFINITY) {
                    self.before[k] += wall(before.depth[k], before.normal[k]);
                    self.after[k] += wall(after.depth[k + shift], -after.normal[k + shift]);
                }
            }
        }
    }

    #[inline(always)]
    fn solve_over(
        &mut self,
        before: Beside,
        after: Beside,
        shift: usize,
        range: (usize, usize),
        crest: impl Fn(usize) -> f32,
    ) {
        for at in (range.0..range.1).step_by(LANES) {
            let (l, r) = (before.sides.block(at), after.sides.block(at + shift));
            let broken = (block(before.broken, at), block(after.broken, at + shift));
            let (mass, first) = (block_mut(&mut self.mass, at), block_mut(&mut self.before, at));
            let (second, along) = (block_mut(&mut self.after, at), block_mut(&mut self.tangential, at));
            for k in 0..LANES {
                let left = Side { depth: l.0[k], level: l.1[k], normal: l.2[k], tangential: l.3[k] };
                let right = Side { depth: r.0[k], level: r.1[k], normal: r.2[k], tangential: r.3[k] };
                let flux = riemann(left, right, crest(at + k), max(broken.0[k], broken.1[k]));
                mass[k] = flux.mass;
                first[k] = flux.before;
                second[k] = flux.after;
                along[k] = flux.tangential;
            }
        }
    }
}

/// What surrounds a row of cells, and what enters it from above.
pub(super) struct Surroundings<'a> {
    /// Fluxes along x through the eastern faces.
    pub x: &'a Fluxes,
    /// Fluxes along z through the northern faces.
    pub north: &'a Fluxes,
    /// Fluxes along z through the southern faces.
    pub south: &'a Fluxes,
    /// The row's own faces.
    pub faces: &'a Faces,
    /// What point sources add, m/s, for each cell; `None` if there are none.
    pub sources: Option<&'a Values>,
}

/// What a step makes of a row.
#[derive(Clone)]
pub(super) struct Updated {
    pub state: StateRows,
    /// What fell and sprang, m.
    pub given: Values,
    /// |u| + c, m/s.
    pub signal: Values,
}

impl Default for Updated {
    fn default() -> Self {
        Self { state: StateRows::default(), given: [0.0; SPAN], signal: [0.0; SPAN] }
    }
}

impl Updated {
    /// The state of the first `width` cells of a strip after a step.
    #[inline(always)]
    pub fn update(&mut self, old: &StateRows, around: &Surroundings, numbers: Numbers, width: usize) {
        for at in (HALO..HALO + width).step_by(LANES) {
            match around.sources {
                None => self.update_block(old, around, numbers, at, |_| 0.0),
                Some(sources) => self.update_block(old, around, numbers, at, |k| sources[at + k]),
            }
        }
    }

    /// The fastest signal of the cells of a strip, m/s.
    #[inline(always)]
    pub fn fastest(&self, width: usize) -> f32 {
        // Floats that are not negative are ordered like their bits, and integers have a vector maximum.
        let signals = &self.signal[HALO..HALO + width];
        f32::from_bits(signals.iter().fold(0, |fastest, signal| fastest.max(signal.to_bits())))
    }

    #[inline(always)]
    fn update_block(
        &mut self,
        old: &StateRows,
        around: &Surroundings,
        numbers: Numbers,
        at: usize,
        source: impl Fn(usize) -> f32,
    ) {
        let (h, carry) = (block(&old.depth, at), block(&old.carry, at));
        let (qx, qz) = (block(&old.discharge_x, at), block(&old.discharge_z, at));
        let (h_new, carry_new) = (block_mut(&mut self.state.depth, at), block_mut(&mut self.state.carry, at));
        let (qx_new, qz_new) = (block_mut(&mut self.state.discharge_x, at), block_mut(&mut self.state.discharge_z, at));
        let (given, signal) = (block_mut(&mut self.given, at), block_mut(&mut self.signal, at));
        let (x, north, south) = (around.x, around.north, around.south);
        let (mass_e, before_e, along_e) = (block(&x.mass, at), block(&x.before, at), block(&x.tangential, at));
        let (mass_w, after_w, along_w) =
            (block(&x.mass, at - 1), block(&x.after, at - 1), block(&x.tangential, at - 1));
        let (mass_n, after_n, along_n) =
            (block(&north.mass, at), block(&north.after, at), block(&north.tangential, at));
        let (mass_s, before_s, along_s) =
            (block(&south.mass, at), block(&south.before, at), block(&south.tangential, at));
        let (push_x, push_z) = (block(&around.faces.push_x, at), block(&around.faces.push_z, at));
        let Numbers { dt, ratio, drag, rain } = numbers;
        for k in 0..LANES {
            let depth = max(sane(h[k], DEEPEST), 0.0);
            let flowed = -ratio * ((mass_e[k] - mass_w[k]) + (mass_s[k] - mass_n[k]));
            // A sink takes no more than there is.
            let added = max(dt * (rain + source(k)), -max(depth + flowed, 0.0));
            // Kahan: what the sum cannot hold is carried to the next step, and so is water that left twice.
            let change = flowed + added + sane(carry[k], DEEPEST);
            let sum = max(depth + change, 0.0);
            given[k] = added;
            h_new[k] = sum;
            carry_new[k] = change - (sum - depth);

            let force_x = (before_e[k] - after_w[k]) + push_x[k] + (along_s[k] - along_n[k]);
            let force_z = (before_s[k] - after_n[k]) + push_z[k] + (along_e[k] - along_w[k]);
            let px = sane(qx[k], DEEPEST * FASTEST) - ratio * force_x;
            let pz = sane(qz[k], DEEPEST * FASTEST) - ratio * force_z;
            let factor = per_depth(sum);
            // In a film the discharge follows the reduced speed, so that none is left over when it deepens.
            let film = if sum < FILM { sum * factor } else { 1.0 };
            let kept = film * kept_by_friction(sum, (px * px + pz * pz).sqrt(), dt, drag);
            qx_new[k] = px * kept;
            qz_new[k] = pz * kept;
            signal[k] = max(px.abs(), pz.abs()) * kept * factor + (GRAVITY * sum).sqrt();
        }
    }
}
