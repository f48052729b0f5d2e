//! What run a folder holds: `run.ron`.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::files::{Header, parse, read_text, refuse_link, store_ron};
use super::settings::SettingsV2;
use crate::ENGINE_VERSION;
use crate::check::{Invalid, name};
use crate::evolve::{RunPlan, Settings};

const KIND: &str = "snakes-and-stairs run";
const FORMAT: u32 = 2;
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
    if Header::read(path, text, KIND, FORMAT)? != FORMAT {
        let allowed =
            format!("{FORMAT}; an earlier version began this run, its champions can be replayed");
        let source = Invalid::new("format", 1, allowed);
        return Err(SaveError::Invalid { path: path.to_owned(), source });
    }
    let RunV2 { engine, preset, seed, settings, .. } = parse(path, text)?;
    let settings = Settings::from(settings);
    let checked = check_engine(engine)
        .and_then(|()| name("preset", &preset))
        .and_then(|()| settings.check().map_err(|error| error.inside("settings")));
    checked.map_err(|source| SaveError::Invalid { path: path.to_owned(), source })?;
    Ok(RunPlan { preset, seed, settings })
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
        &RunV2 {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            preset: plan.preset.clone(),
            seed: plan.seed,
            settings: plan.settings.clone().into(),
        },
    )
}
