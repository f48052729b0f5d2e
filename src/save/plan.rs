//! What run a folder holds: `run.ron`.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::files::{Header, parse, read_text, refuse_link, store_ron};
use super::settings::SettingsV2;
use super::v4::GenomeV4;
use crate::ENGINE_VERSION;
use crate::check::{Invalid, name};
use crate::evolve::{Founder, RunPlan, Settings};

const KIND: &str = "snakes-and-stairs run";
/// Format 2 had no founder.
const FORMAT: u32 = 3;
pub const RUN_FILE: &str = "run.ron";

/// The file that says what run it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RunV2 {
    kind: String,
    format: u32,
    engine: u32,
    preset: String,
    seed: u64,
    settings: SettingsV2,
}

/// The same with a founder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RunV3 {
    kind: String,
    format: u32,
    engine: u32,
    preset: String,
    seed: u64,
    settings: SettingsV2,
    founder: Option<FounderV3>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FounderV3 {
    name: String,
    genome: GenomeV4,
}

impl From<RunV2> for RunV3 {
    fn from(RunV2 { kind, format: _, engine, preset, seed, settings }: RunV2) -> Self {
        Self { kind, format: FORMAT, engine, preset, seed, settings, founder: None }
    }
}

/// Reads what run a folder holds.
///
/// # Errors
/// There is no run in it, it was recorded by another engine, or its file is damaged.
pub fn load_plan(folder: &Path) -> Result<RunPlan, SaveError> {
    let path = folder.join(RUN_FILE);
    if !path.is_symlink() && !path.exists() {
        let source = std::io::Error::other("no run.ron in it; a run's folder is wanted");
        return Err(SaveError::Unreadable { path: folder.to_owned(), source });
    }
    let unreadable = |source| SaveError::Unreadable { path: path.clone(), source };
    refuse_link(&path).map_err(unreadable)?;
    parse_plan(&path, &read_text(&path)?)
}

/// Reads from a text what run it is; `path` is what errors call it.
///
/// # Errors
/// As [`load_plan`], apart from reading.
pub fn parse_plan(path: &Path, text: &str) -> Result<RunPlan, SaveError> {
    let file: RunV3 = match Header::read(path, text, KIND, FORMAT)? {
        1 => {
            let allowed = format!(
                "2 to {FORMAT}; an earlier version began this run, its champions can be replayed"
            );
            let source = Invalid::new("format", 1, allowed);
            return Err(SaveError::Invalid { path: path.to_owned(), source });
        }
        2 => parse::<RunV2>(path, text)?.into(),
        _ => parse(path, text)?,
    };
    plan_of(file).map_err(|source| SaveError::Invalid { path: path.to_owned(), source })
}

fn plan_of(file: RunV3) -> Result<RunPlan, Invalid> {
    let RunV3 { engine, preset, seed, settings, founder, .. } = file;
    let settings = Settings::from(settings);
    check_engine(engine)?;
    name("preset", &preset)?;
    settings.check().map_err(|error| error.inside("settings"))?;
    let plan = RunPlan::new(&preset, seed, settings);
    let Some(FounderV3 { name, genome }) = founder else { return Ok(plan) };
    let founder = Founder::new(&name, genome.into());
    if founder.name() != name {
        let start: String = name.chars().take(60).collect();
        let allowed = "up to 40 letters, digits, spaces and any of - _ . ,";
        return Err(Invalid::new("founder.name", format!("{start:?}"), allowed));
    }
    plan.founded_by(founder)
}

/// Another engine computes other bits: what one began, the other cannot go on with.
pub fn check_engine(engine: u32) -> Result<(), Invalid> {
    if engine == ENGINE_VERSION {
        return Ok(());
    }
    let allowed = format!("{ENGINE_VERSION}; its champions can be replayed, the run cannot go on");
    Err(Invalid::new("engine", engine, allowed))
}

pub fn store_plan(path: &Path, plan: &RunPlan) -> Result<(), SaveError> {
    store_ron(
        path,
        &RunV3 {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            preset: plan.preset.clone(),
            seed: plan.seed,
            settings: plan.settings.clone().into(),
            founder: plan.founder.as_ref().map(|founder| FounderV3 {
                name: founder.name().to_owned(),
                genome: founder.genome().clone().into(),
            }),
        },
    )
}
