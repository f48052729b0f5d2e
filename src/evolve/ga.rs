//! A genetic algorithm over real numbers: selection, crossover, mutation with a step of its own, elites.
//!
//! The operators are those of Eiben and Smith, *Introduction to Evolutionary Computing*, 2nd edition (2015):
//! tournament and linear ranking in section 5.2, crossover in 4.4, self-adapted steps in 4.4.2.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::search::{Search, normal};
use super::{Parents, Place, PointState, RunPlan, Strategy, StrategyState, full_ranking};
use crate::check::{Invalid, within};
use crate::genome::Genome;
use crate::rng::Purpose;
use crate::score::Evaluation;

/// Settings of the genetic algorithm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GaSettings {
    /// Who becomes a parent.
    pub selection: Selection,
    /// How many enter a tournament.
    pub tournament: u32,
    /// How two parents make one child.
    pub crossover: Crossover,
    /// Share of the children that have two parents; the others are copies of one before they mutate.
    pub crossover_share: f32,
    /// How a child's genes differ from what it inherited.
    pub mutation: Mutation,
    /// Step of mutation of the first generation's children, as a share of each gene's range. Later it is
    /// inherited and mutates itself.
    pub step: f32,
    /// What the steps are multiplied by with each generation, beside what they evolve to. Below 1 the search
    /// settles: what was found becomes the habit of all, as in the report's method.
    pub cooling: f32,
    /// How many of the best go on unchanged. They are evaluated again and count.
    pub elites: u32,
}

/// Who becomes a parent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Selection {
    /// The best of a few that are drawn.
    Tournament,
    /// Anyone, in proportion to rank: the best twice as often as the middle one, the worst hardly ever.
    Rank,
}

/// How two parents make one child.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Crossover {
    /// Each gene is of either parent.
    Uniform,
    /// The genes before a point are of one parent, those after it of the other.
    OnePoint,
}

/// How genes mutate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mutation {
    /// By a normally distributed step.
    Gaussian,
    /// By a step anywhere in a range of the same standard deviation.
    Uniform,
}

impl Default for GaSettings {
    fn default() -> Self {
        Self {
            selection: Selection::Tournament,
            tournament: 3,
            crossover: Crossover::Uniform,
            crossover_share: 0.5,
            mutation: Mutation::Gaussian,
            step: 0.1,
            cooling: 1.0,
            elites: 2,
        }
    }
}

/// The steps that self-adaptation may reach, as shares of a gene's range.
const STEPS: std::ops::RangeInclusive<f64> = 1.0e-4..=0.5;
/// How fast steps adapt: a child's step is its parents' times e to the power of this times a normal number.
const LEARNING_RATE: f64 = 0.2;

impl GaSettings {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        within("tournament", self.tournament, 1..=1000)?;
        within("crossover_share", self.crossover_share, 0.0..=1.0)?;
        within("step", self.step, 1.0e-4..=0.5)?;
        within("cooling", self.cooling, 0.5..=1.0)?;
        within("elites", self.elites, 0..=super::LARGEST_POPULATION)
    }
}

/// One who may become a parent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Member {
    /// Step of mutation, as a share of each gene's range.
    pub step: f64,
    /// The genes, as coordinates of the unit cube.
    pub point: Vec<f64>,
}

/// What a genetic algorithm knows: the last generation, best first.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct GaState(Vec<Member>);

/// How an individual comes about; the numbers are indices among the last generation, best first.
enum Origin {
    /// From nothing.
    Newborn,
    /// It goes on unchanged.
    Elite(usize),
    /// From one parent, or two.
    Child(usize, Option<usize>),
}

/// Makes generations of points; who is best is told from outside.
#[derive(Debug, Clone)]
pub struct Breeder {
    settings: GaSettings,
    /// The search it belongs to.
    pub search: Search,
    /// The last generation, best first; nobody at the beginning.
    parents: GaState,
    /// Where they come from; nothing, if that is not known.
    places: Vec<Place>,
}

impl Breeder {
    /// A breeder at its beginning.
    pub fn new(plan: &RunPlan) -> Self {
        let settings = plan.settings.evolution.ga.clone();
        let (search, parents) = (Search::new(plan, 0), GaState::default());
        Self { settings, search, parents, places: Vec::new() }
    }

    /// A breeder that goes on.
    pub fn resumed(plan: &RunPlan, finished: u32, parents: GaState) -> Result<Self, Invalid> {
        let search = Search::new(plan, finished);
        within("members", parents.0.len(), 0..=search.population)?;
        for member in &parents.0 {
            within("step", member.step, STEPS)?;
            search.check(&member.point)?;
        }
        let settings = plan.settings.evolution.ga.clone();
        Ok(Self { settings, search, parents, places: Vec::new() })
    }

    /// The next generation.
    pub fn generation(&self) -> Vec<Member> {
        (0..self.search.population).map(|individual| self.individual(individual)).collect()
    }

    /// The genomes of the next generation.
    pub fn genomes(&self) -> Vec<Genome> {
        let members = self.generation();
        let genomes = members.iter().map(|member| self.search.genome(&member.point)).collect();
        self.search.beginning_with_founder(genomes)
    }

