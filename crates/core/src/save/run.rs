//! A run's folder: its plan, the logs of its generations, its checkpoints and champions.
//!
//! | file | contents | written |
//! |---|---|---|
//! | `run.ron` | preset, seed, settings, founder, engine | once, atomically |
//! | `changes.jsonl` | a line per changed setting | appended, before the first generation that uses it |
//! | `generation-N.ron` | the champion of generation N | atomically, before the log's line |
//! | `checkpoint-N.ron` | the state of the search after generation N | atomically, before the log's line |
//! | `log.jsonl` | a line per finished generation | appended; this line makes a generation finished |
//! | `lineage.jsonl` | the individuals' parents, a line per finished generation | appended, before the log's line |
//! | `evaluations.jsonl` | the evaluations of the current generation | appended; emptied after each generation |
//! | `crashed-N-I.ron` | a genome on which the program panicked | atomically |
//! | `lock` | nothing; locked by the program that writes into the folder | while it does |
//! | `lock-owner` | that program's process number and name | when it takes the lock |
//!
//! A kill at any instant therefore leaves a log whose last complete line has its checkpoint. Lost evaluations are computed again, with the
//! same bits.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::SaveError;
use super::champion::{load_champion, store_champion};
use super::change::{CHANGES_FILE, ChangeRecord, read_changes};
use super::checkpoint::{
    SearchState, checkpoints, load_checkpoint, remove_old_checkpoints, store_checkpoint,
};
use super::files::refuse_link;
use super::folder::{champion_file_name, within_run};
use super::lineage::{LINEAGE_FILE, LineageRecord, read_lineage};
use super::lock::Lock;
use super::log::Log;
use super::plan::{RUN_FILE, load_plan, store_plan};
use super::record::{EVALUATIONS_FILE, EvaluationRecord, LOG_FILE, read_evaluations, read_records};
use super::run_name::fingerprint;
use super::whole_file::prepare_folder;
use crate::evolve::{Champion, GenerationRecord, RunPlan, SettingChange};
use crate::score::{Evaluation, Recording};

/// Maximum number of crashed genomes that a run keeps.
const MAX_CRASHED: usize = 30;

/// The saved progress of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SavedProgress {
    /// Changes of the run, the earliest first. If finished generations were lost, some changes may apply to future generations.
    pub changes: Vec<SettingChange>,
    /// Finished generations, in order.
    pub records: Vec<GenerationRecord>,
    /// Champion of each finished generation. None if the generation had none, or if the file is missing.
    pub champions: Vec<Option<Champion>>,
    /// State of the search. None before the first generation is finished.
    pub knowledge: Option<SearchState>,
    /// Known evaluations of the current generation, with the individuals' indices.
    pub evaluations: Vec<(u32, Evaluation)>,
    /// Parents of individuals, as far as they were written. The results of the run do not depend on them.
    pub lineage: Vec<LineageRecord>,
}

/// A run's folder, locked and open for writing.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    log: Log,
    /// Log of the current generation's evaluations. None before the first evaluation of a generation.
    evaluations: Mutex<Option<EvaluationLog>>,
    /// Plan with which the run began.
    plan: RunPlan,
    changes: Vec<SettingChange>,
    /// Last generation in the log of parents, and the log. None if the log cannot be written.
    lineage: Option<(u32, Log)>,
    _lock: Lock,
}

/// Log of the current generation's evaluations.
#[derive(Debug)]
struct EvaluationLog {
    generation: u32,
    /// Fingerprint of the run's plan in the current generation.
    plan: String,
    log: Log,
}

/// Treatment of a run that a folder already has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExistingRun {
    /// The run is continued. If it is finished, nothing is left to do.
    Keep,
    /// The run starts over.
    Discard,
}

