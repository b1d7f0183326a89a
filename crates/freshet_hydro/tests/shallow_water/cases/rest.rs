//! Still water stays still.
use super::{Run, fastest, land, terrain};

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

/// Over the real terrain, with pools and dry land, for 10 000 steps: to the last bit, as sums of beds and depths are exact.
pub fn over_terrain(run: Run) {
    println!("terrain, still level (m) | wet cells | max |u| (m/s) | max |Δη| (m)");
    for level in [0.0_f32, 1.0, 1.4, 2.71] {
        let mut water = terrain::land();
        water.fill(level).expect("a sane level");
        let before: Vec<f32> = (0..water.depths().len()).map(|index| water.level(index)).collect();
        let wet = water.depths().iter().filter(|depth| **depth > 0.0).count();
        let duration = 10_000.0 * 0.45 * 2.0 / f64::from(water.fastest_signal());
        run(&mut water, duration);
        let speed = fastest(&water);
        let change = (0..before.len()).map(|index| (water.level(index) - before[index]).abs()).fold(0.0, f32::max);
        println!("{level} | {wet} | {speed:.1e} | {change:.1e}");
        assert!(speed <= 1e-6 && change <= 1e-6, "{speed} {change}");
    }
}
