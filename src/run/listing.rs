//! Looking through a folder of saves on a thread of its own: there may be many, and the disk may be slow.

use std::sync::mpsc::{Receiver, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;

use crate::save::{RunSummary, SavesFolder};

/// A look at the runs in a folder that is under way.
#[derive(Debug)]
pub struct Listing(Mutex<Receiver<Vec<RunSummary>>>);

impl Listing {
    /// Begins to look.
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn start(saves: SavesFolder) -> std::io::Result<Self> {
        let (sender, found) = channel();
        // Nobody may be waiting any more.
        let look = move || drop(sender.send(saves.runs()));
        thread::Builder::new().name("listing".to_owned()).spawn(look)?;
        Ok(Self(Mutex::new(found)))
    }

    /// What was found, once it is known.
    pub fn poll(&self) -> Option<Vec<RunSummary>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).try_recv().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{RunPlan, Settings};
    use crate::run::RunSource;
    use crate::save::Earlier;
    use std::time::Duration;

    #[test]
    fn it_finds_the_runs_and_leaves_out_what_is_none() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        for seed in [2, 1] {
            let plan = RunPlan::new("test", seed, Settings::default());
            let source = RunSource::in_saves(&saves, plan, Earlier::Keep);
            source.open("a test").expect("opened");
        }
        std::fs::create_dir(folder.path().join("no run")).expect("created");
        std::fs::create_dir(folder.path().join("damaged")).expect("created");
        std::fs::write(folder.path().join("damaged/run.ron"), "(").expect("written");
        let listing = Listing::start(saves).expect("a thread");
        let found = std::iter::repeat_with(|| {
            thread::sleep(Duration::from_millis(2));
            listing.poll()
        });
        let found = found.take(5000).flatten().next().expect("found in time");
        let seeds: Vec<u64> = found.iter().map(|run| run.plan.seed).collect();
        assert_eq!(seeds, [1, 2]);
        assert!(found.iter().all(RunSummary::is_stopped));
    }
}
