//! Rings: small waves of one celerity that spread, reflect from banks and drift with the current.
//!
//! With `D/Dt = ∂t + u·∇`, surface elevation η and its rate v,
//!
//! ```text
//! Dη/Dt = v − η/τ        Dv/Dt = ∇·(c²∇η) − v/τ        c² = (g/k) tanh(k d)
//! ```
//!
//! that is a wave equation with the celerity of the one wavenumber k (Airy 1845), so rings do not disperse. A step is
//! [`Rings::carry`] by u, then [`Rings::spread`]. Dry cells are walls: nothing flows through their faces.
use super::{Cells, NEIGHBOURS};
use crate::waves::GRAVITY;
use glam::{IVec2, Vec2};

/// Largest Courant number `c Δt/Δx` of a step: below 1/√2, where the scheme becomes unstable.
pub const MAX_COURANT: f32 = 0.7;

/// Share of the amplitude that comes back from an absorbing rim.
const REFLECTED: f32 = 1e-3;

/// c², m²/s², of waves of `wavenumber` (rad/m) on still water of `depth` (m); 0 on dry land.
pub fn celerity_squared(wavenumber: f32, depth: f32) -> f32 {
    // Beyond k d = 10 the water is deep to the last digit, and no exponential overflows.
    let relative = (wavenumber * depth).clamp(0.0, 10.0);
    GRAVITY / wavenumber * libm::tanhf(relative)
}

/// How a step is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingStep {
    /// Duration, s, such that c Δt ≤ [`MAX_COURANT`] Δx.
    pub dt: f32,
    /// Time τ in which rings decay to 1/e, s, > 0; may be infinite.
    pub decay: f32,
    /// Whether the western, eastern, northern and southern rim absorb, instead of being walls.
    pub absorbs: [bool; 4],
}

/// The state of the rings.
#[derive(Clone, Debug, PartialEq)]
pub struct Rings {
    /// The cells.
    pub cells: Cells,
    /// c² of every cell, m²/s²; 0 where it is dry.
    pub celerity_squared: Vec<f32>,
    /// Current in every cell, m/s.
    pub current: Vec<Vec2>,
    /// η (m) and v (m/s) of every cell.
    pub waves: Vec<Vec2>,
}

impl Rings {
    /// Still water whose depth (m, ≤ 0 on land) and current (m/s) at column and row are given, for rings of `wavelength`
    /// (m, > 0).
    pub fn new(cells: Cells, wavelength: f32, depth: impl Fn(IVec2) -> f32, current: impl Fn(IVec2) -> Vec2) -> Self {
        let wavenumber = core::f32::consts::TAU / wavelength;
        Self {
            cells,
            celerity_squared: cells.iter().map(|at| celerity_squared(wavenumber, depth(at))).collect(),
            current: cells.iter().map(current).collect(),
            waves: vec![Vec2::ZERO; cells.count()],
        }
    }

    /// c² of the cell `at`; 0 where it is dry or outside.
    fn celerity(&self, at: IVec2) -> f32 {
        self.cells.index(at).map_or(0.0, |i| self.celerity_squared[i])
    }

    /// Raises the surface by `heights` (m, one for every cell; negative lowers it) after spreading each by the weights
    /// ¼, ½, ¼ along x and then z, so that no height stands on one cell alone.
    ///
    /// What would reach dry cells stays where it is, so the raised volume is exact; heights on dry cells do not count.
    pub fn raise(&mut self, heights: &[f32]) {
        let along = |values: &[f32], axis: IVec2| -> Vec<f32> {
            let value = |(i, at): (usize, IVec2)| {
                let own = if self.celerity_squared[i] > 0.0 { values[i] } else { return 0.0 };
                let from = |to: IVec2| match self.cells.index(to) {
                    Some(j) if self.celerity_squared[j] > 0.0 => 0.25 * (values[j] - own),
                    _ => 0.0,
                };
                own + (from(at - axis) + from(at + axis))
            };
            self.cells.iter().enumerate().map(value).collect()
        };
        let spread = along(&along(heights, IVec2::X), IVec2::Y);
        for (wave, height) in self.waves.iter_mut().zip(spread) {
            wave.x += height;
        }
    }

    /// A step of `step`: the rings drift with the current, then spread.
    pub fn step(&mut self, step: &RingStep) {
        if self.current.iter().any(|u| *u != Vec2::ZERO) {
            self.carry(IVec2::X, step.dt);
            self.carry(IVec2::Y, step.dt);
        }
        self.spread(step);
    }

    /// Carries the rings along an axis: semi-Lagrangian, with the quintic Lagrange polynomial through the six cells around
    /// the point of departure, which is stable for up to one cell a step (Strang 1962).
    pub fn carry(&mut self, axis: IVec2, dt: f32) {
        let value = |(i, at): (usize, IVec2)| {
            let cells = (self.current[i].dot(axis.as_vec2()) * dt / self.cells.side).clamp(-1.0, 1.0);
            if cells == 0.0 || self.celerity_squared[i] <= 0.0 {
                return self.waves[i];
            }
            let upstream = if cells > 0.0 { -axis } else { axis };
            let up = self.taps::<3>(at, upstream);
            let down = self.taps::<2>(at, -upstream);
            let taps = [down[1], down[0], self.waves[i], up[0], up[1], up[2]];
            let weights = quintic(cells.abs());
            taps.iter().zip(weights).fold(Vec2::ZERO, |sum, (tap, weight)| sum + *tap * weight)
        };
        self.waves = self.cells.iter().enumerate().map(value).collect();
    }