    /// Ends a generation: `order` lists its indices, best first.
    pub fn select(&mut self, order: &[usize]) {
        let generation = self.generation();
        self.parents =
            GaState(order.iter().filter_map(|&index| generation.get(index).cloned()).collect());
        self.places = Place::all(self.search.generation, order);
        self.search.generation += 1;
    }

    /// Takes the settings of a plan in which some were changed.
    pub fn amend(&mut self, plan: &RunPlan) {
        self.settings = plan.settings.evolution.ga.clone();
        self.search.amend(plan);
    }

    /// What it knows.
    pub fn state(&self) -> GaState {
        self.parents.clone()
    }

    /// Whom the next generation comes from.
    pub fn parents(&self) -> Vec<Parents> {
        let of = |individual| {
            let place = |index: usize| self.places.get(index).copied();
            let parents = match self.origin(individual).0 {
                Origin::Newborn => Some(Parents::Newborn),
                Origin::Elite(index) | Origin::Child(index, None) => place(index).map(Parents::One),
                Origin::Child(first, Some(second)) => {
                    place(first).zip(place(second)).map(|(a, b)| Parents::Two(a, b))
                }
            };
            parents.unwrap_or(Parents::Unknown)
        };
        (0..self.search.population).map(of).collect()
    }

    /// The places of the last generation, best first.
    pub fn breeders(&self) -> Vec<Place> {
        self.places.clone()
    }

    /// Takes in what [`Self::breeders`] said.
    pub fn recall(&mut self, breeders: &[Place]) {
        self.places = breeders.get(..self.parents.0.len()).unwrap_or_default().to_vec();
    }

    /// How an individual comes about, and the random numbers that are left for what follows.
    fn origin(&self, individual: usize) -> (Origin, ChaCha8Rng) {
        let mut rng = self.search.stream(individual, Purpose::Mutation);
        let count = self.parents.0.len();
        // Somebody has to change.
        let elites = (self.settings.elites as usize).min(self.search.population - 1);
        let origin = if count == 0 {
            Origin::Newborn
        } else if individual < elites.min(count) {
            Origin::Elite(individual)
        } else {
            let first = self.parent(&mut rng);
            let is_crossed = rng.random_range(0.0..1.0) < f64::from(self.settings.crossover_share);
            Origin::Child(first, is_crossed.then(|| self.parent(&mut rng)))
        };
        (origin, rng)
    }

    fn individual(&self, individual: usize) -> Member {
        let parents = &self.parents.0;
        let (origin, mut rng) = self.origin(individual);
        let (first, second) = match origin {
            Origin::Newborn => return self.first(individual),
            Origin::Elite(index) => return parents[index].clone(),
            Origin::Child(first, second) => (first, second),
        };
        let mut child = parents[first].clone();
        if let Some(other) = second {
            self.cross(&mut child, &parents[other], &mut rng);
        }
        self.mutate(&mut child, &mut rng);
        child
    }

    /// One of the first generation.
    fn first(&self, individual: usize) -> Member {
        let step = f64::from(self.settings.step).max(*STEPS.start());
        let Some(founder) = self.search.founder() else {
            return Member { step, point: self.search.newborn_point(individual) };
        };
        let mut member = Member { step, point: founder.to_vec() };
        if !Search::is_founders_mutant(individual) {
            member.point = self.search.newborn_point(individual);
        } else if individual > 0 {
            self.mutate(&mut member, &mut self.search.stream(individual, Purpose::Mutation));
        }
        member
    }

    /// The index of somebody who becomes a parent.
    fn parent(&self, rng: &mut ChaCha8Rng) -> usize {
        let count = self.parents.0.len();
        match self.settings.selection {
            // They are in order: the best of the drawn is the one with the least index.
            Selection::Tournament => (0..self.settings.tournament)
                .map(|_| rng.random_range(0..count))
                .fold(count - 1, usize::min),
            // Linear ranking with selection pressure 2: the lesser of two drawn at random has its
            // distribution, P(i) in proportion to n - i - 1/2.
            Selection::Rank => rng.random_range(0..count).min(rng.random_range(0..count)),
        }
    }

    fn cross(&self, child: &mut Member, other: &Member, rng: &mut ChaCha8Rng) {
        // The step that lies in the middle on a logarithmic scale.
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

    fn mutate(&self, child: &mut Member, rng: &mut ChaCha8Rng) {
        let cooling = f64::from(self.settings.cooling);
        let step = child.step * cooling * libm::exp(LEARNING_RATE * normal(rng));
        child.step = step.clamp(*STEPS.start(), *STEPS.end());
        // A uniform distribution in ±√3 has variance 1.
        let half = 3.0_f64.sqrt();
        for gene in &mut child.point {
            let deviate = match self.settings.mutation {
                Mutation::Gaussian => normal(rng),
                Mutation::Uniform => rng.random_range(-half..=half),
            };
            *gene += child.step * deviate;
        }
    }
}

/// The genetic algorithm at work.
#[derive(Debug, Clone)]
pub struct Ga {
    breeder: Breeder,
}

impl Ga {
    /// A fresh search.
    pub fn new(plan: &RunPlan) -> Self {
        Self { breeder: Breeder::new(plan) }
    }

