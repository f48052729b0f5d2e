//! Map of the MAP-Elites archive: a cell per kind of behaviour, coloured by fitness. A click replays the elite.

use bevy_egui::egui;

use super::archive_pictures::ArchivePictures;
use super::legend::click_hint;
use crate::studio::commands::pick::Pick;
use crate::studio::commands::{Command, StageCommand};
use crate::studio::panels::shown::ShownLane;
use crate::studio::ui::plot_axes::{number, y_title};
use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;
use snakes_core::evolve::{Archive, ArchiveAxis, Elite};

/// Draws the archive `height` points high and collects the user's commands. `unit` is the unit of the fitness.
pub(crate) fn archive_map(
    ui: &mut egui::Ui,
    archive: &Archive,
    unit: &str,
    pictures: &ArchivePictures,
    shown: &[ShownLane],
    height: f32,
    commands: &mut Vec<Command>,
) {
    let cells = archive.cells();
    let (elites, percent) = (archive.elites().len(), archive.coverage() * 100.0);
    let score = number(archive.qd_score());
    let floor = number(f64::from(archive.floor));
    ui.label(format!("Coverage {percent:.0} % ({elites} of {cells} cells), QD score {score}"))
        .on_hover_text(format!(
            "Quality-diversity score: fitness above {floor}{unit}, summed over all cells"
        ));
    let fitness = archive.elites().map(|(_, elite)| elite.fitness);
    let (min, max) = fitness.fold((f32::MAX, f32::MIN), |(l, m), x| (l.min(x), m.max(x)));
    if min > max {
        return explain(ui, "All snakes so far were disqualified.");
    }
    click_hint(ui, "Click a coloured cell to replay its snake.");
    y_title(ui, archive.y.label);
    let size = egui::vec2(ui.available_width(), height);
    let (area, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    let map =
        egui::Rect::from_min_max(egui::pos2(area.left() + LABELS_WIDTH, area.top()), area.max);
    let response = ui.interact(map, ui.id().with("archive"), egui::Sense::click());
    let palette = theme::of(ui);
    let painter = ui.painter();
    painter.rect_filled(map, 0.0, palette.empty_cell);
    for (cell, elite) in archive.elites() {
        let share = (elite.fitness - min) / (max - min).max(f32::MIN_POSITIVE);
        let (rect, color) = (cell_rect(map, archive, cell), theme::palette::ramp(share));
        painter.rect_filled(rect, 0.0, color);
        pictures.draw(painter, cell, rect, color);
    }
    let on_stage = shown.iter().filter_map(|shown| {
        let is_it = |of: &Elite| shown.champion.is(of.generation, of.individual);
        let (cell, _) = archive.elites().find(|(_, elite)| is_it(elite))?;
        Some((cell, shown.color(palette).unwrap_or(palette.text)))
    });
    let hovered = response.hover_pos().and_then(|at| cell_at(map, archive, at));
    let hovered_elite = hovered.filter(|cell| archive.elite(*cell).is_some());
    let hovered_one = hovered_elite.map(|cell| (cell, palette.text_weak));
    for (cell, color) in hovered_one.into_iter().chain(on_stage) {
        let stroke = egui::Stroke::new(2.0, color);
        let rect = cell_rect(map, archive, cell);
        painter.rect_stroke(rect, 0.0, stroke, egui::StrokeKind::Outside);
    }
    let line = egui::TextStyle::Small.resolve(ui.style()).size + 2.0;
    let (below, _) = ui.allocate_exact_size(egui::vec2(area.width(), line), egui::Sense::hover());
    let [[x_from, x_to], [y_from, y_to]] =
        [archive.x, archive.y].map(|axis| axis.range.map(number));
    let left = map.left() - theme::GAP / 2.0;
    let y = below.top();
    for (x, y, anchor, text) in [
        (left, map.top(), egui::Align2::RIGHT_TOP, y_to),
        (left, map.bottom(), egui::Align2::RIGHT_BOTTOM, y_from),
        (map.left(), y, egui::Align2::LEFT_TOP, x_from),
        (map.right(), y, egui::Align2::RIGHT_TOP, x_to),
        (map.center().x, y, egui::Align2::CENTER_TOP, archive.x.label.to_owned()),
    ] {
        small_label(ui, egui::pos2(x, y), anchor, &text);
    }
    colour_scale(ui, map.x_range(), [min, max], unit);

    response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Other, true, "Map"));
    if response.clicked() {
        commands.extend(
            hovered_elite.map(|cell| Command::Stage(StageCommand::Show(Pick::Elite(cell)))),
        );
    }
    if let Some(cell) = hovered {
        response.on_hover_ui_at_pointer(|ui| {
            pictures.large(ui, cell);
            ui.label(hover_text(archive, cell, unit));
        });
    }
}

/// Width of the axis labels at the left, in points.
const LABELS_WIDTH: f32 = 36.0;

/// Draws a small label.
fn small_label(ui: &egui::Ui, at: egui::Pos2, anchor: egui::Align2, text: &str) {
    let small = egui::TextStyle::Small.resolve(ui.style());
    ui.painter().text(at, anchor, text, small, theme::of(ui).text_weak);
}

