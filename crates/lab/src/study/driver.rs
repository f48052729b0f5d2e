//! The driver of a study: makes missing runs and exams, and writes the files of the results.

use std::path::{Path, PathBuf};

use super::definition::{Arm, Examined, Study};
use super::figure::study_figure;
use super::findings::Findings;
use super::records::{result_records, run_records};
use super::results::Results;
use super::run::{FinishedRun, PlannedRun};
use super::values::{add_exam, add_judged, of_judge, of_suite};
use crate::export::mjcf;
use crate::plot;
use crate::run::exam::{exam_trials, examine};
use crate::run::headless::{HeadlessError, say};
use crate::run::judge::{Court, Judge, judge_trials};
use crate::run::progress_bar::{bar_of, beneath_bar, with_bar};
use crate::run::{Evaluator, RunControl, whole_runs};
use snakes_core::check::{Invalid, within};
use snakes_core::save::{
    MAX_STUDY_RUNS, Picture, SaveError, SavesFolder, StudiedRun, StudyRuns, StudyValue,
    load_champion, load_study, store_champion, store_csv, store_exam, store_picture, store_study,
};
use snakes_core::score::ExamSuite;
use snakes_core::world::WorldPlan;

/// Paths of the files of a study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StudyFiles {
    /// File of the finished runs, from which an interrupted study continues.
    pub ron: PathBuf,
    /// Table with a line for each run.
    pub runs: PathBuf,
    /// Table with a line for each result: values of arms, comparisons, and demands.
    pub results: PathBuf,
    /// Picture of the results.
    pub picture: PathBuf,
    champions: PathBuf,
}

impl StudyFiles {
    /// Returns the paths of a study's files in a folder.
    pub fn within(folder: &Path, study: &Study) -> Self {
        let named = |ending: &str| folder.join(format!("{}{ending}", study.name));
        Self {
            ron: named(".ron"),
            runs: named("-runs.csv"),
            results: named("-results.csv"),
            picture: named(".png"),
            champions: folder.join(&study.name),
        }
    }

    /// Returns the paths of the files that every study writes.
    pub fn all(&self) -> [&Path; 4] {
        [&self.ron, &self.runs, &self.results, &self.picture]
    }

    /// Returns the path of a run's champion, which is written only if champions take an exam.
    pub fn champion(&self, arm: &Arm, seed: u64) -> PathBuf {
        self.champions.join(format!("{}-seed{seed}.ron", arm.name))
    }
}

/// Makes the runs and exams that are missing in the study's files, and writes the results. Each finished run is stored at once.
/// `restarts` repeats all runs of the selected arms.
///
/// # Errors
/// An arm's settings are not allowed, or differ from those of its finished runs; a file cannot be read or written; or `control` was
/// cancelled.
pub fn perform(
    study: &Study,
    files: &StudyFiles,
    restarts: bool,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<(StudyRuns, Findings), HeadlessError> {
    let planned = study.planned()?;
    within("runs", planned.len(), 1..=MAX_STUDY_RUNS).map_err(SaveError::Study)?;
    let keeps_champions = !study.suites.is_empty() || !study.judges.is_empty();
    if keeps_champions {
        SavesFolder::find(Some(&files.champions)).prepare()?;
    }
    let mut finished = earlier_runs(study, &files.ron, &planned, restarts)?;
    let is_done = |planned: &&PlannedRun<'_>| {
        planned.result(&finished).is_some_and(|run| {
            let arm = planned.arm;
            arm.examined == Examined::Never
                || left_suites(study, run).is_empty() && left_judges(study, run).is_empty()
                || run.number("fitness").is_none()
                || files.champion(arm, run.seed).exists()
        })
    };
    // A missing judge is reported before the first run, but results that are complete are printed without it.
    let is_needed = |judge: &&&'static Judge| {
        planned.iter().any(|planned| {
            planned.arm.examined != Examined::Never
                && planned.result(&finished).is_none_or(|run| {
                    run.number("fitness").is_some() && left_judges(study, run).contains(judge)
                })
        })
    };
    let judges = study.judges.iter().filter(is_needed);
    let mut courts = judges.map(|judge| Court::start(judge)).collect::<Result<Vec<_>, _>>()?;
    let left: Vec<&PlannedRun<'_>> = planned.iter().filter(|run| !is_done(run)).collect();
    say(&format!("{}: {} of {} runs left", study.name, left.len(), planned.len()));
    let bar = bar_of(left.iter().map(|run| run.simulations()).sum(), "simulations");
    let work = |index: usize, single: &dyn Evaluator| {
        left[index].make(single, control, &|simulations| bar.inc(simulations))
    };
    let done = |FinishedRun { arm, protocol, run, champion }: FinishedRun<'_>| {
        // The champion is stored first: a run whose champion has no file is made again.
        if let Some(champion) = champion.filter(|_| keeps_champions) {
            store_champion(&files.champion(arm, run.seed), &champion, None)?;
        }
        say(&in_one_line(arm, &run));
        finished.add(&arm.name, &protocol, run);
        // The runs are stored after each run, so that a kill loses no finished run.
        Ok(store_study(&files.ron, &finished)?)
    };
    let result = beneath_bar(&bar, || whole_runs(left.len(), evaluator, control, work, done));
    result.map_err(|error| error.keeping(&files.ron))?;
    let order = |name: &str| study.arms.iter().position(|arm| arm.name == name);
    finished.arms.sort_by_key(|arm| order(&arm.name));
    let examined =
        examine_champions(study, files, &mut finished, evaluator, control).and_then(|()| {
            judge_champions(study, files, &mut finished, &mut courts, evaluator, control)
        });
    store_study(&files.ron, &finished)?;
    examined.map_err(|error| error.keeping(&files.ron))?;
    let findings = Findings::of(study, evaluator, control)?;
    let results = Results { study, runs: &finished, findings: &findings };
    store_csv(&files.runs, &run_records(&results))?;
    store_csv(&files.results, &result_records(&results))?;
    store_picture(&files.picture, &picture(&results)?)?;
    Ok((finished, findings))
}

