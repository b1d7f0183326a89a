//! How thick the ice is.

/// Part of the winter after which the last place begins to freeze: the rest of it makes the cover solid.
pub const LAST: f32 = 0.8;

/// Thickness, m, at which the skim of crystals has closed and hides the water's own surface.
pub const CLOSED: f32 = 0.02;

/// Thickness, m, from which on all the snow that falls on the ice stays dry on it. Thinner ice is flooded by the weight
/// of the snow, which turns to slush.
pub const SETTLED: f32 = 0.12;

/// Smallest thickness, m, at the end of a winter: with it the last place is closed as well.
pub const THINNEST_WINTER: f32 = 0.1;

/// k/H, m: the thickness of ice that holds the heat back as much as the air above it. See the table of the module.
const AIR_FILM: f32 = 0.1;

/// A winter, at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Winter {
    /// Part of its frost that has passed, 0…1.
    pub freezing: f32,
    /// Thickness of the oldest ice at its end, m, at least [`THINNEST_WINTER`].
    pub thickest: f32,
}

impl Winter {
    /// Thickness, m, of the ice where the `order` (0…1) of [`order_map`](super::order_map) is given; 0 is open water.
    ///
    /// Stefan's law with the resistance of the air (Ashton 1989, "Thin ice growth", *Water Resources Research* 25):
    /// `h = √(b² + 2 k S/(ρ L)) − b` with b = k/H and S the frost since the place froze, in K s. The frost of the whole
    /// winter follows from `thickest`, so the constants cancel:
    /// ```text
    /// h = √(b² + s ((h_max + b)² − b²)) − b,    s = max(freezing − LAST · order, 0)
    /// ```
    /// Thick ice grows like Stefan's √s, thin ice linearly: a place does not freeze at a blow.
    pub fn thickness(&self, order: f32) -> f32 {
        let spent = (self.freezing - LAST * order).max(0.0);
        let end = self.thickest + AIR_FILM;
        (AIR_FILM * AIR_FILM + spent * (end * end - AIR_FILM * AIR_FILM)).sqrt() - AIR_FILM
    }
}

/// Share of the water's surface that ice of `thickness` (m) has taken: waves, current and foam keep the rest.
pub fn cover(thickness: f32) -> f32 {
    smoothstep(thickness / CLOSED)
}

/// Share of the fallen snow that lies on ice of `thickness` (m).
pub fn settled(thickness: f32) -> f32 {
    smoothstep((thickness - CLOSED) / (SETTLED - CLOSED))
}

fn smoothstep(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    #[test]
    fn the_ends_of_winter_are_open_water_and_solid_ice() {
        for order in [0.0, 0.3, 1.0] {
            for thickest in [THINNEST_WINTER, 0.3, 2.0] {
                assert_eq!(Winter { freezing: 0.0, thickest }.thickness(order), 0.0);
                assert_eq!(cover(Winter { freezing: 1.0, thickest }.thickness(order)), 1.0);
            }
        }
        assert_relative_eq!(Winter { freezing: 1.0, thickest: 0.3 }.thickness(0.0), 0.3, epsilon = 1e-6);
    }

    /// b dh/dt + h dh/dt = const: conduction through the ice and the air in series.
    #[test]
    fn growth_balances_the_heat_through_ice_and_air() {
        let at = |freezing: f32| f64::from(Winter { freezing, thickest: 0.6 }.thickness(0.0));
        let film = f64::from(AIR_FILM);
        let heat = |s: f32| (at(s + 0.02) - at(s - 0.02)) / 0.04 * (film + at(s));
        for s in [0.1, 0.4, 0.9] {
            assert_relative_eq!(heat(s), heat(0.5), max_relative = 0.01);
        }
        // The table of the module: b = k/H.
        assert_relative_eq!(AIR_FILM, 2.24 / 22.0, max_relative = 0.02);
    }

    proptest! {
        #[test]
        fn ice_grows_through_the_winter_and_is_thickest_where_it_came_first(
            order in 0.0_f32..1.0, later in 0.0_f32..0.5, freezing in 0.0_f32..1.0, thickest in 0.1_f32..2.0,
        ) {
            let winter = Winter { freezing, thickest };
            let here = winter.thickness(order);
            prop_assert!((0.0..=thickest + 1e-5).contains(&here));
            prop_assert!(winter.thickness(order + later) <= here);
            let then = Winter { freezing: freezing + later, ..winter };
            prop_assert!(then.thickness(order) >= here);
            prop_assert!(settled(here) <= cover(here), "snow needs ice under it");
        }
    }
}
