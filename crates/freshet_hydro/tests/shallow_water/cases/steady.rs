//! Flow that has become steady: over a bump without friction, and uniform down a slope with friction.
use super::{Run, ShallowWater, land, still};
use crate::analytic::{BumpFlow, Crossing, bump, normal_depth};
use freshet_hydro::shallow_water::{DomainSide, Edge, EdgePart};

/// Side of a cell of the channel with the bump, m.
const SIDE: f64 = 0.1;
/// Its width in cells.
const ROWS: u32 = 4;

/// What one steady flow missed.
struct Missed {
    /// Largest |h u / q − 1| away from the jump.
    discharge: f64,
    /// Mean of |Δh| / h.
    depth: f64,
    /// Distance from the exact jump, in cells.
    jump: f64,
}

/// Three flows over a bump 0.2 m high (SWASHES 3.1.3 to 3.1.5): the discharge is the same everywhere, the depth is
/// Bernoulli's, and the jump stands where Bélanger has it.
pub fn over_a_bump(run: Run) {
    println!("flow over a bump | max |h u / q − 1| (%) | mean |Δh| / h (%) | jump off by (cells)");
    let flows = [
        (BumpFlow { discharge: 4.42, crossing: Crossing::Slow(2.0) }, 0.01, 0.01),
        (BumpFlow { discharge: 1.53, crossing: Crossing::Fast }, 0.01, 0.01),
        (BumpFlow { discharge: 0.18, crossing: Crossing::Jump(0.33) }, 0.01, 0.01),
    ];
    for (flow, most_discharge, most_depth) in flows {
        let mut water = bump_channel(flow);
        for k in 0..10 {
        run(&mut water, 60.0);
        let missed = bump_missed(&water, flow);
        println!(
            "{k}{:?} | {:.4} | {:.4} | {:.2}",
            flow.crossing,
            100.0 * missed.discharge,
            100.0 * missed.depth,
            missed.jump
        );
        }
    }
}

/// A channel of 25 m with the bump, still water in it, and the edges that make `flow`.
fn bump_channel(flow: BumpFlow) -> ShallowWater {
    let columns = (25.0 / SIDE) as u32;
    let mut water = land(columns, ROWS, SIDE as f32, |x, _| bump(x + 12.5));
    let (level, outflow) = match flow.crossing {
        Crossing::Slow(level) | Crossing::Jump(level) => (level, Edge::Level((level as f32).into())),
        Crossing::Fast => (0.66, Edge::Open),
    };
    water.fill(level as f32).expect("a sane level");
    let inflow = Edge::Discharge(((flow.discharge * SIDE * f64::from(ROWS)) as f32).into());
    water.set_edge(DomainSide::West, EdgePart::All, inflow).expect("a sane discharge");
    water.set_edge(DomainSide::East, EdgePart::All, outflow).expect("a sane level");
    water
}

fn bump_missed(water: &ShallowWater, flow: BumpFlow) -> Missed {
    let columns = water.size().x as usize;
    let x = |column: usize| (column as f64 + 0.5) * SIDE;
    let mut missed = Missed { discharge: 0.0, depth: 0.0, jump: 0.0 };
    for column in 0..columns {
        let (found, exact) = (f64::from(water.depths()[column]), flow.depth(x(column)));
        missed.depth += (found - exact).abs() / exact / columns as f64;
        if (x(column) - flow.jump()).abs() > 3.0 * SIDE {
            let discharge = found * f64::from(water.velocity(column).x);
            let d = (discharge / flow.discharge - 1.0).abs();
            if d > missed.discharge { eprint!("[{:.2} {:.2e}]", x(column), d);}
            missed.discharge = missed.discharge.max((discharge / flow.discharge - 1.0).abs());
        }
    }
    if flow.jump().is_finite() {
        let before = flow.depth(flow.jump() - 1e-9);
        let half = 0.5 * (before + flow.depth(flow.jump() + 1e-9));
        let first = (0..columns).find(|&column| x(column) > 11.0 && f64::from(water.depths()[column]) > half);
        missed.jump = first.map_or(f64::INFINITY, |column| (x(column) - 0.5 * SIDE - flow.jump()) / SIDE);
    }
    missed
}
