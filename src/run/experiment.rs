//! A run of the learning method: asks the strategy, evaluates in parallel, tells it in order.

use std::borrow::Cow;
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;
use std::time::Instant;

use rayon::ThreadPool;
use rayon::prelude::*;
use xxhash_rust::xxh3::Xxh3Default;

use super::lineage::Lineage;
use super::report::{Crash, generation_hash, meaning, reasons};
use super::{
    Ancestor, Cancelled, Control, Descent, Generation, GenerationReport, Statistics, caught,
};
use crate::check::{Invalid, within};
use crate::evolve::{
    Archive, Champion, Front, FrontMember, Origin, Place, RunPlan, SettingChange, Settings,
    Strategy, StrategyKind, begin, ranking, resume,
};
use crate::genome::Genome;
use crate::save::{BornRecord, Knowledge, LineageRecord, Progress};
use crate::score::{Evaluation, Trial, evaluate};
use crate::world::Disqualification;

/// A run, between two generations.
pub struct Experiment {
    /// That of the generation under way, or of the last one.
    plan: RunPlan,
    /// Changes that were written down and concern generations to come, the earliest first.
    ahead: VecDeque<SettingChange>,
    strategy: Box<dyn Strategy>,
    front: Front,
    finished: u32,
    evaluated: u64,
    hash: Xxh3Default,
    best: Option<Champion>,
    /// The best of the last generation, the best first.
    leaders: Vec<Champion>,
    /// The last generation, if this session has finished it.
    generation: Option<Arc<Generation>>,
    lineage: Lineage,
    /// What of the last generation is to be written down.
    lineage_record: Option<LineageRecord>,
    /// Evaluations of the next generation that were made before a kill.
    known: BTreeMap<u32, Evaluation>,
    /// Only a test puts another in its place.
    evaluate: fn(&Genome, &Trial) -> Evaluation,
}

/// So many of a generation's crashed genomes are reported; more would tell nothing new.
const MOST_CRASHES: usize = 3;
/// So many of the best of a generation can be seen side by side.
const MOST_LEADERS: usize = 10;

impl Experiment {
    /// A fresh run.
    pub fn new(plan: RunPlan) -> Self {
        Self {
            strategy: begin(&plan),
            plan,
            ahead: VecDeque::new(),
            front: Front::default(),
            finished: 0,
            evaluated: 0,
            hash: Xxh3Default::new(),
            best: None,
            leaders: Vec::new(),
            generation: None,
            lineage: Lineage::default(),
            lineage_record: None,
            known: BTreeMap::new(),
            evaluate,
        }
    }

    /// A run that goes on after what it has behind it, as if it had never been stopped.
    ///
    /// # Errors
    /// What was learned does not fit the plan.
    pub fn resumed(plan: RunPlan, progress: &Progress) -> Result<Self, Invalid> {
        let finished = progress.records.len() as u32;
        let begun = plan;
        let mut experiment = Self::new(begun.in_generation(finished, &progress.changes)?);
        // What is ahead must be allowed, too: when its time comes, nobody is there to be told.
        begun.in_generation(u32::MAX, &progress.changes)?;
        let ahead = progress.changes.iter().filter(|change| change.generation > finished);
        experiment.ahead = ahead.cloned().collect();
        if let Some(Knowledge { strategy, front }) = &progress.knowledge {
            experiment.strategy = resume(&experiment.plan, finished, strategy.clone())?;
            experiment.front = front.clone();
        }
        for record in &progress.records {
            // Reading the log has checked it.
            let hash = record.generation_hash().unwrap_or(0);
            experiment.hash.update(&hash.to_le_bytes());
        }
        experiment.finished = finished;
        experiment.evaluated =
            progress.records.iter().map(|record| u64::from(record.evaluations)).sum();
        experiment.known = progress.evaluations.iter().copied().collect();
        for champion in &progress.champions {
            experiment.keep_if_better(champion.as_ref());
        }
        experiment.lineage = Lineage::recalled(&progress.lineage);
        if let Some(last) = progress.lineage.last().filter(|last| last.generation == finished) {
            let place = |&BornRecord(individual, ..): &BornRecord| Place {
                generation: finished,
                individual,
            };
            let breeders: Vec<Place> = last.born.iter().map(place).collect();
            experiment.strategy.recall(&breeders);
        }
        Ok(experiment)
    }

