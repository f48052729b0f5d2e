//! The program without a window: an experiment as a table or as JSON lines, a replay as a verdict.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use rayon::{ThreadPool, ThreadPoolBuildError};
use serde_json::{Value, json};

use super::{Cancelled, Control, Experiment, GenerationReport, KeptRun, RunSource, caught, pool};
use crate::ENGINE_VERSION;
use crate::evolve::{Champion, RunPlan, SettingChange};
use crate::save::{SaveError, load_champion};
use crate::score::{Evaluation, evaluate};
use crate::world::{Effort, HealthLimits};

/// Why a headless command failed.
#[derive(Debug, thiserror::Error)]
pub enum HeadlessError {
    /// A file could not be read or written.
    #[error(transparent)]
    Save(#[from] SaveError),
    /// The threads could not be started.
    #[error("threads: cannot be started: {0}")]
    Threads(#[from] ThreadPoolBuildError),
    /// Standard output was closed or is full.
    #[error("standard output: cannot be written: {0}")]
    Output(#[from] io::Error),
    /// The interrupt key stopped a run.
    #[error(
        "cancelled after generation {finished} of {generations}; it goes on with --resume {}",
        folder.display()
    )]
    Stopped {
        /// Generations that are finished.
        finished: u32,
        /// Generations in the run.
        generations: u32,
        /// The run's folder.
        folder: PathBuf,
    },
    /// A generation could not be saved.
    #[error(
        "{source}; generations up to {saved} are safe, the run goes on with --resume {}",
        folder.display()
    )]
    NotSaved {
        /// Why.
        source: Box<SaveError>,
        /// Generations that are saved.
        saved: u32,
        /// The run's folder.
        folder: PathBuf,
    },
    /// The program failed on the genome of a save.
    #[error("{}: the program failed on its genome: {message}", path.display())]
    Crashed {
        /// The save.
        path: PathBuf,
        /// What the program said.
        message: String,
    },
    /// The interrupt key was pressed.
    #[error("cancelled; {}", match kept {
        Some(path) => format!("the best so far is saved to {}", path.display()),
        None => "the first seed was not finished, nothing is saved".to_owned(),
    })]
    Cancelled {
        /// Where the best so far is.
        kept: Option<PathBuf>,
    },
    /// A replay came out differently than recorded.
    #[error("{path}: replay differs from the record: {difference}")]
    Differs {
        /// The save.
        path: PathBuf,
        /// What differs, and why that may be.
        difference: String,
    },
    /// Every agent of every generation was disqualified.
    #[error("no champion: every agent of every generation was disqualified")]
    NoChampion,
}

/// Evolves a run to its end and prints it to `out`, a line per generation, those included that were behind
/// it. Each generation is saved before its line is printed.
///
/// # Errors
/// See [`HeadlessError`]. The folder is opened before the first evaluation.
pub fn evolve(
    source: RunSource,
    threads: usize,
    json: bool,
    control: &Arc<Control>,
    out: &mut dyn Write,
) -> Result<(), HeadlessError> {
    let RunPlan { preset, seed, founder, .. } = source.plan.clone();
    let KeptRun { mut experiment, mut keeper, reports } = source.open("snakes --no-render")?;
    let pool = pool(threads)?;
    let folder = keeper.folder().to_owned();
    let settings = experiment.settings().into_owned();
    let generations = settings.evolution.generations;
    let behind = match reports.len() {
        0 => String::new(),
        _ if experiment.is_over() => "; finished before (--restart evolves it again)".to_owned(),
        behind => format!("; goes on after generation {behind}"),
    };
    let founder = founder.map(|founder| format!(", from {}", founder.name()));
    let from = founder.unwrap_or_default();
    say(&format!(
        "preset {preset}, seed {seed}{from}: generations {generations}, population {}, threads \
         {threads}{behind}",
        settings.evolution.population
    ));
    if !keeper.changes().is_empty() {
        say(&format!("changed on the way: {}", in_words(keeper.changes())));
    }
    if !json {
        writeln!(out, "{TABLE_HEAD}")?;
    }
    let mut landing = Landing::default();
    let mut print = |report: &GenerationReport| {
        landing.see(report);
        let line = if json { json_line(report).to_string() } else { table_row(report) };
        writeln!(out, "{line}")?;
        out.flush()
    };
    reports.iter().try_for_each(&mut print)?;
    drop(reports);
    while !experiment.is_over() {
        let note = |generation, individual, evaluation: &_| {
            keeper.note(generation, individual, evaluation);
        };
        let report = with_progress(&mut experiment, &pool, control, note);
        let finished = experiment.finished();
        let report = report.map_err(|Cancelled| HeadlessError::Stopped {
            finished,
            generations,
            folder: folder.clone(),
        })?;
        let crashes =
            keeper.keep(&experiment, &report).map_err(|source| HeadlessError::NotSaved {
                source: Box::new(source),
                saved: experiment.finished() - 1,
                folder: folder.clone(),
            })?;
        crashes.iter().for_each(|crash| say(crash));
        print(&report)?;
    }
    let run_hash = format!("{:016x}", experiment.run_hash());
    let best = experiment.best();
    if json {
        let last = json!({
            "done": true,
            "run_hash": run_hash,
            "first_on_landing": landing.first,
            "best": best.map(|best| best.evaluation.fitness),
            "champion": keeper.best(),
        });
        writeln!(out, "{last}")?;
    } else if let (Some(best), Some(path)) = (best, keeper.best()) {
        writeln!(out, "\nchampion  {}", about(best))?;
        writeln!(out, "saved to  {}", path.display())?;
        if let Some(first) = landing.first {
            writeln!(out, "landing   first reached by evaluation {first}")?;
        }
        writeln!(out, "run hash  {run_hash}")?;
    }
    best.map(|_| ()).ok_or(HeadlessError::NoChampion)
}

