//! A genetic algorithm over genomes whose bodies evolve: blocks are added, removed, divided and merged.
//!
//! A changed body is controlled by genes that fit its parent's body, so it would lose against bodies whose genes have adapted. Its age
//! protects it, after Schmidt and Lipson, "Age-Fitness Pareto Optimization" (2010), and Cheney and others, "Scalable co-optimization of
//! morphology and control in embodied machines" (2018). The age is the number of generations since the structure of the body last changed.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::body_children::is_crossed;
use super::breeder::{BehaviourPoint, Breeder};
use super::parent_pool::ParentPool;
use super::search::Search;
use crate::check::{Invalid, within};
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::IndividualId;
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::{BodyGaSettings, BodyProtection};
use crate::evolve::strategy::{Strategy, StrategyState, full_ranking};
use crate::genome::{BodySpace, Genome};
use crate::rng::Purpose;
use crate::score::Evaluation;

/// An individual of the last generation, with its age.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyMember {
    /// Genome of the individual.
    genome: Genome,
    /// Generations since the structure of the individual's body last changed.
    age: u32,
}

/// The genetic algorithm over bodies.
#[derive(Debug, Clone)]
pub struct BodyGa {
    settings: BodyGaSettings,
    search: Search,
    /// Individuals of the last generation, as possible parents.
    pool: ParentPool<BodyMember>,
}

impl BodyGa {
    fn with(plan: &RunPlan, finished: u32, members: Vec<BodyMember>) -> Self {
        Self {
            settings: plan.settings.evolution.body_ga.clone(),
            search: Search::new(plan, finished),
            pool: ParentPool::unknown(members),
        }
    }

    fn individual(&self, individual: usize) -> Candidate {
        let members = &self.pool.members;
        let step = self.settings.mutation_step.into();
        let count = members.len();
        if count == 0 {
            return self.search.founding(individual, step);
        }
        // At least one individual of a generation is a new genome.
        let elites = (self.settings.kept_best as usize).min(self.search.population - 1);
        if individual < elites.min(count) {
            let BodyMember { genome, age } = members[individual].clone();
            let parents = self.pool.parents(individual, None);
            return Candidate::aged(age.saturating_add(1), genome, parents);
        }
        let mut rng = self.search.stream(individual, Purpose::Mutation);
        let mut parent = || {
            let drawn = (0..self.settings.tournament_size).map(|_| rng.random_range(0..count));
            // Members are in order, best first, so the best drawn member has the lowest index.
            drawn.fold(count - 1, usize::min)
        };
        let (first, second) = (parent(), parent());
        let is_crossed = is_crossed(self.settings.two_parents, &mut rng);
        let (parent, parents) = if is_crossed && second != first {
            // The fitter parent, from which the child inherits the structure, has the lower index.
            let [fitter, other] = [first.min(second), first.max(second)];
            let parents = self.pool.parents(fitter, Some(other));
            let [fitter, other] = [fitter, other].map(|index| &members[index]);
            let space = &self.search.space;
            let genome = space.with_crossed_bodies(&fitter.genome, &other.genome, &mut rng);
            (BodyMember { genome, age: fitter.age.max(other.age) }, parents)
        } else {
            (members[first].clone(), self.pool.parents(first, None))
        };
        let child = self.search.varied(&parent.genome, step, &mut rng);
        let age = if child.is_restructured { 0 } else { parent.age.saturating_add(1) };
        Candidate::aged(age, child.genome, parents)
    }

    /// Returns the order of a generation as parents: first the elites by rank, then the others by the protection of new bodies.
    fn order(&self, ages: &[u32], ranked: &[usize]) -> Vec<usize> {
        match self.settings.protection {
            BodyProtection::None => ranked.to_vec(),
            BodyProtection::Age => {
                let elites = (self.settings.kept_best as usize).min(ranked.len());
                let (best, others) = ranked.split_at(elites);
                [best, by_fronts(others, ages).as_slice()].concat()
            }
        }
    }
}

/// Orders indices, given best first, by Pareto fronts of rank and age. An individual is in the first front if no other is both better and
/// no older, in the second front if only individuals of the first front are, and so on. Each front is in the order of ranks.
fn by_fronts(ranked: &[usize], ages: &[u32]) -> Vec<usize> {
    // For each front, the least age of the individuals so far. An individual belongs to the front after the last front that has a better
    // individual no older than it.
    let mut youngest: Vec<u32> = Vec::new();
    let mut fronts: Vec<Vec<usize>> = Vec::new();
    for &index in ranked {
        let age = ages.get(index).copied().unwrap_or(u32::MAX);
        // The least ages ascend from front to front.
        let front = youngest.partition_point(|&of_front| of_front <= age);
        if front == fronts.len() {
            fronts.push(Vec::new());
            youngest.push(age);
        }
        fronts[front].push(index);
        youngest[front] = youngest[front].min(age);
    }
    fronts.concat()
}

impl Breeder for BodyGa {
    type Member = BodyMember;
    /// Behaviour (three coordinates), number of blocks, and length of the body.
    type Point = [f64; 5];

