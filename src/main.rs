//! The `snakes` program: the command line and the window.

mod cli;
#[cfg(feature = "studio")]
mod studio;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run(std::env::args_os())
}