/// Draws the picture of a study's results.
///
/// # Errors
/// The plotting library failed.
pub fn picture(results: &Results<'_>) -> Result<Picture, HeadlessError> {
    Ok(plot::figure(&study_figure(results))?)
}

/// Returns the finished runs. A restart drops those of the selected arms. Runs of a selected arm under another protocol are
/// refused.
fn earlier_runs(
    study: &Study,
    ron: &Path,
    planned: &[PlannedRun<'_>],
    restarts: bool,
) -> Result<StudyRuns, SaveError> {
    if !ron.exists() || restarts && study.selected.is_empty() {
        return Ok(StudyRuns::new(&study.name));
    }
    let mut finished = load_study(ron)?;
    let refused = |source| SaveError::Invalid { path: ron.to_owned(), source };
    if finished.study != study.name {
        return Err(refused(Invalid::new("study", &finished.study, &study.name)));
    }
    if restarts {
        finished.arms.retain(|arm| !study.selected.contains(&arm.name));
        return Ok(finished);
    }
    for PlannedRun { arm, protocol, .. } in planned {
        let earlier = finished.arm(&arm.name).map(|arm| &arm.protocol);
        if let Some(earlier) = earlier.filter(|earlier| *earlier != protocol) {
            let field = format!("settings of {}", arm.name);
            let allowed = "those of its finished runs; --restart begins its runs again, and --out names another folder";
            return Err(refused(Invalid::new(
                field,
                format!("changed: {}", earlier.difference(protocol)),
                allowed,
            )));
        }
    }
    Ok(finished)
}

/// Returns the suites of the study for which a run has no results.
fn left_suites(study: &Study, run: &StudiedRun) -> Vec<ExamSuite> {
    let is_left = |suite: &ExamSuite| run.number(&of_suite(*suite, "_trials")).is_none();
    study.suites.iter().copied().filter(is_left).collect()
}

/// Examines champions whose results are missing, and adds the results to their runs and to their files.
fn examine_champions(
    study: &Study,
    files: &StudyFiles,
    finished: &mut StudyRuns,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<(), HeadlessError> {
    let seeds = study.seeds();
    for arm in study.selected_arms() {
        let Some(of_arm) = finished.arms.iter_mut().find(|of| of.name == arm.name) else {
            continue;
        };
        let examined = seeds_to_examine(arm, &of_arm.runs, &seeds);
        for run in of_arm.runs.iter_mut().filter(|run| examined.contains(&run.seed)) {
            let left = left_suites(study, run);
            let path = files.champion(arm, run.seed);
            if left.is_empty() {
                continue;
            }
            let loaded = load_champion(&path)?;
            let is_known =
                |suite: &ExamSuite| loaded.exam.iter().any(|known| known.suite == *suite);
            let (known, open): (Vec<ExamSuite>, Vec<ExamSuite>) =
                left.iter().partition(|suite| is_known(suite));
            let mut results = loaded.exam.clone();
            results.retain(|result| known.contains(&result.suite));
            let trials = exam_trials(&loaded.champion, &open);
            if trials > 0 {
                say(&format!("exam of {}, seed {}", arm.name, run.seed));
                let work = || examine(&loaded.champion, &open, evaluator, control);
                let found = with_bar(&bar_of(trials.into(), "trials"), control, work);
                let found = found.map_err(|_| HeadlessError::Cancelled { kept: None })?;
                store_exam(&path, &loaded, &found)?;
                results.extend(found);
            }
            let simulated: u32 = results.iter().map(|result| result.trials + 1).sum();
            add_simulations(run, simulated);
            add_exam(&mut run.values, &results);
        }
    }
    Ok(())
}

/// Adds trials to the number of simulations of a run, if that is known.
fn add_simulations(run: &mut StudiedRun, trials: u32) {
    if let Some(before) = run.number("simulations") {
        let all = StudyValue::Number(before + f64::from(trials));
        run.values.insert("simulations".to_owned(), all);
    }
}

/// Returns the judges of the study for which a run has no results.
fn left_judges(study: &Study, run: &StudiedRun) -> Vec<&'static Judge> {
    let is_left = |judge: &&Judge| run.number(&of_judge(judge, "_trials")).is_none();
    study.judges.iter().copied().filter(is_left).collect()
}

/// Examines champions by the judges whose results are missing, and adds the results to their runs in the study's file, each
/// at once.
fn judge_champions(
    study: &Study,
    files: &StudyFiles,
    finished: &mut StudyRuns,
    courts: &mut [Court],
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<(), HeadlessError> {
    let seeds = study.seeds();
    let model = |plan: &WorldPlan| mjcf("snake", plan, &[]);
    for arm in study.selected_arms() {
        let of_arm = finished.arms.iter().find(|of| of.name == arm.name);
        let examined = of_arm.map(|of| seeds_to_examine(arm, &of.runs, &seeds)).unwrap_or_default();
        for seed in examined {
            let path = files.champion(arm, seed);
            for court in &mut *courts {
                let runs = finished.arms.iter_mut().filter(|of| of.name == arm.name);
                let Some(run) = runs.flat_map(|of| &mut of.runs).find(|run| run.seed == seed)
                else {
                    continue;
                };
                if !left_judges(study, run).contains(&court.judge) {
                    continue;
                }
                say(&format!("{} of {}, seed {seed}", court.judge.title, arm.name));
                let champion = load_champion(&path)?.champion;
                let bar = bar_of(judge_trials().into(), "trials");
                let work = || court.examine(&champion, &model, evaluator, control);
                let result = with_bar(&bar, control, work)?;
                add_simulations(run, judge_trials());
                add_judged(&mut run.values, &result);
                store_study(&files.ron, finished)?;
            }
        }
    }
    Ok(())
}

/// Returns the seeds of the runs of an arm whose champions take the exam.
fn seeds_to_examine(arm: &Arm, runs: &[StudiedRun], seeds: &std::ops::Range<u64>) -> Vec<u64> {
    let runs =
        runs.iter().filter(|run| seeds.contains(&run.seed) && run.number("fitness").is_some());
    let rank = |run: &StudiedRun| {
        ["landed", "steps_climbed", "fitness"].map(|name| run.number(name).unwrap_or(0.0))
    };
    match arm.examined {
        Examined::Never => Vec::new(),
        Examined::All => runs.map(|run| run.seed).collect(),
        Examined::Best => {
            // Of equally good runs the first is chosen.
            let best = runs.reduce(|best, run| if rank(run) > rank(best) { run } else { best });
            best.map(|run| run.seed).into_iter().collect()
        }
    }
}

/// Describes a finished run in a line.
fn in_one_line(arm: &Arm, run: &StudiedRun) -> String {
    let number = |name: &str, digits: usize| {
        run.number(name).map(|value| super::values::number(value, digits))
    };
    let result = match number("fitness", 3) {
        None => "all snakes were disqualified".to_owned(),
        Some(fitness) => {
            let steps = number("steps_climbed", 0).unwrap_or_default();
            let landed = if run.number("landed") == Some(1.0) { ", landed" } else { "" };
            format!("fitness {fitness}, {steps} steps{landed}")
        }
    };
    let first =
        number("first_landing", 0).map_or(String::new(), |of| format!(", first landing {of}"));
    let evaluations = number("evaluations", 0).unwrap_or_default();
    format!("{}  seed {}  {evaluations} evaluations: {result}{first}", arm.name, run.seed)
}
