//! What happens to the library by itself: it is read, follows the run, and takes files that are dropped.

use std::path::Path;

use bevy::prelude::*;
use bevy::window::FileDragAndDrop;

use super::history::Change;
use super::{Ask, Item, Library, capital, listed};
use crate::run::Reading;
use crate::save::SaveError;
use crate::save::library::{Entry, Step};
use crate::studio::Frame;
use crate::studio::command::Command;
use crate::studio::evolution::{Evolution, Status};
use crate::studio::notice::Notices;

pub(in crate::studio) fn plugin(app: &mut App) {
    app.init_resource::<Library>()
        .add_systems(Update, (take_drops, follow, take_in).chain().in_set(Frame::TakeIn));
}

/// So many readings are taken in within a frame: some tenths of a millisecond.
const MOST_READINGS: usize = 100;
/// A folder that changes with every generation is looked at again after so many seconds at the earliest.
const EARLIEST_LOOK_S: f32 = 2.0;

fn take_in(mut library: ResMut<Library>, mut notices: ResMut<Notices>) {
    library.take_in(&mut notices);
}

/// Files that are dropped into the window are imported, all of a frame at once.
fn take_drops(
    mut drops: MessageReader<FileDragAndDrop>,
    mut library: ResMut<Library>,
    mut send: MessageWriter<Command>,
) {
    let mut dropped = Vec::new();
    for drop in drops.read() {
        library.is_drop_near = matches!(drop, FileDragAndDrop::HoveredFile { .. });
        if let FileDragAndDrop::DroppedFile { path_buf, .. } = drop {
            dropped.push(path_buf.clone());
        }
    }
    if !dropped.is_empty() {
        send.write(Command::Library(Ask::Import(dropped)));
    }
}

/// Looks again when the run has another generation, and knows which run goes on.
fn follow(
    mut library: ResMut<Library>,
    evolution: Res<Evolution>,
    time: Res<Time<Real>>,
    mut seen: Local<(u32, usize)>,
    mut looked_s: Local<f32>,
) {
    let goes_on = matches!(evolution.status(), Status::Running | Status::Paused);
    let current = goes_on.then(|| evolution.folder());
    if library.current.as_deref() != current {
        library.current = current.map(ToOwned::to_owned);
        library.revision += 1;
    }
    let now = (evolution.number(), evolution.reports().len());
    let now_s = time.elapsed_secs();
    if *seen != now && library.is_open() && now_s - *looked_s > EARLIEST_LOOK_S {
        (*seen, *looked_s) = (now, now_s);
        library.look_again();
    }
}

impl Library {
    /// Takes in what was read and copied meanwhile.
    pub(super) fn take_in(&mut self, notices: &mut Notices) {
        let errands = std::mem::take(&mut self.errands);
        for outstanding in errands {
            match outstanding.errand.poll() {
                None => self.errands.push(outstanding),
                Some(result) => self.take_back(outstanding.verb, result, notices),
            }
        }
        let Some(librarian) = &self.librarian else { return };
        for reading in librarian.poll(MOST_READINGS) {
            self.learn(reading);
        }
    }

    /// Takes in what came of copies.
    fn take_back(
        &mut self,
        verb: &str,
        result: Result<Vec<Result<Step, SaveError>>, String>,
        notices: &mut Notices,
    ) {
        let results = match result {
            Ok(results) => results,
            Err(problem) => return notices.problem(format!("Nothing was {verb}: {problem}")),
        };
        let mut steps = Vec::new();
        for result in results {
            match result {
                Ok(step) => steps.push(step),
                Err(error) => notices.problem(error.to_string()),
            }
        }
        let places = steps.iter().filter_map(Step::place);
        let names: Vec<String> = places.map(|place| place.name()).collect();
        let Some(first) = steps.first().and_then(Step::place) else { return };
        let words = format!("{verb} {}", listed(&names));
        let folder = first.path().and_then(Path::parent).unwrap_or(Path::new("."));
        notices.news(format!("{} to {}", capital(&words), folder.display()));
        self.keep(Change { words, steps });
    }

    pub(super) fn learn(&mut self, reading: Reading) {
        match reading {
            Reading::Done(_) => self.unread = 0,
            Reading::NotListed(problem) => {
                self.problem = Some(problem);
                self.is_listed = true;
                self.items.clear();
                self.listings += 1;
                self.revision += 1;
            }
            Reading::Listed(entries) => self.list(entries),
            Reading::Read(place, read) => {
                let found = self.items.binary_search_by(|item| item.place().cmp(&place));
                let Ok(index) = found else { return };
                self.unread = self.unread.saturating_sub(1);
                let item = &mut self.items[index];
                item.learn(read);
                self.revision += 1;
            }
        }
    }

    /// Takes in what there is by name; what was known of entries of before stays known until it is read anew.
    fn list(&mut self, entries: Vec<Entry>) {
        let is_same = self.is_listed && self.problem.is_none();
        let known = self.items.iter().map(Item::entry);
        if is_same && entries.len() == self.items.len() && known.eq(entries.iter()) {
            return;
        }
        let mut before = std::mem::take(&mut self.items).into_iter().peekable();
        self.unread = 0;
        for entry in entries {
            while before.next_if(|item| item.place() < &entry.place).is_some() {}
            let item = match before.next_if(|item| item.place() == &entry.place) {
                Some(item) if *item.entry() == entry => {
                    self.unread += usize::from(!item.is_read());
                    item
                }
                Some(item) => {
                    self.unread += 1;
                    item.changed(entry)
                }
                None => {
                    self.unread += 1;
                    Item::new(entry)
                }
            };
            self.items.push(item);
        }
        self.is_listed = true;
        self.problem = None;
        self.listings += 1;
        self.revision += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::SavesFolder;
    use crate::studio::evolution::prepared_run;

    #[test]
    fn files_that_are_dropped_are_imported_together() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut app = App::new();
        app.add_message::<Command>()
            .add_message::<FileDragAndDrop>()
            .insert_resource(prepared_run())
            .insert_resource(Library::new(SavesFolder::find(Some(folder.path()))))
            .add_systems(Update, take_drops);
        let window = Entity::PLACEHOLDER;
        let path = |name: &str| folder.path().join(name);
        app.world_mut()
            .write_message(FileDragAndDrop::HoveredFile { window, path_buf: path("a.ron") });
        app.update();
        assert!(app.world().resource::<Library>().is_drop_near());
        for name in ["a.ron", "b.ron"] {
            let drop = FileDragAndDrop::DroppedFile { window, path_buf: path(name) };
            app.world_mut().write_message(drop);
        }
        app.update();
        assert!(!app.world().resource::<Library>().is_drop_near());
        let sent: Vec<Command> =
            app.world_mut().resource_mut::<Messages<Command>>().drain().collect();
        let both = vec![path("a.ron"), path("b.ron")];
        assert_eq!(sent, [Command::Library(Ask::Import(both))]);
    }
}
