//! Wet river mud: smooth sheets with a film of water, lumps, fine shrinkage cracks, worm holes, a few pebbles;
//! 3 m a side.

use fastrand::Rng;

use super::{
    SUPERSAMPLED,
    colour::{mix, scaled, smoothstep},
    periodic::{Cells, Fractal, Ripples},
    picture::{Picture, Texel},
};

/// Mean albedo of wet estuarine mud.
const ALBEDO: [f64; 3] = [0.115, 0.095, 0.070];

/// Paints the mud.
pub fn mud() -> Picture {
    let mut rng = Rng::with_seed(23);
    let bend = [Fractal::new(&mut rng, [7.0; 2], 3), Fractal::new(&mut rng, [7.0; 2], 3)];
    let relief = Fractal::new(&mut rng, [11.0; 2], 6);
    let swash = Ripples::new(&mut rng, [13.0, 6.0], 9.0, 60);
    let rills = Fractal::new(&mut rng, [8.0, 5.0], 3);
    let lumps = Fractal::new(&mut rng, [44.0; 2], 4);
    let algae = Fractal::new(&mut rng, [10.0; 2], 5);
    let plates = Cells::new(&mut rng, [30; 2]);
    let pebbles = Cells::new(&mut rng, [48; 2]);
    let holes = Cells::new(&mut rng, [34; 2]);
    let pebble_sizes = sizes(&mut rng, pebbles.count(), 0.14, 0.34);
    let pebble_tones: Vec<f64> = (0..pebbles.count()).map(|_| rng.f64()).collect();
    let hole_sizes = sizes(&mut rng, holes.count(), 0.20, 0.13);

    Picture::from_fn(SUPERSAMPLED, |point| {
        let bent = std::array::from_fn(|axis| point[axis] + 0.014 * bend[axis].at(point));
        // Water drains off along winding rills, where the noise changes sign.
        let rill = smoothstep(0.09, 0.0, rills.at(bent).abs());
        let (phase, amplitude) = swash.at(bent);
        let high = 0.7 * relief.at(bent) + 0.22 * amplitude * libm::cos(phase) - 0.3 * rill;
        let dry = smoothstep(-0.35, 0.55, high);
        let grain = rng.f64() - 0.5;
        let lump = lumps.at(bent);
        let crack = smoothstep(0.09, 0.01, plates.nearest(bent).border) * smoothstep(0.45, 0.9, dry + 0.3 * lump);
        let hole = holes.nearest(point);
        let hole = smoothstep(1.0, 0.5, hole.distance / hole_sizes[hole.index].max(1e-3));

        // The film of water fills the hollows level and hides the fine relief.
        let mut height =
            0.45 * high.max(-0.25) + (0.10 + 0.20 * dry) * lump + 0.02 * grain - 0.16 * crack - 0.12 * hole;
        let albedo = mix([0.088, 0.070, 0.052], [0.136, 0.115, 0.087], dry);
        let albedo = scaled(albedo, 1.0 + 0.75 * lump * (0.3 + 0.7 * dry) + 0.25 * grain);
        let albedo = mix(albedo, [0.085, 0.090, 0.040], 0.28 * smoothstep(0.0, 0.9, algae.at(bent)));
        let mut albedo = scaled(albedo, 1.0 - 0.45 * crack - 0.65 * hole);

        let pebble = pebbles.nearest(bent);
        let size = pebble_sizes[pebble.index];
        if pebble.distance < size {
            let share = pebble.distance / size;
            let round = 1.0 - share * share;
            let tone = pebble_tones[pebble.index];
            let stone = mix([0.10, 0.095, 0.09], [0.27, 0.24, 0.20], tone * tone);
            albedo = mix(albedo, scaled(stone, 0.6 + 0.5 * round + 0.3 * grain), smoothstep(0.0, 0.25, round));
            height += 0.16 * round.sqrt();
        } else {
            // A shadow of wet mud where a pebble sits in it.
            albedo =
                scaled(albedo, 1.0 - 0.35 * smoothstep(size + 0.10, size, pebble.distance) * (size / 0.2).min(1.0));
        }
        Texel { albedo, alpha: height }
    })
    .halved()
    .with_mean_albedo(ALBEDO)
    .with_full_height()
}

/// Radii up to `largest`, mostly small, for a `share` of the cells, and 0 for the others.
fn sizes(rng: &mut Rng, count: usize, share: f64, largest: f64) -> Vec<f64> {
    (0..count)
        .map(|_| {
            let size = rng.f64();
            if rng.f64() < share { largest * (0.3 + 0.7 * size * size) } else { 0.0 }
        })
        .collect()
}
