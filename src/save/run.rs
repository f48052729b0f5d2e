//! A run as a folder: what run it is, a log of its generations, checkpoints, champions.
//!
//! | file | what it holds | written |
//! |---|---|---|
//! | `run.ron` | preset, seed, settings, engine | once, whole |
//! | `generation-N.ron` | the champion of generation N | whole, before the log's line |
//! | `checkpoint-N.ron` | what the strategy knew after generation N | whole, before the log's line |
//! | `log.jsonl` | a line per finished generation | added to; a generation is finished once its line stands |
//! | `evaluations.jsonl` | the evaluations of the generation under way | added to, begun anew with each |
//! | `crashed-N-I.ron` | a genome on which the program failed | whole |
//! | `lock` | who writes into the folder | while somebody does |
//!
//! So a kill at any instant leaves a log whose last whole line has its checkpoint beside it. What is lost
//! is computed again, with the same bits.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use ron::ser::PrettyConfig;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::SaveError;
use super::champion::{load_champion, store_champion};
use super::files::{
    Header, hash_of, parse, prepare_folder, read_bytes, refuse_link, remove_unfinished, text_of,
    write_whole,
};
use super::folder::{champion_file_name, fingerprint};
use super::lock::Lock;
use super::log::{Log, parse_log, read_log_bytes};
use super::settings::SettingsV1;
use super::v2::GenomeV2;
use crate::ENGINE_VERSION;
use crate::check::{Invalid, name, within};
use crate::evolve::{Champion, HalvingSettings, RunPlan, Settings, StrategyState};
use crate::genome::Genome;
use crate::score::{Evaluation, Recording};
use crate::world::Disqualification;

const RUN_KIND: &str = "snakes-and-stairs run";
const RUN_FORMAT: u32 = 1;
const RUN_FILE: &str = "run.ron";
const CHECKPOINT_KIND: &str = "snakes-and-stairs checkpoint";
const CHECKPOINT_FORMAT: u32 = 1;
/// The parents' torque points are bounded so that a checkpoint stays below.
const LARGEST_CHECKPOINT_MIB: u64 = 64;
const LOG_FILE: &str = "log.jsonl";
/// A run keeps so many genomes on which the program failed.
const MOST_CRASHED: usize = 30;
const EVALUATIONS_FILE: &str = "evaluations.jsonl";

/// The file that says what run it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RunV1 {
    kind: String,
    format: u32,
    engine: u32,
    preset: String,
    seed: u64,
    settings: SettingsV1,
}

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

/// A finished generation, as a line of the log.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GenerationRecord {
    /// The first is 1.
    pub generation: u32,
    /// Individuals that were evaluated.
    pub evaluations: u32,
    /// How many of them were disqualified, for whatever reason.
    pub disqualified: u32,
    /// On how many of them the program failed.
    pub crashed: u32,
    /// Fitness statistics over the healthy ones; none if there were none.
    pub statistics: Option<StatisticsRecord>,
    /// Hash over the bits of every evaluation, in 16 hexadecimal digits.
    pub hash: String,
    /// Wall-clock time it took, in seconds.
    pub elapsed_s: f64,
}

/// Fitness statistics of a generation, as in the log.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields are those of run::Statistics, which explains them")]
pub struct StatisticsRecord {
    pub mean: f64,
    pub best: f64,
    pub median: f64,
    pub std: f64,
    pub worst: f64,
    pub mean_centre_y_m: f64,
}

/// An evaluation of the generation under way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct EvaluationRecord {
    /// Hash over the plan of the run.
    plan: String,
    generation: u32,
    individual: u32,
    fitness: f32,
    centre_y_m: f32,
    disqualified: Option<Disqualification>,
    trace_hash: String,
    steps: u32,
}

/// What a run has behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// The finished generations, the first first.
    pub records: Vec<GenerationRecord>,
    /// The champion of each of them; none, if it had none or its file is gone.
    pub champions: Vec<Option<Champion>>,
    /// What the strategy had learned; none before the first generation is finished.
    pub state: Option<StrategyState>,
    /// What is known of the generation under way: individuals and their evaluations.
    pub evaluations: Vec<(u32, Evaluation)>,
}