    /// The next cells from `at` in a direction; from the first dry one on, the last wet one is repeated.
    fn taps<const N: usize>(&self, at: IVec2, direction: IVec2) -> [Vec2; N] {
        let (mut last, mut wet) = (self.cells.index(at).map_or(Vec2::ZERO, |i| self.waves[i]), true);
        core::array::from_fn(|n| {
            let to = at + direction * (n as i32 + 1);
            wet = wet && self.celerity(to) > 0.0;
            if let Some(i) = self.cells.index(to).filter(|_| wet) {
                last = self.waves[i];
            }
            last
        })
    }

    /// Spreads the rings: v and then η, each with the other's newest value (symplectic Euler), by fluxes through the faces
    /// of wet cells. Keeps [`Rings::energy`] but for decay and rims.
    pub fn spread(&mut self, step: &RingStep) {
        let per_area = 1.0 / self.cells.area();
        let value = |(i, at): (usize, IVec2)| {
            let own = self.celerity_squared[i];
            if own <= 0.0 {
                return Vec2::ZERO;
            }
            let Vec2 { x: height, y: rate } = self.waves[i];
            let flux = NEIGHBOURS.map(|to| match self.cells.index(at + to) {
                Some(j) if self.celerity_squared[j] > 0.0 => {
                    0.5 * (own + self.celerity_squared[j]) * (self.waves[j].x - height)
                }
                _ => 0.0,
            });
            let rate = rate + step.dt * (flux[0] + flux[1] + flux[2] + flux[3]) * per_area;
            Vec2::new(height + step.dt * rate, rate) * self.kept(at, own, step)
        };
        self.waves = self.cells.iter().enumerate().map(value).collect();
    }

    /// Share of η and v that is left after a step. Towards an absorbing rim of w cells the rate grows with the square of the
    /// way into it, so that a wave which crosses it twice is left with [`REFLECTED`].
    fn kept(&self, at: IVec2, celerity_squared: f32, step: &RingStep) -> f32 {
        let (near, far) = (at.as_vec2() + 0.5, self.cells.size.as_vec2() - at.as_vec2() - 0.5);
        let ways = [near.x, far.x, near.y, far.y];
        let way = ways.iter().zip(step.absorbs).filter(|(_, absorbs)| *absorbs).map(|(way, _)| *way);
        let width = rim_width(&self.cells);
        let into = (1.0 - way.fold(width, f32::min) / width).max(0.0);
        let most = rim_decay(&self.cells) * celerity_squared.sqrt();
        libm::expf(-step.dt * (1.0 / step.decay + most * into * into))
    }

    /// Volume over the still surface, m³.
    pub fn volume(&self) -> f64 {
        self.waves.iter().map(|wave| f64::from(wave.x)).sum::<f64>() * f64::from(self.cells.area())
    }

    /// What a step of `dt` keeps on still water between walls: `½ Σ (v² + c² ∇η·∇η⁻)`, m⁴/s², with η⁻ = η − Δt v of the
    /// step before. It is never negative while c Δt ≤ [`MAX_COURANT`] Δx.
    pub fn energy(&self, dt: f32) -> f64 {
        let before = |i: usize| f64::from(self.waves[i].x) - f64::from(dt) * f64::from(self.waves[i].y);
        let cell = |(i, at): (usize, IVec2)| {
            let faces = [IVec2::X, IVec2::Y].map(|to| match self.cells.index(at + to) {
                Some(j) if self.celerity_squared[i] > 0.0 && self.celerity_squared[j] > 0.0 => {
                    let rise = f64::from(self.waves[j].x) - f64::from(self.waves[i].x);
                    let celerity = 0.5 * f64::from(self.celerity_squared[i] + self.celerity_squared[j]);
                    celerity * rise * (before(j) - before(i))
                }
                _ => 0.0,
            });
            f64::from(self.waves[i].y).powi(2) * f64::from(self.cells.area()) + faces[0] + faces[1]
        };
        0.5 * self.cells.iter().enumerate().map(cell).sum::<f64>()
    }
}

/// Width of an absorbing rim, cells.
pub fn rim_width(cells: &Cells) -> f32 {
    (cells.size.min_element() as f32 / 4.0).min(16.0)
}

/// Rate of decay at the outer end of an absorbing rim for a celerity of one, 1/m. It grows with the square of the way s into
/// the rim of width w: `2 ∫ rate dx/c = ln(1/REFLECTED)` with `∫ s² ds = 1/3`.
pub fn rim_decay(cells: &Cells) -> f32 {
    1.5 * -libm::logf(REFLECTED) / (rim_width(cells) * cells.side)
}

/// Weights of the cells 2 downstream to 3 upstream of a cell for the value `t` (0…1) cells upstream of it: the Lagrange
/// polynomials through −2…3.
fn quintic(t: f32) -> [f32; 6] {
    let [a, b, c, d, e, f] = [t + 2.0, t + 1.0, t, t - 1.0, t - 2.0, t - 3.0];
    [
        b * c * d * e * f / -120.0,
        a * c * d * e * f / 24.0,
        a * b * d * e * f / -12.0,
        a * b * c * e * f / 12.0,
        a * b * c * d * f / -24.0,
        a * b * c * d * e / 120.0,
    ]
}
