//! Every pair of a flag and a task, and the help of each subcommand.

use super::*;
use crate::cli::args::{Parsed, parse};
use clap::CommandFactory;
use std::ffi::OsString;

/// Every task, as words of the command line.
const TASKS: [(Task, &str); 21] = [
    (Window, ""),
    (Run, "--no-render"),
    (ReplayInWindow, "replay a.ron"),
    (CheckReplay, "replay a.ron --no-render"),
    (Bench, "bench"),
    (BenchChampion, "bench a.ron"),
    (Body, "body a.ron"),
    (Study, "study"),
    (Verify, "verify"),
    (Exam, "exam a.ron"),
    (Export, "export a.ron -o a.csv"),
    (Robust, "robust a.ron"),
    (Completions, "completions bash"),
    (Figures, "figures run"),
    (Render, "render a.ron"),
    (Worker, "worker --nats nats://a"),
    (Machines, "machines --nats nats://a"),
    (Manual, "man"),
    (Presets, "presets"),
    (Settings, "settings"),
    (SettingsAsMarkdown, "settings --markdown"),
];

fn parsed(words: &str) -> Result<Box<Args>, String> {
    let arguments = ["snakes"].into_iter().chain(words.split_whitespace());
    match parse(arguments.map(OsString::from)) {
        Ok(Parsed::Run(args)) => Ok(args),
        Ok(Parsed::Print(_)) => unreachable!("no help was asked for"),
        Err(error) => Err(error.to_string()),
    }
}

/// The flag with a value, if it takes one.
fn flag(id: &str) -> String {
    let command = Args::command();
    let argument = command.get_arguments().find(|argument| argument.get_id() == id);
    let takes_value = argument.expect("a flag").get_action().takes_values();
    format!("--{}{}", id.replace('_', "-"), if takes_value { " 1" } else { "" })
}

#[test]
fn every_flag_has_its_tasks() {
    let command = Args::command();
    let mut ids: Vec<&str> =
        command.get_arguments().map(|argument| argument.get_id().as_str()).collect();
    ids.retain(|id| !["help", "version"].contains(id));
    let mut listed: Vec<&str> = FLAGS.iter().map(|(id, _)| *id).collect();
    ids.sort_unstable();
    listed.sort_unstable();
    assert_eq!(listed, ids);
    assert!(FLAGS.iter().all(|(_, tasks)| !tasks.is_empty()));
}

#[test]
fn every_pair_of_a_flag_and_a_task_is_accepted_or_refused_by_name() {
    assert_eq!(TASKS.len(), Task::value_variants().len());
    for (task, words) in TASKS {
        assert_eq!(Task::of(&parsed(words).expect("allowed")), task, "{words}");
        for (id, tasks) in FLAGS {
            if id == "no_render" || (id == "nats" && words.contains("--nats")) {
                continue;
            }
            // Before the subcommand, where all flags are known.
            let is_one = OF_SERVER.contains(&id) && tasks.contains(&task);
            let server = if is_one && !words.contains("--nats") { "--nats nats://a" } else { "" };
            let line = format!("{server} {} {words}", flag(id));
            match parsed(&line) {
                Ok(_) => assert!(tasks.contains(&task), "{line}"),
                Err(message) => {
                    assert!(!tasks.contains(&task), "{line}: {message}");
                    let name = id.replace('_', "-");
                    let start = format!("--{name} has no effect with {}", task.words());
                    assert!(message.starts_with(&start), "{line}: {message}");
                }
            }
        }
    }
}

#[test]
fn flags_of_a_server_are_refused_without_one_and_threads_with_one() {
    for (words, problem) in [
        ("--no-render --expect-workers 2", "--expect-workers has no effect without --nats"),
        ("study --tls-ca a.pem", "--tls-ca has no effect without --nats"),
        ("worker", "snakes worker needs --nats URL"),
        ("machines", "snakes machines needs --nats URL"),
        (
            "exam a.ron --nats nats://a --threads 2",
            "--threads has no effect with --nats; use --local-threads",
        ),
        (
            "--no-render --nats nats://a --evaluator threads",
            "--evaluator has no effect with --nats",
        ),
    ] {
        let message = parsed(words).expect_err("refused");
        assert!(message.starts_with(problem), "{words}: {message}");
    }
    assert!(parsed("worker --nats nats://a --threads 2").is_ok());
}

#[test]
fn no_render_is_refused_where_no_window_opens() {
    for words in ["bench", "verify", "robust a.ron", "study", "presets"] {
        let message = parsed(&format!("{words} --no-render")).expect_err("refused");
        assert!(message.starts_with("--no-render has no effect with snakes"), "{message}");
    }
}

#[test]
fn the_help_of_a_task_lists_exactly_the_flags_that_the_task_accepts() {
    for (subcommand, tasks) in [
        ("study", &[Study][..]),
        ("robust", &[Robust]),
        ("bench", &[Bench]),
        ("verify", &[Verify]),
        ("figures", &[Figures]),
        ("render", &[Render]),
        ("export", &[Export]),
        ("worker", &[Worker]),
        ("machines", &[Machines]),
        ("presets", &[Presets]),
        ("settings", &[Settings, SettingsAsMarkdown]),
        ("replay", &[ReplayInWindow, CheckReplay]),
    ] {
        let arguments = ["snakes", subcommand, "--help"].map(OsString::from);
        let Ok(Parsed::Print(help)) = parse(arguments) else { panic!("{subcommand} has help") };
        for (id, of) in FLAGS.iter().filter(|(id, _)| !["from", "evaluator"].contains(id)) {
            let flag = format!("--{}", id.replace('_', "-"));
            let is_listed = help.split_whitespace().any(|word| word == flag);
            let is_accepted = of.iter().any(|task| tasks.contains(task));
            assert_eq!(is_listed, is_accepted, "{flag} in the help of {subcommand}:\n{help}");
        }
    }
}

#[test]
fn a_flag_of_a_run_is_refused_by_the_check_of_a_replay() {
    let message = parsed("replay a.ron --no-render --set physics.steps_per_s=240");
    assert_eq!(
        message.expect_err("refused"),
        "--set has no effect with snakes replay --no-render; leave out --no-render (see snakes --help)"
    );
}

#[test]
fn the_server_and_the_threads_mean_something_else_to_a_worker() {
    let help = |subcommand: &str| {
        let arguments = ["snakes", subcommand, "--help"].map(OsString::from);
        let Ok(Parsed::Print(help)) = parse(arguments) else { panic!("{subcommand} has help") };
        help.split_whitespace().collect::<Vec<&str>>().join(" ")
    };
    assert!(help("study").contains("Compute on the workers of this NATS server"));
    for (subcommand, flag, text) in OTHER_HELP {
        assert!(help(subcommand).contains(text), "--{flag} of {subcommand}");
        assert!(!help(subcommand).contains("Compute on the workers"), "{subcommand}");
        assert!(!help(subcommand).contains("with a window"), "{subcommand}");
    }
}
