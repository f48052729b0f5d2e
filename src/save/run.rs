//! A run as a folder: what run it is, a log of its generations, checkpoints, champions.
//!
//! | file | what it holds | written |
//! |---|---|---|
//! | `run.ron` | preset, seed, settings, founder, engine | once, whole |
//! | `changes.jsonl` | a line per setting that was changed on the way | added to, before the generation that it concerns |
//! | `generation-N.ron` | the champion of generation N | whole, before the log's line |
//! | `checkpoint-N.ron` | what the strategy knew after generation N | whole, before the log's line |
//! | `log.jsonl` | a line per finished generation | added to; a generation is finished once its line stands |
//! | `lineage.jsonl` | who came from whom, a line per finished generation | added to, before the log's line |
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

use super::champion::{load_champion, store_champion};
use super::change::{CHANGES_FILE, ChangeRecord, read_changes};
use super::checkpoint::{Knowledge, checkpoints, load_checkpoint, store_checkpoint, thin};
use super::files::{prepare_folder, refuse_link, remove_unfinished};
use super::folder::{champion_file_name, fingerprint};
use super::lineage::{LINEAGE_FILE, LineageRecord, read_lineage};
use super::lock::Lock;
use super::log::Log;
use super::plan::{RUN_FILE, load_plan, store_plan};
use super::record::{EVALUATIONS_FILE, EvaluationRecord, LOG_FILE, read_evaluations, read_records};
use super::{GenerationRecord, SaveError};
use crate::check::Invalid;
use crate::evolve::{Champion, RunPlan, SettingChange};
use crate::score::{Evaluation, Recording};

/// A run keeps so many genomes on which the program failed.
const MOST_CRASHED: usize = 30;

/// What a run has behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// What was changed of it, the earliest first. If finished generations were lost, some changes may be ahead.
    pub changes: Vec<SettingChange>,
    /// The finished generations, the first first.
    pub records: Vec<GenerationRecord>,
    /// The champion of each of them; none, if it had none or its file is gone.
    pub champions: Vec<Option<Champion>>,
    /// What had been learned; none before the first generation is finished.
    pub knowledge: Option<Knowledge>,
    /// What is known of the generation under way: individuals and their evaluations.
    pub evaluations: Vec<(u32, Evaluation)>,
    /// Who came from whom, as far as it was written down; nothing of a run depends on it.
    pub lineage: Vec<LineageRecord>,
}

/// A run's folder, open for writing. Nobody else can open it meanwhile.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    log: Log,
    /// The generation under way, and the evaluations written of it.
    evaluations: Mutex<Option<Notes>>,
    /// What the run began with, and what was changed since: what is written is tied to both.
    plan: RunPlan,
    changes: Vec<SettingChange>,
    /// Who came from whom, and the last generation of which it tells. None, if it cannot be written.
    lineage: Option<(u32, Log)>,
    _lock: Lock,
}

