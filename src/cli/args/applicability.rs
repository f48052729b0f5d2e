//! Which flags have an effect in which task of the program. A flag without effect is refused.

use clap::builder::Resettable;
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command, ValueEnum};

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
    BenchChampion,
    Body,
    Study,
    Verify,
    Exam,
    Export,
    Robust,
    Completions,
    Manual,
    Figures,
    Render,
    Worker,
    Machines,
    Presets,
    Settings,
    SettingsAsMarkdown,
}

use Task::{
    Bench, BenchChampion, Body, CheckReplay, Completions, Exam, Export, Figures, Machines, Manual,
    Presets, Render, ReplayInWindow, Robust, Run, Settings, SettingsAsMarkdown, Study, Verify,
    Window, Worker,
};

/// The tasks that compute on other machines.
const SPREAD: &[Task] = &[Run, Exam, Robust, Study];
/// These, and the tasks that need a server.
const WITH_SERVER: &[Task] = &[Run, Exam, Robust, Study, Worker, Machines];

/// The flags that have no effect without `--nats`.
const OF_SERVER: [&str; 4] = ["creds", "tls_ca", "expect_workers", "local_threads"];

/// The help of flags that mean something else in some subcommands: subcommand, flag, help.
const OTHER_HELP: [(&str, &str, &str); 6] = [
    (
        "worker",
        "nats",
        "Address of the NATS server whose runs this computer helps, such as nats://192.168.1.5:4222",
    ),
    ("worker", "threads", "Number of threads that compute [default: all cores]"),
    (
        "man",
        "out",
        "Folder for the manual pages of all commands [default: none, and the program's page is printed]",
    ),
    ("export", "theme", "Colour theme of a film: light or dark [default: light]"),
    ("render", "theme", "Colour theme of the picture: light or dark [default: light]"),
    ("machines", "nats", "Address of the NATS server, such as nats://192.168.1.5:4222"),
];

