//! Where a library entry is: in the program, in a file or in a folder.

use std::path::{Path, PathBuf};

/// The place of a library entry.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum SavePlace {
    /// A champion that is part of the program, by name; read-only.
    Shipped(&'static str),
    /// A champion's file.
    Champion(PathBuf),
    /// A run's folder.
    Run(PathBuf),
}

impl SavePlace {
    /// Its name: that of the file without its extension, or that of the folder.
    pub fn name(&self) -> String {
        let part = match self {
            Self::Shipped(name) => return (*name).to_owned(),
            Self::Champion(path) => path.file_stem(),
            Self::Run(path) => path.file_name(),
        };
        part.unwrap_or_default().to_string_lossy().into_owned()
    }

    /// The path of its file or folder, if it has one.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Shipped(_) => None,
            Self::Champion(path) | Self::Run(path) => Some(path),
        }
    }

    /// The run's folder, if it is a run.
    pub fn run(&self) -> Option<&Path> {
        match self {
            Self::Run(path) => Some(path),
            Self::Shipped(_) | Self::Champion(_) => None,
        }
    }
}