    /// The settings of the run: those of the next generation, if they were changed.
    pub fn settings(&self) -> Cow<'_, Settings> {
        match self.next_plan() {
            Cow::Borrowed(plan) => Cow::Borrowed(&plan.settings),
            Cow::Owned(plan) => Cow::Owned(plan.settings),
        }
    }

    /// The plan of the next generation.
    pub fn next_plan(&self) -> Cow<'_, RunPlan> {
        let due = self.ahead.iter().take_while(|change| change.generation <= self.finished + 1);
        let mut plan = Cow::Borrowed(&self.plan);
        for change in due {
            // All were found to be allowed before.
            let _ = plan.to_mut().change(change);
        }
        plan
    }

    /// The change of a setting that a person means by a text, from the next generation on; none if that would change
    /// nothing. Nothing is changed yet: see [`Self::amend`].
    ///
    /// # Errors
    /// The setting may not change during a run, its value is not allowed, or an earlier change is still ahead.
    pub fn proposed(&self, field: &str, text: &str) -> Result<Option<SettingChange>, Invalid> {
        let next = self.finished + 1;
        if let Some(later) = self.ahead.iter().find(|change| change.generation > next) {
            let allowed =
                format!("no other change before generation {}, as before", later.generation);
            return Err(Invalid::new("a change during a run", format!("{field:?}"), allowed));
        }
        self.next_plan().proposed(next, field, text)
    }

    /// Makes a change that was proposed: it takes effect with the next generation. What is known of that generation
    /// was found under the old setting, and is forgotten.
    ///
    /// # Errors
    /// As [`Self::proposed`]; nothing is changed then.
    pub fn amend(&mut self, change: &SettingChange) -> Result<(), Invalid> {
        let next = self.finished + 1;
        within("generation", change.generation, next..=next)?;
        self.take_up_changes();
        self.plan.change(change)?;
        self.strategy.amend(&self.plan);
        self.known.clear();
        Ok(())
    }

    /// Makes the changes that were written down for the next generation.
    fn take_up_changes(&mut self) {
        let next = self.finished + 1;
        // One by one, as they were made: there and back is not the same as never.
        while let Some(change) = self.ahead.pop_front_if(|change| change.generation <= next) {
            // All were found to be allowed before.
            let _ = self.plan.change(&change);
            self.strategy.amend(&self.plan);
        }
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

    /// How many individuals the next generation has.
    pub fn population(&self) -> u32 {
        match self.next_plan() {
            // The population of CMA-ES may not change, but changes by itself.
            Cow::Owned(plan) if plan.settings.evolution.strategy != StrategyKind::CmaEs => {
                plan.settings.evolution.population
            }
            _ => u32::try_from(self.strategy.population()).unwrap_or(u32::MAX),
        }
    }

    /// Evaluations of the finished generations.
    pub fn evaluated(&self) -> u64 {
        self.evaluated
    }

    /// The best of every kind so far, if the strategy keeps such an archive.
    pub fn archive(&self) -> Option<&Archive> {
        self.strategy.archive()
    }

    /// The best of the last generation that this session has finished, the best first.
    pub fn leaders(&self) -> &[Champion] {
        &self.leaders
    }

    /// The last generation, if this session has finished it.
    pub fn generation(&self) -> Option<&Arc<Generation>> {
        self.generation.as_ref()
    }

    /// The line of descent of the best individual so far.
    pub fn descent(&self) -> Descent {
        self.lineage.descent(self.best_place())
    }

    /// The parents of the next generation, each with how many children it will have, in the order of their places; as
    /// far as they are known.
    pub fn parents(&self) -> Vec<(Arc<Ancestor>, u32)> {
        let mut children = BTreeMap::new();
        for place in self.strategy.parents().into_iter().flat_map(|parents| parents.places()) {
            *children.entry(place).or_insert(0) += 1;
        }
        let known = |(place, count)| Some((Arc::clone(self.lineage.get(place)?), count));
        children.into_iter().filter_map(known).collect()
    }

    /// What of the last generation is to be written down about who came from whom.
    pub fn lineage_record(&self) -> Option<&LineageRecord> {
        self.lineage_record.as_ref()
    }

    fn best_place(&self) -> Option<Place> {
        let Origin { generation, individual, .. } = self.best.as_ref()?.origin;
        Some(Place { generation, individual })
    }

    /// Who is beaten by nobody in distance and energy so far.
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

    /// What has been learned so far.
    pub fn knowledge(&self) -> Knowledge {
        Knowledge { strategy: self.strategy.state(), front: self.front.clone() }
    }

    /// Evaluates one generation, under the settings that were changed for it, on `pool` and lets the strategy learn from it.
    ///
    /// # Errors
    /// [`Cancelled`], if `control` was; the experiment then is as it was before the call.
    pub fn run_generation(
        &mut self,
        pool: &ThreadPool,
        control: &Control,
    ) -> Result<GenerationReport, Cancelled> {
        self.run_generation_noting(pool, control, |_, _, _| ())
    }

    /// The same; `note` is told of each evaluation as soon as it is made: generation, individual, result.
    ///
    /// # Errors
    /// As [`Self::run_generation`].
    pub fn run_generation_noting(
        &mut self,
        pool: &ThreadPool,
        control: &Control,
        note: impl Fn(u32, u32, &Evaluation) + Sync,
    ) -> Result<GenerationReport, Cancelled> {
        let started = Instant::now();
        control.start_generation();
        self.take_up_changes();
        let generation = self.finished + 1;
        let (genomes, parents) = (self.strategy.ask(), self.strategy.parents());
        let trial = &self.plan.settings.trial;
        let score = |(index, genome): (usize, &Genome)| {
            let individual = index as u32;
            if let Some(known) = self.known.get(&individual) {
                control.count_one();
                return Ok((*known, None));
            }
            control.pass()?;
            let (evaluation, message) = match caught(|| (self.evaluate)(genome, trial)) {
                Ok(evaluation) => (evaluation, None),
                Err(message) => (void_evaluation(), Some(message)),
            };
            // A crash is tried again: the next program may have been mended.
            if message.is_none() {
                note(generation, individual, &evaluation);
            }
            control.count_one();
            Ok((evaluation, message))
        };
        // Collecting a parallel iterator keeps the order of the individuals.
        let scored: Vec<(Evaluation, Option<String>)> =
            pool.install(|| genomes.par_iter().enumerate().map(score).collect::<Result<_, _>>())?;
        let (evaluations, messages): (Vec<Evaluation>, Vec<Option<String>>) =
            scored.into_iter().unzip();

        let individual = |index: usize| Champion {
            genome: genomes[index].clone(),
            trial: trial.clone(),
            evaluation: evaluations[index],
            origin: Origin {
                preset: self.plan.preset.clone(),
                seed: self.plan.seed,
                generation,
                individual: index as u32,
            },
        };
        let crashes = messages.into_iter().enumerate().filter_map(|(index, message)| {
            Some(Crash { individual: individual(index), message: message? })
        });
        let count = |is: fn(&Disqualification) -> bool| {
            let reasons = evaluations.iter().filter_map(|e| e.disqualified.as_ref());
            reasons.filter(|reason| is(reason)).count() as u32
        };
        let ranking = ranking(&evaluations);
        let statistics = Statistics::of(&evaluations);
        let landed = |evaluation: &&Evaluation| evaluation.is_on_landing(&trial.stairs);
        let first_on_landing = evaluations.iter().position(|e| landed(&e));
        let report = GenerationReport {
            generation,
            on_landing: evaluations.iter().filter(landed).count() as u32,
            first_on_landing: first_on_landing.map(|index| index as u32),
            evaluations: evaluations.len() as u32,
            disqualified: count(|_| true),
            reasons: reasons(&evaluations),
            crashed: count(|reason| *reason == Disqualification::Crashed),
            crashes: crashes.take(MOST_CRASHES).collect(),
            statistics,
            meaning: meaning(statistics.as_ref(), trial),
            hash: generation_hash(&evaluations),
            elapsed_s: started.elapsed().as_secs_f64(),
            champion: ranking.first().map(|&index| individual(index)),
        };
        self.leaders = ranking.iter().take(MOST_LEADERS).map(|&index| individual(index)).collect();

        for (index, (genome, evaluation)) in genomes.iter().zip(&evaluations).enumerate() {
            // Hardly anybody is taken in: only who is, is copied.
            if self.front.takes(genome, evaluation, trial.start_y_m) {
                let (genome, evaluation) = (genome.clone(), *evaluation);
                let individual = index as u32;
                let member = FrontMember { genome, evaluation, generation, individual };
                self.front.add(member, trial.start_y_m);
            }
        }
        self.strategy.tell(&genomes, &evaluations);
        self.finished = generation;
        self.evaluated += evaluations.len() as u64;
        self.known.clear();
        self.hash.update(&report.hash.to_le_bytes());
        self.keep_if_better(report.champion.as_ref());
        let genomes = genomes.into_iter().map(Arc::new).collect();
        self.remember(Generation { number: generation, genomes, evaluations, parents });
        Ok(report)
    }

    /// Remembers a generation that was just finished, and who in it may have descendants.
    fn remember(&mut self, generation: Generation) {
        let (breeders, best) = (self.strategy.breeders(), self.best_place());
        self.lineage_record = Some(self.lineage.add(&generation, &breeders, best));
        self.lineage.retain(breeders.into_iter().chain(best));
        self.generation = Some(Arc::new(generation));
    }

    fn keep_if_better(&mut self, candidate: Option<&Champion>) {
        let fitness = |champion: &Champion| champion.evaluation.fitness;
        if let Some(candidate) = candidate
            && self.best.as_ref().is_none_or(|best| fitness(candidate) > fitness(best))
        {
            self.best = Some(candidate.clone());
        }
    }
}

