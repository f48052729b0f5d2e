//! The limits of a run, and whether it has ended.
//!
//! A run has two limits: its number of generations, and the number of evaluations of that many generations with the planned population
//! ([`RunPlan::budget`]). Some strategies have generations larger than the population, such as the first generation of CMA-ES. Their runs
//! end when the evaluations are spent, after fewer generations.

use super::RunPlan;
use crate::evolve::generation::GenerationRecord;
use crate::evolve::settings::StrategyKind;

impl RunPlan {
    /// Returns whether a run ends after `finished` generations with `evaluated` evaluations, if the next generation has `next` individuals.
    pub fn is_over(&self, finished: u32, evaluated: u64, next: u64) -> bool {
        finished >= self.settings.evolution.generations || evaluated + next > self.budget()
    }

    /// Returns whether a run has ended after the generations of its log.
    pub fn has_ended<'a>(&self, log: impl IntoIterator<Item = &'a GenerationRecord>) -> bool {
        let (mut finished, mut evaluated, mut next) = (0, 0, 0);
        for record in log {
            let evaluations = u64::from(record.evaluations);
            (finished, evaluated) = (finished + 1, evaluated + evaluations);
            next = self.least_after(evaluations);
        }
        self.is_over(finished, evaluated, next)
    }

    /// Returns a lower bound for the size of the generation that follows a generation of `last` individuals.
    fn least_after(&self, last: u64) -> u64 {
        let evolution = &self.settings.evolution;
        match evolution.strategy {
            // With the strategy of islands, generations shrink, down to two islands.
            StrategyKind::Islands => last.min(2 * u64::from(evolution.islands.candidates)),
            // With strategies that evolve stairs, generations vary in size; only the strategy's state determines the next size.
            kind if kind.info().evolves_stairs => 1,
            kind if kind.info().is_budget_driven => last,
            _ => 0,
        }
    }

    /// Returns the planned number of generations in words: "40", or "at most 40" if large generations may lead to fewer.
    pub fn most_generations_in_words(&self) -> String {
        let evolution = &self.settings.evolution;
        let at_most = if evolution.strategy.info().is_budget_driven { "at most " } else { "" };
        format!("{at_most}{}", evolution.generations)
    }

    /// Describes the progress of a run in words: "37 of at most 40 generations". After the end: "40 of 40 generations", or "37 generations"
    /// if those spent all evaluations.
    pub fn generations_in_words(&self, finished: u32, has_ended: bool) -> String {
        match (has_ended, self.settings.evolution.generations) {
            (true, planned) if finished < planned => format!("{finished} generations"),
            (true, planned) => format!("{finished} of {planned} generations"),
            (false, _) => format!("{finished} of {} generations", self.most_generations_in_words()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;

    fn plan(strategy: StrategyKind) -> RunPlan {
        let mut settings = Settings::default();
        (settings.evolution.strategy, settings.evolution.population) = (strategy, 200);
        settings.evolution.generations = 40;
        RunPlan::new("test", 1, settings)
    }

    #[test]
    fn r1_a_run_whose_evaluations_are_spent_has_ended() {
        let plan = plan(StrategyKind::CmaEs);
        // A first generation of 800 and 36 generations of 200 spend the 8,000 evaluations of forty generations of 200.
        let mut records = vec![GenerationRecord::of_test(1, 800)];
        records.extend((2..=36).map(|generation| GenerationRecord::of_test(generation, 200)));
        assert!(!plan.has_ended(&records));
        assert_eq!(plan.generations_in_words(36, false), "36 of at most 40 generations");
        records.push(GenerationRecord::of_test(37, 200));
        assert!(plan.has_ended(&records));
        assert_eq!(plan.generations_in_words(37, true), "37 generations");
    }

    #[test]
    fn a_run_of_equal_generations_has_as_many_as_its_plan_says() {
        let plan = plan(StrategyKind::Halving);
        let records: Vec<_> = (1..=40).map(|of| GenerationRecord::of_test(of, 200)).collect();
        assert_eq!(
            [0, 1, 39, 40].map(|of| plan.has_ended(&records[..of])),
            [false, false, false, true]
        );
        assert_eq!(plan.generations_in_words(39, false), "39 of 40 generations");
    }
}
