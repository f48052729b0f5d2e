//! The library: every save in a list that is searched, sorted, replayed, raced and tidied up.
//!
//! Only the rows in sight are laid out, and nothing is sorted unless something has changed: ten thousand saves
//! cost a frame as little as ten. The list has the keyboard as a whole; all that the mouse can do, keys can.

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
mod thumbnail;

use std::path::PathBuf;

use bevy_egui::egui::{self, EventFilter, Sense, WidgetInfo, WidgetType};

use super::explain;
use crate::save::library::{EXPORTS, Place, check_entry_name};
use crate::studio::command::Command;
use crate::studio::library::{Ask, Item, Library};
use crate::studio::look;

use actions::{Act, Action, actions};
use fields::{Asking, Naming, Wanted};
use order::{Order, Sort};
use row::{Manner, name_rect, row};
use selection::Selection;

/// The panel, with what it remembers between frames.
#[derive(Debug, Default)]
pub(super) struct LibraryPanel {
    search: String,
    sort: Sort,
    order: Order,
    selection: Selection,
    /// What can be done with what is chosen, and of which selection and revision that is.
    offers: (Option<(u64, u64)>, Vec<Action>),
    /// The save whose name is being edited.
    naming: Option<Naming>,
    /// A path that is being asked for.
    asking: Option<Asking>,
    /// The run whose champions are listed.
    listed_run: Option<PathBuf>,
    /// What was in sight when it was last told.
    in_sight: Vec<Place>,
    /// Of which listing the selection is.
    listing: u64,
    /// How many new entries have been pointed out.
    pointed_out: u64,
    /// A row to be scrolled into sight.
    scroll_to: Option<Place>,
    /// Whether the list is to have the keyboard from the next frame on.
    wants_keyboard: bool,
    /// How far the list is scrolled, and how high it was then, in points.
    offset: f32,
    height: f32,
    /// Heights over and under the list in the last frame, in points.
    around: [f32; 2],
}

impl LibraryPanel {
    /// Draws the panel and adds what was asked for.
    pub fn ui(&mut self, ui: &mut egui::Ui, library: &Library, asked: &mut Vec<Command>) {
        if !library.is_open() {
            send(asked, Ask::Look);
        }
        let available = ui.available_height();
        if !available.is_finite() {
            return self.parts(ui, library, look::LIST_HEIGHTS[0], asked);
        }
        let [usual, least] = look::LIST_HEIGHTS;
        let rest = if self.around == [0.0; 2] {
            usual
        } else {
            available - self.around[0] - self.around[1]
        };
        let area = egui::ScrollArea::vertical().id_salt("library").auto_shrink(false);
        area.show(ui, |ui| self.parts(ui, library, rest.floor().max(least), asked));
    }

    fn parts(
        &mut self,
        ui: &mut egui::Ui,
        library: &Library,
        list_height: f32,
        asked: &mut Vec<Command>,
    ) {
        let gaps = ui.spacing().item_spacing.y * 2.0;
        let over = ui.scope(|ui| self.over(ui, library, asked)).response.rect.height();
        self.follow(library);
        let now_s = ui.input(|input| input.time);
        self.order.update(library, &self.search, self.sort, now_s);
        self.list(ui, library, list_height, asked);
        let under = ui.scope(|ui| self.under(ui, library, asked)).response.rect.height();
        self.around = [over + gaps, under];
    }

    /// Keeps to what there is: what is gone is no longer chosen, what is new is pointed out.
    fn follow(&mut self, library: &Library) {
        if self.listing != library.listings() {
            self.listing = library.listings();
            self.selection.retain(|place| library.item(place).is_some());
            self.naming = self.naming.take().filter(|naming| library.item(&naming.place).is_some());
        }
        let (count, newest) = library.newest();
        let newest =
            newest.filter(|place| count != self.pointed_out && library.item(place).is_some());
        if let Some(place) = newest {
            self.pointed_out = count;
            self.selection.only(place);
            self.scroll_to = Some(place.clone());
        }
    }

