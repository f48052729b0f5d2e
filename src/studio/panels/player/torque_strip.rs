//! Torques of a whole rollout, joint by joint from head to tail, with marks of the climb, and a time cursor that can be dragged.

use std::sync::Arc;

use bevy_egui::egui::{self, Color32, Pos2, Rect, Shape, Stroke};

use super::climb_events::{ClimbEvent, events};
use super::strip_marks::{draw_events, event_at, legend};
use super::timeline::TimelineSpan;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::plot_axes::{number, step};
use crate::studio::ui::theme;
use snakes_core::score::KeyframeHistory;
use snakes_core::world::{BodyPlan, JointTorque};

/// The torque strip, with its cached lines.
#[derive(Default)]
pub(crate) struct TorqueStrip {
    drawn: Option<DrawnStrip>,
    /// End of the strip when the mouse button was pressed, in simulated seconds; `None` while it is up. Going back from
    /// a pull that ended the trial extends the end, but must not move the time under the pointer.
    pressed_end_s: Option<f64>,
}

/// Lines and events of the strip, cached until their input changes.
struct DrawnStrip {
    history: Arc<KeyframeHistory>,
    /// Rectangle of the torques, end of the strip in simulated seconds, whether the theme is dark, and the shown joints.
    look: (Rect, f64, bool, Vec<usize>),
    shapes: Vec<Shape>,
    events: Vec<ClimbEvent>,
}

/// Function that returns the torque about one axis, in N·m.
type TorqueAxis = fn(&JointTorque) -> f32;

/// Width of a column in which samples are combined, in points.
const COLUMN_WIDTH: f32 = 2.0;
/// Height of the time ruler, in points.
const RULER_HEIGHT: f32 = 11.0;
/// Height of the band with the marks of the climb, in points.
const MARKS_HEIGHT: f32 = 12.0;
/// Height of the strip without torques, in points.
pub(super) const THIN: f32 = MARKS_HEIGHT + RULER_HEIGHT + 3.0;
/// Vertical margin of a row, in points.
const ROW_MARGIN: f32 = 1.5;
/// Width of the names of the joints beside a wide strip and beside a narrow one, in points.
const NAMES_WIDTH: [f32; 2] = [82.0, 42.0];
/// Minimum width of a wide strip, in points.
const WIDE: f32 = 480.0;

