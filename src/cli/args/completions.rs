//! Completions for shells.

use clap::builder::PossibleValuesParser;
use clap::{Command, CommandFactory};
use clap_complete::Shell;

use super::flags::CommandLine;
use snakes_core::save::{THEMES, built_in_stairs_names, shipped_preset_names};
use snakes_core::schema::Choices;
use snakes_core::score::{ExamSuite, Fitness};
use snakes_lab::run::judge::JUDGES;

/// Returns the completions of the program for a shell: its subcommands, the flags of each, and the names that flags take. Because
/// `--preset` offers names, some shells do not complete the path of a preset file for it.
pub fn completions(shell: Shell) -> String {
    let mut command = CommandLine::command();
    for (flag, names) in [
        ("preset", shipped_preset_names()),
        ("stairs", built_in_stairs_names()),
        ("fitness", Fitness::names()),
        ("theme", THEMES.to_vec()),
        ("suite", ExamSuite::names()),
    ] {
        command = with_names(command, flag, &names);
    }
    let judges = JUDGES.iter().map(|judge| judge.name);
    let with_judges: Vec<_> = ExamSuite::names().into_iter().chain(judges).collect();
    command = command.mut_subcommand("exam", |exam| with_names(exam, "suite", &with_judges));
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut command, "snakes", &mut text);
    String::from_utf8_lossy(&text).into_owned()
}

/// Makes these names the completions of a flag, in all commands that have the flag.
fn with_names(command: Command, flag: &str, names: &[&'static str]) -> Command {
    let command = command.mut_subcommands(|subcommand| with_names(subcommand, flag, names));
    command.mut_args(|argument| {
        if argument.get_id() == flag {
            argument
                .value_parser(PossibleValuesParser::new(names.to_vec()))
                .hide_possible_values(true)
        } else {
            argument
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_completed_by_the_flags_that_have_an_effect_in_it() {
        let text = completions(Shell::Fish);
        let of_bench: Vec<&str> = text
            .lines()
            .filter(|line| line.contains("__fish_snakes_using_subcommand bench\""))
            .collect();
        let has = |flag: &str| of_bench.iter().any(|line| line.contains(&format!("-l {flag} ")));
        assert!(has("preset") && has("json"), "{of_bench:#?}");
        let mut names =
            text.lines().filter(|line| line.contains("-l suite ") && line.contains("mujoco"));
        assert!(names.next().is_some_and(|line| line.contains("using_subcommand exam")));
        assert_eq!(names.next(), None, "studies know no judge");
        assert!(!has("seed") && !has("theme") && !has("nats"), "{of_bench:#?}");
    }

    #[test]
    fn every_shell_completes_subcommands_and_names() {
        for shell in [Shell::Bash, Shell::Elvish, Shell::Fish, Shell::PowerShell, Shell::Zsh] {
            let text = completions(shell);
            assert!(text.contains("study") && text.contains("no-render"), "{shell}");
            // Elvish and PowerShell do not complete values.
            if matches!(shell, Shell::Bash | Shell::Fish | Shell::Zsh) {
                assert!(text.contains("trampoline") && text.contains("step-rate"), "{shell}");
            }
        }
    }
}
