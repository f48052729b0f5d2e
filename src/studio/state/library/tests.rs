//! Tests of the library, and a library for the tests of its parts.

use super::*;
use crate::studio::commands::Command;
use crate::studio::commands::files::FileCommand;
use crate::studio::commands::library::LibraryCommand;
use crate::studio::state::undo::UndoDirection;
use crate::studio::ui::notifications::Notices;
use snakes_core::save::{shipped_champion, store_champion};
use tempfile::TempDir;

/// A library with its undo history and messages, in a temporary folder.
pub struct Tried {
    pub folder: TempDir,
    pub library: Library,
    pub history: UndoHistory,
    pub notices: Notices,
}

impl Tried {
    /// Creates a library of champions with these names.
    pub fn new(names: &[&str]) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let loaded = shipped_champion().expect("well formed");
        for name in names {
            let path = folder.path().join(format!("{name}.ron"));
            store_champion(&path, &loaded.champion, None).expect("written");
        }
        let mut library = Library::new(SavesFolder::find(Some(folder.path())));
        library.read_all();
        Self { folder, library, history: UndoHistory::default(), notices: Notices::default() }
    }

    /// Returns the names of the entries in the folder.
    pub fn own(&mut self) -> Vec<String> {
        self.library.read_all();
        let own = self.library.items.iter().filter(|item| item.place().path().is_some());
        own.map(|item| item.name().to_owned()).collect()
    }

    pub fn place(&self, name: &str) -> SavePlace {
        let item = self.library.items.iter().find(|item| item.name() == name);
        item.expect("listed").place().clone()
    }

    pub fn apply(&mut self, request: &LibraryCommand) -> Result<Option<Show>, String> {
        self.library.apply(request, &mut self.history, &mut self.notices)
    }

    /// Undoes or redoes the next step, and waits for the result.
    pub fn step(&mut self, way: UndoDirection) {
        let Some(UndoStep::Files { label, steps }) = self.history.take(way) else {
            panic!("no step")
        };
        self.library.step(way, label, steps, &mut self.history, &mut self.notices).expect("begun");
    }

    pub fn take_in(&mut self) {
        self.library.take_in(&mut self.history, &mut self.notices);
    }

    /// Waits until no batch operation is in progress.
    pub fn wait(&mut self) {
        while !self.library.batches.is_empty() {
            self.take_in();
        }
    }

    /// Returns the labels of the next steps to undo and to redo.
    pub fn next(&self) -> (Option<&str>, Option<&str>) {
        (self.history.next(UndoDirection::Back), self.history.next(UndoDirection::Forth))
    }
}

#[test]
fn saves_that_were_deleted_together_are_restored_and_deleted_again_together() {
    let mut tried = Tried::new(&["a", "b", "c"]);
    let places = vec![tried.place("a"), tried.place("c")];
    tried.apply(&LibraryCommand::Delete(places)).expect("deleted");
    assert_eq!(tried.notices.len(), 1);
    assert_eq!(tried.own(), ["b"]);
    assert_eq!(tried.next(), (Some("deleted 2 saves"), None));
    tried.step(UndoDirection::Back);
    assert_eq!(tried.notices.last(), Some("2 saves restored."));
    assert_eq!(tried.notices.len(), 1, "it replaces the message about the change");
    assert_eq!(tried.own(), ["a", "b", "c"]);
    assert_eq!(tried.next(), (None, Some("deleted 2 saves")));
    tried.step(UndoDirection::Forth);
    assert_eq!(tried.own(), ["b"]);
    assert_eq!(tried.next(), (Some("deleted 2 saves"), None));
}

#[test]
fn a_save_that_is_restored_under_another_name_is_reported() {
    let mut tried = Tried::new(&["a"]);
    let a = tried.place("a");
    tried.apply(&LibraryCommand::Delete(vec![a])).expect("deleted");
    std::fs::write(tried.folder.path().join("a.ron"), "another").expect("written");
    tried.step(UndoDirection::Back);
    let said = "a restored. The name a was taken, so the new name is a 2.";
    assert_eq!(tried.notices.last(), Some(said));
    let (count, newest) = &tried.library.newest;
    assert_eq!((*count, newest.as_ref().map(SavePlace::name)), (1, Some("a 2".to_owned())));
}

#[test]
fn a_refused_name_changes_nothing_and_the_next_change_ends_redo() {
    let mut tried = Tried::new(&["a", "b"]);
    let rename = |tried: &mut Tried, from: &str, to: &str| {
        let request = LibraryCommand::Rename { place: tried.place(from), name: to.to_owned() };
        tried.apply(&request).map(|_| ())
    };
    let refusal = rename(&mut tried, "a", "b").expect_err("taken");
    assert!(refusal.contains("not taken yet"), "{refusal}");
    assert_eq!(tried.next(), (None, None));
    rename(&mut tried, "a", "c").expect("free");
    assert_eq!(tried.own(), ["b", "c"]);
    tried.step(UndoDirection::Back);
    tried.own();
    rename(&mut tried, "b", "d").expect("free");
    assert_eq!(tried.next(), (Some("renamed b"), None));
}

#[test]
fn copies_are_taken_in_when_they_are_complete() {
    let mut tried = Tried::new(&["a"]);
    let export = LibraryCommand::Export { places: vec![tried.place("a")], to: None };
    tried.apply(&export).expect("begun");
    tried.wait();
    let exports = tried.folder.path().join("exports");
    let copy = exports.join("a.ron");
    assert!(copy.exists());
    let offers = [
        ("Open folder", FileCommand::OpenFolder(exports)),
        ("Copy path", FileCommand::CopyPath(copy.clone())),
    ];
    let offers = offers.map(|(label, of)| (label.to_owned(), Command::File(of)));
    assert_eq!(tried.notices.last_offers(), offers);
    tried.apply(&LibraryCommand::Import(vec![copy])).expect("begun");
    tried.wait();
    assert_eq!(tried.own(), ["a 2", "a"]);
    assert_eq!(tried.next(), (Some("imported a 2"), None));
    assert_eq!(tried.notices.len(), 1, "only the latest operation is reported");
}
