//! Linear colours and the few curves that shade them.

/// Red, green and blue in linear light.
pub type Colour = [f64; 3];

/// `from` at 0, `to` at 1, straight between and beyond.
pub fn mix(from: Colour, to: Colour, share: f64) -> Colour {
    std::array::from_fn(|channel| from[channel] + (to[channel] - from[channel]) * share)
}

/// A colour made brighter or darker.
pub fn scaled(colour: Colour, factor: f64) -> Colour {
    colour.map(|channel| channel * factor)
}

/// 0 below `from`, 1 above `to`, smooth between; `from` may be the greater one.
pub fn smoothstep(from: f64, to: f64, value: f64) -> f64 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// The sRGB transfer function (IEC 61966-2-1), 0 to 1.
pub fn to_srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
}
