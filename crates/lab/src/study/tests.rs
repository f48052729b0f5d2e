//! Studies from their definitions to their verdicts.

use std::path::Path;

use super::*;
use crate::run::{LocalPool, RunControl};
use snakes_core::evolve::StrategyKind;
use snakes_core::genome::ControllerKind;
use snakes_core::save::{Protocol, StudiedRun, StudyRuns, StudyValue, parse_definition};
use snakes_core::score::Fitness;

/// A study of two arms with short trials and a demand.
const TINY: &str = r#"(
    name: "tiny",
    title: "Two strategies",
    seeds: 2,
    evaluations: 12,
    settings: {"evolution.population": 6, "trial.duration_s": 0.5, "repeats.champion_trials": 2},
    arms: [
        (name: "search", settings: {"strategy": "cma_es"}),
        (name: "random", title: "At random", settings: {"strategy": "random"}),
    ],
    baseline: "random",
    suites: ["step-rate"],
    show: ["fitness", "generation_means"],
    compare: ["fitness"],
    demands: [(arms: ["search"], measure: Difference(of: "fitness"), must: 0)],
)"#;

fn defined(text: &str) -> Study {
    let mut study: Study = parse_definition(Path::new("test"), text).expect("RON");
    study.set_methods().expect("allowed");
    study.check().expect("allowed");
    study
}

fn performed(study: &Study, folder: &Path, threads: usize) -> (StudyRuns, String) {
    let files = StudyFiles::within(folder, study);
    let pool = LocalPool::new(threads).expect("threads");
    let (runs, findings) =
        perform(study, &files, false, &pool, &RunControl::default()).expect("performed");
    let text = tables(&Results { study, runs: &runs, findings: &findings });
    (runs, text)
}

#[test]
fn every_built_in_study_has_a_plan_for_each_arm_and_no_two_arms_make_the_same_runs() {
    for study in built_in_studies().expect("well formed") {
        let planned = study.planned().expect("allowed");
        assert_eq!(planned.len() as u64, study.arms.len() as u64 * study.seeds, "{}", study.name);
        for (index, run) in planned[..study.arms.len()].iter().enumerate() {
            assert!(planned[..index].iter().all(|other| other.protocol != run.protocol), "{run:?}");
        }
        for demand in &study.demands {
            assert!(demand.must.or(demand.hard).is_some() || !demand.measure.values().is_empty());
        }
    }
}

#[test]
fn a_study_has_the_same_results_for_any_number_of_threads_and_continues_with_what_is_missing() {
    let folder = tempfile::tempdir().expect("a folder");
    let study = defined(TINY);
    let mut first = study.clone();
    first.seeds = 1;
    first.selected = vec!["search".to_owned()];
    let (runs, _) = performed(&first, &folder.path().join("a"), 1);
    assert_eq!((runs.arms.len(), runs.of_arm("search").len()), (1, 1));
    let (runs, text) = performed(&study, &folder.path().join("a"), 2);
    let (whole, other_text) = performed(&study, &folder.path().join("b"), 1);
    assert_eq!((&runs, &text), (&whole, &other_text));
    let run = &runs.of_arm("search")[0];
    let generations = run.numbers("generation_means").len() as f64;
    let evaluations = run.number("evaluations").expect("counted");
    assert!(generations >= 1.0 && evaluations <= 12.0, "{run:?}");
    // Two candidates take three trials each in each generation. The exam has five step rates and the undisturbed trial.
    let simulations = evaluations + generations * 2.0 * 3.0 + 6.0;
    assert_eq!(run.number("simulations"), Some(simulations));
    assert_eq!(
        run.curve.last().copied().flatten().map(f64::from).map(|of| of as f32),
        run.number("fitness").map(|of| of as f32)
    );
    for part in
        ["| search", "| At random", "generation", "best fitness, more than random", "A: chance"]
    {
        assert!(text.contains(part), "{part} in {text}");
    }
    let files = StudyFiles::within(&folder.path().join("a"), &study);
    assert!(files.all().iter().all(|file| file.exists()));
    assert!(files.champion(&study.arms[0], 1).exists());
    let mut other = study.clone();
    other.settings.insert("surface.friction".to_owned(), Plain::Number(0.8));
    let pool = LocalPool::new(1).expect("threads");
    let refusal =
        perform(&other, &files, false, &pool, &RunControl::default()).expect_err("refused");
    let changed = "tiny.ron: settings of search is changed: trial.surface.friction was as in climb and is 0.8;";
    assert!(refusal.to_string().contains(changed), "{refusal}");
    assert!(
        perform(&other, &files, true, &pool, &RunControl::default()).is_ok(),
        "it begins again"
    );
}

