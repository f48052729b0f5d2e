//! A genetic algorithm over graphs that grow into creatures, after Karl Sims, "Evolving Virtual Creatures" (1994): a fifth of the
//! generation survives, and the rest are offspring of survivors, in proportion to their fitness.

use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::parent_pool::ParentPool;
use super::search::Search;
use crate::check::{Invalid, within};
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::{IndividualId, Parents};
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::CreatureGaSettings;
use crate::evolve::strategy::{Strategy, StrategyState, full_ranking};
use crate::genome::{CreatureChange, Genome};
use crate::rng::{Purpose, uniform};
use crate::score::Evaluation;

/// Number of attempts to make a child that can be built, after which the child is a copy of its parent.
const ATTEMPTS: usize = 20;
/// Chance of the worst survivor to be a parent, relative to that of the best.
const LEAST_CHANCE: f64 = 0.1;

/// A survivor of the last generation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Survivor {
    /// Genome of the survivor.
    genome: Genome,
    /// Chance to be a parent, relative to the other survivors.
    chance: f64,
}

/// The genetic algorithm over creatures.
#[derive(Debug, Clone)]
pub struct CreatureGa {
    settings: CreatureGaSettings,
    search: Search,
    /// Survivors of the last generation.
    pool: ParentPool<Survivor>,
}

impl CreatureGa {
    fn with(plan: &RunPlan, finished: u32, survivors: Vec<Survivor>) -> Self {
        Self {
            settings: plan.settings.evolution.creature_ga.clone(),
            search: Search::new(plan, finished),
            pool: ParentPool::unknown(survivors),
        }
    }

    /// Draws the index of a survivor, with probabilities in proportion to the chances.
    fn parent(&self, rng: &mut ChaCha8Rng) -> usize {
        let all: f64 = self.pool.members.iter().map(|survivor| survivor.chance).sum();
        let mut left = uniform(rng) * all;
        let drawn = self.pool.members.iter().position(|survivor| {
            left -= survivor.chance;
            left < 0.0
        });
        drawn.unwrap_or(0)
    }

    fn individual(&self, individual: usize) -> Candidate {
        let survivors = &self.pool.members;
        if survivors.is_empty() {
            let genome = self.search.first_genome(individual, |founder, rng| {
                self.child([founder; 2], CreatureChange::Mutation, rng)
            });
            return Candidate::new(genome, Parents::None);
        }
        // At least one individual of a generation is a new genome.
        if individual < survivors.len().min(self.search.population - 1) {
            let genome = survivors[individual].genome.clone();
            return Candidate::new(genome, self.pool.parents(individual, None));
        }
        let mut rng = self.search.stream(individual, Purpose::Mutation);
        let drawn = CreatureChange::draw(&mut rng);
        let (first, second) = (self.parent(&mut rng), self.parent(&mut rng));
        let change = if first == second { CreatureChange::Mutation } else { drawn };
        let mates = [first, second].map(|index| &survivors[index].genome);
        let has_two = !matches!(change, CreatureChange::Mutation);
        let parents = self.pool.parents(first, has_two.then_some(second));
        Candidate::new(self.child(mates, change, &mut rng), parents)
    }

    /// Makes a child that can be built; after too many attempts, a copy of the first parent.
    fn child(&self, parents: [&Genome; 2], change: CreatureChange, rng: &mut ChaCha8Rng) -> Genome {
        let step = self.settings.mutation_step.into();
        let mut attempt = || self.search.space.changed_creature(parents, change, step, rng);
        let child = (0..ATTEMPTS).find_map(|_| attempt());
        child.unwrap_or_else(|| parents[0].clone())
    }
}

/// Returns the chances of survivors to be parents, given their fitness, best first. The chance rises linearly from 0.1 at the worst fitness
/// to 1 at the best.
fn chances(fitness: &[f32]) -> Vec<f64> {
    let best = fitness.first().copied().unwrap_or_default();
    let worst = fitness.last().copied().unwrap_or_default();
    let range = f64::from(best - worst);
    let chance = |fitness: f32| {
        let share = if range > 0.0 { f64::from(fitness - worst) / range } else { 1.0 };
        LEAST_CHANCE + (1.0 - LEAST_CHANCE) * if share.is_finite() { share } else { 0.0 }
    };
    fitness.iter().copied().map(chance).collect()
}

impl Strategy for CreatureGa {
    fn begin(plan: &RunPlan) -> Self {
        Self::with(plan, 0, Vec::new())
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let resumed = Self::with(plan, finished, state.read()?);
        within("survivors", resumed.pool.members.len(), 0..=resumed.search.population)?;
        for survivor in &resumed.pool.members {
            within("chance", survivor.chance, LEAST_CHANCE..=1.0)?;
            resumed.search.check_genome(&survivor.genome, plan)?;
        }
        Ok(resumed)
    }

    fn ask(&self) -> Vec<Candidate> {
        (0..self.search.population).map(|individual| self.individual(individual)).collect()
    }

