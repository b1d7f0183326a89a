//! Water that swings in a bowl.
use super::super::analytic::Bowl;
use super::{Run, land, place};
use glam::Vec2;

/// Thacker's planar solution on 200² cells for three periods.
pub fn planar(run: Run) {
    let bowl = Bowl { depth: 0.1, radius: 1.0, swing: 0.5 };
    let mut water = land(200, 200, 0.02, |x, z| bowl.bed(x, z));
    let initial = |at: Vec2, bed: f32| {
        let (level, [u, v]) = bowl.water(f64::from(at.x), f64::from(at.y), 0.0);
        let depth = (level as f32 - bed).max(0.0);
        (depth, if depth > 0.0 { Vec2::new(u as f32, v as f32) } else { Vec2::ZERO })
    };
    water.set_water(initial).expect("a sane state");
    let before = water.volume();
    let period = core::f64::consts::TAU / bowl.frequency();
    println!("period | centroid (m) | relative L1 of depth | shore off by (cells) | volume drift");
    for turn in 1..=3 {
        run(&mut water, period);
        let (mut volume, mut moment, mut error) = (0.0, [0.0; 2], 0.0);
        let mut shore = 0.0_f64;
        for (index, &depth) in water.depths().iter().enumerate() {
            let at = place(&water, index);
            let depth = f64::from(depth);
            let exact = (bowl.water(at[0], at[1], 0.0).0 - bowl.bed(at[0], at[1])).max(0.0);
            volume += depth;
            moment = [moment[0] + at[0] * depth, moment[1] + at[1] * depth];
            error += (depth - exact).abs();
            let outside = (at[0] - bowl.swing).hypot(at[1]) - bowl.radius;
            if (depth > 1e-3) != (exact > 1e-3) {
                shore = shore.max(outside.abs() / 0.02);
            }
        }
        let centroid = moment.map(|moment| moment / volume);
        let drift = water.volume() / before - 1.0;
        println!(
            "{turn} | ({:.4}, {:.4}) | {:.4} | {shore:.2} | {drift:.1e}",
            centroid[0],
            centroid[1],
            error / volume
        );
        let amplitude = centroid[0].hypot(centroid[1]) / bowl.swing;
        assert!((amplitude - 1.0).abs() < 0.03, "{amplitude}");
        assert!(shore < 2.0, "{shore}");
        assert!(drift.abs() < 1e-6, "{drift}");
    }
}
