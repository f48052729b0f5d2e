//! Tasks of the program and their flags.

use std::path::PathBuf;

use clap::ArgMatches;
use clap::parser::ValueSource;
use clap_complete::Shell;

use super::export::ExportArgs;
use super::film::FilmArgs;
use super::flags::{CliCommand, CommandLine, ShownList};
use super::groups::{OutputFlags, RunFlags, ThreadFlags, WindowFlags, WorkerFlags};
use super::robust::ExamArgs;
use super::study::StudyArgs;
use crate::cli::error::CliError;

/// Flags that several commands share. They are empty in commands without them.
#[derive(Debug, Default)]
pub struct Args {
    /// Whether JSON is printed.
    pub json: bool,
    /// Flags of the run.
    pub run: RunFlags,
    /// Flags of the workers that evaluate the run.
    pub workers: WorkerFlags,
    /// Flags of the window.
    #[cfg_attr(not(feature = "studio"), expect(dead_code, reason = "this build has no window"))]
    pub window: WindowFlags,
}

/// A task of the program.
#[derive(Debug)]
pub enum Task {
    /// Open the window, with the champions in these files.
    Window(Vec<PathBuf>),
    /// Evolve in the terminal.
    Run,
    /// Check the champions in these files against their records.
    CheckReplay(Vec<PathBuf>),
    /// Examine champions.
    Exam(ExamArgs),
    /// Perform a study.
    Study(StudyArgs),
    /// Write champions in other formats.
    Export(ExportArgs),
    /// List the presets.
    Presets,
    /// List the settings.
    Settings {
        /// Whether they are printed as Markdown.
        as_markdown: bool,
    },
    /// Print the body of the champion in this file.
    Body(PathBuf),
    /// Compare the bits of this machine with the reference.
    Verify,
    /// Measure the speed of the simulation with the champion in this file, or with newborns.
    Bench(Option<PathBuf>),
    /// Compute for runs on other computers.
    Worker,
    /// List the machines on a server.
    Machines {
        /// Name of a run whose queue is to be removed; `None` to list the machines.
        #[cfg_attr(not(feature = "cluster"), expect(dead_code, reason = "it needs a server"))]
        purge: Option<String>,
    },
    /// Print completions for this shell.
    Completions(Shell),
    /// Print the manual page, or write all pages into this folder.
    Manual(Option<PathBuf>),
}

