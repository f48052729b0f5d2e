//! Entries of the champion list that are on the stage.

use crate::evolve::Origin;
use crate::studio::stage::staged_champion::{ChampionSource, StagedChampion};

/// Entry of the champion list that is on the stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ShownChampion {
    /// Champion that the studio opened with; the first is 0.
    Opening(usize),
    /// Individual of the current run.
    Found {
        /// Generation that found it; the first is 1.
        generation: u32,
        /// Index in that generation.
        individual: u32,
    },
}

impl ShownChampion {
    /// List entry of a staged champion, if it has one; `run` is the number of the current run.
    pub(crate) fn of(staged: &StagedChampion, run: u32) -> Option<Self> {
        match staged.source() {
            ChampionSource::Opened(index) => Some(Self::Opening(index)),
            ChampionSource::Run(of) if of == run => {
                let Origin { generation, individual, .. } = staged.champion().origin;
                Some(Self::Found { generation, individual })
            }
            ChampionSource::Library(_) | ChampionSource::Run(_) | ChampionSource::Lesson => None,
        }
    }

    /// Whether this is the given individual of the current run.
    pub(crate) fn is(self, generation: u32, individual: u32) -> bool {
        self == Self::Found { generation, individual }
    }
}
