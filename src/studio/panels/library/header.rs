//! Header of the list: title, search field and sort order.

use bevy_egui::egui::{self, Key as Press, Sense, WidgetType};

use super::LibraryPanel;
use super::order::{SortKey, SortOrder};
use super::row::column;
use crate::studio::commands::Command;
use crate::studio::commands::files::{FileCommand, FileQuestion};
use crate::studio::commands::library::LibraryCommand;
use crate::studio::panels::undo_buttons::undo_buttons;
use crate::studio::state::library::Library;
use crate::studio::state::undo::UndoHistory;
use crate::studio::ui::accessible::{named, named_selected};
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::text_rows::{cancellable_progress, text_field, title_and};
use crate::studio::ui::theme;

impl LibraryPanel {
    /// Draws the title, the search field and the sort order.
    pub(super) fn header(&mut self, ui: &mut egui::Ui, library: &Library, history: &UndoHistory) {
        title_and(ui, "Library", |ui| {
            let hint = format!("Read the folder again: {}", library.saves.path().display());
            let refresh = Command::Library(LibraryCommand::Refresh);
            CommandButton::new("Refresh", hint, refresh).small().show(ui);
            let hint =
                "Copy champions or a run into the library; you can also drop files onto the window";
            let import = Command::File(FileCommand::Ask(FileQuestion::Import));
            CommandButton::new("Import", hint, import).small().show(ui);
            undo_buttons(ui, history);
        });
        batch_progress(ui, library);
        let field = text_field(&mut self.search)
            .hint_text("Search name, notes, preset, controller, \"damaged\"")
            .desired_width(f32::INFINITY);
        let response = named(ui.add(field), WidgetType::TextEdit, "Search the library");
        // Enter and Down move the focus from the search field to the list.
        let is_left = response.lost_focus();
        let is_in_it = response.has_focus();
        // The key is consumed, because the list would otherwise replay the selected save on Enter.
        self.wants_keyboard |= ui.input_mut(|input| {
            let mut pressed = |key| input.consume_key(egui::Modifiers::NONE, key);
            (is_left && pressed(Press::Enter)) || (is_in_it && pressed(Press::ArrowDown))
        });
        if ui.available_width() < theme::COLUMNS_WIDTH {
            self.sort_by(ui);
        } else {
            self.columns(ui);
        }
    }

    fn sort_by(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            let name = ui.label("Sort by");
            let choice = egui::ComboBox::from_id_salt("sort").selected_text(self.sort.key.name());
            let list = choice.width(theme::FIELD_WIDTH).show_ui(ui, |ui| {
                for key in SortKey::ALL {
                    if ui.selectable_label(self.sort.key == key, key.name()).clicked() {
                        self.sort = SortOrder::by(key);
                    }
                }
            });
            list.response.labelled_by(name.id);
            let direction = if self.sort.is_descending { "Descending" } else { "Ascending" };
            if ui.button(direction).on_hover_text("Reverse the order").clicked() {
                self.sort = self.sort.reversed();
            }
        });
    }

    fn columns(&mut self, ui: &mut egui::Ui) {
        let size = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
        let (line, _) = ui.allocate_exact_size(size, Sense::hover());
        for key in SortKey::ALL {
            let is_key = self.sort.key == key;
            // The spaces reserve room for the arrow of the direction, which is painted, because not every font contains it.
            let name = if is_key { format!("{}    ", key.name()) } else { key.name().to_owned() };
            let button = egui::Button::new(name).selected(is_key).small();
            let place = column(line.expand2(egui::vec2(0.0, 4.0)), key);
            let builder = egui::UiBuilder::new()
                .max_rect(place)
                .layout(egui::Layout::left_to_right(egui::Align::Center));
            let response = ui.new_child(builder).add(button);
            if is_key {
                let right = response.rect.right_center() - egui::vec2(theme::GAP * 1.75, 0.0);
                let (wide, high) = if self.sort.is_descending { (4.0, 3.0) } else { (-4.0, -3.0) };
                let corners = [[-wide, -high], [wide, -high], [0.0, high]];
                let points = corners.map(|[x, y]| right + egui::vec2(x, y)).to_vec();
                let color = theme::of(ui).text;
                ui.painter().add(egui::Shape::convex_polygon(points, color, egui::Stroke::NONE));
            }
            let name = format!("Sort by {}", key.name().to_lowercase());
            let response = named_selected(response, WidgetType::Button, is_key, &name);
            let hint = "Sort by this column; click again to reverse the order";
            if response.on_hover_text(hint).clicked() {
                self.sort = self.sort.clicked(key);
            }
        }
    }
}

/// Draws the progress of operations on many saves and of an exam, with buttons that cancel them.
fn batch_progress(ui: &mut egui::Ui, library: &Library) {
    let of_files = "Stop after the current file. Undo reverses the finished part";
    let of_exam = "Stop the exam. The results of finished champions are kept";
    let files = library.under_way().map(|progress| (progress, of_files));
    let exam = library.exam_under_way().map(|progress| (progress, of_exam));
    for ((words, share), hint) in files.chain(exam) {
        cancellable_progress(ui, (hint, Command::Library(LibraryCommand::Cancel)), share, &words);
    }
}
