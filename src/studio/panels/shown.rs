//! Champions of the champions list that are on the stage, with the colours of their lanes.

use bevy_egui::egui::Color32;

use crate::studio::commands::pick::Pick;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::staged_champion::{ChampionSource, StagedChampion};
use crate::studio::ui::theme::Palette;
use snakes_core::evolve::{Champion, IndividualId, Origin};

/// Returns the place of a champion in the run that found it.
pub(crate) fn place_of(champion: &Champion) -> IndividualId {
    let Origin { generation, individual, .. } = champion.origin;
    IndividualId { generation, individual }
}

/// Returns the entry of the champions list for a staged champion: an opened champion or an individual of the current run, whose number is
/// `run`.
fn entry_of(staged: &StagedChampion, run: u32) -> Option<Pick> {
    match staged.source() {
        ChampionSource::Opened(index) => Some(Pick::Opened(index)),
        ChampionSource::Run(of) if of == run => Some(Pick::Individual(place_of(staged.champion()))),
        ChampionSource::Library(_)
        | ChampionSource::Run(_)
        | ChampionSource::Lesson
        | ChampionSource::Edited => None,
    }
}

/// A champion of the list that is on the stage, with its lane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ShownLane {
    /// Champion of the list that is on the stage: an opened champion or an individual.
    pub champion: Pick,
    /// Lane of the champion, if several lanes side by side have colours; the first is 0.
    pub lane: Option<usize>,
}

impl ShownLane {
    /// Returns the champions of the list that are on the stage, except ghosts. `run` is the number of the current run.
    pub(crate) fn all(lanes: &[&Lane], run: u32) -> Vec<Self> {
        let racers = || lanes.iter().filter(|lane| !lane.is_ghost);
        let are_many = racers().nth(1).is_some();
        let shown = racers().filter_map(|lane| {
            let champion = entry_of(&lane.staged, run)?;
            Some(Self { champion, lane: are_many.then_some(lane.number) })
        });
        shown.collect()
    }

    /// Returns the colour of the champion's lane, as in the leaderboard; `None` for a single snake.
    pub(crate) fn color(self, palette: &Palette) -> Option<Color32> {
        self.lane.map(|lane| palette.lane_color(lane))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::climber_lane;

    #[test]
    fn lanes_side_by_side_have_their_colours_and_ghosts_or_a_snake_alone_none() {
        let lane = |number| climber_lane(number, "one");
        let shown = |lanes: &[&Lane]| -> Vec<Option<usize>> {
            ShownLane::all(lanes, 0).into_iter().map(|shown| shown.lane).collect()
        };
        assert_eq!(shown(&[&lane(0)]), [None]);
        assert_eq!(shown(&[&lane(0), &lane(1).into_ghost()]), [None]);
        assert_eq!(shown(&[&lane(0), &lane(1)]), [Some(0), Some(1)]);
    }
}
