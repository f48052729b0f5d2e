//! Tests of changes of settings during a run.

use super::*;
use crate::evolve::{Strategy, StrategyKind, begin, fields, resume};
use crate::genome::{ControllerKind, Genome};
use crate::score::{Behaviour, Evaluation};
use crate::world::{Disqualification, Effort};

fn plan(strategy: StrategyKind) -> RunPlan {
    let mut settings = Settings::default();
    settings.evolution.strategy = strategy;
    settings.evolution.population = 24;
    settings.genome.controller = ControllerKind::Gait;
    settings.trial.duration_s = 1.0;
    settings.suit_to_strategy();
    RunPlan::new("test", 1, settings)
}

/// Changes a setting below `evolution` to the value in `text`.
fn change(plan: &mut RunPlan, generation: u32, field: &str, text: &str) -> Result<(), Invalid> {
    let change = plan.change_of_text(generation, &format!("evolution.{field}"), text)?;
    plan.change(&change)
}

fn changed(plan: &RunPlan, changes: &[(u32, &str, &str)]) -> RunPlan {
    let mut plan = plan.clone();
    for (generation, field, value) in changes {
        change(&mut plan, *generation, field, value).expect("allowed");
    }
    plan
}

/// Returns distinct evaluations without a simulation; some are disqualified.
fn evaluations(generation: u32, count: usize) -> Vec<Evaluation> {
    let evaluation = |index: usize| {
        let number = ((index * 37 + generation as usize * 11) % 101) as f32;
        Evaluation {
            disqualified: (index % 7 == 3).then_some(Disqualification::TooFast),
            steps: 60,
            effort: Some(Effort { energy_j: 100.0 * number, ..Effort::default() }),
            behaviour: Some(Behaviour { contact_duty: number / 101.0, ..Behaviour::default() }),
            ..Evaluation::of_fitness(number / 10.0 - 7.0)
        }
    };
    (0..count).map(evaluation).collect()
}

fn advance(strategy: &mut dyn Strategy, generation: u32) {
    let asked = strategy.ask();
    strategy.tell(&asked, &evaluations(generation, asked.len()));
}

fn genomes(strategy: &dyn Strategy) -> Vec<Genome> {
    strategy.ask().into_iter().map(|candidate| candidate.genome).collect()
}

/// Settings of each strategy that may change, with a new value for each.
const ALLOWED: [(StrategyKind, &[(&str, &str)]); 13] = [
    (
        StrategyKind::BodyMapElites,
        &[
            ("body_map_elites.two_parents", "0.9"),
            ("body_map_elites.mutation_step", "0.2"),
            ("population", "7"),
            ("population", "30"),
        ],
    ),
    (
        StrategyKind::BodyGa,
        &[
            ("body_ga.protection", "none"),
            ("body_ga.tournament_size", "7"),
            ("body_ga.two_parents", "0.9"),
            ("body_ga.mutation_step", "0.2"),
            ("body_ga.kept_best", "5"),
            ("population", "7"),
            ("population", "30"),
        ],
    ),
    (
        StrategyKind::BodyNovelty,
        &[
            ("novelty.weight", "0.9"),
            ("novelty.neighbours", "3"),
            ("body_ga.tournament_size", "7"),
            ("body_ga.mutation_step", "0.2"),
        ],
    ),
    (StrategyKind::Islands, &[("generations", "40")]),
    (StrategyKind::Poet, &[("poet.children", "3")]),
    (StrategyKind::BodyPoet, &[("body_ga.tournament_size", "7")]),
    (StrategyKind::Mcc, &[("mcc.uses_of_stairs", "3")]),
    (
        StrategyKind::Halving,
        &[
            ("halving.parents", "2"),
            ("halving.parents", "9"),
            ("halving.mutation_range_nm", "300"),
            ("halving.mutation_decay", "1"),
            ("population", "7"),
            ("population", "30"),
            ("generations", "9"),
        ],
    ),
    (
        StrategyKind::Ga,
        &[
            ("ga.selection", "rank"),
            ("ga.tournament", "7"),
            ("ga.crossover", "one_point"),
            ("ga.crossover_share", "0.9"),
            ("ga.mutation", "uniform"),
            ("ga.cooling", "0.7"),
            ("ga.elites", "5"),
            ("population", "7"),
            ("population", "30"),
        ],
    ),
    (StrategyKind::CmaEs, &[("generations", "40")]),
    (
        StrategyKind::MapElites,
        &[
            ("map_elites.step", "0.2"),
            ("map_elites.line", "1"),
            ("map_elites.cma_share", "0.2"),
            ("map_elites.cma_share", "1"),
            ("map_elites.cma_share", "0"),
            ("map_elites.cma_step", "0.4"),
            ("population", "7"),
            ("population", "30"),
        ],
    ),
    (
        StrategyKind::Novelty,
        &[
            ("novelty.weight", "1"),
            ("novelty.neighbours", "2"),
            ("novelty.remembered", "20"),
            ("novelty.archive_limit", "3"),
            ("novelty.archive_limit", "15"),
            ("ga.elites", "5"),
            ("population", "7"),
            ("population", "30"),
        ],
    ),
    (StrategyKind::Random, &[("population", "7"), ("generations", "9")]),
];

