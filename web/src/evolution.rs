//! Evolution from a champion, one evaluation at a time, so that a page can show the progress and stop it.

use serde_json::{Value, json};
use snakes_core::evolve::{
    Candidate, Champion, Founder, RunPlan, Settings, Strategy, StrategyKind, begin, ranking,
};
use snakes_core::genome::GenomeSpace;
use snakes_core::save::champion_text;
use snakes_core::score::{Evaluation, Scored, score};

use crate::replay::trial_with;

/// Number of generations of the search, more than a user waits for.
const GENERATIONS: u32 = 10_000;

/// A search that descends from a champion.
pub struct Evolution {
    plan: RunPlan,
    strategy: Box<dyn Strategy>,
    generation: u32,
    candidates: Vec<Candidate>,
    scored: Vec<Scored>,
    best: Option<Champion>,
    /// Best fitness in each finished generation with a healthy individual.
    history: Vec<f32>,
}

impl Evolution {
    /// Begins a search from a champion with the genetic algorithm, or with the learner that the champion's controller needs.
    pub fn begin(
        champion: Champion,
        friction: Option<f32>,
        seed: u64,
        population: u32,
    ) -> Result<Self, String> {
        let trial = trial_with(&champion, friction)?;
        let kind = champion.genome.controller.kind();
        let genome = GenomeSpace { controller: kind, ..GenomeSpace::default() };
        let mut settings =
            Settings { trial, genome: genome.widened_for(&champion.genome), ..Settings::default() };
        settings.evolution.population = population;
        settings.evolution.generations = GENERATIONS;
        let strategies = StrategyKind::ALL.into_iter();
        let mut fitting = strategies.filter(|strategy| strategy.controllers().any(|of| of == kind));
        let is_plain = fitting.clone().any(|strategy| strategy == StrategyKind::Ga);
        settings.evolution.strategy = match is_plain {
            true if settings.genome.bodies.vary => StrategyKind::BodyGa,
            true => StrategyKind::Ga,
            false => fitting.next().ok_or("nothing can evolve this controller")?,
        };
        settings.check().map_err(|error| error.to_string())?;
        let plan = RunPlan::new("page", seed, settings);
        let plan = plan.starting_from(Founder::new("page", champion.genome));
        let plan = plan.map_err(|error| error.to_string())?;
        let strategy = begin(&plan);
        let candidates = strategy.ask();
        let (scored, history) = (Vec::new(), Vec::new());
        Ok(Self { plan, strategy, generation: 1, candidates, scored, best: None, history })
    }

    /// Evaluates the next individual. After the last one of a generation, the search learns from all.
    pub fn next(&mut self) -> Value {
        let index = self.scored.len();
        let candidate = &self.candidates[index];
        let trial = self.plan.trial_in(self.generation);
        let scored = score(&candidate.genome, &trial);
        let evaluation = scored.evaluation;
        self.scored.push(scored);
        let is_better = evaluation.disqualified.is_none()
            && candidate.may_be_champion
            && self.best.as_ref().is_none_or(|best| evaluation.fitness > best.evaluation.fitness);
        if is_better {
            self.best = Some(Champion {
                genome: candidate.genome.clone(),
                trial,
                evaluation,
                chosen_by: None,
                origin: self.plan.origin(self.generation, index),
            });
        }
        if self.scored.len() == self.candidates.len() {
            self.finish_generation();
        }
        let mut state = self.state();
        state["is_better"] = is_better.into();
        state
    }

    fn finish_generation(&mut self) {
        let (evaluations, episodes): (Vec<Evaluation>, Vec<_>) =
            self.scored.drain(..).map(|scored| (scored.evaluation, scored.episode)).unzip();
        let best = ranking(&evaluations).first().map(|&index| evaluations[index].fitness);
        self.history.extend(best);
        self.strategy.learn(episodes);
        self.strategy.tell(&self.candidates, &evaluations);
        self.generation += 1;
        self.candidates = self.strategy.ask();
    }

    /// Returns the progress so far.
    pub fn state(&self) -> Value {
        json!({
            "generation": self.generation,
            "individual": self.scored.len(),
            "population": self.candidates.len(),
            "history": self.history,
            "best": self.best.as_ref().map(|best| best.evaluation.fitness),
            "meaning": self.best.as_ref().map(Champion::reached),
        })
    }

    /// Returns the text of the best individual's file.
    pub fn best(&self) -> Result<Value, String> {
        let best = self.best.as_ref().ok_or("no individual is healthy")?;
        let text = champion_text(best, None, &[]).map_err(|error| error.to_string())?;
        Ok(json!({ "champion": text }))
    }
}
