//! Reading another run's log on a thread of its own: it may be long, and the disk may be slow.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;

use crate::evolve::RunPlan;
use crate::save::{GenerationRecord, load_log};

/// What was read: the run and its generations, or what is wrong with them.
type Read = Result<(RunPlan, Vec<GenerationRecord>), String>;

/// The log of a run that is on its way.
#[derive(Debug)]
pub struct LogReading(Mutex<Receiver<Read>>);

impl LogReading {
    /// Begins to read the log in a run's folder.
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn start(folder: PathBuf) -> std::io::Result<Self> {
        let (sender, read) = channel();
        // Nobody may be waiting any more.
        let look = move || drop(sender.send(load_log(&folder).map_err(|error| error.to_string())));
        thread::Builder::new().name("reading".to_owned()).spawn(look)?;
        Ok(Self(Mutex::new(read)))
    }

    /// What was read, once it is there.
    pub fn poll(&self) -> Option<Read> {
        match self.0.lock().unwrap_or_else(PoisonError::into_inner).try_recv() {
            Ok(read) => Some(read),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                Some(Err("The log could not be read: the program failed on it".to_owned()))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;
    use crate::run::{Control, RunSource, pool};
    use crate::save::{Earlier, SavesFolder};
    use std::time::Duration;

    fn read(folder: PathBuf) -> Read {
        let reading = LogReading::start(folder).expect("a thread");
        let read = std::iter::repeat_with(|| {
            thread::sleep(Duration::from_millis(2));
            reading.poll()
        });
        read.take(5000).flatten().next().expect("read in time")
    }

    #[test]
    fn it_reads_the_log_alone_and_says_what_is_wrong_with_a_damaged_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        let mut settings = Settings::default();
        settings.evolution.population = 4;
        settings.trial.duration_s = 0.5;
        let plan = RunPlan::new("test", 1, settings);
        let source = RunSource::in_saves(&saves, plan.clone(), Earlier::Keep);
        let path = source.folder.clone();
        let mut run = source.open("a test").expect("opened");
        let pool = pool(1).expect("a pool");
        let report = run.experiment.run_generation(&pool, &Control::default()).expect("done");
        run.keeper.keep(&run.experiment, &report).expect("kept");
        let (found, records) = read(path.clone()).expect("a run");
        assert_eq!((found, records), (plan, vec![report.record()]));
        let log = path.join("log.jsonl");
        let text = std::fs::read_to_string(&log).expect("read");
        std::fs::write(&log, text.replace("\"evaluations\":4", "\"evaluations\":5"))
            .expect("written");
        let problem = read(path).expect_err("damaged");
        assert!(problem.contains("log.jsonl: damaged"), "{problem}");
        let problem = read(folder.path().join("none")).expect_err("nothing there");
        assert!(problem.contains("cannot be read"), "{problem}");
    }
}
