//! Names and notes of library entries, as operations that can be undone.

use std::path::{Path, PathBuf};

use super::change::FileStep;
use super::name::notes_beside;
use super::place::SavePlace;
use crate::check::Invalid;
use crate::save::SaveError;
use crate::save::notes::{EntryNotes, notes_in_run};
use crate::save::whole_file::write_copy;

/// Returns the path of an entry's notes. None for a part of the program.
fn notes_path(place: &SavePlace) -> Option<PathBuf> {
    match place {
        SavePlace::Shipped(_) => None,
        SavePlace::Champion(path) => Some(notes_beside(path)),
        SavePlace::Run(folder) => Some(notes_in_run(folder)),
    }
}

/// Reads the name and notes of an entry. Returns empty notes if the entry has none.
///
/// # Errors
/// Fails if the file of notes is unreadable, damaged, a link, or of another kind or format.
pub fn read_notes(place: &SavePlace) -> Result<EntryNotes, SaveError> {
    notes_path(place).map_or_else(|| Ok(EntryNotes::default()), |path| EntryNotes::load(&path))
}

/// Gives an entry another name and other notes. If name and notes are empty, their file is removed.
///
/// # Errors
/// Fails if the entry is part of the program or does not exist, if name or notes are not allowed, if the present notes are damaged and
/// would be lost, or if the file cannot be written.
pub fn set_notes(place: &SavePlace, notes: &EntryNotes) -> Result<FileStep, SaveError> {
    let Some(path) = notes_path(place) else {
        let source = Invalid::new("entry", "built-in", "a champion's file or a run's folder");
        return Err(SaveError::Invalid { path: place.name().into(), source });
    };
    let entry = place.path().unwrap_or(&path);
    entry.symlink_metadata().map_err(SaveError::unreadable(entry))?;
    let before = notes.store(&path)?;
    Ok(FileStep::Noted { place: place.clone(), before })
}

/// Gives a run a name in its notes, or none if `name` is empty. The folder is not renamed.
///
/// # Errors
/// Fails as [`set_notes`] does.
pub fn name_run(place: &SavePlace, name: &str) -> Result<FileStep, SaveError> {
    let EntryNotes { text, .. } = read_notes(place)?;
    // The folder's name is not stored, because it is shown for a run without a name.
    let name = if name == place.name() { String::new() } else { name.to_owned() };
    set_notes(place, &EntryNotes { name, text })
}

/// Changes the text of an entry's notes.
///
/// # Errors
/// Fails as [`set_notes`] does.
pub fn set_notes_text(place: &SavePlace, text: &str) -> Result<FileStep, SaveError> {
    let EntryNotes { name, .. } = read_notes(place)?;
    set_notes(place, &EntryNotes { name, text: text.to_owned() })
}