    /// A search that goes on.
    pub fn resumed(plan: &RunPlan, finished: u32, state: GaState) -> Result<Self, Invalid> {
        Ok(Self { breeder: Breeder::resumed(plan, finished, state)? })
    }
}

impl Strategy for Ga {
    fn ask(&self) -> Vec<Genome> {
        self.breeder.genomes()
    }

    fn population(&self) -> usize {
        self.breeder.search.population
    }

    fn tell(&mut self, _: &[Genome], evaluations: &[Evaluation]) {
        self.breeder.select(&full_ranking(evaluations));
    }

    fn state(&self) -> StrategyState {
        StrategyState::points(PointState::Ga(self.breeder.state()))
    }

    fn amend(&mut self, plan: &RunPlan) {
        self.breeder.amend(plan);
    }

    fn parents(&self) -> Vec<Parents> {
        self.breeder.parents()
    }

    fn breeders(&self) -> Vec<Place> {
        self.breeder.breeders()
    }

    fn recall(&mut self, breeders: &[Place]) {
        self.breeder.recall(breeders);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;

    fn breeder(change: impl FnOnce(&mut GaSettings)) -> Breeder {
        let mut settings = Settings::default();
        settings.evolution.population = 200;
        settings.trial.duration_s = 1.0;
        change(&mut settings.evolution.ga);
        let mut breeder = Breeder::new(&RunPlan::new("test", 1, settings));
        breeder.select(&(0..200).collect::<Vec<_>>());
        breeder
    }

    /// How often each of the last generation is chosen in many draws.
    fn chosen(breeder: &Breeder) -> Vec<u32> {
        let mut counts = vec![0; 200];
        let mut rng = breeder.search.stream(0, Purpose::Mutation);
        for _ in 0..40_000 {
            counts[breeder.parent(&mut rng)] += 1;
        }
        counts
    }

    #[test]
    fn both_selections_prefer_the_best_as_much_as_they_say() {
        // Expected shares of the best tenth: 1 - 0.9^3 of a tournament of three, 1 - 0.9^2 by rank.
        let tournament = breeder(|_| ());
        let rank = breeder(|settings| settings.selection = Selection::Rank);
        for (breeder, share) in [(tournament, 0.271), (rank, 0.19)] {
            let best: u32 = chosen(&breeder)[..20].iter().sum();
            let seen = f64::from(best) / 40_000.0;
            assert!((seen - share).abs() < 0.01, "{seen}, not {share}");
        }
    }

    #[test]
    fn elites_go_on_unchanged_and_the_others_do_not() {
        let breeder = breeder(|settings| settings.elites = 3);
        let next = breeder.generation();
        assert_eq!(next[..3], breeder.parents.0[..3]);
        assert!(next[3..].iter().all(|child| !breeder.parents.0.contains(child)));
    }

    #[test]
    fn every_gene_of_a_child_is_near_that_of_a_parent_it_names() {
        let breeder = breeder(|settings| settings.step = 1.0e-4);
        let index_of = |place: Place| {
            breeder.places.iter().position(|known| *known == place).expect("one of the last")
        };
        let mut seen = [0; 3];
        for (child, parents) in breeder.generation().iter().zip(breeder.parents()) {
            let parents: Vec<_> = parents.places().map(index_of).collect();
            seen[parents.len()] += 1;
            let members: Vec<_> = parents.iter().map(|&index| &breeder.parents.0[index]).collect();
            for (gene, value) in child.point.iter().enumerate() {
                let is_near = |member: &&Member| (member.point[gene] - value).abs() < 0.01;
                assert!(members.iter().any(is_near), "gene {gene}");
            }
        }
        assert!(seen[0] == 0 && seen[1] > 50 && seen[2] > 50, "{seen:?}");
        assert_eq!(breeder.parents()[0], Parents::One(breeder.places[0]), "the first is an elite");
    }

    #[test]
    fn crossover_takes_every_gene_from_one_of_the_two() {
        for crossover in [Crossover::Uniform, Crossover::OnePoint] {
            let breeder = breeder(|settings| settings.crossover = crossover);
            let parent = |gene| Member { step: 0.1, point: vec![gene; 40] };
            let mut rng = breeder.search.stream(5, Purpose::Mutation);
            let mut switches = 0;
            for _ in 0..50 {
                let mut child = parent(0.25);
                breeder.cross(&mut child, &parent(0.75), &mut rng);
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
    fn both_mutations_have_the_step_they_say() {
        for mutation in [Mutation::Gaussian, Mutation::Uniform] {
            let breeder = breeder(|settings| settings.mutation = mutation);
            let mut rng = breeder.search.stream(5, Purpose::Mutation);
            let (mut squares, mut count, mut most) = (0.0, 0.0, 0.0_f64);
            for parent in &breeder.parents.0 {
                let mut child = parent.clone();
                breeder.mutate(&mut child, &mut rng);
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
