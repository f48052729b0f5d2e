//! The program without a window: evolves a run and prints it as a table or as JSON lines.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::evaluator::{Evaluator, WorkersError};
use super::json::{short, with_short_numbers};
use super::judge::JudgeError;
use super::progress_bar::run_generation_with_bar;
use super::recorder::{RecordedRun, RunSource};
use super::report::GenerationReport;
use super::run_control::{Cancelled, RunControl};
pub use super::terminal::say;
use super::terminal::write_line;
use snakes_core::evolve::{
    BandCount, Champion, RunPlan, Rung, SettingChange, SpeciesCount, StairsCount,
};
use snakes_core::save::SaveError;
use snakes_core::score::EndingKind;

/// Errors of commands without a window.
#[derive(Debug, thiserror::Error)]
pub enum HeadlessError {
    /// A file could not be read or written.
    #[error(transparent)]
    Save(#[from] SaveError),
    /// The workers could not be started.
    #[error(transparent)]
    Workers(#[from] WorkersError),
    /// Standard output was closed or is full.
    #[error("standard output: cannot be written: {0}")]
    Output(#[from] io::Error),
    /// The interrupt key stopped a run after a finished generation.
    #[error(
        "cancelled after generation {finished} of {generations}; continue it with: snakes --no-render --resume {}{flags}",
        folder.display()
    )]
    Stopped {
        /// Number of finished generations.
        finished: u32,
        /// Greatest number of generations of the run, in words.
        generations: String,
        /// Folder of the run.
        folder: PathBuf,
        /// Command-line flags that choose the run's evaluator: see [`Evaluator::flags`].
        flags: String,
    },
    /// A generation could not be saved, or its line could not be written.
    #[error(
        "{source}; generations up to {saved} are saved; continue the run with: snakes --no-render --resume {}{flags}",
        folder.display()
    )]
    NotSaved {
        /// Error of the file or the output that could not be written.
        source: Box<HeadlessError>,
        /// Number of saved generations.
        saved: u32,
        /// Folder of the run.
        folder: PathBuf,
        /// Command-line flags that choose the run's evaluator: see [`Evaluator::flags`].
        flags: String,
    },
    /// The simulation of a saved genome panicked.
    #[error("{}: simulating its genome failed: {message}", path.display())]
    Crashed {
        /// File of the genome.
        path: PathBuf,
        /// Message of the panic.
        message: String,
    },
    /// A plot could not be drawn.
    #[error(transparent)]
    Plot(#[from] crate::plot::PlotError),
    /// The interrupt key was pressed.
    #[error("cancelled; {}", match kept {
        Some(path) => format!("the best so far is saved to {}", path.display()),
        None => "nothing was finished, so nothing is saved".to_owned(),
    })]
    Cancelled {
        /// File with what was finished; `None` if nothing was.
        kept: Option<PathBuf>,
    },
    /// A replay differs from its record.
    #[error("{path}: replay differs from the record: {difference}")]
    Differs {
        /// File of the champion.
        path: PathBuf,
        /// Difference in words, with a possible reason.
        difference: String,
    },
    /// A judge could not examine a champion.
    #[error(transparent)]
    Judge(JudgeError),
    /// Every agent of every generation was disqualified.
    #[error("no champion: every snake of every generation was disqualified")]
    NoChampion,
}

impl From<JudgeError> for HeadlessError {
    fn from(error: JudgeError) -> Self {
        match error {
            JudgeError::Cancelled => Self::Cancelled { kept: None },
            other => Self::Judge(other),
        }
    }
}

impl HeadlessError {
    /// Adds to a cancellation the file with what was finished, if the file exists.
    pub fn keeping(self, file: &Path) -> Self {
        match self {
            Self::Cancelled { .. } => {
                Self::Cancelled { kept: file.exists().then(|| file.to_owned()) }
            }
            other => other,
        }
    }
}

