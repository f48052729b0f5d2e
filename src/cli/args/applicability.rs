//! Which flags have an effect in which task of the program. A flag without effect is refused.

use clap::parser::ValueSource;
use clap::{ArgMatches, Command, ValueEnum};

use super::flags::{Args, Subcommand};
use crate::cli::error::CliError;

/// A task of the program, chosen by the subcommand and `--no-render`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Task {
    Window,
    Run,
    ReplayInWindow,
    CheckReplay,
    Bench,
    Verify,
    Exam,
    Robust,
    Compare,
    Families,
    Table1,
    Figures,
    Render,
    Worker,
    Machines,
    Presets,
    Settings,
    SettingsAsMarkdown,
}

use Task::{
    Bench, CheckReplay, Compare, Exam, Families, Figures, Machines, Presets, Render,
    ReplayInWindow, Robust, Run, Settings, SettingsAsMarkdown, Table1, Verify, Window, Worker,
};

/// The tasks that compute on other machines.
const SPREAD: &[Task] = &[Run, Exam, Robust, Compare, Families, Table1];
/// These, and the tasks that need a server.
const WITH_SERVER: &[Task] = &[Run, Exam, Robust, Compare, Families, Table1, Worker, Machines];

/// The flags that are not of a single subcommand, each with the tasks in which it has an effect.
const FLAGS: [(&str, &[Task]); 28] = [
    ("no_render", &[Run, CheckReplay]),
    (
        "json",
        &[
            Run,
            CheckReplay,
            Bench,
            Verify,
            Exam,
            Robust,
            Compare,
            Families,
            Table1,
            Machines,
            Presets,
            Settings,
        ],
    ),
    (
        "preset",
        &[Window, Run, ReplayInWindow, Bench, Compare, Table1, Settings, SettingsAsMarkdown],
    ),
    ("seed", &[Window, Run, ReplayInWindow, Robust, Compare, Families]),
    ("population", &[Window, Run, ReplayInWindow, Compare, Table1, Settings, SettingsAsMarkdown]),
    ("generations", &[Window, Run, ReplayInWindow, Table1, Settings, SettingsAsMarkdown]),
    (
        "duration",
        &[
            Window,
            Run,
            ReplayInWindow,
            Bench,
            Compare,
            Families,
            Table1,
            Settings,
            SettingsAsMarkdown,
        ],
    ),
    ("fitness", &[Window, Run, ReplayInWindow, Compare, Table1, Settings, SettingsAsMarkdown]),
    ("set", &[Window, Run, ReplayInWindow, Bench, Compare, Table1, Settings, SettingsAsMarkdown]),
    ("resume", &[Window, Run, ReplayInWindow]),
    ("from", &[Window, Run]),
    ("restart", &[Window, Run, ReplayInWindow, Compare, Families]),
    (
        "threads",
        &[
            Window,
            Run,
            ReplayInWindow,
            Bench,
            Verify,
            Exam,
            Robust,
            Compare,
            Families,
            Table1,
            Worker,
        ],
    ),
    ("nats", WITH_SERVER),
    ("creds", WITH_SERVER),
    ("tls_ca", WITH_SERVER),
    ("expect_workers", SPREAD),
    ("local_threads", SPREAD),
    ("evaluator", &[Window, Run, ReplayInWindow, Verify, Compare, Table1]),
    ("out", &[Window, Run, ReplayInWindow, Compare, Families, Table1, Figures]),
    ("saves", &[Window, Run, ReplayInWindow]),
    ("comparison", &[Window, ReplayInWindow]),
    ("window_size", &[Window, ReplayInWindow]),
    ("theme", &[Window, ReplayInWindow, Render]),
    ("preferences", &[Window, ReplayInWindow]),
    ("present", &[Window, ReplayInWindow]),
    ("places", &[Window, ReplayInWindow]),
    ("exit_after_frames", &[Window, ReplayInWindow]),
];

impl Task {
    fn of(args: &Args) -> Self {
        match &args.command {
            None if args.no_render => Run,
            None => Window,
            Some(Subcommand::Replay { .. }) if args.no_render => CheckReplay,
            Some(Subcommand::Replay { .. }) => ReplayInWindow,
            Some(Subcommand::Bench) => Bench,
            Some(Subcommand::Verify) => Verify,
            Some(Subcommand::Exam { .. }) => Exam,
            Some(Subcommand::Robust { .. }) => Robust,
            Some(Subcommand::Compare(_)) => Compare,
            Some(Subcommand::Families(_)) => Families,
            Some(Subcommand::Table1 { .. }) => Table1,
            Some(Subcommand::Figures { .. }) => Figures,
            Some(Subcommand::Render(_)) => Render,
            Some(Subcommand::Worker) => Worker,
            Some(Subcommand::Machines { .. }) => Machines,
            Some(Subcommand::Presets) => Presets,
            Some(Subcommand::Settings { markdown: false }) => Settings,
            Some(Subcommand::Settings { markdown: true }) => SettingsAsMarkdown,
        }
    }

