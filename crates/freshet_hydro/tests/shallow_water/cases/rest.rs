//! Still water stays still.
use super::{Run, fastest, land};

/// Over a bump under water and one that is an island, at depths up to 500 m.
pub fn over_bumps(run: Run) {
    println!("still level (m) | bed moved by (m) | max |u| (m/s) | in ε √(g d) | max |Δη| (m)");
    for (level, down) in [(0.5_f32, 0.0), (0.1, 0.0), (0.5, 4.5), (0.5, 49.5), (0.5, 499.5)] {
        let mut water = land(100, 20, 0.25, |x, _| (0.2 - 0.05 * x * x).max(0.0) - down);
        water.fill(level).expect("a sane level");
        let before: Vec<f32> = (0..water.depths().len()).map(|index| water.level(index)).collect();
        let duration = 10_000.0 * 0.45 * 0.25 / f64::from(water.fastest_signal());
        run(&mut water, duration);
        let speed = fastest(&water);
        let change = (0..before.len()).map(|index| (water.level(index) - before[index]).abs()).fold(0.0, f32::max);
        let depth = level + down as f32;
        let unit = f32::EPSILON * (9.81 * depth).sqrt();
        println!("{level} | {down} | {speed:.1e} | {:.1} | {change:.1e}", speed / unit);
        assert!(speed <= 10.0 * unit && change <= 4.0 * f32::EPSILON * depth);
    }
}
