//! The state of a search after a generation: `checkpoint-N.ron`.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::files::{Header, numbered, parse, read_bytes, refuse_link, store_ron, text_of};
use super::folder::within_run;
use super::run_name::fingerprint;
use super::same_engine::check_engine;
use crate::check::{Invalid, hash_of, quoted, within};
use crate::engine::{ENGINE_VERSION, Engine, Processors};
use crate::evolve::{
    Front, FrontMember, GenerationRecord, RunPlan, Settings, StrategyState, resume, run_hash,
};
use crate::schema::is_default;

const KIND: &str = "snakes-and-stairs checkpoint";
/// Number of the format. Format 2, which was never released, is not read.
const FORMAT: u32 = 3;
/// Maximum size of a checkpoint, in MiB. The number of the parents' torque points is limited so that checkpoints stay smaller.
const LARGEST_MIB: u64 = 64;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CheckpointV3 {
    kind: String,
    format: u32,
    engine: u32,
    #[serde(default, skip_serializing_if = "is_default")]
    processors: Processors,
    /// Fingerprint of the plan of the checkpoint's run.
    plan: String,
    /// Number of finished generations of the run.
    generation: u32,
    /// Hash over the finished generations, which ties the checkpoint to its log.
    run_hash: String,
    /// State as the strategy wrote it, because only the engine that wrote a checkpoint reads it.
    strategy: StrategyState,
    front: Vec<FrontMember>,
}

/// The state of a search: everything that a run needs to continue.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchState {
    /// State of the strategy.
    pub strategy: StrategyState,
    /// Pareto front of distance and energy.
    pub front: Front,
}

/// Writes the state of a search after a generation.
pub fn store_checkpoint(
    folder: &Path,
    plan: &str,
    generation: u32,
    run_hash: u64,
    knowledge: &SearchState,
) -> Result<(), SaveError> {
    let checkpoint = CheckpointV3 {
        kind: KIND.to_owned(),
        format: FORMAT,
        engine: ENGINE_VERSION,
        processors: Processors::THIS,
        plan: plan.to_owned(),
        generation,
        run_hash: format!("{run_hash:016x}"),
        strategy: knowledge.strategy.clone(),
        front: knowledge.front.members().cloned().collect(),
    };
    store_ron(&within_run(folder, &checkpoint_name(generation))?, &checkpoint)
}

/// Returns the generations of a folder's checkpoints, in no particular order.
pub fn checkpoints(folder: &Path) -> Result<Vec<u32>, SaveError> {
    numbered(folder, "checkpoint-")
}

/// Removes the checkpoints that [`is_kept`] does not keep after `finished` generations.
pub fn remove_old_checkpoints(folder: &Path, finished: u32) {
    // Errors are ignored, because an old checkpoint does no harm.
    for generation in checkpoints(folder).unwrap_or_default() {
        if !is_kept(generation, finished) {
            let _ = fs::remove_file(folder.join(checkpoint_name(generation)));
        }
    }
}

/// Returns whether a checkpoint is kept, so that a long run does not fill the disk: one of the latest two, or of generation 1, 2, 4, 8 and
/// so on. Champions are always kept.
fn is_kept(generation: u32, finished: u32) -> bool {
    let is_latest = generation <= finished && finished - generation < 2;
    is_latest || (generation < finished && generation.is_power_of_two())
}

fn checkpoint_name(generation: u32) -> String {
    format!("checkpoint-{generation}.ron")
}

/// Reads the checkpoint of a generation, which must belong to the finished generations `records`.
pub fn load_checkpoint(
    folder: &Path,
    generation: u32,
    records: &[GenerationRecord],
    plan: &RunPlan,
) -> Result<SearchState, SaveError> {
    let path = folder.join(checkpoint_name(generation));
    refuse_link(&path).map_err(SaveError::unreadable(&path))?;
    let text = text_of(&path, read_bytes(&path, LARGEST_MIB)?)?;
    let (found, found_hash, state) = parse_checkpoint(&path, &text, plan)?;
    let checked = within("generation", found, generation..=generation).and_then(|()| {
        let expected = run_hash(records);
        if found_hash == expected {
            return Ok(());
        }
        let allowed = format!("{expected:016x}, as in its log");
        Err(Invalid::new("run_hash", format!("{found_hash:016x}"), allowed))
    });
    checked.map_err(|source| SaveError::Invalid { path, source })?;
    Ok(state)
}

/// Parses a checkpoint. Returns its generation, the run's hash, and the state of the search.
///
/// # Errors
/// Fails if the checkpoint is damaged or of another engine, or if a genome in it does not fit the settings.
pub fn parse_checkpoint(
    path: &Path,
    text: &str,
    plan: &RunPlan,
) -> Result<(u32, u64, SearchState), SaveError> {
    Header::check(path, text, KIND, FORMAT)?;
    let file: CheckpointV3 = parse(path, text)?;
    let CheckpointV3 {
        engine, processors, plan: of, generation, run_hash, strategy, front, ..
    } = file;
    let read = || {
        let Settings { trial, genome, .. } = &plan.settings;
        let recorded = Engine { version: engine, processors };
        check_engine(recorded, trial.physics.engine, genome.has_creatures())?;
        let expected = fingerprint(plan);
        if of != expected {
            let allowed = format!(
                "{expected}, the fingerprint of the seed and settings in run.ron: one of the files was edited"
            );
            return Err(Invalid::new("plan", quoted(&of), allowed));
        }
        let run_hash = hash_of("run_hash", &run_hash)?;
        // A state is valid if the strategy can resume from it.
        resume(plan, generation, &strategy).map_err(|error| error.inside("strategy"))?;
        let front = read_front(front, plan)?;
        Ok((generation, run_hash, SearchState { strategy, front }))
    };
    read().map_err(SaveError::invalid(path))
}

fn read_front(members: Vec<FrontMember>, plan: &RunPlan) -> Result<Front, Invalid> {
    let mut front = Front::default();
    let trial = &plan.settings.trial;
    for (index, member) in members.into_iter().enumerate() {
        let place = format!("front[{index}]");
        let FrontMember { evaluation, genome, .. } = &member;
        evaluation.check().map_err(|error| error.inside(&place))?;
        trial.check_genome(genome).map_err(|error| error.inside(&place))?;
        let start_y_m = trial.middle_start_y_m(genome);
        front.add(member, start_y_m);
    }
    Ok(front)
}
