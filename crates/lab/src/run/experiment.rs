//! A run of the learning method: asks the strategy, evaluates the genomes, and tells it the results in order.

mod changes;
mod choice;
mod ladder;
mod trials;

use std::borrow::Cow;
use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, OnceLock};
use std::time::Instant;

use xxhash_rust::xxh3::Xxh3Default;

use super::evaluator::{EvaluationResult, Evaluator, Job, evaluate_caught};
use super::lineage::{Ancestor, Ancestry, Generation, Lineage};
use super::report::{EvaluatedGeneration, GenerationReport};
use super::run_control::{Cancelled, RunControl};
use choice::choose_champion;
use ladder::Ladder;
use snakes_core::check::Invalid;
use snakes_core::evolve::{
    Archive, Champion, Front, FrontMember, IndividualId, Origin, RunPlan, SettingChange,
    StairsTree, Strategy, begin, ranking, resume,
};
use snakes_core::genome::Genome;
use snakes_core::save::{IndividualRecord, LineageRecord, SavedProgress, SearchState};
use snakes_core::score::{Evaluation, Scored, Trial};
use snakes_core::world::Disqualification;
pub use trials::GenerationTrials;

/// A run, between two generations.
pub struct Experiment {
    /// The plan of the generation in progress, or of the last one.
    plan: RunPlan,
    /// Recorded changes that take effect with later generations, the earliest first.
    ahead: VecDeque<SettingChange>,
    strategy: Box<dyn Strategy>,
    ladder: Option<Ladder>,
    front: Front,
    finished: u32,
    evaluated: u64,
    simulations: u64,
    hash: Xxh3Default,
    best: Option<Champion>,
    /// The best individuals of the last generation, the best first.
    leaders: Vec<Champion>,
    /// The last generation, if this session has finished it.
    generation: Option<Arc<Generation>>,
    lineage: Lineage,
    /// Lineage of the last generation, to be saved.
    lineage_record: Option<LineageRecord>,
    /// Evaluations of the next generation that were made before the program was stopped.
    known: BTreeMap<u32, Evaluation>,
}

/// Maximum number of leaders that are kept of a generation.
const MAX_LEADERS: usize = 10;

impl Experiment {
    /// A fresh run.
    pub fn new(plan: RunPlan) -> Self {
        Self {
            strategy: begin(&plan),
            ladder: Ladder::begin(&plan.settings),
            plan,
            ahead: VecDeque::new(),
            front: Front::default(),
            finished: 0,
            evaluated: 0,
            simulations: 0,
            hash: Xxh3Default::new(),
            best: None,
            leaders: Vec::new(),
            generation: None,
            lineage: Lineage::default(),
            lineage_record: None,
            known: BTreeMap::new(),
        }
    }

