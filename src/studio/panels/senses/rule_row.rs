//! List of rules: each with its condition above and its action below. Rules whose conditions hold are highlighted.

use bevy_egui::egui;

use crate::studio::ui::accessible::named;
use crate::studio::ui::theme;

/// Height of a rule in the list, in points: two lines for the condition, one for the action.
const RULE_HEIGHT: f32 = theme::GAP * 6.75;
/// Height of the list of rules, in points. It is fixed because the panel scrolls as well; otherwise the list would get
/// only the remaining height of the window.
const LIST_HEIGHT: f32 = theme::GAP * 40.0;

/// Draws a list of rules with its own scroll bar. Only visible rules are laid out.
pub(super) fn rule_list(
    ui: &mut egui::Ui,
    id_salt: &str,
    rules: usize,
    row: impl Fn(usize) -> RuleRow,
) {
    let area =
        egui::ScrollArea::vertical().max_height(LIST_HEIGHT).min_scrolled_height(LIST_HEIGHT);
    let area = area.auto_shrink([false, true]).id_salt(id_salt);
    area.show_rows(ui, RULE_HEIGHT, rules, |ui, seen| seen.for_each(|index| row(index).ui(ui)));
}

/// A row of the list: one rule.
pub(super) struct RuleRow {
    /// Condition of the rule: "If ...".
    pub condition: String,
    /// The action of the rule, in words.
    pub action: String,
    /// Whether the condition of the rule holds.
    pub holds: bool,
    /// Whether the rule has decided what the controller does.
    pub decides: bool,
    /// State of the rule in a sentence without a full stop.
    pub state: &'static str,
}

impl RuleRow {
    /// Draws the rule over the whole width.
    fn ui(&self, ui: &mut egui::Ui) {
        let palette = theme::of(ui);
        let size = egui::vec2(ui.available_width(), RULE_HEIGHT);
        let (rect, response) = ui.allocate_exact_size(size, egui::Sense::hover());
        let fill = match (self.holds, self.decides) {
            (_, true) => palette.accent_soft,
            (true, false) => palette.field_hovered,
            (false, false) => palette.field,
        };
        ui.painter().rect_filled(rect, theme::GAP / 2.0, fill);
        let inside = rect.shrink2(egui::vec2(theme::GAP * 0.75, theme::GAP / 4.0));
        let font = egui::TextStyle::Body.resolve(ui.style());
        let cut = |text: &str, lines: usize, color: egui::Color32| {
            let mut job =
                egui::text::LayoutJob::simple(text.to_owned(), font.clone(), color, inside.width());
            job.wrap.max_rows = lines;
            ui.fonts_mut(|fonts| fonts.layout_job(job))
        };
        let of = |is_lit| if is_lit { palette.text } else { palette.text_weak };
        let condition = cut(&self.condition, 2, of(self.holds));
        ui.painter().galley(inside.left_top(), condition, palette.text);
        let action = cut(&self.action, 1, of(self.decides));
        let bottom = inside.left_bottom() - egui::vec2(0.0, action.size().y);
        ui.painter().galley(bottom, action, palette.text);
        let said = format!("{}: {}. {}", self.condition, self.action, self.state);
        named(response, egui::WidgetType::Label, &said).on_hover_text(&said);
    }
}
