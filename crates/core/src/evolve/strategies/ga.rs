//! A genetic algorithm over real numbers: selection, crossover, mutation with a step of its own, elites.
//!
//! The operators are those of Eiben and Smith, *Introduction to Evolutionary Computing*, 2nd edition (2015):
//! tournament and linear ranking in section 5.2, crossover in 4.4, self-adapted steps in 4.4.2.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::breeder::{BehaviourPoint, Breeder};
use super::search::Search;
use super::wave_takeover::WaveTakeover;
use crate::check::{Invalid, within};
use crate::control::WaveUses;
use crate::evolve::parents::{IndividualId, Parents};
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::{Crossover, GaSettings, Mutation, ParentSelection};
use crate::evolve::strategy::{Strategy, StrategyState, full_ranking};
use crate::genome::{BodySpace, Genome};
use crate::rng::{Purpose, normal};
use crate::score::Evaluation;

/// The range of self-adapted steps, as shares of a gene's range.
const STEPS: std::ops::RangeInclusive<f64> = 1.0e-4..=0.5;
/// Learning rate of steps: a child's step is its parents' times exp(rate · normal number).
const LEARNING_RATE: f64 = 0.2;

/// An individual of the last generation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GaMember {
    /// Step of mutation, as a share of each gene's range.
    pub step: f64,
    /// The genes, as coordinates of the unit cube.
    pub point: Vec<f64>,
    /// How often it chose each wave of its library, if it has one and that is to be known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uses: Option<WaveUses>,
}

/// How an individual is made; the numbers are indices in the last generation, best first.
enum Variation {
    /// Drawn at random.
    Random,
    /// An unchanged copy.
    Elite(usize),
    /// A child of one parent, or two, and of one of whom it has a wave.
    Child { first: usize, second: Option<usize>, wave_of: Option<usize> },
}

/// The genetic algorithm. Which individuals are the best may also be decided from outside: see [`Breeder::select`].
#[derive(Debug, Clone)]
pub struct Ga {
    settings: GaSettings,
    /// The points of genomes, and random numbers.
    pub search: Search,
    /// The last generation, best first; empty at the beginning.
    members: Vec<GaMember>,
    /// Their ids; empty if they are unknown.
    ids: Vec<IndividualId>,
    takeover: WaveTakeover,
}

impl Ga {
    fn with(plan: &RunPlan, finished: u32, members: Vec<GaMember>) -> Self {
        Self {
            settings: plan.settings.evolution.ga.clone(),
            search: Search::new(plan, finished),
            members,
            ids: Vec::new(),
            takeover: WaveTakeover::new(plan),
        }
    }

    /// The next generation.
    pub fn generation(&self) -> Vec<GaMember> {
        (0..self.search.population).map(|individual| self.individual(individual)).collect()
    }

    /// How an individual is made, and the stream from which its random numbers continue.
    fn variation(&self, individual: usize) -> (Variation, ChaCha8Rng) {
        let mut rng = self.search.stream(individual, Purpose::Mutation);
        let count = self.members.len();
        // At least one individual has to change.
        let elites = (self.settings.elites as usize).min(self.search.population - 1);
        let variation = if count == 0 {
            Variation::Random
        } else if individual < elites.min(count) {
            Variation::Elite(individual)
        } else {
            let first = self.parent(&mut rng);
            let is_crossed = rng.random_range(0.0..1.0) < f64::from(self.settings.crossover_share);
            let second = is_crossed.then(|| self.parent(&mut rng));
            let share = self.settings.wave_takeover;
            let wave_of = self.takeover.donor(&self.members, first, share, &mut rng);
            Variation::Child { first, second, wave_of }
        };
        (variation, rng)
    }

    fn individual(&self, individual: usize) -> GaMember {
        let parents = &self.members;
        let (variation, mut rng) = self.variation(individual);
        let (first, second, wave_of) = match variation {
            Variation::Random => return self.first(individual),
            Variation::Elite(index) => return parents[index].clone(),
            Variation::Child { first, second, wave_of } => (first, second, wave_of),
        };
        let mut child = parents[first].clone();
        if let Some(other) = second {
            self.cross(&mut child, &parents[other], &mut rng);
        }
        if let Some(other) = wave_of {
            self.takeover.take_over(&mut child.point, &parents[first], &parents[other]);
        }
        self.mutate(&mut child, &mut rng);
        child
    }

    /// An individual of the first generation.
    fn first(&self, individual: usize) -> GaMember {
        let step = f64::from(self.settings.step).max(*STEPS.start());
        let Some(founder) = self.search.founder() else {
            let point = self.search.random_genome_point(individual);
            return GaMember { step, point, uses: None };
        };
        let mut member = GaMember { step, point: founder.to_vec(), uses: None };
        if !Search::is_founder_mutant(individual) {
            member.point = self.search.random_genome_point(individual);
        } else if individual > 0 {
            self.mutate(&mut member, &mut self.search.stream(individual, Purpose::Mutation));
        }
        member
    }