/// A run's folder, open for writing. Nobody else can open it meanwhile.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    log: Log,
    /// The generation under way, and the evaluations written of it.
    evaluations: Mutex<Option<(u32, Log)>>,
    /// Ties what is written to the plan of the run.
    plan: String,
    _lock: Lock,
}

/// What to do with what a folder already holds of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Earlier {
    /// Go on with it; if it is finished, there is nothing left to do.
    Keep,
    /// Begin anew.
    Discard,
}

impl RunFolder {
    /// Opens the folder of a run, making it if need be. `who` is what others are told who want it too.
    ///
    /// # Errors
    /// Another program writes into the folder; it holds another run; something in it is damaged; it cannot
    /// be written.
    pub fn open(
        path: &Path,
        plan: &RunPlan,
        earlier: Earlier,
        who: &str,
    ) -> Result<(Self, Progress), SaveError> {
        prepare_folder(path)?;
        let lock = Lock::take(path, who)?;
        remove_unfinished(path);
        let file = path.join(RUN_FILE);
        let unreadable = |source| SaveError::Unreadable { path: file.clone(), source };
        refuse_link(&file).map_err(unreadable)?;
        // Whatever stands there, a run that begins anew is what was asked for.
        if file.exists() && earlier == Earlier::Keep {
            let stored = load_plan(path)?;
            if stored != *plan {
                return Err(SaveError::OtherRun { path: path.to_owned() });
            }
        } else {
            store_plan(&file, plan)?;
        }
        let log_path = path.join(LOG_FILE);
        let progress = match earlier {
            Earlier::Keep => Progress::read(path, plan)?,
            Earlier::Discard => Progress::none(),
        };
        let folder = Self {
            path: path.to_owned(),
            log: Log::open(&log_path, progress.records.len())?,
            evaluations: Mutex::new(None),
            plan: fingerprint(plan),
            _lock: lock,
        };
        let next = progress.records.len() as u32 + 1;
        if progress.evaluations.is_empty() {
            // Those of another generation.
            let _ = fs::remove_file(path.join(EVALUATIONS_FILE));
        } else {
            let log = Log::open(&path.join(EVALUATIONS_FILE), progress.evaluations.len())?;
            folder.evaluations_log().replace((next, log));
        }
        folder.thin(progress.records.len() as u32);
        Ok((folder, progress))
    }

    /// The folder's path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file of a generation's champion.
    pub fn champion_path(&self, generation: u32) -> PathBuf {
        self.path.join(champion_file_name(generation))
    }

    /// Notes an evaluation of the generation under way, so that not even that is computed twice. What
    /// cannot be noted is computed again: that is no error.
    pub fn note(&self, generation: u32, individual: u32, evaluation: &Evaluation) {
        let mut log = self.evaluations_log();
        if log.as_ref().is_none_or(|(of, _)| *of != generation) {
            let fresh = Log::open(&self.path.join(EVALUATIONS_FILE), 0);
            *log = fresh.ok().map(|fresh| (generation, fresh));
        }
        if let Some((_, log)) = log.as_mut() {
            let _ = log.append_lightly(&EvaluationRecord {
                plan: self.plan.clone(),
                generation,
                individual,
                fitness: evaluation.fitness,
                centre_y_m: evaluation.centre_y_m,
                disqualified: evaluation.disqualified,
                trace_hash: format!("{:016x}", evaluation.trace_hash),
                steps: evaluation.steps,
            });
        }
    }

    /// Writes a finished generation down. If that fails, it is not finished yet, and may be tried again.
    /// Returns the champion's file.
    ///
    /// # Errors
    /// Something cannot be written.
    pub fn finish_generation(
        &mut self,
        record: &GenerationRecord,
        champion: Option<(&Champion, &Recording)>,
        state: &StrategyState,
        run_hash: u64,
    ) -> Result<Option<PathBuf>, SaveError> {
        let champion_path = self.champion_path(record.generation);
        if let Some((champion, recording)) = champion {
            store_champion(&champion_path, champion, Some(recording))?;
        }
        let StrategyState::Halving { parents } = state.clone();
        let checkpoint = CheckpointV1 {
            kind: CHECKPOINT_KIND.to_owned(),
            format: CHECKPOINT_FORMAT,
            engine: ENGINE_VERSION,
            plan: self.plan.clone(),
            generation: record.generation,
            run_hash: format!("{run_hash:016x}"),
            strategy: StrategyV1::Halving {
                parents: parents.into_iter().map(Into::into).collect(),
            },
        };
        store_ron(&checkpoint_path(&self.path, record.generation), &checkpoint)?;
        self.log.append(record)?;
        // They are in the champion, the checkpoint and the log now.
        self.evaluations_log().take();
        let _ = fs::remove_file(self.path.join(EVALUATIONS_FILE));
        self.thin(record.generation);
        Ok(champion.map(|_| champion_path))
    }

