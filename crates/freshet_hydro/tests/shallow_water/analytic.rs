//! Exact solutions of the shallow-water equations, with g as the solver has it.
use freshet_hydro::waves::GRAVITY;

const G: f64 = GRAVITY as f64;

/// Depth (m) and speed (m/s) at `x` (m) and `time` (s > 0) after a dam at 0 between depths `left` > `right` ≥ 0 broke
/// (Ritter 1892, Stoker 1957).
pub fn dam_break(left: f64, right: f64, x: f64, time: f64) -> (f64, f64) {
    let c0 = (G * left).sqrt();
    let speed = x / time;
    let fan = || (4.0 / (9.0 * G) * (c0 - 0.5 * speed).powi(2), 2.0 / 3.0 * (c0 + speed));
    if speed <= -c0 {
        return (left, 0.0);
    }
    if right <= 0.0 {
        return if speed < 2.0 * c0 { fan() } else { (0.0, 0.0) };
    }
    let c = middle_celerity(left, right);
    let (depth, velocity) = (c * c / G, 2.0 * (c0 - c));
    if speed < velocity - c {
        fan()
    } else if speed < shock_speed(left, right) {
        (depth, velocity)
    } else {
        (right, 0.0)
    }
}

/// Speed of the shock of [`dam_break`], m/s.
pub fn shock_speed(left: f64, right: f64) -> f64 {
    let (c0, c) = ((G * left).sqrt(), middle_celerity(left, right));
    2.0 * c * c * (c0 - c) / (c * c - G * right)
}

fn middle_celerity(left: f64, right: f64) -> f64 {
    let (c0, gr) = ((G * left).sqrt(), G * right);
    let residual = |c: f64| -8.0 * gr * c * c * (c0 - c).powi(2) + (c * c - gr).powi(2) * (c * c + gr);
    let (mut low, mut high) = (gr.sqrt(), c0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if residual(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// A parabolic bowl z = −h₀ (1 − r²/a²) in which a flat surface circles (Thacker 1981).
pub struct Bowl {
    /// Depth of the middle, m.
    pub depth: f64,
    /// Radius at level 0, m.
    pub radius: f64,
    /// Radius of the circle on which the middle of the water goes round, m.
    pub swing: f64,
}

impl Bowl {
    /// Elevation of the bed at (x, z), m.
    pub fn bed(&self, x: f64, z: f64) -> f64 {
        -self.depth * (1.0 - (x * x + z * z) / (self.radius * self.radius))
    }

    /// Angular frequency, rad/s.
    pub fn frequency(&self) -> f64 {
        (2.0 * G * self.depth).sqrt() / self.radius
    }

    /// Level (m) and velocity (m/s) at (x, z) and `time` (s), where it is wet.
    pub fn water(&self, x: f64, z: f64, time: f64) -> (f64, [f64; 2]) {
        let (omega, s) = (self.frequency(), self.swing);
        let (sin, cos) = (omega * time).sin_cos();
        let slope = s * self.depth / (self.radius * self.radius);
        (slope * (2.0 * x * cos + 2.0 * z * sin - s), [-s * omega * sin, s * omega * cos])
    }
}
