//! A rule in a list: its condition above, what it does below. Those that hold are lit.

use bevy_egui::egui;

use crate::studio::ui::theme;

/// Height of a rule in the list, in points.
pub(super) const RULE_HEIGHT: f32 = theme::GAP * 5.0;

/// A rule of a list.
pub(super) struct RuleRow {
    /// Its condition: "If ...".
    pub condition: String,
    /// What it does.
    pub action: String,
    /// Whether its condition holds.
    pub holds: bool,
    /// Whether it holds and decides.
    pub decides: bool,
    /// Both in a sentence without a full stop.
    pub state: &'static str,
}

impl RuleRow {
    /// Draws the rule over the whole width.
    pub fn ui(&self, ui: &mut egui::Ui) {
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
        let cut = |text: String, color: egui::Color32| {
            let mut job = egui::text::LayoutJob::simple_singleline(text, font.clone(), color);
            job.wrap = egui::text::TextWrapping::truncate_at_width(inside.width());
            ui.fonts_mut(|fonts| fonts.layout_job(job))
        };
        let of = |is_lit| if is_lit { palette.text } else { palette.text_weak };
        for (text, color, top) in [
            (&self.condition, of(self.holds), inside.top()),
            (&self.action, of(self.decides), inside.center().y),
        ] {
            let text = cut(text.clone(), color);
            ui.painter().galley(egui::pos2(inside.left(), top), text, color);
        }
        let said = format!("{}: {}. {}", self.condition, self.action, self.state);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Label, true, &said));
        response.on_hover_text(&said);
    }
}
