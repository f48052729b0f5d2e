//! Champions with which the studio was opened.

use bevy::prelude::*;

use super::staged_champion::StagedChampion;
use snakes_core::save::LoadedChampion;

/// A champion that was read from a file, with its name.
#[derive(Debug, Clone)]
pub(crate) struct NamedChampion {
    /// Name of the champion's file.
    pub name: String,
    /// Champion that was read from the file.
    pub loaded: LoadedChampion,
}

impl From<(String, LoadedChampion)> for NamedChampion {
    fn from((name, loaded): (String, LoadedChampion)) -> Self {
        Self { name, loaded }
    }
}

/// Champions with which the studio was opened.
#[derive(Resource, Debug, Clone)]
pub(crate) struct OpeningChampions(pub Vec<NamedChampion>);

impl OpeningChampions {
    /// Returns the champion with this index, ready for the stage; `None` if there is none.
    pub fn staged(&self, index: usize) -> Option<StagedChampion> {
        self.0.get(index).map(|saved| StagedChampion::from_file(&saved.loaded, index, &saved.name))
    }
}
