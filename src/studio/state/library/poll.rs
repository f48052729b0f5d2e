//! Systems of the library: process results, follow the current run, import dropped files.

use bevy::prelude::*;
use bevy::window::FileDragAndDrop;

use super::{Library, LibraryItem};
use crate::studio::commands::Command;
use crate::studio::commands::files::{FileCommand, FileQuestion};
use crate::studio::commands::library::LibraryCommand;
use crate::studio::schedule::FrameSet;
use crate::studio::state::current_run::CurrentRun;
use crate::studio::state::undo::UndoHistory;
use crate::studio::ui::notifications::Notices;
use snakes_core::save::library::LibraryEntry;
use snakes_lab::run::names::tell_apart;
use snakes_lab::run::{BackgroundTask, LibraryEvent};

pub(crate) fn plugin(app: &mut App) {
    let saves = app.world().resource::<CurrentRun>().context.saves.clone();
    app.insert_resource(Library::new(saves))
        .add_systems(Update, (take_drops, follow, take_in).chain().in_set(FrameSet::TakeIn));
}

/// Maximum number of events that are handled per frame, which takes some tenths of a millisecond.
const MOST_EVENTS: usize = 100;
/// Minimum interval between two listings of the folder, in seconds. Each generation of a run changes the folder.
const EARLIEST_LOOK_S: f32 = 2.0;

fn take_in(
    mut library: ResMut<Library>,
    mut history: ResMut<UndoHistory>,
    mut notices: ResMut<Notices>,
    mut send: MessageWriter<Command>,
) {
    library.take_in(&mut history, &mut notices);
    if library.loaded.is_some() {
        send.write(Command::Library(LibraryCommand::ShowLoaded));
    }
}

/// Imports all files that were dropped within a frame as one batch.
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
        send.write(Command::File(FileCommand::Answer(FileQuestion::Import, dropped)));
    }
}

/// Lists the folder again after each generation, and tracks the folder of the run in progress.
fn follow(
    mut library: ResMut<Library>,
    run: Res<CurrentRun>,
    time: Res<Time<Real>>,
    mut seen: Local<(u32, usize)>,
    mut looked_s: Local<f32>,
) {
    let current = run.is_under_way().then_some(run.source.folder.as_path());
    if library.current.as_deref() != current {
        library.current = current.map(ToOwned::to_owned);
        library.revision += 1;
    }
    let now = (run.number, run.reports.len());
    let now_s = time.elapsed_secs();
    if *seen != now && library.is_open() && now_s - *looked_s > EARLIEST_LOOK_S {
        (*seen, *looked_s) = (now, now_s);
        library.look_again();
    }
}

impl Library {
    /// Processes the results of background work.
    pub(super) fn take_in(&mut self, history: &mut UndoHistory, notices: &mut Notices) {
        self.take_in_batches(history, notices);
        if self.examination.as_ref().is_some_and(|exam| exam.report(notices)) {
            self.examination = None;
            self.look_again();
        }
        if let Some(loaded) = BackgroundTask::take_result(&mut self.loading) {
            self.loaded = Some(loaded.flatten());
        }
        let Some(reader) = &self.reader else { return };
        for event in reader.poll(MOST_EVENTS) {
            self.learn(event);
        }
    }

    pub(super) fn learn(&mut self, event: LibraryEvent) {
        match event {
            LibraryEvent::Done(_) => {
                self.unread = 0;
                if std::mem::take(&mut self.has_new_names) {
                    let runs = self.items.iter_mut();
                    tell_apart(runs.filter_map(LibraryItem::name_to_tell_apart));
                    self.revision += 1;
                }
            }
            LibraryEvent::NotListed(problem) => {
                self.problem = Some(problem);
                self.is_listed = true;
                self.items.clear();
                self.listings += 1;
                self.revision += 1;
            }
            LibraryEvent::Listed(entries) => self.list(entries),
            LibraryEvent::Read(place, read) => {
                let found = self.items.binary_search_by(|item| item.place().cmp(&place));
                let Ok(index) = found else { return };
                self.unread = self.unread.saturating_sub(1);
                let is_sorted_anew = self.items[index].learn(read);
                self.sortings += u64::from(is_sorted_anew);
                self.has_new_names |= is_sorted_anew;
                self.revision += 1;
            }
        }
    }

