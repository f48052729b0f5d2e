//! A run of the learning method: gets candidates from the strategy, evaluates them, and reports the results to it in order.

mod best;
mod changes;
mod choice;
mod evaluation;
mod ladder;

use std::borrow::Cow;
use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, OnceLock};
use std::time::Instant;

use xxhash_rust::xxh3::Xxh3Default;

use super::evaluated_generation::EvaluatedGeneration;
use super::evaluator::Evaluator;
use super::generation_trials::GenerationTrials;
use super::lineage::{Ancestor, Ancestry, Generation, Lineage};
use super::report::GenerationReport;
use super::run_control::{Cancelled, RunControl};
use best::Best;
use choice::choose_champion;
use evaluation::{GenerationResults, evaluate};
use ladder::Ladder;
use snakes_core::check::Invalid;
use snakes_core::evolve::{
    Archive, Candidate, Champion, Front, IndividualId, RunPlan, SettingChange, StairsTree,
    Strategy, begin, resume,
};
use snakes_core::save::{IndividualRecord, LineageRecord, SavedProgress, SearchState};
use snakes_core::score::{Evaluation, Trial};

/// A run between two generations.
pub struct Experiment {
    /// Plan of the generation in progress, or of the last generation.
    plan: RunPlan,
    /// Recorded changes that take effect with later generations, the earliest first.
    ahead: VecDeque<SettingChange>,
    strategy: Box<dyn Strategy>,
    /// Candidates of the next generation, once they were requested, until they are evaluated or a setting changes.
    asked: OnceLock<Vec<Candidate>>,
    ladder: Option<Ladder>,
    front: Front,
    finished: u32,
    evaluated: u64,
    simulations: u64,
    hash: Xxh3Default,
    best: Best,
    /// The best individuals of the last generation, the best first.
    leaders: Vec<Champion>,
    /// The last generation; `None` if an earlier session finished it.
    generation: Option<Arc<Generation>>,
    lineage: Lineage,
    /// Lineage of the last generation, which is to be saved.
    lineage_record: Option<LineageRecord>,
    /// Evaluations of the next generation that were made before the program was stopped, by individual.
    known: BTreeMap<u32, Evaluation>,
}

/// Maximum number of leaders that are kept of a generation.
const MAX_LEADERS: usize = 10;

impl Experiment {
    /// Creates a run that has not begun.
    pub fn new(plan: RunPlan) -> Self {
        Self {
            strategy: begin(&plan),
            asked: OnceLock::new(),
            ladder: Ladder::begin(&plan.settings),
            plan,
            ahead: VecDeque::new(),
            front: Front::default(),
            finished: 0,
            evaluated: 0,
            simulations: 0,
            hash: Xxh3Default::new(),
            best: Best::default(),
            leaders: Vec::new(),
            generation: None,
            lineage: Lineage::default(),
            lineage_record: None,
            known: BTreeMap::new(),
        }
    }

    /// Creates a run that continues from its saved progress, with the same bits as if it had never stopped.
    ///
    /// # Errors
    /// The saved state does not fit the plan.
    pub fn resumed(plan: RunPlan, progress: &SavedProgress) -> Result<Self, Invalid> {
        let finished = progress.records.len() as u32;
        let begun = plan;
        let mut experiment = Self::new(begun.in_generation(finished, &progress.changes)?);
        // Later changes are validated now, because an error in them could not be reported later.
        begun.in_generation(u32::MAX, &progress.changes)?;
        let ahead = progress.changes.iter().filter(|change| change.generation > finished);
        experiment.ahead = ahead.cloned().collect();
        if let Some(SearchState { strategy, front }) = &progress.knowledge {
            experiment.strategy = resume(&experiment.plan, finished, strategy)?;
            experiment.front = front.clone();
        }
        for record in &progress.records {
            experiment.hash.update(&record.hash.to_le_bytes());
        }
        experiment.ladder = Ladder::after(&experiment.plan.settings, &progress.records)?;
        experiment.finished = finished;
        experiment.evaluated =
            progress.records.iter().map(|record| u64::from(record.evaluations)).sum();
        experiment.known = progress.evaluations.iter().copied().collect();
        for champion in progress.champions.iter().flatten() {
            experiment.best.restore(champion, &experiment.plan.settings.evolution);
        }
        experiment.lineage = Lineage::recalled(&progress.lineage);
        if let Some(last) = progress.lineage.last().filter(|last| last.generation == finished) {
            let place = |&IndividualRecord(individual, ..): &IndividualRecord| IndividualId {
                generation: finished,
                individual,
            };
            let pool: Vec<IndividualId> = last.born.iter().map(place).collect();
            experiment.strategy.restore_parents(&pool);
        }
        Ok(experiment)
    }

