//! Over the list: title, search, and what it is sorted by.

use bevy_egui::egui::{self, Key as Press, Sense};

use super::fields::{Wanted, label};
use super::order::{Key, Sort};
use super::row::column;
use super::{LibraryPanel, send};
use crate::studio::command::Command;
use crate::studio::library::{Ask, Library};
use crate::studio::look;
use crate::studio::panels::title_and;

impl LibraryPanel {
    /// Title, search and what it is sorted by.
    pub(super) fn over(&mut self, ui: &mut egui::Ui, library: &Library, asked: &mut Vec<Command>) {
        title_and(ui, "Library", |ui| {
            let hint = format!("Look at the folder again: {}", library.folder().display());
            let refresh = egui::Button::new("Refresh").small();
            if ui.add(refresh).on_hover_text(hint).clicked() {
                send(asked, Ask::Look);
            }
            let import = egui::Button::new("Import").small();
            let hint = "Copy a champion or a run in from anywhere; or drop files into the window";
            if ui.add(import).on_hover_text(hint).clicked() {
                self.ask_for(Wanted::Import, String::new());
            }
            for (name, keys, last, ask) in [
                ("Redo", "Ctrl Shift Z", library.redoable(), Ask::Redo),
                ("Undo", "Ctrl Z", library.undoable(), Ask::Undo),
            ] {
                let Some(last) = last else { continue };
                let button = egui::Button::new(name).small();
                let hint = format!("{name}: {last} ({keys})");
                if ui.add(button).on_hover_text(hint).clicked() {
                    send(asked, ask);
                }
            }
        });
        under_way(ui, library, asked);
        let field = egui::TextEdit::singleline(&mut self.search)
            .hint_text("Search name, preset, controller, \"damaged\"")
            .desired_width(f32::INFINITY)
            .margin(egui::Margin::symmetric(8, 4));
        let response = ui.add(field);
        label(ui, &response, "Search the library");
        // From the field straight into the list.
        let is_left = response.lost_focus();
        let is_in_it = response.has_focus();
        // The key is the field's: the list would take it for a wish to replay.
        self.wants_keyboard |= ui.input_mut(|input| {
            let mut pressed = |key| input.consume_key(egui::Modifiers::NONE, key);
            (is_left && pressed(Press::Enter)) || (is_in_it && pressed(Press::ArrowDown))
        });
        if ui.available_width() < look::COLUMNS_WIDTH {
            self.sort_by(ui);
        } else {
            self.columns(ui);
        }
    }

    fn sort_by(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            let name = ui.label("Sort by");
            let choice = egui::ComboBox::from_id_salt("sort").selected_text(self.sort.key.name());
            let list = choice.width(look::FIELD_WIDTH).show_ui(ui, |ui| {
                for key in Key::ALL {
                    if ui.selectable_label(self.sort.key == key, key.name()).clicked() {
                        self.sort = Sort::by(key);
                    }
                }
            });
            list.response.labelled_by(name.id);
            let direction = if self.sort.is_descending { "Descending" } else { "Ascending" };
            if ui.button(direction).on_hover_text("The other way round").clicked() {
                self.sort = self.sort.reversed();
            }
        });
    }

    fn columns(&mut self, ui: &mut egui::Ui) {
        let size = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
        let (line, _) = ui.allocate_exact_size(size, Sense::hover());
        for key in Key::ALL {
            let is_key = self.sort.key == key;
            // Room for the sign of the direction, which no font has for certain.
            let name = if is_key { format!("{}    ", key.name()) } else { key.name().to_owned() };
            let button = egui::Button::new(name).selected(is_key).small();
            let place = column(line.expand2(egui::vec2(0.0, 4.0)), key);
            let builder = egui::UiBuilder::new()
                .max_rect(place)
                .layout(egui::Layout::left_to_right(egui::Align::Center));
            let response = ui.new_child(builder).add(button);
            if is_key {
                let right = response.rect.right_center() - egui::vec2(look::GAP * 1.75, 0.0);
                let (wide, high) = if self.sort.is_descending { (4.0, 3.0) } else { (-4.0, -3.0) };
                let corners = [[-wide, -high], [wide, -high], [0.0, high]];
                let points = corners.map(|[x, y]| right + egui::vec2(x, y)).to_vec();
                let color = look::of(ui).text;
                ui.painter().add(egui::Shape::convex_polygon(points, color, egui::Stroke::NONE));
            }
            label(ui, &response, &format!("Sort by {}", key.name().to_lowercase()));
            if response.on_hover_text("Sort by it; again for the other way round").clicked() {
                self.sort = self.sort.clicked(key);
            }
        }
    }
}

/// What is being done with many saves, how far that is, and a button that ends it.
fn under_way(ui: &mut egui::Ui, library: &Library, asked: &mut Vec<Command>) {
    for (words, share) in library.under_way() {
        ui.horizontal(|ui| {
            let hint = "Stop after the file that is being worked on; what is done stays, and can be undone";
            if ui.button("Cancel").on_hover_text(hint).clicked() {
                send(asked, Ask::Cancel);
            }
            ui.add(egui::ProgressBar::new(share).text(words));
        });
    }
}
