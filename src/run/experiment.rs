//! A run of the learning method: asks the strategy, evaluates in parallel, tells it in order.

use std::time::Instant;

use rayon::ThreadPool;
use rayon::prelude::*;
use xxhash_rust::xxh3::Xxh3Default;

use super::report::generation_hash;
use super::{Cancelled, Control, GenerationReport, Statistics};
use crate::evolve::{Champion, Halving, Origin, Settings, Strategy, ranking};
use crate::genome::Genome;
use crate::score::{Evaluation, evaluate};

/// A run, between two generations.
pub struct Experiment {
    preset: String,
    seed: u64,
    settings: Settings,
    strategy: Halving,
    finished: u32,
    hash: Xxh3Default,
    best: Option<Champion>,
}

impl Experiment {
    /// A fresh run. The settings must have passed their check.
    pub fn new(preset: &str, seed: u64, settings: Settings) -> Self {
        let strategy = Halving::new(
            settings.evolution.clone(),
            settings.genome.clone(),
            seed,
            settings.trial.agent.joints(),
            settings.trial.duration_s,
        );
        Self {
            preset: preset.to_owned(),
            seed,
            settings,
            strategy,
            finished: 0,
            hash: Xxh3Default::new(),
            best: None,
        }
    }

    /// The settings of the run.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Generations finished so far.
    pub fn finished(&self) -> u32 {
        self.finished
    }

    /// Whether all generations are done.
    pub fn is_over(&self) -> bool {
        self.finished >= self.settings.evolution.generations
    }

    /// The best individual of all generations so far; of equals, the first found.
    pub fn best(&self) -> Option<&Champion> {
        self.best.as_ref()
    }

    /// Hash over the bits of every evaluation so far, in the order of generations and individuals.
    pub fn run_hash(&self) -> u64 {
        self.hash.digest()
    }

    /// Evaluates one generation on `pool` and lets the strategy learn from it.
    ///
    /// # Errors
    /// [`Cancelled`], if `control` was; the experiment then is as it was before the call.
    pub fn run_generation(
        &mut self,
        pool: &ThreadPool,
        control: &Control,
    ) -> Result<GenerationReport, Cancelled> {
        let started = Instant::now();
        control.start_generation();
        let genomes = self.strategy.ask();
        let trial = &self.settings.trial;
        let score = |genome: &Genome| {
            control.pass()?;
            let evaluation = evaluate(genome, trial);
            control.count_one();
            Ok(evaluation)
        };
        // Collecting a parallel iterator keeps the order of the individuals.
        let evaluations: Vec<Evaluation> =
            pool.install(|| genomes.par_iter().map(score).collect::<Result<_, _>>())?;

        let statistics = Statistics::of(&evaluations);
        let champion = ranking(&evaluations).first().map(|&index| Champion {
            genome: genomes[index].clone(),
            trial: trial.clone(),
            evaluation: evaluations[index],
            origin: Origin {
                preset: self.preset.clone(),
                seed: self.seed,
                generation: self.finished + 1,
                individual: index as u32,
            },
        });
        let meaning = match statistics {
            Some(statistics) => trial.meaning(statistics.mean_centre_y_m),
            None => "all disqualified".to_owned(),
        };
        let hash = generation_hash(&evaluations);

        self.strategy.tell(&genomes, &evaluations);
        self.finished += 1;
        self.hash.update(&hash.to_le_bytes());
        self.keep_if_better(champion.as_ref());
        Ok(GenerationReport {
            generation: self.finished,
            evaluations: evaluations.len() as u32,
            disqualified: evaluations.iter().filter(|e| e.disqualified.is_some()).count() as u32,
            statistics,
            meaning,
            hash,
            elapsed_s: started.elapsed().as_secs_f64(),
            champion,
        })
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::pool;

    fn small(seed: u64) -> Experiment {
        let mut settings = Settings::default();
        settings.evolution.population = 12;
        settings.evolution.generations = 3;
        settings.trial.duration_s = 1.0;
        Experiment::new("test", seed, settings)
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
    fn the_champion_scores_the_same_when_it_is_seen_again() {
        let mut experiment = small(3);
        let pool = pool(2).expect("a pool");
        let report = experiment.run_generation(&pool, &Control::default()).expect("not cancelled");
        let champion = report.champion.expect("somebody was healthy");
        assert_eq!(evaluate(&champion.genome, &champion.trial), champion.evaluation);
        assert_eq!(experiment.best(), Some(&champion));
    }
}
