//! The flags of `snakes families`.

use super::flags::suite_help;
use snakes_core::schema::Choices;
use snakes_lab::run::families::{DEFAULT_SUITES, Family};

/// The flags of `snakes families`.
#[derive(Debug, clap::Args)]
pub struct FamiliesArgs {
    #[arg(long, value_name = "A,B", default_value = "all", help = families_help())]
    pub families: String,
    /// Number of seeds, starting with --seed
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub seeds: u64,
    /// Evaluations that each run may spend; on mixed stairs each has several simulations
    #[arg(long, value_name = "M", default_value_t = 6000)]
    pub evaluations: u32,
    #[arg(long, value_name = "NAME", help = exam_help())]
    pub suite: Vec<String>,
}

fn families_help() -> String {
    format!("Families: all, or a list of {}", Family::names().join(", "))
}

fn exam_help() -> String {
    let default: Vec<&str> = DEFAULT_SUITES.iter().map(|suite| suite.choice().name).collect();
    suite_help().replace("[default: all]", &format!("[default: {}]", default.join(", ")))
}
