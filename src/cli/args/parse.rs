//! Parsing of the command line into flags, or into a text to be printed.

use std::ffi::OsString;

use clap::error::{ContextKind, ErrorKind};
use clap::{CommandFactory, FromArgMatches};

use super::flags::CommandLine;
use super::task::{Args, Task};
use crate::cli::error::CliError;
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
    // The name of a command comes first, or after flags without values.
    let command = arguments.iter().skip(1).find(|word| !word.to_string_lossy().starts_with('-'));
    let named =
        EARLIER_NAMES.iter().find(|(earlier, _)| command.is_some_and(|word| word == earlier));
    if let Some((earlier, now)) = named {
        return Err(CliError::Usage(format!("snakes {earlier} is now: snakes {now}")));
    }
    let parsed = CommandLine::command().try_get_matches_from(arguments).and_then(|matches| {
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
            _ => Err(CliError::Usage(one_line(&error))),
        },
    }
}

/// Returns the error and its tip, if it has one, as one line.
fn one_line(error: &clap::Error) -> String {
    let text = error.render().to_string();
    let mut paragraphs = text.split("\n\n");
    let problem = paragraphs.next().unwrap_or_default();
    let tip = setting_tip(error)
        .or_else(|| order_tip(error))
        .or_else(|| paragraphs.find(|text| text.trim().starts_with("tip:")).map(str::to_owned));
    let in_one_line = |text: &str| text.split_whitespace().collect::<Vec<&str>>().join(" ");
    let problem = in_one_line(problem);
    let tip = tip.map(|tip| format!("; {}", in_one_line(&tip))).unwrap_or_default();
    format!("{}{tip} (see snakes --help)", problem.trim_start_matches("error: "))
}

/// Returns the tip to use --set if an unknown flag has the name of exactly one setting, with or without its unit.
fn setting_tip(error: &clap::Error) -> Option<String> {
    let flag = error.get(ContextKind::InvalidArg)?.to_string();
    if error.kind() != ErrorKind::UnknownArgument {
        return None;
    }
    let name = flag.trim_start_matches('-').replace('-', "_");
    let settings = fields(&Settings::default());
    let mut named = settings.iter().map(|(path, _)| path).filter(|path| {
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