    /// Returns the number of finished generations.
    pub fn finished(&self) -> u32 {
        self.finished
    }

    /// Returns whether all generations are done, or the next would cost more evaluations than remain.
    pub fn is_over(&self) -> bool {
        self.next_plan().is_over(self.finished, self.evaluated, self.population().into())
    }

    /// Returns the number of individuals in the next generation.
    pub fn population(&self) -> u32 {
        match self.next_plan() {
            Cow::Owned(plan)
                if !plan.settings.evolution.strategy.info().is_budget_driven
                    && !plan.settings.evolution.strategy.info().has_fixed_population =>
            {
                plan.settings.evolution.population
            }
            _ => u32::try_from(self.strategy.population()).unwrap_or(u32::MAX),
        }
    }

    /// Returns the number of evaluations in the finished generations.
    pub fn evaluated(&self) -> u64 {
        self.evaluated
    }

    /// Returns the number of trials that this session has simulated, including repeats and the trials that chose champions.
    pub fn simulations(&self) -> u64 {
        self.simulations
    }

    /// Returns a copy of the strategy's archive of elites, if it has one.
    pub fn archive(&self) -> Option<Archive> {
        self.strategy.archive()
    }

    /// Returns a copy of the tree of stairs, if stairs evolve.
    pub fn stairs_tree(&self) -> Option<StairsTree> {
        self.strategy.stairs_tree()
    }

    /// Returns the best individuals of the last generation that this session has finished, the best first.
    pub fn leaders(&self) -> &[Champion] {
        &self.leaders
    }

    /// Returns the last generation, if this session has finished it.
    pub fn generation(&self) -> Option<&Arc<Generation>> {
        self.generation.as_ref()
    }

    /// Returns the ancestry of the best individual so far.
    pub fn ancestry(&self) -> Ancestry {
        self.lineage.ancestry(self.best.place())
    }

    /// Returns the known parents of the next generation, each with its number of children, in the order of their places.
    pub fn parents(&self) -> Vec<(Arc<Ancestor>, u32)> {
        let mut children = BTreeMap::new();
        let asked = self.asked.get_or_init(|| self.strategy.ask());
        for place in asked.iter().flat_map(|candidate| candidate.parents.ids()) {
            *children.entry(place).or_insert(0) += 1;
        }
        let known = |(place, count)| Some((Arc::clone(self.lineage.get(place)?), count));
        children.into_iter().filter_map(known).collect()
    }

    /// Returns the lineage of the last generation, which is to be saved.
    pub fn lineage_record(&self) -> Option<&LineageRecord> {
        self.lineage_record.as_ref()
    }

    /// Returns the individuals so far that no other beats in both distance and energy.
    pub fn front(&self) -> &Front {
        &self.front
    }

    /// Returns the best individual of all generations so far; of equals, the first found.
    pub fn best(&self) -> Option<&Champion> {
        self.best.champion()
    }

    /// Returns a hash over the bits of every evaluation so far, in the order of generations and individuals.
    pub fn run_hash(&self) -> u64 {
        self.hash.digest()
    }

    /// Returns the state of the strategy and the front, which is to be saved.
    pub fn knowledge(&self) -> SearchState {
        SearchState { strategy: self.strategy.state(), front: self.front.clone() }
    }

    /// Evaluates one generation under the settings that hold for it, and lets the strategy learn from it.
    ///
    /// # Errors
    /// [`Cancelled`], if `control` was cancelled. The experiment is then in the state before the call.
    pub fn run_generation(
        &mut self,
        evaluator: &dyn Evaluator,
        control: &RunControl,
    ) -> Result<GenerationReport, Cancelled> {
        self.run_generation_recording(evaluator, control, |_, _, _| ())
    }

