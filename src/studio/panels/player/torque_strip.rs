//! Torques of a whole rollout, joint by joint, with a draggable time cursor.

use std::sync::Arc;

use bevy_egui::egui;
use bevy_egui::egui::{Color32, Pos2, Rect, Shape, Stroke};

use crate::score::KeyframeHistory;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::theme;
use crate::world::JointTorque;

/// The strip with its cached lines.
#[derive(Default)]
pub(crate) struct TorqueStrip {
    drawn: Option<DrawnStrip>,
}

/// Lines that are cached until their input changes.
struct DrawnStrip {
    history: Arc<KeyframeHistory>,
    rect: Rect,
    end_s: f64,
    is_dark: bool,
    shapes: Vec<Shape>,
}

/// Reads the torque about one axis, in N·m.
type TorqueAxis = fn(&JointTorque) -> f32;

/// Width of a sampling column, in points.
const COLUMN_WIDTH: f32 = 2.0;
/// Height of the time ruler, in points.
const RULER_HEIGHT: f32 = 11.0;
/// Vertical margin of a row, in points.
const ROW_MARGIN: f32 = 1.5;

impl TorqueStrip {
    /// Draws the strip over the available width. Returns the time that was clicked or dragged to, in simulated
    /// seconds.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        lane: &Lane,
        now_s: f64,
        end_s: f64,
        height: f32,
    ) -> Option<f64> {
        let size = egui::vec2(ui.available_width(), height);
        let (rect, response) = ui.allocate_exact_size(size, egui::Sense::click_and_drag());
        response.widget_info(|| {
            egui::WidgetInfo::slider(ui.is_enabled(), now_s, "Time, in simulated seconds")
        });
        let palette = theme::of(ui);
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 4.0, palette.field);
        let mut plot = rect.shrink2(egui::vec2(0.0, 3.0));
        plot.max.y -= RULER_HEIGHT;
        let x_of = |time_s: f64| {
            let share = if end_s > 0.0 { time_s / end_s } else { 0.0 };
            plot.left() + plot.width() * share.clamp(0.0, 1.0) as f32
        };
        // The played part is shaded like a progress bar.
        let played = Rect::from_min_max(rect.min, egui::pos2(x_of(now_s), rect.bottom()));
        painter.rect_filled(played, 4.0, palette.field.lerp_to_gamma(palette.accent_soft, 0.5));
        seconds(&painter, rect, end_s, &x_of, palette);
        match lane.history() {
            Some(history) => {
                painter.extend(self.lines(history, lane, plot, end_s, ui.visuals().dark_mode));
            }
            None => {
                let text = match lane.lookahead_share() {
                    Some(share) => format!("Computing preview: {:.0} %", share * 100.0),
                    None if lane.staged().recording().is_some() => {
                        "A recording contains poses, but no torques".to_owned()
                    }
                    None => "The torques are unknown".to_owned(),
                };
                let font = egui::FontId::proportional(theme::SMALL_SIZE);
                let align = egui::Align2::CENTER_CENTER;
                painter.text(rect.center(), align, text, font, palette.text_weak);
            }
        }
        let x = x_of(now_s);
        let cursor = Stroke::new(2.0, palette.accent);
        painter.line_segment([egui::pos2(x, rect.top()), egui::pos2(x, rect.bottom())], cursor);

        // A quick click goes down and up within one frame.
        let is_pointed = response.is_pointer_button_down_on() || response.clicked();
        let pointed = response.interact_pointer_pos().filter(|_| is_pointed);
        let at = |pointer: Pos2| {
            f64::from((pointer.x - plot.left()) / plot.width().max(1.0)).clamp(0.0, 1.0) * end_s
        };
        let requested_s = pointed.map(at);
        if let Some(hovered) = response.hover_pos().filter(|_| !response.dragged()) {
            let time_s = at(hovered);
            response.on_hover_text_at_pointer(hover_text(lane, time_s));
        }
        requested_s
    }

    fn lines(
        &mut self,
        history: &Arc<KeyframeHistory>,
        lane: &Lane,
        plot: Rect,
        end_s: f64,
        is_dark: bool,
    ) -> Vec<Shape> {
        let is_drawn = self.drawn.as_ref().is_some_and(|drawn| {
            Arc::ptr_eq(&drawn.history, history)
                && (drawn.rect, drawn.end_s, drawn.is_dark) == (plot, end_s, is_dark)
        });
        if !is_drawn {
            let palette = if is_dark { theme::Theme::Dark } else { theme::Theme::Light }.palette();
            let shapes = shapes(history, lane, plot, end_s, palette);
            self.drawn = Some(DrawnStrip {
                history: Arc::clone(history),
                rect: plot,
                end_s,
                is_dark,
                shapes,
            });
        }
        self.drawn.as_ref().map(|drawn| drawn.shapes.clone()).unwrap_or_default()
    }
}