/// What was changed, in a line; of many changes the latest.
fn in_words(changes: &[SettingChange]) -> String {
    const MOST: usize = 6;
    let left_out = changes.len().saturating_sub(MOST);
    let mut texts: Vec<String> = Vec::new();
    if left_out > 0 {
        texts.push(format!("{left_out} earlier"));
    }
    texts.extend(changes.iter().skip(left_out).map(|change| {
        let SettingChange { generation, field, value } = change;
        let name = field.strip_prefix("evolution.").unwrap_or(field);
        format!("{name} {value} from generation {generation}")
    }));
    texts.join(", ")
}

/// Counts evaluations up to the first agent on the landing.
#[derive(Debug, Default)]
struct Landing {
    spent: u64,
    /// Its number, counted from 1.
    first: Option<u64>,
}

impl Landing {
    fn see(&mut self, report: &GenerationReport) {
        let number = report.first_on_landing.map(|index| self.spent + u64::from(index) + 1);
        self.first = self.first.or(number);
        self.spent += u64::from(report.evaluations);
    }
}

/// Runs one generation with a progress bar on the terminal; where standard error is no terminal, none
/// is drawn. `note` is told of every evaluation: see [`Experiment::run_generation_noting`].
///
/// # Errors
/// [`Cancelled`], if `control` was.
pub fn with_progress(
    experiment: &mut Experiment,
    pool: &ThreadPool,
    control: &Arc<Control>,
    note: impl Fn(u32, u32, &Evaluation) + Sync,
) -> Result<GenerationReport, Cancelled> {
    let bar = ProgressBar::new(experiment.population().into());
    // The template is a constant; if it were wrong, the default bar would do.
    if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len}  {eta} left") {
        bar.set_style(style);
    }
    bar.set_message(format!("generation {}", experiment.finished() + 1));
    watched(&bar, control, || experiment.run_generation_noting(pool, control, note))
}

/// Does `work` while a bar shows how much of it `control` has counted.
pub fn watched<T>(bar: &ProgressBar, control: &Control, work: impl FnOnce() -> T) -> T {
    let result = std::thread::scope(|scope| {
        let (finished, watched) = std::sync::mpsc::channel::<()>();
        scope.spawn(move || {
            // Ends when the sender is dropped.
            while watched.recv_timeout(Duration::from_millis(100))
                == Err(std::sync::mpsc::RecvTimeoutError::Timeout)
            {
                bar.set_position(control.done().into());
            }
        });
        let result = work();
        drop(finished);
        result
    });
    bar.finish_and_clear();
    result
}

/// Re-simulates a saved champion and compares it with its record, bit for bit.
///
/// # Errors
/// The file cannot be used, or fitness or trace differ from what was recorded.
pub fn replay(path: &Path, json: bool, out: &mut dyn Write) -> Result<(), HeadlessError> {
    let loaded = load_champion(path)?;
    let recorded = loaded.champion.evaluation;
    let Champion { genome, trial, .. } = &loaded.champion;
    let found = caught(|| evaluate(genome, trial))
        .map_err(|message| HeadlessError::Crashed { path: path.to_owned(), message })?;
    let matches = found.agrees_with(&recorded);
    let meaning = loaded.champion.trial.meaning(f64::from(found.centre_y_m));
    if json {
        let line = json!({
            "fitness": found.fitness,
            "trace_hash": format!("{:016x}", found.trace_hash),
            "recorded_fitness": recorded.fitness,
            "recorded_trace_hash": format!("{:016x}", recorded.trace_hash),
            "steps": found.steps,
            "energy_j": found.effort.map(|effort| effort.energy_j),
            "top_speed_m_s": found.effort.map(|effort| effort.top_speed_m_s),
            "joint_drift_m": found.effort.map(|effort| effort.joint_drift_m),
            "sideways_m": found.effort.map(|effort| effort.sideways_m),
            "disqualified": found.disqualified.map(|reason| reason.words()),
            "meaning": meaning,
            "engine": loaded.engine,
            "matches": matches,
        });
        writeln!(out, "{line}")?;
    } else {
        let unit = loaded.champion.trial.fitness.unit();
        writeln!(out, "fitness     {:.6}{unit}, {meaning}", found.fitness)?;
        if let Some(reason) = found.disqualified {
            let words = reason.words();
            writeln!(out, "disqualified after {} steps: {words}", found.steps)?;
        }
        if let Some(effort) = &found.effort {
            writeln!(out, "{}", effort_lines(effort, &trial.health))?;
        }
        writeln!(out, "trace_hash  {:016x}", found.trace_hash)?;
        if matches {
            writeln!(out, "equal to the record, bit for bit")?;
        }
    }
    if matches {
        return Ok(());
    }
    let engine = if loaded.is_of_this_engine() {
        "the file was edited, or this machine computes other bits".to_owned()
    } else {
        format!("recorded by engine {}, this is engine {ENGINE_VERSION}", loaded.engine)
    };
    let difference = format!(
        "fitness {}, {} steps, trace {:016x}; recorded {}, {} steps, {:016x} ({engine})",
        found.fitness,
        found.steps,
        found.trace_hash,
        recorded.fitness,
        recorded.steps,
        recorded.trace_hash,
    );
    Err(HeadlessError::Differs { path: path.to_owned(), difference })
}