impl CommandLine {
    /// Returns the task and its flags. `matches` tells which flags are given.
    ///
    /// # Errors
    /// A flag of the window is given without a window, or a flag of the terminal with one.
    pub(super) fn task(self, matches: &ArgMatches) -> Result<(Args, Task), CliError> {
        let Self { no_render, run, workers, output, window, command } = self;
        let Some(command) = command else {
            let json = output.json;
            let args = Args { json, run, workers, window };
            if no_render {
                refuse::<WindowFlags>(matches, "snakes --no-render; leave out --no-render")?;
                return Ok((args, Task::Run));
            }
            refuse::<OutputFlags>(matches, "the studio; add --no-render")?;
            refuse_server(matches, "the studio; add --no-render")?;
            return Ok((args, Task::Window(Vec::new())));
        };
        let matches = matches.subcommand().map_or(matches, |(_, matches)| matches);
        let mut args = Args::default();
        let task = match command {
            CliCommand::Run { run, workers, output } => {
                args = Args { json: output.json, run, workers, ..args };
                Task::Run
            }
            CliCommand::Replay { files, no_render, run, workers, output, window } => {
                if no_render {
                    let words = "snakes replay --no-render; leave out --no-render";
                    refuse::<RunFlags>(matches, words)?;
                    refuse::<WorkerFlags>(matches, words)?;
                    refuse::<WindowFlags>(matches, words)?;
                } else {
                    refuse::<OutputFlags>(matches, "snakes replay; add --no-render")?;
                    refuse_server(matches, "snakes replay")?;
                    refuse_ids(matches, &["from"], "snakes replay")?;
                }
                args = Args { json: output.json, run, workers, window };
                if no_render { Task::CheckReplay(files) } else { Task::Window(files) }
            }
            CliCommand::Exam { exam, workers, output } => {
                args = Args { json: output.json, workers, ..args };
                Task::Exam(exam)
            }
            CliCommand::Study { study, settings, seed, restart, workers, out, output } => {
                let run = RunFlags { settings, seed, restart, out, ..RunFlags::default() };
                args = Args { json: output.json, run, workers, ..args };
                Task::Study(study)
            }
            CliCommand::Export { mut export, output } => {
                args.json = output.json;
                export.film_flag = first_given(matches, &ids_of::<FilmArgs>());
                Task::Export(export)
            }
            CliCommand::Show { what: ShownList::Presets { output } } => {
                args.json = output.json;
                Task::Presets
            }
            CliCommand::Show { what: ShownList::Settings { markdown, settings, output } } => {
                (args.json, args.run.settings) = (output.json, settings);
                Task::Settings { as_markdown: markdown }
            }
            CliCommand::Show { what: ShownList::Body { file, output } } => {
                args.json = output.json;
                Task::Body(file)
            }
            CliCommand::Verify { threads, output } => {
                (args.json, args.workers.threads) = (output.json, threads);
                Task::Verify
            }
            CliCommand::Bench { file, settings, threads, output } => {
                (args.json, args.run.settings) = (output.json, settings);
                args.workers.threads = threads;
                Task::Bench(file)
            }
            CliCommand::Worker { threads, server } => {
                let threads = ThreadFlags { threads, ..ThreadFlags::default() };
                (args.workers.threads, args.workers.nats) = (threads, server.nats);
                args.workers.credentials = server.credentials;
                Task::Worker
            }
            CliCommand::Machines { purge, server, output } => {
                (args.json, args.workers.nats) = (output.json, server.nats);
                args.workers.credentials = server.credentials;
                Task::Machines { purge }
            }
            CliCommand::Completions { shell } => Task::Completions(shell),
            CliCommand::Man { out } => Task::Manual(out),
        };
        Ok((args, task))
    }
}

/// Returns the names of the flags in a group.
fn ids_of<G: clap::Args>() -> Vec<String> {
    let group = G::augment_args(clap::Command::new(""));
    group.get_arguments().map(|flag| flag.get_id().to_string()).collect()
}

/// Returns the first of some flags that is given, as it is written on the command line.
fn first_given(matches: &ArgMatches, ids: &[impl AsRef<str>]) -> Option<String> {
    let mut ids = ids.iter().map(AsRef::as_ref);
    let given = ids.find(|id| matches.value_source(id) == Some(ValueSource::CommandLine));
    given.map(|id: &str| format!("--{}", id.replace('_', "-")))
}

/// Refuses the first given flag of a group. For `words`, see `refuse_ids`.
fn refuse<G: clap::Args>(matches: &ArgMatches, words: &str) -> Result<(), CliError> {
    refuse_ids(matches, &ids_of::<G>(), words)
}

/// Refuses the flags of a server, but not those of threads.
fn refuse_server(matches: &ArgMatches, words: &str) -> Result<(), CliError> {
    refuse_ids(matches, &["nats", "creds", "tls_ca", "expect_workers", "local_threads"], words)
}

/// Refuses the first given flag. `words` name the command, and after a semicolon a remedy.
fn refuse_ids(matches: &ArgMatches, ids: &[impl AsRef<str>], words: &str) -> Result<(), CliError> {
    first_given(matches, ids).map_or(Ok(()), |flag| {
        Err(CliError::Usage(format!("{flag} has no effect with {words} (see snakes --help)")))
    })
}

#[cfg(test)]
mod tests {
    use super::Task;
    use crate::cli::args::Parsed;
    use crate::cli::args::parse::tests::{asked, parsed};

    fn help(words: &str) -> String {
        match parsed(&format!("{words} --help")) {
            Ok(Parsed::Print(help)) => help.split_whitespace().collect::<Vec<_>>().join(" "),
            _ => unreachable!("{words} has help"),
        }
    }

