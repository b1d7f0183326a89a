//! Rows of a strip of columns: the scheme, one operation after the other along whole rows, so that the compiler turns each
//! loop into vector instructions.
use super::{
    rows::{Block, Cells, FIRST, Faces, Fluxes, Kept, LANES, SPAN, Sides, Values, block, block_mut, blocks, padded},
    scheme::{
        DEEPEST, FASTEST, FILM, Meeting, Side, brokenness, face_bed, half_slope, kept_by_friction, max, per_depth,
        riemann, sane, slowed_by_friction, wall,
    },
    step::{State, StateMut},
};
use crate::waves::GRAVITY;
use std::ops::Range;

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

/// Bed, depth, level (m) and velocity (m/s) of a cell, from its conserved numbers over its `bed`.
#[inline(always)]
fn primitive(depth: f32, (qx, qz): (f32, f32), bed: f32) -> (f32, f32, f32, f32, f32) {
    let depth = max(sane(depth, DEEPEST), 0.0);
    let factor = per_depth(depth);
    let level = depth + bed;
    // The bed is what is left of the sum, so that where water is still both have the same slope.
    (level - depth, depth, level, sane(qx * factor, FASTEST), sane(qz * factor, FASTEST))
}

impl Cells {
    /// `width` cells of a state over its `bed`, from cell `index` on.
    #[inline(always)]
    pub fn load(&mut self, state: &State, bed: &[f32], index: usize, width: usize) {
        let columns = [&state.depth, &state.discharge_x, &state.discharge_z, bed];
        let [h, qx, qz, z] = columns.map(|values| blocks(&values[index..index + width]));
        for n in 0..width / LANES {
            self.load_block(FIRST + n * LANES, [&h.0[n], &qx.0[n], &qz.0[n], &z.0[n]]);
        }
        if !h.1.is_empty() {
            let [h, qx, qz, z] = [h, qx, qz, z].map(|(_, rest)| padded(rest));
            self.load_block(FIRST + width / LANES * LANES, [&h, &qx, &qz, &z]);
        }
    }

    #[inline(always)]
    fn load_block(&mut self, at: usize, [h, qx, qz, z]: [&Block; 4]) {
        let (bed, depth) = (block_mut(&mut self.bed, at), block_mut(&mut self.depth, at));
        let (level, u, v) = (block_mut(&mut self.level, at), block_mut(&mut self.u, at), block_mut(&mut self.v, at));
        for k in 0..LANES {
            (bed[k], depth[k], level[k], u[k], v[k]) = primitive(h[k], (qx[k], qz[k]), z[k]);
        }
    }

    /// Finds what friction leaves the cells `range` of their speed, if there is any. A loop of its own, for it is a long chain of
    /// operations, and a processor looks ahead over so many only: the shorter they are the more blocks it works on at once.
    #[inline(always)]
    pub fn slow(&mut self, range: Range<usize>, numbers: Numbers) {
        if numbers.drag <= 0.0 {
            return;
        }
        for at in range.step_by(LANES) {
            let (depth, u, v) = (block(&self.depth, at), block(&self.u, at), block(&self.v, at));
            let slowed = block_mut(&mut self.slowed, at);
            for k in 0..LANES {
                let speed = (u[k] * u[k] + v[k] * v[k]).sqrt();
                slowed[k] = slowed_by_friction(depth[k], speed, 0.5 * numbers.dt, numbers.drag);
            }
        }
    }

    /// Cell `index` of a state over its `bed` at place `k`.
    #[inline(always)]
    pub fn load_one(&mut self, state: &State, bed: &[f32], index: usize, k: usize) {
        let discharge = (state.discharge_x[index], state.discharge_z[index]);
        let cell = primitive(state.depth[index], discharge, bed[index]);
        (self.bed[k], self.depth[k], self.level[k], self.u[k], self.v[k]) = cell;
    }

    /// The water of place `from` at place `to`, over this `bed` (m).
    #[inline(always)]
    pub fn repeat(&mut self, from: usize, to: usize, bed: f32) {
        (self.depth[to], self.u[to], self.v[to]) = (self.depth[from], self.u[from], self.v[from]);
        self.level[to] = self.depth[to] + bed;
        self.bed[to] = self.level[to] - self.depth[to];
    }
}

