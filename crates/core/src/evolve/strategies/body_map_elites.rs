//! MAP-Elites over bodies (Mouret and Clune, arXiv:1504.04909): the best snake of each number of blocks and each length.
//!
//! The cells protect new bodies: a changed body competes only with bodies of its own kind.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::body_children::BodyChildren;
use crate::check::Invalid;
use crate::evolve::archives::{Archive, Elite, EliteGenes, body_archive, body_cell};
use crate::evolve::parents::{IndividualId, Parents};
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::BodyMapElitesSettings;
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::genome::Genome;
use crate::rng::Purpose;
use crate::score::Evaluation;

/// The elites with the numbers of their cells.
type Elites = Vec<(u32, Elite<Genome>)>;
/// A parent, perhaps another one, and random numbers.
type ChosenParents<'a> = (&'a Elite<Genome>, Option<&'a Elite<Genome>>, ChaCha8Rng);

/// MAP-Elites over bodies.
#[derive(Debug, Clone)]
pub struct BodyMapElites {
    settings: BodyMapElitesSettings,
    children: BodyChildren,
    population: usize,
    archive: Archive<Genome>,
}

impl BodyMapElites {
    /// The parents of a child, the one whose structure it takes first, and the random numbers with which it goes on.
    fn chosen<'a>(&self, individual: usize, elites: &[&'a Elite<Genome>]) -> ChosenParents<'a> {
        let mut rng = self.children.stream(individual, Purpose::Mutation);
        let first = rng.random_range(0..elites.len());
        let second = rng.random_range(0..elites.len());
        let is_crossed = BodyChildren::is_crossed(self.settings.two_parents, &mut rng);
        let (first, second, is_same) = (elites[first], elites[second], first == second);
        if !is_crossed || is_same {
            return (first, None, rng);
        }
        let [fitter, other] =
            if second.fitness > first.fitness { [second, first] } else { [first, second] };
        (fitter, Some(other), rng)
    }

    fn individual(&self, individual: usize, elites: &[&Elite<Genome>]) -> Genome {
        let step = self.settings.mutation_step.into();
        if elites.is_empty() {
            return self
                .children
                .first(individual, |founder, rng| self.children.varied(founder, step, rng).genome);
        }
        let (parent, other, mut rng) = self.chosen(individual, elites);
        let Some(other) = other else {
            return self.children.varied(&parent.genes, step, &mut rng).genome;
        };
        let crossed =
            self.children.space.with_crossed_bodies(&parent.genes, &other.genes, &mut rng);
        self.children.varied(&crossed, step, &mut rng).genome
    }

    fn elites(&self) -> Vec<&Elite<Genome>> {
        self.archive.elites().map(|(_, elite)| elite).collect()
    }
}

impl Strategy for BodyMapElites {
    fn begin(plan: &RunPlan) -> Self {
        let settings = plan.settings.evolution.body_map_elites.clone();
        let floor = plan.settings.trial.resting_fitness();
        Self {
            archive: body_archive(&plan.settings.genome.bodies, settings.length_cells, floor),
            settings,
            children: BodyChildren::new(plan, 0),
            population: plan.settings.evolution.population as usize,
        }
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let elites: Elites = state.read()?;
        let mut resumed = Self { children: BodyChildren::new(plan, finished), ..Self::begin(plan) };
        for (cell, elite) in &elites {
            plan.settings.trial.check_genome(&elite.genes)?;
            resumed.children.space.check_genome(&elite.genes, resumed.children.shape)?;
            let expected = body_cell(&resumed.archive, &elite.genes);
            if *cell != expected {
                let allowed = format!("{expected}, the cell of its body");
                return Err(Invalid::new("cell", cell, allowed));
            }
        }
        resumed.archive.restore(elites)?;
        Ok(resumed)
    }

    fn ask(&self) -> Vec<Genome> {
        let elites = self.elites();
        (0..self.population).map(|individual| self.individual(individual, &elites)).collect()
    }

    fn population(&self) -> usize {
        self.population
    }

