//! Dry river sand: ripples a hand wide, grains, dark minerals and bits of shell; 3 m a side.

use fastrand::Rng;

use super::{
    SUPERSAMPLED,
    colour::{mix, scaled, smoothstep},
    periodic::{Fractal, Ripples},
    picture::{Picture, Texel},
};

/// Mean albedo of dry quartz sand.
const ALBEDO: [f64; 3] = [0.44, 0.38, 0.29];

/// Paints the sand.
pub fn sand() -> Picture {
    let mut rng = Rng::with_seed(11);
    let ripples = Ripples::new(&mut rng, [7.0, 23.0], 5.0, 48);
    let bend = [Fractal::new(&mut rng, [3.0; 2], 3), Fractal::new(&mut rng, [3.0; 2], 3)];
    let swells = Fractal::new(&mut rng, [7.0; 2], 4);
    let sorting = Fractal::new(&mut rng, [14.0; 2], 5);
    let lumps = Fractal::new(&mut rng, [70.0; 2], 3);

    Picture::from_fn(SUPERSAMPLED, |point| {
        let bent = std::array::from_fn(|axis| point[axis] + 0.012 * bend[axis].at(point));
        let (phase, amplitude) = ripples.at(bent);
        // A gentle side towards the current, a steep one away from it.
        let ripple = amplitude.min(1.6) * libm::cos(phase + 0.5 * libm::sin(phase));
        let swell = swells.at(point);
        let lump = lumps.at(point);
        let grain = rng.f64() + rng.f64() - 1.0;
        let height = 0.26 * ripple + 0.28 * swell + 0.16 * lump + 0.10 * grain;

        // Wind sorts pale quartz onto the crests and heavy dark minerals into the troughs.
        let sorted = 0.55 * ripple + 0.8 * sorting.at(bent) + 0.9 * lump;
        let albedo = mix([0.31, 0.25, 0.175], [0.54, 0.48, 0.38], smoothstep(-1.7, 1.7, sorted));
        let albedo = scaled(albedo, 1.0 + 0.50 * grain + 0.06 * swell);
        let albedo = match rng.f64() {
            rare if rare < 0.014 => scaled(albedo, 0.2),
            rare if rare < 0.022 => mix(albedo, [0.9, 0.86, 0.78], 0.7),
            rare if rare < 0.030 => mix(albedo, [0.42, 0.22, 0.12], 0.7),
            _ => albedo,
        };
        Texel { albedo, alpha: height }
    })
    .halved()
    .with_mean_albedo(ALBEDO)
    .with_full_height()
}
