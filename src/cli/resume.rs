//! `--resume DIR`: the run in a folder, or the only run in a folder of runs.

use std::path::Path;

use super::error::CliError;
use super::output::print_line;
use snakes_core::save::{RunSummary, SaveError, SavesFolder, is_run};
use snakes_lab::run::RunSource;

/// Returns the run in `folder`, or the only run in a folder within it. Several runs are listed, one per line, and cause an error; damaged
/// runs count, too.
pub fn run_in(folder: &Path, json: bool) -> Result<RunSource, CliError> {
    let runs = if is_run(folder) { Vec::new() } else { SavesFolder::find(Some(folder)).all_runs() };
    if runs.len() > 1 {
        let mut lines = runs.iter().map(|(folder, run)| match run {
            Ok(run) => line(run, json),
            Err(problem) => line_of_damaged(folder, problem, json),
        });
        lines.try_for_each(|line| print_line(&line))?;
        return Err(CliError::SeveralRuns { folder: folder.to_owned(), count: runs.len() });
    }
    match runs.into_iter().next() {
        // If there is no run, the error of this call names what is missing.
        None => Ok(RunSource::in_folder(folder)?),
        Some((_, run)) => Ok(RunSource::in_folder(&run?.folder)?),
    }
}

/// Describes a run that cannot be read in a line: its folder and the reason.
fn line_of_damaged(folder: &Path, problem: &SaveError, json: bool) -> String {
    if json {
        let line = serde_json::json!({
            "type": "run", "folder": folder, "resumable": false, "problem": problem.to_string(),
        });
        return line.to_string();
    }
    format!("{}  cannot be resumed: {problem}", folder.display())
}

/// Describes a run in a line: its folder, the name that the user gave it, and its state.
fn line(run: &RunSummary, json: bool) -> String {
    let RunSummary { folder, plan, finished, name, .. } = run;
    let is_stopped = run.is_stopped();
    if json {
        let line = serde_json::json!({
            "type": "run", "folder": folder, "name": name, "generations": finished,
            "of": plan.settings.evolution.generations, "resumable": is_stopped,
        });
        return line.to_string();
    }
    let folder = folder.display();
    let name = name.as_ref().map(|name| format!("  \"{name}\"")).unwrap_or_default();
    let state = if is_stopped { "can be resumed" } else { "finished" };
    format!("{folder}{name}  {}, {state}", run.generations_in_words())
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::evolve::{RunPlan, Settings};
    use snakes_core::save::library::{SavePlace, rename};
    use snakes_core::save::{ExistingRun, load_preset};
    use std::path::PathBuf;

    fn climb() -> Settings {
        load_preset("climb").expect("shipped").settings
    }

    /// Adds a run without finished generations, and returns its folder.
    fn add_run(saves: &SavesFolder, seed: u64) -> PathBuf {
        let plan = RunPlan::new("climb", seed, climb());
        let folder = saves.of_run(&plan);
        RunSource::in_saves(saves, plan, ExistingRun::Keep).open("a test").expect("opened");
        folder
    }

    #[test]
    fn a_folder_that_holds_one_run_stands_for_it_and_several_runs_are_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        let missing = run_in(folder.path(), false).expect_err("no run").to_string();
        assert!(missing.contains("it contains no run.ron"), "{missing}");
        let only = add_run(&saves, 1);
        for given in [folder.path(), &only] {
            let found = run_in(given, false).expect("one run");
            assert_eq!(found, RunSource::in_folder(&only).expect("a run"), "{}", given.display());
        }
        add_run(&saves, 2);
        let refused = run_in(folder.path(), false).expect_err("two runs");
        assert_eq!(refused.exit_code(), 2);
        assert!(refused.to_string().contains("holds 2 runs"), "{refused}");
        assert!(run_in(&only, false).is_ok());
    }

    #[test]
    fn f5_a_damaged_run_is_named_with_its_reason_and_counts() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        let damaged = add_run(&saves, 1);
        std::fs::write(damaged.join("run.ron"), "(").expect("written");
        let reason =
            format!("{}: damaged or incomplete at line 1", damaged.join("run.ron").display());
        for given in [folder.path(), &damaged] {
            let refused = run_in(given, false).expect_err("damaged").to_string();
            assert!(refused.starts_with(&reason), "{refused}");
        }
        add_run(&saves, 2);
        let refused = run_in(folder.path(), true).expect_err("two runs").to_string();
        assert!(refused.contains("holds 2 runs"), "{refused}");
        let runs = saves.all_runs();
        let problems = runs.iter().filter_map(|(of, run)| Some((of, run.as_ref().err()?)));
        let lines: Vec<[String; 2]> = problems
            .map(|(of, problem)| [false, true].map(|json| line_of_damaged(of, problem, json)))
            .collect();
        let [[text, json]] = &lines[..] else { panic!("{lines:?}") };
        assert!(text.contains(&format!("cannot be resumed: {reason}")), "{text}");
        let json: serde_json::Value = serde_json::from_str(json).expect("JSON");
        assert_eq!(json["folder"], damaged.display().to_string());
        assert!(json["problem"].as_str().is_some_and(|text| text.starts_with(&reason)), "{json}");
    }

    #[test]
    fn r1_a_listed_run_has_its_own_name_and_its_state() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        let run = add_run(&saves, 1);
        rename(&SavePlace::Run(run.clone()), "The icy one").expect("renamed");
        let runs = saves.runs();
        let generations = climb().evolution.generations;
        assert_eq!(
            line(&runs[0], false),
            format!(
                "{}  \"The icy one\"  0 of at most {generations} generations, can be resumed",
                run.display()
            )
        );
        let json: serde_json::Value = serde_json::from_str(&line(&runs[0], true)).expect("JSON");
        assert_eq!((&json["name"], &json["resumable"]), (&"The icy one".into(), &true.into()));
    }
}
