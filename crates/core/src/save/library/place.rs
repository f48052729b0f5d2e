//! Places of library entries: in the program, in a file or in a folder.

use std::path::{Path, PathBuf};

use crate::check::printable;

/// Place of a library entry.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum SavePlace {
    /// The name of a champion that is part of the program and cannot be changed.
    Shipped(&'static str),
    /// The path of a champion's file.
    Champion(PathBuf),
    /// The path of a run's folder.
    Run(PathBuf),
}

impl SavePlace {
    /// Returns the name of the entry: that of the file without its extension, or that of the folder.
    pub fn name(&self) -> String {
        let part = match self {
            Self::Shipped(name) => return (*name).to_owned(),
            Self::Champion(path) => path.file_stem(),
            Self::Run(path) => path.file_name(),
        };
        part.unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Returns the name of the entry as one line for people: see [`printable`].
    pub fn shown_name(&self) -> String {
        printable(&self.name()).into_owned()
    }

    /// Returns the path of the file or folder. None for a part of the program.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Shipped(_) => None,
            Self::Champion(path) | Self::Run(path) => Some(path),
        }
    }

    /// Returns the run's folder. None if the entry is not a run.
    pub fn run(&self) -> Option<&Path> {
        match self {
            Self::Run(path) => Some(path),
            Self::Shipped(_) | Self::Champion(_) => None,
        }
    }
}
