//! Commands to the library of saves.

use std::path::PathBuf;

use snakes_core::save::library::SavePlace;

/// A command to the library of saves.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum LibraryCommand {
    /// Read the folder of saves, or reread it.
    Refresh,
    /// Load these entries first, because they are visible.
    LoadFirst(Vec<SavePlace>),
    /// Show the champion of an entry on the stage; of a run, its best champion.
    Replay(SavePlace),
    /// Race the champions of entries.
    Race(Vec<SavePlace>),
    /// Show the champion of a run's generation on the stage.
    ReplayGeneration {
        /// The run's folder.
        run: PathBuf,
        /// The generation; the first is 1.
        generation: u32,
    },
    /// Race the champions of these generations of a run. Of many generations, an evenly spaced selection races.
    RaceGenerations {
        /// The run's folder.
        run: PathBuf,
        /// The generations that have a champion.
        generations: Vec<u32>,
    },
    /// Rename a champion's file, or give a run a name of its own.
    Rename {
        /// The champion or run.
        place: SavePlace,
        /// The new name; of a run, empty for its folder's name.
        name: String,
    },
    /// Change the notes of an entry.
    SetNotes {
        /// The champion or run.
        place: SavePlace,
        /// The new notes; empty for none.
        text: String,
    },
    /// Copy champions within the folder of saves.
    Duplicate(Vec<SavePlace>),
    /// Move entries to the trash folder, from where undo restores them.
    Delete(Vec<SavePlace>),
    /// Copy entries to another folder.
    Export {
        /// The entries.
        places: Vec<SavePlace>,
        /// Target folder, or target file for a single champion; without it, the default export folder.
        to: Option<PathBuf>,
    },
    /// Copy champions or runs into the folder of saves.
    Import(Vec<PathBuf>),
    /// Examine champions in the background, and write the results into their files.
    Examine(Vec<SavePlace>),
    /// Stop a batch operation after the current file, and an exam.
    Cancel,
    /// Show the champions that were loaded in the background.
    ShowLoaded,
}
