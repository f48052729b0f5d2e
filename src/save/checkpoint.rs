//! What a strategy knew after a generation: `checkpoint-N.ron`.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::files::{Header, hash_of, numbered, parse, read_bytes, refuse_link, store_ron, text_of};
use super::folder::fingerprint;
use super::plan::check_engine;
use super::v2::GenomeV2;
use super::{GenerationRecord, SaveError};
use crate::ENGINE_VERSION;
use crate::check::{Invalid, within};
use crate::evolve::{RunPlan, StrategyState};
use crate::genome::Genome;

const KIND: &str = "snakes-and-stairs checkpoint";
const FORMAT: u32 = 1;
/// The parents' torque points are bounded so that a checkpoint stays below.
const LARGEST_MIB: u64 = 64;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CheckpointV1 {
    kind: String,
    format: u32,
    engine: u32,
    /// Hash over the plan of the run.
    plan: String,
    /// Generations that were finished.
    generation: u32,
    /// Hash over them: it ties the checkpoint to its log.
    run_hash: String,
    strategy: StrategyV1,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
enum StrategyV1 {
    Halving { parents: Vec<GenomeV2> },
}

/// Writes down what a strategy knows after a generation.
pub fn store_checkpoint(
    folder: &Path,
    plan: &str,
    generation: u32,
    run_hash: u64,
    state: &StrategyState,
) -> Result<(), SaveError> {
    let StrategyState::Halving { parents } = state.clone();
    let parents = parents.into_iter().map(Into::into).collect();
    let checkpoint = CheckpointV1 {
        kind: KIND.to_owned(),
        format: FORMAT,
        engine: ENGINE_VERSION,
        plan: plan.to_owned(),
        generation,
        run_hash: format!("{run_hash:016x}"),
        strategy: StrategyV1::Halving { parents },
    };
    store_ron(&checkpoint_path(folder, generation), &checkpoint)
}

/// The numbers of a folder's checkpoints, in no order.
pub fn checkpoints(folder: &Path) -> Result<Vec<u32>, SaveError> {
    numbered(folder, "checkpoint-")
}

/// Removes the checkpoints that are not kept when `finished` generations are: see [`is_kept`].
pub fn thin(folder: &Path, finished: u32) {
    // One too many is no harm.
    for generation in checkpoints(folder).unwrap_or_default() {
        if !is_kept(generation, finished) {
            let _ = fs::remove_file(checkpoint_path(folder, generation));
        }
    }
}

/// Checkpoints are thinned so that a long run does not fill the disk: the latest two stay, and of the
/// earlier ones those after a power of two generations (1, 2, 4, 8, ...). Champions always stay.
fn is_kept(generation: u32, finished: u32) -> bool {
    let is_latest = generation <= finished && finished - generation < 2;
    is_latest || (generation < finished && generation.is_power_of_two())
}

fn checkpoint_path(folder: &Path, generation: u32) -> PathBuf {
    folder.join(format!("checkpoint-{generation}.ron"))
}

/// Reads the checkpoint that was written after the generations `records`.
pub fn load_checkpoint(
    folder: &Path,
    generation: u32,
    records: &[GenerationRecord],
    plan: &RunPlan,
) -> Result<StrategyState, SaveError> {
    let path = checkpoint_path(folder, generation);
    let unreadable = |source| SaveError::Unreadable { path: path.clone(), source };
    refuse_link(&path).map_err(unreadable)?;
    let text = text_of(&path, read_bytes(&path, LARGEST_MIB)?)?;
    let (found, run_hash, state) = parse_checkpoint(&path, &text, plan)?;
    let checked = within("generation", found, generation..=generation).and_then(|()| {
        let expected = run_hash_of(records)?;
        if run_hash == expected {
            return Ok(());
        }
        let allowed = format!("{expected:016x}, as its log has it");
        Err(Invalid::new("run_hash", format!("{run_hash:016x}"), allowed))
    });
    checked.map_err(|source| SaveError::Invalid { path, source })?;
    Ok(state)
}

/// Reads a checkpoint from a text: after which generation, with which hash, what was learned.
///
/// # Errors
/// It is damaged, of another engine, or a genome in it does not fit the settings.
pub fn parse_checkpoint(
    path: &Path,
    text: &str,
    plan: &RunPlan,
) -> Result<(u32, u64, StrategyState), SaveError> {
    Header::read(path, text, KIND, FORMAT)?;
    let file: CheckpointV1 = parse(path, text)?;
    let CheckpointV1 { engine, plan: of, generation, run_hash, strategy, .. } = file;
    let StrategyV1::Halving { parents } = strategy;
    let settings = &plan.settings;
    let read = || {
        check_engine(engine)?;
        let expected = fingerprint(plan);
        if of != expected {
            let of: String = of.chars().take(40).collect();
            let allowed =
                format!("{expected}, for the seed and settings in run.ron: one was edited");
            return Err(Invalid::new("plan", format!("{of:?}"), allowed));
        }
        let run_hash = hash_of("run_hash", &run_hash)?;
        within("parents", parents.len(), 0..=settings.evolution.parents as usize)?;
        let parents: Vec<Genome> = parents.into_iter().map(Into::into).collect();
        for (index, parent) in parents.iter().enumerate() {
            let place = format!("parents[{index}]");
            settings.trial.check_genome(parent).map_err(|error| error.inside(&place))?;
        }
        Ok((generation, run_hash, StrategyState::Halving { parents }))
    };
    read().map_err(|source| SaveError::Invalid { path: path.to_owned(), source })
}

/// Hash over the finished generations.
fn run_hash_of(records: &[GenerationRecord]) -> Result<u64, Invalid> {
    let mut hash = Xxh3Default::new();
    for record in records {
        hash.update(&record.generation_hash()?.to_le_bytes());
    }
    Ok(hash.digest())
}