    /// Works as [`Self::run_generation`], and calls `record` with generation, individual and result of each evaluation as soon as
    /// it is made.
    ///
    /// # Errors
    /// As [`Self::run_generation`].
    pub fn run_generation_recording(
        &mut self,
        evaluator: &dyn Evaluator,
        control: &RunControl,
        record: impl Fn(u32, u32, &Evaluation) + Sync,
    ) -> Result<GenerationReport, Cancelled> {
        let started = Instant::now();
        control.set_done(0);
        self.apply_due_changes();
        let generation = self.finished + 1;
        // If this generation is cancelled, the strategy makes the same candidates again.
        let candidates = self.asked.take().unwrap_or_else(|| self.strategy.ask());
        let trials = GenerationTrials::new(self.trial_in(generation), &candidates);
        let record = |individual, evaluation: &_| record(generation, individual, evaluation);
        if self.strategy.learns_from_episodes() {
            // Saved evaluations lack the episodes from which the strategy learns, so they are computed again, with the same bits.
            self.known.clear();
        }
        let GenerationResults { evaluations, episodes, messages } =
            evaluate(&candidates, &trials, &self.known, evaluator, control, &record)?;
        let evaluated = EvaluatedGeneration {
            plan: &self.plan,
            generation,
            trials: &trials,
            rung: self.ladder.as_ref().map(|ladder| ladder.rung_of(&evaluations, &trials.common)),
            candidates: &candidates,
            evaluations: &evaluations,
        };
        let settings = &self.plan.settings.evolution;
        let rank = |champion: &Champion| Best::rank(champion, settings);
        let ranking = evaluated.ranking(rank);
        let (mut champion, of_choice) =
            choose_champion(&evaluated, &ranking, evaluator, control, rank)?;
        if trials.are_own() {
            // With thousands of generations, only champions that are better than all before are kept.
            champion = champion.filter(|champion| self.best.is_beaten_by(champion, settings));
        }
        // Rules that no decision of the champion needs are dropped for readers. A run that starts from it learns new ones.
        champion.iter_mut().for_each(|champion| champion.genome.controller.compact());
        let mut report = GenerationReport::of(&evaluated, champion, messages, started.elapsed());
        let leaders = ranking.iter().take(MAX_LEADERS);
        self.leaders = leaders.map(|&index| evaluated.individual(index)).collect();
        evaluated.extend(&mut self.front);

        self.strategy.learn(episodes);
        self.strategy.tell(&candidates, &evaluations);
        report.set_stairs(self.strategy.stairs_tree().as_ref());
        let simulations = trials.simulations(&evaluations) + of_choice;
        report.record.simulations = Some(simulations);
        self.finished = generation;
        if let Some((ladder, rung)) = self.ladder.as_mut().zip(report.rung) {
            self.strategy.forget_values();
            let before_m = ladder.rise_m();
            ladder.tell(rung.successes, report.evaluations);
            if ladder.rise_m() != before_m {
                // The front's members climbed other stairs than the next generations will.
                self.front = Front::default();
            }
        }
        self.evaluated += evaluations.len() as u64;
        self.simulations += simulations;
        self.known.clear();
        self.hash.update(&report.hash.to_le_bytes());
        if let Some(champion) = &report.champion {
            self.best.take(champion, &self.plan.settings.evolution);
        }
        self.remember(Generation::of(generation, candidates, evaluations));
        Ok(report)
    }

    /// Returns the trial of a generation: the plan's trial, on the rung that the ladder has reached.
    fn trial_in(&self, generation: u32) -> Trial {
        let trial = self.plan.trial_in(generation);
        match &self.ladder {
            Some(ladder) => ladder.trial(trial),
            None => trial,
        }
    }

    /// Keeps the generation that was just finished, and adds its possible parents to the lineage.
    fn remember(&mut self, generation: Generation) {
        let (pool, best) = (self.strategy.parent_pool(), self.best.place());
        self.lineage_record = Some(self.lineage.add(&generation, &pool, best));
        self.lineage.retain(pool.into_iter().chain(best));
        self.generation = Some(Arc::new(generation));
    }
}

#[cfg(test)]
pub(super) mod tests;
