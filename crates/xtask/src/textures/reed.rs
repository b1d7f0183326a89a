//! A bundle of common reed, *Phragmites australis*, to be cut out by alpha: stems, blades and plumes; about 2 m a side.

use fastrand::Rng;

use super::{
    colour::{Colour, mix, scaled, smoothstep},
    picture::Picture,
    ribbon::{Canvas, Curve, Point, Ribbon},
};

/// Mean albedo of reed in late summer.
const ALBEDO: [f64; 3] = [0.135, 0.135, 0.055];

const STEMS: u32 = 34;
const PLUME: Colour = [0.20, 0.145, 0.095];

/// Paints the reed; it stands on the bottom edge.
pub fn reed() -> Picture {
    let mut rng = Rng::with_seed(61);
    let mut canvas = Canvas::clear(1024);
    for stem in 0..STEMS {
        let depth = f64::from(stem) / f64::from(STEMS);
        draw_stem(&mut canvas, &mut rng, depth);
    }
    canvas.finish().halved().halved().with_mean_albedo(ALBEDO).with_colour_spread()
}

fn draw_stem(canvas: &mut Canvas, rng: &mut Rng, depth: f64) {
    let root = 0.5 + 0.32 * (rng.f64() + rng.f64() - 1.0);
    let lean = 0.35 * (root - 0.5) + 0.10 * (rng.f64() - 0.5);
    let height = 0.62 + 0.30 * rng.f64();
    let tip = [(root + lean).clamp(0.17, 0.83), 1.0 - height, depth];
    let bow = root + 0.35 * lean;
    let light = 0.5 + 0.55 * depth;
    let dry = rng.f64() < 0.25;
    let colour = if dry { [0.30, 0.245, 0.13] } else { mix([0.10, 0.125, 0.035], [0.16, 0.165, 0.06], rng.f64()) };
    let curve = Curve([[root, 1.01, depth], [bow, 1.0 - 0.5 * height, depth], tip]);
    // Paler and drier towards the foot, where the old sheaths are.
    let shade = |foot: f64, across: f64| {
        scaled(mix([0.27, 0.22, 0.12], colour, smoothstep(0.0, 0.4, foot)), light * (1.0 - 0.25 * across))
    };
    canvas.draw(&Ribbon { curve, width: 0.0090, outline: |along| 1.0 - 0.65 * along }, |place| {
        shade(place.along, place.across)
    });

    let blades = 6 + rng.u32(..3);
    let mut side = if rng.bool() { 1.0 } else { -1.0 };
    for blade in 0..blades {
        let along = 0.06 + 0.84 * (f64::from(blade) + 0.5 * rng.f64()) / f64::from(blades);
        side = -side;
        let length = (0.17 + 0.13 * rng.f64()) * (1.1 - 0.5 * along);
        draw_blade(canvas, rng, curve.at(along), side * length, scaled(colour, light));
    }
    if rng.f64() < 0.55 {
        draw_plume(canvas, rng, tip, lean);
    }
}

/// A blade leaves the stem steeply, bends over and hangs.
fn draw_blade(canvas: &mut Canvas, rng: &mut Rng, [x, y, depth]: Point, reach: f64, colour: Colour) {
    let length = reach.abs();
    let spread = reach * (0.30 + 0.40 * rng.f64());
    let near = depth + 0.1 * (rng.f64() - 0.4);
    let ribbon = Ribbon {
        curve: Curve([
            [x, y, near],
            [x + 0.35 * spread, y - 0.75 * length, near],
            [x + spread, y - length * (1.0 - 0.65 * rng.f64()), near],
        ]),
        width: 0.012 + 0.007 * rng.f64(),
        outline: |along| libm::pow(1.0 - along, 0.7) * smoothstep(-0.25, 0.2, along),
    };
    let tone = 0.8 + 0.4 * rng.f64();
    canvas.draw(&ribbon, |place| {
        let dried = mix(colour, [0.26, 0.20, 0.10], 0.5 * smoothstep(0.6, 1.0, place.along));
        scaled(dried, tone * place.folded(1.2, 0.16 * reach.signum()) * (0.85 + 0.3 * place.along))
    });
}

/// A drooping plume of fine branches.
fn draw_plume(canvas: &mut Canvas, rng: &mut Rng, [tip_x, tip_y, depth]: Point, lean: f64) {
    let droop = if lean < 0.0 { -1.0 } else { 1.0 };
    for branch in 0..90 {
        let along = f64::from(branch) / 90.0;
        let (x, y) = (tip_x + 0.025 * droop * along * along, tip_y + 0.05 - 0.09 * along);
        let reach = (0.035 + 0.02 * rng.f64()) * (1.15 - along);
        let aside = (rng.f64() - 0.5) * 1.2 + 0.5 * droop;
        let near = depth + 0.05 * rng.f64();
        let curve = Curve([
            [x, y, near],
            [x + 0.4 * aside * reach, y - 0.7 * reach, near],
            [x + aside * reach, y - 0.5 * reach + 0.3 * reach * rng.f64(), near],
        ]);
        let colour = scaled(PLUME, (0.5 + 0.55 * depth) * (0.7 + 0.6 * rng.f64()));
        canvas.draw(&Ribbon { curve, width: 0.006, outline: |along| 0.5 + 0.5 * along }, |_| colour);
    }
}
