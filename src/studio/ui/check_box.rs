//! Check boxes with square corners and a clear edge. egui's default has the round corners and the pale edge of its
//! buttons, which looks like a radio button.

use bevy_egui::egui;

use super::theme;

/// Side length of the box, in points.
pub(crate) const CHECK_BOX_SIDE: f32 = 16.0;
/// Width of the tick, in points.
const TICK: f32 = 10.0;
/// Corner radius of the box, in points: small, so that the box looks square.
const CORNER: egui::CornerRadius = egui::CornerRadius::same(2);

/// Draws a check box with its label. The label may be empty if another widget names the box.
pub(crate) fn check_box(
    ui: &mut egui::Ui,
    is_on: &mut bool,
    label: impl Into<egui::WidgetText>,
) -> egui::Response {
    let palette = theme::of(ui);
    let fill = if *is_on { palette.accent } else { palette.panel };
    let mark = if *is_on { palette.on_accent } else { palette.text };
    let label = label.into();
    ui.scope(|ui| {
        ui.spacing_mut().icon_width = CHECK_BOX_SIDE;
        ui.spacing_mut().icon_width_inner = TICK;
        let widgets = &mut ui.visuals_mut().widgets;
        for (widget, edge) in [
            (&mut widgets.inactive, palette.text_weak),
            (&mut widgets.hovered, palette.accent),
            (&mut widgets.active, palette.accent),
        ] {
            widget.corner_radius = CORNER;
            widget.bg_fill = fill;
            widget.bg_stroke = egui::Stroke::new(1.5, edge);
            widget.fg_stroke = egui::Stroke::new(2.0, mark);
        }
        ui.checkbox(is_on, label)
    })
    .inner
}

/// Paints a check box that is part of another widget, such as a menu entry.
pub(crate) fn paint_check_box(ui: &egui::Ui, rect: egui::Rect, is_on: bool) {
    let palette = theme::of(ui);
    let fill = if is_on { palette.accent } else { palette.panel };
    let edge = egui::Stroke::new(1.5, palette.text_weak);
    ui.painter().rect(rect, CORNER, fill, edge, egui::StrokeKind::Inside);
    if is_on {
        let tick = egui::Rect::from_center_size(rect.center(), egui::Vec2::splat(TICK));
        let points = vec![
            egui::pos2(tick.left(), tick.center().y),
            tick.center_bottom() - egui::vec2(TICK * 0.1, TICK * 0.1),
            tick.right_top(),
        ];
        ui.painter().line(points, egui::Stroke::new(2.0, palette.on_accent));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn a_click_on_the_label_ticks_the_box() {
        let mut harness = Harness::new_ui_state(
            |ui, is_on: &mut bool| {
                check_box(ui, is_on, "Anti-aliasing");
            },
            false,
        );
        harness.get_by_label("Anti-aliasing").click();
        harness.run();
        assert!(*harness.state());
        harness.get_by_role(egui::accesskit::Role::CheckBox).click();
        harness.run();
        assert!(!*harness.state());
    }

    #[test]
    fn a_check_box_is_a_square_with_sharp_corners() {
        // A corner radius of half the side would make a circle.
        assert!(f32::from(CORNER.nw) * 4.0 <= CHECK_BOX_SIDE / 2.0);
    }
}
