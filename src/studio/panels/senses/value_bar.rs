//! A row with a name, a bar in a range, and a number.

use bevy_egui::egui::{self, Color32};

use crate::studio::ui::accessible::named;
use crate::studio::ui::theme;

/// A row of the Senses panel: a value with its name, as a bar and as a number.
#[derive(Default)]
pub(super) struct ValueBar<'b> {
    pub name: &'b str,
    /// Width of all names in the list, in points.
    pub names_width: f32,
    /// Width of all numbers in the list, in points.
    pub numbers_width: f32,
    /// Number with its unit, as text.
    pub text: String,
    /// Value that the bar shows, and the ends of the bar's range.
    pub value: f32,
    pub range: [f32; 2],
    /// Short note at the right end: the range in words, or that the value is frozen.
    pub note: &'b str,
    pub color: Color32,
    /// Whether the value does not change any more, so that the row is grey.
    pub is_frozen: bool,
    /// Whether the row is the selected one of several.
    pub is_chosen: bool,
    pub hint: String,
}

/// Height of a row with a bar, in points.
const ROW_HEIGHT: f32 = theme::GAP * 2.25;
/// Width of the names of senses, in points.
const SENSE_NAMES: f32 = theme::GAP * 12.5;
/// Width of the numbers of senses with their units, in points.
const SENSE_NUMBERS: f32 = theme::GAP * 9.5;
/// Width of the notes at the right end, in points.
const NOTES: f32 = theme::GAP * 9.5;
/// Height of a bar, in points.
const BAR: f32 = theme::GAP * 0.75;

impl ValueBar<'_> {
    /// Creates an empty row for a list of senses.
    pub fn of_sense() -> Self {
        Self { names_width: SENSE_NAMES, numbers_width: SENSE_NUMBERS, ..Self::default() }
    }

    /// Draws the row over the whole width.
    pub fn ui(&self, ui: &mut egui::Ui) {
        let palette = theme::of(ui);
        let size = egui::vec2(ui.available_width(), ROW_HEIGHT);
        let (rect, response) = ui.allocate_exact_size(size, egui::Sense::hover());
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        let color = if self.is_frozen { palette.text_weak } else { self.color };
        let text = if self.is_frozen { palette.text_weak } else { palette.text };
        if self.is_chosen {
            painter.rect_filled(rect, theme::GAP / 4.0, palette.accent_soft);
        }
        let font = egui::TextStyle::Body.resolve(ui.style());
        let number = egui::TextStyle::Monospace.resolve(ui.style());
        let small = egui::FontId::proportional(theme::SMALL_SIZE);
        let weak = if self.is_chosen { palette.text } else { palette.text_weak };
        let middle = rect.center().y;
        let at = |x: f32| egui::pos2(x, middle);
        painter.text(at(rect.left() + 2.0), egui::Align2::LEFT_CENTER, self.name, font, weak);
        let numbers_end = rect.right() - NOTES;
        painter.text(at(numbers_end), egui::Align2::RIGHT_CENTER, &self.text, number, text);
        let left = numbers_end + theme::GAP;
        painter.text(at(left), egui::Align2::LEFT_CENTER, self.note, small, weak);
        let bar = egui::Rect::from_min_max(
            egui::pos2(rect.left() + self.names_width, middle - BAR / 2.0),
            egui::pos2(numbers_end - self.numbers_width - theme::GAP / 2.0, middle + BAR / 2.0),
        );
        if bar.width() > 1.0 {
            painter.rect_filled(bar, BAR / 2.0, palette.field_hovered);
            let [zero, end] = [0.0, self.value].map(|value| {
                egui::remap_clamp(value, self.range[0]..=self.range[1], bar.x_range())
            });
            let filled = egui::Rect::from_x_y_ranges(zero.min(end)..=zero.max(end), bar.y_range());
            painter.rect_filled(filled, BAR / 2.0, color);
            if self.range[0] < 0.0 {
                let tick = egui::Rangef::new(bar.top() - 2.0, bar.bottom() + 2.0);
                painter.vline(zero, tick, egui::Stroke::new(1.0, palette.text_weak));
            }
        }
        let said = format!("{}: {} {}", self.name, self.text, self.note);
        let said = if self.is_chosen { format!("{said}, chosen") } else { said };
        let response = named(response, egui::WidgetType::Label, &said);
        if !self.hint.is_empty() {
            response.on_hover_text(&self.hint);
        }
    }
}
