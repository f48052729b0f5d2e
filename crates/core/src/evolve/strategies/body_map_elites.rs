//! MAP-Elites over bodies (Mouret and Clune, arXiv:1504.04909): an archive of the best snake for each number of blocks and each length.
//!
//! The cells protect new bodies, because a changed body competes only with bodies in its cell.

use rand::RngExt;

use super::body_children::is_crossed;
use super::search::Search;
use crate::check::Invalid;
use crate::evolve::archives::{Archive, Elite, EliteGenes, body_archive, body_cell};
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::{IndividualId, Parents};
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::BodyMapElitesSettings;
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::genome::Genome;
use crate::rng::Purpose;
use crate::score::Evaluation;

/// Elites with the numbers of their cells.
type Elites = Vec<(u32, Elite<Genome>)>;

/// MAP-Elites over bodies.
#[derive(Debug, Clone)]
pub struct BodyMapElites {
    settings: BodyMapElitesSettings,
    search: Search,
    archive: Archive<Genome>,
}

impl BodyMapElites {
    fn individual(&self, individual: usize, elites: &[&Elite<Genome>]) -> Candidate {
        let step = self.settings.mutation_step.into();
        if elites.is_empty() {
            return self.search.founding(individual, step);
        }
        let mut rng = self.search.stream(individual, Purpose::Mutation);
        let first = rng.random_range(0..elites.len());
        let second = rng.random_range(0..elites.len());
        let is_crossed = is_crossed(self.settings.two_parents, &mut rng);
        let (first, second, is_same) = (elites[first], elites[second], first == second);
        if !is_crossed || is_same {
            let child = self.search.varied(&first.genes, step, &mut rng);
            return Candidate::new(child.genome, Parents::One(first.id()));
        }
        // A child inherits the structure of the fitter parent.
        let [fitter, other] =
            if second.fitness > first.fitness { [second, first] } else { [first, second] };
        let crossed = self.search.space.with_crossed_bodies(&fitter.genes, &other.genes, &mut rng);
        let child = self.search.varied(&crossed, step, &mut rng);
        Candidate::new(child.genome, Parents::Two(fitter.id(), other.id()))
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
            search: Search::new(plan, 0),
        }
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let elites: Elites = state.read()?;
        let mut resumed = Self { search: Search::new(plan, finished), ..Self::begin(plan) };
        for (cell, elite) in &elites {
            resumed.search.check_genome(&elite.genes, plan)?;
            let expected = body_cell(&resumed.archive, &elite.genes);
            if *cell != expected {
                let allowed = format!("{expected}, the cell of its body");
                return Err(Invalid::new("cell", cell, allowed));
            }
        }
        resumed.archive.restore(elites)?;
        Ok(resumed)
    }

    fn ask(&self) -> Vec<Candidate> {
        let elites = self.elites();
        (0..self.search.population).map(|individual| self.individual(individual, &elites)).collect()
    }

    fn population(&self) -> usize {
        self.search.population
    }

    fn tell(&mut self, candidates: &[Candidate], evaluations: &[Evaluation]) {
        for (index, (candidate, evaluation)) in candidates.iter().zip(evaluations).enumerate() {
            if evaluation.disqualified.is_some() {
                continue;
            }
            let elite = Elite {
                fitness: evaluation.fitness,
                generation: self.search.generation,
                individual: index as u32,
                genes: candidate.genome.clone(),
            };
            self.archive.add(body_cell(&self.archive, &candidate.genome), elite);
        }
        self.search.generation += 1;
    }

    fn state(&self) -> StrategyState {
        let elites: Elites =
            self.archive.elites().map(|(cell, elite)| (cell, elite.clone())).collect();
        StrategyState::of(&elites)
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.settings = plan.settings.evolution.body_map_elites.clone();
        self.search.apply_settings(plan);
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
    use crate::evolve::StrategyKind;
    use crate::evolve::strategies::fixtures;

    fn plan() -> RunPlan {
        fixtures::plan(StrategyKind::BodyMapElites, |settings| settings.evolution.population = 60)
    }

    fn advance(search: &mut BodyMapElites) {
        fixtures::advance(search, |of| of.genome.body.segments[0].length_m);
    }

    #[test]
    fn each_cell_keeps_the_best_body_of_its_number_of_blocks_and_length() {
        let mut search = BodyMapElites::begin(&plan());
        let mut best = std::collections::BTreeMap::new();
        for _ in 0..10 {
            for candidate in search.ask() {
                let segments = &candidate.genome.body.segments;
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
        assert_eq!((again.archive, again.search.generation), (search.archive, 2));
        elites[0].0 += 1;
        let error = BodyMapElites::resume(&plan(), 1, &StrategyState::of(&elites));
        let error = error.expect_err("refused").to_string();
        assert!(error.ends_with(", the cell of its body"), "{error}");
    }
}
