//! List of all keyboard shortcuts, shown over the window.

use bevy_egui::egui;

use crate::studio::commands::actions::{Action, Menu, actions};
use crate::studio::commands::{Command, WindowCommand};
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::text_rows::{at_right, explain, title_text};
use crate::studio::ui::theme;

/// Mouse actions on the stage, each with its effect.
const MOUSE: [(&str, &str); 6] = [
    ("Click", "Show a block's numbers"),
    ("Drag", "Turn the camera; on a block, pull the block"),
    ("Right drag", "Move the camera"),
    ("Wheel", "Zoom"),
    ("Double click", "Centre the camera there"),
    ("Drop a file", "Import a champion or a run"),
];

/// Draws the list over the window, and sends the user's commands.
pub(crate) fn key_overlay(context: &egui::Context) {
    let screen = context.content_rect();
    let frame = theme::of_context(context).dialog();
    let modal = egui::Modal::new(egui::Id::new("keys")).frame(frame);
    let room = screen.width() - theme::GAP * 8.0;
    let columns = ((room / theme::KEY_COLUMN_WIDTH) as usize).clamp(1, 3);
    let shown = modal.show(context, |ui| {
        ui.set_width(room.min(columns as f32 * theme::KEY_COLUMN_WIDTH));
        ui.horizontal(|ui| {
            ui.label(egui::RichText::new("Keyboard and mouse").size(theme::HEADING_SIZE).strong());
            at_right(ui, |ui| {
                let close = Command::Window(WindowCommand::CloseModal);
                CommandButton::new("Close", "Esc or ?", close).show(ui);
            });
        });
        explain(ui, "Press Ctrl K to search all commands by name.");
        ui.add_space(theme::GAP);
        let height = screen.height() - theme::GAP * 16.0;
        let area = egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height);
        area.show(ui, |ui| {
            let groups = groups();
            ui.columns(columns, |places| {
                for (ui, column) in places.iter_mut().zip(in_columns(&groups, columns)) {
                    // Rows of text need less height than those with buttons.
                    ui.spacing_mut().interact_size.y = theme::GAP * 2.0;
                    column.iter().for_each(|group| draw(ui, group));
                }
            });
        });
    });
    if shown.backdrop_response.clicked() {
        Command::Window(WindowCommand::CloseModal).send(context);
    }
}

/// A group of shortcuts, each with its effect.
struct KeyGroup {
    name: &'static str,
    keys: Vec<(&'static str, &'static str)>,
}

/// Returns the groups in the order of the menus, followed by the mouse actions.
fn groups() -> Vec<KeyGroup> {
    let of = |menu: Menu| {
        let with_key = |action: &&Action| action.menu == menu && !action.keys.is_empty();
        let keys = actions().iter().filter(with_key).map(|action| (action.key(), action.name));
        KeyGroup { name: menu.name(), keys: keys.collect() }
    };
    let mut groups: Vec<KeyGroup> = Menu::ALL.map(of).into();
    groups.retain(|group| !group.keys.is_empty());
    groups.push(KeyGroup { name: "Mouse", keys: MOUSE.to_vec() });
    groups
}

/// Distributes the groups over columns of about equal length, in order.
fn in_columns(groups: &[KeyGroup], columns: usize) -> Vec<&[KeyGroup]> {
    // A heading is as high as two rows.
    let length = |group: &KeyGroup| group.keys.len() + 2;
    let mut found = Vec::new();
    let mut rest = groups;
    for column in (1..=columns).rev() {
        let goal = rest.iter().map(length).sum::<usize>().div_ceil(column);
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

fn draw(ui: &mut egui::Ui, group: &KeyGroup) {
    let palette = theme::of(ui);
    ui.label(title_text(group.name));
    let spacing = [theme::GAP * 1.5, theme::GAP / 2.0];
    egui::Grid::new(group.name).num_columns(2).spacing(spacing).show(ui, |ui| {
        for (key, effect) in &group.keys {
            ui.label(egui::RichText::new(*key).color(palette.accent));
            ui.label(*effect);
            ui.end_row();
        }
    });
    ui.add_space(theme::GAP);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a24_every_shortcut_is_listed_and_no_heading_is_empty_for_any_number_of_columns() {
        let with_keys = actions().iter().filter(|action| !action.keys.is_empty()).count();
        let groups = groups();
        assert!(groups.iter().all(|group| !group.keys.is_empty()), "a24: a heading without keys");
        for columns in 1..=3 {
            let in_columns = in_columns(&groups, columns);
            assert_eq!(in_columns.len(), columns);
            let listed: usize =
                in_columns.iter().flat_map(|of| of.iter()).map(|of| of.keys.len()).sum();
            assert_eq!(listed, with_keys + MOUSE.len(), "{columns} columns");
        }
    }
}
