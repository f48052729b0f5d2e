//! Parsing of the command line into flags, or into a text to be printed.

use std::ffi::OsString;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, CommandFactory, FromArgMatches};

use super::flags::CommandLine;
use super::task::{Args, Task};
use crate::cli::error::CliError;
use snakes_core::check::{Invalid, quoted};
use snakes_core::evolve::{Settings, fields};

/// The result of parsing.
pub enum Parsed {
    /// A task and its flags.
    Run(Box<Args>, Box<Task>),
    /// A text to print: help or version.
    Print(String),
}

/// Earlier names of commands, with the commands that replace them.
const EARLIER_NAMES: [(&str, &str); 13] = [
    ("body", "show body"),
    ("body-study", "study bodies"),
    ("compare", "study methods"),
    ("engine-study", "study engines"),
    ("families", "study families"),
    ("figures", "export RUN --figures"),
    ("poet-study", "study poet"),
    ("presets", "show presets"),
    ("render", "export FILES -o PICTURE.png --at SECONDS"),
    ("robust", "exam FILES --trials 100"),
    ("settings", "show settings"),
    ("stairs-study", "study stairs"),
    ("table1", "study table1"),
];

/// Parses the arguments, shortens clap's errors to one line, and refuses flags without effect.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Parsed, CliError> {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    refuse_homes(&arguments)?;
    let parsed = CommandLine::command().try_get_matches_from(&arguments).and_then(|matches| {
        let line = CommandLine::from_arg_matches(&matches)?;
        Ok((line, matches))
    });
    match parsed {
        Ok((line, matches)) => {
            let (args, task) = line.task(&matches)?;
            Ok(Parsed::Run(Box::new(args), Box::new(task)))
        }
        Err(error) => match error.kind() {
            ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
                Ok(Parsed::Print(error.render().to_string()))
            }
            _ => Err(CliError::Usage(one_line(&error, &arguments))),
        },
    }
}

/// Returns the row of [`EARLIER_NAMES`] of the word that the error is about, unless a command stands before it.
fn earlier_name<'e>(
    error: &clap::Error,
    arguments: &[OsString],
) -> Option<&'e (&'static str, &'static str)> {
    let words = [ContextKind::InvalidSubcommand, ContextKind::InvalidArg];
    let named =
        words.into_iter().filter_map(|kind| error.get(kind)).find_map(|word| match word {
            ContextValue::String(word) => EARLIER_NAMES.iter().find(|(earlier, _)| word == earlier),
            _ => None,
        })?;
    let line = CommandLine::command();
    let is_command = |word: &OsString| line.get_subcommands().any(|of| *word == *of.get_name());
    let mut before = arguments.iter().skip(1).take_while(|word| *word != named.0);
    (!before.any(is_command)).then_some(named)
}

/// Refuses paths that begin with `~`, which a shell replaces only at the beginning of a word and without quotes. Otherwise `--out=~/runs`
/// would make a folder that is named `~`.
fn refuse_homes(arguments: &[OsString]) -> Result<(), CliError> {
    for word in arguments.iter().skip(1) {
        let word = word.to_string_lossy();
        let flag = word.split_once('=').filter(|(flag, _)| flag.starts_with('-'));
        let (flag, path) = flag.unwrap_or(("a path", &*word));
        if path == "~" || path.starts_with("~/") {
            let allowed = "a path that the shell has completed: write ~ at the beginning of a word and without quotes, or \
                           ./~ for a file of this name";
            return Err(Invalid::new(flag, quoted(path), allowed).into());
        }
    }
    Ok(())
}