    /// Processes a listing of the folder. Known contents stay until they are read again. If no entry was added or
    /// removed, only the entries that changed are updated.
    fn list(&mut self, entries: Vec<LibraryEntry>) {
        let is_known = self.is_listed && self.problem.is_none();
        let places = self.items.iter().map(LibraryItem::place);
        if is_known && places.eq(entries.iter().map(|entry| &entry.place)) {
            self.items.iter_mut().zip(entries).for_each(|(item, entry)| item.follow(entry));
        } else {
            let mut before = std::mem::take(&mut self.items).into_iter().peekable();
            for entry in entries {
                while before.next_if(|item| item.place() < &entry.place).is_some() {}
                let item = match before.next_if(|item| item.place() == &entry.place) {
                    Some(mut item) => {
                        item.follow(entry);
                        item
                    }
                    None => LibraryItem::new(entry),
                };
                self.items.push(item);
            }
            self.is_listed = true;
            self.problem = None;
            self.has_new_names = true;
            self.listings += 1;
            self.revision += 1;
        }
        self.unread = self.items.iter().filter(|item| item.is_to_be_read()).count();
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::studio::state::current_run::prepared_run;
    use snakes_core::save::library::{EntryProblem, SavePlace};
    use snakes_core::save::{EntryNotes, SavesFolder};

    #[test]
    fn during_a_run_only_its_entry_is_sorted_again_and_only_after_it_is_read() {
        let place = |name: &str| SavePlace::Champion(format!("saves/{name}.ron").into());
        let entry = |name: &str, day: u64| LibraryEntry {
            place: place(name),
            bytes: 1,
            modified: Duration::from_secs(day * 86_400),
            notes: Ok(EntryNotes::default()),
        };
        let read =
            |name: &str| LibraryEvent::Read(place(name), Err(EntryProblem::damaged("cut off")));
        let listed = |day| LibraryEvent::Listed(vec![entry("a", 1), entry("b", day)]);
        let mut library = Library::of(vec![listed(2), read("a"), read("b")]);
        let state = |library: &Library| {
            (library.listings, library.sortings, library.revision, library.unread)
        };
        let (listings, sortings, revision, unread) = state(&library);
        assert_eq!(unread, 0);
        library.learn(listed(3));
        assert_eq!(state(&library), (listings, sortings, revision, 1), "nothing to be seen yet");
        library.learn(read("b"));
        assert_eq!(state(&library), (listings, sortings + 1, revision + 1, 0));
        let date = library.item(&place("b")).expect("there").entry.modified;
        assert_eq!(date.as_secs(), 3 * 86_400);
        library.learn(listed(3));
        library.learn(read("a"));
        let now = (listings, sortings + 1, revision + 2, 0);
        assert_eq!(state(&library), now, "read anew, it is what it was");
        library.learn(LibraryEvent::Listed(vec![entry("b", 3)]));
        assert_eq!(library.listings, listings + 1);
    }

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
        assert!(app.world().resource::<Library>().is_drop_near);
        for name in ["a.ron", "b.ron"] {
            let drop = FileDragAndDrop::DroppedFile { window, path_buf: path(name) };
            app.world_mut().write_message(drop);
        }
        app.update();
        assert!(!app.world().resource::<Library>().is_drop_near);
        let sent: Vec<Command> =
            app.world_mut().resource_mut::<Messages<Command>>().drain().collect();
        let both = vec![path("a.ron"), path("b.ron")];
        assert_eq!(sent, [Command::File(FileCommand::Answer(FileQuestion::Import, both))]);
    }
}
