//! The best champion of a run, and how its champions are compared.

use snakes_core::evolve::{Champion, EvolutionSettings, IndividualId};

/// The best champion of a run so far; of equals, the first found.
#[derive(Debug, Default)]
pub struct Best(Option<Champion>);

impl Best {
    /// The numbers by which the champions of a run are compared: the greater are the better one.
    pub fn rank(champion: &Champion, settings: &EvolutionSettings) -> [f32; 2] {
        if settings.strategy.info().evolves_stairs {
            champion.rank_of_climbed(settings.climbed_from())
        } else {
            champion.rank()
        }
    }

    /// The champion, if there is one.
    pub fn champion(&self) -> Option<&Champion> {
        self.0.as_ref()
    }

    /// The place of the champion in the run.
    pub fn place(&self) -> Option<IndividualId> {
        let origin = &self.0.as_ref()?.origin;
        Some(IndividualId { generation: origin.generation, individual: origin.individual })
    }

    /// Whether a champion is better than all before.
    pub fn is_beaten_by(&self, candidate: &Champion, settings: &EvolutionSettings) -> bool {
        let rank = |champion| Self::rank(champion, settings);
        self.0.as_ref().is_none_or(|best| rank(candidate) > rank(best))
    }

    /// Takes in the champion of a generation.
    pub fn take(&mut self, candidate: &Champion, settings: &EvolutionSettings) {
        if self.is_beaten_by(candidate, settings) {
            self.0 = Some(candidate.clone());
        }
    }

    /// Takes in a champion that an earlier session has kept. Where stairs evolve, only better ones were kept, by the settings
    /// of that time.
    pub fn restore(&mut self, kept: &Champion, settings: &EvolutionSettings) {
        if settings.strategy.info().evolves_stairs {
            self.0 = Some(kept.clone());
        } else {
            self.take(kept, settings);
        }
    }
}
