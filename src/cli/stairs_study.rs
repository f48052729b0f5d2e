//! `snakes stairs-study`: how many of the held-out stairs snakes climb that learned on many stairs, or on one.

use super::args::{Args, StairsStudyArgs};
use super::error::CliError;
use super::study::{FIRST_SEED, Study, published_settings};
use snakes_lab::run::stairs_study::{StairsArm, stairs_claims, stairs_records};

/// Makes the runs that the study's file does not have yet, and prints the results.
pub fn stairs_study(args: &Args, wanted: &StairsStudyArgs) -> Result<(), CliError> {
    let (preset, name) = ("generalist", "stairs-study");
    let mut settings = published_settings(preset)?;
    if let Some(duration_s) = args.duration_s()? {
        settings.trial.duration_s = duration_s;
    }
    let StairsStudyArgs { seeds, evaluations } = *wanted;
    let first_seed = FIRST_SEED;
    let study = Study {
        args,
        command: name,
        first_seed,
        seeds,
        evaluations,
        name,
        settings: &settings,
        preset,
    };
    let (files, runs) = study
        .continued::<StairsArm>(|run| format!("{} of 60 held-out stairs", run.climbed_in_all()))?;
    study.report(files, &stairs_records(&runs), || stairs_claims(&runs))
}
