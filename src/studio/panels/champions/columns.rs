//! Columns of the champions list: fitness, time and energy on the right of each row, as many as the width allows.

use bevy_egui::egui;
use bevy_egui::egui::epaint::text::LayoutJob;

use crate::studio::panels::shown::ShownLane;
use crate::studio::panels::thumbnail::thumbnail;
use crate::studio::ui::accessible::named_selected;
use crate::studio::ui::text_rows::weak;
use crate::studio::ui::theme;
use snakes_core::evolve::Champion;
use snakes_core::save::library::Thumbnail;

/// Widths of the columns for fitness, time and energy, in points.
const WIDTHS: [f32; 3] = [62.0, 54.0, 54.0];
/// Minimum width for the picture and the name, in points.
const NAME_WIDTH: f32 = 170.0;
/// Headings of the columns and their tooltips.
const HEADS: [(&str, &str); 3] = [
    ("Fitness", "What the run rewards: see Fitness in the Change panel"),
    (
        "Time",
        "Simulated time until the snake first reached the top of the stairs; - if it does not end there",
    ),
    ("Energy", "Energy that the joints used in the whole trial"),
];

/// Returns how many columns fit into a list of this width, in points; at least the fitness.
pub(super) fn count(width: f32) -> usize {
    let fits = |count: &usize| NAME_WIDTH + WIDTHS[..*count].iter().sum::<f32>() <= width;
    (1..=WIDTHS.len()).rev().find(fits).unwrap_or(1)
}

/// Returns the texts of a champion's columns. `time` is that of its landing, in seconds, or a text in its place.
pub(super) fn cells(champion: &Champion, time: Result<f64, &str>) -> [String; 3] {
    let energy =
        champion.evaluation.effort.map(|effort| format!("{:.1} kJ", effort.energy_j / 1000.0));
    let time = time.map_or_else(str::to_owned, |time_s| format!("{time_s:.2} s"));
    [champion.brief(), time, energy.unwrap_or_else(|| "-".to_owned())]
}

/// Draws the headings of the columns above rows of this width, in points.
pub(super) fn heads(ui: &mut egui::Ui, width: f32) {
    let size = egui::vec2(width, theme::SMALL_SIZE + 4.0);
    let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    for (index, cell) in places(rect, count(width)).into_iter().enumerate() {
        let (name, hint) = HEADS[index];
        let text = weak(ui, name).small();
        let layout = egui::Layout::right_to_left(egui::Align::Center);
        let mut cell = ui.new_child(egui::UiBuilder::new().max_rect(cell).layout(layout));
        cell.label(text).on_hover_text(hint);
    }
}

/// Draws a clickable row of full width: the picture of the climb, if it is known, and the name on the left, the columns
/// on the right. `shown` is the lane of the row's champion, if the champion is on the stage.
pub(super) fn row(
    ui: &mut egui::Ui,
    shown: Option<&ShownLane>,
    picture: Option<&Thumbnail>,
    name: &str,
    cells: &[String; 3],
) -> egui::Response {
    let (width, is_shown) = (ui.available_width(), shown.is_some());
    let count = count(width);
    let button = egui::Button::new("")
        .selected(is_shown)
        .min_size(egui::vec2(width, theme::CHAMPION_ROW_HEIGHT));
    let response = ui.add(button);
    let label = std::iter::once(name).chain(cells[..count].iter().map(String::as_str));
    let label = label.collect::<Vec<_>>().join(", ");
    let response = named_selected(response, egui::WidgetType::Button, is_shown, &label);
    let rect = response.rect;
    let palette = theme::of(ui);
    let font = egui::TextStyle::Button.resolve(ui.style());
    let places = places(rect, count);
    let names_end = places.first().map_or(rect.right(), |first| first.left());
    let mut at = rect.left_center() + egui::vec2(theme::GAP / 2.0, 0.0);
    let size = theme::CHAMPION_THUMBNAIL;
    if let Some(picture) = picture {
        let place = egui::Rect::from_min_size(at - egui::vec2(0.0, size.y / 2.0), size);
        thumbnail(ui.painter(), place, picture, palette);
    }
    at.x += size.x + theme::GAP;
    if let Some(color) = shown.and_then(|shown| shown.color(palette)) {
        let radius = theme::LANE_DOT / 2.0;
        ui.painter().circle_filled(at + egui::vec2(radius, 0.0), radius, color);
        at.x += theme::LANE_DOT + theme::GAP / 2.0;
    }
    let mut job = LayoutJob::simple_singleline(name.to_owned(), font.clone(), palette.text);
    job.wrap = egui::text::TextWrapping::truncate_at_width(names_end - theme::GAP - at.x);
    let name = ui.painter().layout_job(job);
    ui.painter().galley(at - egui::vec2(0.0, name.size().y / 2.0), name, palette.text);
    let color = if is_shown { palette.text } else { palette.text_weak };
    for (place, text) in places.iter().zip(cells) {
        let at = egui::pos2(place.right(), place.center().y);
        ui.painter().text(at, egui::Align2::RIGHT_CENTER, text, font.clone(), color);
    }
    response
}

/// Returns the rectangles of the columns in a row, from left to right.
fn places(row: egui::Rect, count: usize) -> Vec<egui::Rect> {
    let widths = &WIDTHS[..count];
    let mut left = row.right() - theme::GAP - widths.iter().sum::<f32>();
    let place = |width: &f32| {
        let place = egui::Rect::from_x_y_ranges(left..=left + width, row.y_range());
        left += width;
        place
    };
    widths.iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_list_drops_energy_first_and_keeps_the_fitness() {
        let counts = [400.0, 320.0, 260.0, 100.0].map(count);
        assert_eq!(counts, [3, 2, 1, 1]);
        let row = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(370.0, 24.0));
        let places = places(row, 3);
        assert!(places.windows(2).all(|pair| pair[0].right() == pair[1].left()));
        assert!(places[0].left() >= NAME_WIDTH && places[2].right() < row.right());
    }
}