    /// A run that continues from its saved progress, with the same bits as if it had never been stopped.
    ///
    /// # Errors
    /// The saved state does not fit the plan.
    pub fn resumed(plan: RunPlan, progress: &SavedProgress) -> Result<Self, Invalid> {
        let finished = progress.records.len() as u32;
        let begun = plan;
        let mut experiment = Self::new(begun.in_generation(finished, &progress.changes)?);
        // Validate future changes now; later an error could not be reported.
        begun.in_generation(u32::MAX, &progress.changes)?;
        let ahead = progress.changes.iter().filter(|change| change.generation > finished);
        experiment.ahead = ahead.cloned().collect();
        if let Some(SearchState { strategy, front }) = &progress.knowledge {
            experiment.strategy = resume(&experiment.plan, finished, strategy)?;
            experiment.front = front.clone();
        }
        for record in &progress.records {
            // Reading the log has checked it.
            let hash = record.generation_hash().unwrap_or(0);
            experiment.hash.update(&hash.to_le_bytes());
        }
        experiment.ladder = Ladder::after(&experiment.plan.settings, &progress.records)?;
        experiment.finished = finished;
        experiment.evaluated =
            progress.records.iter().map(|record| u64::from(record.evaluations)).sum();
        experiment.known = progress.evaluations.iter().copied().collect();
        for champion in progress.champions.iter().flatten() {
            if experiment.was_better(champion) {
                experiment.best = Some(champion.clone());
            }
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

    /// Generations finished so far.
    pub fn finished(&self) -> u32 {
        self.finished
    }

    /// Whether all generations are done, or the next would cost more evaluations than are left.
    pub fn is_over(&self) -> bool {
        let plan = self.next_plan();
        self.finished >= plan.settings.evolution.generations
            || self.evaluated + u64::from(self.population()) > plan.budget()
    }

    /// Number of individuals in the next generation.
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

    /// Number of evaluations in the finished generations.
    pub fn evaluated(&self) -> u64 {
        self.evaluated
    }

    /// Number of trials that this session has simulated: each repeat of an evaluation, and those that chose champions.
    pub fn simulations(&self) -> u64 {
        self.simulations
    }

    /// A copy of the strategy's archive of elites, if it has one.
    pub fn archive(&self) -> Option<Archive> {
        self.strategy.archive()
    }

    /// A copy of the tree of stairs, if stairs evolve.
    pub fn stairs_tree(&self) -> Option<StairsTree> {
        self.strategy.stairs_tree()
    }

    /// The best individuals of the last generation that this session has finished, the best first.
    pub fn leaders(&self) -> &[Champion] {
        &self.leaders
    }

    /// The last generation, if this session has finished it.
    pub fn generation(&self) -> Option<&Arc<Generation>> {
        self.generation.as_ref()
    }

    /// The ancestry of the best individual so far.
    pub fn ancestry(&self) -> Ancestry {
        self.lineage.ancestry(self.best_place())
    }

    /// The known parents of the next generation, each with its number of children, in the order of their places.
    pub fn parents(&self) -> Vec<(Arc<Ancestor>, u32)> {
        let mut children = BTreeMap::new();
        for place in self.strategy.parents().into_iter().flat_map(|parents| parents.ids()) {
            *children.entry(place).or_insert(0) += 1;
        }
        let known = |(place, count)| Some((Arc::clone(self.lineage.get(place)?), count));
        children.into_iter().filter_map(known).collect()
    }

    /// Lineage of the last generation, to be saved.
    pub fn lineage_record(&self) -> Option<&LineageRecord> {
        self.lineage_record.as_ref()
    }

    fn best_place(&self) -> Option<IndividualId> {
        let Origin { generation, individual, .. } = self.best.as_ref()?.origin;
        Some(IndividualId { generation, individual })
    }

    /// The individuals so far that no other beats in both distance and energy.
    pub fn front(&self) -> &Front {
        &self.front
    }

    /// The best individual of all generations so far; of equals, the first found.
    pub fn best(&self) -> Option<&Champion> {
        self.best.as_ref()
    }

    /// Hash over the bits of every evaluation so far, in the order of generations and individuals.
    pub fn run_hash(&self) -> u64 {
        self.hash.digest()
    }

    /// The state of the strategy and the front, to be saved.
    pub fn knowledge(&self) -> SearchState {
        SearchState { strategy: self.strategy.state(), front: self.front.clone() }
    }

    /// Evaluates one generation, under the settings that were changed for it, and lets the strategy learn from it.
    ///
    /// # Errors
    /// [`Cancelled`], if `control` was; the experiment then is as it was before the call.
    pub fn run_generation(
        &mut self,
        evaluator: &dyn Evaluator,
        control: &RunControl,
    ) -> Result<GenerationReport, Cancelled> {
        self.run_generation_recording(evaluator, control, |_, _, _| ())
    }

    /// The same; calls `record` with generation, individual and result of each evaluation as soon as it is made.
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
        control.start_generation();
        self.apply_due_changes();
        let generation = self.finished + 1;
        let (genomes, parents) = (self.strategy.ask(), self.strategy.parents());
        let record = |individual, evaluation: &_| record(generation, individual, evaluation);
        let stairs = self.strategy.stairs();
        let trials = GenerationTrials::new(self.trial_in(generation), &stairs);
        let results = self.evaluate(&genomes, &trials, evaluator, control, &record)?;
        let (mut evaluations, mut episodes, mut messages) = (Vec::new(), Vec::new(), Vec::new());
        for result in results {
            let (scored, message) = match result {
                Ok(scored) => (scored, None),
                Err(message) => {
                    (Scored { evaluation: void_evaluation(), episode: None }, Some(message))
                }
            };
            evaluations.push(scored.evaluation);
            episodes.push(scored.episode);
            messages.push(message);
        }

        let mut ranking = ranking(&evaluations);
        ranking.retain(|&index| self.strategy.may_be_champion(index));
        let bands = bands(&self.plan, &*self.strategy, &genomes);
        let evaluated = EvaluatedGeneration {
            plan: &self.plan,
            generation,
            trials: &trials,
            rung: self.ladder.as_ref().map(|ladder| ladder.rung_of(&evaluations, &trials.common)),
            genomes: &genomes,
            evaluations: &evaluations,
            species: &bands,
        };
        if trials.are_own() {
            // The best on stairs that they climb, the highest first.
            let rank = |index: usize| self.rank(&evaluated.individual(index));
            let ranks: Vec<[f32; 2]> = (0..genomes.len()).map(rank).collect();
            ranking.sort_by(|&a, &b| {
                ranks[b].partial_cmp(&ranks[a]).unwrap_or(std::cmp::Ordering::Equal)
            });
        }
        let (mut champion, of_choice) =
            choose_champion(&evaluated, &ranking, evaluator, control, |of| self.rank(of))?;
        if trials.are_own() {
            // There are thousands of generations. Those that are better than all before are enough.
            champion = champion.filter(|champion| self.is_better(champion));
        }
        // People read its rules. A run that starts from it learns again what it needs besides.
        champion.iter_mut().for_each(|champion| champion.genome.controller.compact());
        let mut report = evaluated.report(champion, messages, started.elapsed());
        let leaders = ranking.iter().take(MAX_LEADERS);
        self.leaders = leaders.map(|&index| evaluated.individual(index)).collect();

        for (index, (genome, evaluation)) in genomes.iter().zip(&evaluations).enumerate() {
            // Distances on different stairs cannot be compared.
            if trials.are_own() || !self.strategy.may_be_champion(index) {
                continue;
            }
            let start_y_m = trials.common.middle_start_y_m(genome);
            // Clone only the few genomes that enter the front.
            if self.front.accepts(genome, evaluation, start_y_m) {
                let (genome, evaluation) = (genome.clone(), *evaluation);
                let individual = index as u32;
                let member = FrontMember { genome, evaluation, generation, individual };
                self.front.add(member, start_y_m);
            }
        }
        self.strategy.learn(episodes);
        self.strategy.tell(&genomes, &evaluations);
        report.set_stairs(self.strategy.stairs_tree().as_ref());
        self.finished = generation;
        if let Some((ladder, rung)) = self.ladder.as_mut().zip(report.rung) {
            self.strategy.forget_values();
            let before_m = ladder.rise_m();
            ladder.tell(rung.successes, report.evaluations);
            if ladder.rise_m() != before_m {
                // Its members climbed other stairs than those that follow.
                self.front = Front::default();
            }
        }
        self.evaluated += evaluations.len() as u64;
        let simulations = evaluations
            .iter()
            .enumerate()
            .map(|(index, evaluation)| u64::from(trials.of(index).simulations_of(evaluation)));
        self.simulations += simulations.sum::<u64>() + of_choice;
        self.known.clear();
        self.hash.update(&report.hash.to_le_bytes());
        self.keep_if_better(report.champion.as_ref());
        let genomes = genomes.into_iter().map(Arc::new).collect();
        self.remember(Generation { number: generation, genomes, evaluations, parents, stairs });
        Ok(report)
    }

    /// Evaluates the genomes whose results are not known yet. Returns all results in the order of the individuals,
    /// whichever the evaluator reported first.
    fn evaluate(
        &self,
        genomes: &[Genome],
        trials: &GenerationTrials,
        evaluator: &dyn Evaluator,
        control: &RunControl,
        record: &(dyn Fn(u32, &Evaluation) + Sync),
    ) -> Result<Vec<EvaluationResult>, Cancelled> {
        // A journal of evaluations has no experience to learn from; it is computed again, with the same bits.
        let is_enough = !self.strategy.learns_from_episodes();
        let result_of = |index: usize| match self.known.get(&(index as u32)) {
            Some(known) if is_enough => {
                OnceLock::from(Ok(Scored { evaluation: *known, episode: None }))
            }
            _ => OnceLock::new(),
        };
        let results: Vec<OnceLock<EvaluationResult>> = (0..genomes.len()).map(result_of).collect();
        let unknown: Vec<usize> =
            (0..genomes.len()).filter(|&index| results[index].get().is_none()).collect();
        (unknown.len()..genomes.len()).for_each(|_| control.count_one());
        let store = |index: usize, result: EvaluationResult| {
            let evaluation = result.as_ref().ok().map(|scored| scored.evaluation);
            if results[index].set(result).is_err() {
                return;
            }
            // A crash is not recorded: after a resume it is tried again, perhaps by a corrected program.
            if let Some(evaluation) = evaluation {
                record(index as u32, &evaluation);
            }
            control.count_one();
        };
        let job = |&index: &usize| Job { genome: &genomes[index], trial: trials.index_of(index) };
        let jobs: Vec<Job<'_>> = unknown.iter().map(job).collect();
        evaluator.evaluate_jobs(&trials.all, &jobs, control, &|job, result| {
            if let Some(&index) = unknown.get(job) {
                store(index, result);
            }
        })?;
        for &index in &unknown {
            if results[index].get().is_none() {
                control.wait_while_paused()?;
                store(index, evaluate_caught(&genomes[index], trials.of(index)));
            }
        }
        Ok(results.into_iter().filter_map(OnceLock::into_inner).collect())
    }

    /// The trial of a generation: that of the plan, on the rung that the ladder has reached.
    fn trial_in(&self, generation: u32) -> Trial {
        let trial = self.plan.trial_in(generation);
        match &self.ladder {
            Some(ladder) => ladder.trial(trial),
            None => trial,
        }
    }

    /// Keeps the generation that was just finished, and its possible parents in the lineage.
    fn remember(&mut self, generation: Generation) {
        let (pool, best) = (self.strategy.parent_pool(), self.best_place());
        self.lineage_record = Some(self.lineage.add(&generation, &pool, best));
        self.lineage.retain(pool.into_iter().chain(best));
        self.generation = Some(Arc::new(generation));
    }

    /// The numbers by which champions of this run are compared: the greater are the better one.
    fn rank(&self, champion: &Champion) -> [f32; 2] {
        let settings = &self.plan.settings.evolution;
        if settings.strategy.info().evolves_stairs {
            champion.rank_of_climbed(settings.climbed_from())
        } else {
            champion.rank()
        }
    }

    /// Whether a champion that an earlier session has kept is better than those before it. Where stairs evolve, only better
    /// ones were kept, by the settings of that time.
    fn was_better(&self, kept: &Champion) -> bool {
        self.plan.settings.evolution.strategy.info().evolves_stairs || self.is_better(kept)
    }

    /// Whether a champion is better than all before.
    fn is_better(&self, candidate: &Champion) -> bool {
        self.best.as_ref().is_none_or(|best| self.rank(candidate) > self.rank(best))
    }

    fn keep_if_better(&mut self, candidate: Option<&Champion>) {
        if let Some(candidate) = candidate
            && self.is_better(candidate)
        {
            self.best = Some(candidate.clone());
        }
    }
}

/// The number by which each individual is counted: of its species, or of its blocks where bodies evolve. Empty if there
/// is none.
fn bands<'a>(plan: &RunPlan, strategy: &'a dyn Strategy, genomes: &[Genome]) -> Cow<'a, [u32]> {
    if plan.settings.genome.bodies.vary {
        genomes.iter().map(|genome| genome.body.block_count() as u32).collect()
    } else {
        strategy.species().into()
    }
}

/// The evaluation of an individual whose simulation panicked.
fn void_evaluation() -> Evaluation {
    let disqualified = Some(Disqualification::Crashed);
    Evaluation {
        fitness: 0.0,
        centre_y_m: 0.0,
        disqualified,
        trace_hash: 0,
        steps: 0,
        effort: None,
        behaviour: None,
    }
}

#[cfg(test)]
mod tests;
