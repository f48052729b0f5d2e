//! Tests of POET with made-up evaluations.

use super::*;
use crate::evolve::settings::StrategyKind;
use crate::evolve::strategies::cma_es::CmaEs;
use crate::evolve::strategies::fixtures::{self, assert_resumes};
use crate::score::Fitness;
use crate::world::Disqualification;

fn plan() -> RunPlan {
    fixtures::plan(StrategyKind::Poet, |settings| {
        settings.trial.fitness = Fitness::Share;
        let poet = &mut settings.evolution.poet;
        (poet.pairs, poet.learn_generations, poet.transfers, poet.children) = (4, 6, 2, 24);
    })
}

/// Returns an evaluation whose share of the way falls with the distance of a gene from a target, which follows from the rise of the stairs.
fn evaluate(poet: &Poet<CmaEs>, attempt: &Attempt<PoetRole>) -> Evaluation {
    let point = poet.plan.settings.genome.point_of(&attempt.candidate.genome);
    let target = f64::from(attempt.stairs.rise_m) / 1.2;
    let [first, second] = [point[point.len() - 1], point[point.len() - 2]];
    let off: f64 = 3.0 * (first - target).abs() + (second - 0.5).abs() / 4.0;
    Evaluation::of_fitness((1.05 - off).clamp(0.0, 1.05) as f32)
}

fn advance(poet: &mut Poet<CmaEs>) {
    let asked = poet.ask();
    assert!(!asked.is_empty());
    assert_eq!(poet.population(), asked.len());
    assert!(asked.iter().all(|candidate| candidate.stairs.is_some()));
    let evaluations: Vec<Evaluation> =
        poet.batch.iter().map(|attempt| evaluate(poet, attempt)).collect();
    poet.tell(&asked, &evaluations);
}

/// Returns a run after the given number of rounds, and its number of generations.
fn run(rounds: u32) -> (Poet<CmaEs>, u32) {
    let mut poet = Poet::<CmaEs>::begin(&plan());
    let mut generations = 0;
    while poet.progress.rounds < rounds {
        advance(&mut poet);
        generations += 1;
    }
    (poet, generations)
}

#[test]
fn stairs_come_are_solved_and_the_oldest_are_archived() {
    let (poet, _) = run(16);
    let tree = poet.stairs_tree().expect("it has one");
    assert!(tree.nodes.len() > 6, "{} stairs", tree.nodes.len());
    assert!(tree.active() <= 4);
    assert_eq!(tree.active() + archived(&tree), tree.nodes.len());
    assert!(tree.solved_challenges() >= 2);
    for (index, node) in tree.nodes.iter().enumerate() {
        assert_eq!(node.parent.is_none(), index == 0);
        assert!(node.parent.is_none_or(|parent| (parent as usize) < index));
        assert!(node.agent.is_some());
        assert!(node.trials > 0 || node.born == tree.rounds);
    }
    let born: Vec<u32> = tree.nodes.iter().map(|node| node.born).collect();
    assert!(born.is_sorted());
    // Each staircase has been compared with each agent of the panel.
    assert_eq!(poet.progress.panel.len(), tree.nodes.len());
    assert!(poet.progress.rows.iter().all(|row| row.len() == tree.nodes.len()));
}

fn archived(tree: &StairsTree) -> usize {
    tree.nodes.iter().filter(|node| node.archived.is_some()).count()
}

/// Gives the last pair, whose search has begun, an agent that hardly moves, before a measurement. Returns the index of its stairs.
fn forget_an_agent(poet: &mut Poet<CmaEs>) -> u32 {
    advance(poet);
    let target = poet.progress.pairs[3].node;
    let shape = poet.plan.settings.trial.genome_shape();
    let space = &poet.plan.settings.genome;
    let idle = space.genome_at(&vec![0.99; space.dimension(shape)], shape);
    let node = poet.progress.node_mut(target).expect("it is there");
    let agent = Agent { genome: idle, generation: 1, individual: 0 };
    (node.agent, node.score) = (Some(agent), 0.0);
    let pair = poet.progress.pair_mut(target).expect("it is active");
    (pair.recent, pair.challenger) = (vec![0.0], None);
    poet.progress.phase = Phase::Measure;
    poet.batch = poet.next_batch();
    target
}

#[test]
fn an_agent_that_climbs_other_stairs_better_moves_there() {
    let (mut poet, _) = run(4);
    let target = forget_an_agent(&mut poet);
    advance(&mut poet);
    assert!(matches!(poet.progress.phase, Phase::Tune { .. }));
    advance(&mut poet);
    assert!(matches!(poet.progress.phase, Phase::Confirm { .. }));
    advance(&mut poet);
    let moved = poet.progress.transfers.last().expect("a transfer");
    assert_eq!((moved.round, moved.to), (5, target));
    assert_ne!(moved.from, target);
    let pair = poet.progress.pair_mut(target).expect("it is active");
    assert_eq!((pair.restarts, pair.finished), (1, 0), "its search begins again around the agent");
    let beaten = pair.recent.clone();
    let node = poet.progress.node(target).expect("it is there");
    assert_eq!(beaten[0], 0.0);
    assert!(beaten[1] < beaten[2] && beaten[2] == node.score, "{beaten:?}");
}

#[test]
fn a_resumed_run_goes_on_with_the_same_bits_from_any_phase() {
    let (mut poet, generations) = run(4);
    forget_an_agent(&mut poet);
    let mut phases = std::collections::BTreeSet::new();
    let finished = generations + 1..generations + 121;
    assert_resumes(poet, &plan(), finished, advance, |poet| {
        phases.insert(format!("{:?}", poet.progress.phase)[..5].to_owned());
    });
    assert_eq!(phases.len(), 7, "{phases:?}");
}

#[test]
fn a_disqualified_snake_scores_nothing() {
    let evaluation = Evaluation::of_fitness(0.9);
    assert_eq!(Poet::<CmaEs>::score(&evaluation), 0.9);
    let disqualified = Some(Disqualification::TooFast);
    assert_eq!(Poet::<CmaEs>::score(&Evaluation { disqualified, ..evaluation }), 0.0);
}

#[test]
fn a_state_that_no_run_can_have_is_refused() {
    let (poet, finished) = run(6);
    let text = ron::to_string(&poet.state()).expect("written");
    let refused = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        let state: StrategyState = ron::from_str(&text.replacen(from, to, 1)).expect("RON");
        let error = Poet::<CmaEs>::resume(&plan(), finished, &state).err().expect("refused");
        error.to_string()
    };
    let error = refused("rounds: 6", "rounds: 4000000");
    assert!(error.starts_with("rounds is 4000000; allowed: 0 to "), "{error}");
    let error = refused("steps: 10", "steps: 4000000");
    assert!(error.contains("steps is 4000000; allowed: 3 to 20"), "{error}");
    let node = format!("node: {}", poet.progress.pairs[0].node);
    let error = refused(&node, "node: 70");
    assert!(error.contains("stairs is 70"), "{error}");
    assert!(!refused("rows: [", "rows: [], old: [").is_empty());
    assert!(!refused("Learn", "Rest").is_empty());
}
