//! The report's method: the best few individuals become parents, every child is a parent shifted at random, and the range of the shift
//! halves with each generation.

use super::parent_pool::ParentPool;
use super::search::Search;
use crate::check::{Invalid, within};
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::{IndividualId, Parents};
use crate::evolve::plan::RunPlan;
use crate::evolve::strategy::{Strategy, StrategyState, ranking};
use crate::genome::Genome;
use crate::rng::Purpose;
use crate::score::Evaluation;

/// The report's method as a strategy.
#[derive(Debug, Clone)]
pub struct Halving {
    plan: RunPlan,
    search: Search,
    /// Parents of the next generation, best first.
    pool: ParentPool<Genome>,
}

impl Halving {
    fn candidate(&self, individual: usize) -> Candidate {
        let count = self.pool.members.len();
        if count == 0 {
            return Candidate::new(self.search.random_genome(individual), Parents::None);
        }
        // Parents take turns, so that all of them have nearly equal numbers of children.
        let parent = individual % count;
        let parents = self.pool.parents(parent, None);
        Candidate::new(self.child(&self.pool.members[parent], individual), parents)
    }

    fn child(&self, parent: &Genome, individual: usize) -> Genome {
        if self.search.generation == 1 && individual == 0 {
            // The first individual is the founder itself, because a mutation could make it worse.
            return parent.clone();
        }
        let mut rng = self.search.stream(individual, Purpose::Mutation);
        let range_nm = self.plan.mutation_range_nm(self.search.generation);
        self.plan.settings.genome.mutate(parent, range_nm, &mut rng)
    }
}

impl Strategy for Halving {
    /// Begins with a founder, if there is one, as the only parent of the first generation.
    fn begin(plan: &RunPlan) -> Self {
        let founder = plan.founder.iter().map(|founder| founder.genome().clone());
        Self {
            search: Search::new(plan, 0),
            pool: ParentPool::unknown(founder.collect()),
            plan: plan.clone(),
        }
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let parents: Vec<Genome> = state.read()?;
        let shape = plan.settings.trial.genome_shape();
        let most = plan.settings.evolution.halving.parents as usize;
        within("parents", parents.len(), 0..=most)?;
        for (index, parent) in parents.iter().enumerate() {
            let field = format!("parents[{index}]");
            plan.settings.trial.check_genome(parent).map_err(|error| error.inside(&field))?;
            // The layout limits the size of the parents, and so that of their many children.
            let layout = plan.settings.genome.check_layout(parent, shape);
            layout.map_err(|error| error.inside(&field))?;
        }
        let (search, pool) = (Search::new(plan, finished), ParentPool::unknown(parents));
        Ok(Self { plan: plan.clone(), search, pool })
    }

    /// Returns random genomes if there are no parents: in the first generation without a founder, and after a generation in which all
    /// individuals were disqualified.
    fn ask(&self) -> Vec<Candidate> {
        (0..self.search.population).map(|individual| self.candidate(individual)).collect()
    }

    fn population(&self) -> usize {
        self.search.population
    }

    fn tell(&mut self, candidates: &[Candidate], evaluations: &[Evaluation]) {
        let best = ranking(evaluations);
        let most = self.plan.settings.evolution.halving.parents as usize;
        let chosen = &best[..best.len().min(most)];
        let genome = |&index: &usize| candidates[index].genome.clone();
        self.pool = ParentPool::chosen(self.search.generation, chosen, genome);
        self.search.generation += 1;
    }

    fn state(&self) -> StrategyState {
        StrategyState::of(&self.pool.members)
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.plan = plan.clone();
        self.search.apply_settings(plan);
        self.pool.truncate(plan.settings.evolution.halving.parents as usize);
    }

    fn parent_pool(&self) -> Vec<IndividualId> {
        self.pool.ids()
    }

    fn restore_parents(&mut self, pool: &[IndividualId]) {
        // The list begins with the parents; the best of the generation may follow.
        self.pool.restore(pool);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;
    use crate::genome::ControllerGenes;
    use crate::world::Disqualification;

    fn plan(parents: u32, mutation_range_nm: f32) -> RunPlan {
        let mut settings = Settings::default();
        settings.evolution.population = 8;
        settings.evolution.halving.parents = parents;
        settings.evolution.halving.mutation_range_nm = mutation_range_nm;
        settings.trial.duration_s = 1.0;
        RunPlan::new("test", 1, settings)
    }

    /// Returns the largest difference between two genomes' torque points, in N·m.
    fn distance_nm(a: &Genome, b: &Genome) -> f32 {
        let (ControllerGenes::Signal(a), ControllerGenes::Signal(b)) =
            (&a.controller, &b.controller)
        else {
            panic!("no signals")
        };
        let pairs = a.all().flatten().zip(b.all().flatten());
        pairs.map(|(x, y)| (*x - *y).abs()).fold(0.0, f32::max)
    }

    #[test]
    fn children_come_from_the_best_in_turn_within_the_halved_range() {
        let mut halving = Halving::begin(&plan(2, 100.0));
        let mut asked = halving.ask();
        for range_nm in [100.0, 50.0, 25.0] {
            let fitness =
                (0..8).map(|i| Evaluation::of_fitness(if i == 5 { 9.0 } else { i as f32 }));
            halving.tell(&asked, &fitness.collect::<Vec<_>>());
            let children = halving.ask();
            for (index, child) in children.iter().enumerate() {
                let parent = &asked[if index % 2 == 0 { 5 } else { 7 }];
                let distance = distance_nm(&child.genome, &parent.genome);
                assert!(distance <= range_nm + 0.001, "{distance} N·m in a range of {range_nm}");
                assert!(distance > range_nm * 0.5, "{distance} N·m in a range of {range_nm}");
            }
            asked = children;
        }
    }

    #[test]
    fn without_mutation_children_equal_their_parents_even_after_a_restart() {
        let plan = plan(3, 0.0);
        let mut halving = Halving::begin(&plan);
        let parents = |of: &Halving| of.ask().iter().map(|of| of.parents).collect::<Vec<_>>();
        assert_eq!(parents(&halving), [Parents::None; 8]);
        let asked = halving.ask();
        let evaluations: Vec<_> = (0..8).map(|i| Evaluation::of_fitness(i as f32)).collect();
        halving.tell(&asked, &evaluations);
        let is_right = |halving: &Halving| {
            for child in halving.ask() {
                let Parents::One(id) = child.parents else { panic!("{:?}", child.parents) };
                assert_eq!(id.generation, 1);
                assert_eq!(child.genome, asked[id.individual as usize].genome);
            }
        };
        is_right(&halving);
        let mut again = Halving::resume(&plan, 1, &halving.state()).expect("it fits");
        assert_eq!(parents(&again), [Parents::Unknown; 8]);
        again.restore_parents(&halving.parent_pool()[..2]);
        assert_eq!(parents(&again), [Parents::Unknown; 8], "fewer ids than parents");
        again.restore_parents(&halving.parent_pool());
        is_right(&again);
    }

    #[test]
    fn random_genomes_follow_a_generation_without_a_healthy_agent() {
        let mut halving = Halving::begin(&plan(2, 100.0));
        let asked = halving.ask();
        let broken = Evaluation {
            disqualified: Some(Disqualification::JointBroke),
            ..Evaluation::of_fitness(99.0)
        };
        halving.tell(&asked, &[broken; 8]);
        let again = halving.ask();
        assert_eq!(again.len(), 8);
        assert!(distance_nm(&again[0].genome, &asked[0].genome) > 200.0, "random, not copies");
    }
}
