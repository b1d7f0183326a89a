#[path = "shallow_water/analytic.rs"]
mod analytic;
#[path = "shallow_water/cases/mod.rs"]
mod cases;
use analytic::*;
use freshet_hydro::shallow_water::*;
use cases::*;
fn chan(q: f64, level: f32, east: Edge, n: u32) -> ShallowWater {
    let side = 25.0 / n as f64;
    let mut w = land(n, 4, side as f32, |x, _| bump(x + 12.5));
    w.fill(level).unwrap();
    w.set_edge(DomainSide::West, EdgePart::All, Edge::Discharge(((q * side * 4.0) as f32).into())).unwrap();
    w.set_edge(DomainSide::East, EdgePart::All, east).unwrap();
    w
}

fn spread(w: &mut ShallowWater, from: usize, to: usize) -> (f32, f32, f32) {
    let mut m = (f32::INFINITY, 0.0f32, 0.0);
    for _ in 0..200 { w.advance(0.05, u32::MAX);
        for c in from..to { let q = w.depths()[c] * w.velocity(c).x; m.0 = m.0.min(q); m.1 = m.1.max(q);} }
    m.2 = w.depths()[to-1]; m
}
#[test]
fn fast() {
    for n in [125, 250, 500] { for courant in [0.9, 0.45, 0.2, 0.1] {
    let mut w = chan(1.53, 0.0, Edge::Open, n);
    w.set_courant(courant).unwrap();
    w.advance(150.0, u32::MAX);
    let n = n as usize;
    println!("fast {n} {courant} up {:?} down {:?}", spread(&mut w, 0, n*7/25), spread(&mut w, n*13/25, n));
    }}
}
#[test]
fn jump() {
    for n in [125, 200, 240, 250, 260, 300, 400, 500] { for courant in [0.9, 0.45, 0.2, 0.1] {
    let mut w = chan(0.18, 0.33, Edge::Level(0.33.into()), n);
    w.set_courant(courant).unwrap();
    w.advance(300.0, u32::MAX);
    let n = n as usize;
    println!("jump {n} {courant} up {:?} down {:?}", spread(&mut w, 0, n*7/25), spread(&mut w, n*25/50, n));
    }}
}
#[test]
fn whence() {
    for (q, level, east, n, courant) in [(1.53, 0.0, Edge::Open, 250u32, 0.2), (0.18, 0.33, Edge::Level(0.33.into()), 250, 0.2)] {
    let mut w = chan(q, level, east, n);
    w.set_courant(courant).unwrap();
    w.advance(200.0, u32::MAX);
    let n = n as usize;
    let mut m = vec![(f32::INFINITY, 0.0f32); n];
    let mut hm = vec![(f32::INFINITY, 0.0f32); n];
    for _ in 0..2000 { w.advance(0.01, u32::MAX);
        for c in 0..n { let q = w.depths()[c] * w.velocity(c).x; m[c].0 = m[c].0.min(q); m[c].1 = m[c].1.max(q);
           let h = w.depths()[c]; hm[c].0 = hm[c].0.min(h); hm[c].1 = hm[c].1.max(h);
        } }
    for c in 60..150 { println!("{c} x {:.2} q {:.5}..{:.5} d {:.1e} dh {:.1e} h {:.4}", (c as f32+0.5)*0.1, m[c].0, m[c].1, m[c].1-m[c].0, hm[c].1-hm[c].0, hm[c].0); }
    }
}
