//! The bark of an old willow: ridges that run up the trunk, split and join; about 1 m a side.

use fastrand::Rng;

use super::{
    colour::{mix, scaled, smoothstep},
    periodic::{Cells, Fractal},
    picture::{Picture, Texel},
};

/// Mean albedo of dry grey-brown bark.
const ALBEDO: [f64; 3] = [0.155, 0.125, 0.095];

/// Paints the bark; the trunk stands along y.
pub fn bark() -> Picture {
    let mut rng = Rng::with_seed(41);
    let bend = [Fractal::new(&mut rng, [4.0, 7.0], 4), Fractal::new(&mut rng, [10.0, 3.0], 3)];
    let plates = Cells::new(&mut rng, [11, 3]);
    let fibre = Fractal::new(&mut rng, [44.0, 7.0], 4);
    let rough = Fractal::new(&mut rng, [20.0, 14.0], 4);
    let lichen = Fractal::new(&mut rng, [6.0; 2], 5);
    let tones: Vec<f64> = (0..plates.count()).map(|_| rng.f64()).collect();

    Picture::from_fn(512, |point| {
        let bent: [f64; 2] = std::array::from_fn(|axis| point[axis] + [0.055, 0.10][axis] * bend[axis].at(point));
        let plate = plates.nearest(bent);
        let ridge = smoothstep(0.0, 0.5, plate.border);
        let (fibre, rough) = (fibre.at(bent), rough.at(point));
        let grain = rng.f64() - 0.5;
        let height = ridge + 0.45 * fibre + 0.25 * rough + 0.06 * grain;
        let albedo = mix([0.035, 0.026, 0.018], [0.19, 0.155, 0.12], smoothstep(-0.1, 1.15, height));
        let albedo = scaled(albedo, 0.85 + 0.3 * tones[plate.index] + 0.4 * fibre + 0.3 * rough + 0.15 * grain);
        let grown = ridge * smoothstep(0.25, 0.75, lichen.at(point) + 0.3 * rough);
        Texel { albedo: mix(albedo, [0.20, 0.21, 0.15], 0.5 * grown), alpha: height }
    })
    .halved()
    .with_mean_albedo(ALBEDO)
    .with_full_height()
}
