//! Loads champions from saves, for the stage or as founders of runs.

use std::path::Path;

use xxhash_rust::xxh3::xxh3_64;

use crate::studio::stage::staged_champion::StagedChampion;
use snakes_core::evolve::Champion;
use snakes_core::save::library::{SavePlace, load_entry};
use snakes_core::save::{LoadedChampion, load_generation};
use snakes_lab::run::names::preset_title;

/// Maximum length of a champion's name on the stage, in characters.
const MAX_LABEL: usize = 40;

/// Returns the champion of an entry, to start a run from it. For a run, this is its best champion, from generation
/// `best` if that is known.
///
/// # Errors
/// The champion cannot be read.
pub fn founder_of(place: &SavePlace, best: Option<u32>) -> Result<Champion, String> {
    load(place, best).map(|(loaded, _)| loaded.champion)
}

/// Loads the champion of an entry, and its generation if the entry is a run. If the best generation is known, the run's
/// log, which may be long, is not read.
fn load(place: &SavePlace, best: Option<u32>) -> Result<(LoadedChampion, Option<u32>), String> {
    let loaded = match (place, best) {
        (SavePlace::Run(run), Some(best)) => load_generation(run, best).map(|it| (it, Some(best))),
        _ => load_entry(place),
    };
    Ok(loaded?)
}

/// Returns the champion of an entry for the stage. For a run, this is its best champion, from generation `best` if that
/// is known. `own_name` is the user's name for the run.
pub fn champion_of(
    place: &SavePlace,
    own_name: Option<&str>,
    best: Option<u32>,
) -> Result<StagedChampion, String> {
    let (loaded, generation) = load(place, best)?;
    let name = match (generation, own_name) {
        (None, _) => place.shown_name(),
        (Some(generation), Some(own)) => format!("{own}, generation {generation}"),
        (Some(generation), None) => {
            let origin = &loaded.champion.origin;
            let (preset, seed) = (preset_title(&origin.preset), origin.seed);
            format!("{preset} {seed}, generation {generation}")
        }
    };
    Ok(shown(&loaded, &name, &format!("{place:?}{generation:?}")))
}

/// Returns the champion of a run's generation for the stage.
pub fn generation_of(run: &Path, generation: u32) -> Result<StagedChampion, String> {
    let loaded = load_generation(run, generation)?;
    let identity = format!("{:?}{:?}", SavePlace::Run(run.to_owned()), Some(generation));
    Ok(shown(&loaded, &format!("Generation {generation}"), &identity))
}

fn shown(loaded: &LoadedChampion, name: &str, identity: &str) -> StagedChampion {
    let mut label: String = name.chars().take(MAX_LABEL).collect();
    if label.len() < name.len() {
        label.push('…');
    }
    StagedChampion::from_library(loaded, xxh3_64(identity.as_bytes()), &label)
}