/// Draws a mark at every round second.
fn seconds(
    painter: &egui::Painter,
    rect: Rect,
    end_s: f64,
    x_of: &dyn Fn(f64) -> f32,
    palette: &theme::Palette,
) {
    let step_s = crate::studio::ui::plot_axes::step(end_s.max(0.1));
    let font = egui::FontId::proportional(theme::SMALL_SIZE - 1.0);
    let mut mark_s = step_s;
    while mark_s < end_s * 0.985 {
        let x = x_of(mark_s);
        let stroke = Stroke::new(1.0, palette.field_hovered);
        painter.line_segment([egui::pos2(x, rect.top()), egui::pos2(x, rect.bottom())], stroke);
        let text = format!("{} s", crate::studio::ui::plot_axes::number(mark_s));
        let at = egui::pos2(x + 3.0, rect.bottom() - 1.0);
        painter.text(at, egui::Align2::LEFT_BOTTOM, text, font.clone(), palette.text_weak);
        mark_s += step_s;
    }
}

/// Lines of all joints: one row per joint, one line per axis.
fn shapes(
    history: &KeyframeHistory,
    lane: &Lane,
    plot: Rect,
    end_s: f64,
    palette: &theme::Palette,
) -> Vec<Shape> {
    let samples: Vec<&[JointTorque]> = history.torques().collect();
    let joints = &lane.body().joints;
    let sample_s = lane.step_s() * f64::from(history.sample_steps());
    let row_height = plot.height() / joints.len().max(1) as f32;
    let columns = (plot.width() / COLUMN_WIDTH).max(1.0) as usize;
    let mut shapes = Vec::new();
    for (joint, plan) in joints.iter().enumerate() {
        let middle = plot.top() + row_height * (joint as f32 + 0.5);
        let zero = [egui::pos2(plot.left(), middle), egui::pos2(plot.right(), middle)];
        shapes.push(Shape::line_segment(zero, Stroke::new(1.0, palette.field_hovered)));
        let axes: [(TorqueAxis, f32, Color32); 2] = [
            (|torque| torque.twist_nm, plan.max_twist_torque_nm, palette.twist),
            (|torque| torque.bend_nm, plan.max_bend_torque_nm, palette.bend),
        ];
        for (axis, most_nm, color) in axes {
            let column = |index: usize| {
                let sample = |at: usize| {
                    let time_s = end_s * at as f64 / columns as f64;
                    (time_s / sample_s) as usize
                };
                let (from, to) = (sample(index), sample(index + 1));
                let seen = samples.get(from..to.max(from + 1).min(samples.len()))?;
                // The largest torque within a column is drawn, so that no peak is lost.
                let torques = seen.iter().filter_map(|torques| torques.get(joint).map(axis));
                let largest = torques.max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
                let share = (largest / most_nm.max(1.0e-6)).clamp(-1.0, 1.0);
                let x = plot.left() + plot.width() * index as f32 / columns as f32;
                Some(egui::pos2(x, middle - share * (row_height / 2.0 - ROW_MARGIN)))
            };
            let line: Vec<Pos2> = (0..columns).map_while(column).collect();
            let is_flat = line.iter().all(|point| (point.y - middle).abs() < 0.1);
            if !is_flat {
                shapes.push(Shape::line(line, Stroke::new(1.0, color)));
            }
        }
    }
    shapes
}

/// Torques at a time, as hover text.
fn hover_text(lane: &Lane, time_s: f64) -> String {
    let mut text = format!("{time_s:.2} s: click or drag to go there");
    let Some(history) = lane.history() else { return text };
    let sample = (time_s / (lane.step_s() * f64::from(history.sample_steps()))) as usize;
    if let Some(torques) = history.torques().nth(sample) {
        for (joint, torque) in (1..).zip(torques) {
            // Avoids "-0".
            let [bend_nm, twist_nm] = [torque.bend_nm, torque.twist_nm].map(|nm| nm.round() + 0.0);
            text += &format!("\nJoint {joint}: bend {bend_nm:+} N·m, twist {twist_nm:+} N·m");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::shipped_champion;
    use crate::studio::stage::staged_champion::StagedChampion;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn a_click_or_a_drag_seeks_to_the_time_under_the_pointer() {
        let loaded = shipped_champion().expect("well formed");
        let lane = Lane::new(StagedChampion::from_file(&loaded, 0, "climber"), 0);
        let mut strip_panel = TorqueStrip::default();
        let mut harness = Harness::builder().with_size(egui::vec2(600.0, 100.0)).build_ui_state(
            |ui, commands: &mut Vec<f64>| {
                commands.extend(strip_panel.ui(ui, &lane, 1.0, 15.0, 60.0))
            },
            Vec::new(),
        );
        let strip = harness.get_by_label("Time, in simulated seconds").rect();
        let at = |share: f32| strip.lerp_inside(egui::vec2(share, 0.5));
        harness.hover_at(at(0.5));
        harness.drag_at(at(0.5));
        harness.drop_at(at(0.5));
        harness.run();
        let clicked = harness.state().last().copied().expect("a moment");
        assert!((clicked - 7.5).abs() < 0.1, "{clicked} s");
        harness.drag_at(at(0.2));
        harness.run();
        harness.hover_at(at(2.0));
        harness.run();
        let dragged = harness.state().last().copied().expect("a moment");
        assert_eq!(dragged, 15.0, "beyond the end is the end");
        harness.drop_at(at(2.0));
    }
}
