//! Marsh grass from above: tussocks of overlapping blades, living and dead; 4 m a side.

use std::f64::consts::TAU;

use fastrand::Rng;

use super::{
    SUPERSAMPLED,
    colour::{Colour, mix, scaled, smoothstep},
    periodic::{Cells, Fractal},
    picture::{Picture, Texel},
    ribbon::{Canvas, Curve, Ribbon},
};

/// Mean albedo of marsh grass, with the soil that shows between the blades.
const ALBEDO: [f64; 3] = [0.105, 0.122, 0.042];

const BLADES: usize = 30_000;

/// Paints the grass.
pub fn grass() -> Picture {
    let mut rng = Rng::with_seed(37);
    let tussocks = Cells::new(&mut rng, [11; 2]);
    let lushness = Fractal::new(&mut rng, [4.0; 2], 3);
    let wind = Fractal::new(&mut rng, [3.0; 2], 2);
    let litter = Fractal::new(&mut rng, [30.0; 2], 4);

    let ground = Picture::from_fn(SUPERSAMPLED, |point| {
        let shade = 0.5 + 0.3 * litter.at(point) + 0.2 * rng.f64();
        Texel { albedo: scaled([0.050, 0.044, 0.024], shade), alpha: 0.0 }
    });
    let mut canvas = Canvas::over(ground);
    for _ in 0..BLADES {
        let root = [rng.f64(), rng.f64()];
        let tussock = tussocks.nearest(root);
        // Blades stand dense and tall in the middle of a tussock and lean out of it.
        let middle = smoothstep(0.9, 0.1, tussock.distance);
        let lush = 0.5 + 0.5 * lushness.at(root);
        let outward = libm::atan2(tussock.offset[1], tussock.offset[0]);
        let spread = 1.2 + 1.9 * middle;
        let lean = outward + 0.9 * wind.at(root) + spread * (rng.f64() + rng.f64() + rng.f64() - 1.5);
        let size = (0.45 + 0.55 * rng.f64()) * (0.6 + 0.4 * middle) * (0.85 + 0.3 * lush);
        // Some stand upright, and cover their own tussock.
        let reach = 0.085 * size * (0.15 + 0.85 * rng.f64());
        let drift = lean + 0.9 * (rng.f64() - 0.5);
        let crown = 0.75 * size + 0.25 * rng.f64();
        let ribbon = Ribbon {
            curve: Curve([
                [root[0], root[1], 0.0],
                [root[0] + 0.45 * reach * libm::cos(lean), root[1] + 0.45 * reach * libm::sin(lean), 1.5 * crown],
                [root[0] + reach * libm::cos(drift), root[1] + reach * libm::sin(drift), 0.65 * crown],
            ]),
            width: 0.0052 * (0.7 + 0.6 * rng.f64()),
            outline: |along| (1.0 - along * along) * (0.6 + 0.4 * along),
        };
        let colour = blade_colour(&mut rng, lush);
        // The sky lights the side of a folded blade that faces up more than the other.
        let fold = 0.22 * libm::cos(lean - TAU / 8.0);
        canvas.draw(&ribbon, |place| {
            let depth = 0.08 + 1.1 * place.z;
            let tip = mix(colour, [0.20, 0.17, 0.075], 0.45 * smoothstep(0.6, 1.0, place.along));
            scaled(tip, depth * place.folded(1.12, fold))
        });
    }
    canvas.finish().halved().with_mean_albedo(ALBEDO).with_full_height()
}

/// Green to olive, more yellow where less lush, and one in seven dead.
fn blade_colour(rng: &mut Rng, lush: f64) -> Colour {
    let tone = 0.8 + 0.45 * rng.f64();
    let living =
        mix([0.135, 0.135, 0.036], [0.070, 0.125, 0.030], (0.7 * lush + 0.6 * rng.f64() - 0.1).clamp(0.0, 1.0));
    let dead = mix([0.26, 0.205, 0.105], [0.15, 0.115, 0.06], rng.f64());
    scaled(if rng.f64() < 0.14 { dead } else { living }, tone)
}
