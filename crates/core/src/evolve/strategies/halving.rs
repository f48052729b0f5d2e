//! The report's method: the best few become parents, every child is one parent shifted at random, and
//! the range of the shift halves with each generation.

use crate::check::{Invalid, within};
use crate::evolve::parents::{IndividualId, Parents};
use crate::evolve::plan::RunPlan;
use crate::evolve::strategy::{Strategy, StrategyState, ranking};
use crate::genome::{Genome, GenomeShape};
use crate::rng::{Purpose, stream};
use crate::score::Evaluation;

/// The report's method.
#[derive(Debug, Clone)]
pub struct Halving {
    plan: RunPlan,
    shape: GenomeShape,
    /// The next generation; the first is 1.
    generation: u32,
    /// The parents of the next generation, best first.
    parents: Vec<Genome>,
    /// Their ids; empty if they are unknown.
    ids: Vec<IndividualId>,
}

impl Halving {
    fn random_genome(&self, individual: u32) -> Genome {
        let mut rng = stream(self.plan.seed, self.generation, individual, Purpose::Birth);
        self.plan.settings.genome.random_genome(self.shape, &mut rng)
    }

    /// The index of the parent of an individual, if there is at least one parent.
    fn parent_of(&self, individual: u32) -> usize {
        // In turn, so that all parents have the same number of children.
        individual as usize % self.parents.len()
    }

    fn child(&self, individual: u32) -> Genome {
        let parent = &self.parents[self.parent_of(individual)];
        if self.generation == 1 && individual == 0 {
            // The founder itself, which mutation could make worse.
            return parent.clone();
        }
        let mut rng = stream(self.plan.seed, self.generation, individual, Purpose::Mutation);
        let range_nm = self.plan.mutation_range_nm(self.generation);
        self.plan.settings.genome.mutate(parent, range_nm, &mut rng)
    }
}

impl Strategy for Halving {
    /// A founder is the only parent of the first generation.
    fn begin(plan: &RunPlan) -> Self {
        Self {
            shape: plan.settings.trial.genome_shape(),
            generation: 1,
            parents: plan.founder.iter().map(|founder| founder.genome().clone()).collect(),
            ids: Vec::new(),
            plan: plan.clone(),
        }
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let parents: Vec<Genome> = state.read()?;
        let search = Self::begin(plan);
        let most = plan.settings.evolution.halving.parents as usize;
        within("parents", parents.len(), 0..=most)?;
        for (index, parent) in parents.iter().enumerate() {
            let field = format!("parents[{index}]");
            plan.settings.trial.check_genome(parent).map_err(|error| error.inside(&field))?;
            // A child is as long as its parent, and there are many children.
            let layout = plan.settings.genome.check_layout(parent, search.shape);
            layout.map_err(|error| error.inside(&field))?;
        }
        Ok(Self { generation: finished + 1, parents, ..search })
    }

    /// Random genomes if there are no parents: in the first generation without a founder, and after one in which all
    /// individuals were disqualified.
    fn ask(&self) -> Vec<Genome> {
        let individuals = 0..self.plan.settings.evolution.population;
        if self.parents.is_empty() {
            individuals.map(|individual| self.random_genome(individual)).collect()
        } else {
            individuals.map(|individual| self.child(individual)).collect()
        }
    }

    fn population(&self) -> usize {
        self.plan.settings.evolution.population as usize
    }

    fn tell(&mut self, genomes: &[Genome], evaluations: &[Evaluation]) {
        let best = ranking(evaluations);
        let most = self.plan.settings.evolution.halving.parents as usize;
        let chosen = &best[..best.len().min(most)];
        self.parents = chosen.iter().map(|&index| genomes[index].clone()).collect();
        self.ids = IndividualId::all(self.generation, chosen);
        self.generation += 1;
    }

