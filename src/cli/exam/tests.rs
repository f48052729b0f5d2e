//! Tests of the tables of exams, and of the suites that a user names.

use super::*;
use snakes_core::save::shipped_champion;
use snakes_core::score::Endings;

#[test]
fn r10_a_named_suite_that_says_nothing_of_the_champions_is_refused() {
    let champions = [shipped_champion().expect("well formed")];
    let checked = |names: &[&str]| {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        let (suites, _) = asked(&names).expect("suites");
        check_suites(&names, &suites, &champions).map_err(|error| error.to_string())
    };
    assert_eq!(checked(&[]), Ok(()), "usual suites that say nothing are left out");
    assert_eq!(checked(&["stairs", "step-rate"]), Ok(()));
    let message = checked(&["stairs", "lesion"]).expect_err("a gait has no senses");
    let expected = "--suite is lesion; allowed: trials, step-rate, stairs, surprise, shove, held-out, engine for \
                    these champions";
    assert_eq!(message, expected);
}

fn result(suite: ExamSuite, each: &[(&str, f32)]) -> SuiteResult {
    SuiteResult {
        suite,
        trials: 100,
        landed: 97,
        disqualified: 0,
        median_steps: 10.0,
        kept: 0.7,
        each: each.iter().map(|&(label, kept)| (label.to_owned(), kept)).collect(),
        endings: Endings::default(),
    }
}

#[test]
fn the_table_has_a_row_for_each_champion_and_a_column_for_each_step_rate() {
    let suites = [ExamSuite::Trials, ExamSuite::StepRate];
    let results = || {
        let rates = [("60 Hz", 1.0), ("240 Hz", 0.7)];
        vec![result(ExamSuite::Trials, &[]), result(ExamSuite::StepRate, &rates)]
    };
    let text = table(&suites, &["climber", "b"].map(|name| row(name, results(), Vec::new())));
    let expected = "\
| champion |    trials | 60 Hz | 240 Hz |
|:---------|----------:|------:|-------:|
| climber  | 97 of 100 |  1.00 |   0.70 |
| b        | 97 of 100 |  1.00 |   0.70 |
";
    assert_eq!(text, expected);
}

fn row(name: &str, results: Vec<SuiteResult>, judged: Vec<JudgeResult>) -> ExamRow {
    ExamRow { name: name.to_owned(), results, judged }
}

#[test]
fn held_out_stairs_have_an_interval_and_alone_a_column_for_each_class() {
    let classes = [("equal", 0.6), ("irregular", 1.0), ("house", 0.0), ("nosing", 0.2)];
    let result = || SuiteResult { trials: 60, landed: 27, ..result(ExamSuite::HeldOut, &classes) };
    let row = || row("climber", vec![result()], Vec::new());
    let alone = table(&[ExamSuite::HeldOut], &[row()]);
    let last = alone.lines().last().expect("a row");
    for cell in ["27 of 60 (0.33–0.58)", "9 of 15 (0.36–0.80)", "0 of 15 (0.00–0.20)"] {
        assert!(last.contains(cell), "{cell} in {last}");
    }
    let among = table(&[ExamSuite::Trials, ExamSuite::HeldOut], &[row()]);
    assert!(among.contains("27 of 60 (0.33–0.58)") && !among.contains("of 15"), "{among}");
}

#[test]
fn a_judge_adds_columns_and_the_trials_here_are_shown_once() {
    let of = |judge: &'static Judge, there: u32, way: f32| JudgeResult {
        judge,
        trials: 20,
        climbed: [20, there],
        landed: [19, 0],
        way: [1.0, way],
        kept: 0.5,
        endings: [Endings::default(), Endings::default()],
    };
    let [mujoco, ode] = [of(&JUDGES[0], 7, 0.45), of(&JUDGES[1], 9, 0.55)];
    let text = table(&[], &[row("climber", Vec::new(), vec![mujoco, ode])]);
    let expected = "\
| champion | 3 steps here | way here | 3 steps in MuJoCo | way in MuJoCo | kept in MuJoCo | 3 steps in ODE | way in ODE | kept in ODE |
|:---------|-------------:|---------:|------------------:|--------------:|---------------:|---------------:|-----------:|------------:|
| climber  |     20 of 20 |     1.00 |           7 of 20 |          0.45 |           0.50 |        9 of 20 |       0.55 |        0.50 |
";
    assert_eq!(text, expected);
}

#[test]
fn judges_examine_only_if_they_are_named() {
    let asked = |names: &[&str]| {
        let names: Vec<_> = names.iter().map(|name| (*name).to_owned()).collect();
        let (suites, judges) = asked(&names)?;
        Ok((suites, judges.iter().map(|judge| judge.name).collect::<Vec<_>>()))
    };
    assert_eq!(asked(&[]), Ok((ExamSuite::USUAL.to_vec(), vec![])));
    assert_eq!(asked(&["mujoco"]), Ok((Vec::new(), vec!["mujoco"])));
    assert_eq!(asked(&["ode", "shove"]), Ok((vec![ExamSuite::Shove], vec!["ode"])));
    assert_eq!(asked(&["ode", "mujoco"]), Ok((Vec::new(), vec!["mujoco", "ode"])));
    let error: Invalid = asked(&["stars"]).expect_err("unknown");
    assert!(error.to_string().ends_with(", mujoco, ode"), "{error}");
}

#[test]
fn an_unknown_suite_is_refused_with_the_known_ones() {
    let error = suites_named("--suite", &["stars".to_owned()]).expect_err("unknown").to_string();
    assert!(error.contains("\"stars\"") && error.contains("step-rate, stairs"), "{error}");
    let twice = ["shove", "trials", "shove"].map(str::to_owned);
    assert_eq!(
        suites_named("--suite", &twice).expect("known"),
        [ExamSuite::Trials, ExamSuite::Shove]
    );
}
