//! Keyboard control of the list.

use bevy_egui::egui;
use bevy_egui::egui::{Key as Press, Modifiers};

use super::LibraryPanel;
use super::actions::LibraryActionKind;
use crate::studio::commands::Command;
use crate::studio::commands::library::LibraryCommand;
use crate::studio::state::library::Library;

/// Number of rows that Page Up and Page Down move.
const PAGE_ROWS: usize = 10;

impl LibraryPanel {
    /// Handles key presses while the list has the focus.
    pub(super) fn keys(&mut self, ui: &egui::Ui, library: &Library, commands: &mut Vec<Command>) {
        let (held, pressed) = ui.input(|input| {
            let of = |event: &egui::Event| match event {
                egui::Event::Key { key, pressed: true, .. } => Some(*key),
                _ => None,
            };
            (input.modifiers, input.events.iter().filter_map(of).collect::<Vec<Press>>())
        });
        for key in pressed {
            self.update_actions(library);
            let acts = |is_match: fn(&LibraryActionKind) -> bool| {
                let possible = self.actions.1.iter().filter(|action| action.refusal.is_none());
                possible.map(|action| &action.act).find(|act| is_match(act)).cloned()
            };
            // A disabled action reports why it is disabled.
            let refused = |is_match: fn(&LibraryActionKind) -> bool| {
                let of = self.actions.1.iter().find(|action| is_match(&action.act));
                of.and_then(|action| action.refusal)
            };
            let why = match key {
                Press::F2 => refused(|act| matches!(act, LibraryActionKind::Rename(_))),
                Press::Delete => refused(LibraryActionKind::deletes),
                _ => None,
            };
            commands.extend(why.map(|why| Command::Notify(format!("{why}."))));
            let wanted = match key {
                Press::Enter => acts(|act| {
                    matches!(
                        act,
                        LibraryActionKind::Send(Command::Library(
                            LibraryCommand::Replay(_) | LibraryCommand::Race(_)
                        ))
                    )
                }),
                Press::F2 => acts(|act| matches!(act, LibraryActionKind::Rename(_))),
                Press::Delete => acts(LibraryActionKind::deletes),
                Press::D if held.command => acts(|act| {
                    matches!(
                        act,
                        LibraryActionKind::Send(Command::Library(LibraryCommand::Duplicate(_)))
                    )
                }),
                Press::A if held.command => {
                    let rows = self.order.rows();
                    self.selection.all(rows.iter().map(|row| library.items()[*row].place()));
                    None
                }
                _ => {
                    self.move_cursor(key, held, library);
                    None
                }
            };
            self.act(wanted, library, commands);
        }
    }

    /// Moves the cursor. Shift extends the selected range.
    fn move_cursor(&mut self, key: Press, held: Modifiers, library: &Library) {
        let rows = self.order.rows();
        let Some(last) = rows.len().checked_sub(1) else { return };
        let place_of = |row: usize| library.items()[rows[row]].place();
        let now = self
            .selection
            .cursor()
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
            self.selection.extend(&place, rows.iter().map(|row| library.items()[*row].place()));
        } else {
            self.selection.only(&place);
        }
        self.scroll_to = Some(place);
    }
}
