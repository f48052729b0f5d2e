//! A genetic algorithm over real numbers: selection, crossover, mutation with self-adapted steps, elites.
//!
//! The operators are those of Eiben and Smith, *Introduction to Evolutionary Computing*, 2nd edition (2015):
//! tournament and linear ranking in section 5.2, crossover in 4.4, self-adapted steps in 4.4.2.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::breeder::{BehaviourPoint, Breeder};
use super::parent_pool::ParentPool;
use super::search::Search;
use super::wave_takeover::WaveTakeover;
use crate::check::{Invalid, within};
use crate::control::WaveUses;
use crate::evolve::candidate::{Candidate, Heritage};
use crate::evolve::parents::{IndividualId, Parents};
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::{Crossover, GaSettings, Mutation, ParentSelection};
use crate::evolve::strategy::{Strategy, StrategyState, full_ranking};
use crate::genome::{BodySpace, Genome};
use crate::rng::{Purpose, normal};
use crate::score::Evaluation;

/// Range of self-adapted steps, as shares of a gene's range.
const STEPS: std::ops::RangeInclusive<f64> = 1.0e-4..=0.5;
/// Learning rate of steps: a child's step is the inherited step times exp(rate · normal number).
const LEARNING_RATE: f64 = 0.2;

/// An individual of the last generation, with its mutation step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GaMember {
    /// Mutation step, as a share of each gene's range.
    pub step: f64,
    /// Genes, as coordinates of the unit cube.
    pub point: Vec<f64>,
    /// Number of times that the individual chose each wave of its library. None if it has no library, or if the numbers are not needed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uses: Option<WaveUses>,
}

/// The genetic algorithm. Novelty search may determine the ranking instead of the fitness: see [`Breeder::select`].
#[derive(Debug, Clone)]
pub struct Ga {
    settings: GaSettings,
    /// Generation, population, founder, points of genomes, and random streams.
    pub search: Search,
    /// Individuals of the last generation, as possible parents.
    pool: ParentPool<GaMember>,
    takeover: WaveTakeover,
}

impl Ga {
    fn with(plan: &RunPlan, finished: u32, members: Vec<GaMember>) -> Self {
        Self {
            settings: plan.settings.evolution.ga.clone(),
            search: Search::new(plan, finished),
            pool: ParentPool::unknown(members),
            takeover: WaveTakeover::new(plan),
        }
    }

    fn individual(&self, individual: usize) -> Candidate {
        let members = &self.pool.members;
        if members.is_empty() {
            return self.candidate(self.first(individual), Parents::None);
        }
        // At least one individual of a generation is a new genome.
        let elites = (self.settings.elites as usize).min(self.search.population - 1);
        if individual < elites.min(members.len()) {
            let parents = self.pool.parents(individual, None);
            return self.candidate(members[individual].clone(), parents);
        }
        let mut rng = self.search.stream(individual, Purpose::Mutation);
        let first = self.parent(&mut rng);
        let is_crossed = rng.random_range(0.0..1.0) < f64::from(self.settings.crossover_share);
        let second = is_crossed.then(|| self.parent(&mut rng));
        let wave_of = self.takeover.donor(members, first, self.settings.wave_takeover, &mut rng);
        let mut child = members[first].clone();
        if let Some(other) = second {
            self.cross(&mut child, &members[other], &mut rng);
        }
        if let Some(other) = wave_of {
            self.takeover.take_over(&mut child.point, &members[first], &members[other]);
        }
        self.mutate(&mut child, &mut rng);
        // Only two parents are recorded: with three, the donor of the wave is omitted.
        self.candidate(child, self.pool.parents(first, second.or(wave_of)))
    }

    fn candidate(&self, GaMember { step, point, .. }: GaMember, parents: Parents) -> Candidate {
        let mut candidate = self.search.candidate(point, parents);
        candidate.heritage.step = step;
        candidate
    }

    /// Makes an individual of the first generation.
    fn first(&self, individual: usize) -> GaMember {
        let step = f64::from(self.settings.step).max(*STEPS.start());
        let point = self.search.unvaried_point(individual);
        let mut member = GaMember { step, point, uses: None };
        if individual > 0 && self.search.founder_of(individual).is_some() {
            self.mutate(&mut member, &mut self.search.stream(individual, Purpose::Mutation));
        }
        member
    }

