//! The flags of `snakes compare`.

use crate::evolve::StrategyKind;
use crate::genome::ControllerKind;

/// The flags of `snakes compare`.
#[derive(Debug, clap::Args)]
pub struct CompareArgs {
    #[arg(long, value_name = "A,B", default_value = "all", help = strategies_help())]
    pub strategies: String,
    #[arg(long, value_name = "X,Y", default_value = "all", help = controllers_help())]
    pub controllers: String,
    /// Number of seeds, starting with --seed
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub seeds: u64,
    /// Evaluations that each run may spend
    #[arg(long, value_name = "M", default_value_t = 3000)]
    pub evaluations: u32,
}

fn strategies_help() -> String {
    let names: Vec<&str> = StrategyKind::ALL.iter().map(|kind| kind.name()).collect();
    format!("Strategies: all, or a list of {}", names.join(", "))
}

fn controllers_help() -> String {
    let names: Vec<&str> = ControllerKind::ALL.iter().map(|kind| kind.name()).collect();
    format!("Controllers: all, or a list of {}", names.join(", "))
}
