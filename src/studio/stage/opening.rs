//! Champions with which the studio was opened.

use bevy::prelude::*;

use super::staged_champion::StagedChampion;
use snakes_core::save::LoadedChampion;

/// Champions with which the studio was opened, and their names.
#[derive(Resource, Debug, Clone)]
pub(crate) struct OpeningChampions(pub Vec<(String, LoadedChampion)>);

impl OpeningChampions {
    /// Returns the champion with this index, ready for the stage; `None` if there is none.
    pub fn staged(&self, index: usize) -> Option<StagedChampion> {
        self.0.get(index).map(|(name, loaded)| StagedChampion::from_file(loaded, index, name))
    }
}