/// What counts for an agent on which the program failed.
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
mod tests {
    use super::*;
    use crate::run::pool;

    fn small(seed: u64) -> Experiment {
        let mut settings = Settings::default();
        settings.evolution.population = 12;
        settings.evolution.generations = 3;
        settings.trial.duration_s = 1.0;
        Experiment::new(RunPlan::new("test", seed, settings))
    }

    fn hash_with(threads: usize, seed: u64) -> u64 {
        let mut experiment = small(seed);
        let pool = pool(threads).expect("a pool");
        while !experiment.is_over() {
            experiment.run_generation(&pool, &Control::default()).expect("not cancelled");
        }
        experiment.run_hash()
    }

    #[test]
    fn the_number_of_threads_does_not_change_the_run_hash() {
        let one = hash_with(1, 1);
        assert_eq!(one, hash_with(2, 1));
        assert_eq!(one, hash_with(4, 1));
        assert_ne!(one, hash_with(1, 2), "the seed does");
    }

    #[test]
    fn a_cancelled_generation_leaves_the_experiment_as_it_was() {
        let mut experiment = small(1);
        let pool = pool(2).expect("a pool");
        let cancelled = Control::default();
        cancelled.cancel();
        assert_eq!(experiment.run_generation(&pool, &cancelled), Err(Cancelled));
        assert_eq!(experiment.finished(), 0);
        while !experiment.is_over() {
            experiment.run_generation(&pool, &Control::default()).expect("not cancelled");
        }
        assert_eq!(experiment.run_hash(), hash_with(1, 1));
    }

