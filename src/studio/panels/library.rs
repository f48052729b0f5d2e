//! The library: every save in a list that is searched, sorted, replayed, raced and tidied up.
//!
//! Only the rows in sight are laid out, and nothing is sorted unless something has changed: ten thousand saves
//! cost a frame as little as ten. The list has the keyboard as a whole; all that the mouse can do, keys can.

mod actions;
mod details;
mod order;
mod row;
mod selection;
#[cfg(test)]
mod tests;
mod thumbnail;

use std::path::PathBuf;

use bevy_egui::egui::{self, EventFilter, Key as Press, Modifiers, Sense, WidgetInfo, WidgetType};

use super::{explain, title_and};
use crate::save::library::{EXPORTS, Place, check_entry_name};
use crate::studio::command::Command;
use crate::studio::library::{Ask, Item, Library};
use crate::studio::look;

use actions::{Act, Action, actions};
use order::{Key, Order, Sort};
use row::{Manner, column, name_rect, row};
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
    /// How far the list is scrolled, in points.
    offset: f32,
    /// Heights over and under the list in the last frame, in points.
    around: [f32; 2],
}

/// A name that is being edited.
#[derive(Debug)]
struct Naming {
    place: Place,
    text: String,
    has_begun: bool,
}

/// A path that is being typed.
#[derive(Debug)]
struct Asking {
    what: Wanted,
    text: String,
    has_begun: bool,
}

/// What a path is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wanted {
    Export,
    Import,
}

/// How many rows a page is, for the keys that turn pages.
const PAGE: usize = 10;

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

    /// Title, search and what it is sorted by.
    fn over(&mut self, ui: &mut egui::Ui, library: &Library, asked: &mut Vec<Command>) {
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
        let field = egui::TextEdit::singleline(&mut self.search)
            .hint_text("Search name, preset, controller, \"damaged\"")
            .desired_width(f32::INFINITY)
            .margin(egui::Margin::symmetric(8, 4));
        let response = ui.add(field);
        label(ui, &response, "Search the library");
        // From the field straight into the list.
        let pressed = |key| ui.input(|input| input.key_pressed(key));
        let is_entered = response.lost_focus() && pressed(Press::Enter);
        self.wants_keyboard |= is_entered || (response.has_focus() && pressed(Press::ArrowDown));
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
        ui.spacing_mut().item_spacing.y = 0.0;
        let view = ui.available_height();
        let mut area = egui::ScrollArea::vertical().id_salt("saves").auto_shrink(false);
        let items = library.items();
        let row_of = |place: &Place| rows.iter().position(|row| items[*row].place() == place);
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

    /// What keys ask for while the list has the keyboard.
    fn keys(&mut self, ui: &egui::Ui, library: &Library, asked: &mut Vec<Command>) {
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
            let wanted = match key {
                Press::Enter => acts(|act| {
                    matches!(act, Act::Send(Command::Library(Ask::Replay(_) | Ask::Race(_))))
                }),
                Press::F2 => acts(|act| matches!(act, Act::Rename(_))),
                Press::Delete => acts(Act::deletes),
                Press::D if held.command => {
                    acts(|act| matches!(act, Act::Send(Command::Library(Ask::Duplicate(_)))))
                }
                Press::Z if held.command && held.shift => Some(of(Ask::Redo)),
                Press::Z if held.command => Some(of(Ask::Undo)),
                Press::Y if held.command => Some(of(Ask::Redo)),
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

    /// A field over the name of a row: Enter takes it, Escape leaves it as it was.
    fn edit_name(&mut self, ui: &mut egui::Ui, rect: egui::Rect, asked: &mut Vec<Command>) {
        let Some(naming) = &mut self.naming else { return };
        let field = egui::TextEdit::singleline(&mut naming.text);
        let response = ui.put(rect, field);
        label(ui, &response, "New name");
        if !naming.has_begun {
            response.request_focus();
            naming.has_begun = true;
            return;
        }
        if !response.lost_focus() {
            return;
        }
        let name = naming.text.trim().to_owned();
        let is_good = check_entry_name(&name).is_ok();
        if ui.input(|input| input.key_pressed(Press::Escape)) || name == naming.place.name() {
            self.naming = None;
        } else if is_good {
            send(asked, Ask::Rename { place: naming.place.clone(), name });
            self.naming = None;
        } else if ui.input(|input| input.key_pressed(Press::Enter)) {
            // What is wrong with it is said below.
            naming.has_begun = false;
            return;
        } else {
            self.naming = None;
        }
        self.wants_keyboard = true;
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

    fn ask_for(&mut self, what: Wanted, text: String) {
        let is_open = self.asking.as_ref().is_some_and(|asking| asking.what == what);
        self.asking = (!is_open).then_some(Asking { what, text, has_begun: false });
    }

    /// A field for a path, while one is asked for.
    fn path_field(&mut self, ui: &mut egui::Ui, asked: &mut Vec<Command>) {
        let Some(asking) = &mut self.asking else { return };
        let (label, hint) = match asking.what {
            Wanted::Export => ("Export to", "A folder, which is made if need be"),
            Wanted::Import => ("Import from", "A champion's file, or the folder of a run"),
        };
        let mut is_done = false;
        ui.horizontal(|ui| {
            let name = ui.label(label);
            // The width of the two buttons beside it.
            let width = ui.available_width() - look::COLUMN_WIDTHS[2];
            let field = egui::TextEdit::singleline(&mut asking.text).desired_width(width);
            let response = ui.add(field).labelled_by(name.id).on_hover_text(hint);
            if !asking.has_begun {
                response.request_focus();
                asking.has_begun = true;
            }
            let is_entered =
                response.lost_focus() && ui.input(|input| input.key_pressed(Press::Enter));
            let is_there = !asking.text.trim().is_empty();
            let go = ui.add_enabled(is_there, egui::Button::new("OK").small());
            if (is_entered || go.clicked()) && is_there {
                let path = PathBuf::from(asking.text.trim());
                let places = self.selection.places().cloned().collect();
                send(
                    asked,
                    match asking.what {
                        Wanted::Export => Ask::Export { places, to: Some(path) },
                        Wanted::Import => Ask::Import(vec![path]),
                    },
                );
                is_done = true;
            }
            let is_left =
                response.lost_focus() && ui.input(|input| input.key_pressed(Press::Escape));
            is_done |= is_left || ui.add(egui::Button::new("Cancel").small()).clicked();
        });
        if is_done {
            self.asking = None;
            self.wants_keyboard = true;
        }
    }
}

fn send(asked: &mut Vec<Command>, ask: Ask) {
    asked.push(Command::Library(ask));
}

fn of(ask: Ask) -> Act {
    Act::Send(Command::Library(ask))
}

/// Names a field for who does not see it.
fn label(ui: &egui::Ui, response: &egui::Response, name: &str) {
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
}
