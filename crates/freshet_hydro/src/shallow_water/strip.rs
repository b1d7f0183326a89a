//! Rows of a strip of columns: the scheme, one operation after the other along whole rows, so that the compiler turns each
//! loop into vector instructions.
use super::scheme::{DEEPEST, FASTEST, FILM, Flux, Side, kept_by_friction, limited, per_depth, riemann, sane, wall};
use crate::waves::GRAVITY;

/// Cells beyond a strip that its cells need.
pub(super) const HALO: usize = 2;
/// Most columns of a strip, so that its rows stay in the processor's nearest cache.
pub(super) const COLUMNS: usize = 256;
/// Values in a row: the strip and its halos.
pub(super) const SPAN: usize = COLUMNS + 2 * HALO;

pub(super) type Values = [f32; SPAN];

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
}

/// One row of the four conserved numbers of a state.
pub(super) struct StateRow<'a> {
    /// Depth, m.
    pub depth: &'a [f32],
    /// What the depth cannot hold: rounding, and volume that left twice, m.
    pub carry: &'a [f32],
    /// Discharge along x, m²/s.
    pub discharge_x: &'a [f32],
    /// Discharge along z, m²/s.
    pub discharge_z: &'a [f32],
}

/// One row of a state that is being written.
pub(super) struct StateRowMut<'a> {
    pub depth: &'a mut [f32],
    pub carry: &'a mut [f32],
    pub discharge_x: &'a mut [f32],
    pub discharge_z: &'a mut [f32],
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
        }
    }
}

