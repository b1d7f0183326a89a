//! Transport of what floats in or on the water: foam, and dye in three colours.
//!
//! Both are areal densities q, so that the total is ∫ q dA. A step is
//!
//! ```text
//! ∂q/∂t + ∇·(u q − K ∇q) = births and decay
//! ```
//!
//! in finite volumes: upwind with van Leer's limiter (1974) and the Lax–Wendroff correction in each direction, so of
//! second order where q is smooth and without new extremes. Nothing crosses the faces of dry cells.
use super::{Cells, foam};
use glam::{IVec2, Vec2, Vec4, Vec4Swizzles};

/// Largest Courant number `|u| Δt/Δx` along an axis; faster carriers are slowed to it.
pub const MAX_COURANT: f32 = 0.25;

/// Largest `K Δt/Δx²`; faster spreading is slowed to it.
pub const MAX_DIFFUSION: f32 = 0.1;

/// Still depth below which a cell is no land but lies beyond the water or its data: there the transport is open.
pub const OPEN_BELOW: f32 = -1e4;

/// What carries and feeds a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stream {
    /// Velocity, m/s.
    pub velocity: Vec2,
    /// Depth of the still water, m; ≤ 0 on land, below [`OPEN_BELOW`] beyond the water.
    pub depth: f32,
    /// Birth rate of foam, 1/s.
    pub birth: f32,
}

/// How a step is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransportStep {
    /// Duration, s.
    pub dt: f32,
    /// Diffusivity K of dye, m²/s, ≥ 0.
    pub spreading: f32,
    /// Time in which dye fades to 1/e, s, > 0; may be infinite.
    pub dye_life: f32,
    /// Time in which foam decays to 1/e, s, > 0.
    pub foam_life: f32,
}

/// The state of foam and dye.
#[derive(Clone, Debug, PartialEq)]
pub struct Transport {
    /// The cells.
    pub cells: Cells,
    /// What carries and feeds every cell.
    pub stream: Vec<Stream>,
    /// Density of foam (x) and of dye (yzw) in every cell.
    pub matter: Vec<Vec4>,
}

/// What a face sees of a cell.
enum Side {
    /// Water in the cell of this index.
    Water(usize),
    Land,
    /// Beyond the water or the rectangle.
    Open,
}

impl Transport {
    /// Clean water, whose carrier at column and row is given, with the foam that balances its births.
    pub fn new(cells: Cells, foam_life: f32, stream: impl Fn(IVec2) -> Stream) -> Self {
        let stream: Vec<Stream> = cells.iter().map(stream).collect();
        let matter = stream.iter().map(|stream| at_rest(stream, foam_life)).collect();
        Self { cells, stream, matter }
    }

    fn side(&self, at: IVec2) -> Side {
        match self.cells.index(at) {
            Some(i) if self.stream[i].depth > 0.0 => Side::Water(i),
            Some(i) if self.stream[i].depth > OPEN_BELOW => Side::Land,
            _ => Side::Open,
        }
    }

    /// Density of the cell `at`, or `other` if there is no water.
    fn density_or(&self, at: IVec2, other: Vec4) -> Vec4 {
        if let Side::Water(i) = self.side(at) { self.matter[i] } else { other }
    }

    /// A step of `step`.
    pub fn step(&mut self, step: &TransportStep) {
        let ratio = step.dt / self.cells.side;
        let value = |(i, at): (usize, IVec2)| {
            let stream = self.stream[i];
            if stream.depth <= 0.0 {
                return Vec4::ZERO;
            }
            let [west, east, north, south] = [(-1, IVec2::X), (0, IVec2::X), (-1, IVec2::Y), (0, IVec2::Y)]
                .map(|(from, axis)| self.flux(at + axis * from, axis, step));
            let carried = self.matter[i] + ratio * ((west - east) + (north - south));
            let foam = foam::after(carried.x, stream.birth, step.foam_life, step.dt);
            (carried.yzw() * libm::expf(-step.dt / step.dye_life)).extend(foam).wxyz()
        };
        self.matter = self.cells.iter().enumerate().map(value).collect();
    }

    /// Flux through the face between the cell `low` and the next one along `axis`, per metre of face.
    fn flux(&self, low: IVec2, axis: IVec2, step: &TransportStep) -> Vec4 {
        let high = low + axis;
        let most = MAX_COURANT * self.cells.side / step.dt;
        let along = |i: usize| self.stream[i].velocity.dot(axis.as_vec2()).clamp(-most, most);
        match (self.side(low), self.side(high)) {
            (Side::Water(a), Side::Water(b)) => {
                let speed = 0.5 * (along(a) + along(b));
                let (qa, qb) = (self.matter[a], self.matter[b]);
                let courant = speed.abs() * step.dt / self.cells.side;
                let face = if speed >= 0.0 {
                    qa + 0.5 * (1.0 - courant) * van_leer(qa - self.density_or(low - axis, qa), qb - qa)
                } else {
                    qb + 0.5 * (1.0 - courant) * van_leer(qb - self.density_or(high + axis, qb), qa - qb)
                };
                let diffusivity = step.spreading.min(MAX_DIFFUSION * self.cells.area() / step.dt);
                let spread = Vec4::new(0.0, 1.0, 1.0, 1.0) * (diffusivity / self.cells.side);
                face * speed - spread * (qb - qa)
            }
            // Out with what is there, in with what is usual there.
            (Side::Water(a), Side::Open) => self.open_flux(a, along(a), 1.0, step.foam_life),
            (Side::Open, Side::Water(b)) => self.open_flux(b, along(b), -1.0, step.foam_life),
            _ => Vec4::ZERO,
        }
    }

    /// Flux between the cell `i` and the open, which lies in the direction `outwards` along the axis.
    fn open_flux(&self, i: usize, speed: f32, outwards: f32, foam_life: f32) -> Vec4 {
        let leaves = speed * outwards > 0.0;
        speed * if leaves { self.matter[i] } else { at_rest(&self.stream[i], foam_life) }
    }

    /// ∫ q dA: m² of foam, and of dye.
    pub fn total(&self) -> Vec4 {
        self.matter.iter().map(|matter| matter.as_dvec4()).sum::<glam::DVec4>().as_vec4() * self.cells.area()
    }
}

/// Clean water with the foam that balances its births.
fn at_rest(stream: &Stream, foam_life: f32) -> Vec4 {
    if stream.depth <= 0.0 { Vec4::ZERO } else { Vec4::X * foam::equilibrium(stream.birth, foam_life) }
}

/// Harmonic mean of two differences of one sign, else zero (van Leer 1974).
fn van_leer(a: Vec4, b: Vec4) -> Vec4 {
    let one = |a: f32, b: f32| if a * b > 0.0 { 2.0 * a * b / (a + b) } else { 0.0 };
    Vec4::new(one(a.x, b.x), one(a.y, b.y), one(a.z, b.z), one(a.w, b.w))
}