impl RunFolder {
    /// Opens the folder of a run, and creates it if it does not exist. Other programs report `owner` as the owner's name.
    ///
    /// # Errors
    /// Fails if another program writes into the folder, if the folder has another run, or if a file is damaged or cannot be written.
    pub fn open(
        path: &Path,
        plan: &RunPlan,
        earlier: ExistingRun,
        owner: &str,
    ) -> Result<(Self, SavedProgress), SaveError> {
        prepare_folder(path)?;
        let lock = Lock::take(path, owner)?;
        let file = path.join(RUN_FILE);
        refuse_link(&file).map_err(SaveError::unreadable(&file))?;
        // A run that starts over replaces the plan without reading the old one.
        if file.exists() && earlier == ExistingRun::Keep {
            let stored = load_plan(path)?;
            if stored != *plan {
                return Err(SaveError::OtherRun { path: path.to_owned() });
            }
        } else {
            store_plan(&file, plan)?;
        }
        let log_path = path.join(LOG_FILE);
        if earlier == ExistingRun::Discard {
            // The changes are removed first. After a kill, files of the earlier run could otherwise be mistaken for files of the new run.
            discard(&path.join(CHANGES_FILE))?;
        }
        let progress = match earlier {
            ExistingRun::Keep => SavedProgress::read(path, plan)?,
            ExistingRun::Discard => SavedProgress::default(),
        };
        let folder = Self {
            path: path.to_owned(),
            log: Log::open(&log_path, progress.records.len())?,
            evaluations: Mutex::new(None),
            plan: plan.clone(),
            changes: progress.changes.clone(),
            lineage: {
                let log = Log::open(&path.join(LINEAGE_FILE), progress.lineage.len()).ok();
                let last = progress.lineage.last().map_or(0, |record| record.generation);
                log.map(|log| (last, log))
            },
            _lock: lock,
        };
        let next = progress.records.len() as u32 + 1;
        if progress.evaluations.is_empty() {
            // An evaluations file without usable evaluations belongs to another generation.
            let _ = fs::remove_file(path.join(EVALUATIONS_FILE));
        } else {
            let log = Log::open(&path.join(EVALUATIONS_FILE), progress.evaluations.len())?;
            let plan = folder.fingerprint(next)?;
            folder.evaluations_log().replace(EvaluationLog { generation: next, plan, log });
        }
        if earlier == ExistingRun::Discard {
            remove_old_checkpoints(path, 0);
        }
        Ok((folder, progress))
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the path of a generation's champion.
    pub fn champion_path(&self, generation: u32) -> PathBuf {
        self.path.join(champion_file_name(generation))
    }

    /// Logs an evaluation of the current generation, so that a resumed run need not compute it again. A failure is not an error, because
    /// the evaluation can be computed again.
    pub fn note(&self, generation: u32, individual: u32, evaluation: &Evaluation) {
        let mut log = self.evaluations_log();
        if log.as_ref().is_none_or(|notes| notes.generation != generation) {
            let fresh = Log::open(&self.path.join(EVALUATIONS_FILE), 0);
            let plan = self.fingerprint(generation).ok();
            *log = fresh.ok().zip(plan).map(|(log, plan)| EvaluationLog { generation, plan, log });
        }
        if let Some(EvaluationLog { plan, log, .. }) = log.as_mut() {
            let _ = log.append_lightly(&EvaluationRecord {
                plan: plan.clone(),
                generation,
                individual,
                disqualified: evaluation.disqualified,
                recorded: *evaluation,
            });
        }
    }

    /// Logs the parents of a generation that is about to be finished. A failure is not an error: the parents are then unknown later.
    pub fn note_lineage(&mut self, record: &LineageRecord) {
        let Some((last, log)) = &mut self.lineage else { return };
        // A generation that could not be finished is logged again, but its parents only once.
        if record.generation > *last && log.append_lightly(record).is_ok() {
            *last = record.generation;
        }
    }

    /// Writes a finished generation, and returns the path of the champion. If writing fails, the generation is not finished, and writing
    /// may be tried again.
    ///
    /// # Errors
    /// Fails if a file cannot be written.
    pub fn finish_generation(
        &mut self,
        record: &GenerationRecord,
        champion: Option<(&Champion, &Recording)>,
        knowledge: &SearchState,
        run_hash: u64,
    ) -> Result<Option<PathBuf>, SaveError> {
        let champion_path = within_run(&self.path, &champion_file_name(record.generation))?;
        if let Some((champion, recording)) = champion {
            store_champion(&champion_path, champion, Some(recording))?;
        }
        let plan = self.fingerprint(record.generation)?;
        store_checkpoint(&self.path, &plan, record.generation, run_hash, knowledge)?;
        self.log.append(record)?;
        // The evaluations are not needed after the generation.
        self.evaluations_log().take();
        let _ = fs::remove_file(self.path.join(EVALUATIONS_FILE));
        remove_old_checkpoints(&self.path, record.generation);
        Ok(champion.map(|_| champion_path))
    }

    /// Logs the change of a setting before the first generation that uses it. Known evaluations of that generation used the old value, and
    /// are discarded.
    ///
    /// # Errors
    /// Fails if the log cannot be written; the change is then not made.
    pub fn change(&mut self, change: &SettingChange) -> Result<(), SaveError> {
        let mut log = Log::open(&self.path.join(CHANGES_FILE), self.changes.len())?;
        log.append(&ChangeRecord::from(change))?;
        if self.changes.is_empty() {
            // The folder is flushed, so that the new file's name survives a power cut. Errors are ignored.
            #[cfg(unix)]
            let _ = fs::File::open(&self.path).and_then(|folder| folder.sync_all());
        }
        self.changes.push(change.clone());
        self.evaluations_log().take();
        Ok(())
    }

    /// Returns the changes of the run, the earliest first.
    pub fn changes(&self) -> &[SettingChange] {
        &self.changes
    }

    /// Returns the fingerprint of the run's plan in a generation.
    fn fingerprint(&self, generation: u32) -> Result<String, SaveError> {
        let plan = self.plan.in_generation(generation, &self.changes);
        let plan = plan.map_err(SaveError::invalid(&self.path.join(CHANGES_FILE)))?;
        Ok(fingerprint(&plan))
    }

    /// Saves a genome on which the program panicked, for debugging.
    ///
    /// # Errors
    /// Fails if the file cannot be written, or if [`MAX_CRASHED`] genomes are already saved.
    pub fn keep_crashed(&self, crashed: &Champion) -> Result<PathBuf, SaveError> {
        let origin = &crashed.origin;
        let name = format!("crashed-{}-{}.ron", origin.generation, origin.individual);
        let unwritable = SaveError::unwritable(&self.path);
        let entries = fs::read_dir(&self.path).map_err(unwritable)?.flatten();
        let is_crash = |name: &OsStr| name.to_string_lossy().starts_with("crashed-");
        if entries.filter(|entry| is_crash(&entry.file_name())).count() >= MAX_CRASHED {
            let enough = format!("it already contains {MAX_CRASHED} crashed genomes");
            return Err(unwritable(std::io::Error::other(enough)));
        }
        let path = within_run(&self.path, &name)?;
        store_champion(&path, crashed, None)?;
        Ok(path)
    }

    fn evaluations_log(&self) -> std::sync::MutexGuard<'_, Option<EvaluationLog>> {
        self.evaluations.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Removes a file of an earlier run, if it exists.
fn discard(path: &Path) -> Result<(), SaveError> {
    match fs::remove_file(path) {
        Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
            Err(SaveError::Unwritable { path: path.to_owned(), source })
        }
        _ => Ok(()),
    }
}

impl SavedProgress {
    /// Reads the progress of a run from its folder.
    pub fn read(folder: &Path, plan: &RunPlan) -> Result<Self, SaveError> {
        let changes = read_changes(folder, plan)?;
        let changes_file = folder.join(CHANGES_FILE);
        let plan_in = |generation| {
            let plan = plan.in_generation(generation, &changes);
            plan.map_err(SaveError::invalid(&changes_file))
        };
        let mut records = read_records(folder, &plan_in(u32::MAX)?)?;
        let known = checkpoints(folder)?;
        let latest = known.into_iter().filter(|&of| of as usize <= records.len()).max();
        records.truncate(latest.unwrap_or(0) as usize);
        let knowledge = latest.map(|of| load_checkpoint(folder, of, &records, &plan_in(of)?));
        let champion = |record: &GenerationRecord| {
            let path = folder.join(champion_file_name(record.generation));
            refuse_link(&path).map_err(SaveError::unreadable(&path))?;
            if record.statistics.is_none() || !path.exists() {
                return Ok(None);
            }
            Ok(Some(load_champion(&path)?.champion))
        };
        Ok(Self {
            knowledge: knowledge.transpose()?,
            champions: records.iter().map(champion).collect::<Result<_, _>>()?,
            evaluations: {
                let next = records.len() as u32 + 1;
                read_evaluations(folder, next, &plan_in(next)?)?
            },
            lineage: read_lineage(folder, records.len() as u32, &plan_in(u32::MAX)?),
            records,
            changes,
        })
    }
}
