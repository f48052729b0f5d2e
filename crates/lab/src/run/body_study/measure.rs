//! The measurements of a run of the study.

use std::sync::Arc;

use super::splits::split_changes;
use crate::run::evaluator::Evaluator;
use crate::run::experiment::Experiment;
use crate::run::lineage::{Ancestry, Generation};
use crate::run::run_control::{Cancelled, RunControl};
use snakes_core::evolve::{Archive, Elite, RunPlan, body_archive, body_cell};
use snakes_core::genome::Genome;
use snakes_core::save::BodyStudyRun;

/// Makes a run to its end and measures it.
pub(super) fn measured(
    experiment: &mut Experiment,
    plan: &RunPlan,
    evaluator: &dyn Evaluator,
    control: &RunControl,
    spent: &(dyn Fn(u64) + Sync),
) -> Result<BodyStudyRun, Cancelled> {
    let settings = &plan.settings;
    let mut archive: Archive<()> = body_archive(
        &settings.genome.bodies,
        settings.evolution.body_map_elites.length_cells,
        settings.trial.resting_fitness(),
    );
    while !experiment.is_over() {
        let report = experiment.run_generation(evaluator, control)?;
        spent(report.evaluations.into());
        if let Some(generation) = experiment.generation() {
            collect(&mut archive, generation);
        }
    }
    let best = experiment.best();
    let ancestry = experiment.ancestry();
    let [late_changes, changes] =
        [experiment.finished() / 2, 0].map(|after| changes_after(&ancestry, after));
    let [split, insertion] = match experiment.generation() {
        Some(last) => split_changes(plan, last, evaluator, control)?,
        None => [Vec::new(), Vec::new()],
    };
    Ok(BodyStudyRun {
        seed: plan.seed,
        evaluations: u32::try_from(experiment.evaluated()).unwrap_or(u32::MAX),
        share: best.map(|best| best.evaluation.fitness),
        blocks: best.map_or(0, |best| best.genome.body.block_count() as u32),
        changes,
        late_changes,
        cells: archive.elites().len() as u32,
        qd_score: archive.qd_score(),
        split_changes: split,
        insertion_changes: insertion,
        run_hash: format!("{:016x}", experiment.run_hash()),
    })
}

/// Adds the healthy individuals of a generation to an archive of all that were evaluated.
fn collect(archive: &mut Archive<()>, generation: &Generation) {
    let individuals = generation.genomes.iter().zip(&generation.evaluations);
    for (index, (genome, evaluation)) in individuals.enumerate() {
        if evaluation.disqualified.is_none() {
            let elite = Elite {
                fitness: evaluation.fitness,
                generation: generation.number,
                individual: index as u32,
                genes: (),
            };
            archive.add(body_cell(archive, genome), elite);
        }
    }
}

/// Number of individuals in a line of descent that were born after a generation with another structure than their first
/// parent.
fn changes_after(ancestry: &Ancestry, generation: u32) -> u32 {
    let pairs = ancestry.line.iter().zip(ancestry.line.iter().skip(1));
    let late = pairs.filter(|(child, _)| child.place.generation > generation);
    let structure =
        |genome: &Option<Arc<Genome>>| genome.as_ref().map(|genome| genome.body.block_ids());
    late.filter(|(child, parent)| structure(&child.genome) != structure(&parent.genome)).count()
        as u32
}