/// Writes a copy of a champion's file, as private as the original, and of the notes beside the original if the original is a file. Notes that
/// cannot be read are not copied.
///
/// # Errors
/// Fails if the path is taken, or if the copy cannot be written.
pub fn add_copy(text: &str, original: Option<&Path>, path: PathBuf) -> Result<FileStep, SaveError> {
    write_copy(&path, text.as_bytes(), original)?;
    let noted = original.map(|from| read_notes(&SavePlace::Champion(from.to_owned())));
    let notes = noted.and_then(Result::ok).unwrap_or_default();
    if !notes.is_empty() {
        let _ = set_notes(&SavePlace::Champion(path.clone()), &notes);
    }
    Ok(FileStep::Added { path })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::fixtures::{champion_in, run_in, saves};
    use crate::save::library::{delete, duplicate, export, import, list, read_entry, rename};
    use std::fs;

    fn notes(name: &str, text: &str) -> EntryNotes {
        EntryNotes { name: name.to_owned(), text: text.to_owned() }
    }

    fn read(place: &SavePlace) -> EntryNotes {
        read_notes(place).expect("readable")
    }

    #[test]
    fn a_run_gets_a_name_and_notes_that_are_undone_and_redone_and_keeps_its_folder() {
        let (_folder, saves) = saves();
        let run = run_in(&saves, 1);
        let before = read_entry(&run).expect("whole");
        let named = rename(&run, "Ice: 1/2, \"the slow one\"").expect("renamed");
        let noted = set_notes_text(&run, "Slips at step 3.\nTry more grip.").expect("noted");
        let both = notes("Ice: 1/2, \"the slow one\"", "Slips at step 3.\nTry more grip.");
        assert_eq!(read(&run), both);
        assert_eq!(named.place(), Some(run.clone()));
        assert_eq!(read_entry(&run).expect("whole"), before, "nothing else changed");
        let listed = list(&saves).expect("listed");
        let listed = listed.into_iter().find(|entry| entry.place == run).expect("listed");
        assert_eq!(listed.notes, Ok(both.clone()));
        let again = noted.undo(&saves).expect("undone");
        assert_eq!(read(&run).text, "");
        again.undo(&saves).expect("done again");
        assert_eq!(read(&run), both);
        noted.undo(&saves).and_then(|_| named.undo(&saves)).expect("undone");
        assert!(!notes_in_run(run.path().expect("a folder")).exists(), "no empty file is left");
        rename(&run, "other").expect("renamed");
        rename(&run, &run.name()).expect("renamed");
        assert_eq!(read(&run), EntryNotes::default(), "the folder's name is no name of its own");
    }

    #[test]
    fn notes_follow_their_champion_when_it_is_renamed_copied_and_deleted() {
        let (folder, saves) = saves();
        let place = champion_in(&saves, "a");
        let mine = notes("", "my favourite");
        set_notes(&place, &mine).expect("noted");
        let copy = duplicate(&saves, &place).expect("copied").place().expect("there");
        assert_eq!((copy.name().as_str(), read(&copy)), ("a copy", mine.clone()));
        let renamed = rename(&place, "b").expect("renamed");
        let b = renamed.place().expect("there");
        assert_eq!((read(&b), read(&place)), (mine.clone(), EntryNotes::default()));
        let deleted = delete(&saves, &b).expect("deleted");
        assert!(!folder.path().join("b.about").exists());
        let restored = deleted.undo(&saves).expect("restored");
        assert_eq!(read(&b), mine);
        assert_eq!(restored.place(), Some(b.clone()));
        let elsewhere = tempfile::tempdir().expect("a folder");
        let exported = export(&saves, &b, Some(elsewhere.path())).expect("exported");
        let exported = exported.place().expect("there");
        assert_eq!(read(&exported), mine);
        let path = exported.path().expect("a file");
        let imported = import(&saves, path).expect("imported").place().expect("there");
        assert_eq!((imported.name().as_str(), read(&imported)), ("b 2", mine));
    }

    #[test]
    fn the_name_and_notes_of_a_run_are_exported_and_imported_with_it() {
        let (_folder, saves) = saves();
        let run = run_in(&saves, 1);
        let mine = notes("The icy one", "notes");
        set_notes(&run, &mine).expect("noted");
        let elsewhere = tempfile::tempdir().expect("a folder");
        let exported = export(&saves, &run, Some(elsewhere.path())).expect("exported");
        let exported = exported.place().expect("there");
        let (_other, others) = super::super::fixtures::saves();
        let imported = import(&others, exported.path().expect("a folder")).expect("imported");
        assert_eq!(read(&imported.place().expect("there")), mine);
    }

    #[test]
    fn a_name_whose_notes_are_left_over_is_taken() {
        let (folder, saves) = saves();
        let place = champion_in(&saves, "a");
        fs::write(folder.path().join("b.about"), "left over").expect("written");
        let refusal = rename(&place, "b").expect_err("taken").to_string();
        assert!(refusal.contains("not taken yet"), "{refusal}");
        assert!(place.path().expect("a file").exists());
    }

    #[test]
    fn damaged_notes_are_reported_and_never_replaced() {
        let (folder, saves) = saves();
        let place = champion_in(&saves, "a");
        fs::write(folder.path().join("a.about"), "(kind: 3").expect("written");
        let listed = list(&saves).expect("listed");
        let listed = listed.into_iter().find(|entry| entry.place == place).expect("listed");
        let problem = listed.notes.expect_err("damaged");
        assert!(problem.contains("a.about: damaged or incomplete"), "{problem}");
        assert!(set_notes(&place, &notes("", "new")).is_err());
        assert_eq!(fs::read_to_string(folder.path().join("a.about")).expect("there"), "(kind: 3");
    }

    #[test]
    fn names_and_notes_that_are_not_allowed_are_refused() {
        let (_folder, saves) = saves();
        let run = run_in(&saves, 1);
        let long = "x".repeat(4001);
        for (refused, message) in [
            (notes("a\nb", ""), "allowed: a name without line breaks"),
            (notes(&"x".repeat(101), ""), "name is 101 characters long; allowed: 1 to 100"),
            (notes("", &long), "notes is 4001 characters long; allowed: up to 4000 characters"),
            (notes("", "\u{7}"), "allowed: text without control characters"),
        ] {
            let error = set_notes(&run, &refused).expect_err("refused").to_string();
            assert!(error.contains(message), "{error}");
        }
        let error = set_notes(&SavePlace::Shipped("fast"), &notes("", "x")).expect_err("built-in");
        assert!(error.to_string().contains("entry is built-in"), "{error}");
        let gone = SavePlace::Champion(saves.path().join("gone.ron"));
        assert!(set_notes(&gone, &notes("", "x")).is_err());
    }
}
