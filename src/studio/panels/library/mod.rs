//! Library: searchable and sortable list of all saves, with replay, race and file operations.
//!
//! Only visible rows are laid out, and rows are sorted only after a change, so the cost of a frame does not depend on
//! the number of saves. The list takes the keyboard focus as a whole. Every mouse action is also possible with keys.

mod actions;
mod details;
mod fields;
mod header;
mod keyboard;
mod order;
mod row;
mod selection;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::path::PathBuf;

use bevy_egui::egui::{self, EventFilter, Sense, WidgetType};

use crate::studio::commands::Command;
use crate::studio::commands::files::{FileCommand, FileQuestion};
use crate::studio::commands::library::LibraryCommand;
use crate::studio::state::library::{Library, LibraryItem};
use crate::studio::state::undo::UndoHistory;
use crate::studio::ui::accessible::named;
use crate::studio::ui::text_prompt::TextPrompt;
use crate::studio::ui::text_rows::{explain, problem};
use crate::studio::ui::theme;
use snakes_core::save::library::{EXPORTS, SavePlace};

use actions::{LibraryAction, LibraryActionKind, actions};
use fields::{NotesField, PathPrompt, RenameField};
use order::{SortOrder, SortedItems};
use row::{name_rect, row};
use selection::ChosenSaves;

/// The library panel, with its state between frames.
#[derive(Debug, Default)]
pub(super) struct LibraryPanel {
    search: String,
    sort: SortOrder,
    order: SortedItems,
    selection: ChosenSaves,
    /// Actions on the selected saves. The counter of the selection's changes and the library's revision are the key of this cache.
    actions: (Option<(u64, u64)>, Vec<LibraryAction>),
    /// Name that is being edited, if any.
    renaming: Option<RenameField>,
    /// Notes that are being edited, if any.
    notes: Option<NotesField>,
    /// Path that is being typed, if any.
    path_prompt: Option<PathPrompt>,
    /// Number of questions so far for which no file dialog could be shown.
    unanswered: u64,
    /// Number of requests so far from outside the panel to export the selected saves.
    export_requests: u64,
    /// Run whose champions are listed.
    listed_run: Option<PathBuf>,
    /// Unread places among the visible rows that were last sent to the loader.
    visible: Vec<SavePlace>,
    /// Version of the listing to which the selection belongs.
    listing: u64,
    /// Number of new entries so far that were selected automatically.
    new_entries: u64,
    /// Row to scroll into view, if any.
    scroll_to: Option<SavePlace>,
    /// Whether the list will request the focus in the next frame.
    wants_keyboard: bool,
    /// Scroll offset and height of the list, in points.
    offset: f32,
    height: f32,
    /// Height of the details below the list in the previous frame, in points.
    details_height: f32,
}

impl LibraryPanel {
    /// Draws the panel and sends the user's commands.
    pub fn ui(&mut self, ui: &mut egui::Ui, library: &Library, history: &UndoHistory) {
        if !library.is_open() {
            Command::Library(LibraryCommand::Refresh).send(ui);
        }
        let available = ui.available_height();
        let gaps = ui.spacing().item_spacing.y * 2.0;
        let above = ui.scope(|ui| self.header(ui, library, history)).response.rect.height() + gaps;
        self.follow(library);
        self.take_requests(ui, library);
        let now_s = ui.input(|input| input.time);
        if self.order.update(library, &self.search, self.sort, now_s) {
            // An action must never concern a save that the search hides.
            let shown: BTreeSet<&SavePlace> =
                self.order.rows.iter().map(|row| library.items[*row].place()).collect();
            self.selection.retain(|place| shown.contains(place));
        }
        // The details of a selected save leave a part of the panel to the rows of the list; they scroll instead.
        let rest = available - above - self.details_height;
        let rows = (self.order.rows.len() as f32 + 0.5) * theme::LIBRARY_ROW_HEIGHT;
        let least = rows.min(available * theme::LEAST_LIST_SHARE);
        self.list(ui, library, rest.max(least).floor());
        let details = egui::ScrollArea::vertical().id_salt("details").auto_shrink([false, true]);
        let footer = details.show(ui, |ui| self.footer(ui, library));
        self.details_height = footer.content_size.y;
    }

    /// Removes entries that do not exist any more from the selection, and selects new ones.
    fn follow(&mut self, library: &Library) {
        if self.listing != library.listings {
            self.listing = library.listings;
            self.selection.retain(|place| library.item(place).is_some());
            self.renaming =
                self.renaming.take().filter(|renaming| library.item(&renaming.place).is_some());
        }
        let (count, newest) = &library.newest;
        let is_there = |place: &&SavePlace| library.item(place).is_some();
        if let Some(place) = newest.as_ref().filter(is_there)
            && *count != self.new_entries
        {
            self.new_entries = *count;
            self.selection.only(place);
            self.scroll_to = Some(place.clone());
        }
    }

