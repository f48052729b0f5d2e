//! View of waves that rules choose: the wave of each joint, the waves with their phases, and the rules on which the choice is based.

use bevy_egui::egui::{self, Align2, FontId, Rect, Stroke};

use super::rule_row::{RuleRow, rule_list};
use crate::studio::ui::accessible::named;
use crate::studio::ui::decimals::{decimals, in_percent};
use crate::studio::ui::text_rows::{explain, title};
use crate::studio::ui::theme;
use snakes_core::control::{ActiveWaveRule, WaveChoiceActivity};
use snakes_core::genome::controllers::{JointGroup, Wave};
use snakes_lab::plot::Role;

/// Height of the row of joints, and of a wave's row, in points.
const JOINTS_HEIGHT: f32 = theme::GAP * 4.5;
const WAVE_HEIGHT: f32 = theme::GAP * 5.5;
/// Width of the names, and of the shares, beside the curves, in points.
const NAMES: f32 = theme::GAP * 9.0;
const SHARES: f32 = theme::GAP * 6.0;
/// Minimum width at which a joint is labelled with a word, in points.
const WORD_WIDTH: f32 = theme::GAP * 6.0;
/// Number of segments of a wave's curve.
const CURVE_POINTS: usize = 64;

/// Draws the waves and the rules that choose them.
pub(super) fn wave_view(ui: &mut egui::Ui, choice: &WaveChoiceActivity) {
    joints(ui, choice);
    title(ui, &format!("Waves at joint {}", choice.joint + 1));
    explain(
        ui,
        "One period of the bend target, and thin, of the twist target. The line is now; the percentage is the share \
         of decisions so far.",
    );
    let most = choice.waves.iter().flat_map(|wave| [&wave.targets.bend, &wave.targets.twist]);
    let most = most.flat_map(curve).map(|[_, angle]| angle.abs()).fold(0.05, f32::max);
    for index in 0..choice.waves.len() {
        wave_row(ui, choice, index, most);
    }
    rules(ui, choice);
}

/// Draws the wave that each joint follows, on the wave's colour.
fn joints(ui: &mut egui::Ui, choice: &WaveChoiceActivity) {
    let palette = theme::of(ui);
    let size = egui::vec2(ui.available_width(), JOINTS_HEIGHT);
    let (area, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    // A gap separates the halves of the joints.
    let gap = theme::GAP;
    let width = (area.width() - gap) / choice.of_joints.len().max(1) as f32;
    let (small, body) =
        (FontId::proportional(theme::SMALL_SIZE), egui::TextStyle::Body.resolve(ui.style()));
    for (joint, &wave) in choice.of_joints.iter().enumerate() {
        let is_rear = joint >= choice.front_joints;
        let left = area.left() + width * joint as f32 + if is_rear { gap } else { 0.0 };
        let cell = Rect::from_min_size(
            egui::pos2(left, area.top()),
            egui::vec2(width - 2.0, area.height()),
        );
        let color = palette.role(Role::Species(wave as u32));
        let ink = theme::palette::text_on(color);
        ui.painter().rect_filled(cell, theme::GAP / 2.0, color);
        let (above, below) = if width >= WORD_WIDTH {
            (format!("Joint {}", joint + 1), format!("wave {}", wave + 1))
        } else {
            ((joint + 1).to_string(), (wave + 1).to_string())
        };
        let [high, low] = [0.3, 0.68].map(|share| cell.top() + cell.height() * share);
        let x = cell.center().x;
        ui.painter().text(egui::pos2(x, high), Align2::CENTER_CENTER, above, small.clone(), ink);
        ui.painter().text(egui::pos2(x, low), Align2::CENTER_CENTER, below, body.clone(), ink);
        let half = if is_rear { "rear" } else { "front" };
        let said = format!("Joint {}, in the {half} half, follows wave {}", joint + 1, wave + 1);
        let response = ui.interact(cell, ui.id().with(("wave of", joint)), egui::Sense::hover());
        named(response, egui::WidgetType::Label, &said).on_hover_text(&said);
    }
}

/// Returns one period of a wave, as points of the elapsed part, from 0 to 1, and the angle in radians.
fn curve(wave: &Wave) -> impl Iterator<Item = [f32; 2]> + '_ {
    (0..=CURVE_POINTS).map(|point| {
        let part = point as f64 / CURVE_POINTS as f64;
        [part as f32, wave.at(part)]
    })
}