#[test]
fn what_a_definition_must_not_say_is_refused_with_the_allowed_values() {
    for (from, to, message) in [
        ("\"random\",\n", "\"walker\",\n", "baseline is \"walker\"; allowed: search, random"),
        (
            "(of: \"fitness\")",
            "(of: \"speed\")",
            "demands.measure.of is \"speed\"; allowed: evaluations",
        ),
        (
            "(of: \"fitness\")",
            "(of: \"tree\")",
            "demands.measure.of is \"tree\"; allowed: a number",
        ),
        (
            "name: \"random\"",
            "name: \"search\"",
            "arms.name is \"search\"; allowed: a name that no other arm has",
        ),
        ("seeds: 2", "seeds: 0", "seeds is 0; allowed: 1 to 10000"),
        (
            "Difference(of: \"fitness\")",
            "Overlap(of: \"fitness\"), at_most: true",
            "demands.at_most is true; allowed: false",
        ),
        (
            "\"generation_means\"]",
            "\"exam_shove\"]",
            "show is \"exam_shove\"; allowed: other values, or suites with \"shove\"",
        ),
        (
            "\"generation_means\"]",
            "\"exam_ode_kept\"]",
            "show is \"exam_ode_kept\"; allowed: other values, or judges with \"ode\"",
        ),
        (
            "compare: [\"fitness\"]",
            "compare: [\"tree\"]",
            "compare is \"tree\"; allowed: a value that is a number",
        ),
    ] {
        assert!(TINY.contains(from), "{from}");
        let study: Study =
            parse_definition(Path::new("test"), &TINY.replace(from, to)).expect("RON");
        let refusal = study.check().expect_err("refused").to_string();
        assert!(refusal.starts_with(message), "{refusal}");
    }
    for (from, to, message) in [
        (
            "\"strategy\": \"cma_es\"",
            "\"strategy\": \"poet\"",
            "strategy of search is poet; allowed: strategies whose",
        ),
        (
            "\"strategy\": \"cma_es\"",
            "\"ga.step\": 0.5",
            "evolution.ga.step of search is 0.5; allowed: no value",
        ),
        (
            "\"evolution.population\": 6",
            "\"soft_parts\": 2, \"evolution.population\": 6",
            "soft_parts is 2; allowed: no value",
        ),
        ("evaluations: 12", "evaluations: 3", "evaluations of search is 3; allowed: 6 to"),
    ] {
        let study = defined(&TINY.replace(from, to));
        let refusal = study.planned().expect_err("refused").to_string();
        assert!(refusal.starts_with(message), "{refusal}");
    }
}

#[test]
fn methods_are_crossed_in_the_order_in_which_they_are_named() {
    let text = "(name: \"m\", title: \"M\", methods: (strategies: [random, ga], controllers: [gait, wave]))";
    let names: Vec<String> = defined(text).arms.into_iter().map(|arm| arm.name).collect();
    assert_eq!(names, ["random-gait", "random-wave", "ga-gait", "ga-wave"]);
    let all = defined("(name: \"m\", title: \"M\", methods: ())");
    let evolves_stairs =
        |arm: &Arm| arm.method.is_some_and(|(strategy, _)| strategy.info().evolves_stairs);
    assert!(all.arms.len() > 20 && !all.arms.iter().any(evolves_stairs));
    let mut one: Study =
        parse_definition(Path::new("test"), &text.replace("random, ga", "q_learning"))
            .expect("RON");
    let refusal = one.set_methods().expect_err("refused").to_string();
    assert!(
        refusal.starts_with("controllers is gait,wave; allowed: a list with one of "),
        "{refusal}"
    );
}

#[test]
fn r7_methods_without_the_baseline_of_the_study_are_compared_with_the_first() {
    let chosen = |strategies: Vec<StrategyKind>| {
        let mut study = Study::load("methods").expect("built in");
        study.methods = study.methods.map(|methods| Methods { strategies, ..methods });
        study.set_methods().expect("allowed");
        study.forget_lacking_baseline();
        study.check().expect("its baseline is one of its arms");
        let last = study.arms.last().expect("an arm");
        study.baseline_of(last).map(|arm| arm.name.clone())
    };
    assert_eq!(chosen(vec![StrategyKind::Ga, StrategyKind::CmaEs]).as_deref(), Some("ga-signal"));
    let with_random = vec![StrategyKind::Random, StrategyKind::CmaEs];
    assert_eq!(chosen(with_random).as_deref(), Some("random-gait"), "that of the study");
}

/// Values by their names, each with a number for each run. An infinite number stands for a missing one.
type Values<'a> = &'a [(&'a str, &'a [f64])];

