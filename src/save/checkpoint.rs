//! What a strategy knew after a generation: `checkpoint-N.ron`.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::files::{Header, hash_of, numbered, parse, read_bytes, refuse_link, store_ron, text_of};
use super::folder::fingerprint;
use super::plan::check_engine;
use super::v4::{GenomeV4, RecordedV4};
use super::{GenerationRecord, SaveError};
use crate::ENGINE_VERSION;
use crate::check::{Invalid, within};
use crate::evolve::{Front, FrontMember, PointState, RunPlan, StrategyState, resume};

const KIND: &str = "snakes-and-stairs checkpoint";
const FORMAT: u32 = 2;
/// The parents' torque points are bounded so that a checkpoint stays below.
const LARGEST_MIB: u64 = 64;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CheckpointV2 {
    kind: String,
    format: u32,
    engine: u32,
    /// Hash over the plan of the run.
    plan: String,
    /// Generations that were finished.
    generation: u32,
    /// Hash over them: it ties the checkpoint to its log.
    run_hash: String,
    strategy: StrategyV2,
    front: Vec<FrontMemberV2>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
enum StrategyV2 {
    Halving {
        parents: Vec<GenomeV4>,
    },
    /// Checkpoints are of one engine alone, so what a strategy knows stands in them as it is.
    Points(Box<PointState>),
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FrontMemberV2 {
    generation: u32,
    individual: u32,
    recorded: RecordedV4,
    genome: GenomeV4,
}

/// What a run has learned.
#[derive(Debug, Clone, PartialEq)]
pub struct Knowledge {
    /// The strategy.
    pub strategy: StrategyState,
    /// Who is beaten by nobody in distance and energy.
    pub front: Front,
}

/// Writes down what a strategy knows after a generation.
pub fn store_checkpoint(
    folder: &Path,
    plan: &str,
    generation: u32,
    run_hash: u64,
    knowledge: &Knowledge,
) -> Result<(), SaveError> {
    let strategy = match knowledge.strategy.clone() {
        StrategyState::Halving(parents) => {
            StrategyV2::Halving { parents: parents.into_iter().map(Into::into).collect() }
        }
        StrategyState::Points(state) => StrategyV2::Points(state),
    };
    let member = |member: &FrontMember| FrontMemberV2 {
        generation: member.generation,
        individual: member.individual,
        recorded: member.evaluation.into(),
        genome: member.genome.clone().into(),
    };
    let checkpoint = CheckpointV2 {
        kind: KIND.to_owned(),
        format: FORMAT,
        engine: ENGINE_VERSION,
        plan: plan.to_owned(),
        generation,
        run_hash: format!("{run_hash:016x}"),
        strategy,
        front: knowledge.front.members().map(member).collect(),
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
) -> Result<Knowledge, SaveError> {
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
) -> Result<(u32, u64, Knowledge), SaveError> {
    let format = Header::read(path, text, KIND, FORMAT)?;
    within("format", format, FORMAT..=FORMAT)
        .map_err(|source| SaveError::Invalid { path: path.to_owned(), source })?;
    let file: CheckpointV2 = parse(path, text)?;
    let CheckpointV2 { engine, plan: of, generation, run_hash, strategy, front, .. } = file;
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
        let strategy = match strategy {
            StrategyV2::Halving { parents } => {
                StrategyState::Halving(parents.into_iter().map(Into::into).collect())
            }
            StrategyV2::Points(state) => StrategyState::Points(state),
        };
        // Whatever passes here can go on.
        resume(plan, generation, strategy.clone()).map_err(|error| error.inside("strategy"))?;
        let front = read_front(front, plan)?;
        Ok((generation, run_hash, Knowledge { strategy, front }))
    };
    read().map_err(|source| SaveError::Invalid { path: path.to_owned(), source })
}

fn read_front(members: Vec<FrontMemberV2>, plan: &RunPlan) -> Result<Front, Invalid> {
    let mut front = Front::default();
    let trial = &plan.settings.trial;
    for (index, member) in members.into_iter().enumerate() {
        let place = format!("front[{index}]");
        let FrontMemberV2 { generation, individual, recorded, genome } = member;
        let evaluation = recorded.evaluation().map_err(|error| error.inside(&place))?;
        let genome = genome.into();
        trial.check_genome(&genome).map_err(|error| error.inside(&place))?;
        front.add(FrontMember { genome, evaluation, generation, individual }, trial.start_y_m);
    }
    Ok(front)
}

/// Hash over the finished generations.
fn run_hash_of(records: &[GenerationRecord]) -> Result<u64, Invalid> {
    let mut hash = Xxh3Default::new();
    for record in records {
        hash.update(&record.generation_hash()?.to_le_bytes());
    }
    Ok(hash.digest())
}