    /// Chooses a parent; returns its index.
    fn parent(&self, rng: &mut ChaCha8Rng) -> usize {
        let count = self.members.len();
        match self.settings.selection {
            // Members are in order, so the best of those drawn has the lowest index.
            ParentSelection::Tournament => (0..self.settings.tournament)
                .map(|_| rng.random_range(0..count))
                .fold(count - 1, usize::min),
            // Linear ranking with selection pressure 2: the lower of two random indices has its
            // distribution, P(i) in proportion to n - i - 1/2.
            ParentSelection::Rank => rng.random_range(0..count).min(rng.random_range(0..count)),
        }
    }

    fn cross(&self, child: &mut GaMember, other: &GaMember, rng: &mut ChaCha8Rng) {
        // The geometric mean of both steps.
        child.step = (child.step * other.step).sqrt();
        match self.settings.crossover {
            Crossover::Uniform => {
                for (gene, of_other) in child.point.iter_mut().zip(&other.point) {
                    if rng.random_range(0.0..1.0) < 0.5 {
                        *gene = *of_other;
                    }
                }
            }
            Crossover::OnePoint => {
                let cut = rng.random_range(0..child.point.len().max(1));
                let tail = child.point.iter_mut().zip(&other.point).skip(cut);
                tail.for_each(|(gene, of_other)| *gene = *of_other);
            }
        }
    }

    fn mutate(&self, child: &mut GaMember, rng: &mut ChaCha8Rng) {
        let cooling = f64::from(self.settings.cooling);
        let step = child.step * cooling * libm::exp(LEARNING_RATE * normal(rng));
        child.step = step.clamp(*STEPS.start(), *STEPS.end());
        // A uniform distribution in ±√3 has variance 1.
        let half = 3.0_f64.sqrt();
        let before = child.point.clone();
        for gene in &mut child.point {
            let deviate = match self.settings.mutation {
                Mutation::Gaussian => normal(rng),
                Mutation::Uniform => rng.random_range(-half..=half),
            };
            *gene += child.step * deviate;
        }
        self.search.after_mutation(&before, &mut child.point, rng);
    }
}

impl Breeder for Ga {
    type Member = GaMember;
    type Point = BehaviourPoint;

    fn resume_with(plan: &RunPlan, finished: u32, members: Vec<GaMember>) -> Result<Self, Invalid> {
        let ga = Self::with(plan, finished, members);
        within("members", ga.members.len(), 0..=ga.search.population)?;
        for member in &ga.members {
            within("step", member.step, STEPS)?;
            ga.search.check(&member.point)?;
            ga.takeover.check(member)?;
        }
        Ok(ga)
    }

    fn members(&self) -> &[GaMember] {
        &self.members
    }

    fn select(&mut self, order: &[usize]) {
        let generation = self.generation();
        let member = |&index: &usize| {
            generation.get(index).map(|member| GaMember { uses: None, ..member.clone() })
        };
        self.members = order.iter().filter_map(member).collect();
        self.ids = IndividualId::all(self.search.generation, order);
        self.search.generation += 1;
    }

    fn stream(&self, purpose: Purpose) -> ChaCha8Rng {
        self.search.stream(0, purpose)
    }

    fn point(behaviour: BehaviourPoint, _: &Genome, _: &BodySpace) -> BehaviourPoint {
        behaviour
    }
}

impl Strategy for Ga {
    fn begin(plan: &RunPlan) -> Self {
        Self::with(plan, 0, Vec::new())
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        Self::resume_with(plan, finished, state.read()?)
    }

    fn ask(&self) -> Vec<Genome> {
        let members = self.generation();
        let genomes = members.iter().map(|member| self.search.genome(&member.point)).collect();
        self.search.with_founder_first(genomes)
    }

    fn population(&self) -> usize {
        self.search.population
    }

    fn tell(&mut self, _: &[Genome], evaluations: &[Evaluation]) {
        let order = full_ranking(evaluations);
        self.select(&order);
        self.takeover.learn(&mut self.members, &order, evaluations);
    }

    fn state(&self) -> StrategyState {
        StrategyState::of(&self.members)
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.settings = plan.settings.evolution.ga.clone();
        self.search.apply_settings(plan);
    }

    fn parents(&self) -> Vec<Parents> {
        let of = |individual| {
            let id = |index: usize| self.ids.get(index).copied();
            let parents = match self.variation(individual).0 {
                Variation::Random => Some(Parents::None),
                Variation::Elite(index) => id(index).map(Parents::One),
                // Of three, the one that has given a single wave is left out.
                Variation::Child { first, second, wave_of } => match second.or(wave_of) {
                    None => id(first).map(Parents::One),
                    Some(second) => id(first).zip(id(second)).map(|(a, b)| Parents::Two(a, b)),
                },
            };
            parents.unwrap_or(Parents::Unknown)
        };
        (0..self.search.population).map(of).collect()
    }

