//! The scale of a view: its colours, and the values at their ends and in the middle.
use crate::surface::ViewScale;
use bevy::prelude::*;
use bevy_egui::egui::{Align2, Color32, FontId, Rect, Sense, TextStyle, Ui, pos2, vec2};

/// Width and height of the colours, px.
const SIZE: [f32; 2] = [240.0, 10.0];
/// Strips of one colour.
const STRIPS: u32 = 60;

/// Draws a bar of the colours with its numbers under it.
pub(super) fn draw(ui: &mut Ui, scale: ViewScale) {
    let font = TextStyle::Small.resolve(ui.style());
    let (place, _) = ui.allocate_exact_size(vec2(SIZE[0], SIZE[1] + font.size + 4.0), Sense::hover());
    let painter = ui.painter_at(place);
    let width = place.width() / STRIPS as f32;
    for k in 0..STRIPS {
        let color = Srgba::from(ViewScale::color((k as f32 + 0.5) / STRIPS as f32)).to_u8_array_no_alpha();
        let left = place.left() + k as f32 * width;
        let strip = Rect::from_min_size(pos2(left, place.top()), vec2(width + 0.5, SIZE[1]));
        painter.rect_filled(strip, 0.0, Color32::from_rgb(color[0], color[1], color[2]));
    }
    let below = place.top() + SIZE[1] + 2.0;
    let number = |x: f32, align: Align2, value: f32| {
        let text = format!("{} {}", shown(value), scale.unit);
        painter.text(pos2(x, below), align, text, FontId::clone(&font), ui.visuals().weak_text_color());
    };
    number(place.left(), Align2::LEFT_TOP, scale.low);
    number(place.center().x, Align2::CENTER_TOP, 0.5 * (scale.low + scale.high));
    number(place.right(), Align2::RIGHT_TOP, scale.high);
}

/// A number with three digits that count.
fn shown(value: f32) -> String {
    let digits = if value == 0.0 { 0.0 } else { (2.0 - value.abs().log10().floor()).clamp(0.0, 6.0) };
    let text = format!("{value:.*}", digits as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        assert_eq!([0.0, 2.0, -0.125, 0.25, 1234.0, 1e-3].map(shown), ["0", "2", "-0.125", "0.25", "1234", "0.001"]);
    }
}