impl TorqueStrip {
    /// Draws the strip in the available width, with its legend above unless the height is [`THIN`]. A selected limb limits
    /// the torques to those of its joints. Returns the time that was clicked or dragged to, in simulated seconds.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        (lane, limb): (&Lane, Option<usize>),
        now_s: f64,
        TimelineSpan { end_s, hides_future }: TimelineSpan,
        height: f32,
    ) -> Option<f64> {
        let is_wide = ui.available_width() >= WIDE;
        // A thin bar has the marks of the climb only.
        let has_torques = height > THIN;
        if has_torques {
            legend(ui, &lane.body.joints);
        }
        let names_width = if has_torques { NAMES_WIDTH[usize::from(!is_wide)] } else { 0.0 };
        let size = egui::vec2(ui.available_width(), height);
        let (whole, _) = ui.allocate_exact_size(size, egui::Sense::hover());
        let rect = Rect::from_min_max(whole.min + egui::vec2(names_width, 0.0), whole.max);
        let response = ui.interact(rect, ui.id().with("strip"), egui::Sense::click_and_drag());
        response.widget_info(|| {
            egui::WidgetInfo::slider(ui.is_enabled(), now_s, "Time, in simulated seconds")
        });
        // In a quick click, the button is pressed and released within one frame.
        let is_pointed = response.is_pointer_button_down_on() || response.clicked();
        self.pressed_end_s = is_pointed.then(|| self.pressed_end_s.unwrap_or(end_s));
        let end_s = self.pressed_end_s.unwrap_or(end_s);
        let palette = theme::of(ui);
        let painter = ui.painter_at(whole);
        painter.rect_filled(rect, 4.0, palette.field);
        let marks = Rect::from_min_size(rect.min, egui::vec2(rect.width(), MARKS_HEIGHT));
        let mut plot = rect;
        plot.min.y += MARKS_HEIGHT;
        plot.max.y -= RULER_HEIGHT;
        let x_of = |time_s: f64| {
            let share = if end_s > 0.0 { time_s / end_s } else { 0.0 };
            plot.left() + plot.width() * share.clamp(0.0, 1.0) as f32
        };
        // The area before the displayed time is shaded like a progress bar.
        let played = Rect::from_min_max(rect.min, egui::pos2(x_of(now_s), rect.bottom()));
        painter.rect_filled(played, 4.0, palette.field.lerp_to_gamma(palette.accent_soft, 0.5));
        seconds(&painter, rect, end_s, &x_of, palette);
        let of_whole = Rect::from_x_y_ranges(whole.left()..=plot.left(), plot.y_range());
        let joints = joints_of(&lane.body, limb);
        if has_torques {
            names(ui, of_whole, &lane.body, &joints, is_wide);
        }
        let mut climb = match lane.history() {
            Some(history) => {
                let drawn =
                    self.drawn(history, (lane, joints), plot, end_s, ui.visuals().dark_mode);
                let seen = if hides_future { played } else { rect };
                let seen = painter.with_clip_rect(seen.intersect(painter.clip_rect()));
                if has_torques {
                    seen.extend(drawn.shapes.iter().cloned());
                }
                // A snake that was pulled does not climb as in its undisturbed rollout.
                if lane.replay.is_disturbed() { Vec::new() } else { drawn.events.clone() }
            }
            None if !has_torques => events(lane),
            None => {
                let text = match lane.lookahead_share() {
                    Some(share) => format!("Computing preview: {:.0} %", share * 100.0),
                    None if lane.staged.recording().is_some() => {
                        "A recording contains poses, but no torques".to_owned()
                    }
                    None => "The torques are unknown".to_owned(),
                };
                let font = egui::FontId::proportional(theme::SMALL_SIZE);
                let align = egui::Align2::CENTER_CENTER;
                painter.text(rect.center(), align, text, font, palette.text_weak);
                events(lane)
            }
        };
        if hides_future {
            // Later marks would reveal the result that the reader has to guess.
            climb.retain(|event| event.time_s <= now_s);
        }
        draw_events(&painter, &climb, marks, plot.bottom(), &x_of, palette);
        let x = x_of(now_s);
        let cursor = Stroke::new(2.0, palette.accent);
        painter.line_segment([egui::pos2(x, rect.top()), egui::pos2(x, rect.bottom())], cursor);

        let pointed = response.interact_pointer_pos().filter(|_| is_pointed);
        let at = |pointer: Pos2| {
            f64::from((pointer.x - plot.left()) / plot.width().max(1.0)).clamp(0.0, 1.0) * end_s
        };
        let requested_s = pointed.map(at);
        if let Some(hovered) = response.hover_pos().filter(|_| !response.dragged()) {
            let event = event_at(&climb, hovered.x, &x_of).map(|words| words + "\n");
            let is_known = !hides_future || at(hovered) <= now_s;
            let text = event.unwrap_or_default() + &hover_text(lane, at(hovered), is_known);
            response.on_hover_text_at_pointer(text);
        }
        requested_s
    }

    fn drawn(
        &mut self,
        history: &Arc<KeyframeHistory>,
        (lane, joints): (&Lane, Vec<usize>),
        plot: Rect,
        end_s: f64,
        is_dark: bool,
    ) -> &DrawnStrip {
        let look = (plot, end_s, is_dark, joints);
        let is_same =
            |drawn: &DrawnStrip| Arc::ptr_eq(&drawn.history, history) && drawn.look == look;
        let drawn = self.drawn.take().filter(is_same).unwrap_or_else(|| {
            let palette = if is_dark { theme::Theme::Dark } else { theme::Theme::Light }.palette();
            let shapes = shapes(history, (lane, &look.3), plot, end_s, palette);
            DrawnStrip { history: Arc::clone(history), look, shapes, events: events(lane) }
        });
        self.drawn.insert(drawn)
    }
}

/// Returns the indices of the joints whose torques are shown: those of the selected limb, or all.
fn joints_of(body: &BodyPlan, limb: Option<usize>) -> Vec<usize> {
    let is_shown = |index: &usize| {
        let joint = &body.joints[*index];
        let limbs = [joint.parent, joint.child].map(|part| body.parts[part].limb);
        limb.is_none_or(|limb| limbs.contains(&limb))
    };
    (0..body.joints.len()).filter(is_shown).collect()
}

/// Returns "head" or "tail" for the joints at the ends of a body. If only each joint of a certain number has a name, the
/// last of them is at the tail.
fn end_of(body: &BodyPlan, joint: usize, every: usize) -> &'static str {
    match joint {
        // The body of a creature has no head and tail ends.
        _ if body.is_branching() => "",
        0 => "head",
        _ if joint + every >= body.joints.len() => "tail",
        _ => "",
    }
}

