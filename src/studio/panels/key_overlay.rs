//! All keys, over the window.

use bevy_egui::egui;

use crate::studio::actions::{ACTIONS, Menu};
use crate::studio::command::Command;
use crate::studio::look;

/// What the mouse does on the stage.
const MOUSE: [(&str, &str); 6] = [
    ("Click", "A limb's numbers"),
    ("Drag", "Turn the camera; on a limb, pull it"),
    ("Right drag", "Move the camera"),
    ("Wheel", "Nearer, further"),
    ("Double click", "Look at what is there"),
    ("Drop a file", "Import it"),
];

/// Draws the keys and adds what was asked for.
pub(super) fn key_overlay(context: &egui::Context, asked: &mut Vec<Command>) {
    let palette = look::of_context(context);
    let screen = context.content_rect();
    let modal = egui::Modal::new(egui::Id::new("keys")).frame(palette.dialog());
    // As many columns as there is room for.
    let room = screen.width() - look::GAP * 8.0;
    let columns = ((room / look::KEY_COLUMN_WIDTH) as usize).clamp(1, 3);
    let shown = modal.show(context, |ui| {
        ui.set_width(room.min(columns as f32 * look::KEY_COLUMN_WIDTH));
        ui.horizontal(|ui| {
            ui.label(egui::RichText::new("Keys and mouse").size(look::HEADING_SIZE).strong());
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("Close").on_hover_text("Esc or ?").clicked() {
                    asked.push(Command::Uncover);
                }
            });
        });
        ui.label(
            egui::RichText::new("Ctrl K finds any of these by name.").color(palette.text_weak),
        );
        ui.add_space(look::GAP);
        let height = screen.height() - look::GAP * 16.0;
        let area = egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height);
        area.show(ui, |ui| {
            let groups = groups();
            ui.columns(columns, |places| {
                for (ui, column) in places.iter_mut().zip(spread(&groups, columns)) {
                    // Lines of text, not of buttons.
                    ui.spacing_mut().interact_size.y = look::GAP * 2.0;
                    column.iter().for_each(|group| draw(ui, group));
                }
            });
        });
    });
    if shown.backdrop_response.clicked() {
        asked.push(Command::Uncover);
    }
}

/// A group's name, and its keys with what they do.
struct Group {
    name: &'static str,
    keys: Vec<(&'static str, &'static str)>,
}

/// The groups in their order, the mouse last.
fn groups() -> Vec<Group> {
    let of = |menu: Menu| {
        let with_key = |action: &&crate::studio::actions::Action| {
            action.menu == menu && !action.keys.is_empty()
        };
        let keys = ACTIONS.iter().filter(with_key).map(|action| (action.key(), action.name));
        Group { name: menu.name(), keys: keys.collect() }
    };
    let mut groups: Vec<Group> = Menu::ALL.map(of).into_iter().collect();
    groups.push(Group { name: "Mouse", keys: MOUSE.to_vec() });
    groups
}

/// The groups in columns of about equal length, their order kept.
fn spread(groups: &[Group], columns: usize) -> Vec<&[Group]> {
    // A name takes the room of two lines.
    let length = |group: &Group| group.keys.len() + 2;
    let all: usize = groups.iter().map(length).sum();
    let mut found = Vec::new();
    let mut rest = groups;
    for column in (1..=columns).rev() {
        let goal = rest.iter().map(length).sum::<usize>().min(all).div_ceil(column);
        let mut used = 0;
        let taken = rest.iter().take_while(|group| {
            let is_first = used == 0;
            used += length(group);
            is_first || used <= goal + 3
        });
        let count = if column == 1 { rest.len() } else { taken.count() };
        let (these, others) = rest.split_at(count);
        found.push(these);
        rest = others;
    }
    found
}

fn draw(ui: &mut egui::Ui, group: &Group) {
    let palette = look::of(ui);
    ui.label(egui::RichText::new(group.name).size(look::TITLE_SIZE).strong());
    let spacing = [look::GAP * 1.5, look::GAP / 2.0];
    egui::Grid::new(group.name).num_columns(2).spacing(spacing).show(ui, |ui| {
        for (key, effect) in &group.keys {
            ui.label(egui::RichText::new(*key).color(palette.accent));
            ui.label(*effect);
            ui.end_row();
        }
    });
    ui.add_space(look::GAP);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_action_with_a_key_is_listed_whatever_the_number_of_columns() {
        let with_keys = ACTIONS.iter().filter(|action| !action.keys.is_empty()).count();
        let groups = groups();
        for columns in 1..=3 {
            let spread = spread(&groups, columns);
            assert_eq!(spread.len(), columns);
            let listed: usize =
                spread.iter().flat_map(|of| of.iter()).map(|of| of.keys.len()).sum();
            assert_eq!(listed, with_keys + MOUSE.len(), "{columns} columns");
        }
    }
}
