//! The flags of `snakes exam`.

use std::path::PathBuf;

use snakes_core::schema::Choices;
use snakes_core::score::{ExamSuite, PerturbationRange};
use snakes_lab::run::mujoco::{MUJOCO, MUJOCO_SENTENCE};

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
    #[arg(long, value_name = "SHARE", requires = "trials", default_value_t = PerturbationRange::default().friction)]
    off_friction: f32,
    /// Maximum relative change of the steps' height
    #[arg(long, value_name = "SHARE", requires = "trials", default_value_t = PerturbationRange::default().rise)]
    off_rise: f32,
    /// Maximum relative change of the limbs' density
    #[arg(long, value_name = "SHARE", requires = "trials", default_value_t = PerturbationRange::default().density)]
    off_density: f32,
    /// Maximum shift of the start, along and across the stairs, in metres
    #[arg(long, value_name = "M", requires = "trials", default_value_t = PerturbationRange::default().start_m)]
    off_start: f32,
    /// Maximum turn of the snake at the start, to either side, in degrees
    #[arg(long, value_name = "DEG", requires = "trials", default_value_t = PerturbationRange::default().turn_deg)]
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
            ..Self::default()
        }
    }
}

/// Returns the help of a flag that names suites: every suite of the exam, and the `default` without the flag.
pub(super) fn suite_help(default: &str) -> String {
    let choices = ExamSuite::choices().into_iter();
    let rows: Vec<String> =
        choices.map(|choice| format!("{}: {}", choice.name, choice.sentence)).collect();
    format!("Suite of the exam; may be repeated [default: {default}]. {}", rows.join(" "))
}

/// Returns the help of `--suite` of `snakes exam`, which offers MuJoCo as a further suite.
fn exam_suite_help() -> String {
    format!("{} {MUJOCO}: {MUJOCO_SENTENCE}", suite_help("all but engine and mujoco"))
}
