//! The keys of the list: all that the mouse can do.

use bevy_egui::egui::{self, Key as Press, Modifiers};

use super::LibraryPanel;
use super::actions::Act;
use crate::studio::command::Command;
use crate::studio::library::{Ask, Library};

/// How many rows a page is, for the keys that turn pages.
const PAGE: usize = 10;

impl LibraryPanel {
    /// What keys ask for while the list has the keyboard.
    pub(super) fn keys(&mut self, ui: &egui::Ui, library: &Library, asked: &mut Vec<Command>) {
        let (held, pressed) = ui.input(|input| {
            let of = |event: &egui::Event| match event {
                egui::Event::Key { key, pressed: true, .. } => Some(*key),
                _ => None,
            };
            (input.modifiers, input.events.iter().filter_map(of).collect::<Vec<Press>>())
        });
        for key in pressed {
            self.update_offers(library);
            let acts = |is_it: fn(&Act) -> bool| {
                let possible = self.offers.1.iter().filter(|action| action.refusal.is_none());
                possible.map(|action| &action.act).find(|act| is_it(act)).cloned()
            };
            // Why what a key asks for cannot be.
            let refused = |is_it: fn(&Act) -> bool| {
                let of = self.offers.1.iter().find(|action| is_it(&action.act));
                of.and_then(|action| action.refusal)
            };
            let why = match key {
                Press::F2 => refused(|act| matches!(act, Act::Rename(_))),
                Press::Delete => refused(Act::deletes),
                _ => None,
            };
            asked.extend(why.map(|why| Command::Say(format!("{why}."))));
            let wanted = match key {
                Press::Enter => acts(|act| {
                    matches!(act, Act::Send(Command::Library(Ask::Replay(_) | Ask::Race(_))))
                }),
                Press::F2 => acts(|act| matches!(act, Act::Rename(_))),
                Press::Delete => acts(Act::deletes),
                Press::D if held.command => {
                    acts(|act| matches!(act, Act::Send(Command::Library(Ask::Duplicate(_)))))
                }
                Press::A if held.command => {
                    let rows = self.order.rows();
                    self.selection.all(rows.iter().map(|row| library.items()[*row].place()));
                    None
                }
                _ => {
                    self.walk(key, held, library);
                    None
                }
            };
            self.act(wanted, library, asked);
        }
    }

    /// Moves the row at which keys begin; with Shift the range grows.
    fn walk(&mut self, key: Press, held: Modifiers, library: &Library) {
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
            (Press::PageDown, Some(now)) => now + PAGE,
            (Press::PageUp, Some(now)) => now.saturating_sub(PAGE),
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