/// Draws a wave with its phase. `most` is the largest angle of all waves, in radians.
fn wave_row(ui: &mut egui::Ui, choice: &WaveChoiceActivity, index: usize, most: f32) {
    let wave = &choice.waves[index];
    let palette = theme::of(ui);
    let size = egui::vec2(ui.available_width(), WAVE_HEIGHT);
    let (area, response) = ui.allocate_exact_size(size, egui::Sense::hover());
    let followers = choice.of_joints.iter().filter(|of| **of == index).count();
    let color = palette.role(Role::Species(index as u32));
    let painter = ui.painter();
    let small = FontId::proportional(theme::SMALL_SIZE);
    let body = egui::TextStyle::Body.resolve(ui.style());
    // The mark has the wave's colour, which the joints that follow the wave also have.
    let tab = Rect::from_min_size(area.min, egui::vec2(theme::GAP / 2.0, area.height() - 4.0));
    painter.rect_filled(tab, 2.0, color);
    let left = area.left() + theme::GAP;
    let (upper, lower) = (area.top() + WAVE_HEIGHT * 0.3, area.top() + WAVE_HEIGHT * 0.65);
    let name = format!("Wave {}", index + 1);
    painter.text(egui::pos2(left, upper), Align2::LEFT_CENTER, &name, body.clone(), palette.text);
    let frequency = format!("{} Hz", decimals(wave.frequency_hz, 2));
    let below = egui::pos2(left, lower);
    painter.text(below, Align2::LEFT_CENTER, &frequency, small, palette.text_weak);
    let share = in_percent(wave.share);
    let right = egui::pos2(area.right(), area.center().y - 2.0);
    painter.text(right, Align2::RIGHT_CENTER, &share, body, palette.text);
    let plot = Rect::from_min_max(
        egui::pos2(area.left() + NAMES, area.top()),
        egui::pos2(area.right() - SHARES, area.bottom() - 4.0),
    );
    if plot.width() > 1.0 {
        let fill = if followers > 0 { palette.accent_soft } else { palette.field };
        painter.rect_filled(plot, theme::GAP / 4.0, fill);
        painter.hline(plot.x_range(), plot.center().y, Stroke::new(1.0, palette.field_hovered));
        let at = |[part, angle]: [f32; 2]| {
            let y = plot.center().y - angle / most * (plot.height() / 2.0 - 3.0);
            egui::pos2(plot.left() + plot.width() * part, y)
        };
        let ink = if followers > 0 { palette.text } else { palette.text_weak };
        for (of, width) in [(&wave.targets.twist, 1.0), (&wave.targets.bend, 2.0)] {
            let line: Vec<egui::Pos2> = curve(of).map(at).collect();
            painter.line(line, Stroke::new(width, ink));
        }
        let now = at([wave.phase, wave.targets.bend.at(f64::from(wave.phase))]);
        painter.vline(now.x, plot.y_range(), Stroke::new(1.0, ink));
        painter.circle(now, theme::GAP / 2.0, color, Stroke::new(1.5, ink));
    }
    let now = match followers {
        0 => "no joint follows it now".to_owned(),
        1 => "1 joint follows it now".to_owned(),
        many => format!("{many} joints follow it now"),
    };
    let said = format!("{name}: {frequency}, {share} of decisions, {now}");
    named(response, egui::WidgetType::Label, &said).on_hover_text(&said);
}

/// Draws the rules, the strongest first. The first rule that holds decides.
fn rules(ui: &mut egui::Ui, choice: &WaveChoiceActivity) {
    let held = choice.rules.iter().filter(|rule| rule.holds).count();
    title(ui, &format!("Rules: {held} of {} hold", choice.rules.len()));
    explain(
        ui,
        "The strongest are first. Those that held at the last decision are lit; in each half of the joints the \
         strongest of them decided, and is brighter. Where none holds, wave 1 moves the joints.",
    );
    let mut listed: Vec<&ActiveWaveRule> = choice.rules.iter().collect();
    // The sort is stable, because the first of equally strong rules decides.
    listed.sort_by(|a, b| b.rule.strength.total_cmp(&a.rule.strength));
    rule_list(ui, "wave rules", listed.len(), |index| entry(listed[index]));
}

/// Returns the row of a rule: its condition above, its joints and wave below.
fn entry(ActiveWaveRule { rule, holds, decides }: &ActiveWaveRule) -> RuleRow {
    let strength = decimals(rule.strength, 2);
    let joints = match rule.group {
        JointGroup::Front => "front joints",
        JointGroup::All => "all joints",
        JointGroup::Rear => "rear joints",
    };
    let condition = match rule.words() {
        always if always == "always" => "Always".to_owned(),
        words => format!("If {words}"),
    };
    RuleRow {
        condition,
        action: format!("{joints}: wave {}, strength {strength}", rule.wave),
        holds: *holds,
        decides: decides.is_some(),
        state: match (holds, decides) {
            (_, Some(JointGroup::All)) => "It decides for all joints",
            (_, Some(JointGroup::Front)) => "It decides for the front joints",
            (_, Some(JointGroup::Rear)) => "It decides for the rear joints",
            (true, None) => "It holds, but a stronger rule decides",
            (false, None) => "It does not hold",
        },
    }
}