    /// The command, as it stands in messages.
    fn words(self) -> &'static str {
        match self {
            Window => "the studio",
            Run => "snakes --no-render",
            ReplayInWindow => "snakes replay",
            CheckReplay => "snakes replay --no-render",
            Bench => "snakes bench",
            Verify => "snakes verify",
            Exam => "snakes exam",
            Robust => "snakes robust",
            Compare => "snakes compare",
            Families => "snakes families",
            Table1 => "snakes table1",
            Figures => "snakes figures",
            Render => "snakes render",
            Worker => "snakes worker",
            Machines => "snakes machines",
            Presets => "snakes presets",
            Settings => "snakes settings",
            SettingsAsMarkdown => "snakes settings --markdown",
        }
    }

    /// The same task with `--no-render` if it is without, and the other way round.
    fn other_mode(self) -> Option<(Self, &'static str)> {
        match self {
            Window => Some((Run, "; add --no-render")),
            ReplayInWindow => Some((CheckReplay, "; add --no-render")),
            Run => Some((Window, "; leave out --no-render")),
            CheckReplay => Some((ReplayInWindow, "; leave out --no-render")),
            _ => None,
        }
    }
}

/// Hides the flags that a subcommand refuses from its help.
pub(super) fn without_refused_flags(command: Command) -> Command {
    let flags: Vec<_> =
        command.get_arguments().filter(|flag| flag.is_global_set()).cloned().collect();
    command.mut_subcommands(|subcommand| {
        let start = format!("snakes {}", subcommand.get_name());
        let is_its_own = |task: &&Task| {
            let rest = task.words().strip_prefix(start.as_str());
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
        };
        let tasks: Vec<&Task> = Task::value_variants().iter().filter(is_its_own).collect();
        let is_refused = |flag: &&clap::Arg| {
            let row = FLAGS.iter().find(|(id, _)| *id == flag.get_id().as_str());
            row.is_some_and(|(_, of)| !of.iter().any(|task| tasks.contains(&task)))
        };
        // A subcommand's own definition of a global flag takes the place of the inherited one.
        let hidden = flags.iter().filter(is_refused).map(|flag| flag.clone().hide(true));
        subcommand.args(hidden)
    })
}

/// Refuses the first given flag that has no effect in the task that the arguments name.
pub(super) fn check(matches: &ArgMatches, args: &Args) -> Result<(), CliError> {
    let task = Task::of(args);
    let is_given = |id: &str| matches.value_source(id) == Some(ValueSource::CommandLine);
    let without_effect = FLAGS.iter().find(|(id, tasks)| is_given(id) && !tasks.contains(&task));
    let Some((id, tasks)) = without_effect else { return check_server(task, is_given) };
    let other = task.other_mode().filter(|(other, _)| tasks.contains(other));
    let advice = other.map_or("", |(_, advice)| advice);
    Err(CliError::Usage(format!(
        "--{} has no effect with {}{advice} (see snakes --help)",
        id.replace('_', "-"),
        task.words()
    )))
}

/// Refuses flags that have an effect only with a server, or only without.
fn check_server(task: Task, is_given: impl Fn(&str) -> bool) -> Result<(), CliError> {
    let needs_server = matches!(task, Worker | Machines);
    let name = |id: &str| id.replace('_', "-");
    if !is_given("nats") {
        if needs_server {
            let words = task.words();
            let problem =
                format!("{words} needs --nats URL, the address of a server (see {words} --help)");
            return Err(CliError::Usage(problem));
        }
        let of_server = ["creds", "tls_ca", "expect_workers", "local_threads"];
        let given = of_server.into_iter().find(|id| is_given(id));
        return given.map_or(Ok(()), |id| {
            let problem =
                format!("--{} has no effect without --nats (see snakes --help)", name(id));
            Err(CliError::Usage(problem))
        });
    }
    let of_threads = [("threads", "; use --local-threads"), ("evaluator", "")];
    let given = of_threads.into_iter().find(|(id, _)| !needs_server && is_given(id));
    given.map_or(Ok(()), |(id, advice)| {
        let problem = format!("--{id} has no effect with --nats{advice} (see snakes --help)");
        Err(CliError::Usage(problem))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::args::{Parsed, parse};
    use clap::CommandFactory;
    use std::ffi::OsString;

    /// Every task, as words of the command line.
    const TASKS: [(Task, &str); 18] = [
        (Window, ""),
        (Run, "--no-render"),
        (ReplayInWindow, "replay a.ron"),
        (CheckReplay, "replay a.ron --no-render"),
        (Bench, "bench"),
        (Verify, "verify"),
        (Exam, "exam a.ron"),
        (Robust, "robust a.ron"),
        (Compare, "compare"),
        (Families, "families"),
        (Table1, "table1"),
        (Figures, "figures run"),
        (Render, "render a.ron"),
        (Worker, "worker --nats nats://a"),
        (Machines, "machines --nats nats://a"),
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
                let needs_server = ["creds", "tls_ca", "expect_workers", "local_threads"];
                let is_one = needs_server.contains(&id) && tasks.contains(&task);
                let server =
                    if is_one && !words.contains("--nats") { "--nats nats://a" } else { "" };
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
            ("compare --tls-ca a.pem", "--tls-ca has no effect without --nats"),
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
        for words in ["bench", "verify", "robust a.ron", "compare", "table1", "presets"] {
            let message = parsed(&format!("{words} --no-render")).expect_err("refused");
            assert!(message.starts_with("--no-render has no effect with snakes"), "{message}");
        }
    }

    #[test]
    fn the_help_of_a_task_lists_exactly_the_flags_that_the_task_accepts() {
        for (subcommand, tasks) in [
            ("compare", &[Compare][..]),
            ("families", &[Families]),
            ("robust", &[Robust]),
            ("bench", &[Bench]),
            ("verify", &[Verify]),
            ("table1", &[Table1]),
            ("figures", &[Figures]),
            ("render", &[Render]),
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
}