    #[test]
    fn an_evaluation_that_panics_is_void_and_counted_and_its_genome_kept() {
        let mut experiment = small(1);
        let healthy = small(1)
            .run_generation(&pool(1).expect("a pool"), &Control::default())
            .expect("not cancelled");
        // The champion's is the one to fail.
        static FAILS: std::sync::OnceLock<Genome> = std::sync::OnceLock::new();
        let champion = healthy.champion.expect("somebody was healthy");
        FAILS.set(champion.genome.clone()).expect("set once");
        experiment.evaluate = |genome, trial| {
            assert_ne!(Some(genome), FAILS.get(), "index out of bounds");
            evaluate(genome, trial)
        };
        let hash_with = |experiment: &mut Experiment, threads| {
            let pool = pool(threads).expect("a pool");
            experiment.run_generation(&pool, &Control::default()).expect("not cancelled")
        };
        let report = hash_with(&mut experiment, 2);
        assert_eq!((report.crashed, report.disqualified), (1, healthy.disqualified + 1));
        let crash = report.crashes.first().expect("reported");
        assert_eq!(crash.individual.genome, champion.genome);
        assert_eq!(crash.individual.origin, champion.origin);
        assert!(crash.message.contains("index out of bounds"), "{}", crash.message);
        assert_ne!(report.champion, Some(champion), "another is the best");
        assert!(!experiment.is_over(), "and the run goes on");
        hash_with(&mut experiment, 2);
    }