#[test]
fn applying_changed_settings_gives_the_same_bits_as_resuming_with_them() {
    for (kind, changes) in ALLOWED {
        let begun = plan(kind);
        let after_three = || {
            let mut strategy = begin(&begun);
            (1..=3).for_each(|generation| advance(&mut *strategy, generation));
            strategy
        };
        for (field, value) in changes {
            let what = format!("{kind}: {field} {value}");
            let mut told = after_three();
            let plan = changed(&begun, &[(4, field, value)]);
            let unchanged = genomes(&*told);
            told.apply_settings(&plan);
            let mut resumed = resume(&begun, 3, &after_three().state()).expect("its own state");
            resumed.apply_settings(&plan);
            for generation in 4..=6 {
                assert_eq!(genomes(&*told), genomes(&*resumed), "{what}");
                assert_eq!(told.state(), resumed.state(), "{what}");
                assert_eq!(told.population(), told.ask().len(), "{what}");
                advance(&mut *told, generation);
                advance(&mut *resumed, generation);
                // The strategy's new state can be read back from a checkpoint.
                let again = resume(&plan, generation, &told.state()).expect(&what);
                assert_eq!(genomes(&*again), genomes(&*told), "{what}");
            }
            let has_effect = *field != "generations";
            let mut otherwise = after_three();
            assert_eq!(genomes(&*otherwise), unchanged);
            (4..=6).for_each(|generation| advance(&mut *otherwise, generation));
            assert_eq!(genomes(&*otherwise) != genomes(&*told), has_effect, "{what}");
        }
    }
}

#[test]
fn settings_may_change_or_have_a_reason_why_not() {
    for kind in StrategyKind::ALL {
        let settings = plan(kind).settings;
        let allowed: Vec<String> = fields(&settings)
            .into_iter()
            .map(|(field, _)| field)
            .filter(|field| match may_change_during_run(field, &settings) {
                Ok(()) => true,
                Err(reason) => {
                    assert!(reason.ends_with('.') && reason != UNKNOWN, "{field}: {reason}");
                    false
                }
            })
            .collect();
        assert!(allowed.iter().all(|field| field.starts_with("evolution.")), "{allowed:?}");
        assert!(allowed.contains(&"evolution.generations".to_owned()));
        let known = ALLOWED.iter().filter(|(of, _)| *of == kind);
        for (field, _) in known.flat_map(|(_, changes)| *changes) {
            assert!(allowed.contains(&format!("evolution.{field}")), "{kind}: {field}");
        }
    }
    let settings = Settings::default();
    let reason = |field| may_change_during_run(field, &settings).expect_err("not allowed");
    for (field, beginning) in [
        ("trial.surface.friction", "the fitness of earlier"),
        ("genome.points_per_s", "existing genomes would not fit"),
        ("genome.wave.harmonics", "existing genomes would not fit"),
        ("evolution.strategy", "another strategy cannot use"),
        ("evolution.ga.elites", "the current run does not use it"),
        ("evolution.ga.step", "the current run does not use it"),
    ] {
        let cause = reason(field).strip_prefix("Takes effect with the next run, because ");
        assert!(cause.is_some_and(|cause| cause.starts_with(beginning)), "{field}: {cause:?}");
    }
    assert_eq!(reason("population"), UNKNOWN);
    let cma_es = plan(StrategyKind::CmaEs).settings;
    for field in ["population", "cma_es.step", "cma_es.active", "cma_es.restarts"] {
        let reason = may_change_during_run(&format!("evolution.{field}"), &cma_es);
        assert!(reason.is_err_and(|reason| reason.contains("state of CMA-ES")), "{field}");
    }
}