/// Makes runs with these values, one for each seed from 1 on.
fn runs(arms: &[(&str, Values<'_>)]) -> StudyRuns {
    let protocol = Protocol {
        preset: "climb".to_owned(),
        settings: String::new(),
        strategy: StrategyKind::CmaEs,
        controller: ControllerKind::Gait,
        fitness: Fitness::Climb,
        budget: 100,
        stops_at_goal: false,
        changed: None,
    };
    let mut runs = StudyRuns::new("test");
    for (arm, values) in arms {
        for seed in 0..values.iter().map(|(_, numbers)| numbers.len()).max().unwrap_or(0) {
            let of_seed = values.iter().filter_map(|(name, numbers)| {
                let number = numbers.get(seed).filter(|number| number.is_finite())?;
                Some(((*name).to_owned(), StudyValue::Number(*number)))
            });
            let run = StudiedRun {
                seed: seed as u64 + 1,
                values: of_seed.collect(),
                curve: Vec::new(),
                run_hash: "0".repeat(16),
            };
            runs.add(arm, &protocol, run);
        }
    }
    runs
}

/// Returns the verdict on a demand on arm `a`, whose baseline is `b`.
fn verdict(demand: &str, runs: &StudyRuns) -> Verdict {
    verdict_of("All", demand, runs)
}

fn verdict_of(examined: &str, demand: &str, runs: &StudyRuns) -> Verdict {
    let study = defined(&format!(
        "(name: \"t\", title: \"T\", seeds: 20, arms: [(name: \"a\", examined: {examined}), (name: \"b\")], baseline: \"b\", \
         demands: [(arms: [\"a\"], {demand})])"
    ));
    let findings = Findings::default();
    let results = Results { study: &study, runs, findings: &findings };
    results.verdict(&study.arms[0], &study.demands[0])
}

#[test]
fn measures_have_the_values_and_words_of_their_definitions() {
    const NEVER: f64 = f64::INFINITY;
    let steps: &[f64] = &[4.0, 6.0, 5.0];
    let climbed = runs(&[("a", &[("steps_climbed", steps), ("landed", &[1.0, 1.0, 0.0, 1.0])])]);
    let landing =
        runs(&[("a", &[("first_landing", &[100.0, 200.0, NEVER]), ("evaluations", &[900.0; 3])])]);
    let exam = runs(&[
        ("a", &[("exam_stairs", &[80.0, 60.0, 70.0, 40.0]), ("exam_lesion", &[30.0, 60.0, 65.0])]),
        ("b", &[("exam_stairs", &[60.0, 60.0, 40.0])]),
    ]);
    for (runs, demand, value, text) in [
        (&climbed, "measure: Median(of: \"steps_climbed\")", 5.0, "5 [4.5 5.5], n = 3"),
        (&climbed, "measure: Share(of: {\"landed\": 1})", 0.75, "3 of 4: 75 % [30 95]"),
        (&landing, "measure: Median(of: \"first_landing\")", 200.0, "200 [150 –], n = 3"),
        (&landing, "measure: Share(of: {\"first_landing\": 1})", 2.0 / 3.0, "2 of 3: 67 % [21 94]"),
        (
            &exam,
            "measure: Median(of: \"exam_stairs\", less: \"exam_lesion\")",
            5.0,
            "5 [2.5 27.5], n = 3",
        ),
        (
            &exam,
            "measure: Difference(of: \"exam_stairs\")",
            20.0,
            "+20 [+10 +25], n = 3: +20 +0 +30",
        ),
        (
            &exam,
            "measure: SignTest(of: \"exam_stairs\")",
            0.5,
            "p = 0.5000: more 2, fewer 0, equal 1",
        ),
        (&exam, "measure: Ratio(of: \"exam_stairs\")", 4.0 / 3.0, "1.33 [1.17 1.54], n = 3"),
        (&exam, "measure: TotalRatio(of: \"exam_stairs\")", 250.0 / 160.0, "250 against 160"),
    ] {
        let measured = verdict(demand, runs).measured.expect(demand);
        assert!((measured.value - value).abs() < 1e-9, "{demand}: {measured:?}");
        assert_eq!(measured.text, text, "{demand}");
    }
    let empty = StudyRuns::new("test");
    let nothing = verdict("measure: Median(of: \"steps_climbed\"), must: 1", &empty);
    assert_eq!((nothing.measured, nothing.meets_must), (None, None));
}

#[test]
fn of_evaluations_and_probabilities_less_is_better_and_a_higher_baseline_has_no_probability() {
    let soon = runs(&[("a", &[("first_landing", &[100.0, 200.0, 300.0])])]);
    let met = |demand: &str, runs: &StudyRuns| verdict(demand, runs).meets_must;
    assert_eq!(met("measure: Median(of: \"first_landing\"), must: 250", &soon), Some(true));
    assert_eq!(met("measure: Median(of: \"first_landing\"), must: 150", &soon), Some(false));
    let (low, high): (&[f64], &[f64]) = (&[1.0; 8], &[2.0; 8]);
    let lower = runs(&[("a", &[("fitness", low)]), ("b", &[("fitness", high)])]);
    let found = verdict("measure: SignTest(of: \"fitness\"), must: 0.01", &lower);
    assert_eq!((found.measured.expect("measured").value, found.meets_must), (1.0, Some(false)));
    let higher = runs(&[("a", &[("fitness", high)]), ("b", &[("fitness", low)])]);
    assert_eq!(met("measure: SignTest(of: \"fitness\"), must: 0.01", &higher), Some(true));
}

#[test]
fn an_upper_bound_is_printed_as_one_for_every_measure() {
    for (measure, bound) in [
        ("Median(of: \"fitness\")", "≤ 2"),
        ("Difference(of: \"fitness\")", "≤ +2"),
        ("Ratio(of: \"fitness\")", "≤ 2 times"),
        ("TotalRatio(of: \"steps_climbed\")", "≤ 2 times"),
    ] {
        let demand = format!("(measure: {measure}, at_most: true, must: 2)");
        let study = defined(&format!(
            "(name: \"t\", title: \"T\", arms: [(name: \"a\")], demands: [{demand}])"
        ));
        assert_eq!(study.demands[0].bound(study.demands[0].must), bound, "{measure}");
    }
}

#[test]
fn shares_of_trials_are_apart_only_if_their_intervals_are() {
    let trials: &[f64] = &[60.0, 60.0, 60.0];
    let of = |a: &[f64], b: &[f64]| {
        let values = |landed: &[f64]| landed.iter().map(|of| of / 0.6).collect::<Vec<_>>();
        let (a, b) = (values(a), values(b));
        let arms: [(&str, Values<'_>); 2] = [
            ("a", &[("exam_held_out", &a), ("exam_held_out_trials", trials)]),
            ("b", &[("exam_held_out", &b), ("exam_held_out_trials", trials)]),
        ];
        let runs = runs(&arms);
        let of = "of: \"exam_held_out\", trials: \"exam_held_out_trials\"";
        ["TotalRatio", "Apart"]
            .map(|measure| verdict(&format!("measure: {measure}({of}), must: 1"), &runs))
    };
    let [ratio, apart] = of(&[44.0; 3], &[22.0; 3]);
    assert_eq!(
        ratio.measured.expect("measured").text,
        "2.00 times; 0.73 [0.66, 0.79] against 0.37 [0.30, 0.44]"
    );
    assert_eq!(apart.meets_must, Some(true));
    assert_eq!(of(&[44.0; 3], &[40.0; 3])[1].meets_must, Some(false));
}

#[test]
fn the_best_champions_are_compared_where_only_they_were_examined() {
    let examined = runs(&[
        ("a", &[("exam_stairs", &[f64::INFINITY, 80.0])]),
        ("b", &[("exam_stairs", &[90.0])]),
    ]);
    let demand = "measure: Difference(of: \"exam_stairs\"), hard: 10";
    let found = verdict_of("Best", demand, &examined);
    assert_eq!(found.measured.expect("measured").text, "-10: 80, b 90");
    assert_eq!((found.meets_must, found.meets_hard), (None, Some(false)));
    assert_eq!(verdict(demand, &examined).measured, None, "no seed in common");
}

#[test]
fn every_line_of_json_has_a_type_and_every_record_as_many_fields() {
    let study = defined(TINY);
    let numbers: &[f64] = &[1.0, 2.0];
    let found =
        runs(&[("search", &[("fitness", numbers)]), ("random", &[("fitness", &[0.5, 3.0])])]);
    let findings = Findings::default();
    let results = Results { study: &study, runs: &found, findings: &findings };
    let folder = tempfile::tempdir().expect("a folder");
    let lines = json_lines(&results, &StudyFiles::within(folder.path(), &study));
    let types: Vec<&str> =
        lines.iter().map(|line| line["type"].as_str().expect("a type")).collect();
    for (kind, count) in [("run", 4), ("arm", 2), ("comparison", 1), ("demand", 1), ("done", 1)] {
        assert_eq!(types.iter().filter(|of| **of == kind).count(), count, "{types:?}");
    }
    let compared = lines.iter().find(|line| line["type"] == "comparison").expect("one");
    assert_eq!((&compared["arm"], &compared["baseline"]), (&"search".into(), &"random".into()));
    assert_eq!(compared["superiority"], 0.5);
    for records in [super::records::run_records(&results), super::records::result_records(&results)]
    {
        assert!(records.len() > 3 && records.iter().all(|record| record.len() == records[0].len()));
    }
    assert!(picture(&results).expect("drawn").width > 0);
}