impl Faces {
    /// Limited slopes, carried half a step ahead by the equations in primitive form (Hancock), in the cells `range` of the
    /// row `here` between its neighbours.
    #[inline(always)]
    pub fn reconstruct(
        &mut self,
        kept: &mut Kept,
        (north, here, south): (&Cells, &Cells, &Cells),
        range: Range<usize>,
        numbers: Numbers,
    ) {
        for at in range.step_by(LANES) {
            self.reconstruct_block(kept, (north, here, south), at, numbers);
        }
    }

    #[inline(always)]
    fn reconstruct_block(
        &mut self,
        kept: &mut Kept,
        (north, here, south): (&Cells, &Cells, &Cells),
        at: usize,
        numbers: Numbers,
    ) {
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
            let slowed = block(&here.slowed, at);
            for k in 0..LANES {
                u_then[k] *= slowed[k];
                v_then[k] *= slowed[k];
            }
        }
        let (u_w, u_e) = (block(&here.u, at - 1), block(&here.u, at + 1));
        let (v_n, v_s) = (block(&north.v, at), block(&south.v, at));
        let broken = block_mut(&mut kept.broken, at);
        for k in 0..LANES {
            broken[k] = brokenness(h[k], (u_w[k] - u_e[k]) + (v_n[k] - v_s[k]));
        }
        let now = Now { bed: block(&here.bed, at), depth: h, level: l, risen: &risen };
        let beds = (block(&here.bed, at - 1), block(&here.bed, at + 1));
        let sides = (self.west.block_mut(at), self.east.block_mut(at));
        let push = block_mut(&mut kept.push_x, at);
        show_sides(sides, push, &now, (&hx, &lx), (&u_then, &ux), (&v_then, &vx), beds);
        let beds = (block(&north.bed, at), block(&south.bed, at));
        let sides = (self.north.block_mut(at), kept.south.block_mut(at));
        let push = block_mut(&mut kept.push_z, at);
        show_sides(sides, push, &now, (&hz, &lz), (&v_then, &vz), (&u_then, &uz), beds);
    }
}

type SideBlocks<'a> = (&'a mut Block, &'a mut Block, &'a mut Block, &'a mut Block);

/// Bed, depth and level of a block of cells, and how far they rise in half a step.
struct Now<'a> {
    bed: &'a Block,
    depth: &'a Block,
    level: &'a Block,
    risen: &'a Block,
}

