//! Map of an exam's grid: rises upwards, treads to the right. Each cell shows the number of landings, also by its colour.

use bevy_egui::egui::{self, Color32};

use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::state::stairs_exams::end_in_words;
use crate::studio::ui::accessible::named;
use crate::studio::ui::text_rows::weak;
use crate::studio::ui::theme;
use crate::studio::ui::theme::palette::{ramp, text_on};
use snakes_core::score::{ExamSuite, StairsCell, StairsGrid, Trial};

/// A map of an exam's grid in the panel.
pub(super) struct StairsMap<'m> {
    pub grid: &'m StairsGrid,
    /// Title above the map.
    title: &'static str,
    /// Examined snake, as the stage shows it.
    staged: &'m StagedChampion,
    /// Rectangle of all cells, in points.
    cells: egui::Rect,
    /// Whether the labels of the rises are to the left of the map.
    has_rises: bool,
}

/// Width of the labels of the rises, in points.
const RISES_WIDTH: f32 = theme::GAP * 6.0;
/// Height of a cell, and its maximum width, in points.
const CELL_HEIGHT: f32 = theme::GAP * 3.0;
const MOST_CELL_WIDTH: f32 = theme::GAP * 8.0;
/// Height of a line of text, in points.
const LINE: f32 = theme::GAP * 2.25;
/// Distance between two maps, in points.
const APART: f32 = theme::GAP * 1.5;
/// Radius of the dot that marks the snake's own stairs, in points.
const DOT: f32 = 2.5;
/// Size of a colour sample in the legend, in points.
const SAMPLE: egui::Vec2 = egui::vec2(theme::GAP * 2.5, theme::GAP * 2.0);

impl<'m> StairsMap<'m> {
    /// Places the maps of grids of the same stairs side by side.
    pub fn side_by_side(
        ui: &mut egui::Ui,
        grids: &'m [StairsGrid],
        staged: &'m StagedChampion,
    ) -> Vec<Self> {
        let columns: usize = grids.iter().map(|grid| grid.treads_m.len()).sum();
        let rows = grids.iter().map(|grid| grid.rises_m.len()).max().unwrap_or(0);
        let gaps = APART * grids.len().saturating_sub(1) as f32;
        let room = ui.available_width() - RISES_WIDTH - gaps;
        let width = (room / columns.max(1) as f32).min(MOST_CELL_WIDTH);
        // Above the cells are the title and the count; below them the labels of the treads and their title.
        let height = CELL_HEIGHT * rows as f32 + 4.0 * LINE;
        let all = egui::vec2(ui.available_width(), height);
        let (all, _) = ui.allocate_exact_size(all, egui::Sense::hover());
        let mut left = all.left() + RISES_WIDTH;
        let map = |(index, grid): (usize, &'m StairsGrid)| {
            let at = egui::pos2(left, all.top() + 2.0 * LINE);
            let size = egui::vec2(width * grid.treads_m.len() as f32, CELL_HEIGHT * rows as f32);
            left += size.x + APART;
            let title = match grid.suite {
                ExamSuite::Lesion => "Without senses",
                _ if grids.len() > 1 => "With senses",
                _ => "On other stairs",
            };
            let cells = egui::Rect::from_min_size(at, size);
            Self { grid, title, staged, cells, has_rises: index == 0 }
        };
        grids.iter().enumerate().map(map).collect()
    }

    /// Returns the rectangle of the cell in a row, counted from the bottom, and a column, counted from the left.
    fn cell(&self, row: usize, column: usize) -> egui::Rect {
        let (rows, columns) = (self.grid.rises_m.len() as f32, self.grid.treads_m.len() as f32);
        let size = self.cells.size() / egui::vec2(columns, rows);
        let corner = egui::vec2(column as f32 * size.x, (rows - 1.0 - row as f32) * size.y);
        egui::Rect::from_min_size(self.cells.min + corner, size).shrink(0.5)
    }

    /// Draws the map. Returns the index of the clicked cell, if any.
    pub fn ui(&self, ui: &mut egui::Ui) -> Option<usize> {
        self.labels(ui);
        let mut clicked = None;
        let mut outlines = Vec::new();
        for (index, cell) in self.grid.cells.iter().enumerate() {
            let same = |values: &[f32], value: f32| values.iter().position(|of| *of == value);
            let row = same(&self.grid.rises_m, cell.rise_m);
            let Some((row, column)) = row.zip(same(&self.grid.treads_m, cell.tread_m)) else {
                continue;
            };
            let rect = self.cell(row, column);
            let id = ui.id().with(("exam", self.title, index));
            let response = ui.interact(rect, id, egui::Sense::click());
            self.draw(ui, cell, rect);
            let palette = theme::of(ui);
            if self.staged.is_on_stairs_of_exam() && cell.typical == *self.staged.trial() {
                // The accent colour would not stand out from the cells' colours.
                outlines.push((rect, palette.text));
            } else if response.hovered() || response.has_focus() {
                outlines.push((rect, palette.text_weak));
            }
            let said = format!("{}. {}", self.title, said(cell));
            let response = named(response, egui::WidgetType::Button, &said);
            if response.clicked() {
                clicked = Some(index);
            }
            response.on_hover_text(self.hover_text(cell));
        }
        // The outlines are drawn over the neighbouring cells.
        for (rect, color) in outlines {
            let stroke = egui::Stroke::new(2.0, color);
            ui.painter().rect_stroke(rect, 2.0, stroke, egui::StrokeKind::Outside);
        }
        clicked
    }

