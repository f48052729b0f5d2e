//! Measurements of runs in which bodies evolve: an archive of all bodies, and changes of their structure.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::edits::edit_changes;
use crate::run::{Ancestry, Cancelled, Evaluator, Experiment, Generation, RunControl};
use snakes_core::evolve::{
    Archive, Elite, RunPlan, Settings, body_archive, body_cell, feasible_cells,
};
use snakes_core::genome::Genome;
use snakes_core::save::StudyValue;

/// Measurements of the bodies of a run.
pub(super) struct BodyMeasures {
    archive: Archive<()>,
    feasible_cells: usize,
}

impl BodyMeasures {
    pub fn new(settings: &Settings) -> Self {
        let bodies = &settings.genome.bodies;
        let length_cells = settings.evolution.body_map_elites.length_cells;
        let archive = body_archive(bodies, length_cells, settings.trial.resting_fitness());
        Self { feasible_cells: feasible_cells(&archive, bodies), archive }
    }

    /// Adds the healthy individuals of a generation to the archive.
    pub fn add(&mut self, generation: &Generation) {
        let individuals = generation.genomes.iter().zip(&generation.evaluations);
        for (index, (genome, evaluation)) in individuals.enumerate() {
            if evaluation.disqualified.is_none() {
                let elite = Elite {
                    fitness: evaluation.fitness,
                    generation: generation.number,
                    individual: index as u32,
                    genes: (),
                };
                self.archive.add(body_cell(&self.archive, genome), elite);
            }
        }
    }

    /// Adds the values of the whole run to `values`.
    ///
    /// # Errors
    /// `control` was cancelled.
    pub fn finish(
        self,
        values: &mut BTreeMap<String, StudyValue>,
        plan: &RunPlan,
        experiment: &Experiment,
        evaluator: &dyn Evaluator,
        control: &RunControl,
    ) -> Result<(), Cancelled> {
        let filled = self.archive.elites().len() as f64 / self.feasible_cells.max(1) as f64;
        let ancestry = experiment.ancestry();
        let [late_changes, changes] =
            [experiment.finished() / 2, 0].map(|after| changes_after(&ancestry, after));
        let mut add = |name: &str, value| values.insert(name.to_owned(), value);
        add("filled_cells", StudyValue::Number(100.0 * filled));
        add("qd_score", StudyValue::Number(self.archive.qd_score()));
        add("changes", StudyValue::Number(changes as f64));
        add("late_changes", StudyValue::Number(late_changes as f64));
        if let Some(last) = experiment.generation() {
            for (name, changes) in edit_changes(plan, last, evaluator, control)? {
                add(name, StudyValue::Numbers(changes));
            }
        }
        Ok(())
    }
}

/// Counts the individuals in a line of descent that were born after `generation` and have another structure than their first
/// parent.
fn changes_after(ancestry: &Ancestry, generation: u32) -> usize {
    let pairs = ancestry.line.iter().zip(ancestry.line.iter().skip(1));
    let late = pairs.filter(|(child, _)| child.place.generation > generation);
    let structure =
        |genome: &Option<Arc<Genome>>| genome.as_ref().map(|genome| genome.body.block_ids());
    late.filter(|(child, parent)| structure(&child.genome) != structure(&parent.genome)).count()
}
