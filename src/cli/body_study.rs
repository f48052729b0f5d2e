//! `snakes body-study`: whether protection and an archive pay while bodies evolve, and what creatures learn.

use super::args::{Args, BodyStudyArgs};
use super::error::CliError;
use super::study::{FIRST_SEED, Study, published_settings};
use snakes_lab::run::body_study::{Arm, claims, study_records};
use snakes_lab::run::creature_study::{CreatureArm, creature_claims, creature_records};

/// Makes the runs that the study's file does not have yet, and prints the results.
pub fn body_study(args: &Args, wanted: &BodyStudyArgs) -> Result<(), CliError> {
    let (preset, name) =
        if wanted.creatures { ("creatures", "creature-study") } else { ("bodies", "body-study") };
    let mut settings = published_settings(preset)?;
    if let Some(duration_s) = args.duration_s()? {
        settings.trial.duration_s = duration_s;
    }
    let BodyStudyArgs { seeds, evaluations, .. } = *wanted;
    let command = "body-study";
    let first_seed = FIRST_SEED;
    let study =
        Study { args, command, first_seed, seeds, evaluations, name, settings: &settings, preset };
    if wanted.creatures { of_creatures(&study) } else { of_chains(&study) }
}

fn of_chains(study: &Study<'_>) -> Result<(), CliError> {
    let (files, runs) = study.continued::<Arm>(|run| {
        let share = run.share.map_or("–".to_owned(), |share| format!("{share:.3}"));
        format!("share {share}, {} blocks", run.blocks)
    })?;
    study.report(files, &study_records(&runs), || claims(&runs, study.settings))
}

fn of_creatures(study: &Study<'_>) -> Result<(), CliError> {
    let (files, runs) = study.continued::<CreatureArm>(|run| {
        let fitness = run.fitness.map_or("–".to_owned(), |fitness| format!("{fitness:.3}"));
        format!("fitness {fitness}, {} steps, {}", run.steps, run.tree)
    })?;
    study.report(files, &creature_records(&runs), || creature_claims(&runs))
}
