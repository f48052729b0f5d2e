//! The report's method: the best few become parents, every child is one parent shifted at random, and
//! the range of the shift halves with each generation.

use serde::{Deserialize, Serialize};

use super::{LARGEST_POPULATION, Parents, Place, RunPlan, Strategy, StrategyState, ranking};
use crate::check::{Invalid, within};
use crate::genome::{Descent, Genome};
use crate::rng::{Purpose, stream};
use crate::score::Evaluation;

/// Settings of the report's method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HalvingSettings {
    /// How many of the best become parents. The report has four.
    pub parents: u32,
    /// Mutation range of the second generation, in N·m. The report has 100.
    pub mutation_range_nm: f32,
    /// What the range is multiplied by with each further generation. The report has 0.5.
    pub mutation_decay: f32,
}

impl Default for HalvingSettings {
    fn default() -> Self {
        Self { parents: 4, mutation_range_nm: 100.0, mutation_decay: 0.5 }
    }
}

impl HalvingSettings {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        within("parents", self.parents, 1..=LARGEST_POPULATION)?;
        within("mutation_range_nm", self.mutation_range_nm, 0.0..=1.0e6)?;
        within("mutation_decay", self.mutation_decay, 0.0..=1.0)
    }
}

/// The report's method at work.
#[derive(Debug, Clone)]
pub struct Halving {
    plan: RunPlan,
    descent: Descent,
    /// The generation that `ask` returns; the first is 1.
    generation: u32,
    parents: Vec<Genome>,
    /// Where they come from; nothing, if that is not known.
    places: Vec<Place>,
}

impl Halving {
    /// A fresh search. A founder is the only parent of the first generation.
    pub fn new(plan: &RunPlan) -> Self {
        Self {
            descent: plan.settings.trial.descent(),
            generation: 1,
            parents: plan.founder.iter().map(|founder| founder.genome().clone()).collect(),
            places: Vec::new(),
            plan: plan.clone(),
        }
    }

    /// A search that goes on after its first `finished` generations, of which `parents` are left.
    ///
    /// # Errors
    /// There are more parents than there may be, or one does not fit the trial.
    pub fn resumed(plan: &RunPlan, finished: u32, parents: Vec<Genome>) -> Result<Self, Invalid> {
        let fresh = Self::new(plan);
        let most = plan.settings.evolution.halving.parents as usize;
        within("parents", parents.len(), 0..=most)?;
        for (index, parent) in parents.iter().enumerate() {
            let place = format!("parents[{index}]");
            let kind = plan.settings.genome.controller;
            if parent.controller.kind() != kind {
                let found = parent.controller.kind();
                return Err(Invalid::new(place, found, format!("a {kind}")));
            }
            plan.settings.trial.check_genome(parent).map_err(|error| error.inside(&place))?;
            // A child is as long as its parent, and there are many children.
            let (found, expected) =
                (parent.controller.numbers(), fresh.newborn(0).controller.numbers());
            if found != expected {
                return Err(Invalid::new(place, format!("{found} numbers"), expected.to_string()));
            }
        }
        Ok(Self { generation: finished + 1, parents, ..fresh })
    }

    fn newborn(&self, individual: u32) -> Genome {
        let mut rng = stream(self.plan.seed, self.generation, individual, Purpose::Birth);
        self.plan.settings.genome.birth(self.descent, &mut rng)
    }

    /// Which of the parents, of whom there is one at least, is that of an individual.
    fn parent_of(&self, individual: u32) -> usize {
        // In turn, so that every parent has its equal share of the children.
        individual as usize % self.parents.len()
    }

    fn child(&self, individual: u32) -> Genome {
        let parent = &self.parents[self.parent_of(individual)];
        if self.generation == 1 && individual == 0 {
            // The founder itself, so that it is not lost.
            return parent.clone();
        }
        let mut rng = stream(self.plan.seed, self.generation, individual, Purpose::Mutation);
        let range_nm = self.plan.mutation_range_nm(self.generation);
        self.plan.settings.genome.mutated(parent, range_nm, &mut rng)
    }
}