    /// Selects a parent. Returns its index.
    fn parent(&self, rng: &mut ChaCha8Rng) -> usize {
        let count = self.pool.members.len();
        match self.settings.selection {
            // Members are in order, best first, so the best drawn member has the lowest index.
            ParentSelection::Tournament => (0..self.settings.tournament)
                .map(|_| rng.random_range(0..count))
                .fold(count - 1, usize::min),
            // Linear ranking with selection pressure 2: the lower of two random indices has the distribution P(i) in proportion to n - i -
            // 1/2.
            ParentSelection::Rank => rng.random_range(0..count).min(rng.random_range(0..count)),
        }
    }

    fn cross(&self, child: &mut GaMember, other: &GaMember, rng: &mut ChaCha8Rng) {
        // The child's step is the geometric mean of the parents' steps.
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
        self.search.space.after_mutation(&before, &mut child.point, self.search.shape, rng);
    }
}

impl Breeder for Ga {
    type Member = GaMember;
    type Point = BehaviourPoint;

    fn resume_with(plan: &RunPlan, finished: u32, members: Vec<GaMember>) -> Result<Self, Invalid> {
        let mut ga = Self::with(plan, finished, Vec::new());
        within("members", members.len(), 0..=ga.search.population)?;
        for member in &members {
            within("step", member.step, STEPS)?;
            ga.search.check(&member.point)?;
            ga.takeover.check(member)?;
        }
        ga.pool = ParentPool::unknown(members);
        Ok(ga)
    }

    fn members(&self) -> &[GaMember] {
        &self.pool.members
    }

    fn select(&mut self, candidates: &[Candidate], order: &[usize]) {
        let member = |&index: &usize| {
            let Heritage { step, point, .. } = candidates[index].heritage.clone();
            GaMember { step, point, uses: None }
        };
        self.pool = ParentPool::chosen(self.search.generation, order, member);
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

    fn ask(&self) -> Vec<Candidate> {
        let all = (0..self.search.population).map(|individual| self.individual(individual));
        self.search.with_founder_first(all.collect())
    }

    fn population(&self) -> usize {
        self.search.population
    }

    fn tell(&mut self, candidates: &[Candidate], evaluations: &[Evaluation]) {
        let order = full_ranking(evaluations);
        self.select(candidates, &order);
        self.takeover.learn(&mut self.pool.members, &order, evaluations);
    }

    fn state(&self) -> StrategyState {
        StrategyState::of(&self.pool.members)
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.settings = plan.settings.evolution.ga.clone();
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
    use crate::evolve::Settings;

    fn ga(change: impl FnOnce(&mut GaSettings)) -> Ga {
        let mut settings = Settings::default();
        settings.evolution.population = 200;
        settings.trial.duration_s = 1.0;
        change(&mut settings.evolution.ga);
        let mut ga = Ga::begin(&RunPlan::new("test", 1, settings));
        ga.select(&ga.ask(), &(0..200).collect::<Vec<_>>());
        ga
    }

    /// Counts how often each member of the last generation is selected in many draws.
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
        // The best tenth has expected shares of 1 - 0.9^3 with a tournament of three, and 1 - 0.9^2 with selection by rank.
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
        let members: Vec<_> = ga.pool.members.iter().map(|of| (of.step, &of.point)).collect();
        let next = ga.ask();
        let next: Vec<_> = next.iter().map(|of| (of.heritage.step, &of.heritage.point)).collect();
        assert_eq!(next[..3], members[..3]);
        assert!(next[3..].iter().all(|child| !members.contains(child)));
    }

    #[test]
    fn every_gene_of_a_child_is_close_to_that_of_a_recorded_parent() {
        let ga = ga(|settings| settings.step = 1.0e-4);
        let index_of = |id: IndividualId| {
            ga.pool.ids().iter().position(|known| *known == id).expect("one of the last")
        };
        let mut seen = [0; 3];
        let asked = ga.ask();
        for child in &asked {
            let parents: Vec<_> = child.parents.ids().map(index_of).collect();
            seen[parents.len()] += 1;
            let members: Vec<_> = parents.iter().map(|&index| &ga.pool.members[index]).collect();
            for (gene, value) in child.heritage.point.iter().enumerate() {
                let is_near = |member: &&GaMember| (member.point[gene] - value).abs() < 0.01;
                assert!(members.iter().any(is_near), "gene {gene}");
            }
        }
        assert!(seen[0] == 0 && seen[1] > 50 && seen[2] > 50, "{seen:?}");
        assert_eq!(asked[0].parents, Parents::One(ga.pool.ids()[0]), "the first is an elite");
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
            for parent in &ga.pool.members {
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