impl Sides {
    pub fn get(&self, k: usize) -> Side {
        Side {
            depth: self.depth[k],
            level: self.level[k],
            normal: self.normal[k],
            tangential: self.tangential[k],
        }
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
    /// Depth, level and velocity from a row of the state, written from `at` on.
    #[inline(always)]
    pub fn load(&mut self, at: usize, state: StateRow, bed: &[f32]) {
        let n = bed.len();
        let (h, qx, qz) = (&state.depth[..n], &state.discharge_x[..n], &state.discharge_z[..n]);
        let (depth, level) = (&mut self.depth[at..at + n], &mut self.level[at..at + n]);
        let (u, v) = (&mut self.u[at..at + n], &mut self.v[at..at + n]);
        for k in 0..n {
            let d = sane(h[k], DEEPEST).max(0.0);
            let factor = per_depth(d);
            depth[k] = d;
            level[k] = d + bed[k];
            u[k] = sane(qx[k] * factor, FASTEST);
            v[k] = sane(qz[k] * factor, FASTEST);
        }
    }
}

impl Faces {
    /// Limited slopes, carried half a step ahead by the equations in primitive form (Hancock), in the cells `range` of the
    /// row `here` between its neighbours.
    #[inline(always)]
    pub fn reconstruct(&mut self, north: &Cells, here: &Cells, south: &Cells, range: (usize, usize), half_ratio: f32) {
        let (a, b) = range;
        let n = b - a;
        macro_rules! around {
            ($field:ident) => {
                (&here.$field[a - 1..b - 1], &here.$field[a..b], &here.$field[a + 1..b + 1], &north.$field[a..b], &south.$field[a..b])
            };
        }
        let (h_w, h, h_e, h_n, h_s) = around!(depth);
        let (l_w, l, l_e, l_n, l_s) = around!(level);
        let (u_w, u, u_e, u_n, u_s) = around!(u);
        let (v_w, v, v_e, v_n, v_s) = around!(v);
        macro_rules! side {
            ($side:ident) => {
                (
                    &mut self.$side.depth[a..b],
                    &mut self.$side.level[a..b],
                    &mut self.$side.normal[a..b],
                    &mut self.$side.tangential[a..b],
                )
            };
        }
        let west = side!(west);
        let east = side!(east);
        let north = side!(north);
        let south = side!(south);
        let (push_x, push_z) = (&mut self.push_x[a..b], &mut self.push_z[a..b]);
        for k in 0..n {
            let hx = 0.5 * limited(h[k] - h_w[k], h_e[k] - h[k]);
            let hz = 0.5 * limited(h[k] - h_n[k], h_s[k] - h[k]);
            let lx = 0.5 * limited(l[k] - l_w[k], l_e[k] - l[k]);
            let lz = 0.5 * limited(l[k] - l_n[k], l_s[k] - l[k]);
            let ux = 0.5 * limited(u[k] - u_w[k], u_e[k] - u[k]);
            let uz = 0.5 * limited(u[k] - u_n[k], u_s[k] - u[k]);
            let vx = 0.5 * limited(v[k] - v_w[k], v_e[k] - v[k]);
            let vz = 0.5 * limited(v[k] - v_n[k], v_s[k] - v[k]);

            // ∂h/∂t = −∇·(h u), ∂u/∂t = −u·∇u − g ∇η over Δt/2, where a slope is half the difference over Δx.
            let step = 2.0 * half_ratio;
            let h_t = -step * (u[k] * hx + v[k] * hz + h[k] * (ux + vz));
            let u_t = -step * (u[k] * ux + v[k] * uz + GRAVITY * lx);
            let v_t = -step * (u[k] * vx + v[k] * vz + GRAVITY * lz);
            let (h1, l1, u1, v1) = (h[k] + h_t, l[k] + h_t, u[k] + u_t, v[k] + v_t);

            // The bed of a face stays where it is, also where the water would fall below it.
            let bed_w = (l[k] - lx) - (h[k] - hx);
            let bed_e = (l[k] + lx) - (h[k] + hx);
            let bed_n = (l[k] - lz) - (h[k] - hz);
            let bed_s = (l[k] + lz) - (h[k] + hz);
            let (depth_w, level_w) = ((h1 - hx).max(0.0), (l1 - lx).max(bed_w));
            let (depth_e, level_e) = ((h1 + hx).max(0.0), (l1 + lx).max(bed_e));
            let (depth_n, level_n) = ((h1 - hz).max(0.0), (l1 - lz).max(bed_n));
            let (depth_s, level_s) = ((h1 + hz).max(0.0), (l1 + lz).max(bed_s));
            (west.0[k], west.1[k], west.2[k], west.3[k]) = (depth_w, level_w, u1 - ux, v1 - vx);
            (east.0[k], east.1[k], east.2[k], east.3[k]) = (depth_e, level_e, u1 + ux, v1 + vx);
            (north.0[k], north.1[k], north.2[k], north.3[k]) = (depth_n, level_n, v1 - vz, u1 - uz);
            (south.0[k], south.1[k], south.2[k], south.3[k]) = (depth_s, level_s, v1 + vz, u1 + uz);
            push_x[k] = (0.5 * GRAVITY) * (depth_w + depth_e) * (level_e - level_w);
            push_z[k] = (0.5 * GRAVITY) * (depth_n + depth_s) * (level_s - level_n);
        }
    }
}

impl Fluxes {
    /// Fluxes between the sides `before[k]` and `after[k + shift]` of the faces `k` of `range`, over `crests` if there are any.
    #[inline(always)]
    pub fn solve(&mut self, before: &Sides, after: &Sides, shift: usize, range: (usize, usize), crests: Option<&Values>) {
        let (a, b) = range;
        match crests {
            None => self.solve_over(before, after, shift, range, |_| f32::NEG_INFINITY),
            Some(crests) => {
                self.solve_over(before, after, shift, range, |k| crests[k]);
                for k in a..b {
                    if crests[k] == f32::INFINITY {
                        self.before[k] += wall(before.depth[k], before.normal[k]);
                        self.after[k] += wall(after.depth[k + shift], -after.normal[k + shift]);
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn solve_over(
        &mut self,
        before: &Sides,
        after: &Sides,
        shift: usize,
        (a, b): (usize, usize),
        crest: impl Fn(usize) -> f32,
    ) {
        let n = b - a;
        let l = (&before.depth[a..b], &before.level[a..b], &before.normal[a..b], &before.tangential[a..b]);
        let (c, d) = (a + shift, b + shift);
        let r = (&after.depth[c..d], &after.level[c..d], &after.normal[c..d], &after.tangential[c..d]);
        let (mass, first) = (&mut self.mass[a..b], &mut self.before[a..b]);
        let (second, along) = (&mut self.after[a..b], &mut self.tangential[a..b]);
        for k in 0..n {
            let left = Side { depth: l.0[k], level: l.1[k], normal: l.2[k], tangential: l.3[k] };
            let right = Side { depth: r.0[k], level: r.1[k], normal: r.2[k], tangential: r.3[k] };
            let flux = riemann(left, right, crest(a + k));
            mass[k] = flux.mass;
            first[k] = flux.before;
            second[k] = flux.after;
            along[k] = flux.tangential;
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
    /// See [`Faces::push_x`].
    pub push_x: &'a Values,
    /// See [`Faces::push_z`].
    pub push_z: &'a Values,
    /// What point sources add, m/s, for each cell; empty if there are none.
    pub sources: &'a [f32],
}

/// Writes the state of a row after a step into `new` and what fell or sprang in it (m) into `given`, and returns the greatest speed of a signal in it, |u| + c (m/s).
#[inline(always)]
pub(super) fn update(new: &mut StateRowMut, old: StateRow, around: &Surroundings, numbers: Numbers, given: &mut Values) -> f32 {
    if around.sources.is_empty() {
        update_with(new, old, around, numbers, given, |_| 0.0)
    } else {
        update_with(new, old, around, numbers, given, |k| around.sources[k])
    }
}

#[inline(always)]
fn update_with(
    new: &mut StateRowMut,
    old: StateRow,
    around: &Surroundings,
    numbers: Numbers,
    given: &mut Values,
    source: impl Fn(usize) -> f32,
) -> f32 {
    let n = old.depth.len();
    let given = &mut given[..n];
    let (h, carry, qx, qz) = (&old.depth[..n], &old.carry[..n], &old.discharge_x[..n], &old.discharge_z[..n]);
    let (h_new, carry_new) = (&mut new.depth[..n], &mut new.carry[..n]);
    let (qx_new, qz_new) = (&mut new.discharge_x[..n], &mut new.discharge_z[..n]);
    let (from, to) = (HALO, HALO + n);
    let (x, north, south) = (around.x, around.north, around.south);
    let (mass_e, before_e, along_e) = (&x.mass[from..to], &x.before[from..to], &x.tangential[from..to]);
    let (mass_w, after_w, along_w) = (&x.mass[from - 1..to - 1], &x.after[from - 1..to - 1], &x.tangential[from - 1..to - 1]);
    let (mass_n, after_n, along_n) = (&north.mass[from..to], &north.after[from..to], &north.tangential[from..to]);
    let (mass_s, before_s, along_s) = (&south.mass[from..to], &south.before[from..to], &south.tangential[from..to]);
    let (push_x, push_z) = (&around.push_x[from..to], &around.push_z[from..to]);
    let Numbers { dt, ratio, drag, rain } = numbers;
    let mut fastest = 0_u32;
    for k in 0..n {
        let depth = sane(h[k], DEEPEST).max(0.0);
        let flowed = -ratio * ((mass_e[k] - mass_w[k]) + (mass_s[k] - mass_n[k]));
        // A sink takes no more than there is.
        given[k] = (dt * (rain + source(k))).max(-(depth + flowed).max(0.0));
        // Kahan: what the sum cannot hold is carried to the next step, and so is water that left twice.
        let change = flowed + given[k] + sane(carry[k], DEEPEST);
        let sum = (depth + change).max(0.0);
        h_new[k] = sum;
        carry_new[k] = change - (sum - depth);

        let px = sane(qx[k], DEEPEST * FASTEST) - ratio * ((before_e[k] - after_w[k]) + push_x[k] + (along_s[k] - along_n[k]));
        let pz = sane(qz[k], DEEPEST * FASTEST) - ratio * ((before_s[k] - after_n[k]) + push_z[k] + (along_e[k] - along_w[k]));
        let size = (px * px + pz * pz).sqrt();
        let factor = per_depth(sum);
        // In a film the discharge follows the reduced speed, so that none is left over when it deepens.
        let film = if sum < FILM { sum * factor } else { 1.0 };
        let kept = kept_by_friction(sum, size, dt, drag) * film;
        qx_new[k] = px * kept;
        qz_new[k] = pz * kept;
        let speed = (px.abs().max(pz.abs()) * kept) * factor + (GRAVITY * sum).sqrt();
        // Floats that are not negative are ordered like their bits, and integers have a vector maximum.
        fastest = fastest.max(speed.to_bits());
    }
    f32::from_bits(fastest)
}
