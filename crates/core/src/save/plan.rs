//! The plan of a run as it began: `run.ron`.

use std::io::ErrorKind;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::files::{Header, parse, read_text, refuse_link, store_ron};
use super::same_engine::check_engine;
use crate::check::{Invalid, name, quoted};
use crate::engine::{ENGINE_VERSION, Engine, Processors};
use crate::evolve::{Founder, RunPlan, Settings};
use crate::genome::Genome;
use crate::schema::is_default;

const KIND: &str = "snakes-and-stairs run";
const FORMAT: u32 = 4;
pub const RUN_FILE: &str = "run.ron";

/// Contents of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RunV4 {
    kind: String,
    format: u32,
    engine: u32,
    #[serde(default, skip_serializing_if = "is_default")]
    processors: Processors,
    preset: String,
    seed: u64,
    settings: Settings,
    founder: Option<FounderV4>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FounderV4 {
    name: String,
    genome: Genome,
}

/// Returns whether a folder has a run, be it readable or damaged.
pub fn is_run(folder: &Path) -> bool {
    let plan = folder.join(RUN_FILE).symlink_metadata();
    plan.map_or_else(|error| error.kind() != ErrorKind::NotFound, |_| true)
}

/// Reads the plan of the run in a folder.
///
/// # Errors
/// Fails if the folder has no run, if another engine recorded the run, or if the file is damaged.
pub fn load_plan(folder: &Path) -> Result<RunPlan, SaveError> {
    let path = folder.join(RUN_FILE);
    if !is_run(folder) {
        let source = std::io::Error::other("it contains no run.ron; give a run's folder");
        return Err(SaveError::Unreadable { path: folder.to_owned(), source });
    }
    refuse_link(&path).map_err(SaveError::unreadable(&path))?;
    parse_plan(&path, &read_text(&path)?)
}

/// Parses the plan of a run; errors name the file `path`.
///
/// # Errors
/// Fails as [`load_plan`] does, except for reading the file.
pub fn parse_plan(path: &Path, text: &str) -> Result<RunPlan, SaveError> {
    Header::check(path, text, KIND, FORMAT)?;
    let file: RunV4 = parse(path, text)?;
    plan_of(file).map_err(SaveError::invalid(path))
}

fn plan_of(file: RunV4) -> Result<RunPlan, Invalid> {
    let RunV4 { engine, processors, preset, seed, settings, founder, .. } = file;
    let (recorded, physics) =
        (Engine { version: engine, processors }, settings.trial.physics.engine);
    check_engine(recorded, physics, settings.genome.has_creatures())?;
    name("preset", &preset)?;
    settings.check().map_err(|error| error.inside("settings"))?;
    let plan = RunPlan::new(&preset, seed, settings);
    let Some(FounderV4 { name, genome }) = founder else { return Ok(plan) };
    let founder = Founder::new(&name, genome);
    if founder.name() != name {
        let allowed = "up to 40 letters, digits, spaces and any of - _ . ,";
        return Err(Invalid::new("founder.name", quoted(&name), allowed));
    }
    plan.starting_from(founder)
}

pub fn store_plan(path: &Path, plan: &RunPlan) -> Result<(), SaveError> {
    store_ron(
        path,
        &RunV4 {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            processors: Processors::THIS,
            preset: plan.preset.clone(),
            seed: plan.seed,
            settings: plan.settings.clone(),
            founder: plan.founder.as_ref().map(|founder| FounderV4 {
                name: founder.name().to_owned(),
                genome: founder.genome().clone(),
            }),
        },
    )
}