/// Writes the names of the joints beside their rows, from head to tail, in short form beside a narrow strip. If the
/// rows are lower than a line of text, neighbouring rows share a name.
fn names(ui: &egui::Ui, area: Rect, body: &BodyPlan, shown: &[usize], is_wide: bool) {
    let row_height = area.height() / shown.len().max(1) as f32;
    let every = (theme::SMALL_SIZE / row_height.max(0.1)).ceil().max(1.0) as usize;
    let font = egui::FontId::proportional(theme::SMALL_SIZE);
    let painter = ui.painter_at(area.expand2(egui::vec2(0.0, theme::SMALL_SIZE)));
    for (row, joint) in shown.iter().copied().enumerate().step_by(every) {
        let end = end_of(body, joint, every);
        let number = joint + 1;
        let name = match (is_wide, end) {
            (true, "") => format!("Joint {number}"),
            (true, end) => format!("Joint {number} ({end})"),
            (false, end) => format!("{number} {end}"),
        };
        let at = egui::pos2(area.left(), area.top() + row_height * (row as f32 + 0.5));
        let color = theme::of(ui).text_weak;
        painter.text(at, egui::Align2::LEFT_CENTER, name.trim_end(), font.clone(), color);
    }
}

/// Draws a mark and a number at round seconds.
fn seconds(
    painter: &egui::Painter,
    rect: Rect,
    end_s: f64,
    x_of: &dyn Fn(f64) -> f32,
    palette: &theme::Palette,
) {
    let step_s = step(end_s.max(0.1));
    let font = egui::FontId::proportional(theme::SMALL_SIZE - 1.0);
    let mut mark_s = step_s;
    while mark_s < end_s * 0.985 {
        let x = x_of(mark_s);
        let stroke = Stroke::new(1.0, palette.field_hovered);
        painter.line_segment([egui::pos2(x, rect.top()), egui::pos2(x, rect.bottom())], stroke);
        let text = format!("{} s", number(mark_s));
        let at = egui::pos2(x + 3.0, rect.bottom() - 1.0);
        painter.text(at, egui::Align2::LEFT_BOTTOM, text, font.clone(), palette.text_weak);
        mark_s += step_s;
    }
}

/// Returns the lines of these joints: one row per joint, one line per axis.
fn shapes(
    history: &KeyframeHistory,
    (lane, shown): (&Lane, &[usize]),
    plot: Rect,
    end_s: f64,
    palette: &theme::Palette,
) -> Vec<Shape> {
    let samples: Vec<&[JointTorque]> = history.torques().collect();
    let sample_s = lane.step_s * f64::from(history.sample_steps());
    let row_height = plot.height() / shown.len().max(1) as f32;
    let columns = (plot.width() / COLUMN_WIDTH).max(1.0) as usize;
    let mut shapes = Vec::new();
    let zero_color = palette.text_weak.gamma_multiply(0.5);
    for (row, joint) in shown.iter().copied().enumerate() {
        let plan = &lane.body.joints[joint];
        let middle = plot.top() + row_height * (row as f32 + 0.5);
        let zero = [egui::pos2(plot.left(), middle), egui::pos2(plot.right(), middle)];
        shapes.push(Shape::line_segment(zero, Stroke::new(1.0, zero_color)));
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

/// Returns the hover text: the time under the pointer and, unless they must be hidden (`is_known == false`), the torques at that time.
fn hover_text(lane: &Lane, time_s: f64, is_known: bool) -> String {
    let mut text = format!("{time_s:.2} s: click or drag to go there");
    let Some(history) = lane.history().filter(|_| is_known) else { return text };
    let sample = (time_s / (lane.step_s * f64::from(history.sample_steps()))) as usize;
    if let Some(torques) = history.torques().nth(sample) {
        for (joint, torque) in torques.iter().enumerate() {
            // Turns -0.0 into 0.0.
            let [bend_nm, twist_nm] = [torque.bend_nm, torque.twist_nm].map(|nm| nm.round() + 0.0);
            let end = match end_of(&lane.body, joint, 1) {
                "" => String::new(),
                end => format!(" ({end})"),
            };
            let number = joint + 1;
            text += &format!("\nJoint {number}{end}: bend {bend_nm:+} N·m, twist {twist_nm:+} N·m");
        }
    }
    text
}

#[cfg(test)]
mod tests;