    fn population(&self) -> usize {
        self.search.population
    }

    fn tell(&mut self, candidates: &[Candidate], evaluations: &[Evaluation]) {
        let share = f64::from(self.settings.survivors);
        let count = libm::round(share * candidates.len() as f64) as usize;
        let mut order = full_ranking(evaluations);
        order.truncate(count.max(1));
        // A disqualified creature breeds only if all creatures in the selected share are disqualified.
        let healthy = |index: &usize| evaluations[*index].disqualified.is_none();
        if order.iter().any(healthy) {
            order.retain(healthy);
        }
        let fitness: Vec<f32> = order.iter().map(|&index| evaluations[index].fitness).collect();
        let mut chances = chances(&fitness).into_iter();
        let survivor = |&index: &usize| Survivor {
            genome: candidates[index].genome.clone(),
            chance: chances.next().unwrap_or(LEAST_CHANCE),
        };
        self.pool = ParentPool::chosen(self.search.generation, &order, survivor);
        self.search.generation += 1;
    }

    fn state(&self) -> StrategyState {
        StrategyState::of(&self.pool.members)
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.settings = plan.settings.evolution.creature_ga.clone();
        self.search.apply_settings(plan);
    }

    fn parent_pool(&self) -> Vec<IndividualId> {
        self.pool.ids()
    }

    fn restore_parents(&mut self, pool: &[IndividualId]) {
        self.pool.restore(pool);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::StrategyKind;
    use crate::evolve::strategies::fixtures;
    use crate::genome::{ControllerKind, grow};

    fn plan(population: u32) -> RunPlan {
        fixtures::plan(StrategyKind::CreatureGa, |settings| {
            settings.evolution.population = population;
            settings.genome.controller = ControllerKind::PartNeurons;
        })
    }

    fn parts(genome: &Genome) -> usize {
        grow(&genome.body.nodes).len()
    }

    fn advance(ga: &mut CreatureGa) -> f32 {
        let asked = ga.ask();
        let evaluations: Vec<Evaluation> = asked
            .iter()
            .map(|of| Evaluation::of_fitness(-(parts(&of.genome) as f32 - 8.0).abs()))
            .collect();
        ga.tell(&asked, &evaluations);
        evaluations.iter().map(|of| of.fitness).sum::<f32>() / evaluations.len() as f32
    }

    #[test]
    fn a_fifth_survives_and_the_population_follows_the_fitness() {
        let mut ga = CreatureGa::begin(&plan(60));
        let first = advance(&mut ga);
        assert_eq!(ga.pool.members.len(), 12);
        let asked = ga.ask();
        let pairs = asked.iter().zip(&ga.pool.members);
        assert!(pairs.clone().all(|(of, survivor)| of.genome == survivor.genome));
        assert!(pairs.count() == 12);
        let last = (0..6).map(|_| advance(&mut ga)).last().expect("six");
        assert!(last > first + 1.0, "{first}, then {last}");
        assert_eq!(parts(&ga.pool.members[0].genome), 8);
    }

    #[test]
    fn the_chance_to_be_a_parent_grows_with_the_fitness() {
        let found = chances(&[4.0, 3.0, 2.0, 0.0]);
        for (found, expected) in found.into_iter().zip([1.0, 0.775, 0.55, 0.1]) {
            assert!((found - expected).abs() < 1e-9, "{found}, not {expected}");
        }
        assert_eq!(chances(&[2.0, 2.0]), [1.0, 1.0]);
        assert!(chances(&[f32::NEG_INFINITY, f32::NEG_INFINITY]).iter().all(|of| *of >= 0.1));
    }

    #[test]
    fn disqualified_creatures_do_not_breed_beside_healthy_ones() {
        let mut ga = CreatureGa::begin(&plan(60));
        let asked = ga.ask();
        let mut evaluations: Vec<Evaluation> =
            (0..60).map(|_| Evaluation::of_fitness(9.0)).collect();
        for evaluation in &mut evaluations[3..] {
            evaluation.disqualified = Some(crate::world::Disqualification::FellOver);
        }
        ga.tell(&asked, &evaluations);
        assert_eq!(ga.pool.members.len(), 3);
    }

    #[test]
    fn a_state_that_does_not_fit_is_refused() {
        let plan = plan(20);
        let mut ga = CreatureGa::begin(&plan);
        advance(&mut ga);
        CreatureGa::resume(&plan, 1, &ga.state()).expect("its own");
        let error = |change: fn(&mut Survivor)| {
            let mut survivors = ga.pool.members.clone();
            change(&mut survivors[1]);
            let state = StrategyState::of(&survivors);
            CreatureGa::resume(&plan, 1, &state).expect_err("refused").to_string()
        };
        assert_eq!(error(|of| of.chance = 7.0), "chance is 7; allowed: 0.1 to 1");
        let heavy = error(|of| of.genome.body.nodes[0].density_kg_m3 *= 1.0e9);
        assert!(heavy.contains("density_kg_m3"), "{heavy}");
    }
}
