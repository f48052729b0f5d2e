//! Tests of minimal criterion coevolution with made-up evaluations.

use std::sync::Arc;

use super::*;
use crate::evolve::plan::Founder;
use crate::evolve::settings::StrategyKind;
use crate::evolve::strategies::cma_es::CmaEs;
use crate::evolve::strategies::fixtures::{self, assert_resumes};
use crate::score::Fitness;
use crate::world::Disqualification;

fn plan() -> RunPlan {
    fixtures::plan(StrategyKind::Mcc, |settings| {
        settings.trial.fitness = Fitness::Share;
        let mcc = &mut settings.evolution.mcc;
        (mcc.snake_queue, mcc.first_snakes, mcc.stairs_queue) = (20, 10, 6);
    })
}

/// Returns an evaluation whose share of the way falls with the distance of a gene from a target, which follows from the rise of the stairs.
fn evaluate(mcc: &Mcc<CmaEs>, attempt: &Attempt<MccRole>) -> Evaluation {
    let point = mcc.plan.settings.genome.point_of(&attempt.candidate.genome);
    let target = 0.5 + f64::from(attempt.stairs.rise_m) / 2.4;
    let off = 1.5 * (point[point.len() - 1] - target).abs();
    Evaluation::of_fitness((1.05 - off).clamp(0.0, 1.05) as f32)
}

fn advance(mcc: &mut Mcc<CmaEs>) {
    let asked = mcc.ask();
    assert!(!asked.is_empty());
    assert_eq!(mcc.population(), asked.len());
    assert!(asked.iter().all(|candidate| candidate.stairs.is_some()));
    let evaluations: Vec<Evaluation> =
        mcc.batch.iter().map(|attempt| evaluate(mcc, attempt)).collect();
    mcc.tell(&asked, &evaluations);
}

/// Returns a run after the given number of rounds, and its number of generations.
fn run(rounds: u32) -> (Mcc<CmaEs>, u32) {
    let mut mcc = Mcc::<CmaEs>::begin(&plan());
    let mut generations = 0;
    while mcc.progress.rounds < rounds {
        advance(&mut mcc);
        generations += 1;
    }
    (mcc, generations)
}

#[test]
fn queues_are_filled_and_shortened_and_every_member_meets_the_criterion() {
    let (mcc, _) = run(40);
    let MccProgress { snakes, nodes, uses, rounds, .. } = &mcc.progress;
    let tree = mcc.stairs_tree().expect("it has one");
    assert_eq!((tree.rounds, *rounds), (40, 40));
    assert_eq!(snakes.len(), 20);
    assert_eq!(tree.active(), 6);
    assert!(tree.nodes.len() > 10, "{} stairs", tree.nodes.len());
    assert!(nodes.iter().any(|node| node.stairs.rise_m > 0.3), "they have become higher");
    for (index, node) in nodes.iter().enumerate() {
        assert_eq!(node.parent.is_none(), index == 0);
        assert!(node.solved.is_some() && node.score >= mcc.settings().criterion);
        let agent = node.agent.as_ref().expect("a snake climbs it");
        let attempt = Attempt::new(&agent.genome, node.stairs, MccRole::First);
        assert_eq!(evaluate(&mcc, &attempt).fitness, node.score);
    }
    assert!(uses.iter().all(|uses| *uses <= mcc.settings().uses_of_stairs), "{uses:?}");
    assert!(mcc.progress.snake_turn < 20 && mcc.progress.stairs_turn < 6);
    let born: Vec<u32> = nodes.iter().map(|node| node.born).collect();
    assert!(born.is_sorted());
}

#[test]
fn used_up_stairs_let_no_more_snakes_in() {
    let (mut mcc, _) = run(1);
    mcc.progress
        .uses
        .iter_mut()
        .for_each(|uses| *uses = mcc.plan.settings.evolution.mcc.uses_of_stairs);
    mcc.batch = mcc.next_batch();
    let is_of_snake = |attempt: &Attempt<MccRole>| matches!(attempt.role, MccRole::Snake { .. });
    assert!(!mcc.batch.iter().any(is_of_snake), "no child can enter");
    assert!(!mcc.batch.is_empty(), "mutants of stairs are tried");
    let before = mcc.progress.snakes.clone();
    advance(&mut mcc);
    assert_eq!(mcc.progress.snakes, before);
}

#[test]
fn a_child_enters_by_the_least_used_of_the_stairs_that_it_climbs() {
    let (mut mcc, _) = run(3);
    let open: Vec<u32> = mcc.progress.active().collect();
    assert!(open.len() > 1);
    let least = open[open.len() - 1];
    mcc.progress.uses.iter_mut().for_each(|uses| *uses = 2);
    mcc.progress.uses[least as usize] = 1;
    mcc.batch = mcc.next_batch();
    let asked = mcc.ask();
    let is_first =
        |attempt: &Attempt<MccRole>| matches!(attempt.role, MccRole::Snake { child: 0, .. });
    let evaluations: Vec<Evaluation> = mcc
        .batch
        .iter()
        .map(|attempt| Evaluation::of_fitness(if is_first(attempt) { 1.0 } else { 0.0 }))
        .collect();
    mcc.tell(&asked, &evaluations);
    assert_eq!(mcc.progress.uses[least as usize], 2);
    let entered = mcc.progress.snakes.last().expect("one");
    assert_eq!(entered.genome, asked[0].genome);
    let of_stairs = &mcc.progress.nodes[least as usize];
    assert_eq!((of_stairs.agent.as_ref() == Some(entered)), of_stairs.score == 1.0);
}