impl Strategy for Halving {
    /// The first generation is drawn from nothing, unless there is a founder; so is a later one that found nobody
    /// fit to be a parent because all were disqualified.
    fn ask(&self) -> Vec<Genome> {
        let individuals = 0..self.plan.settings.evolution.population;
        if self.parents.is_empty() {
            individuals.map(|individual| self.newborn(individual)).collect()
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
        self.places = Place::all(self.generation, chosen);
        self.generation += 1;
    }

    fn state(&self) -> StrategyState {
        StrategyState::Halving(self.parents.clone())
    }

    fn amend(&mut self, plan: &RunPlan) {
        self.plan = plan.clone();
        // They are in order: the best stay.
        self.parents.truncate(plan.settings.evolution.halving.parents as usize);
        self.places.truncate(self.parents.len());
    }

    fn parents(&self) -> Vec<Parents> {
        let of = |individual| {
            if self.parents.is_empty() {
                return Parents::Newborn;
            }
            let place = self.places.get(self.parent_of(individual));
            place.map_or(Parents::Unknown, |place| Parents::One(*place))
        };
        (0..self.plan.settings.evolution.population).map(of).collect()
    }

    fn breeders(&self) -> Vec<Place> {
        self.places.clone()
    }

    fn recall(&mut self, breeders: &[Place]) {
        // Others may be written down behind them.
        self.places = breeders.get(..self.parents.len()).unwrap_or_default().to_vec();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;
    use crate::genome::Controller;
    use crate::world::Disqualification;

    fn small() -> Halving {
        let mut settings = Settings::default();
        settings.evolution.population = 8;
        settings.evolution.halving.parents = 2;
        settings.trial.duration_s = 1.0;
        Halving::new(&RunPlan::new("test", 1, settings))
    }

    /// The largest difference between two genomes' torque points, in N·m.
    fn distance_nm(a: &Genome, b: &Genome) -> f32 {
        let (Controller::Signal(a), Controller::Signal(b)) = (&a.controller, &b.controller) else {
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
    fn without_mutation_a_child_is_its_parent_and_so_it_is_after_a_stop() {
        let mut settings = Settings::default();
        settings.evolution.population = 8;
        settings.evolution.halving.parents = 3;
        settings.evolution.halving.mutation_range_nm = 0.0;
        settings.trial.duration_s = 1.0;
        let plan = RunPlan::new("test", 1, settings);
        let mut halving = Halving::new(&plan);
        assert_eq!(halving.parents(), [Parents::Newborn; 8]);
        let genomes = halving.ask();
        let evaluations: Vec<_> = (0..8).map(|i| Evaluation::of_fitness(i as f32)).collect();
        halving.tell(&genomes, &evaluations);
        let is_right = |halving: &Halving| {
            for (child, parents) in halving.ask().iter().zip(halving.parents()) {
                let Parents::One(place) = parents else { panic!("{parents:?}") };
                assert_eq!(place.generation, 1);
                assert_eq!(*child, genomes[place.individual as usize]);
            }
        };
        is_right(&halving);
        let mut again = Halving::resumed(&plan, 1, halving.parents.clone()).expect("it fits");
        assert_eq!(again.parents(), [Parents::Unknown; 8]);
        again.recall(&halving.breeders()[..2]);
        assert_eq!(again.parents(), [Parents::Unknown; 8], "too few to be them");
        again.recall(&halving.breeders());
        is_right(&again);
    }

    #[test]
    fn a_generation_without_a_healthy_agent_starts_afresh() {
        let mut halving = small();
        let genomes = halving.ask();
        let broken = Evaluation {
            disqualified: Some(Disqualification::JointBroke),
            ..Evaluation::of_fitness(99.0)
        };
        halving.tell(&genomes, &[broken; 8]);
        let again = halving.ask();
        assert_eq!(again.len(), 8);
        assert!(distance_nm(&again[0], &genomes[0]) > 200.0, "newborns, not copies");
    }
}
