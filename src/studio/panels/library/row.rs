//! A row of the library: two lines where it is narrow, columns where it is wide.

use bevy_egui::egui::{
    self, Align, FontId, Rect, Response, Sense, WidgetInfo, WidgetType, epaint::text::LayoutJob,
};

use super::order::Key;
use super::thumbnail::thumbnail;
use crate::studio::library::Item;
use crate::studio::look;

/// How a row stands out.
#[derive(Debug, Clone, Copy, Default)]
pub struct Manner {
    /// Whether it is chosen.
    pub is_chosen: bool,
    /// Whether keys begin at it, and the list has the keyboard.
    pub is_cursor: bool,
}

/// Draws a row, and says what is done with it.
pub fn row(ui: &mut egui::Ui, rect: Rect, item: &Item, manner: Manner) -> Response {
    let id = ui.id().with(item.place().path()).with(item.name());
    // The list as a whole has the keyboard, not each of ten thousand rows.
    let response = ui.interact(rect, id, Sense::CLICK);
    response.widget_info(|| {
        WidgetInfo::selected(WidgetType::SelectableLabel, true, manner.is_chosen, item.label())
    });
    let palette = look::of(ui);
    let ground = rect.shrink2(egui::vec2(0.0, 1.0));
    let fill = match (manner.is_chosen, response.hovered()) {
        (true, _) => Some(palette.accent_soft),
        (false, true) => Some(palette.field_hovered),
        (false, false) => None,
    };
    if let Some(fill) = fill {
        ui.painter().rect_filled(ground, 4.0, fill);
    }
    if manner.is_cursor {
        let stroke = egui::Stroke::new(1.5, palette.accent);
        ui.painter().rect_stroke(ground, 4.0, stroke, egui::StrokeKind::Inside);
    }
    let picture = picture_rect(rect);
    match item.thumbnail() {
        Some(of) => thumbnail(ui.painter(), picture, of, palette),
        None => {
            ui.painter().rect_filled(picture, 4.0, palette.field);
            let sign = if item.problem().is_some() { "!" } else { "…" };
            let font = FontId::proportional(look::TITLE_SIZE);
            let color = if item.problem().is_some() { palette.problem } else { palette.text_weak };
            ui.painter().text(picture.center(), egui::Align2::CENTER_CENTER, sign, font, color);
        }
    }
    if rect.width() >= look::COLUMNS_WIDTH {
        wide(ui, rect, item, manner)
    } else {
        narrow(ui, rect, item, manner)
    }
    match item.problem() {
        Some(problem) => response.on_hover_text(problem),
        None => response,
    }
}

fn picture_rect(rect: Rect) -> Rect {
    let left = rect.left_center() + egui::vec2(look::GAP / 2.0, 0.0);
    Rect::from_min_size(left - egui::vec2(0.0, look::THUMBNAIL_SIZE.y / 2.0), look::THUMBNAIL_SIZE)
}

/// Where the name of a row is, to be edited in place.
pub fn name_rect(rect: Rect) -> Rect {
    if rect.width() >= look::COLUMNS_WIDTH {
        return column(rect, Key::Name);
    }
    let text = text_rect(rect);
    text.with_max_y(rect.center().y + look::GAP)
}

fn text_rect(rect: Rect) -> Rect {
    let left = picture_rect(rect).right() + look::GAP;
    rect.with_min_x(left).with_max_x(rect.right() - look::GAP).shrink2(egui::vec2(0.0, 4.0))
}

/// Where a column is within a row.
pub fn column(row: Rect, key: Key) -> Rect {
    let text = text_rect(row);
    let place = Key::ALL.iter().position(|of| *of == key).unwrap_or(0);
    let widths = look::COLUMN_WIDTHS;
    let after: f32 = widths.iter().skip(place).sum();
    let right = text.right() - after;
    match place.checked_sub(1) {
        None => text.with_max_x(right - look::GAP),
        Some(before) => {
            let left = right - widths.get(before).copied().unwrap_or_default();
            text.with_min_x(left).with_max_x(right - look::GAP)
        }
    }
}

fn narrow(ui: &egui::Ui, rect: Rect, item: &Item, manner: Manner) {
    let text = text_rect(rect);
    let [above, below] = [text.with_max_y(text.center().y), text.with_min_y(text.center().y)];
    let weak = weak(ui, manner);
    let palette = look::of(ui);
    let fitness = write(ui, above, Align::Max, &item.fitness_text(), palette.text, false);
    let name = above.with_max_x(above.right() - fitness - look::GAP);
    write(ui, name, Align::Min, item.name(), palette.text, false);
    if item.problem().is_some() {
        write(ui, below, Align::Min, "damaged", problem_color(ui, manner), true);
        return;
    }
    let date = write(ui, below, Align::Max, &item.date_text(), weak, true);
    let about = [item.preset().unwrap_or_default(), &item.generation_text()].join(", ");
    let left = below.with_max_x(below.right() - date - look::GAP);
    write(ui, left, Align::Min, about.trim_matches([',', ' ']), weak, true);
}

fn wide(ui: &egui::Ui, rect: Rect, item: &Item, manner: Manner) {
    let palette = look::of(ui);
    let weak = weak(ui, manner);
    write(ui, column(rect, Key::Name), Align::Min, item.name(), palette.text, false);
    if item.problem().is_some() {
        let rest = column(rect, Key::Fitness).union(column(rect, Key::Generation));
        write(ui, rest, Align::Min, "damaged", problem_color(ui, manner), false);
    }
    for (key, text, color) in [
        (Key::Fitness, item.fitness_text(), palette.text),
        (Key::Preset, item.preset().unwrap_or_default().to_owned(), weak),
        (Key::Generation, item.generation_text(), weak),
        (Key::Date, item.date_text(), weak),
    ] {
        write(ui, column(rect, key), Align::Min, &text, color, false);
    }
}

/// Weak text is not weak on what is chosen: it could not be read there.
fn weak(ui: &egui::Ui, manner: Manner) -> egui::Color32 {
    let palette = look::of(ui);
    if manner.is_chosen { palette.text } else { palette.text_weak }
}

fn problem_color(ui: &egui::Ui, manner: Manner) -> egui::Color32 {
    let palette = look::of(ui);
    if manner.is_chosen { palette.text } else { palette.problem }
}

/// Writes a line, cut off where there is no more room. Returns how wide it is, in points.
fn write(
    ui: &egui::Ui,
    rect: Rect,
    align: Align,
    text: &str,
    color: egui::Color32,
    is_small: bool,
) -> f32 {
    if text.is_empty() || rect.width() <= 0.0 {
        return 0.0;
    }
    let style = if is_small { egui::TextStyle::Small } else { egui::TextStyle::Body };
    let font = style.resolve(ui.style());
    let mut job = LayoutJob::simple_singleline(text.to_owned(), font, color);
    job.wrap = egui::text::TextWrapping::truncate_at_width(rect.width());
    let galley = ui.painter().layout_job(job);
    let size = galley.size();
    let left = if align == Align::Max { rect.right() - size.x } else { rect.left() };
    let at = egui::pos2(left, rect.center().y - size.y / 2.0);
    ui.painter().galley(at, galley, color);
    size.x
}