/// What a run demanded, each with the limit beyond which it would have been disqualified.
fn effort_lines(effort: &Effort, health: &HealthLimits) -> String {
    format!(
        "energy      {:.1} J\n\
         top speed   {:.2} m/s of {} m/s\n\
         joint drift {:.4} m of {} m\n\
         sideways    {:.2} m of {} m",
        effort.energy_j,
        effort.top_speed_m_s,
        health.speed_m_s,
        effort.joint_drift_m,
        health.joint_drift_m,
        effort.sideways_m,
        health.arena_half_width_m,
    )
}

/// Tells a person how it goes; standard output is for results.
pub fn say(line: &str) {
    // Nothing is left to do if even standard error is gone.
    let _ = writeln!(io::stderr(), "{line}");
}

const TABLE_HEAD: &str =
    "generation     mean     best   median  std.dev.  disqualified  meaning of the mean";

fn table_row(report: &GenerationReport) -> String {
    let generation = report.generation;
    let disqualified = report.disqualified;
    let numbers = match report.statistics {
        Some(s) => format!("{:>9.2}{:>9.2}{:>9.2}{:>10.2}", s.mean, s.best, s.median, s.std),
        None => format!("{:>9}{:>9}{:>9}{:>10}", "-", "-", "-", "-"),
    };
    format!("{generation:>10}{numbers}{disqualified:>14}  {}", report.meaning)
}

fn json_line(report: &GenerationReport) -> Value {
    let statistics = report.statistics;
    json!({
        "generation": report.generation,
        "mean": statistics.map(|s| s.mean),
        "best": statistics.map(|s| s.best),
        "median": statistics.map(|s| s.median),
        "std": statistics.map(|s| s.std),
        "worst": statistics.map(|s| s.worst),
        "disqualified": report.disqualified,
        "crashed": report.crashed,
        "on_landing": report.on_landing,
        "first_on_landing": report.first_on_landing,
        "evaluations": report.evaluations,
        "elapsed_s": report.elapsed_s,
        "meaning": report.meaning,
        "hash": format!("{:016x}", report.hash),
    })
}

/// A champion in one line.
fn about(champion: &Champion) -> String {
    format!(
        "{} (generation {}, individual {})",
        champion.reached(),
        champion.origin.generation,
        champion.origin.individual,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Statistics;

    fn report() -> GenerationReport {
        let statistics = Statistics {
            mean: -7.225,
            best: 1.5,
            median: -7.0,
            std: 0.25,
            worst: -9.0,
            mean_centre_y_m: -7.225,
            quartiles: None,
        };
        GenerationReport {
            generation: 1,
            evaluations: 500,
            disqualified: 12,
            reasons: Default::default(),
            crashed: 0,
            crashes: Vec::new(),
            on_landing: 0,
            first_on_landing: None,
            statistics: Some(statistics),
            meaning: "starting position".to_owned(),
            hash: 0,
            elapsed_s: 0.0,
            champion: None,
        }
    }

    #[test]
    fn the_first_on_the_landing_is_counted_over_generations() {
        let mut landing = Landing::default();
        for (evaluations, first_on_landing) in [(50, None), (50, Some(7)), (50, Some(0))] {
            landing.see(&GenerationReport { evaluations, first_on_landing, ..report() });
        }
        assert_eq!(landing.first, Some(58));
    }

    #[test]
    fn a_row_stands_under_its_head() {
        let report = report();
        let row = table_row(&report);
        for (number, column) in [("-7.22", "mean"), ("1.50", "best"), ("12", "disqualified")] {
            let end_of = |line: &str, word: &str| line.find(word).map(|at| at + word.len());
            assert_eq!(end_of(&row, number), end_of(TABLE_HEAD, column), "{row}\n{TABLE_HEAD}");
        }
        assert_eq!(row.find("starting"), TABLE_HEAD.find("meaning"));
    }
}
