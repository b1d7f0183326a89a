//! Where foam is born, and how its density goes on.
//!
//! The density m is the share of the water that foam covers. It is born at a rate b on what is not covered yet, and decays
//! with its life T: `dm/dt = b (1 − m) − m/T`, so it rests at `b T/(1 + b T)`.
use glam::Vec2;

/// Share of the shore's foam that is born although no wave runs up.
pub const CALM_SHORE: f32 = 0.15;

/// How much foam is born; each rate is switched off by 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FoamSources {
    /// At the waterline, 1/s.
    pub shore: f32,
    /// Depth of still water below which the shore counts, m, > 0.
    pub shore_depth: f32,
    /// In sheared flow: 1/s for each 1/s of shear above the threshold.
    pub shear: f32,
    /// Shear below which none is born, 1/s.
    pub shear_threshold: f32,
    /// Where the current runs together, as in hydraulic jumps and at breaking fronts: 1/s for each 1/s above the threshold.
    pub breaking: f32,
    /// Convergence below which none is born, 1/s.
    pub breaking_threshold: f32,
    /// In fast flow: 1/s for each m/s above the threshold.
    pub speed: f32,
    /// Speed below which none is born, m/s.
    pub speed_threshold: f32,
    /// Around bodies: 1/s for each m/s between body and water.
    pub bodies: f32,
}

/// What happens at a place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stir {
    /// Depth of the still water, m.
    pub depth: f32,
    /// Height of the waves over the still water as if they did not fade in the shallows, m.
    pub crest: f32,
    /// [`shear`] of the current, 1/s.
    pub shear: f32,
    /// [`convergence`] of the current, 1/s.
    pub convergence: f32,
    /// Speed of the current, m/s.
    pub speed: f32,
    /// How much of a body's rim is here, 0…1.
    pub rim: f32,
    /// Speed between that body and the water, m/s.
    pub slip: f32,
}

impl FoamSources {
    /// Birth rate, 1/s; none on dry land.
    pub fn birth(&self, stir: &Stir) -> f32 {
        if stir.depth <= 0.0 {
            return 0.0;
        }
        let shallow = (1.0 - stir.depth / self.shore_depth).max(0.0);
        let run_up = (stir.crest / self.shore_depth).clamp(0.0, 1.0);
        self.shore * shallow * (CALM_SHORE + (1.0 - CALM_SHORE) * run_up)
            + self.shear * (stir.shear - self.shear_threshold).max(0.0)
            + self.breaking * (stir.convergence - self.breaking_threshold).max(0.0)
            + self.speed * (stir.speed - self.speed_threshold).max(0.0)
            + self.bodies * stir.rim * stir.slip
    }
}

/// Rate of deformation of a current, 1/s, from its derivatives along x and z: `√((∂u/∂x − ∂w/∂z)² + (∂u/∂z + ∂w/∂x)²)`.
///
/// In simple shear it is the gradient of the speed; water that turns as a whole has none.
pub fn shear(along_x: Vec2, along_z: Vec2) -> f32 {
    Vec2::new(along_x.x - along_z.y, along_z.x + along_x.y).length()
}

/// Rate at which a current runs together, 1/s, from its derivatives along x and z: `−∇·u`.
pub fn convergence(along_x: Vec2, along_z: Vec2) -> f32 {
    -(along_x.x + along_z.y)
}

/// Density at which birth and decay balance.
pub fn equilibrium(birth: f32, life: f32) -> f32 {
    birth * life / (1.0 + birth * life)
}

/// Density after `dt` (s), exactly.
pub fn after(density: f32, birth: f32, life: f32, dt: f32) -> f32 {
    let rest = equilibrium(birth, life);
    rest + (density - rest) * libm::expf(-(birth + 1.0 / life) * dt)
}