    fn parent_pool(&self) -> Vec<IndividualId> {
        self.ids.clone()
    }

    fn restore_parents(&mut self, pool: &[IndividualId]) {
        self.ids = pool.get(..self.members.len()).unwrap_or_default().to_vec();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;

    fn ga(change: impl FnOnce(&mut GaSettings)) -> Ga {
        let mut settings = Settings::default();
        settings.evolution.population = 200;
        settings.trial.duration_s = 1.0;
        change(&mut settings.evolution.ga);
        let mut ga = Ga::begin(&RunPlan::new("test", 1, settings));
        ga.select(&(0..200).collect::<Vec<_>>());
        ga
    }

    /// Number of times that each of the last generation is chosen in many draws.
    fn chosen(ga: &Ga) -> Vec<u32> {
        let mut counts = vec![0; 200];
        let mut rng = ga.search.stream(0, Purpose::Mutation);
        for _ in 0..40_000 {
            counts[ga.parent(&mut rng)] += 1;
        }
        counts
    }

    #[test]
    fn both_selections_choose_the_best_tenth_as_often_as_theory_predicts() {
        // Expected shares of the best tenth: 1 - 0.9^3 of a tournament of three, 1 - 0.9^2 by rank.
        let tournament = ga(|_| ());
        let rank = ga(|settings| settings.selection = ParentSelection::Rank);
        for (ga, share) in [(tournament, 0.271), (rank, 0.19)] {
            let best: u32 = chosen(&ga)[..20].iter().sum();
            let seen = f64::from(best) / 40_000.0;
            assert!((seen - share).abs() < 0.01, "{seen}, not {share}");
        }
    }

    #[test]
    fn elites_are_unchanged_and_all_others_change() {
        let ga = ga(|settings| settings.elites = 3);
        let next = ga.generation();
        assert_eq!(next[..3], ga.members[..3]);
        assert!(next[3..].iter().all(|child| !ga.members.contains(child)));
    }

    #[test]
    fn every_gene_of_a_child_is_close_to_that_of_a_recorded_parent() {
        let ga = ga(|settings| settings.step = 1.0e-4);
        let index_of = |id: IndividualId| {
            ga.ids.iter().position(|known| *known == id).expect("one of the last")
        };
        let mut seen = [0; 3];
        for (child, parents) in ga.generation().iter().zip(ga.parents()) {
            let parents: Vec<_> = parents.ids().map(index_of).collect();
            seen[parents.len()] += 1;
            let members: Vec<_> = parents.iter().map(|&index| &ga.members[index]).collect();
            for (gene, value) in child.point.iter().enumerate() {
                let is_near = |member: &&GaMember| (member.point[gene] - value).abs() < 0.01;
                assert!(members.iter().any(is_near), "gene {gene}");
            }
        }
        assert!(seen[0] == 0 && seen[1] > 50 && seen[2] > 50, "{seen:?}");
        assert_eq!(ga.parents()[0], Parents::One(ga.ids[0]), "the first is an elite");
    }

    #[test]
    fn crossover_takes_every_gene_from_one_of_the_two() {
        for crossover in [Crossover::Uniform, Crossover::OnePoint] {
            let ga = ga(|settings| settings.crossover = crossover);
            let parent = |gene| GaMember { step: 0.1, point: vec![gene; 40], uses: None };
            let mut rng = ga.search.stream(5, Purpose::Mutation);
            let mut switches = 0;
            for _ in 0..50 {
                let mut child = parent(0.25);
                ga.cross(&mut child, &parent(0.75), &mut rng);
                assert!(child.point.iter().all(|gene| [0.25, 0.75].contains(gene)));
                switches += child.point.windows(2).filter(|pair| pair[0] != pair[1]).count();
            }
            let genes = 40 * 50;
            match crossover {
                Crossover::OnePoint => assert!(switches <= 50),
                Crossover::Uniform => {
                    assert!((0.4..0.6).contains(&(switches as f64 / genes as f64)));
                }
            }
        }
    }

    #[test]
    fn both_mutations_have_the_configured_standard_deviation() {
        for mutation in [Mutation::Gaussian, Mutation::Uniform] {
            let ga = ga(|settings| settings.mutation = mutation);
            let mut rng = ga.search.stream(5, Purpose::Mutation);
            let (mut squares, mut count, mut most) = (0.0, 0.0, 0.0_f64);
            for parent in &ga.members {
                let mut child = parent.clone();
                ga.mutate(&mut child, &mut rng);
                for (x, y) in child.point.iter().zip(&parent.point) {
                    let steps = (x - y) / child.step;
                    squares += steps * steps;
                    most = most.max(steps.abs());
                    count += 1.0;
                }
            }
            let deviation = (squares / count).sqrt();
            assert!((deviation - 1.0).abs() < 0.03, "{deviation}");
            assert_eq!(most > 1.8, mutation == Mutation::Gaussian, "{most}");
        }
    }
}
