//! The formulas of the scheme, for one cell or one face. The README beside this file derives them.
//!
//! Only additions, products, quotients, square roots and comparisons, each rounded once, in the order written here: the
//! result is the same on every machine, and in `shallow_water.wgsl` up to the shader compiler's freedom.
use crate::waves::GRAVITY;

/// Depth, m, below which speed is reduced smoothly to nothing, as q/h loses its meaning there.
pub const FILM: f32 = 1e-4;
/// Depths from this on, m, are taken for damage and not for water.
pub const DEEPEST: f32 = 1e6;
/// Speeds from this on, m/s, are taken for damage and not for water.
pub const FASTEST: f32 = 1e4;
/// Crest, m, of a face that nothing can pass.
pub const CLOSED: f32 = f32::INFINITY;

/// `value` unless it is NaN or of `limit` and more, else 0.
#[inline(always)]
pub(super) fn sane(value: f32, limit: f32) -> f32 {
    if value.abs() < limit { value } else { 0.0 }
}

/// The larger number, `b` if they are not ordered: one instruction, which `f32::max` is not.
#[inline(always)]
pub(super) fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller number, `b` if they are not ordered.
#[inline(always)]
pub(super) fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// What turns a discharge q (m²/s) in water of `depth` h into its speed: 1/h, and 2h/(h² + ε²) below [`FILM`] ε.
#[inline(always)]
pub(super) fn per_depth(depth: f32) -> f32 {
    let square = depth * depth;
    2.0 * depth / (square + max(square, FILM * FILM))
}

/// Half the difference across a cell from the differences to its two neighbours, limited so that neither face overshoots the
/// neighbour there (generalised minmod with factor 1.5, van Leer 1979): steeper ones never come to rest behind a jump.
#[inline(always)]
pub(super) fn half_slope(before: f32, after: f32) -> f32 {
    let central = (1.0 / 3.0) * (before + after);
    let most = max(min(before, after), 0.0);
    let least = min(max(before, after), 0.0);
    0.75 * max(min(central, most), least)
}

/// Bed that a cell shows at a face (m), and by how much that lifts its level there.
///
/// `found` is level less depth at the face by their slopes. Where the water is shallower than the bed's steps it can lie beyond
/// the beds of both cells, and the face of a dike would be shut by the water before it: there it is kept between them.
#[inline(always)]
pub(super) fn face_bed(found: f32, bed: f32, next: f32, is_shallow: bool) -> (f32, f32) {
    let kept = max(min(found, max(bed, next)), min(bed, next));
    if is_shallow { (kept, kept - found) } else { (found, 0.0) }
}

/// How broken the water of a cell is, 0…1: 1 in jumps and bores, where `closing`, the speed at which its neighbours approach each
/// other (m/s), is more than a quarter of the celerity.
#[inline(always)]
pub(super) fn brokenness(depth: f32, closing: f32) -> f32 {
    let closing = max(closing, 0.0);
    let share = closing * closing / (GRAVITY * max(depth, 1e-3));
    max(min(20.0 * (share - 0.005), 1.0), 0.0)
}

/// Depth, level, normal and tangential velocity at one side of a face.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Side {
    pub depth: f32,
    pub level: f32,
    pub normal: f32,
    pub tangential: f32,
}

/// What passes a face along its normal.
///
/// The pressure ½ g h² of each side is left out of `before` and `after`, which keeps still water exactly still.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Flux {
    /// Volume, m²/s.
    pub mass: f32,
    /// Momentum along the normal as the cell before the face gets it, m³/s².
    pub before: f32,
    /// Momentum along the normal as the cell after the face gets it, m³/s².
    pub after: f32,
    /// Momentum along the face, m³/s².
    pub tangential: f32,
}