    /// Writes a genome down on which the program failed, to be looked into.
    ///
    /// # Errors
    /// The file cannot be written, or there are enough of them.
    pub fn keep_crashed(&self, crashed: &Champion) -> Result<PathBuf, SaveError> {
        let origin = &crashed.origin;
        let name = format!("crashed-{}-{}.ron", origin.generation, origin.individual);
        let unwritable = |source| SaveError::Unwritable { path: self.path.clone(), source };
        let entries = fs::read_dir(&self.path).map_err(unwritable)?.flatten();
        let is_crash = |name: &OsStr| name.to_string_lossy().starts_with("crashed-");
        if entries.filter(|entry| is_crash(&entry.file_name())).count() >= MOST_CRASHED {
            let enough = format!("{MOST_CRASHED} crashed genomes are enough");
            return Err(unwritable(std::io::Error::other(enough)));
        }
        let path = self.path.join(name);
        store_champion(&path, crashed, None)?;
        Ok(path)
    }

    /// Removes the checkpoints that are not kept when `finished` generations are: see [`is_kept`].
    fn thin(&self, finished: u32) {
        // One too many is no harm.
        for generation in checkpoints(&self.path).unwrap_or_default() {
            if !is_kept(generation, finished) {
                let _ = fs::remove_file(checkpoint_path(&self.path, generation));
            }
        }
    }

    fn evaluations_log(&self) -> std::sync::MutexGuard<'_, Option<(u32, Log)>> {
        self.evaluations.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Checkpoints are thinned so that a long run does not fill the disk: the latest two stay, and of the
/// earlier ones those after a power of two generations (1, 2, 4, 8, ...). Champions always stay.
fn is_kept(generation: u32, finished: u32) -> bool {
    let is_latest = generation <= finished && finished - generation < 2;
    is_latest || (generation < finished && generation.is_power_of_two())
}

impl Progress {
    fn none() -> Self {
        Self { records: Vec::new(), champions: Vec::new(), state: None, evaluations: Vec::new() }
    }