/// What cells show at two opposite sides, from their slopes (of depth and level) and their velocities along and across the
/// normal with their slopes; `beds` are the elevations of the two neighbours.
#[inline(always)]
fn show_sides(
    (before, after): (SideBlocks, SideBlocks),
    push: &mut Block,
    now: &Now,
    (hs, ls): (&Block, &Block),
    (n, ns): (&Block, &Block),
    (t, ts): (&Block, &Block),
    beds: (&Block, &Block),
) {
    let (h, l) = (now.depth, now.level);
    let [mut shown_b, mut shown_a, mut lift_b, mut lift_a] = [[0.0; LANES]; 4];
    let mut is_deep = true;
    for k in 0..LANES {
        let rises = max((beds.0[k] - now.bed[k]).abs(), (beds.1[k] - now.bed[k]).abs());
        is_deep &= h[k] >= rises;
        shown_b[k] = (l[k] - ls[k]) - (h[k] - hs[k]);
        shown_a[k] = (l[k] + ls[k]) - (h[k] + hs[k]);
    }
    if !is_deep {
        for k in 0..LANES {
            let bed = now.bed[k];
            let rises = max((beds.0[k] - bed).abs(), (beds.1[k] - bed).abs());
            (shown_b[k], lift_b[k]) = face_bed(shown_b[k], bed, beds.0[k], h[k] < rises);
            (shown_a[k], lift_a[k]) = face_bed(shown_a[k], bed, beds.1[k], h[k] < rises);
        }
    }
    for k in 0..LANES {
        let (h1, l1) = (h[k] + now.risen[k], l[k] + now.risen[k]);
        // The bed of a face stays where it is, also where the water would fall below it.
        let (depth_b, level_b) = (max(h1 - hs[k], 0.0), max((l1 - ls[k]) + lift_b[k], shown_b[k]));
        let (depth_a, level_a) = (max(h1 + hs[k], 0.0), max((l1 + ls[k]) + lift_a[k], shown_a[k]));
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
    /// Fluxes through the faces `k` of `range` between the cells `k - shift` before and `k` after them, over `crests` if there
    /// are any.
    #[inline(always)]
    pub fn solve(&mut self, before: Beside, after: Beside, shift: usize, range: Range<usize>, crests: Option<&Values>) {
        match crests {
            None => self.solve_over(before, after, shift, range, |_| f32::NEG_INFINITY),
            Some(crests) => {
                self.solve_over(before, after, shift, range.clone(), |k| crests[k]);
                let (before, after) = (before.sides, after.sides);
                for k in range.filter(|&k| crests[k] == f32::INFINITY) {
                    self.before[k] += wall(before.depth[k - shift], before.normal[k - shift]);
                    self.after[k] += wall(after.depth[k], -after.normal[k]);
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
        range: Range<usize>,
        crest: impl Fn(usize) -> f32,
    ) {
        for at in range.step_by(LANES) {
            let (l, r) = (before.sides.block(at - shift), after.sides.block(at));
            let broken = (block(before.broken, at - shift), block(after.broken, at));
            let (mass, first) = (block_mut(&mut self.mass, at), block_mut(&mut self.before, at));
            let (second, along) = (block_mut(&mut self.after, at), block_mut(&mut self.tangential, at));
            let mut is_plain = true;
            for k in 0..LANES {
                let (left, right) = (side(l, k), side(r, k));
                let meeting = Meeting::new(left, right, crest(at + k));
                let (flux, _, is_fan) = meeting.hllc(left.tangential, right.tangential);
                (mass[k], first[k], second[k], along[k]) = (flux.mass, flux.before, flux.after, flux.tangential);
                is_plain &= !is_fan & (max(broken.0[k], broken.1[k]) <= 0.0);
            }
            if is_plain {
                continue;
            }
            for k in 0..LANES {
                let flux = riemann(side(l, k), side(r, k), crest(at + k), max(broken.0[k], broken.1[k]));
                (mass[k], first[k], second[k], along[k]) = (flux.mass, flux.before, flux.after, flux.tangential);
            }
        }
    }
}

#[inline(always)]
fn side((depth, level, normal, tangential): (&Block, &Block, &Block, &Block), k: usize) -> Side {
    Side { depth: depth[k], level: level[k], normal: normal[k], tangential: tangential[k] }
}

/// What surrounds a row of cells, and what enters it from above.
pub(super) struct Surroundings<'a> {
    /// Fluxes along x through the western faces of the cells and of the one after them.
    pub x: &'a Fluxes,
    /// Fluxes along z through the northern faces.
    pub north: &'a Fluxes,
    /// Fluxes along z through the southern faces.
    pub south: &'a Fluxes,
    /// What is kept of the row.
    pub kept: &'a Kept,
    /// What point sources add, m/s, if there are any.
    pub sources: Option<&'a Values>,
}

/// What a strip of columns has met on its way down.
#[derive(Clone)]
pub(super) struct Met {
    /// Greatest |u| + c of every lane, m/s.
    fastest: Block,
    /// What fell and sprang in each cell of the row, m, if there are point sources.
    added: Values,
    /// What fell and sprang, as a sum of depths, m. Counted only if there are point sources.
    pub given: f64,
}

impl Default for Met {
    fn default() -> Self {
        Self { fastest: [0.0; LANES], added: [0.0; SPAN], given: 0.0 }
    }
}

impl Met {
    /// Greatest |u| + c, m/s.
    pub fn fastest(&self) -> f32 {
        self.fastest.into_iter().fold(0.0, f32::max)
    }

    /// Takes the step of `count` cells: those of the domain from `index` on, at place `FIRST` of a strip, and at `to` of `new`.
    #[inline(always)]
    pub fn update(
        &mut self,
        (new, to): (&mut StateMut, usize),
        (old, index): (&State, usize),
        around: &Surroundings,
        numbers: Numbers,
        count: usize,
    ) {
        let olds = [&old.depth, &old.carry, &old.discharge_x, &old.discharge_z];
        let [h, carry, qx, qz] = olds.map(|values| blocks(&values[index..index + count]));
        let news = [&mut *new.depth, &mut *new.carry, &mut *new.discharge_x, &mut *new.discharge_z];
        let [h_new, carry_new, qx_new, qz_new] = news.map(|values| values[to..to + count].as_chunks_mut::<LANES>());
        for n in 0..count / LANES {
            let at = FIRST + n * LANES;
            let new = [&mut h_new.0[n], &mut carry_new.0[n], &mut qx_new.0[n], &mut qz_new.0[n]];
            self.update_block(new, [&h.0[n], &carry.0[n], &qx.0[n], &qz.0[n]], around, numbers, at);
        }
        let rest = h.1.len();
        if rest > 0 {
            let [h, carry, qx, qz] = [h, carry, qx, qz].map(|(_, rest)| padded(rest));
            let mut new = [[0.0; LANES]; 4];
            let fastest = self.fastest;
            self.update_block(new.each_mut(), [&h, &carry, &qx, &qz], around, numbers, FIRST + count - rest);
            // What lies behind the last cell of a row is none of its own.
            self.fastest[rest..].copy_from_slice(&fastest[rest..]);
            for ((_, to), from) in [h_new, carry_new, qx_new, qz_new].into_iter().zip(&new) {
                to.copy_from_slice(&from[..rest]);
            }
        }
        if around.sources.is_some() {
            self.given += self.added[FIRST..FIRST + count].iter().map(|&given| f64::from(given)).sum::<f64>();
        }
    }

    #[inline(always)]
    fn update_block(
        &mut self,
        [h_new, carry_new, qx_new, qz_new]: [&mut Block; 4],
        [h, carry, qx, qz]: [&Block; 4],
        around: &Surroundings,
        numbers: Numbers,
        at: usize,
    ) {
        let (x, north, south) = (around.x, around.north, around.south);
        let (mass_w, after_w, along_w) = (block(&x.mass, at), block(&x.after, at), block(&x.tangential, at));
        let (mass_e, before_e, along_e) =
            (block(&x.mass, at + 1), block(&x.before, at + 1), block(&x.tangential, at + 1));
        let (mass_n, after_n, along_n) =
            (block(&north.mass, at), block(&north.after, at), block(&north.tangential, at));
        let (mass_s, before_s, along_s) =
            (block(&south.mass, at), block(&south.before, at), block(&south.tangential, at));
        let (push_x, push_z) = (block(&around.kept.push_x, at), block(&around.kept.push_z, at));
        let Numbers { dt, ratio, drag, rain } = numbers;
        let mut rate = [rain; LANES];
        if let Some(sources) = around.sources {
            let sources = block(sources, at);
            for k in 0..LANES {
                rate[k] += sources[k];
            }
        }
        for k in 0..LANES {
            let depth = max(sane(h[k], DEEPEST), 0.0);
            let flowed = -ratio * ((mass_e[k] - mass_w[k]) + (mass_s[k] - mass_n[k]));
            // A sink takes no more than there is.
            let added = max(dt * rate[k], -max(depth + flowed, 0.0));
            rate[k] = added;
            // Kahan: what the sum cannot hold is carried to the next step, and so is water that left twice.
            let change = flowed + added + sane(carry[k], DEEPEST);
            let sum = max(depth + change, 0.0);
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
            let signal = max(px.abs(), pz.abs()) * kept * factor + (GRAVITY * sum).sqrt();
            self.fastest[k] = max(signal, self.fastest[k]);
        }
        if around.sources.is_some() {
            *block_mut(&mut self.added, at) = rate;
        }
    }
}
