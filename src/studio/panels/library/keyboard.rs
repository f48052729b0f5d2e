//! Keyboard control of the list.

use bevy_egui::egui::{self, Key as Press, Modifiers};

use super::LibraryPanel;
use crate::studio::commands::{Command, PlayerCommand};
use crate::studio::state::library::Library;

/// Number of rows by which Page Up and Page Down move the cursor.
const PAGE_ROWS: usize = 10;

impl LibraryPanel {
    /// Handles key presses while the list has the focus.
    pub(super) fn keys(&mut self, ui: &egui::Ui, library: &Library) {
        let (held, pressed) = ui.input(|input| {
            let of = |event: &egui::Event| match event {
                egui::Event::Key { key, pressed: true, .. } => Some(*key),
                _ => None,
            };
            (input.modifiers, input.events.iter().filter_map(of).collect::<Vec<Press>>())
        });
        for key in pressed {
            self.update_actions(library);
            let is_letter = matches!(key, Press::A | Press::D);
            if is_letter && !held.command {
                continue;
            }
            if key == Press::Space {
                // The list has no use for Space, and a click into it must not take Space from the stage.
                Command::Player(PlayerCommand::Toggle).send(ui);
                continue;
            }
            if key == Press::A {
                let rows = self.order.rows.clone();
                self.selection.all(rows.iter().map(|row| library.items[*row].place()));
                continue;
            }
            let Some(action) = self.actions.1.iter().find(|action| action.key == Some(key)) else {
                self.move_cursor(key, held, library);
                continue;
            };
            let (wanted, refusal) = (Some(action.act.clone()), action.refusal);
            match refusal {
                None => self.act(ui, wanted, library),
                // For a disabled action, its reason is shown.
                Some(why) if matches!(key, Press::F2 | Press::Delete) => {
                    Command::Notify(format!("{why}.")).send(ui);
                }
                Some(_) => {}
            }
        }
    }

    /// Moves the cursor by a key. With Shift, extends the selected range.
    fn move_cursor(&mut self, key: Press, held: Modifiers, library: &Library) {
        let rows = self.order.rows.clone();
        let Some(last) = rows.len().checked_sub(1) else { return };
        let place_of = |row: usize| library.items[rows[row]].place();
        let now = self
            .selection
            .cursor
            .as_ref()
            .and_then(|cursor| (0..rows.len()).find(|row| place_of(*row) == cursor));
        let next = match (key, now) {
            (Press::Home, _) => 0,
            (Press::End, _) => last,
            (Press::ArrowDown | Press::ArrowUp | Press::PageDown | Press::PageUp, None) => 0,
            (Press::ArrowDown, Some(now)) => now + 1,
            (Press::ArrowUp, Some(now)) => now.saturating_sub(1),
            (Press::PageDown, Some(now)) => now + PAGE_ROWS,
            (Press::PageUp, Some(now)) => now.saturating_sub(PAGE_ROWS),
            _ => return,
        };
        let place = place_of(next.min(last)).clone();
        if held.shift {
            self.selection.extend(&place, rows.iter().map(|row| library.items[*row].place()));
        } else {
            self.selection.only(&place);
        }
        self.scroll_to = Some(place);
    }
}