/// The flags that are not of a single subcommand, each with the tasks in which it has an effect.
const FLAGS: [(&str, &[Task]); 30] = [
    ("no_render", &[Run, CheckReplay]),
    (
        "json",
        &[
            Run,
            CheckReplay,
            Bench,
            BenchChampion,
            Body,
            Verify,
            Exam,
            Export,
            Robust,
            Study,
            Machines,
            Presets,
            Settings,
        ],
    ),
    ("preset", &[Window, Run, ReplayInWindow, Bench, Study, Settings, SettingsAsMarkdown]),
    ("seed", &[Window, Run, ReplayInWindow, Robust, Study]),
    ("population", &[Window, Run, ReplayInWindow, Study, Settings, SettingsAsMarkdown]),
    ("generations", &[Window, Run, ReplayInWindow, Study, Settings, SettingsAsMarkdown]),
    ("duration", &[Window, Run, ReplayInWindow, Bench, Study, Settings, SettingsAsMarkdown]),
    ("fitness", &[Window, Run, ReplayInWindow, Study, Settings, SettingsAsMarkdown]),
    ("stairs", &[Window, Run, ReplayInWindow, Bench, Study, Settings, SettingsAsMarkdown]),
    ("set", &[Window, Run, ReplayInWindow, Bench, Study, Settings, SettingsAsMarkdown]),
    ("resume", &[Window, Run, ReplayInWindow]),
    ("from", &[Window, Run]),
    ("restart", &[Window, Run, ReplayInWindow, Study]),
    (
        "threads",
        &[Window, Run, ReplayInWindow, Bench, BenchChampion, Verify, Exam, Robust, Study, Worker],
    ),
    ("nats", WITH_SERVER),
    ("creds", WITH_SERVER),
    ("tls_ca", WITH_SERVER),
    ("expect_workers", SPREAD),
    ("local_threads", SPREAD),
    ("evaluator", &[Window, Run, ReplayInWindow, Verify, Study]),
    ("out", &[Window, Run, ReplayInWindow, Study, Figures, Manual]),
    ("saves", &[Window, Run, ReplayInWindow]),
    ("comparison", &[Window, ReplayInWindow]),
    ("window_size", &[Window, ReplayInWindow]),
    ("theme", &[Window, ReplayInWindow, Render, Export]),
    ("preferences", &[Window, ReplayInWindow]),
    ("desktop", &[ReplayInWindow]),
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
            Some(Subcommand::Bench { file: None }) => Bench,
            Some(Subcommand::Bench { file: Some(_) }) => BenchChampion,
            Some(Subcommand::Body { .. }) => Body,
            Some(Subcommand::Study(_)) => Study,
            Some(Subcommand::Verify) => Verify,
            Some(Subcommand::Exam { .. }) => Exam,
            Some(Subcommand::Export(_)) => Export,
            Some(Subcommand::Robust { .. }) => Robust,
            Some(Subcommand::Completions { .. }) => Completions,
            Some(Subcommand::Figures { .. }) => Figures,
            Some(Subcommand::Render(_)) => Render,
            Some(Subcommand::Worker) => Worker,
            Some(Subcommand::Machines { .. }) => Machines,
            Some(Subcommand::Man) => Manual,
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
            BenchChampion => "snakes bench FILE",
            Body => "snakes body",
            Study => "snakes study",
            Verify => "snakes verify",
            Exam => "snakes exam",
            Export => "snakes export",
            Robust => "snakes robust",
            Completions => "snakes completions",
            Figures => "snakes figures",
            Render => "snakes render",
            Worker => "snakes worker",
            Machines => "snakes machines",
            Manual => "snakes man",
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

/// Gives each subcommand a help of its own: without the flags that it refuses, and with the meaning that the others have there.
pub(super) fn with_own_help(command: Command) -> Command {
    let flags: Vec<Arg> = global_flags(&command).cloned().collect();
    command.mut_subcommands(|subcommand| {
        let (accepted, refused) = sorted_flags(&subcommand, &flags);
        // A subcommand's own definition of a global flag takes the place of the inherited one.
        let refused = refused.into_iter().map(|flag| flag.hide(true));
        subcommand.args(refused).args(accepted)
    })
}

/// Gives each subcommand exactly the flags that have an effect in it, for completions and manual pages, which cannot hide
/// inherited ones.
pub(super) fn with_own_flags(command: Command) -> Command {
    // The subcommand may lack the flags with which this one conflicts.
    let alone = |flag: &Arg| flag.clone().global(false).conflicts_with(Resettable::Reset);
    let flags: Vec<Arg> = global_flags(&command).map(alone).collect();
    let command = command.mut_args(|flag| flag.global(false));
    command.mut_subcommands(|subcommand| {
        let (accepted, _) = sorted_flags(&subcommand, &flags);
        subcommand.args(accepted)
    })
}

fn global_flags(command: &Command) -> impl Iterator<Item = &Arg> {
    command.get_arguments().filter(|flag| flag.is_global_set())
}

/// The flags that have an effect in a subcommand, with the help that they have there, and those that it refuses.
fn sorted_flags(subcommand: &Command, flags: &[Arg]) -> (Vec<Arg>, Vec<Arg>) {
    let name = subcommand.get_name();
    let start = format!("snakes {name}");
    let is_its_own = |task: &&Task| {
        let rest = task.words().strip_prefix(start.as_str());
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
    };
    let tasks: Vec<&Task> = Task::value_variants().iter().filter(is_its_own).collect();
    let has_effect = |flag: &Arg| {
        let row = FLAGS.iter().find(|(id, _)| *id == flag.get_id().as_str());
        row.is_none_or(|(_, of)| of.iter().any(|task| tasks.contains(&task)))
    };
    let with_its_help = |flag: Arg| {
        let is_it = |(of, id, _): &&(&str, &str, &str)| *of == name && flag.get_id() == *id;
        match OTHER_HELP.iter().find(is_it) {
            Some((_, _, help)) => flag.help(*help),
            None => flag,
        }
    };
    let (accepted, refused): (Vec<Arg>, Vec<Arg>) = flags.iter().cloned().partition(has_effect);
    (accepted.into_iter().map(with_its_help).collect(), refused)
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
        let given = OF_SERVER.into_iter().find(|id| is_given(id));
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
mod tests;