#[test]
fn a_new_mutation_range_decays_from_the_generation_of_its_change() {
    let begun = plan(StrategyKind::Halving);
    let (range, decay) = ("halving.mutation_range_nm", "halving.mutation_decay");
    let ranges = |changes: &[(u32, &str, &str)], from: u32| {
        let plan = changed(&begun, changes);
        [0, 1, 2].map(|more| plan.mutation_range_nm(from + more))
    };
    assert_eq!(ranges(&[], 2), [100.0, 50.0, 25.0]);
    assert_eq!(ranges(&[(1, range, "80")], 2), [80.0, 40.0, 20.0]);
    assert_eq!(ranges(&[(2, range, "80"), (2, decay, "0.25")], 2), [80.0, 20.0, 5.0]);
    assert_eq!(ranges(&[(4, range, "80")], 4), [80.0, 40.0, 20.0]);
    // The third generation had a range of 50.
    assert_eq!(ranges(&[(4, decay, "1")], 4), [50.0, 50.0, 50.0]);
    assert_eq!(ranges(&[(4, decay, "0.1"), (4, decay, "1")], 4), [50.0, 50.0, 50.0]);
    // Two changes for one generation have the same effect in either order.
    assert_eq!(ranges(&[(4, range, "80"), (4, decay, "0.25")], 4), [80.0, 20.0, 5.0]);
    assert_eq!(ranges(&[(4, decay, "0.25"), (4, range, "80")], 4), [80.0, 20.0, 5.0]);
    assert_eq!(ranges(&[(4, range, "80"), (6, decay, "1")], 5), [40.0, 40.0, 40.0]);
}

#[test]
fn the_budget_is_the_sum_of_all_generations_whatever_their_size() {
    let begun = plan(StrategyKind::Ga);
    assert_eq!(begun.budget(), 24 * 6);
    let smaller = changed(&begun, &[(4, "population", "5")]);
    assert_eq!(smaller.budget(), 3 * 24 + 3 * 5);
    let from_its_end = changed(&smaller, &[(7, "generations", "7")]);
    assert_eq!(from_its_end.budget(), 3 * 24 + 4 * 5);
    let longer = changed(&smaller, &[(5, "generations", "10"), (6, "population", "8")]);
    assert_eq!(longer.budget(), 3 * 24 + 2 * 5 + 5 * 8);
}

#[test]
fn refused_changes_leave_the_plan_as_it_was() {
    let mut plan = changed(&plan(StrategyKind::Halving), &[(3, "generations", "8")]);
    let before = plan.clone();
    for (generation, field, value, complaint) in [
        (2, "halving.parents", "7", "generation is 2; allowed: 3 to 8"),
        (10, "generations", "20", "generation is 10; allowed: 3 to 9"),
        (9, "generations", "8", "evolution.generations is 8; allowed: 9 to 10000"),
        (9, "halving.parents", "2", "generation is 9; allowed: 3 to 8"),
        (4, "generations", "3", "evolution.generations is 3; allowed: 4 to 10000"),
        (4, "halving.parents", "0", "evolution.halving.parents is 0; allowed: 1 to 100000"),
        (
            4,
            "halving.parents",
            "x",
            "evolution.halving.parents is \"x\"; allowed: 1 to 100000, whole",
        ),
        (
            4,
            "strategy",
            "ga",
            "changed setting is \"evolution.strategy\"; allowed: a setting that may change during a run (takes effect with the next run, because another strategy",
        ),
        (
            4,
            "ga.elites",
            "1",
            "changed setting is \"evolution.ga.elites\"; allowed: a setting that may change during a run (takes effect with the next run, because the current run",
        ),
    ] {
        let error = change(&mut plan, generation, field, value).expect_err("refused");
        assert!(error.to_string().starts_with(complaint), "{error}");
        assert_eq!(plan, before);
    }
    let long = change(&mut plan, 4, "population", &"1".repeat(100_000)).expect_err("refused");
    assert!(long.to_string().len() < 200, "{long}");
}

#[test]
fn a_change_stores_the_canonical_value_and_no_change_is_none() {
    let plan = plan(StrategyKind::Halving);
    let field = "evolution.halving.mutation_range_nm";
    let of_text = |text| plan.change_of_text(3, field, text).expect("allowed");
    let change = of_text("5e1");
    assert_eq!((change.generation, &*change.value.to_string()), (3, "50"));
    assert!(plan.changed(&change).expect("allowed").is_some());
    assert_eq!(plan.changed(&of_text("100.0")), Ok(None));
    assert!(plan.change_of_text(3, "mutation_range_nm", "50").is_err(), "by its full name only");
}