    fn list(
        &mut self,
        ui: &mut egui::Ui,
        library: &Library,
        height: f32,
        asked: &mut Vec<Command>,
    ) {
        let id = ui.id().with("list");
        let size = egui::vec2(ui.available_width(), height);
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        let list = ui.interact(rect, id, Sense::FOCUSABLE);
        let cursor = self.selection.cursor().and_then(|place| library.item(place));
        list.widget_info(|| {
            let now = cursor.map_or("nothing is chosen".to_owned(), Item::label);
            WidgetInfo::labeled(WidgetType::Other, true, format!("Saves: {now}"))
        });
        let role = egui::accesskit::Role::ListBox;
        ui.ctx().accesskit_node_builder(id, |node| node.set_role(role));
        if std::mem::take(&mut self.wants_keyboard) {
            list.request_focus();
        }
        let has_keyboard = list.has_focus();
        if has_keyboard {
            let filter = EventFilter { vertical_arrows: true, ..EventFilter::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(id, filter));
            self.keys(ui, library, asked);
        }
        let palette = look::of(ui);
        let edge = if has_keyboard { palette.accent } else { palette.field_hovered };
        let edge = if library.is_drop_near() { palette.accent } else { edge };
        let stroke = egui::Stroke::new(if library.is_drop_near() { 3.0 } else { 1.0 }, edge);
        ui.painter().rect_stroke(rect, 4.0, stroke, egui::StrokeKind::Inside);
        let mut inside = ui.new_child(egui::UiBuilder::new().max_rect(rect.shrink(2.0)));
        self.rows(&mut inside, library, has_keyboard, asked);
    }

    fn rows(
        &mut self,
        ui: &mut egui::Ui,
        library: &Library,
        has_keyboard: bool,
        asked: &mut Vec<Command>,
    ) {
        let rows = self.order.rows();
        if rows.is_empty() {
            let text = match (library.problem(), library.is_listed(), self.search.is_empty()) {
                (Some(problem), ..) => problem,
                (_, false, _) => "Looking ...",
                (_, true, true) => "There are no saves yet.",
                (_, true, false) => "No save has all of these words.",
            };
            ui.add_space(look::GAP);
            return explain(ui, text);
        }
        let items = library.items();
        let row_of = |place: &Place| rows.iter().position(|row| items[*row].place() == place);
        ui.spacing_mut().item_spacing.y = 0.0;
        let view = ui.available_height();
        if self.height != view {
            // What is said of the chosen one takes its room from the list, which is not to hide that one.
            let was_in_sight = |row: usize| {
                let top = row as f32 * look::SAVE_HEIGHT - self.offset;
                top < self.height && top + look::SAVE_HEIGHT > 0.0
            };
            let cursor = self.selection.cursor();
            let cursor = cursor.filter(|place| row_of(place).is_some_and(was_in_sight));
            self.scroll_to = self.scroll_to.take().or(cursor.cloned());
            self.height = view;
        }
        let mut area = egui::ScrollArea::vertical().id_salt("saves").auto_shrink(false);
        if let Some(row) = self.scroll_to.take().as_ref().and_then(row_of) {
            let top = row as f32 * look::SAVE_HEIGHT;
            let lowest = top + look::SAVE_HEIGHT - view;
            area = area.vertical_scroll_offset(self.offset.clamp(lowest.min(top), top));
        }
        let mut in_sight = Vec::new();
        let output = area.show_rows(ui, look::SAVE_HEIGHT, rows.len(), |ui, range| {
            for item in rows.get(range).unwrap_or_default().iter().filter_map(|row| items.get(*row))
            {
                let size = egui::vec2(ui.available_width(), look::SAVE_HEIGHT);
                let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
                self.row(ui, rect, library, item, has_keyboard, asked);
                if !item.is_read() {
                    in_sight.push(item.place().clone());
                }
            }
        });
        self.offset = output.state.offset.y;
        if in_sight != self.in_sight && !in_sight.is_empty() {
            send(asked, Ask::Hurry(in_sight.clone()));
        }
        self.in_sight = in_sight;
    }