    /// Draws the title, the count and the axes of the map.
    fn labels(&self, ui: &egui::Ui) {
        let (palette, cells) = (theme::of(ui), self.cells);
        let body = egui::TextStyle::Body.resolve(ui.style());
        let top = egui::pos2(cells.left(), cells.top() - 2.0 * LINE);
        ui.painter().text(top, egui::Align2::LEFT_TOP, self.title, body, palette.text);
        let small = |x: f32, y: f32, align: egui::Align2, text: String| {
            let font = egui::FontId::proportional(theme::SMALL_SIZE);
            ui.painter().text(egui::pos2(x, y), align, text, font, palette.text_weak);
        };
        let above = cells.top() - theme::GAP / 2.0;
        let count = format!("{} of {} climbed", self.grid.landed(), self.grid.trials());
        small(cells.left(), above, egui::Align2::LEFT_BOTTOM, count);
        for (column, tread_m) in self.grid.treads_m.iter().enumerate() {
            let at = self.cell(0, column).center_bottom() + egui::vec2(0.0, theme::GAP / 4.0);
            small(at.x, at.y, egui::Align2::CENTER_TOP, tread_m.to_string());
        }
        let below = cells.bottom() + LINE - theme::GAP / 4.0;
        small(cells.center().x, below, egui::Align2::CENTER_TOP, "Tread (m)".to_owned());
        if self.has_rises {
            let right = cells.left() - theme::GAP / 2.0;
            for (row, rise_m) in self.grid.rises_m.iter().enumerate() {
                let middle = self.cell(row, 0).center().y;
                small(right, middle, egui::Align2::RIGHT_CENTER, rise_m.to_string());
            }
            small(right, above, egui::Align2::RIGHT_BOTTOM, "Rise (m)".to_owned());
        }
    }

    /// Draws a cell with its number of landings.
    fn draw(&self, ui: &egui::Ui, cell: &StairsCell, rect: egui::Rect) {
        let fill = fill(cell.landed, cell.trials);
        ui.painter().rect_filled(rect, 2.0, fill);
        let text = format!("{}/{}", cell.landed, cell.trials);
        let font = egui::TextStyle::Body.resolve(ui.style());
        ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, text, font, text_on(fill));
        if is_own(cell, &self.staged.champion().trial) {
            let at = rect.right_top() + egui::vec2(-DOT - 2.0, DOT + 2.0);
            ui.painter().circle_filled(at, DOT, text_on(fill));
        }
    }

    /// Returns the hover text of a cell.
    fn hover_text(&self, cell: &StairsCell) -> String {
        let frozen = match self.grid.suite {
            ExamSuite::Lesion => "Sight, touch and balance keep the values of the snake at rest.\n",
            _ => "",
        };
        let own = self.staged.champion().trial.stairs.first_riser_y_m;
        let further_m = cell.typical.stairs.first_riser_y_m - own;
        let place = match further_m.abs() < 0.05 {
            true => "as far away as on its own".to_owned(),
            false if further_m > 0.0 => format!("{further_m:.1} m farther away than on its own"),
            false => format!("{:.1} m nearer than on its own", -further_m),
        };
        format!(
            "{}\n{frozen}Click to watch the most typical of the {}: with the first step {place}: {}.",
            said(cell),
            cell.trials,
            end_in_words(&cell.typical_end)
        )
    }
}

/// Describes a cell in a sentence.
fn said(cell: &StairsCell) -> String {
    let StairsCell { rise_m, tread_m, trials, landed, median_steps, typical, .. } = cell;
    format!(
        "Rise {rise_m} m, tread {tread_m} m: {landed} of {trials} climbed, median {median_steps} of {} steps",
        typical.stairs.steps
    )
}

/// Returns the colour for a number of landings.
fn fill(landed: u32, trials: u32) -> Color32 {
    ramp(landed as f32 / trials.max(1) as f32)
}

/// Returns whether all steps on which a champion evolved have the rise and the tread of a cell.
fn is_own(cell: &StairsCell, own: &Trial) -> bool {
    let near = |own_m: f32, cell_m: f32| (own_m - cell_m).abs() < 1.0e-4;
    let is_like = |step| {
        near(own.stairs.step_rise_m(step), cell.rise_m)
            && near(own.stairs.step_tread_m(step), cell.tread_m)
    };
    (0..own.stairs.steps).all(is_like)
}

/// Draws the meaning of the colours and of the dot.
pub(super) fn legend(ui: &mut egui::Ui, grid: &StairsGrid, own: &Trial) {
    let trials = grid.cells.iter().map(|cell| cell.trials).max().unwrap_or(0);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = egui::vec2(theme::GAP / 2.0, theme::GAP / 2.0);
        ui.label(weak(ui, "Climbed").small());
        let gap = std::mem::take(&mut ui.spacing_mut().item_spacing.x);
        let font = egui::FontId::proportional(theme::SMALL_SIZE);
        for landed in 0..=trials {
            let (rect, _) = ui.allocate_exact_size(SAMPLE, egui::Sense::hover());
            let fill = fill(landed, trials);
            ui.painter().rect_filled(rect, 0.0, fill);
            let (at, align) = (rect.center(), egui::Align2::CENTER_CENTER);
            ui.painter().text(at, align, landed.to_string(), font.clone(), text_on(fill));
        }
        ui.spacing_mut().item_spacing.x = gap;
        ui.add_space(gap);
        ui.label(weak(ui, format!("of {trials}")).small());
        if grid.cells.iter().any(|cell| is_own(cell, own)) {
            ui.add_space(theme::GAP);
            let size = egui::vec2(DOT * 2.0, SAMPLE.y);
            let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
            ui.painter().circle_filled(rect.center(), DOT, theme::of(ui).text_weak);
            let words = weak(ui, "its own rise and tread").small();
            ui.add(egui::Label::new(words).extend());
        }
    });
}
