//! Flow that has become steady: over a bump without friction, and uniform down a slope with friction.
use super::super::analytic::{BumpFlow, Crossing, bump, normal_depth};
use super::{Run, ShallowWater, land, place, still};
use freshet_hydro::grid::Grid;
use freshet_hydro::shallow_water::{DomainSide, Edge, EdgePart};

/// Length of the channel with the bump, m, and its width in cells.
const LENGTH: f64 = 25.0;
const ROWS: u32 = 4;

/// What a steady flow over the bump missed.
#[derive(Clone, Copy, Debug, Default)]
struct Missed {
    /// Largest |h u / q − 1| more than three cells from the jump.
    discharge: f64,
    /// Mean and largest |Δh| / h, the largest more than three cells from the jump.
    depth: [f64; 2],
    /// Distance from the exact jump, in cells.
    jump: f64,
}

/// Three flows over a bump 0.2 m high (SWASHES 3.1.3 to 3.1.5): the discharge is the same everywhere, the depth is
/// Bernoulli's, and the jump stands where Bélanger has it.
pub fn over_a_bump(run: Run) {
    println!("flow over a bump | cells | max |h u / q − 1| (%) | mean |Δh| / h (%) | max | jump off by (cells)");
    let flows = [
        (BumpFlow { discharge: 4.42, crossing: Crossing::Slow(2.0) }, 250, 0.0015, 4e-5),
        (BumpFlow { discharge: 1.53, crossing: Crossing::Fast }, 250, 0.006, 0.001),
        (BumpFlow { discharge: 0.18, crossing: Crossing::Jump(0.33) }, 300, 0.01, 0.003),
    ];
    for (flow, columns, most_discharge, most_depth) in flows {
        let missed = steady_over_the_bump(run, flow, columns);
        assert!(missed.discharge <= most_discharge && missed.depth[0] <= most_depth, "{missed:?}");
        assert!(missed.jump.abs() <= 2.0, "{missed:?}");
    }
}

/// The flow behind a jump is steady on any grid, wherever the jump falls between its cells.
pub fn a_jump_stands_still_on_any_grid(run: Run) {
    let flow = BumpFlow { discharge: 0.18, crossing: Crossing::Jump(0.33) };
    let missed = [200, 240, 250, 260, 400].map(|columns| steady_over_the_bump(run, flow, columns));
    for missed in missed {
        assert!(missed.discharge <= 0.01 && missed.jump.abs() <= 2.0, "{missed:?}");
    }
}

/// A jump across a channel that is a little rough stays straight: no fingers grow from it along the rows (the carbuncle).
pub fn a_jump_stays_straight(run: Run) {
    let flow = BumpFlow { discharge: 0.18, crossing: Crossing::Jump(0.33) };
    let mut water = bump_channel(flow, 250);
    let mut random = 7_u32;
    let mut rough = |at: [f64; 2]| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        bump(at[0] + 0.5 * LENGTH) + 3e-5 * (f64::from(random >> 8) / 16_777_216.0 - 0.5)
    };
    let size = water.size();
    let bed: Vec<f32> = (0..water.bed().len()).map(|index| rough(place(&water, index)) as f32).collect();
    water.set_bed(&Grid::new(size, water.cell_size(), bed).expect("a valid shape")).expect("the same shape");
    run(&mut water, 300.0);
    let missed = bump_missed(&water, flow);
    println!("jump in a rough channel: discharge off by {:.3} %", 100.0 * missed.discharge);
    assert!(missed.discharge < 0.01, "{missed:?}");
}

/// What the flow misses after it had time to become steady, at the worst of some instants.
fn steady_over_the_bump(run: Run, flow: BumpFlow, columns: u32) -> Missed {
    let mut water = bump_channel(flow, columns);
    run(&mut water, 300.0);
    let mut worst = Missed::default();
    for _ in 0..20 {
        run(&mut water, 0.25);
        let missed = bump_missed(&water, flow);
        worst.discharge = worst.discharge.max(missed.discharge);
        worst.depth = [worst.depth[0].max(missed.depth[0]), worst.depth[1].max(missed.depth[1])];
        worst.jump = if missed.jump.abs() > worst.jump.abs() { missed.jump } else { worst.jump };
    }
    let [mean, most] = worst.depth.map(|depth| 100.0 * depth);
    let discharge = 100.0 * worst.discharge;
    println!("{:?} | {columns} | {discharge:.4} | {mean:.4} | {most:.4} | {:.2}", flow.crossing, worst.jump);
    worst
}

/// The channel with the bump, still water in it, and the edges that make `flow`.
fn bump_channel(flow: BumpFlow, columns: u32) -> ShallowWater {
    let side = LENGTH / f64::from(columns);
    let mut water = land(columns, ROWS, side as f32, |x, _| bump(x + 0.5 * LENGTH));
    let (level, outflow) = match flow.crossing {
        Crossing::Slow(level) | Crossing::Jump(level) => (level, Edge::Level((level as f32).into())),
        // An open edge keeps whatever slow flow there is behind the bump: only onto dry land the flow becomes fast.
        Crossing::Fast => (0.0, Edge::Open),
    };
    water.fill(level as f32).expect("a sane level");
    let inflow = Edge::Discharge(((flow.discharge * side * f64::from(ROWS)) as f32).into());
    water.set_edge(DomainSide::West, EdgePart::All, inflow).expect("a sane discharge");
    water.set_edge(DomainSide::East, EdgePart::All, outflow).expect("a sane level");
    water
}