    fn resume_with(
        plan: &RunPlan,
        finished: u32,
        members: Vec<BodyMember>,
    ) -> Result<Self, Invalid> {
        let resumed = Self::with(plan, finished, members);
        within("members", resumed.pool.members.len(), 0..=resumed.search.population)?;
        for member in &resumed.pool.members {
            resumed.search.check_genome(&member.genome, plan)?;
        }
        Ok(resumed)
    }

    fn members(&self) -> &[BodyMember] {
        &self.pool.members
    }

    fn select(&mut self, candidates: &[Candidate], ranking: &[usize]) {
        let ages: Vec<u32> = candidates.iter().map(|of| of.heritage.age).collect();
        let order = self.order(&ages, ranking);
        let member = |&index: &usize| BodyMember {
            genome: candidates[index].genome.clone(),
            age: ages[index],
        };
        self.pool = ParentPool::chosen(self.search.generation, &order, member);
        self.search.generation += 1;
    }

    fn stream(&self, purpose: Purpose) -> ChaCha8Rng {
        self.search.stream(0, purpose)
    }

    fn point(
        [end, first, second]: BehaviourPoint,
        genome: &Genome,
        bodies: &BodySpace,
    ) -> [f64; 5] {
        let share = |of: f64, [least, most]: [f64; 2]| {
            ((of - least) / (most - least).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
        };
        let limbs = [bodies.limbs_min, bodies.limbs_max].map(f64::from);
        let blocks = share(genome.body.segments.len() as f64, limbs);
        let length = share(genome.body.chain_length_m(), [0.0, f64::from(bodies.longest_m)]);
        [end, first, second, blocks, length]
    }
}

impl Strategy for BodyGa {
    fn begin(plan: &RunPlan) -> Self {
        Self::with(plan, 0, Vec::new())
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        Self::resume_with(plan, finished, state.read()?)
    }

    fn ask(&self) -> Vec<Candidate> {
        (0..self.search.population).map(|individual| self.individual(individual)).collect()
    }

    fn population(&self) -> usize {
        self.search.population
    }

    fn tell(&mut self, candidates: &[Candidate], evaluations: &[Evaluation]) {
        self.select(candidates, &full_ranking(evaluations));
    }

    fn state(&self) -> StrategyState {
        StrategyState::of(&self.pool.members)
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.settings = plan.settings.evolution.body_ga.clone();
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
    use crate::evolve::strategies::fixtures::{advance, plan};

    #[test]
    fn a_younger_body_only_loses_against_one_that_is_better_and_no_older() {
        // The individuals are given best first: the second is older than the first, the third is younger, and the fourth is younger still.
        assert_eq!(by_fronts(&[3, 1, 0, 2], &[2, 9, 0, 5]), [3, 0, 2, 1]);
        // Individuals of equal age are ordered by fitness alone.
        assert_eq!(by_fronts(&[1, 2, 0], &[4, 4, 4]), [1, 2, 0]);
        assert!(by_fronts(&[], &[]).is_empty());
    }

    fn ga(change: impl FnOnce(&mut BodyGaSettings)) -> BodyGa {
        BodyGa::begin(&plan(StrategyKind::BodyGa, |settings| {
            settings.evolution.population = 200;
            change(&mut settings.evolution.body_ga);
        }))
    }

    #[test]
    fn three_in_ten_children_have_another_structure_and_age_begins_again() {
        let mut ga = ga(|settings| settings.two_parents = 0.0);
        advance(&mut ga, |of| of.genome.body.segments.len() as f32);
        let asked = ga.ask();
        let ids = |genome: &Genome| -> Vec<(u64, u32)> {
            let segments = genome.body.segments.iter();
            segments.map(|segment| (segment.id, segment.length_m.to_bits())).collect()
        };
        let parents: Vec<_> = ga.pool.members.iter().map(|of| ids(&of.genome)).collect();
        assert!(asked[..2].iter().all(|elite| parents.contains(&ids(&elite.genome))));
        assert!(asked[..2].iter().all(|elite| elite.heritage.age == 1));
        let new = asked[2..].iter().filter(|child| child.heritage.age == 0).count();
        assert!((35..85).contains(&new), "{new} of 198");
        assert!(asked[2..].iter().all(|child| child.heritage.age <= 1));
    }

    #[test]
    fn without_protection_only_the_fitness_orders_parents() {
        let evaluations: Vec<Evaluation> =
            [3.0, 2.0, 1.0, 0.0].map(Evaluation::of_fitness).to_vec();
        let ages = [9, 8, 0, 9];
        let order = |protection| {
            ga(|settings| (settings.protection, settings.kept_best) = (protection, 1))
                .order(&ages, &full_ranking(&evaluations))
        };
        assert_eq!(order(BodyProtection::None), [0, 1, 2, 3]);
        // After the best individual, the second and the young individual form the first front.
        assert_eq!(order(BodyProtection::Age), [0, 1, 2, 3]);
        let older =
            ga(|settings| settings.kept_best = 1).order(&[0, 5, 7, 2], &full_ranking(&evaluations));
        assert_eq!(older, [0, 1, 3, 2], "the third is both worse and older than the second");
    }
}