    #[test]
    fn a_flag_without_effect_is_refused_by_its_name() {
        for (words, problem) in [
            (
                "--no-render --theme dark",
                "--theme has no effect with snakes --no-render; leave out",
            ),
            ("--json", "--json has no effect with the studio; add --no-render"),
            ("--nats nats://a", "--nats has no effect with the studio; add --no-render"),
            ("replay a.ron --json", "--json has no effect with snakes replay; add --no-render"),
            ("replay a.ron --from b.ron", "--from has no effect with snakes replay"),
            (
                "replay a.ron --no-render --set physics.steps_per_s=240",
                "--set has no effect with snakes replay --no-render; leave out --no-render",
            ),
            ("run --theme dark", "unexpected argument '--theme' found"),
            ("bench --seed 3", "unexpected argument '--seed' found"),
            ("bench a.ron --preset ice", "the argument '[FILE]' cannot be used with '--preset"),
            ("verify --no-render", "unexpected argument '--no-render' found"),
            (
                "study --expect-workers 2",
                "the following required arguments were not provided: --nats",
            ),
            ("worker", "the following required arguments were not provided: --nats"),
            (
                "exam a.ron --nats nats://a --threads 2",
                "the argument '--nats <URL>' cannot be used with '--threads",
            ),
            (
                "exam a.ron --trials 3 --suite shove",
                "the argument '--trials <N>' cannot be used with",
            ),
            (
                "exam a.ron --off-rise 0.2",
                "the following required arguments were not provided: --trials",
            ),
            ("--json study", "the subcommand 'study' cannot be used with '--json'"),
            ("--resume a --seed 2", "the argument '--resume <DIR>' cannot be used with"),
        ] {
            let message = asked(words).expect_err(words).to_string();
            assert!(message.starts_with(problem) && !message.contains('\n'), "{words}: {message}");
        }
    }

    #[test]
    fn each_command_is_a_task_with_its_flags() {
        let task = |words: &str| asked(words).expect(words);
        assert!(matches!(task("").1, Task::Window(files) if files.is_empty()));
        for words in ["--no-render --seed 7 --nats nats://a", "run --seed 7 --nats nats://a"] {
            let (args, task) = task(words);
            assert!(matches!(task, Task::Run) && args.workers.nats.is_some());
            assert_eq!(args.seed().expect("a number"), 7);
        }
        assert!(matches!(task("replay a.ron b.ron").1, Task::Window(files) if files.len() == 2));
        assert!(matches!(task("replay a.ron --no-render --json").1, Task::CheckReplay(_)));
        assert!(matches!(task("show settings --markdown").1, Task::Settings { as_markdown: true }));
        assert!(matches!(task("worker --nats nats://a --threads 2").1, Task::Worker));
        assert!(matches!(task("bench a.ron --threads 2").1, Task::Bench(Some(_))));
    }

    #[test]
    fn the_help_of_a_command_shows_its_own_flags_only() {
        for (command, own, others) in [
            (
                "bench",
                &["--preset", "--threads", "--json"][..],
                &["--seed", "--nats", "--theme", "--out"][..],
            ),
            ("verify", &["--threads"], &["--preset", "--nats", "--seed"]),
            ("exam", &["--suite", "--nats", "--off-rise"], &["--preset", "--out", "--theme"]),
            (
                "study",
                &["--arms", "--seed", "--nats", "--out"],
                &["--theme", "--resume", "--saves"],
            ),
            ("export", &["--fps", "--theme", "--figures"], &["--preset", "--nats", "--seed"]),
            ("worker", &["--nats", "--creds"], &["--expect-workers", "--json", "--seed"]),
            ("show presets", &["--json"], &["--preset", "--seed"]),
            ("run", &["--seed", "--resume", "--nats"], &["--theme", "--places", "--no-render"]),
        ] {
            let help = help(command);
            let has = |flag: &&&str| help.split(' ').any(|word| word == **flag);
            assert!(own.iter().all(|flag| has(&flag)), "{command}: {help}");
            assert_eq!(others.iter().find(has), None, "{command}: {help}");
        }
        assert!(
            !help("study").contains("with a window") || !help("worker").contains("with a window")
        );
    }
}
