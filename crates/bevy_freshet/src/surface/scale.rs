//! The colours of views that show a number, and what the number is at their ends.
use super::SurfaceView;
use bevy::{math::ops, prelude::*};

/// Values between which the colours of a view run, from dark violet to light yellow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewScale {
    /// Value of the first colour.
    pub low: f32,
    /// Value of the last colour.
    pub high: f32,
    /// Unit of both.
    pub unit: &'static str,
}

impl SurfaceView {
    /// The scale of a view that shows a number, with [`WaterSurface::view_scale`](super::WaterSurface::view_scale) at 1.
    pub const fn scale(self) -> Option<ViewScale> {
        let (low, high, unit) = match self {
            Self::Level => (-2.0, 2.0, "m"),
            Self::Speed => (0.0, 4.0, "m/s"),
            Self::Froude => (0.0, 2.0, ""),
            Self::Age => (0.0, 0.25, "s"),
            _ => return None,
        };
        Some(ViewScale { low, high, unit })
    }
}

impl ViewScale {
    /// The same with `factor` times the range.
    pub fn times(self, factor: f32) -> Self {
        Self { low: self.low * factor, high: self.high * factor, ..self }
    }

    /// The colour at `share` (0…1) of the way from low to high: equal ways look equally different, as lightness and hue of
    /// Oklab (Ottosson 2020) go evenly and its chroma stays. The twin is `even_color` in `views.wgsl`.
    pub fn color(share: f32) -> LinearRgba {
        let share = share.clamp(0.0, 1.0);
        let (lightness, hue) = (0.4 + 0.52 * share, (310.0 - 200.0 * share).to_radians());
        let (a, b) = (0.11 * ops::cos(hue), 0.11 * ops::sin(hue));
        let roots = vec3(
            lightness + 0.396_337_78 * a + 0.215_803_76 * b,
            lightness - 0.105_561_346 * a - 0.063_854_17 * b,
            lightness - 0.089_484_18 * a - 1.291_485_5 * b,
        );
        let cones = roots * roots * roots;
        LinearRgba::rgb(
            cones.dot(vec3(4.076_741_7, -3.307_711_6, 0.230_969_94)),
            cones.dot(vec3(-1.268_438, 2.609_757_4, -0.341_319_4)),
            cones.dot(vec3(-0.004_196_086_3, -0.703_418_6, 1.707_614_7)),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_can_be_shown_and_are_equally_far_apart() {
        let colors: Vec<LinearRgba> = (0..=32).map(|k| ViewScale::color(k as f32 / 32.0)).collect();
        for color in &colors {
            assert!(color.to_vec3().min_element() >= 0.0 && color.to_vec3().max_element() <= 1.0, "{color:?}");
        }
        let apart: Vec<f32> = colors
            .windows(2)
            .map(|pair| {
                let [a, b] = [pair[0], pair[1]].map(|color| Oklaba::from(color).to_vec3());
                a.distance(b)
            })
            .collect();
        let mean = apart.iter().sum::<f32>() / 32.0;
        assert!(apart.iter().all(|way| (way - mean).abs() < 0.01 * mean), "{apart:?}");
    }

    #[test]
    fn a_factor_widens_the_scale() {
        let scale = SurfaceView::Level.scale().map(|scale| scale.times(0.5));
        assert_eq!(scale, Some(ViewScale { low: -1.0, high: 1.0, unit: "m" }));
        assert_eq!(SurfaceView::Water.scale(), None);
    }
}
