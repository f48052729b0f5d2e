//! The flags of `snakes exam` about trials that vary as the user says.

use snakes_core::score::PerturbationRange;

/// How much the conditions of trials vary.
#[derive(Debug, Default, clap::Args)]
#[command(next_help_heading = "Trials that vary as you say")]
pub struct PerturbationArgs {
    /// Instead of suites, simulate this number of trials that vary at random, and print the share that reaches each step
    #[arg(long, value_name = "N", allow_negative_numbers = true, conflicts_with_all = ["suite", "write"])]
    pub trials: Option<String>,
    /// Seed of these trials [default: 1]
    #[arg(long, value_name = "N", allow_negative_numbers = true, requires = "trials")]
    pub seed: Option<String>,
    /// Maximum relative change of friction: 0.2 is 20 % up or down [default: 0.2]
    #[arg(long, value_name = "SHARE", requires = "trials")]
    off_friction: Option<f32>,
    /// Maximum relative change of the steps' height [default: 0.1]
    #[arg(long, value_name = "SHARE", requires = "trials")]
    off_rise: Option<f32>,
    /// Maximum relative change of the limbs' density [default: 0.1]
    #[arg(long, value_name = "SHARE", requires = "trials")]
    off_density: Option<f32>,
    /// Maximum shift of the start, along and across the stairs, in metres [default: 0.2]
    #[arg(long, value_name = "M", requires = "trials")]
    off_start: Option<f32>,
    /// Maximum turn of the snake at the start, to either side, in degrees [default: 5]
    #[arg(long, value_name = "DEG", requires = "trials")]
    off_turn: Option<f32>,
}

impl From<&PerturbationArgs> for PerturbationRange {
    fn from(args: &PerturbationArgs) -> Self {
        let default = Self::default();
        Self {
            friction: args.off_friction.unwrap_or(default.friction),
            rise: args.off_rise.unwrap_or(default.rise),
            density: args.off_density.unwrap_or(default.density),
            start_m: args.off_start.unwrap_or(default.start_m),
            turn_deg: args.off_turn.unwrap_or(default.turn_deg),
            ..default
        }
    }
}
