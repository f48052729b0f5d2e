//! Champions that the studio was opened with.

use bevy::prelude::*;

use super::staged_champion::StagedChampion;
use snakes_core::save::LoadedChampion;

/// A named champion from a file.
#[derive(Debug, Clone)]
pub(crate) struct NamedChampion {
    /// Name of its file.
    pub name: String,
    /// The champion.
    pub loaded: LoadedChampion,
}

impl From<(String, LoadedChampion)> for NamedChampion {
    fn from((name, loaded): (String, LoadedChampion)) -> Self {
        Self { name, loaded }
    }
}

/// Champions that the studio was opened with.
#[derive(Resource, Debug, Clone)]
pub(crate) struct OpeningChampions(pub Vec<NamedChampion>);

impl OpeningChampions {
    /// The champion with this index, ready for the stage.
    pub fn staged(&self, index: usize) -> Option<StagedChampion> {
        self.0.get(index).map(|saved| StagedChampion::from_file(&saved.loaded, index, &saved.name))
    }
}
