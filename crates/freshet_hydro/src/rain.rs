//! What rain does to a water surface: how many drops fall, how large they are, and the craters that they make.
use crate::waves::{GRAVITY, WATER_DENSITY};
use core::f64::consts::PI;

/// Rain in which all drops have the median size of its rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rain {
    /// Volume of a drop, m³.
    pub drop_volume: f32,
    /// Drops per square metre and second.
    pub drops: f32,
    /// Volume of the crater that a drop opens in the surface, m³.
    pub crater_volume: f32,
}

impl Rain {
    /// Rain of `rate` (mm/h, ≥ 0); `None` if it does not rain, or the rate is not a number.
    ///
    /// * Size by Marshall and Palmer (1948): `D₀ = 3.67 / Λ` with `Λ = 4.1 R^(−0.21)` per mm.
    /// * Speed by Atlas and Ulbrich (1977): `v = 3.78 D^0.67` m/s with D in mm.
    /// * Crater: a half sphere of radius r whose potential energy `π ρ g r⁴ / 4` is the drop's kinetic energy (Pumphrey and
    ///   Elmore 1990). Losses and surface tension are left out, so it is the largest crater possible.
    pub fn of_rate(rate: f32) -> Option<Self> {
        if !(rate.is_finite() && rate > 0.0) {
            return None;
        }
        let rate = f64::from(rate);
        let millimetres = 3.67 / 4.1 * libm::pow(rate, 0.21);
        let speed = 3.78 * libm::pow(millimetres, 0.67);
        let diameter = millimetres * 1e-3;
        let drop_volume = PI / 6.0 * diameter * diameter * diameter;
        // Both energies are divided by ρ.
        let energy = 0.5 * drop_volume * speed * speed;
        let radius = libm::pow(4.0 * energy / (PI * f64::from(GRAVITY)), 0.25);
        Some(Self {
            drop_volume: drop_volume as f32,
            drops: (rate / 3.6e6 / drop_volume) as f32,
            crater_volume: (2.0 / 3.0 * PI * radius * radius * radius) as f32,
        })
    }

    /// Mass of water per square metre and second, kg/(m²·s): 1 mm/h is one 3600th.
    pub fn mass_flux(&self) -> f32 {
        self.drop_volume * self.drops * WATER_DENSITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_drops_carry_the_rain() {
        for rate in [0.1, 1.0, 10.0, 100.0] {
            let rain = Rain::of_rate(rate).unwrap();
            assert_relative_eq!(rain.mass_flux(), rate * 1e-3 * WATER_DENSITY / 3600.0, max_relative = 1e-5);
        }
    }

    #[test]
    fn sizes_and_craters_are_those_of_nature() {
        // 10 mm/h: drops of 1.45 mm fall at 4.9 m/s and make craters some 8 mm deep.
        let rain = Rain::of_rate(10.0).unwrap();
        let diameter = (f64::from(rain.drop_volume) * 6.0 / PI).cbrt();
        assert_relative_eq!(diameter, 1.452e-3, max_relative = 1e-3);
        let crater = (f64::from(rain.crater_volume) * 1.5 / PI).cbrt();
        assert!((6e-3..1e-2).contains(&crater), "{crater}");
        // Heavier rain has larger drops.
        assert!(Rain::of_rate(50.0).unwrap().crater_volume > rain.crater_volume);
    }

    #[test]
    fn no_rain_has_no_drops() {
        for rate in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert_eq!(Rain::of_rate(rate), None);
        }
    }
}