/// Draws the colour scale.
fn colour_scale(ui: &mut egui::Ui, x: egui::Rangef, [min, max]: [f32; 2], unit: &str) {
    let small = egui::TextStyle::Small.resolve(ui.style());
    let size = egui::vec2(ui.available_width(), small.size + 2.0);
    let (area, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    let (left, right) = (x.min + x.span() * 0.3, x.max - x.span() * 0.2);
    let painter = ui.painter();
    let shades = 48;
    let width = (right - left) / shades as f32;
    for shade in 0..shades {
        let at = left + width * shade as f32;
        let rect = egui::Rect::from_x_y_ranges(at..=at + width + 0.5, area.y_range());
        painter.rect_filled(rect, 0.0, theme::palette::ramp(shade as f32 / (shades - 1) as f32));
    }
    let middle = area.center().y;
    let gap = theme::GAP / 2.0;
    let low = format!("Fitness {}", number(f64::from(min)));
    let high = format!("{}{unit}", number(f64::from(max)));
    small_label(ui, egui::pos2(left - gap, middle), egui::Align2::RIGHT_CENTER, &low);
    small_label(ui, egui::pos2(right + gap, middle), egui::Align2::LEFT_CENTER, &high);
}

/// Cell at a screen position. The first row is at the bottom.
fn cell_at(map: egui::Rect, archive: &Archive, at: egui::Pos2) -> Option<u32> {
    if !map.contains(at) {
        return None;
    }
    let place = |share: f32, cells: u32| ((share * cells as f32) as u32).min(cells - 1);
    let column = place((at.x - map.left()) / map.width(), archive.x.cells);
    let row = place((map.bottom() - at.y) / map.height(), archive.y.cells);
    Some(row * archive.x.cells + column)
}

fn cell_rect(map: egui::Rect, archive: &Archive, cell: u32) -> egui::Rect {
    let size = map.size() / egui::vec2(archive.x.cells as f32, archive.y.cells as f32);
    let [column, row] = archive.place(cell);
    let corner =
        egui::pos2(map.left() + size.x * column as f32, map.bottom() - size.y * (row + 1) as f32);
    // A thin gap separates cells if they are large enough.
    let gap = if size.min_elem() > 6.0 { 0.5 } else { 0.0 };
    egui::Rect::from_min_size(corner, size).shrink(gap)
}

/// Hover text of a cell.
fn hover_text(archive: &Archive, cell: u32, unit: &str) -> String {
    let span = |axis: ArchiveAxis, place: u32| {
        let [from, to] = axis.ends(place).map(number);
        let values = if from == to { from } else { format!("{from} to {to}") };
        format!("{}: {values}\n", axis.label)
    };
    let [column, row] = archive.place(cell);
    let kind = span(archive.x, column) + &span(archive.y, row);
    match archive.elite(cell) {
        Some(elite) => format!(
            "{kind}Fitness {:.2}{unit}\nGeneration {}, snake {}\nClick to replay",
            elite.fitness,
            elite.generation,
            elite.individual + 1
        ),
        None => kind + "Empty",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::explored_run;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;
    use snakes_core::evolve::Descriptor;

    /// Commands sent by a click in the middle of a cell, and whether the hover text calls it empty.
    fn clicked(archive: &Archive, cell: u32) -> (Vec<Command>, bool) {
        let size = egui::vec2(theme::PANEL_WIDTH, 500.0);
        let mut harness = Harness::builder().with_size(size).build_ui_state(
            |ui, commands| {
                let pictures = ArchivePictures::default();
                archive_map(ui, archive, " m", &pictures, &[], theme::MAP_HEIGHT, commands);
            },
            Vec::new(),
        );
        harness.run();
        let map = harness.get_by_label("Map").rect();
        let at = cell_rect(map, archive, cell).center();
        harness.drag_at(at);
        harness.run();
        harness.drop_at(at);
        harness.run();
        harness.hover_at(at + egui::vec2(1.0, 0.0));
        harness.run();
        let is_empty = harness.query_by_label_contains("Empty").is_some();
        (harness.state().clone(), is_empty)
    }

    #[test]
    fn a_click_on_a_cell_replays_its_elite_and_an_empty_cell_does_nothing() {
        let run = explored_run();
        let exploration = run.exploration().expect("explored");
        let archive = exploration.archive.as_ref().expect("MAP-Elites keeps one");
        let (cell, _) = archive.elites().next().expect("an elite");
        assert_eq!(
            clicked(archive, cell),
            (vec![Command::Stage(StageCommand::Show(Pick::Elite(cell)))], false)
        );
        let cells = archive.cells();
        let empty = (0..cells).find(|cell| archive.elite(*cell).is_none()).expect("an empty cell");
        assert_eq!(clicked(archive, empty), (vec![], true));
    }

    #[test]
    fn a_click_in_a_drawn_cell_hits_that_cell() {
        let x = ArchiveAxis::of(Descriptor::BodyHeight, 7);
        let archive: Archive = Archive::new(x, ArchiveAxis::of_numbers("Blocks", 2..=6), 0.0);
        let map = egui::Rect::from_min_size(egui::pos2(10.0, 20.0), egui::vec2(250.0, 250.0));
        for cell in 0..35 {
            let drawn = cell_rect(map, &archive, cell);
            assert_eq!(cell_at(map, &archive, drawn.center()), Some(cell));
        }
        assert_eq!(cell_at(map, &archive, egui::pos2(0.0, 0.0)), None);
    }
}
