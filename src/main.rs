//! The `snakes` program: see [`snakes_and_stairs::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    snakes_and_stairs::cli::run(std::env::args_os())
}
