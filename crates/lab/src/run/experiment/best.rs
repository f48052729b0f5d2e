//! The best champion of a run, and how its champions are compared.

use snakes_core::evolve::{Champion, EvolutionSettings, IndividualId};

/// The best champion of a run so far; of equals, the first found.
#[derive(Debug, Default)]
pub struct Best(Option<Champion>);

impl Best {
    /// Returns the numbers by which champions of a run are compared in order. Greater numbers are better.
    pub fn rank(champion: &Champion, settings: &EvolutionSettings) -> [f32; 2] {
        if settings.strategy.info().evolves_stairs {
            champion.rank_of_climbed(settings.climbed_from())
        } else {
            champion.rank()
        }
    }

    /// Returns the champion, or `None` if there is none yet.
    pub fn champion(&self) -> Option<&Champion> {
        self.0.as_ref()
    }

    /// Returns the champion's generation and index in it.
    pub fn place(&self) -> Option<IndividualId> {
        let origin = &self.0.as_ref()?.origin;
        Some(IndividualId { generation: origin.generation, individual: origin.individual })
    }

    /// Returns whether a candidate is better than the champion so far, or there is none.
    pub fn is_beaten_by(&self, candidate: &Champion, settings: &EvolutionSettings) -> bool {
        let rank = |champion| Self::rank(champion, settings);
        self.0.as_ref().is_none_or(|best| rank(candidate) > rank(best))
    }

    /// Replaces the champion by the candidate if the candidate is better.
    pub fn take(&mut self, candidate: &Champion, settings: &EvolutionSettings) {
        if self.is_beaten_by(candidate, settings) {
            self.0 = Some(candidate.clone());
        }
    }

    /// Restores a champion that an earlier session saved. Where stairs evolve, a saved champion always replaces the one before: it
    /// was better by the settings of its time.
    pub fn restore(&mut self, kept: &Champion, settings: &EvolutionSettings) {
        if settings.strategy.info().evolves_stairs {
            self.0 = Some(kept.clone());
        } else {
            self.take(kept, settings);
        }
    }
}
