//! The scale of a view: its colours, and the values at their ends and in the middle.
use crate::surface::ViewScale;
use bevy::color::{ColorToPacked, Srgba};
use bevy_egui::egui::{Align2, Color32, FontId, Mesh, Sense, Ui, pos2, vec2};

/// Width and height of the colours, px.
const SIZE: [f32; 2] = [240.0, 10.0];
/// Strips between colours.
const STRIPS: u32 = 32;

/// Draws a bar of the colours with its numbers under it.
pub(super) fn draw(ui: &mut Ui, scale: ViewScale) {
    let font = FontId::proportional(11.0);
    let (place, _) = ui.allocate_exact_size(vec2(SIZE[0], SIZE[1] + font.size + 4.0), Sense::hover());
    let painter = ui.painter_at(place);
    let mut colors = Mesh::default();
    for k in 0..=STRIPS {
        let share = k as f32 / STRIPS as f32;
        let color = Srgba::from(ViewScale::color(share)).to_u8_array_no_alpha();
        let color = Color32::from_rgb(color[0], color[1], color[2]);
        let x = place.left() + share * place.width();
        colors.colored_vertex(pos2(x, place.top()), color);
        colors.colored_vertex(pos2(x, place.top() + SIZE[1]), color);
        if k > 0 {
            colors.add_triangle(2 * k - 2, 2 * k - 1, 2 * k);
            colors.add_triangle(2 * k - 1, 2 * k, 2 * k + 1);
        }
    }
    painter.add(colors);
    let below = place.top() + SIZE[1] + 2.0;
    let number = |x: f32, align: Align2, value: f32| {
        let text = format!("{} {}", shown(value), scale.unit);
        painter.text(pos2(x, below), align, text, font.clone(), ui.visuals().text_color());
    };
    number(place.left(), Align2::LEFT_TOP, scale.low);
    number(place.center().x, Align2::CENTER_TOP, 0.5 * (scale.low + scale.high));
    number(place.right(), Align2::RIGHT_TOP, scale.high);
}

/// A number with three digits that count.
pub(super) fn shown(value: f32) -> String {
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
