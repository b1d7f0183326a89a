//! A spray of willow twigs with their narrow leaves, to be cut out by alpha; about 0.8 m a side.

use std::f64::consts::TAU;

use fastrand::Rng;

use super::{
    colour::{Colour, mix, scaled},
    picture::Picture,
    ribbon::{Canvas, Curve, Point, Ribbon},
};

/// Mean albedo of the leaves and twigs.
const ALBEDO: [f64; 3] = [0.080, 0.115, 0.035];

const TWIGS: u32 = 26;
const TWIG: Colour = [0.10, 0.075, 0.04];

/// Paints the leaves; the branch enters at the middle of the bottom edge.
pub fn leaves() -> Picture {
    let mut rng = Rng::with_seed(53);
    let mut canvas = Canvas::clear(1024);
    let branch = Curve([[0.5, 1.01, 0.3], [0.53, 0.7, 0.3], [0.5, 0.5, 0.3]]);
    canvas.draw(&Ribbon { curve: branch, width: 0.018, outline: |along| 1.0 - 0.75 * along }, |_| scaled(TWIG, 0.8));
    for twig in 0..TWIGS {
        let start = 0.93 - 0.48 * f64::from(twig) / f64::from(TWIGS);
        let fan = (f64::from(twig) * 0.618).fract() - 0.5;
        let heading = TAU * (0.75 + 0.46 * fan * (1.35 - 0.55 * start));
        let depth = rng.f64();
        draw_twig(&mut canvas, &mut rng, [0.51, start, depth], heading);
    }
    canvas.finish().halved().halved().with_mean_albedo(ALBEDO).with_colour_spread()
}

fn draw_twig(canvas: &mut Canvas, rng: &mut Rng, root: Point, heading: f64) {
    let depth = root[2];
    let length = 0.27 + 0.10 * rng.f64();
    let droop = 0.10 * rng.f64();
    let control = ahead(root, heading + 0.25 * (rng.f64() - 0.5), 0.55 * length);
    let mut tip = ahead(root, heading + 0.5 * (rng.f64() - 0.5), length);
    tip[1] += droop;
    let curve = Curve([root, control, tip]);
    canvas
        .draw(&Ribbon { curve, width: 0.008, outline: |along| 1.0 - 0.7 * along }, |_| scaled(TWIG, 0.5 + 0.5 * depth));

    let leaves = 15;
    for leaf in 0..leaves {
        let along = 0.18 + 0.82 * f64::from(leaf) / f64::from(leaves - 1);
        let side = if leaf % 2 == 0 { 1.0 } else { -1.0 };
        let aside = if leaf == leaves - 1 { 0.0 } else { side * (0.55 + 0.35 * rng.f64()) };
        draw_leaf(canvas, rng, curve.at(along), heading + aside);
    }
}

fn draw_leaf(canvas: &mut Canvas, rng: &mut Rng, mut stem: Point, heading: f64) {
    let length = 0.085 + 0.045 * rng.f64();
    stem[2] += 0.15 * rng.f64();
    let curl = 0.5 * (rng.f64() - 0.5);
    let ribbon = Ribbon {
        curve: Curve([stem, ahead(stem, heading, 0.5 * length), ahead(stem, heading + curl, length)]),
        width: length * (0.19 + 0.07 * rng.f64()),
        // A lance: widest a third of the way up, drawn out to a point.
        outline: |along| libm::sin(TAU / 2.0 * libm::pow(along, 0.75)).max(0.0),
    };
    // Willow leaves are silvery underneath, and one in five shows that side.
    let underside = rng.f64() < 0.2;
    let living = mix([0.055, 0.105, 0.022], [0.125, 0.155, 0.040], rng.f64());
    let colour = scaled(if underside { [0.16, 0.19, 0.11] } else { living }, 0.45 + 0.65 * stem[2]);
    canvas.draw(&ribbon, |place| scaled(colour, place.folded(1.35, 0.13) * (0.85 + 0.3 * place.along)));
}

/// The point at a distance in a direction, at the same depth.
fn ahead([x, y, z]: Point, heading: f64, distance: f64) -> Point {
    [x + distance * libm::cos(heading), y + distance * libm::sin(heading), z]
}
