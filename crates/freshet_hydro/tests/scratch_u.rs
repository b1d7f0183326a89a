#[path = "shallow_water/analytic.rs"]
mod analytic;
#[path = "shallow_water/cases/mod.rs"]
mod cases;
use analytic::*;
use freshet_hydro::shallow_water::*;
use cases::*;
#[test]
fn uniform() {
    for (slope, n, q, side) in [(0.001, 0.03, 2.0, 10.0), (0.01, 0.03, 1.0, 10.0), (0.01, 0.03, 1.0, 2.0), (0.05, 0.03, 1.0, 2.0), (0.05, 0.03, 0.01, 2.0), (0.05, 0.03, 0.001, 2.0), (0.002,0.025, 3.0, 2.0), (0.2, 0.05, 0.001, 2.0)] {
        for open in [true, false] { for courant in [0.45, 0.1] {
        let h = normal_depth(q, slope, n);
        let cols = 200u32;
        let mut w = land(cols, 2, side as f32, |x, _| -slope * x);
        w.set_manning(n as f32).unwrap();
        w.set_courant(courant).unwrap();
        w.set_water(|_, _| still(h)).unwrap();
        w.set_edge(DomainSide::West, EdgePart::All, Edge::Discharge(((q * side * 2.0) as f32).into())).unwrap();
        let level = -slope * (cols as f64 / 2.0) * side + h;
        w.set_edge(DomainSide::East, EdgePart::All, if open {Edge::Open} else {Edge::Level((level as f32).into())}).unwrap();
        let u = q / h;
        let mut steps = 0;
        for _ in 0..10 { steps += w.advance(cols as f64 * side / u * 0.5, u32::MAX).steps; }
        let t: Vec<String> = [20, 60, 100, 140, 180, 199].iter().map(|&c| format!("{:.3}%", 100.0 * (w.depths()[c] as f64 / h - 1.0))).collect();
        println!("S {slope} n {n} q {q} dx {side} open {open} C {courant} h {h:.4} Fr {:.2} steps {steps}: {t:?} q {:.4}", u / (9.81 * h).sqrt(), w.depths()[100] * w.velocity(100).x);
    }}}
}
