//! The hardest stairs that a run of POET has solved.

use crate::run::exam::exam_ends;
use crate::run::{Cancelled, RunControl};
use crate::run::{EvaluationResult, Evaluator, Job, evaluate_in_order};
use snakes_core::evolve::{RunPlan, StairsNode, StairsTree};
use snakes_core::genome::Genome;
use snakes_core::save::HardStairs;
use snakes_core::score::{PerturbationRange, Trial, varied};

/// Minimum share of the way for a trial to count as a success.
const SUCCESS: f32 = 0.85;
/// Number of perturbed trials in which the agent of solved stairs is tested.
pub(super) const TRIALS: u32 = 10;
/// Number of perturbed trials that must succeed.
const MUST_SUCCEED: u32 = 8;
/// Number of the hardest stairs that a study uses.
pub(super) const HARDEST: usize = 5;

/// Returns the hardest solved stairs of a run, the hardest first. Only stairs whose agent succeeds in enough perturbed trials
/// count.
///
/// # Errors
/// [`Cancelled`], if `control` was cancelled.
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
        let range = PerturbationRange::default();
        let conditions = varied(&trials[index], &range, TRIALS, plan.seed);
        let ends = exam_ends(&agent.genome, &conditions, evaluator, control)?;
        let successes = ends.iter().filter(|end| end.way >= SUCCESS).count() as u32;
        if successes >= MUST_SUCCEED {
            let trials = ancestors(tree, node).map(|node| tree.nodes[node].trials).sum();
            let (node, stairs) = (node as u32, of.stairs);
            found.push(HardStairs { node, stairs, mean_share, successes, trials });
        }
    }
    Ok(found)
}

/// Returns the index of a staircase and those of all its ancestors.
fn ancestors(tree: &StairsTree, node: usize) -> impl Iterator<Item = usize> {
    let parent = |&node: &usize| tree.nodes.get(node)?.parent.map(|parent| parent as usize);
    std::iter::successors(Some(node), parent)
}

/// Evaluates jobs, and returns the share of the way that each covers, 0 if it was disqualified.
fn shares(
    trials: &[Trial],
    jobs: &[Job<'_>],
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<Vec<f32>, Cancelled> {
    let share = |result: EvaluationResult| {
        result.map_or(0.0, |scored| match scored.evaluation.disqualified {
            None => scored.evaluation.fitness.max(0.0),
            Some(_) => 0.0,
        })
    };
    let results = evaluate_in_order(trials, jobs, evaluator, control)?;
    Ok(results.into_iter().map(share).collect())
}
