//! The hardest of the stairs that a run of POET has solved.

use std::sync::OnceLock;

use super::{HARDEST, MUST_SUCCEED, SUCCESS, TRIALS};
use crate::evolve::{Champion, Origin, RunPlan, StairsNode, StairsTree};
use crate::genome::Genome;
use crate::run::evaluator::{EvaluationResult, Evaluator, Job, evaluate_caught};
use crate::run::exam::exam_ends;
use crate::run::run_control::{Cancelled, RunControl};
use crate::save::HardStairs;
use crate::score::{Evaluation, PerturbationRange, Trial, varied};

/// The hardest solved stairs of a run, the hardest first: those whose agent succeeds in enough perturbed trials.
///
/// # Errors
/// [`Cancelled`], if `control` was.
pub fn hardest_stairs(
    plan: &RunPlan,
    tree: &StairsTree,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<Vec<HardStairs>, Cancelled> {
    let agents: Vec<&Genome> =
        tree.nodes.iter().filter_map(|node| Some(&node.agent.as_ref()?.genome)).collect();
    let solved: Vec<(usize, &StairsNode)> =
        tree.nodes.iter().enumerate().filter(|(_, node)| node.solved.is_some()).collect();
    let trials: Vec<Trial> =
        solved.iter().map(|(_, node)| node.trial(&plan.settings.trial)).collect();
    let jobs: Vec<Job<'_>> = (0..trials.len())
        .flat_map(|trial| agents.iter().map(move |genome| Job { genome, trial }))
        .collect();
    let shares = shares(&trials, &jobs, evaluator, control)?;
    let mut order: Vec<(f32, usize)> = shares
        .chunks(agents.len().max(1))
        .map(|of| of.iter().sum::<f32>() / of.len() as f32)
        .zip(0..)
        .collect();
    order.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let mut found = Vec::new();
    for (mean_share, index) in order {
        if found.len() >= HARDEST {
            break;
        }
        let (node, of) = solved[index];
        let Some(agent) = &of.agent else { continue };
        let champion = agent_on(plan, &agent.genome, trials[index].clone());
        let conditions = varied(&champion.trial, &PerturbationRange::default(), TRIALS, plan.seed);
        let ends = exam_ends(&champion, &conditions, evaluator, control)?;
        let successes = ends.iter().filter(|end| end.way >= SUCCESS).count() as u32;
        if successes >= MUST_SUCCEED {
            let trials = ancestors(tree, node).map(|node| tree.nodes[node].trials).sum();
            let (node, stairs) = (node as u32, of.stairs);
            found.push(HardStairs { node, stairs, mean_share, successes, trials });
        }
    }
    Ok(found)
}

fn agent_on(plan: &RunPlan, agent: &Genome, trial: Trial) -> Champion {
    let origin =
        Origin { preset: plan.preset.clone(), seed: plan.seed, generation: 1, individual: 0 };
    let evaluation = Evaluation {
        fitness: 0.0,
        centre_y_m: 0.0,
        disqualified: None,
        trace_hash: 0,
        steps: 0,
        effort: None,
        behaviour: None,
    };
    Champion { genome: agent.clone(), trial, evaluation, chosen_by: None, origin }
}

/// A staircase and all its ancestors.
fn ancestors(tree: &StairsTree, node: usize) -> impl Iterator<Item = usize> {
    let parent = |&node: &usize| tree.nodes.get(node)?.parent.map(|parent| parent as usize);
    std::iter::successors(Some(node), parent)
}

/// The share that each job covers.
fn shares(
    trials: &[Trial],
    jobs: &[Job<'_>],
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<Vec<f32>, Cancelled> {
    let results: Vec<OnceLock<EvaluationResult>> = jobs.iter().map(|_| OnceLock::new()).collect();
    evaluator.evaluate_jobs(trials, jobs, control, &|index, result| {
        // A second result of the same job is the same.
        let _ = results[index].set(result);
    })?;
    let share = |(result, job): (OnceLock<EvaluationResult>, &Job<'_>)| {
        let result =
            result.into_inner().unwrap_or_else(|| evaluate_caught(job.genome, &trials[job.trial]));
        result.map_or(0.0, |scored| match scored.evaluation.disqualified {
            None => scored.evaluation.fitness.max(0.0),
            Some(_) => 0.0,
        })
    };
    Ok(results.into_iter().zip(jobs).map(share).collect())
}