/// The evaluations of a generation under way.
#[derive(Debug)]
struct Notes {
    generation: u32,
    /// Ties them to the plan of the run in that generation.
    plan: String,
    log: Log,
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
        if earlier == Earlier::Discard {
            // First: without them, what is left of the earlier run is known to be of another.
            discard(&path.join(CHANGES_FILE))?;
        }
        let progress = match earlier {
            Earlier::Keep => Progress::read(path, plan)?,
            Earlier::Discard => Progress::none(),
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
            // Those of another generation.
            let _ = fs::remove_file(path.join(EVALUATIONS_FILE));
        } else {
            let log = Log::open(&path.join(EVALUATIONS_FILE), progress.evaluations.len())?;
            let plan = folder.fingerprint(next)?;
            folder.evaluations_log().replace(Notes { generation: next, plan, log });
        }
        if earlier == Earlier::Discard {
            thin(path, 0);
        }
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
        if log.as_ref().is_none_or(|notes| notes.generation != generation) {
            let fresh = Log::open(&self.path.join(EVALUATIONS_FILE), 0);
            let plan = self.fingerprint(generation).ok();
            *log = fresh.ok().zip(plan).map(|(log, plan)| Notes { generation, plan, log });
        }
        if let Some(Notes { plan, log, .. }) = log.as_mut() {
            let _ = log.append_lightly(&EvaluationRecord {
                plan: plan.clone(),
                generation,
                individual,
                disqualified: evaluation.disqualified,
                recorded: (*evaluation).into(),
            });
        }
    }

    /// Notes who came from whom in a generation that is about to be finished. What cannot be noted is not known
    /// later: that is no error.
    pub fn note_lineage(&mut self, record: &LineageRecord) {
        let Some((last, log)) = &mut self.lineage else { return };
        // A generation that could not be saved comes again.
        if record.generation > *last && log.append_lightly(record).is_ok() {
            *last = record.generation;
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
        knowledge: &Knowledge,
        run_hash: u64,
    ) -> Result<Option<PathBuf>, SaveError> {
        let champion_path = self.champion_path(record.generation);
        if let Some((champion, recording)) = champion {
            store_champion(&champion_path, champion, Some(recording))?;
        }
        let plan = self.fingerprint(record.generation)?;
        store_checkpoint(&self.path, &plan, record.generation, run_hash, knowledge)?;
        self.log.append(record)?;
        // They are in the champion, the checkpoint and the log now.
        self.evaluations_log().take();
        let _ = fs::remove_file(self.path.join(EVALUATIONS_FILE));
        thin(&self.path, record.generation);
        Ok(champion.map(|_| champion_path))
    }

    /// Writes down, before the generation that it concerns, that a setting is changed. Evaluations of that
    /// generation that are known already were made under the old one, and are forgotten.
    ///
    /// # Errors
    /// It cannot be written; it then is not made.
    pub fn change(&mut self, change: &SettingChange) -> Result<(), SaveError> {
        let mut log = Log::open(&self.path.join(CHANGES_FILE), self.changes.len())?;
        log.append(&ChangeRecord::from(change))?;
        if self.changes.is_empty() {
            // That the name of a new file survives a power cut is up to the platform.
            #[cfg(unix)]
            let _ = fs::File::open(&self.path).and_then(|folder| folder.sync_all());
        }
        self.changes.push(change.clone());
        self.evaluations_log().take();
        Ok(())
    }

    /// What was changed of the run, the earliest first.
    pub fn changes(&self) -> &[SettingChange] {
        &self.changes
    }

    /// Ties what is written to the plan of the run in a generation.
    fn fingerprint(&self, generation: u32) -> Result<String, SaveError> {
        let path = || self.path.join(CHANGES_FILE);
        Ok(fingerprint(&in_generation(&self.plan, generation, &self.changes, path)?))
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

    fn evaluations_log(&self) -> std::sync::MutexGuard<'_, Option<Notes>> {
        self.evaluations.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The plan of a run in a generation; `path` is what errors call the changes.
fn in_generation(
    plan: &RunPlan,
    generation: u32,
    changes: &[SettingChange],
    path: impl FnOnce() -> PathBuf,
) -> Result<RunPlan, SaveError> {
    let invalid = |source: Invalid| SaveError::Invalid { path: path(), source };
    plan.in_generation(generation, changes).map_err(invalid)
}

/// Removes what an earlier run has left.
fn discard(path: &Path) -> Result<(), SaveError> {
    match fs::remove_file(path) {
        Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
            Err(SaveError::Unwritable { path: path.to_owned(), source })
        }
        _ => Ok(()),
    }
}

impl Progress {
    fn none() -> Self {
        Self {
            changes: Vec::new(),
            records: Vec::new(),
            champions: Vec::new(),
            knowledge: None,
            evaluations: Vec::new(),
            lineage: Vec::new(),
        }
    }

    /// Reads what a folder has of a run.
    pub fn read(folder: &Path, plan: &RunPlan) -> Result<Self, SaveError> {
        let changes = read_changes(folder, plan)?;
        let plan_in =
            |generation| in_generation(plan, generation, &changes, || folder.join(CHANGES_FILE));
        let mut records = read_records(folder, &plan_in(u32::MAX)?)?;
        let known = checkpoints(folder)?;
        let latest = known.into_iter().filter(|&of| of as usize <= records.len()).max();
        records.truncate(latest.unwrap_or(0) as usize);
        let knowledge = latest.map(|of| load_checkpoint(folder, of, &records, &plan_in(of)?));
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
