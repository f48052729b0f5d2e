//! NEAT: evolution of networks that grow, in species that protect new structure.

use super::search::Search;
use crate::check::{Invalid, within};
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::Parents;
use crate::evolve::plan::RunPlan;
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::genome::controllers::GrownGenes;
use crate::genome::{ControllerGenes, Genome};
use crate::learn::neat::{NeatPopulation, NetworkGenome};
use crate::score::Evaluation;

/// NEAT as a strategy. The genes of body and servo evolve as the parameters of a network's genome.
#[derive(Debug, Clone)]
pub struct Neat {
    search: Search,
    /// The networks of the next generation. None only if the first generation could not be made, which the checks of settings and founders
    /// exclude.
    population: Option<NeatPopulation>,
}

impl Neat {
    /// Makes the first generation: mutants of the founder, if there is one with a network.
    ///
    /// # Errors
    /// Fails if a number is out of range, which the ranges of the settings exclude.
    fn first(plan: &RunPlan, search: &Search) -> Result<NeatPopulation, Invalid> {
        let rules = plan.settings.evolution.neat.rules();
        let (size, seed) = (search.population, plan.seed);
        if let Some(founder) = &plan.founder
            && let ControllerGenes::Grown(genes) = &founder.genome().controller
        {
            let point = search.founder_point().unwrap_or_default();
            let parameters = point.iter().map(|x| (*x as f32).clamp(0.0, 1.0)).collect();
            let network = NetworkGenome { parameters, ..genes.network.clone() };
            return NeatPopulation::descended(rules, &network, size, seed);
        }
        let [inputs, outputs] = GrownGenes::ends(plan.settings.trial.agent.joints());
        let parameters = u16::try_from(search.dimension()).unwrap_or(u16::MAX);
        NeatPopulation::first(rules, inputs, outputs, parameters, size, seed)
    }

    /// Returns the genome with a network as its controller.
    fn genome(&self, network: &NetworkGenome) -> Genome {
        let point: Vec<f64> = network.parameters.iter().map(|x| f64::from(*x)).collect();
        let mut genome = self.search.genome(&point);
        if let ControllerGenes::Grown(genes) = &mut genome.controller {
            genes.network = NetworkGenome { parameters: Vec::new(), ..network.clone() };
        }
        genome
    }
}

impl Strategy for Neat {
    fn begin(plan: &RunPlan) -> Self {
        let search = Search::new(plan, 0);
        let population = Self::first(plan, &search).ok();
        Self { search, population }
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let population: NeatPopulation = state.read()?;
        population.check().map_err(|error| error.inside("state"))?;
        let search = Search::new(plan, finished);
        let size = search.population;
        within("state.genomes", population.genomes.len(), size..=size)?;
        let [inputs, outputs] = GrownGenes::ends(plan.settings.trial.agent.joints());
        for network in &population.genomes {
            within("state.genomes.inputs", network.inputs, inputs..=inputs)?;
            within("state.genomes.outputs", network.outputs, outputs..=outputs)?;
            let parameters = network.parameters.len();
            let expected = search.dimension();
            within("state.genomes.parameters", parameters, expected..=expected)?;
        }
        Ok(Self { search, population: Some(population) })
    }

    fn ask(&self) -> Vec<Candidate> {
        let Some(population) = &self.population else { return Vec::new() };
        let candidate = |(network, &species): (&NetworkGenome, &u32)| Candidate {
            species: Some(species),
            ..Candidate::new(self.genome(network), Parents::None)
        };
        let all = population.genomes.iter().zip(&population.memberships);
        self.search.with_founder_first(all.map(candidate).collect())
    }

    fn population(&self) -> usize {
        self.population.as_ref().map_or(0, |population| population.genomes.len())
    }

    fn tell(&mut self, _: &[Candidate], evaluations: &[Evaluation]) {
        // NaN, for a disqualified individual, counts as the worst fitness.
        let fitness = |evaluation: &Evaluation| match evaluation.disqualified {
            Some(_) => f64::NAN,
            None => f64::from(evaluation.fitness),
        };
        let fitness: Vec<f64> = evaluations.iter().map(fitness).collect();
        self.search.generation += 1;
        let (seed, generation) = (self.search.seed, self.search.generation);
        self.population = self.population.as_ref().map(|of| of.next(&fitness, seed, generation));
    }

    fn state(&self) -> StrategyState {
        match &self.population {
            Some(population) => StrategyState::of(population),
            None => StrategyState::of(&()),
        }
    }

    /// Does nothing, because no setting of NEAT may change during a run.
    fn apply_settings(&mut self, _: &RunPlan) {}
}
