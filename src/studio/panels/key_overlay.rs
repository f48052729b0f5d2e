//! All keys, over the window.

use bevy_egui::egui;

use crate::studio::actions::{ACTIONS, Menu};
use crate::studio::command::Command;
use crate::studio::look;

/// What the mouse does on the stage.
const MOUSE: [(&str, &str); 6] = [
    ("Click", "a limb's numbers"),
    ("Drag", "turn the camera; on a limb, pull it"),
    ("Right drag", "move the camera"),
    ("Wheel", "nearer, further"),
    ("Double click", "look at what is there"),
    ("Drop a file", "import it"),
];

/// Draws the keys and adds what was asked for.
pub(super) fn key_overlay(context: &egui::Context, asked: &mut Vec<Command>) {
    let palette = look::of_context(context);
    let screen = context.content_rect();
    let modal = egui::Modal::new(egui::Id::new("keys")).frame(palette.card(palette.field_hovered));
    let shown = modal.show(context, |ui| {
        ui.set_max_width(screen.width() - look::GAP * 8.0);
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
        let most_height = screen.height() - look::GAP * 16.0;
        egui::ScrollArea::both().max_height(most_height).show(ui, |ui| {
            // As many columns as there is room for.
            let columns = ((screen.width() / look::KEY_COLUMN_WIDTH) as usize).clamp(1, 3);
            let groups = groups();
            ui.horizontal_top(|ui| {
                for column in spread(&groups, columns) {
                    ui.vertical(|ui| column.iter().for_each(|group| draw(ui, group)));
                    ui.add_space(look::GAP * 2.0);
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
    let spacing = [look::GAP * 2.0, look::GAP / 4.0];
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
