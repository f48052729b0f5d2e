//! The flags of `snakes exam`.

use std::path::PathBuf;

use crate::cli::error::of_flag;
use snakes_core::check::Invalid;
use snakes_core::schema::{self, Choices};
use snakes_core::score::{ExamSuite, PerturbationRange};
use snakes_lab::run::judge::JUDGES;

/// The flags of `snakes exam` that no other command has.
#[derive(Debug, clap::Args)]
pub struct ExamArgs {
    /// Saved champions
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    #[arg(long, value_name = "NAME", help = exam_suite_help())]
    pub suite: Vec<String>,
    /// Write the results into the files
    #[arg(long)]
    pub write: bool,
    /// Flags of trials whose ranges the user gives.
    #[command(flatten)]
    pub perturbed: PerturbationArgs,
}

/// Flags for how much the conditions of trials vary.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Trials that vary as you say")]
pub struct PerturbationArgs {
    /// Instead of suites, simulate this number of trials that vary at random, and print the share that reaches each step
    #[arg(long, value_name = "N", allow_negative_numbers = true, conflicts_with_all = ["suite", "write"])]
    pub trials: Option<String>,
    /// Seed of these trials [default: 1]
    #[arg(long, value_name = "N", allow_negative_numbers = true, requires = "trials")]
    pub seed: Option<String>,
    /// Maximum relative change of friction: 0.2 is 20 % up or down
    #[arg(long, value_name = "SHARE", requires = "trials", allow_negative_numbers = true, default_value_t = PerturbationRange::default().friction.to_string())]
    off_friction: String,
    /// Maximum relative change of the steps' height
    #[arg(long, value_name = "SHARE", requires = "trials", allow_negative_numbers = true, default_value_t = PerturbationRange::default().rise.to_string())]
    off_rise: String,
    /// Maximum relative change of the limbs' density
    #[arg(long, value_name = "SHARE", requires = "trials", allow_negative_numbers = true, default_value_t = PerturbationRange::default().density.to_string())]
    off_density: String,
    /// Maximum shift of the start, along and across the stairs, in metres
    #[arg(long, value_name = "M", requires = "trials", allow_negative_numbers = true, default_value_t = PerturbationRange::default().start_m.to_string())]
    off_start: String,
    /// Maximum turn of the snake at the start, to either side, in degrees
    #[arg(long, value_name = "DEG", requires = "trials", allow_negative_numbers = true, default_value_t = PerturbationRange::default().turn_deg.to_string())]
    off_turn: String,
}

impl PerturbationArgs {
    /// Returns how much the conditions of trials vary. The errors name the flags.
    pub fn range(&self) -> Result<PerturbationRange, Invalid> {
        let mut range = PerturbationRange::default();
        for (flag, name, text) in [
            ("--off-friction", "friction", &self.off_friction),
            ("--off-rise", "rise", &self.off_rise),
            ("--off-density", "density", &self.off_density),
            ("--off-start", "start_m", &self.off_start),
            ("--off-turn", "turn_deg", &self.off_turn),
        ] {
            let set = schema::set_text(&mut range, name, text);
            set.and_then(|()| schema::check(&range)).map_err(of_flag(flag))?;
        }
        Ok(range)
    }
}

/// Returns the help of a flag that names suites: every suite of the exam, and the `default` without the flag.
pub(super) fn suite_help(default: &str) -> String {
    let choices = ExamSuite::choices().into_iter();
    let rows: Vec<String> =
        choices.map(|choice| format!("{}: {}", choice.name, choice.sentence)).collect();
    format!("Suite of the exam; may be repeated [default: {default}]. {}", rows.join(" "))
}

/// Returns the help of `--suite` of `snakes exam`, which offers the judges as further suites.
fn exam_suite_help() -> String {
    let mut help = suite_help("all but engine, mujoco and ode");
    JUDGES.iter().for_each(|judge| help += &format!(" {}: {}", judge.name, judge.sentence()));
    help
}