/// The water of two sides above the higher of their beds, or above a crest, as it meets at a face.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Meeting {
    /// Depths, m.
    pub hl: f32,
    pub hr: f32,
    /// Normal velocities, m/s. A dry side moves with the front that would run over it: u + 2c.
    pub ul: f32,
    pub ur: f32,
    /// Celerities, m/s.
    pub cl: f32,
    pub cr: f32,
}

impl Meeting {
    /// Hydrostatic reconstruction (Audusse et al. 2004) over a step of the bed, or over a `crest` (m) above it.
    #[inline(always)]
    pub fn new(l: Side, r: Side, crest: f32) -> Self {
        let sill = max(max(l.level - l.depth, r.level - r.depth), crest);
        let hl = max(l.level - sill, 0.0);
        let hr = max(r.level - sill, 0.0);
        let cl = (GRAVITY * hl).sqrt();
        let cr = (GRAVITY * hr).sqrt();
        let ul = if hl > 0.0 { l.normal } else { r.normal - 2.0 * cr };
        let ur = if hr > 0.0 { r.normal } else { l.normal + 2.0 * cl };
        Self { hl, hr, ul, ur, cl, cr }
    }

    /// Normal velocity between the two waves, m/s.
    #[inline(always)]
    fn middle_speed(&self) -> f32 {
        0.5 * (self.ul + self.ur) + (self.cl - self.cr)
    }

    /// Half the difference of the squares of the depths times g, m³/s²: what the pressures differ by.
    #[inline(always)]
    fn pressure(&self) -> f32 {
        0.5 * GRAVITY * ((self.hr - self.hl) * (self.hr + self.hl))
    }

    /// Flux of the HLLC solver with the speeds of two rarefactions (Toro 2001), where the sides move along the face at speeds
    /// `l` and `r` (m/s); by how much it would smooth those with HLL, m²/s; and whether one of the waves is a fan that opens to
    /// both sides of the face.
    #[inline(always)]
    pub fn hllc(&self, l: f32, r: f32) -> (Flux, f32, bool) {
        let Self { hl, hr, ul, ur, cl, cr } = *self;
        let middle_speed = self.middle_speed();
        let middle_celerity = max(0.5 * (cl + cr) + 0.25 * (ul - ur), 0.0);
        // Speeds of the heads and tails of the two waves.
        let (head_l, tail_l) = (ul - cl, middle_speed - middle_celerity);
        let (tail_r, head_r) = (middle_speed + middle_celerity, ur + cr);
        let sl = min(min(head_l, tail_l), 0.0);
        let sr = max(max(head_r, tail_r), 0.0);
        let ql = hl * ul;
        let qr = hr * ur;
        let per_width = 1.0 / max(sr - sl, 1e-20);
        let both = sl * sr;
        let pressure = self.pressure();
        let mass = (sr * ql - sl * qr + both * (hr - hl)) * per_width;
        let before = (sr * (ql * ul) - sl * (qr * ur + pressure) + both * (qr - ql)) * per_width;
        let flux = Flux { mass, before, after: before - pressure, tangential: carried(mass, l, r) };
        let is_fan = (head_l < 0.0) & (tail_l > 0.0) | (head_r > 0.0) & (tail_r < 0.0);
        (flux, both * per_width * min(hl, hr), is_fan)
    }

    /// Within a fan that opens to both sides of the face the flow is critical, and known exactly.
    #[inline(always)]
    fn fan(&self, l: f32, r: f32) -> Flux {
        let Self { hl, ul, ur, cl, cr, .. } = *self;
        // The fan of the left wave lies over the face where what follows it goes to the right.
        let is_left = self.middle_speed() > 0.0;
        let speed = if is_left { ul + 2.0 * cl } else { ur - 2.0 * cr } * (1.0 / 3.0);
        let celerity = max(if is_left { speed } else { -speed }, 0.0);
        let depth = celerity * celerity * (1.0 / GRAVITY);
        let mass = depth * if is_left { celerity } else { -celerity };
        let before = depth * celerity * celerity + 0.5 * GRAVITY * ((depth - hl) * (depth + hl));
        Flux { mass, before, after: before - self.pressure(), tangential: carried(mass, l, r) }
    }
}

