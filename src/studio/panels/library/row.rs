//! A row of the library: two lines in a narrow panel, columns in a wide one.

use bevy_egui::egui::epaint::text::LayoutJob;
use bevy_egui::egui::{self, Align, FontId, Rect, Response, Sense, WidgetType};

use super::order::SortKey;
use crate::studio::panels::thumbnail::thumbnail;
use crate::studio::state::library::LibraryItem;
use crate::studio::ui::accessible::named_selected;
use crate::studio::ui::theme;
use snakes_core::save::library::EntryProblem;

/// Draws a row and returns its response. The row may be selected, and may have the keyboard cursor of the focused list.
pub fn row(
    ui: &mut egui::Ui,
    rect: Rect,
    item: &LibraryItem,
    is_chosen: bool,
    has_cursor: bool,
) -> Response {
    let id = ui.id().with(item.place().path()).with(item.name());
    // The list takes the focus as a whole, because it may have ten thousand rows.
    let response = ui.interact(rect, id, Sense::CLICK);
    let (kind, name) = (WidgetType::SelectableLabel, item.label());
    let response = named_selected(response, kind, is_chosen, &name);
    let palette = theme::of(ui);
    let ground = rect.shrink2(egui::vec2(0.0, 1.0));
    let fill = match (is_chosen, response.hovered()) {
        (true, _) => Some(palette.accent_soft),
        (false, true) => Some(palette.field_hovered),
        (false, false) => None,
    };
    if let Some(fill) = fill {
        ui.painter().rect_filled(ground, 4.0, fill);
    }
    if has_cursor {
        let stroke = egui::Stroke::new(1.5, palette.accent);
        ui.painter().rect_stroke(ground, 4.0, stroke, egui::StrokeKind::Inside);
    }
    let picture = picture_rect(rect);
    match item.thumbnail() {
        Some(of) => thumbnail(ui.painter(), picture, of, palette),
        None => {
            ui.painter().rect_filled(picture, 4.0, palette.field);
            let sign = if item.problem().is_some() { "!" } else { "…" };
            let font = FontId::proportional(theme::TITLE_SIZE);
            let color = if item.problem().is_some() { palette.problem } else { palette.text_weak };
            ui.painter().text(picture.center(), egui::Align2::CENTER_CENTER, sign, font, color);
        }
    }
    if rect.width() >= theme::COLUMNS_WIDTH {
        wide(ui, rect, item, is_chosen)
    } else {
        narrow(ui, rect, item, is_chosen)
    }
    match item.problem() {
        Some(problem) => response.on_hover_text(problem.message.as_str()),
        None => response,
    }
}

fn picture_rect(rect: Rect) -> Rect {
    let left = rect.left_center() + egui::vec2(theme::GAP / 2.0, 0.0);
    Rect::from_min_size(
        left - egui::vec2(0.0, theme::THUMBNAIL_SIZE.y / 2.0),
        theme::THUMBNAIL_SIZE,
    )
}

/// Returns the rectangle of the name, in which it can be edited.
pub fn name_rect(rect: Rect) -> Rect {
    if rect.width() >= theme::COLUMNS_WIDTH {
        return column(rect, SortKey::Name);
    }
    // The field covers the name and the way, but not the second line.
    let text = text_rect(rect);
    text.with_min_y(rect.top() + 1.0).with_max_y(rect.center().y)
}

fn text_rect(rect: Rect) -> Rect {
    let left = picture_rect(rect).right() + theme::GAP;
    rect.with_min_x(left).with_max_x(rect.right() - theme::GAP).shrink2(egui::vec2(0.0, 4.0))
}

/// Returns the rectangle of a column within a row.
pub fn column(row: Rect, key: SortKey) -> Rect {
    let text = text_rect(row);
    let place = SortKey::ALL.iter().position(|of| *of == key).unwrap_or(0);
    let widths = theme::COLUMN_WIDTHS;
    let after: f32 = widths.iter().skip(place).sum();
    let right = text.right() - after;
    match place.checked_sub(1) {
        None => text.with_max_x(right - theme::GAP),
        Some(before) => {
            let left = right - widths.get(before).copied().unwrap_or_default();
            text.with_min_x(left).with_max_x(right - theme::GAP)
        }
    }
}

fn narrow(ui: &egui::Ui, rect: Rect, item: &LibraryItem, is_chosen: bool) {
    let text = text_rect(rect);
    let [above, below] = [text.with_max_y(text.center().y), text.with_min_y(text.center().y)];
    let palette = theme::of(ui);
    let [weak, problem] = text_colors(palette, is_chosen);
    let way = write(ui, above, Align::Max, &item.way_text(" of the way"), palette.text, false);
    let name = above.with_max_x(above.right() - way - theme::GAP);
    write(ui, name, Align::Min, item.name(), palette.text, false);
    if let Some(EntryProblem { words, .. }) = item.problem() {
        write(ui, below, Align::Min, words, problem, true);
        return;
    }
    let date = write(ui, below, Align::Max, &item.date_text(), weak, true);
    let about = [item.preset_title().unwrap_or_default(), item.generation_text()].join(", ");
    let left = below.with_max_x(below.right() - date - theme::GAP);
    write(ui, left, Align::Min, about.trim_matches([',', ' ']), weak, true);
}

fn wide(ui: &egui::Ui, rect: Rect, item: &LibraryItem, is_chosen: bool) {
    let palette = theme::of(ui);
    let [weak, problem] = text_colors(palette, is_chosen);
    write(ui, column(rect, SortKey::Name), Align::Min, item.name(), palette.text, false);
    if let Some(EntryProblem { words, .. }) = item.problem() {
        let rest = column(rect, SortKey::Way).union(column(rect, SortKey::Generation));
        write(ui, rest, Align::Min, words, problem, false);
    }
    for (key, text, color) in [
        (SortKey::Way, item.way_text(""), palette.text),
        (SortKey::Preset, item.preset_title().unwrap_or_default(), weak),
        (SortKey::Generation, item.generation_text(), weak),
        (SortKey::Date, item.date_text(), weak),
    ] {
        write(ui, column(rect, key), Align::Min, &text, color, false);
    }
}

/// Returns the colours of secondary text and of problems. On a selected row they are the normal text colour, for contrast.
fn text_colors(palette: &theme::Palette, is_chosen: bool) -> [egui::Color32; 2] {
    if is_chosen { [palette.text; 2] } else { [palette.text_weak, palette.problem] }
}

/// Draws one line of text, truncated to `rect`. Returns its width in points.
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
