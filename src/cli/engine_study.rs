//! `snakes engine-study`: whether snakes move and learn alike in the two physics engines.

use super::args::{Args, EngineStudyArgs};
use super::error::CliError;
use super::evaluators::evaluator;
use super::output::cancel_on_interrupt;
use super::study::{Study, published_settings};
use snakes_core::check::within;
use snakes_core::save::library::shipped_champions;
use snakes_core::world::PhysicsEngine;
use snakes_lab::run::Cancelled;
use snakes_lab::run::engine_study::{
    EngineFindings, engine_claims, engine_records, kept_in_other, newborn_statistics,
};
use snakes_lab::run::headless::{HeadlessError, say};

/// Seed of the first run unless one is given: no setting was chosen by it or by those after it.
const FIRST_SEED: u64 = 201;
/// Greatest number of newborns.
const MOST_NEWBORNS: u32 = 1_000_000;

/// Makes the runs that the study's file does not have yet, simulates newborns and shipped champions in both engines, and prints
/// the results.
pub fn engine_study(args: &Args, wanted: &EngineStudyArgs) -> Result<(), CliError> {
    let (preset, name) = ("climb", "engine-study");
    // Each arm has its own engine.
    let mut settings = published_settings(preset)?;
    if let Some(duration_s) = args.duration_s()? {
        settings.trial.duration_s = duration_s;
    }
    let EngineStudyArgs { seeds, evaluations, newborns } = *wanted;
    within("--newborns", newborns, 1..=MOST_NEWBORNS)?;
    let study = Study {
        args,
        command: name,
        first_seed: FIRST_SEED,
        seeds,
        evaluations,
        name,
        settings: &settings,
        preset,
    };
    let (files, runs) = study.continued::<PhysicsEngine>(|run| {
        let landing = run.first_on_landing.map_or("never".to_owned(), |number| number.to_string());
        format!("first landing {landing}")
    })?;
    let control = cancel_on_interrupt();
    let evaluator = evaluator(args, name, &files[0])?;
    let cancelled = |Cancelled| CliError::from(HeadlessError::Cancelled { kept: None });
    say(&format!("{newborns} newborns in both engines"));
    let seed = args.seed_or(FIRST_SEED)?;
    let (of_newborns, healthy) =
        newborn_statistics(&settings, seed, newborns, &*evaluator, &control).map_err(cancelled)?;
    let mut findings = EngineFindings {
        newborns: of_newborns,
        healthy: [healthy, newborns as usize],
        shipped: Vec::new(),
    };
    for (name, loaded) in shipped_champions() {
        let kept = kept_in_other(&loaded.champion, &*evaluator, &control).map_err(cancelled)?;
        findings.shipped.extend(kept.map(|kept| (name.to_owned(), kept)));
    }
    study.report(files, &engine_records(&runs), || engine_claims(&runs, &findings))
}