/// Returns the error and its tip, if it has one, as one line.
fn one_line(error: &clap::Error, arguments: &[OsString]) -> String {
    match error.kind() {
        ErrorKind::InvalidUtf8 => {
            let word = arguments.iter().find(|word| word.to_str().is_none());
            let word = word.map(|word| word.to_string_lossy()).unwrap_or_default();
            return Invalid::new("an argument", quoted(&word), "text in UTF-8 here").to_string();
        }
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => return lists_to_show(),
        _ => (),
    }
    if let Some((earlier, now)) = earlier_name(error, arguments) {
        return format!("snakes {earlier} is now: snakes {now}");
    }
    let text = error.render().to_string();
    let mut paragraphs = text.split("\n\n");
    let problem = paragraphs.next().unwrap_or_default();
    let tip = hyphen_tip(error, arguments)
        .or_else(|| setting_tip(error))
        .or_else(|| order_tip(error))
        .or_else(|| paragraphs.find(|text| text.trim().starts_with("tip:")).map(str::to_owned));
    let in_one_line = |text: &str| text.split_whitespace().collect::<Vec<&str>>().join(" ");
    let problem = in_one_line(problem);
    let tip = tip.map(|tip| format!("; {}", in_one_line(&tip))).unwrap_or_default();
    format!("{}{tip} (see snakes --help)", problem.trim_start_matches("error: "))
}

/// Returns the error that `snakes show` needs the name of a list. No other command lacks a part that is not named.
fn lists_to_show() -> String {
    let command = CommandLine::command();
    let show = command.find_subcommand("show");
    let names: Vec<&str> =
        show.into_iter().flat_map(|show| show.get_subcommands().map(Command::get_name)).collect();
    format!("snakes show needs a list; allowed: {} (see snakes show --help)", names.join(", "))
}

/// Returns the tip how to name a file whose name begins with a hyphen, if the argument that was not expected is more than a flag of one
/// letter.
fn hyphen_tip(error: &clap::Error, arguments: &[OsString]) -> Option<String> {
    let flag = error.get(ContextKind::InvalidArg)?.to_string();
    let is_short = flag.starts_with('-') && flag.chars().count() == 2 && flag != "--";
    let is_file = |word: &&OsString| {
        let word = word.to_string_lossy();
        word.starts_with(&flag) && word.len() > flag.len()
    };
    let word = arguments.iter().find(is_file).filter(|_| is_short)?.to_string_lossy();
    (error.kind() == ErrorKind::UnknownArgument)
        .then(|| format!("tip: if {word} is a file, write ./{word}"))
}

/// Returns the tip to use --set if an unknown flag has the name of exactly one setting, with or without its unit.
fn setting_tip(error: &clap::Error) -> Option<String> {
    let flag = error.get(ContextKind::InvalidArg)?.to_string();
    if error.kind() != ErrorKind::UnknownArgument {
        return None;
    }
    let name = flag.trim_start_matches('-').replace('-', "_");
    let settings = fields(&Settings::default());
    // A flag with the name of a quantity does not mean its variation.
    let paths = settings.iter().map(|(path, _)| path).filter(|path| !path.contains(".off."));
    let mut named = paths.filter(|path| {
        let last = path.rsplit('.').next().unwrap_or_default();
        last.strip_prefix(&name).is_some_and(|unit| unit.is_empty() || unit.starts_with('_'))
    });
    let path = named.next()?;
    named.next().is_none().then(|| format!("tip: use --set {path}=VALUE"))
}

