//! Learning by trial and error: all snakes of a run share their knowledge.
//!
//! A generation is a number of episodes. In the first episode the snake acts by the knowledge, without exploration. Only this snake can
//! become a champion, because the success of an explorer may be luck. The other snakes explore, the first of them most and the last least.
//! Then the learner learns from all episodes, in the order of their indices.

use super::learned::Learned;
use super::search::Search;
use crate::check::Invalid;
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::Parents;
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::EvolutionSettings;
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::genome::Genome;
use crate::genome::controllers::Explorer;
use crate::learn::Episode;
use crate::learn::q_table::epsilon;
use crate::rng::Purpose;
use crate::score::Evaluation;

/// A learner whose knowledge all episodes share.
#[derive(Debug, Clone)]
pub struct Learning<L> {
    search: Search,
    evolution: EvolutionSettings,
    /// Genome of all episodes, into which the knowledge is put: the founder, or the genome in the middle of all ranges.
    first: Genome,
    learned: L,
}

impl<L: Learned> Learning<L> {
    fn with(plan: &RunPlan, finished: u32, learned: L) -> Self {
        let search = Search::new(plan, finished);
        let middle = || search.genome(&vec![0.5; search.dimension()]);
        Self {
            first: plan.founder.as_ref().map_or_else(middle, |of| of.genome().clone()),
            search,
            evolution: plan.settings.evolution.clone(),
            learned,
        }
    }

    /// Returns how an individual explores. None for the first individual, which does not explore.
    fn explorer(&self, individual: usize) -> Option<Explorer> {
        let individual = individual as u32;
        let (finished, actors) = (self.search.generation - 1, self.search.population as u32);
        let ladder = self.evolution.exploration.ladder();
        (individual > 0).then(|| Explorer {
            epsilon: epsilon(finished, individual, actors, &ladder),
            seed: self.search.seed,
            generation: self.search.generation,
            individual,
            rule: self.evolution.q_learning.rule(),
        })
    }
}

impl<L: Learned> Strategy for Learning<L> {
    fn begin(plan: &RunPlan) -> Self {
        let founded = plan.founder.as_ref().and_then(|of| L::of(&of.genome().controller));
        // If the knowledge of the founder does not fit, only the rest of its genome is used.
        let mut fitting = founded.filter(|learned| learned.check_fits(plan).is_ok());
        if let Some(learned) = &mut fitting {
            // The founder learned under other settings.
            learned.apply(&plan.settings.evolution);
        }
        Self::with(plan, 0, fitting.unwrap_or_else(|| L::first(plan)))
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let learned: L = state.read()?;
        learned.check_fits(plan).map_err(|error| error.inside("state"))?;
        Ok(Self::with(plan, finished, learned))
    }

    fn ask(&self) -> Vec<Candidate> {
        let candidate = |individual| {
            let mut genome = self.first.clone();
            let explorer = self.explorer(individual);
            let may_be_champion = explorer.is_none();
            self.learned.give(&mut genome.controller, explorer);
            Candidate { may_be_champion, ..Candidate::new(genome, Parents::None) }
        };
        (0..self.search.population).map(candidate).collect()
    }

    fn population(&self) -> usize {
        self.search.population
    }

    fn learns_from_episodes(&self) -> bool {
        true
    }

    fn learn(&mut self, episodes: Vec<Option<Episode>>) {
        let mut rng = self.search.stream(0, Purpose::Learn);
        let episodes: Vec<Episode> = episodes.into_iter().flatten().collect();
        self.learned.learn(episodes, &self.evolution, &mut rng);
    }

    fn tell(&mut self, _: &[Candidate], _: &[Evaluation]) {
        self.search.generation += 1;
    }

    fn state(&self) -> StrategyState {
        StrategyState::of(&self.learned)
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.search.apply_settings(plan);
        self.evolution = plan.settings.evolution.clone();
        self.learned.apply(&self.evolution);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{Founder, StrategyKind, with_fields};
    use crate::genome::controllers::Policy;
    use crate::genome::{ControllerGenes, ControllerKind};
    use crate::save::load_preset;

    #[test]
    fn rules_of_a_founder_learn_under_the_settings_of_the_run() {
        let settings = load_preset("xcs").expect("shipped").settings;
        assert_eq!(settings.evolution.strategy, StrategyKind::Xcs);
        assert_eq!(settings.genome.controller, ControllerKind::Decisions);
        let founder = Learning::<Policy>::begin(&RunPlan::new("x", 1, settings.clone())).ask();
        let changed = with_fields(&settings, [("xcs.learning_rate", "0.5")]).expect("allowed");
        let plan = RunPlan::new("x", 1, changed);
        let plan =
            plan.starting_from(Founder::new("x", founder[0].genome.clone())).expect("it fits");
        let asked = Learning::<Policy>::begin(&plan).ask();
        let ControllerGenes::Decisions(genes) = &asked[0].genome.controller else {
            panic!("decisions")
        };
        let Policy::Xcs(rules) = &genes.policy else { panic!("rules") };
        assert_eq!(rules.settings.learning_rate, 0.5);
    }
}