fn bump_missed(water: &ShallowWater, flow: BumpFlow) -> Missed {
    let columns = water.size().x as usize;
    let side = LENGTH / columns as f64;
    let x = |column: usize| (column as f64 + 0.5) * side;
    let mut missed = Missed::default();
    for column in 0..columns {
        let (found, exact) = (f64::from(water.depths()[column]), flow.depth(x(column)));
        let error = (found - exact).abs() / exact;
        missed.depth[0] += error / columns as f64;
        if (x(column) - flow.jump()).abs() > 3.0 * side {
            let discharge = found * f64::from(water.velocity(column).x);
            missed.discharge = missed.discharge.max((discharge / flow.discharge - 1.0).abs());
            missed.depth[1] = missed.depth[1].max(error);
        }
    }
    if flow.jump().is_finite() {
        let half = 0.5 * (flow.depth(flow.jump() - 1e-9) + flow.depth(flow.jump() + 1e-9));
        let first = (0..columns).find(|&column| x(column) > 11.0 && f64::from(water.depths()[column]) > half);
        missed.jump = first.map_or(f64::INFINITY, |column| (x(column) - 0.5 * side - flow.jump()) / side);
    }
    missed
}

/// A channel of 200 cells with a slope, Manning's n, a discharge and a size of its cells.
#[derive(Clone, Copy, Debug)]
struct Channel {
    slope: f64,
    manning: f64,
    /// m²/s.
    discharge: f64,
    /// m.
    side: f64,
}

/// Uniform flow down a slope: half way down a long channel the depth is that of u = d^⅔ √S / n.
pub fn uniform(run: Run) {
    println!("uniform flow: slope | n | q (m²/s) | Δx (m) | depth (m) | Froude | depth off by (%)");
    for (slope, manning, discharge, side) in
        [(0.001, 0.03, 2.0, 10.0), (0.002, 0.025, 3.0, 2.0), (0.01, 0.03, 1.0, 2.0), (0.05, 0.03, 1.0, 1.0)]
    {
        let off = uniform_off(run, Channel { slope, manning, discharge, side });
        assert!(off.abs() <= 0.005, "{off}");
    }
}

/// The same for a sheet of rain water: the deeper the cells are below each other, compared with the depth, the more the
/// gravity of half a step counts.
pub fn a_sheet_on_a_slope(run: Run) {
    println!("sheet on a slope: slope | n | q (m²/s) | Δx (m) | depth (m) | Froude | depth off by (%)");
    let channels = [(0.01, 0.03, 1.0, 10.0), (0.05, 0.03, 0.01, 2.0), (0.2, 0.05, 0.001, 2.0)];
    let offs =
        channels.map(|(slope, manning, discharge, side)| uniform_off(run, Channel { slope, manning, discharge, side }));
    assert!(offs.iter().all(|off| off.abs() <= 0.005), "{offs:?}");
}

/// By which share the depth half way down differs from the normal depth.
fn uniform_off(run: Run, channel: Channel) -> f64 {
    let depth = normal_depth(channel.discharge, channel.slope, channel.manning);
    let (water, time) = uniform_flow(run, channel, false);
    let off = f64::from(water.depths()[100]) / depth - 1.0;
    let Channel { slope, manning, discharge, side } = channel;
    let froude = discharge / depth / (9.81 * depth).sqrt();
    println!(
        "{slope} | {manning} | {discharge} | {side} | {depth:.4} | {froude:.2} | {:.4} after {time:.0} s",
        100.0 * off
    );
    off
}

/// Water that runs out through an open edge does so without a backwater: the flow is uniform up to the edge.
pub fn uniform_to_an_open_edge(run: Run) {
    println!("uniform flow to an open edge: cell of 200 | depth off by (%)");
    let channel = Channel { slope: 0.001, manning: 0.03, discharge: 2.0, side: 10.0 };
    let depth = normal_depth(channel.discharge, channel.slope, channel.manning);
    let (water, _) = uniform_flow(run, channel, true);
    let offs = [20, 100, 180, 199].map(|column| {
        let off = f64::from(water.depths()[column]) / depth - 1.0;
        println!("{column} | {:.3}", 100.0 * off);
        off
    });
    assert!(offs.iter().all(|off| off.abs() <= 0.02), "{offs:?}");
}

/// The channel after the water has run through it five times, and the time that took, s. It starts at normal depth, and
/// ends at an open edge or at one that holds that depth.
fn uniform_flow(run: Run, channel: Channel, open: bool) -> (ShallowWater, f64) {
    let Channel { slope, manning, discharge, side } = channel;
    let depth = normal_depth(discharge, slope, manning);
    let mut water = land(200, 2, side as f32, |x, _| -slope * x);
    water.set_manning(manning as f32).expect("a sane roughness");
    water.set_water(|_, _| still(depth)).expect("a sane depth");
    let end = depth - slope * 100.0 * side;
    let outflow = if open { Edge::Open } else { Edge::Level((end as f32).into()) };
    let inflow = Edge::Discharge(((2.0 * discharge * side) as f32).into());
    water.set_edge(DomainSide::West, EdgePart::All, inflow).expect("a sane discharge");
    water.set_edge(DomainSide::East, EdgePart::All, outflow).expect("a sane level");
    let time = 5.0 * 200.0 * side * depth / discharge;
    run(&mut water, time);
    (water, time)
}