/// Evolves a run to its end and prints a line per generation to `out`, beginning with the generations of earlier sessions. Each
/// generation is saved before its line is printed.
///
/// # Errors
/// See [`HeadlessError`]. The folder is opened before the first evaluation.
pub fn evolve(
    source: RunSource,
    evaluator: &dyn Evaluator,
    json: bool,
    control: &RunControl,
    out: &mut dyn Write,
) -> Result<(), HeadlessError> {
    let RunPlan { preset, seed, founder, .. } = source.plan.clone();
    let run = source.open("snakes --no-render")?;
    let RecordedRun { mut experiment, mut recorder, reports, .. } = run;
    let folder = recorder.folder().to_owned();
    let settings = experiment.settings().into_owned();
    let generations = settings.evolution.generations;
    let bodies_vary = settings.genome.bodies.vary;
    let earlier = match reports.len() {
        0 => String::new(),
        _ if experiment.is_over() => "; already finished (--restart starts over)".to_owned(),
        finished => format!("; continues after generation {finished}"),
    };
    let founder = founder.map(|founder| format!(", from {}", founder.name()));
    let from = founder.unwrap_or_default();
    say(&format!(
        "preset {preset}, seed {seed}{from}: generations {generations}, population {}, {}{earlier}",
        settings.evolution.population,
        evaluator.place()
    ));
    if !recorder.changes().is_empty() {
        say(&format!("changed during the run: {}", list_changes(recorder.changes())));
    }
    if !json {
        write_line(out, TABLE_HEAD)?;
    }
    let (mut landing, mut simulations) = (Landing::default(), Some(0));
    let mut print = |report: &GenerationReport| {
        simulations = simulations.zip(report.simulations).map(|(all, of)| all + of);
        let first = landing.add(report);
        let line = match json {
            true => report_json(report, first, bodies_vary).to_string(),
            false => table_row(report),
        };
        write_line(out, &line)?;
        out.flush()
    };
    reports.iter().try_for_each(&mut print)?;
    drop(reports);
    while !experiment.is_over() {
        let record = |generation, individual, evaluation: &_| {
            recorder.record_evaluation(generation, individual, evaluation);
        };
        let report = run_generation_with_bar(&mut experiment, evaluator, control, record);
        let finished = experiment.finished();
        let report = report.map_err(|Cancelled| HeadlessError::Stopped {
            finished,
            generations: experiment.next_plan().most_generations_in_words(),
            folder: folder.clone(),
            flags: evaluator.flags(),
        })?;
        let not_saved = |source: HeadlessError, saved| HeadlessError::NotSaved {
            source: Box::new(source),
            saved,
            folder: folder.clone(),
            flags: evaluator.flags(),
        };
        let crashes = recorder.record_generation(&experiment, &report);
        let crashes = crashes.map_err(|source| not_saved(source.into(), finished - 1))?;
        crashes.iter().for_each(|crash| say(crash));
        print(&report).map_err(|source| not_saved(source.into(), finished))?;
    }
    let run_hash = format!("{:016x}", experiment.run_hash());
    let best = experiment.best();
    if json {
        let last = json!({
            "type": "done",
            "run_hash": run_hash,
            "first_landing": landing.first,
            "evaluations": landing.spent,
            "simulations": simulations,
            "best": best.map(|best| short(best.evaluation.fitness)),
            "champion": recorder.best(),
        });
        write_line(out, &last.to_string())?;
    } else if let (Some(best), Some(path)) = (best, recorder.best()) {
        write_line(out, "")?;
        write_line(out, &format!("champion  {}", about(best)))?;
        write_line(out, &format!("saved to  {}", path.display()))?;
        let trials = simulations.map(|all| format!(" in {all} simulations"));
        let trials = trials.unwrap_or_default();
        write_line(out, &format!("evaluated {} snakes{trials}", landing.spent))?;
        if let Some(first) = landing.first {
            write_line(out, &format!("landing   first reached by evaluation {first}"))?;
        }
        write_line(out, &format!("run hash  {run_hash}"))?;
    }
    best.map(|_| ()).ok_or(HeadlessError::NoChampion)
}