    /// Reads what a folder has of a run.
    fn read(folder: &Path, plan: &RunPlan) -> Result<Self, SaveError> {
        let mut records = read_records(folder, &plan.settings)?;
        let known = checkpoints(folder)?;
        let latest = known.into_iter().filter(|&of| of as usize <= records.len()).max();
        records.truncate(latest.unwrap_or(0) as usize);
        let state = latest.map(|of| load_checkpoint(folder, of, &records, plan));
        let champion = |record: &GenerationRecord| {
            let path = folder.join(champion_file_name(record.generation));
            let unreadable = |source| SaveError::Unreadable { path: path.clone(), source };
            refuse_link(&path).map_err(unreadable)?;
            if record.statistics.is_none() || !path.exists() {
                return Ok(None);
            }
            Ok(Some(load_champion(&path)?.champion))
        };
        Ok(Self {
            state: state.transpose()?,
            champions: records.iter().map(champion).collect::<Result<_, _>>()?,
            evaluations: read_evaluations(folder, records.len() as u32 + 1, plan)?,
            records,
        })
    }
}

/// Reads what run a folder holds.
///
/// # Errors
/// There is no run in it, it was recorded by another engine, or its file is damaged.
pub fn load_plan(folder: &Path) -> Result<RunPlan, SaveError> {
    let path = folder.join(RUN_FILE);
    let unreadable = |source| SaveError::Unreadable { path: path.clone(), source };
    refuse_link(&path).map_err(unreadable)?;
    let bytes = read_bytes(&path, super::files::LARGEST_FILE_MIB)?;
    parse_plan(&path, &text_of(&path, bytes)?)
}

/// Reads from a text what run it is; `path` is what errors call it.
///
/// # Errors
/// As [`load_plan`], apart from reading.
pub fn parse_plan(path: &Path, text: &str) -> Result<RunPlan, SaveError> {
    Header::read(path, text, RUN_KIND, RUN_FORMAT)?;
    let RunV1 { engine, preset, seed, settings, .. } = parse(path, text)?;
    let settings = Settings::from(settings);
    let checked = check_engine(engine)
        .and_then(|()| name("preset", &preset))
        .and_then(|()| settings.check().map_err(|error| error.inside("settings")));
    checked.map_err(|source| SaveError::Invalid { path: path.to_owned(), source })?;
    Ok(RunPlan { preset, seed, settings })
}

/// Another engine computes other bits: what one began, the other cannot go on with.
fn check_engine(engine: u32) -> Result<(), Invalid> {
    if engine == ENGINE_VERSION {
        return Ok(());
    }
    let allowed = format!("{ENGINE_VERSION}; its champions can be replayed, the run cannot go on");
    Err(Invalid::new("engine", engine, allowed))
}

fn store_plan(path: &Path, plan: &RunPlan) -> Result<(), SaveError> {
    store_ron(
        path,
        &RunV1 {
            kind: RUN_KIND.to_owned(),
            format: RUN_FORMAT,
            engine: ENGINE_VERSION,
            preset: plan.preset.clone(),
            seed: plan.seed,
            settings: plan.settings.clone().into(),
        },
    )
}

fn store_ron(path: &Path, file: &impl Serialize) -> Result<(), SaveError> {
    let layout = PrettyConfig::new().compact_arrays(true).struct_names(false);
    let text = ron::ser::to_string_pretty(file, layout).map_err(|error| SaveError::Unwritable {
        path: path.to_owned(),
        source: std::io::Error::other(error),
    })?;
    write_whole(path, format!("{text}\n").as_bytes())
}

/// How many generations of a run's folder are finished: the whole lines of its log, which are not read.
pub fn count_records(folder: &Path) -> Result<u32, SaveError> {
    let bytes = read_log_bytes(&folder.join(LOG_FILE))?;
    Ok(bytes.iter().filter(|byte| **byte == b'\n').count() as u32)
}

/// The finished generations of a run's folder.
fn read_records(folder: &Path, settings: &Settings) -> Result<Vec<GenerationRecord>, SaveError> {
    let path = folder.join(LOG_FILE);
    parse_records(&path, &read_log_bytes(&path)?, settings)
}

/// Reads finished generations from the bytes of a log; `path` is what errors call it.
///
/// # Errors
/// A line that is not the last is damaged, out of its order, or beyond the end of the run.
pub fn parse_records(
    path: &Path,
    bytes: &[u8],
    settings: &Settings,
) -> Result<Vec<GenerationRecord>, SaveError> {
    let records: Vec<GenerationRecord> = parse_log(path, bytes)?;
    let HalvingSettings { generations, population, .. } = settings.evolution;
    let check = |(record, generation): (&GenerationRecord, u32)| {
        within("generation", record.generation, generation..=generation)?;
        within("generation", generation, 1..=generations)?;
        within("evaluations", record.evaluations, 0..=population)?;
        within("disqualified", record.disqualified, 0..=record.evaluations)?;
        within("crashed", record.crashed, 0..=record.disqualified)?;
        within("elapsed_s", record.elapsed_s, 0.0..=1.0e9)?;
        if let Some(statistics) = record.statistics {
            let StatisticsRecord { mean, best, median, std, worst, mean_centre_y_m } = statistics;
            let values = [mean, best, median, std, worst, mean_centre_y_m];
            values.into_iter().try_for_each(|value| within("statistics", value, -1.0e6..=1.0e6))?;
        }
        hash_of("hash", &record.hash).map(drop)
    };
    let checked = records.iter().zip(1..).try_for_each(check);
    checked.map_err(|source| SaveError::Invalid { path: path.to_owned(), source })?;
    Ok(records)
}

/// The numbers of a folder's checkpoints, in no order.
fn checkpoints(folder: &Path) -> Result<Vec<u32>, SaveError> {
    numbered(folder, "checkpoint-")
}

/// The numbers N for which a folder has a file `<prefix>N.ron`, in no order.
pub fn numbered(folder: &Path, prefix: &str) -> Result<Vec<u32>, SaveError> {
    let unreadable = |source| SaveError::Unreadable { path: folder.to_owned(), source };
    let mut numbers = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let file = entry.map_err(unreadable)?.file_name();
        let number = file.to_str().and_then(|file| {
            let digits = file.strip_prefix(prefix)?.strip_suffix(".ron")?;
            let number = digits.parse::<u32>().ok()?;
            // Not a copy that a person named `generation-01.ron`.
            (number.to_string() == digits).then_some(number)
        });
        numbers.extend(number);
    }
    Ok(numbers)
}