    #[test]
    fn evaluations_that_are_known_are_not_made_again_and_change_nothing() {
        let pool = pool(2).expect("a pool");
        let noted = std::sync::Mutex::new(Vec::new());
        let note = |_, individual, evaluation: &Evaluation| {
            noted.lock().expect("no panic").push((individual, *evaluation));
        };
        let mut first = small(1);
        first.run_generation_noting(&pool, &Control::default(), note).expect("not cancelled");
        let mut noted = noted.into_inner().expect("no panic");
        noted.truncate(7);
        let progress = Progress {
            changes: Vec::new(),
            records: Vec::new(),
            champions: Vec::new(),
            knowledge: None,
            evaluations: noted.clone(),
            lineage: Vec::new(),
        };
        let mut again = Experiment::resumed(first.plan.clone(), &progress).expect("it fits");
        let made = std::sync::atomic::AtomicU32::new(0);
        let count = |_, individual, _: &Evaluation| {
            assert!(noted.iter().all(|(known, _)| *known != individual));
            made.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        };
        again.run_generation_noting(&pool, &Control::default(), count).expect("not cancelled");
        assert_eq!(made.into_inner(), 5);
        assert_eq!(again.run_hash(), first.run_hash());
    }

    #[test]
    fn the_last_generation_is_kept_with_its_parents_and_the_best_has_its_line() {
        let mut experiment = small(1);
        let pool = pool(2).expect("a pool");
        while !experiment.is_over() {
            experiment.run_generation(&pool, &Control::default()).expect("not cancelled");
        }
        let generation = experiment.generation().expect("kept");
        assert_eq!((generation.number, generation.genomes.len()), (3, 12));
        let best = experiment.best().expect("somebody was healthy");
        let line = experiment.descent().line;
        assert_eq!(line.len() as u32, best.origin.generation, "back to the first generation");
        assert_eq!(line[0].fitness, Some(best.evaluation.fitness));
        assert_eq!(line[0].genome.as_deref(), Some(&best.genome));
        assert_eq!(experiment.descent().spreads.len(), 3);
        let parents = experiment.parents();
        assert_eq!(parents.len(), 4, "the report has four");
        assert!(parents.iter().all(|(_, children)| *children == 3));
    }

    #[test]
    fn the_champion_scores_the_same_when_it_is_seen_again() {
        let mut experiment = small(3);
        let pool = pool(2).expect("a pool");
        let report = experiment.run_generation(&pool, &Control::default()).expect("not cancelled");
        let champion = report.champion.expect("somebody was healthy");
        assert_eq!(evaluate(&champion.genome, &champion.trial), champion.evaluation);
        assert_eq!(experiment.best(), Some(&champion));
    }
}