    /// Processes requests that come from the menu or from failed file dialogs.
    fn take_requests(&mut self, ui: &egui::Ui, library: &Library) {
        let (count, unanswered) = &library.unanswered;
        if let Some((question, reason)) = unanswered
            && *count != self.unanswered
        {
            self.unanswered = *count;
            let exports = || library.saves.path().join(EXPORTS).to_string_lossy().into_owned();
            let suggestion = match question {
                FileQuestion::Export(_) => exports(),
                FileQuestion::Share(format, name, _) => {
                    let name = format!("{name}.{}", format.info().ending);
                    library.saves.path().join(name).to_string_lossy().into_owned()
                }
                FileQuestion::Open | FileQuestion::Import => String::new(),
            };
            let (question, reason) = (question.clone(), reason.clone());
            let prompt = TextPrompt::new(suggestion);
            self.path_prompt = Some(PathPrompt { question, reason, prompt });
        }
        if library.export_requests != self.export_requests {
            self.export_requests = library.export_requests;
            if self.selection.chosen.is_empty() {
                let text = "Select what to export in the library first.".to_owned();
                Command::Notify(text).send(ui);
            } else {
                self.act(ui, Some(LibraryActionKind::Export), library);
            }
        }
    }

    fn list(&mut self, ui: &mut egui::Ui, library: &Library, height: f32) {
        let id = ui.id().with("list");
        let size = egui::vec2(ui.available_width(), height);
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        let list = ui.interact(rect, id, Sense::FOCUSABLE);
        let cursor = self.selection.cursor.as_ref().and_then(|place| library.item(place));
        let now = cursor.map_or("nothing selected".to_owned(), LibraryItem::label);
        let list = named(list, WidgetType::Other, &format!("Saves: {now}"));
        let role = egui::accesskit::Role::ListBox;
        ui.ctx().accesskit_node_builder(id, |node| node.set_role(role));
        if std::mem::take(&mut self.wants_keyboard) {
            list.request_focus();
        }
        let has_keyboard = list.has_focus();
        if has_keyboard {
            let filter = EventFilter { vertical_arrows: true, ..EventFilter::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(id, filter));
            self.keys(ui, library);
        }
        let palette = theme::of(ui);
        let edge = if has_keyboard { palette.accent } else { palette.field_hovered };
        let edge = if library.is_drop_near { palette.accent } else { edge };
        let stroke = egui::Stroke::new(if library.is_drop_near { 3.0 } else { 1.0 }, edge);
        ui.painter().rect_stroke(rect, 4.0, stroke, egui::StrokeKind::Inside);
        let mut inside = ui.new_child(egui::UiBuilder::new().max_rect(rect.shrink(2.0)));
        self.rows(&mut inside, library, has_keyboard);
    }

    fn rows(&mut self, ui: &mut egui::Ui, library: &Library, has_keyboard: bool) {
        let rows = self.order.rows.clone();
        if rows.is_empty() {
            let text = match (library.problem.as_deref(), library.is_listed, self.search.is_empty())
            {
                (Some(problem), ..) => problem,
                (_, false, _) => "Loading…",
                (_, true, true) => "There are no saves yet.",
                (_, true, false) => "No save matches all of these words.",
            };
            ui.add_space(theme::GAP);
            return explain(ui, text);
        }
        let items = &library.items;
        let row_of = |place: &SavePlace| rows.iter().position(|row| items[*row].place() == place);
        ui.spacing_mut().item_spacing.y = 0.0;
        let view = ui.available_height();
        if self.height != view {
            // The details of a selected save make the list shorter. The list scrolls so that the selected row remains visible.
            let was_in_sight = |row: usize| {
                let top = row as f32 * theme::LIBRARY_ROW_HEIGHT - self.offset;
                top < self.height && top + theme::LIBRARY_ROW_HEIGHT > 0.0
            };
            let cursor = self.selection.cursor.as_ref();
            let cursor = cursor.filter(|place| row_of(place).is_some_and(was_in_sight));
            self.scroll_to = self.scroll_to.take().or(cursor.cloned());
            self.height = view;
        }
        let mut area = egui::ScrollArea::vertical().id_salt("saves").auto_shrink(false);
        if let Some(row) = self.scroll_to.take().as_ref().and_then(row_of) {
            let top = row as f32 * theme::LIBRARY_ROW_HEIGHT;
            let lowest = top + theme::LIBRARY_ROW_HEIGHT - view;
            area = area.vertical_scroll_offset(self.offset.clamp(lowest.min(top), top));
        }
        let mut visible = Vec::new();
        let output = area.show_rows(ui, theme::LIBRARY_ROW_HEIGHT, rows.len(), |ui, range| {
            for item in rows.get(range).unwrap_or_default().iter().filter_map(|row| items.get(*row))
            {
                let size = egui::vec2(ui.available_width(), theme::LIBRARY_ROW_HEIGHT);
                let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
                self.row(ui, rect, library, item, has_keyboard);
                if item.read.is_none() {
                    visible.push(item.place().clone());
                }
            }
        });
        self.offset = output.state.offset.y;
        if visible != self.visible && !visible.is_empty() {
            Command::Library(LibraryCommand::LoadFirst(visible.clone())).send(ui);
        }
        self.visible = visible;
    }