fn checkpoint_path(folder: &Path, generation: u32) -> PathBuf {
    folder.join(format!("checkpoint-{generation}.ron"))
}

fn load_checkpoint(
    folder: &Path,
    generation: u32,
    records: &[GenerationRecord],
    plan: &RunPlan,
) -> Result<StrategyState, SaveError> {
    let path = checkpoint_path(folder, generation);
    let unreadable = |source| SaveError::Unreadable { path: path.clone(), source };
    refuse_link(&path).map_err(unreadable)?;
    let text = text_of(&path, read_bytes(&path, LARGEST_CHECKPOINT_MIB)?)?;
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
    Header::read(path, text, CHECKPOINT_KIND, CHECKPOINT_FORMAT)?;
    let file: CheckpointV1 = parse(path, text)?;
    let CheckpointV1 { engine, plan: of, generation, run_hash, strategy, .. } = file;
    let StrategyV1::Halving { parents } = strategy;
    let settings = &plan.settings;
    let read = || {
        check_engine(engine)?;
        let expected = fingerprint(plan);
        if of != expected {
            let of: String = of.chars().take(40).collect();
            let allowed = format!("{expected}, as its run.ron has it");
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

impl GenerationRecord {
    /// Hash over the bits of every evaluation.
    ///
    /// # Errors
    /// It is not written as a hash.
    pub fn generation_hash(&self) -> Result<u64, Invalid> {
        hash_of("hash", &self.hash)
    }
}

/// The evaluations of the generation under way, in the order in which they were written.
///
/// They are no more than a saving: where they are damaged, they are computed again.
fn read_evaluations(
    folder: &Path,
    generation: u32,
    plan: &RunPlan,
) -> Result<Vec<(u32, Evaluation)>, SaveError> {
    let path = folder.join(EVALUATIONS_FILE);
    refuse_link(&path).map_err(|source| SaveError::Unreadable { path: path.clone(), source })?;
    let Ok(bytes) = read_log_bytes(&path) else { return Ok(Vec::new()) };
    Ok(parse_evaluations(&path, &bytes, generation, plan).unwrap_or_default())
}

/// Reads the evaluations of a generation from the bytes of a log; `path` is what errors call it. Those of
/// another generation or another run are none of this one.
///
/// # Errors
/// A line that is not the last is damaged, or has a value that is not allowed.
pub fn parse_evaluations(
    path: &Path,
    bytes: &[u8],
    generation: u32,
    plan: &RunPlan,
) -> Result<Vec<(u32, Evaluation)>, SaveError> {
    let records: Vec<EvaluationRecord> = parse_log(path, bytes)?;
    let of = fingerprint(plan);
    if records.iter().any(|record| record.generation != generation || record.plan != of) {
        return Ok(Vec::new());
    }
    let read = |record: EvaluationRecord| {
        let last = plan.settings.evolution.population.saturating_sub(1);
        within("individual", record.individual, 0..=last)?;
        within("fitness", record.fitness, -1.0e6..=1.0e6)?;
        within("centre_y_m", record.centre_y_m, -1.0e6..=1.0e6)?;
        let trace_hash = hash_of("trace_hash", &record.trace_hash)?;
        let EvaluationRecord { fitness, centre_y_m, disqualified, steps, .. } = record;
        let evaluation = Evaluation { fitness, centre_y_m, disqualified, trace_hash, steps };
        Ok((record.individual, evaluation))
    };
    let read = records.into_iter().map(read).collect::<Result<_, Invalid>>();
    read.map_err(|source| SaveError::Invalid { path: path.to_owned(), source })
}