/// Momentum along a face that `mass` carries from the side that it comes from, where the sides move at speeds `l` and `r`.
#[inline(always)]
fn carried(mass: f32, l: f32, r: f32) -> f32 {
    max(mass, 0.0) * l + min(mass, 0.0) * r
}

/// Flux between two sides over a step of the bed, or over a `crest` (m) above it: hydrostatic reconstruction with the HLLC
/// solver, exact within critical fans.
///
/// Where water is `broken` (0…1, see [`brokenness`]) shear is smoothed as by the HLL solver: without it jumps that lie along the
/// grid's rows or columns grow fingers (the carbuncle phenomenon; Kemm 2014).
#[inline(always)]
pub(super) fn riemann(l: Side, r: Side, crest: f32, broken: f32) -> Flux {
    let meeting = Meeting::new(l, r, crest);
    let (outer, smoothing, is_fan) = meeting.hllc(l.tangential, r.tangential);
    let fan = meeting.fan(l.tangential, r.tangential);
    let flux = if is_fan { fan } else { outer };
    Flux { tangential: flux.tangential + broken * smoothing * (r.tangential - l.tangential), ..flux }
}

/// Momentum that a wall takes from water of `depth` that comes at it with speed `towards`, beyond the pressure of its depth:
/// the flux of [`riemann`] between the water and its mirror image.
#[inline(always)]
pub(super) fn wall(depth: f32, towards: f32) -> f32 {
    let celerity = (GRAVITY * depth).sqrt();
    let speed = max(max(celerity - towards, celerity + 0.5 * towards), 0.0);
    depth * towards * (towards + speed)
}

/// h^(−1/3) for h > 0, to the last bits: a guess y from the exponent, times the binomial series of (1 − r)^(−1/3) with
/// r = 1 − h y³, which is below 0.11.
#[inline(always)]
pub(super) fn inverse_cube_root(h: f32) -> f32 {
    // A third of the bits, from the upper half of them.
    let guess = f32::from_bits(0x54a1_aa00_u32 - (h.to_bits() >> 16) * 0x5555);
    let r = 1.0 - h * (guess * guess * guess);
    let square = r * r;
    let series = (1.0 / 3.0 + 2.0 / 9.0 * r) + square * ((14.0 / 81.0 + 35.0 / 243.0 * r) + square * (91.0 / 729.0));
    guess + guess * (r * series)
}

/// Share of its discharge that water of `depth` keeps after `dt` (s) of Manning friction, `drag` being g n².
///
/// Fully implicit: the root of q = q₀ − Δt g n² |q| q h^(−7/3), so that uniform flow is the same for every Δt.
#[inline(always)]
pub(super) fn kept_by_friction(depth: f32, discharge: f32, dt: f32, drag: f32) -> f32 {
    let root = inverse_cube_root(max(depth, 1e-6));
    let square = root * root;
    let rate = (square * square) * (square * root) * ((drag * dt) * discharge);
    2.0 / (1.0 + (1.0 + 4.0 * rate).sqrt())
}

