//! A task with a known answer: the genetic algorithm shall find neurons that compute the exclusive or of two senses.

use super::respond;
use crate::evolve::{RunPlan, Settings, StrategyKind, begin};
use crate::genome::controllers::{LIMB_NEURONS, LimbNeuron, NEURON_SOURCES, NeuronSource};
use crate::genome::{ControllerGenes, ControllerKind, Genome};
use crate::score::Evaluation;

/// Evaluations that a run may take.
const MOST_EVALUATIONS: u32 = 20_000;

/// The largest error of the first neuron's output over the four cases, and the sum of the mean errors. A case lasts eight
/// steps from silence, and its last three count: the answer has to stay.
fn errors(neurons: &[LimbNeuron; LIMB_NEURONS]) -> [f32; 2] {
    let [mut largest, mut sum] = [0.0_f32; 2];
    for (a, b) in [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)] {
        let expected = if a == b { 0.0 } else { 1.0 };
        // No neighbours, no beat, and no other senses.
        let mut values = [0.0; NEURON_SOURCES];
        values[NeuronSource::Touch as usize] = a;
        values[NeuronSource::Blocked as usize] = b;
        for step in 0..8 {
            let outputs = respond(neurons, &values);
            values[..LIMB_NEURONS].copy_from_slice(&outputs);
            if step >= 5 {
                let error = (outputs[0] - expected).abs();
                largest = largest.max(error);
                sum += error / 3.0;
            }
        }
    }
    [largest, sum]
}

fn neurons(genome: &Genome) -> &[LimbNeuron; LIMB_NEURONS] {
    match &genome.controller {
        ControllerGenes::LimbNeurons(genes) => &genes.limbs[0],
        other => panic!("{other:?}"),
    }
}

/// The number of evaluations after which a run has an answer that is right in all four cases.
fn evaluations_needed(seed: u64, settings: &Settings) -> Option<u32> {
    let mut search = begin(&RunPlan::new("xor", seed, settings.clone()));
    let mut count = 0;
    while count < MOST_EVALUATIONS {
        let genomes = search.ask();
        let mut evaluations = Vec::with_capacity(genomes.len());
        for genome in &genomes {
            let [largest, sum] = errors(neurons(genome));
            count += 1;
            if largest < 0.5 {
                return Some(count).filter(|count| *count <= MOST_EVALUATIONS);
            }
            evaluations.push(Evaluation::of_fitness((4.0 - sum) * (4.0 - sum)));
        }
        search.tell(&genomes, &evaluations);
    }
    None
}

#[test]
#[ignore = "exploration"]
fn explore() {
    for population in [50, 100, 150, 300, 500] {
        for step in [0.05, 0.1, 0.2, 0.3] {
            for tournament in [2, 3, 5] {
                let mut settings = settings();
                settings.evolution.population = population;
                settings.evolution.ga.step = step;
                settings.evolution.ga.tournament = tournament;
                let mut needed: Vec<u32> =
                    (1..=40).filter_map(|seed| evaluations_needed(seed, &settings)).collect();
                needed.sort();
                println!(
                    "pop {population} step {step} tour {tournament}: {} of 40, median {:?} worst {:?}",
                    needed.len(),
                    needed.get(needed.len() / 2),
                    needed.last()
                );
            }
        }
    }
}

fn settings() -> Settings {
    let mut settings = Settings::default();
    settings.genome.controller = ControllerKind::LimbNeurons;
    settings.evolution.strategy = StrategyKind::Ga;
    settings
}