    fn row(
        &mut self,
        ui: &mut egui::Ui,
        rect: egui::Rect,
        library: &Library,
        item: &LibraryItem,
        has_keyboard: bool,
    ) {
        let place = item.place();
        let is_chosen = self.selection.chosen.contains(place);
        let has_cursor = has_keyboard && self.selection.cursor.as_ref() == Some(place);
        let response = row(ui, rect, item, is_chosen, has_cursor);
        if self.renaming.as_ref().is_some_and(|renaming| renaming.place == *place) {
            return self.edit_name(ui, name_rect(rect));
        }
        if response.clicked() {
            let held = ui.input(|input| input.modifiers);
            if held.shift {
                let rows = self.order.rows.clone();
                self.selection.extend(place, rows.iter().map(|row| library.items[*row].place()));
            } else if held.command {
                self.selection.toggle(place);
            } else {
                self.selection.only(place);
            }
            self.wants_keyboard = true;
        }
        if response.secondary_clicked() && !is_chosen {
            self.selection.only(place);
        }
        if response.double_clicked() {
            Command::Library(LibraryCommand::Replay(place.clone())).send(ui);
        }
        let mut wanted = None;
        response.context_menu(|ui| {
            self.update_actions(library);
            wanted = details::menu(ui, &self.actions.1);
        });
        self.act(ui, wanted, library);
    }

    /// Recomputes the actions only after a change, because many saves may be selected.
    fn update_actions(&mut self, library: &Library) {
        let wanted = Some((self.selection.changes, library.revision));
        if self.actions.0 != wanted {
            let chosen = self.selection.chosen.iter().filter_map(|place| library.item(place));
            self.actions = (wanted, actions(library, &chosen.collect::<Vec<_>>()));
        }
    }

    fn act(&mut self, ui: &egui::Ui, wanted: Option<LibraryActionKind>, library: &Library) {
        match wanted {
            None => {}
            Some(LibraryActionKind::Send(command)) => command.send(ui),
            Some(LibraryActionKind::Rename(place)) => {
                self.renaming = library.item(&place).map(RenameField::new);
                self.scroll_to = Some(place);
            }
            Some(LibraryActionKind::Export) => {
                let places = self.selection.chosen.iter().cloned().collect();
                Command::File(FileCommand::Ask(FileQuestion::Export(places))).send(ui);
            }
            Some(LibraryActionKind::ShowChampions(run)) => {
                let is_listed = self.listed_run.as_ref() == Some(&run);
                self.listed_run = (!is_listed).then_some(run);
            }
        }
    }

    /// Draws the details of the selection and its actions.
    fn footer(&mut self, ui: &mut egui::Ui, library: &Library) {
        let (shown, all) = (self.order.rows.len(), library.items.len());
        let found =
            if shown == all { format!("{all} saves") } else { format!("{shown} of {all} saves") };
        let reading = match library.unread {
            0 => String::new(),
            unread => format!(", {unread} not read yet"),
        };
        let chosen = self.selection.chosen.len();
        let several = if chosen > 1 { format!(", {chosen} selected") } else { String::new() };
        explain(ui, &format!("{found}{reading}{several}"));
        if let Some(reason) = self.renaming.as_ref().and_then(RenameField::problem) {
            problem(ui, &reason);
        }
        self.update_actions(library);
        let wanted = details::buttons(ui, &self.actions.1);
        self.path_field(ui);
        let only = self.selection.chosen.iter().next().filter(|_| chosen == 1);
        let only = only.and_then(|place| library.item(place));
        self.keep_notes_of_others(ui, only);
        if let Some(item) = only {
            details::details(ui, item, library.is_current(item.place()));
            self.notes(ui, item);
            let is_listed = item.place().run() == self.listed_run.as_deref();
            if let Some(run) = item.run().filter(|_| is_listed) {
                details::champions(ui, item.place(), run);
            }
        }
        self.act(ui, wanted, library);
    }
}