/// Share of the speed which water of `depth` and `speed` (m/s) would get without friction that it gets in `dt` (s) with it.
///
/// u = u* − Δt g n² |u₀| u h^(−4/3): uniform flow is the same for every Δt here too.
#[inline(always)]
pub(super) fn slowed_by_friction(depth: f32, speed: f32, dt: f32, drag: f32) -> f32 {
    let root = inverse_cube_root(max(depth, 1e-6));
    let square = root * root;
    1.0 / (1.0 + (square * square) * ((drag * dt) * speed))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn side(depth: f32, bed: f32, normal: f32) -> Side {
        Side { depth, level: bed + depth, normal, tangential: 0.7 }
    }

    #[test]
    fn the_cube_root_is_right_to_the_last_bits() {
        for exponent in -60..60 {
            let h = 1.37 * 2.0_f32.powi(exponent);
            let exact = f64::from(h).cbrt().recip();
            assert!((f64::from(inverse_cube_root(h)) / exact - 1.0).abs() < 4e-7, "{h}");
        }
    }

    #[test]
    fn friction_leaves_the_root_of_its_equation() {
        let (depth, before, dt, drag) = (0.3_f32, 2.0_f32, 5.0_f32, GRAVITY * 0.03 * 0.03);
        let after = before * kept_by_friction(depth, before, dt, drag);
        let lost = dt * drag * after * after * depth.powf(-7.0 / 3.0);
        assert!((after + lost - before).abs() < 1e-6 * before, "{after} {lost}");
        assert_eq!(kept_by_friction(depth, before, dt, 0.0), 1.0);
        assert_eq!(kept_by_friction(0.0, 0.0, dt, drag), 1.0);
    }

    #[test]
    fn a_closed_face_passes_nothing_and_a_wall_is_a_mirror() {
        let towards = side(1.0, 0.0, 0.8);
        let closed = riemann(towards, side(2.0, -1.0, 0.1), CLOSED, 0.0);
        assert_eq!(closed, Flux::default());
        let mirrored = riemann(towards, side(1.0, 0.0, -0.8), f32::NEG_INFINITY, 0.0);
        assert!(mirrored.mass.abs() < 1e-6);
        assert!((mirrored.before - wall(1.0, 0.8)).abs() < 1e-5);
    }

    #[test]
    fn a_dam_over_dry_ground_lets_eight_twentysevenths_pass() {
        // Ritter: q = 8/27 c h at the dam.
        let flux = riemann(side(1.0, 0.0, 0.0), side(0.0, 0.0, 0.0), f32::NEG_INFINITY, 0.0);
        let ritter = 8.0 / 27.0 * GRAVITY.sqrt();
        assert!((flux.mass / ritter - 1.0).abs() < 1e-6, "{} {ritter}", flux.mass);
    }

    proptest! {
        #[test]
        fn still_water_stays_still_over_any_step(level in -5.0_f32..5.0, a in -9.0_f32..9.0, b in -9.0_f32..9.0) {
            let at = |bed: f32| Side { depth: (level - bed).max(0.0), level: bed.max(level), ..Default::default() };
            let flux = riemann(at(a), at(b), f32::NEG_INFINITY, 0.0);
            // (level − bed) + bed is the level up to its last bit.
            prop_assert!(flux.mass.abs() < 1e-5 && flux.before.abs() < 1e-4 && flux.after.abs() < 1e-4, "{flux:?}");
        }

        #[test]
        fn a_flux_seen_from_the_other_side_is_its_mirror_image(
            hl in 0.0_f32..3.0, hr in 0.0_f32..3.0, zl in -1.0_f32..1.0, zr in -1.0_f32..1.0, ul in -9.0_f32..9.0, ur in -9.0_f32..9.0,
        ) {
            let flux = riemann(side(hl, zl, ul), side(hr, zr, ur), f32::NEG_INFINITY, 0.0);
            let mirrored = riemann(side(hr, zr, -ur), side(hl, zl, -ul), f32::NEG_INFINITY, 0.0);
            prop_assert!((flux.mass + mirrored.mass).abs() <= 1e-5 * (1.0 + flux.mass.abs()));
            prop_assert!((flux.before - mirrored.after).abs() <= 1e-4 * (1.0 + flux.before.abs()));
        }

        #[test]
        fn faces_never_overshoot_a_neighbour(a in -9.0_f32..9.0, b in -9.0_f32..9.0, c in -9.0_f32..9.0) {
            let half = half_slope(b - a, c - b);
            prop_assert!(b + half <= b.max(c) + 1e-5 && b + half >= b.min(c) - 1e-5);
            prop_assert!(b - half <= b.max(a) + 1e-5 && b - half >= b.min(a) - 1e-5);
        }
    }
}