/// Returns the tip to write flags after the command if they are written before it.
fn order_tip(error: &clap::Error) -> Option<String> {
    let command = error.get(ContextKind::InvalidSubcommand)?;
    let is_order = error.kind() == ErrorKind::ArgumentConflict;
    is_order.then(|| format!("tip: write flags after the command, as in: snakes {command} --flag"))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Parses a command line that is given without the program's name.
    pub fn parsed(words: &str) -> Result<Parsed, CliError> {
        let arguments = ["snakes"].into_iter().chain(words.split_whitespace());
        parse(arguments.map(OsString::from))
    }

    /// Parses a command line into a task and its flags, or returns the error.
    pub fn asked(words: &str) -> Result<(Args, Task), CliError> {
        match parsed(words)? {
            Parsed::Run(args, task) => Ok((*args, *task)),
            Parsed::Print(_) => unreachable!("no help was asked for"),
        }
    }

    fn refusal(words: &str) -> String {
        asked(words).expect_err("refused").to_string()
    }

    #[test]
    fn an_earlier_name_of_a_command_is_answered_with_the_present_one() {
        assert_eq!(refusal("families --seeds 3"), "snakes families is now: snakes study families");
        assert_eq!(refusal("--json compare"), "snakes compare is now: snakes study methods");
        assert_eq!(refusal("robust a.ron"), "snakes robust is now: snakes exam FILES --trials 100");
        // A value of a flag is no command.
        assert!(asked("--out figures --no-render").is_ok());
        assert!(refusal("run --out figures --polulation 3").contains("--polulation"));
        assert!(!refusal("run families").contains("is now"), "a command stands before it");
    }

    #[test]
    fn an_unknown_flag_gives_one_line_with_the_most_similar_flag() {
        let message = refusal("--polulation 3");
        assert!(message.contains("--polulation") && !message.contains('\n'), "{message}");
        assert!(
            message.contains("found; tip: a similar argument exists: '--population'"),
            "{message}"
        );
    }

    #[test]
    fn s3_a_path_in_which_the_shell_left_a_tilde_is_refused() {
        for (words, flag) in [
            ("run --out=~/runs", "--out"),
            ("export a.ron -o=~/a.csv", "-o"),
            ("exam ~/a.ron", "a path"),
            ("run --out ~", "a path"),
        ] {
            let refusal = refusal(words);
            assert!(refusal.starts_with(&format!("{flag} is \"~")), "{refusal}");
            assert!(refusal.contains("allowed: a path that the shell has completed"), "{refusal}");
        }
        for words in ["exam ./~/a.ron", "exam a~.ron", "export a.ron -o=b~/~.csv", "exam ~a.ron"] {
            assert!(asked(words).is_ok(), "{words}");
        }
    }

    #[test]
    fn s4_a_file_whose_name_begins_with_a_hyphen_gives_the_tip_to_write_its_folder() {
        for (words, name) in [("export a.ron -o -x.csv", "-x.csv"), ("exam -.ron", "-.ron")] {
            let refusal = refusal(words);
            let tip = format!("tip: if {name} is a file, write ./{name} (see");
            assert!(refusal.contains(&tip) && !refusal.contains("--set"), "{refusal}");
        }
        assert!(!refusal("exam -x a.ron").contains("is a file"));
    }

    #[test]
    fn s5_a_list_that_is_not_named_is_asked_for_with_the_names_of_all() {
        let allowed =
            "snakes show needs a list; allowed: presets, settings, body (see snakes show --help)";
        assert_eq!(refusal("show"), allowed);
    }

    #[cfg(unix)]
    #[test]
    fn s6_an_argument_that_is_not_utf_8_is_named() {
        use std::os::unix::ffi::OsStringExt;
        for flag in ["--preset", "--stairs", "--set"] {
            let name = OsString::from_vec(b"ice-\xff.ron".to_vec());
            let words = ["snakes", "run", flag].map(OsString::from);
            let refusal = parse(words.into_iter().chain([name])).err().expect("refused");
            let expected = "an argument is \"ice-\u{fffd}.ron\"; allowed: text in UTF-8 here";
            assert_eq!(refusal.to_string(), expected);
        }
    }

    #[test]
    fn flags_before_a_command_give_the_tip_to_write_them_after_it() {
        let message = refusal("--saves a replay b.ron");
        assert!(message.contains("tip: write flags after the command, as in: snakes replay"));
    }

    #[test]
    fn an_unknown_flag_with_the_name_of_a_setting_gives_the_tip_to_use_set() {
        for (flag, field) in [
            ("--parents", "evolution.halving.parents"),
            ("--points-per-s", "genome.points_per_s"),
            ("--gravity", "trial.physics.gravity_m_s2"),
        ] {
            let message = refusal(&format!("{flag} 3"));
            assert!(message.contains(&format!("'{flag}'")), "{message}");
            assert!(message.contains(&format!("tip: use --set {field}=VALUE")), "{message}");
        }
    }
}
