//! Examines champions in the background, and writes the results into their files.

use std::fmt::Display;
use std::path::PathBuf;
use std::sync::Arc;

use crate::studio::ui::notifications::Notices;
use snakes_core::save::library::SavePlace;
use snakes_core::save::{LoadedChampion, exam_in_words, load_champion, store_exam};
use snakes_core::score::ExamSuite;
use snakes_lab::run::exam::{exam_trials, examine};
use snakes_lab::run::{BackgroundTask, LocalPool, RunControl};

/// Subject of messages about an exam, which replace each other.
const SUBJECT: &str = "exam";

/// An exam of several champions in progress.
#[derive(Debug)]
pub(super) struct Examination {
    names: Vec<String>,
    /// Number of trials of each champion.
    trials: u32,
    control: Arc<RunControl>,
    work: BackgroundTask<Vec<ExamOutcome>>,
}

/// Results of a champion in one line, or an error in one line; `None` after a cancellation.
type ExamOutcome = Option<Result<String, String>>;

impl Examination {
    /// Begins to examine the champions at these places with all suites. Built-in champions are skipped. Returns `None`
    /// if no champion is left.
    ///
    /// # Errors
    /// A file cannot be read, a champion was recorded by another engine version, or no thread can be started.
    pub fn begin(places: &[SavePlace]) -> Result<Option<Self>, String> {
        let load = |(place, path): (&SavePlace, PathBuf)| {
            let loaded = load_champion(&path)?;
            let (name, engine) = (place.shown_name(), &loaded.engine);
            match loaded.is_of_this_engine() {
                true => Ok((name, (path, loaded))),
                false => Err(format!("{name} moves differently here: engine {engine} recorded it")),
            }
        };
        let files = places.iter().filter_map(|place| Some((place, place.path()?.to_owned())));
        let champions = files.map(load).collect::<Result<Vec<_>, String>>()?;
        let (names, champions): (Vec<String>, Vec<_>) = champions.into_iter().unzip();
        let Some((_, first)) = champions.first() else { return Ok(None) };
        let trials = exam_trials(&first.champion, &ExamSuite::USUAL);
        let control = Arc::new(RunControl::default());
        let shared = Arc::clone(&control);
        let failed = |error: &dyn Display| format!("The exam could not be started: {error}");
        let pool = LocalPool::new(1).map_err(|error| failed(&error))?;
        let work = BackgroundTask::start_counted(champions.len(), move |progress| {
            let each = |(path, loaded): (PathBuf, LoadedChampion)| {
                let results = examine(&loaded.champion, &ExamSuite::USUAL, &pool, &shared).ok()?;
                let stored = store_exam(&path, &loaded, &results).map_err(String::from);
                progress.count_one();
                Some(stored.map(|()| exam_in_words(&results).unwrap_or_default()))
            };
            champions.into_iter().map(each).collect()
        });
        let work = work.map_err(|error| failed(&error))?;
        Ok(Some(Self { names, trials, control, work }))
    }

    /// Describes the progress with the champion that is being examined. Also returns the finished share of all champions, from 0 to 1.
    pub fn progress(&self) -> (String, f32) {
        let index = self.work.done().min(self.names.len() - 1);
        let done = self.control.done().min(self.trials);
        let words = format!("Examining {}: {done} of {} trials", self.names[index], self.trials);
        let share = (index as f32 + done as f32 / self.trials as f32) / self.names.len() as f32;
        (words, share)
    }

    /// Cancels the exam. The results of finished champions are kept.
    pub fn cancel(&self) {
        self.control.cancel();
    }

    /// Shows a message about the results as soon as they are available. Returns whether they are.
    pub fn report(&self, notices: &mut Notices) -> bool {
        let Some(result) = self.work.poll() else { return false };
        match result {
            Ok(outcomes) => self.report_outcomes(outcomes, notices),
            Err(problem) => notices.problem(format!("The exam ended with an error: {problem}")),
        }
        true
    }

    fn report_outcomes(&self, outcomes: Vec<ExamOutcome>, notices: &mut Notices) {
        let (mut finished, mut cancelled) = (Vec::new(), 0);
        for (name, outcome) in self.names.iter().zip(outcomes) {
            match outcome {
                Some(Ok(results)) => finished.push((name, results)),
                Some(Err(problem)) => notices.problem(problem),
                None => cancelled += 1,
            }
        }
        let mut said = match finished.as_slice() {
            [] => String::new(),
            [(name, results)] => format!("Exam of {name}: {results}."),
            several => {
                format!("{} champions examined; their details show the results.", several.len())
            }
        };
        if cancelled > 0 {
            said.push_str(" The exam was cancelled.");
        }
        if !said.is_empty() {
            notices.update(SUBJECT, said.trim().to_owned());
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::studio::commands::library::LibraryCommand;
    use crate::studio::state::library::tests::Tried;
    use snakes_core::save::load_champion;
    use snakes_core::score::ExamSuite;

    #[test]
    fn an_exam_shows_its_progress_and_can_be_cancelled() {
        let mut tried = Tried::new(&["a", "b"]);
        let places = vec![tried.place("a"), tried.place("b")];
        tried.apply(&LibraryCommand::Examine(places.clone())).expect("begun");
        let (words, share) = tried.library.exam_under_way().expect("under way");
        assert!(words.starts_with("Examining a: ") && share < 0.5, "{words} {share}");
        let refusal = tried.apply(&LibraryCommand::Examine(places)).expect_err("in progress");
        assert!(refusal.contains("in progress"), "{refusal}");
        tried.apply(&LibraryCommand::Cancel).expect("cancelled");
        while tried.library.exam_under_way().is_some() {
            tried.take_in();
        }
        assert_eq!(tried.notices.last(), Some("The exam was cancelled."));
        let path = tried.folder.path().join("b.ron");
        assert!(load_champion(&path).expect("read").exam.is_empty());
    }

    #[test]
    #[ignore = "takes about ten seconds: cargo test --release --bin snakes the_results_of_an_exam_are -- --ignored"]
    fn the_results_of_an_exam_are_written_into_the_file() {
        let mut tried = Tried::new(&["a"]);
        let a = tried.place("a");
        tried.apply(&LibraryCommand::Examine(vec![a])).expect("begun");
        while tried.library.exam_under_way().is_some() {
            tried.take_in();
        }
        let path = tried.folder.path().join("a.ron");
        let exam = load_champion(&path).expect("read").exam;
        // A gait has no senses to be taken away.
        assert_eq!(exam.len(), ExamSuite::USUAL.len() - 1);
    }
}