    fn row(
        &mut self,
        ui: &mut egui::Ui,
        rect: egui::Rect,
        library: &Library,
        item: &Item,
        has_keyboard: bool,
        asked: &mut Vec<Command>,
    ) {
        let place = item.place();
        let manner = Manner {
            is_chosen: self.selection.has(place),
            is_cursor: has_keyboard && self.selection.cursor() == Some(place),
        };
        let response = row(ui, rect, item, manner);
        if self.naming.as_ref().is_some_and(|naming| naming.place == *place) {
            return self.edit_name(ui, name_rect(rect), asked);
        }
        if response.clicked() {
            let held = ui.input(|input| input.modifiers);
            if held.shift {
                let rows = self.order.rows();
                self.selection.extend(place, rows.iter().map(|row| library.items()[*row].place()));
            } else if held.command {
                self.selection.toggle(place);
            } else {
                self.selection.only(place);
            }
            self.wants_keyboard = true;
        }
        if response.secondary_clicked() && !manner.is_chosen {
            self.selection.only(place);
        }
        if response.double_clicked() {
            send(asked, Ask::Replay(place.clone()));
        }
        let mut wanted = None;
        response.context_menu(|ui| {
            self.update_offers(library);
            wanted = details::menu(ui, &self.offers.1);
        });
        self.act(wanted, library, asked);
    }

    /// The saves that are chosen, as they are listed.
    fn chosen<'a>(&self, library: &'a Library) -> Vec<&'a Item> {
        self.selection.places().filter_map(|place| library.item(place)).collect()
    }

    /// Works out what can be done with what is chosen, if something has changed: everything may be chosen.
    fn update_offers(&mut self, library: &Library) {
        let wanted = Some((self.selection.changes(), library.revision()));
        if self.offers.0 != wanted {
            self.offers = (wanted, actions(library, &self.chosen(library)));
        }
    }

    fn act(&mut self, wanted: Option<Act>, library: &Library, asked: &mut Vec<Command>) {
        match wanted {
            None => {}
            Some(Act::Send(command)) => asked.push(command),
            Some(Act::Rename(place)) => {
                let text = place.name();
                self.scroll_to = Some(place.clone());
                self.naming = Some(Naming { place, text, has_begun: false });
            }
            Some(Act::Export) => {
                let exports = library.folder().join(EXPORTS).to_string_lossy().into_owned();
                self.ask_for(Wanted::Export, exports);
            }
            Some(Act::ShowChampions(run)) => {
                let is_listed = self.listed_run.as_ref() == Some(&run);
                self.listed_run = (!is_listed).then_some(run);
            }
        }
    }

    /// What is chosen, and what can be done with it.
    fn under(&mut self, ui: &mut egui::Ui, library: &Library, asked: &mut Vec<Command>) {
        let (shown, all) = (self.order.rows().len(), library.items().len());
        let found =
            if shown == all { format!("{all} saves") } else { format!("{shown} of {all} saves") };
        let reading = match library.unread() {
            0 => String::new(),
            unread => format!(", {unread} not read yet"),
        };
        let chosen = self.selection.places().len();
        let several = if chosen > 1 { format!(", {chosen} chosen") } else { String::new() };
        explain(ui, &format!("{found}{reading}{several}"));
        let name = self.naming.as_ref().map(|naming| check_entry_name(naming.text.trim()));
        if let Some(Err(problem)) = name {
            ui.colored_label(look::of(ui).problem, problem.to_string());
        }
        self.update_offers(library);
        let wanted = details::buttons(ui, &self.offers.1);
        self.path_field(ui, asked);
        let only = self.selection.places().next().filter(|_| chosen == 1);
        if let Some(item) = only.and_then(|place| library.item(place)) {
            details::details(ui, item);
            let is_listed = item.place().run() == self.listed_run.as_deref();
            if let Some(run) = item.run().filter(|_| is_listed) {
                details::champions(ui, item.place(), run, asked);
            }
        }
        self.act(wanted, library, asked);
    }
}

fn send(asked: &mut Vec<Command>, ask: Ask) {
    asked.push(Command::Library(ask));
}
