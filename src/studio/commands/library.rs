//! Commands to the library of saves.

use std::path::PathBuf;

use snakes_core::save::library::SavePlace;

/// A command to the library of saves.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum LibraryCommand {
    /// Read or reread the folder of saves.
    Refresh,
    /// Load these entries first, because they are visible.
    LoadFirst(Vec<SavePlace>),
    /// Show the champion of an entry on the stage; of a run, its best champion.
    Replay(SavePlace),
    /// Race the champions of these entries. A run takes part with its best champion.
    Race(Vec<SavePlace>),
    /// Show the champion of a run's generation on the stage.
    ReplayGeneration {
        /// Folder of the run.
        run: PathBuf,
        /// Number of the generation; the first is 1.
        generation: u32,
    },
    /// Race the champions of these generations of a run.
    RaceGenerations {
        /// Folder of the run.
        run: PathBuf,
        /// Generations that have a champion, at most as many as there are lanes.
        generations: Vec<u32>,
    },
    /// Rename a champion's file, or give a run a name of its own.
    Rename {
        /// Champion or run to rename.
        place: SavePlace,
        /// New name. For a run, an empty name restores that of its folder.
        name: String,
    },
    /// Change the notes of an entry.
    SetNotes {
        /// Champion or run whose notes are changed.
        place: SavePlace,
        /// New notes; empty for none.
        text: String,
    },
    /// Save the selected snake on the stage, in the world in which it is shown.
    SaveSnake,
    /// Copy champions within the folder of saves.
    Duplicate(Vec<SavePlace>),
    /// Move entries to the trash folder, from where undo restores them.
    Delete(Vec<SavePlace>),
    /// Copy entries to another folder.
    Export {
        /// Entries to copy.
        places: Vec<SavePlace>,
        /// Target folder, or target file for a single champion; `None` for the default export folder.
        to: Option<PathBuf>,
    },
    /// Copy champions or runs into the folder of saves.
    Import(Vec<PathBuf>),
    /// Examine champions in the background, and write the results into their files.
    Examine(Vec<SavePlace>),
    /// Stop a batch operation after the current file, and stop an exam.
    Cancel,
    /// Show the champions that were loaded in the background.
    ShowLoaded,
}