    fn state(&self) -> StrategyState {
        StrategyState::of(&self.parents)
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.plan = plan.clone();
        // The best stay: they come first.
        self.parents.truncate(plan.settings.evolution.halving.parents as usize);
        self.ids.truncate(self.parents.len());
    }

    fn parents(&self) -> Vec<Parents> {
        let of = |individual| {
            if self.parents.is_empty() {
                return Parents::None;
            }
            let id = self.ids.get(self.parent_of(individual));
            id.map_or(Parents::Unknown, |id| Parents::One(*id))
        };
        (0..self.plan.settings.evolution.population).map(of).collect()
    }

    fn parent_pool(&self) -> Vec<IndividualId> {
        self.ids.clone()
    }

    fn restore_parents(&mut self, pool: &[IndividualId]) {
        // The best of the generation may be listed behind them.
        self.ids = pool.get(..self.parents.len()).unwrap_or_default().to_vec();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;
    use crate::genome::ControllerGenes;
    use crate::world::Disqualification;

    fn small() -> Halving {
        let mut settings = Settings::default();
        settings.evolution.population = 8;
        settings.evolution.halving.parents = 2;
        settings.trial.duration_s = 1.0;
        Halving::begin(&RunPlan::new("test", 1, settings))
    }

    /// The largest difference between two genomes' torque points, in N·m.
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
        let mut halving = small();
        let mut genomes = halving.ask();
        for range_nm in [100.0, 50.0, 25.0] {
            let fitness =
                (0..8).map(|i| Evaluation::of_fitness(if i == 5 { 9.0 } else { i as f32 }));
            halving.tell(&genomes, &fitness.collect::<Vec<_>>());
            let children = halving.ask();
            for (index, child) in children.iter().enumerate() {
                let parent = &genomes[if index % 2 == 0 { 5 } else { 7 }];
                let distance = distance_nm(child, parent);
                assert!(distance <= range_nm + 0.001, "{distance} N·m in a range of {range_nm}");
                assert!(distance > range_nm * 0.5, "{distance} N·m in a range of {range_nm}");
            }
            genomes = children;
        }
    }

    #[test]
    fn without_mutation_children_equal_their_parents_even_after_a_restart() {
        let mut settings = Settings::default();
        settings.evolution.population = 8;
        settings.evolution.halving.parents = 3;
        settings.evolution.halving.mutation_range_nm = 0.0;
        settings.trial.duration_s = 1.0;
        let plan = RunPlan::new("test", 1, settings);
        let mut halving = Halving::begin(&plan);
        assert_eq!(halving.parents(), [Parents::None; 8]);
        let genomes = halving.ask();
        let evaluations: Vec<_> = (0..8).map(|i| Evaluation::of_fitness(i as f32)).collect();
        halving.tell(&genomes, &evaluations);
        let is_right = |halving: &Halving| {
            for (child, parents) in halving.ask().iter().zip(halving.parents()) {
                let Parents::One(id) = parents else { panic!("{parents:?}") };
                assert_eq!(id.generation, 1);
                assert_eq!(*child, genomes[id.individual as usize]);
            }
        };
        is_right(&halving);
        let mut again = Halving::resume(&plan, 1, &halving.state()).expect("it fits");
        assert_eq!(again.parents(), [Parents::Unknown; 8]);
        again.restore_parents(&halving.parent_pool()[..2]);
        assert_eq!(again.parents(), [Parents::Unknown; 8], "fewer ids than parents");
        again.restore_parents(&halving.parent_pool());
        is_right(&again);
    }

    #[test]
    fn random_genomes_follow_a_generation_without_a_healthy_agent() {
        let mut halving = small();
        let genomes = halving.ask();
        let broken = Evaluation {
            disqualified: Some(Disqualification::JointBroke),
            ..Evaluation::of_fitness(99.0)
        };
        halving.tell(&genomes, &[broken; 8]);
        let again = halving.ask();
        assert_eq!(again.len(), 8);
        assert!(distance_nm(&again[0], &genomes[0]) > 200.0, "random, not copies");
    }
}
