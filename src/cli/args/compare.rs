//! The flags of `snakes compare`.

use snakes_core::evolve::StrategyKind;
use snakes_core::genome::ControllerKind;
use snakes_core::schema::Choices;

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
    format!("Strategies: all, or a list of {}", StrategyKind::names().join(", "))
}

fn controllers_help() -> String {
    format!("Controllers: all, or a list of {}", ControllerKind::names().join(", "))
}
