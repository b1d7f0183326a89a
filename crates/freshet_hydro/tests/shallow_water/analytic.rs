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

/// Depth, m, of critical flow of `discharge` (m²/s): the shallowest of all flows of the same energy above the bed.
pub fn critical_depth(discharge: f64) -> f64 {
    (discharge * discharge / G).cbrt()
}

/// Depth, m, of uniform flow of `discharge` (m²/s) down a `slope` with Manning's n (s/m^⅓): u = d^⅔ √S / n.
pub fn normal_depth(discharge: f64, slope: f64, manning: f64) -> f64 {
    (discharge * manning / slope.sqrt()).powf(0.6)
}

/// Elevation, m, of the bed with a bump 0.2 m high at x = 10 m (Goutal and Maurel 1997).
pub fn bump(x: f64) -> f64 {
    (0.2 - 0.05 * (x - 10.0).powi(2)).max(0.0)
}

/// How a flow without friction crosses [`bump`].
#[derive(Clone, Copy, Debug)]
pub enum Crossing {
    /// Slower than its waves everywhere, with this level behind the bump, m.
    Slow(f64),
    /// Critical over the crest and faster than its waves from there on.
    Fast,
    /// Critical over the crest, and by a jump back to this level behind the bump, m.
    Jump(f64),
}

/// Steady flow without friction over [`bump`]: Bernoulli's head is constant, except across the jump (Bélanger).
#[derive(Clone, Copy, Debug)]
pub struct BumpFlow {
    /// Discharge, m²/s.
    pub discharge: f64,
    /// How it crosses the bump.
    pub crossing: Crossing,
}

impl BumpFlow {
    /// Depth at `x`, m.
    pub fn depth(&self, x: f64) -> f64 {
        match self.crossing {
            Crossing::Slow(level) => self.of_head(self.head(level), x, false),
            Crossing::Fast => self.of_head(self.critical_head(), x, x > 10.0),
            Crossing::Jump(level) if x > self.jump() => self.of_head(self.head(level), x, false),
            Crossing::Jump(_) => self.of_head(self.critical_head(), x, x > 10.0),
        }
    }

    /// Where the momentum of the fast flow from the crest is that of the slow flow behind, m; beyond the channel
    /// without jump.
    pub fn jump(&self) -> f64 {
        let Crossing::Jump(level) = self.crossing else { return f64::INFINITY };
        let force = |depth: f64| self.discharge * self.discharge / depth + 0.5 * G * depth * depth;
        let (mut low, mut high) = (10.0, 12.0);
        for _ in 0..100 {
            let x = 0.5 * (low + high);
            let fast = force(self.of_head(self.critical_head(), x, true));
            if fast < force(self.of_head(self.head(level), x, false)) { high = x } else { low = x }
        }
        0.5 * (low + high)
    }

    /// Head where the bed is 0 and the water stands at `level`, m.
    fn head(&self, level: f64) -> f64 {
        level + 0.5 * (self.discharge / level).powi(2) / G
    }

    /// Head of flow that is critical over the crest, m.
    fn critical_head(&self) -> f64 {
        1.5 * critical_depth(self.discharge) + bump(10.0)
    }

    /// The slow or the fast flow of this `head`: below the critical depth the energy falls with depth, above it rises.
    fn of_head(&self, head: f64, x: f64, fast: bool) -> f64 {
        let energy = head - bump(x);
        let critical = critical_depth(self.discharge);
        let (mut thin, mut deep) = if fast { (1e-3 * critical, critical) } else { (critical, energy.max(critical)) };
        for _ in 0..100 {
            let depth = 0.5 * (thin + deep);
            let found = depth + 0.5 * (self.discharge / depth).powi(2) / G;
            if (found < energy) != fast { thin = depth } else { deep = depth }
        }
        0.5 * (thin + deep)
    }
}