#[test]
fn a_disqualified_snake_climbs_nothing() {
    let mcc = Mcc::<CmaEs>::begin(&plan());
    let evaluation = Evaluation::of_fitness(0.9);
    assert!(mcc.climbs(&evaluation));
    let disqualified = Some(Disqualification::TooFast);
    assert!(!mcc.climbs(&Evaluation { disqualified, ..evaluation }));
    assert!(!mcc.climbs(&Evaluation::of_fitness(0.8)));
}

#[test]
fn a_resumed_run_goes_on_with_the_same_bits() {
    let mut phases = [false; 2];
    assert_resumes(Mcc::<CmaEs>::begin(&plan()), &plan(), 0..30, advance, |mcc| {
        phases[usize::from(mcc.progress.beginning.is_some())] = true;
    });
    assert_eq!(phases, [true; 2]);
}

#[test]
fn each_snake_has_children_in_turn_while_others_come_and_go() {
    let (mut mcc, _) = run(1);
    let mut parents: Vec<u32> = Vec::new();
    // In each generation two children enter, and the two oldest snakes are removed.
    let queue = mcc.settings().snake_queue as usize;
    let mut oldest = 0;
    while mcc.progress.snakes.len() < queue {
        let first = mcc.progress.snakes[0].clone();
        mcc.progress.snakes.push(first);
    }
    for _ in 0..20 {
        let children = mcc.settings().snake_children;
        let turn = mcc.progress.snake_turn;
        parents.extend((0..children).map(|child| oldest + (turn + child) % queue as u32));
        mcc.progress.pass_turns(children, 1);
        for _ in 0..2 {
            let newest = mcc.progress.snakes[0].clone();
            mcc.progress.snakes.push(newest);
        }
        mcc.progress.shorten(&mcc.plan.settings.evolution.mcc);
        oldest += 2;
    }
    // The snakes are numbered in the order in which they entered. Turns go from the oldest to the newest snake, and then back to the
    // oldest.
    for pair in parents.windows(2) {
        let is_next = pair[1] == pair[0] + 1;
        assert!(is_next || pair[1] < pair[0], "{pair:?} of {parents:?}");
    }
}

#[test]
fn a_search_with_a_founder_and_equal_values_is_resumed_after_a_change_of_settings() {
    let mut plan = plan();
    let space = &plan.settings.genome;
    let genome = space
        .random_genome(plan.settings.trial.genome_shape(), &mut stream(5, 0, 0, Purpose::Birth));
    plan.founder = Some(Arc::new(Founder::new("x", genome)));
    let mut mcc = Mcc::<CmaEs>::begin(&plan);
    for finished in 1..PATIENCE + 3 {
        if finished == 7 || finished == PATIENCE {
            plan.settings.evolution.mcc.child_step = 0.2 + finished as f32 / 1000.0;
            plan.settings.evolution.mcc.snake_queue = 15;
            mcc.apply_settings(&plan);
        }
        let asked = mcc.ask();
        mcc.tell(&asked, &vec![Evaluation::of_fitness(0.1); asked.len()]);
        let resumed = Mcc::<CmaEs>::resume(&plan, finished, &mcc.state()).expect("its own state");
        assert_eq!(resumed.ask(), mcc.ask(), "after generation {finished}");
    }
}

#[test]
fn shorter_queues_take_effect_at_once_and_after_a_resume() {
    let (mut mcc, finished) = run(20);
    let state = mcc.state();
    let mut plan = plan();
    let of = &mut plan.settings.evolution.mcc;
    (of.snake_queue, of.first_snakes, of.stairs_queue) = (5, 5, 2);
    mcc.apply_settings(&plan);
    let resumed = Mcc::<CmaEs>::resume(&plan, finished, &state).expect("its own state");
    assert_eq!((mcc.progress.snakes.len(), mcc.progress.active().count()), (5, 2));
    assert!(resumed.state() == mcc.state());
}

#[test]
fn a_search_that_finds_no_snake_begins_again() {
    let mut mcc = Mcc::<CmaEs>::begin(&plan());
    let first = mcc.ask();
    for _ in 0..PATIENCE {
        let asked = mcc.ask();
        mcc.tell(&asked, &vec![Evaluation::of_fitness(0.1); asked.len()]);
    }
    let beginning = mcc.progress.beginning.as_ref().expect("nothing was found");
    assert_eq!((beginning.restarts, beginning.finished, beginning.idle), (1, 0, 0));
    assert_ne!(mcc.ask(), first, "with other random genomes");
}

#[test]
fn a_state_that_no_run_can_have_is_refused() {
    let (mcc, finished) = run(6);
    let text = ron::to_string(&mcc.state()).expect("written");
    let refused = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        let state: StrategyState = ron::from_str(&text.replacen(from, to, 1)).expect("RON");
        let error = Mcc::<CmaEs>::resume(&plan(), finished, &state).err().expect("refused");
        error.to_string()
    };
    let error = refused("rounds: 6", "rounds: 4000000");
    assert!(error.starts_with("rounds is 4000000; allowed: 0 to "), "{error}");
    let error = refused("steps: 10", "steps: 4000000");
    assert!(error.contains("steps is 4000000; allowed: 3 to 20"), "{error}");
    let error = refused("snake_turn: ", "snake_turn: 99");
    assert!(error.starts_with("snake_turn is 99"), "{error}");
    assert!(!refused("uses: [", "uses: [3, ").is_empty());
    assert!(!refused("snakes: [", "snakes: [], old: [").is_empty());
}
