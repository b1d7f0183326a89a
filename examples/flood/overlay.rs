//! What is written over the picture: clock, legend, scale bar and north arrow. The same in a window and in pictures.
use crate::viewer::{Coloring, HAZARDS, Viewer, hazard_color, round};
use bevy::prelude::*;
use bevy_egui::{
    EguiContexts,
    egui::{Align2, Color32, FontId, LayerId, Mesh, Order, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2 as size},
};
use bevy_freshet::{flood::Flood, panel::OrbitCamera, surface::ViewScale};
use freshet_flood::duration::clock;

const INK: Color32 = Color32::WHITE;
const SHADE: Color32 = Color32::from_black_alpha(150);
/// Distance from the picture's rim, px.
const MARGIN: f32 = 14.0;
/// Width and height of the legend's colours, px.
const BAR: [f32; 2] = [220.0, 12.0];

/// Draws all of it.
pub fn draw(
    mut contexts: EguiContexts,
    viewer: Res<Viewer>,
    flood: Single<&Flood>,
    camera: Single<(&Camera, &GlobalTransform), With<OrbitCamera>>,
) -> Result {
    let context = contexts.ctx_mut()?;
    let painter = context.layer_painter(LayerId::new(Order::Background, "overlay".into()));
    let frame = context.viewport_rect().shrink(MARGIN);
    let time = format!("{} / {}", clock(flood.usable_time()), clock(flood.span().1));
    label(&painter, frame.left_top(), Align2::LEFT_TOP, &time, 20.0);
    // Under the north arrow, where no timeline is.
    legend(&painter, &viewer, frame.right_top() + size(0.0, 118.0));
    let (camera, pose) = *camera;
    north(&painter, pose, frame.right_top() + size(-22.0, 26.0));
    scale_bar(&painter, camera, pose, &viewer, frame.left_bottom());
    Ok(())
}

/// Text on a dark ground.
fn label(painter: &Painter, at: Pos2, align: Align2, text: &str, height: f32) {
    let galley = painter.layout_no_wrap(text.into(), FontId::proportional(height), INK);
    let place = align.anchor_size(at, galley.size() + size(12.0, 6.0));
    painter.rect_filled(place, 4.0, SHADE);
    painter.galley(place.min + size(6.0, 3.0), galley, INK);
}

fn color32(color: LinearRgba) -> Color32 {
    let [r, g, b, _] = Srgba::from(color).to_u8_array();
    Color32::from_rgb(r, g, b)
}

/// The colours and what they mean.
fn legend(painter: &Painter, viewer: &Viewer, corner: Pos2) {
    let Some(scale) = viewer.scale() else { return };
    let board = Rect::from_min_max(corner - size(BAR[0] + 24.0, 58.0), corner);
    painter.rect_filled(board, 4.0, SHADE);
    let title = match viewer.coloring {
        Coloring::Hazard => "danger to people".to_owned(),
        other => format!("{} ({})", other.name(), scale.unit),
    };
    let font = FontId::proportional(13.0);
    painter.text(board.left_top() + size(12.0, 4.0), Align2::LEFT_TOP, title, font, INK);
    let bar = Rect::from_min_size(board.left_top() + size(12.0, 23.0), size(BAR[0], BAR[1]));
    let font = FontId::proportional(11.0);
    if viewer.coloring == Coloring::Hazard {
        let width = bar.width() / HAZARDS.len() as f32;
        for (class, (_, name)) in HAZARDS.iter().enumerate() {
            let left = bar.left_top() + size(class as f32 * width, 0.0);
            painter.rect_filled(
                Rect::from_min_size(left, size(width, bar.height())),
                0.0,
                color32(hazard_color(class)),
            );
            let middle = left + size(0.5 * width, bar.height() + 2.0);
            painter.text(middle, Align2::CENTER_TOP, name, font.clone(), INK);
        }
        return;
    }
    ramp(painter, bar);
    for (share, align) in [(0.0, Align2::LEFT_TOP), (0.5, Align2::CENTER_TOP), (1.0, Align2::RIGHT_TOP)] {
        let value = scale.low + share * (scale.high - scale.low);
        let at = bar.left_bottom() + size(share * bar.width(), 2.0);
        painter.text(at, align, format!("{}", (value * 100.0).round() / 100.0), font.clone(), INK);
    }
}

fn ramp(painter: &Painter, bar: Rect) {
    const STRIPS: u32 = 64;
    let mut mesh = Mesh::default();
    for k in 0..=STRIPS {
        let share = k as f32 / STRIPS as f32;
        let (x, color) = (bar.left() + share * bar.width(), color32(ViewScale::color(share)));
        mesh.colored_vertex(pos2(x, bar.top()), color);
        mesh.colored_vertex(pos2(x, bar.bottom()), color);
        if k > 0 {
            mesh.add_triangle(2 * k - 2, 2 * k - 1, 2 * k);
            mesh.add_triangle(2 * k - 1, 2 * k, 2 * k + 1);
        }
    }
    painter.add(mesh);
}

/// An arrow to the north; up is where the camera looks.
fn north(painter: &Painter, pose: &GlobalTransform, middle: Pos2) {
    let right = pose.right().xz().normalize_or(Vec2::X);
    let along = vec2(-right.y, -right.x);
    let flat = size(along.x, along.y);
    let side = size(-flat.y, flat.x);
    let tip = middle + 9.0 * flat;
    let tail = middle - 18.0 * flat;
    painter.circle_filled(middle, 24.0, SHADE);
    let notch = tail + 4.0 * flat;
    for (wing, color) in [(tail + 8.0 * side, INK), (tail - 8.0 * side, Color32::GRAY)] {
        painter.add(Shape::convex_polygon(vec![tip, wing, notch], color, Stroke::NONE));
    }
    painter.text(middle + 16.0 * flat, Align2::CENTER_CENTER, "N", FontId::proportional(12.0), INK);
}

/// A bar of a round length, as it is in the middle of the picture.
fn scale_bar(painter: &Painter, camera: &Camera, pose: &GlobalTransform, viewer: &Viewer, corner: Pos2) {
    let Some(target) = camera.physical_viewport_size().map(|size| 0.5 * size.as_vec2()) else { return };
    let Some(middle) = crate::hover::ground(camera, pose, target, viewer) else { return };
    let right = pose.right().as_vec3();
    let ends = [-1.0, 1.0].map(|way| camera.world_to_viewport(pose, middle + way * right));
    let [Ok(a), Ok(b)] = ends else { return };
    let pixels_per_metre = 0.5 * a.distance(b);
    if !(pixels_per_metre.is_finite() && pixels_per_metre > 1e-6) {
        return;
    }
    let mut metres = round(100.0 / pixels_per_metre);
    if metres * pixels_per_metre > 200.0 {
        metres *= 0.5;
    }
    let length = metres * pixels_per_metre;
    let board = Rect::from_min_max(corner - size(0.0, 34.0), corner + size(length + 24.0, 0.0));
    painter.rect_filled(board, 4.0, SHADE);
    let (left, y) = (board.left() + 12.0, board.bottom() - 9.0);
    let stroke = Stroke::new(2.0, INK);
    painter.line_segment([pos2(left, y), pos2(left + length, y)], stroke);
    for x in [left, left + length] {
        painter.line_segment([pos2(x, y - 5.0), pos2(x, y + 1.0)], stroke);
    }
    let text = if metres >= 1000.0 { format!("{} km", metres / 1000.0) } else { format!("{metres} m") };
    painter.text(pos2(left + 0.5 * length, y - 5.0), Align2::CENTER_BOTTOM, text, FontId::proportional(13.0), INK);
}
