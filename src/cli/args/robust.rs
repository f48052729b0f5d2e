//! The flags of `snakes robust`.

use crate::score::PerturbationRange;

/// How much the conditions of trials vary.
#[derive(Debug, clap::Args)]
pub struct PerturbationArgs {
    /// Largest change of friction, as a share
    #[arg(long, value_name = "SHARE", default_value_t = PerturbationRange::default().friction)]
    off_friction: f32,
    /// Largest change of the steps' height, as a share
    #[arg(long, value_name = "SHARE", default_value_t = PerturbationRange::default().rise)]
    off_rise: f32,
    /// Largest change of the limbs' density, as a share
    #[arg(long, value_name = "SHARE", default_value_t = PerturbationRange::default().density)]
    off_density: f32,
    /// Largest shift of the start, along and across the stairs, in metres
    #[arg(long, value_name = "M", default_value_t = PerturbationRange::default().start_m)]
    off_start: f32,
    /// Largest turn of the snake at the start, in degrees
    #[arg(long, value_name = "DEG", default_value_t = PerturbationRange::default().turn_deg)]
    off_turn: f32,
}

impl From<&PerturbationArgs> for PerturbationRange {
    fn from(args: &PerturbationArgs) -> Self {
        Self {
            friction: args.off_friction,
            rise: args.off_rise,
            density: args.off_density,
            start_m: args.off_start,
            turn_deg: args.off_turn,
        }
    }
}