/// Lists changes of settings in a line. Of more than six, only the latest are named.
fn list_changes(changes: &[SettingChange]) -> String {
    const MAX_LISTED: usize = 6;
    let left_out = changes.len().saturating_sub(MAX_LISTED);
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

/// Finds the first individual that ends on the landing, in the order of all evaluations.
#[derive(Debug, Default)]
struct Landing {
    /// Number of evaluations so far.
    spent: u64,
    /// Number of the evaluation of that individual in the run; the first evaluation is 1. `None` before it.
    first: Option<u64>,
}

impl Landing {
    /// Adds a generation. Returns the number of its first evaluation on the landing, counted over the run.
    fn add(&mut self, report: &GenerationReport) -> Option<u64> {
        let number = report.first_on_landing.map(|index| self.spent + u64::from(index) + 1);
        self.first = self.first.or(number);
        self.spent += u64::from(report.evaluations);
        number
    }
}

const TABLE_HEAD: &str =
    "generation     mean     best   median  std.dev.  disqualified  mean in words";

fn table_row(report: &GenerationReport) -> String {
    let generation = report.generation;
    let disqualified = report.disqualified;
    let numbers = match report.statistics {
        Some(s) => format!("{:>9.2}{:>9.2}{:>9.2}{:>10.2}", s.mean, s.best, s.median, s.std),
        None => format!("{:>9}{:>9}{:>9}{:>10}", "-", "-", "-", "-"),
    };
    format!("{generation:>10}{numbers}{disqualified:>14}  {}", report.meaning)
}

/// Returns a generation as a line of JSON. `first_landing` is the number of its first evaluation that ended on the landing, counted
/// over the run.
fn report_json(report: &GenerationReport, first_landing: Option<u64>, bodies_vary: bool) -> Value {
    let statistics = report.statistics;
    let mut line = json!({
        "type": "generation",
        "generation": report.generation,
        "mean": statistics.map(|s| s.mean),
        "best": statistics.map(|s| with_short_numbers(&s.best.into())),
        "median": statistics.map(|s| s.median),
        "std": statistics.map(|s| s.std),
        "worst": statistics.map(|s| with_short_numbers(&s.worst.into())),
        "disqualified": report.disqualified,
        "crashed": report.crashed,
        "on_landing": report.on_landing,
        "first_landing": first_landing,
        "evaluations": report.evaluations,
        "simulations": report.simulations,
        "elapsed_s": report.elapsed_s,
        "meaning": report.meaning,
        "hash": format!("{:016x}", report.hash),
    });
    if !report.species.is_empty() {
        let (list, number) = if bodies_vary { ("bodies", "blocks") } else { ("species", "id") };
        let of = |species: &SpeciesCount| json!({number: species.id, "size": species.size, "best": species.best.map(short)});
        line[list] = report.species.iter().map(of).collect();
    }
    if !report.endings.is_empty() {
        let of = |count: &BandCount<EndingKind>| json!({"ending": count.id, "size": count.size, "best": count.best.map(short)});
        line["endings"] = report.endings.iter().map(of).collect();
    }
    if let Some(Rung { rise_m, successes }) = report.rung {
        line["rung"] = json!({"rise_m": short(rise_m), "successes": successes});
    }
    if let Some(StairsCount { rounds, all, active, solved, challenges }) = report.stairs {
        line["stairs"] = json!({
            "rounds": rounds, "all": all, "active": active, "solved": solved, "challenges": challenges,
        });
    }
    line
}

/// Describes a champion in one line.
fn about(champion: &Champion) -> String {
    format!(
        "{} (generation {}, snake {})",
        champion.reached(),
        champion.origin.generation,
        champion.origin.individual + 1,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::evolve::{GenerationRecord, Statistics};
    use snakes_core::score::Trial;

    fn report() -> GenerationReport {
        let statistics = Statistics {
            mean: -7.225,
            best: 1.5,
            median: -7.0,
            std: 0.25,
            worst: -9.0,
            mean_centre_y_m: -7.225,
            lower_quartile: None,
            upper_quartile: None,
        };
        let record = GenerationRecord {
            disqualified: 12,
            statistics: Some(statistics),
            ..GenerationRecord::of_test(1, 500)
        };
        GenerationReport::of_record(record, None, &Trial::default())
    }

    #[test]
    fn the_first_on_the_landing_is_counted_over_generations() {
        let mut landing = Landing::default();
        for (evaluations, first_on_landing) in [(50, None), (50, Some(7)), (50, Some(0))] {
            let mut report = report();
            report.record.evaluations = evaluations;
            report.record.first_on_landing = first_on_landing;
            landing.add(&report);
        }
        assert_eq!(landing.first, Some(58));
    }

    #[test]
    fn table_rows_align_with_the_head() {
        let report = report();
        let row = table_row(&report);
        for (number, column) in [("-7.22", "mean"), ("1.50", "best"), ("12", "disqualified")] {
            let end_of = |line: &str, word: &str| line.find(word).map(|at| at + word.len());
            assert_eq!(end_of(&row, number), end_of(TABLE_HEAD, column), "{row}\n{TABLE_HEAD}");
        }
        assert_eq!(row.find(&report.meaning), TABLE_HEAD.find("mean in words"));
    }
}