    fn tell(&mut self, genomes: &[Genome], evaluations: &[Evaluation]) {
        for (index, (genome, evaluation)) in genomes.iter().zip(evaluations).enumerate() {
            if evaluation.disqualified.is_some() {
                continue;
            }
            let elite = Elite {
                fitness: evaluation.fitness,
                generation: self.children.generation,
                individual: index as u32,
                genes: genome.clone(),
            };
            self.archive.add(body_cell(&self.archive, genome), elite);
        }
        self.children.generation += 1;
    }

    fn state(&self) -> StrategyState {
        let elites: Elites =
            self.archive.elites().map(|(cell, elite)| (cell, elite.clone())).collect();
        StrategyState::of(&elites)
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.settings = plan.settings.evolution.body_map_elites.clone();
        self.population = plan.settings.evolution.population as usize;
    }

    fn parents(&self) -> Vec<Parents> {
        let elites = self.elites();
        let of = |individual| {
            if elites.is_empty() {
                return Parents::None;
            }
            match self.chosen(individual, &elites) {
                (parent, None, _) => Parents::One(parent.id()),
                (parent, Some(other), _) => Parents::Two(parent.id(), other.id()),
            }
        };
        (0..self.population).map(of).collect()
    }

    fn parent_pool(&self) -> Vec<IndividualId> {
        self.elites().into_iter().map(Elite::id).collect()
    }

    fn archive(&self) -> Option<Archive> {
        Some(self.archive.copy_with(|genome| EliteGenes::Genome(Box::new(genome.clone()))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{Settings, StrategyKind};
    use crate::genome::ControllerKind;

    fn plan() -> RunPlan {
        let mut settings = Settings::default();
        settings.evolution.strategy = StrategyKind::BodyMapElites;
        settings.evolution.population = 60;
        settings.genome.bodies.vary = true;
        settings.genome.controller = ControllerKind::Gait;
        settings.check().expect("they go together");
        RunPlan::new("test", 1, settings)
    }

    fn advance(search: &mut BodyMapElites) {
        let genomes = search.ask();
        let fitness = |genome: &Genome| genome.body.segments[0].length_m;
        let evaluations: Vec<Evaluation> =
            genomes.iter().map(|genome| Evaluation::of_fitness(fitness(genome))).collect();
        search.tell(&genomes, &evaluations);
    }

    #[test]
    fn each_cell_keeps_the_best_body_of_its_number_of_blocks_and_length() {
        let mut search = BodyMapElites::begin(&plan());
        let mut best = std::collections::BTreeMap::new();
        for _ in 0..10 {
            for genome in search.ask() {
                let segments = &genome.body.segments;
                let length_m: f32 = segments.iter().map(|segment| segment.length_m).sum();
                let row = ((f64::from(length_m) - 4.0) / 0.5).clamp(0.0, 15.0) as u32;
                let of_cell = best.entry((row, segments.len() as u32)).or_insert(0.0_f32);
                *of_cell = of_cell.max(segments[0].length_m);
            }
            advance(&mut search);
        }
        let kept: Vec<f32> = search.archive.elites().map(|(_, elite)| elite.fitness).collect();
        assert_eq!(kept, best.into_values().collect::<Vec<_>>());
        assert!(kept.len() > 60, "{} cells", kept.len());
    }

    #[test]
    fn a_state_with_an_elite_in_the_cell_of_another_body_is_refused() {
        let mut search = BodyMapElites::begin(&plan());
        advance(&mut search);
        let mut elites: Elites = search.state().read().expect("its own state");
        let again = BodyMapElites::resume(&plan(), 1, &search.state()).expect("accepted");
        assert_eq!((again.archive, again.children.generation), (search.archive, 2));
        elites[0].0 += 1;
        let error = BodyMapElites::resume(&plan(), 1, &StrategyState::of(&elites));
        let error = error.expect_err("refused").to_string();
        assert!(error.ends_with(", the cell of its body"), "{error}");
    }
}
