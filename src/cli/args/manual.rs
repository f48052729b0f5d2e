//! Manual pages in roff, the language of `man`.

use clap::{Command, CommandFactory};
use clap_mangen::Man;
use clap_mangen::roff::{Roff, roman};

use super::flags::CommandLine;

/// Section about the exit status, at the end of every page.
const EXIT_STATUS: &str = "0: done. 1: failed. 2: used wrongly; the message names the flag, its value and the allowed range.";

/// A manual page.
pub struct ManualPage {
    /// Name of the page's file, such as `snakes-exam.1`.
    pub file: String,
    /// Text of the page, in roff.
    pub text: String,
}

/// Returns the pages of the program and of all subcommands, the program's first.
pub fn manual() -> Vec<ManualPage> {
    let mut command = CommandLine::command()
        .disable_help_subcommand(true)
        .override_usage("snakes [OPTIONS] [COMMAND]")
        .subcommand_help_heading("COMMANDS");
    command.build();
    std::iter::once(&command).chain(command.get_subcommands()).map(page).collect()
}

fn page(command: &Command) -> ManualPage {
    // The page must explain flags that the short help hides, because its synopsis names them.
    let man = Man::new(command.clone().mut_args(|flag| flag.hide_short_help(false)))
        .source(concat!("snakes ", env!("CARGO_PKG_VERSION")))
        .manual("Snakes & Stairs");
    let mut end = Roff::new();
    end.control("SH", ["EXIT STATUS"]).text([roman(EXIT_STATUS)]);
    let mut text = Vec::new();
    // Writing into memory cannot fail.
    let _ = man.render(&mut text);
    let text = String::from_utf8_lossy(&text).into_owned() + &end.render();
    ManualPage { file: man.get_filename(), text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_has_a_page_with_the_flags_that_have_an_effect_in_it() {
        let pages = manual();
        let text_of = |file: &str| {
            &pages.iter().find(|page| page.file == file).expect("there is such a page").text
        };
        assert_eq!(pages[0].file, "snakes.1");
        let commands = CommandLine::command().get_subcommands().count();
        assert_eq!(pages.len(), 1 + commands);
        assert!(text_of("snakes-exam.1").contains("\\-\\-suite"));
        assert!(text_of("snakes-bench.1").contains("\\-\\-preset"));
        assert!(text_of("snakes.1").contains("position and label of every widget"));
        assert!(!text_of("snakes-bench.1").contains("\\-\\-theme"));
        assert!(pages.iter().all(|page| page.text.ends_with("allowed range.\n")));
    }
}
