//! Reading the library on a thread of its own: there may be ten thousand saves, and the disk may be slow.
//!
//! Names come first, all at once; then what stands in each of them, those that somebody is looking at before the
//! others. What has not changed since it was read is not read again.

use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use super::caught;
use crate::save::SavesFolder;
use crate::save::library::{Details, Entry, Place, list, read_entry};

/// What was found out.
#[derive(Debug, Clone, PartialEq)]
pub enum Reading {
    /// What there is, by names.
    Listed(Vec<Entry>),
    /// The folder cannot be read, and why.
    NotListed(String),
    /// What stands in an entry, or what is wrong with it.
    Read(Place, Result<Details, String>),
    /// There is nothing left to read for now; since the start the folder was looked at so often.
    Done(u64),
}

/// Somebody who reads the library, and reads it again when asked to. Dropping it ends that.
#[derive(Debug)]
pub struct Librarian {
    desk: Arc<Desk>,
    /// Behind a lock so that a window may keep this where several threads can see it.
    readings: Mutex<Receiver<Reading>>,
}

/// Where wishes are left.
#[derive(Debug, Default)]
struct Desk {
    wishes: Mutex<Wishes>,
    has_wishes: Condvar,
}

#[derive(Debug, Default)]
struct Wishes {
    /// List the folder, for it may have changed.
    look_again: bool,
    /// How often that was asked for.
    looks: u64,
    /// Read these before all others, the last first.
    urgent: Vec<Place>,
    is_closed: bool,
}

impl Wishes {
    fn look(&mut self) {
        self.look_again = true;
        self.looks += 1;
    }
}

impl Desk {
    fn wishes(&self) -> MutexGuard<'_, Wishes> {
        self.wishes.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Librarian {
    /// Begins to read a folder of saves.
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn start(saves: SavesFolder) -> std::io::Result<Self> {
        let desk = Arc::new(Desk::default());
        desk.wishes().look();
        let (sender, readings) = channel();
        let worker = Worker {
            desk: Arc::clone(&desk),
            saves,
            sender,
            known: BTreeMap::new(),
            unread: Vec::new(),
            looks: 0,
        };
        thread::Builder::new().name("librarian".to_owned()).spawn(move || worker.work())?;
        Ok(Self { desk, readings: Mutex::new(readings) })
    }

    /// Asks for these to be read before all others, the first first.
    pub fn hurry(&self, mut places: Vec<Place>) {
        places.reverse();
        self.desk.wishes().urgent = places;
        self.desk.has_wishes.notify_one();
    }

    /// Asks for the folder to be looked at again.
    pub fn look_again(&self) {
        self.desk.wishes().look();
        self.desk.has_wishes.notify_one();
    }

    /// What was found out since, in its order, but not more at once than `most`.
    pub fn poll(&self, most: usize) -> Vec<Reading> {
        let readings = self.readings.lock().unwrap_or_else(PoisonError::into_inner);
        readings.try_iter().take(most).collect()
    }

    /// What is found out until there is nothing left to read, for somebody who has time.
    pub fn wait(&self) -> Vec<Reading> {
        let readings = self.readings.lock().unwrap_or_else(PoisonError::into_inner);
        let mut found = Vec::new();
        while let Ok(reading) = readings.recv() {
            // Whoever asked for another look meanwhile waits for that one.
            let is_last = reading == Reading::Done(self.desk.wishes().looks);
            found.push(reading);
            if is_last {
                break;
            }
        }
        found
    }
}

impl Drop for Librarian {
    fn drop(&mut self) {
        self.desk.wishes().is_closed = true;
        self.desk.has_wishes.notify_one();
    }
}

/// The librarian's thread.
struct Worker {
    desk: Arc<Desk>,
    saves: SavesFolder,
    sender: Sender<Reading>,
    /// What is listed, and whether it has been read as it is now.
    known: BTreeMap<Place, (Entry, bool)>,
    /// What is left to read, the last first.
    unread: Vec<Place>,
    /// Of how many wishes to look at the folder it has heard.
    looks: u64,
}

/// What is to be done next.
enum Next {
    List,
    Read(Place),
    Rest,
    Close,
}

impl Worker {
    fn work(mut self) {
        let mut has_told = false;
        loop {
            let told = match self.next() {
                Next::Close => return,
                Next::List => {
                    has_told = false;
                    self.list()
                }
                Next::Read(place) => self.read(&place),
                Next::Rest if has_told => {
                    let wishes = self.desk.wishes();
                    let is_idle = |wishes: &mut Wishes| {
                        !wishes.look_again && wishes.urgent.is_empty() && !wishes.is_closed
                    };
                    drop(self.desk.has_wishes.wait_while(wishes, is_idle));
                    continue;
                }
                Next::Rest => {
                    has_told = true;
                    Some(Reading::Done(self.looks))
                }
            };
            // Nobody may be waiting any more.
            if told.is_some_and(|told| self.sender.send(told).is_err()) {
                return;
            }
        }
    }

    fn next(&mut self) -> Next {
        let mut wishes = self.desk.wishes();
        if wishes.is_closed {
            return Next::Close;
        }
        if std::mem::take(&mut wishes.look_again) {
            self.looks = wishes.looks;
            return Next::List;
        }
        let is_unread = |place: &Place| self.known.get(place).is_some_and(|(_, is_read)| !is_read);
        let urgent = std::iter::from_fn(|| wishes.urgent.pop()).find(is_unread);
        let next = urgent.or_else(|| std::iter::from_fn(|| self.unread.pop()).find(is_unread));
        next.map_or(Next::Rest, Next::Read)
    }

    fn list(&mut self) -> Option<Reading> {
        let entries = match list(&self.saves) {
            Ok(entries) => entries,
            Err(error) => return Some(Reading::NotListed(error.to_string())),
        };
        let before = std::mem::take(&mut self.known);
        for entry in &entries {
            let is_same = |(known, is_read): &(Entry, bool)| *is_read && known == entry;
            let is_read = before.get(&entry.place).is_some_and(is_same);
            self.known.insert(entry.place.clone(), (entry.clone(), is_read));
        }
        let unread = self.known.iter().rev().filter(|(_, (_, is_read))| !is_read);
        self.unread = unread.map(|(place, _)| place.clone()).collect();
        Some(Reading::Listed(entries))
    }

    fn read(&mut self, place: &Place) -> Option<Reading> {
        if let Some((_, is_read)) = self.known.get_mut(place) {
            *is_read = true;
        }
        let read = caught(|| read_entry(place).map_err(|error| error.to_string()));
        Some(Reading::Read(place.clone(), read.unwrap_or_else(Err)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::{shipped_champion, store_champion};
    use std::path::Path;
    use std::time::{Duration, Instant};

    fn champion(folder: &Path, name: &str) -> Place {
        let path = folder.join(format!("{name}.ron"));
        let loaded = shipped_champion().expect("well formed");
        store_champion(&path, &loaded.champion, loaded.recording.as_ref()).expect("written");
        Place::Champion(path)
    }

    /// The names of what was read from files.
    fn read(readings: &[Reading]) -> Vec<String> {
        let of = readings.iter().filter_map(|reading| match reading {
            Reading::Read(place, _) if place.path().is_some() => Some(place.name()),
            _ => None,
        });
        of.collect()
    }

    #[test]
    fn names_come_first_then_each_entry_and_only_what_has_changed_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        for name in ["a", "b", "c"] {
            champion(folder.path(), name);
        }
        std::fs::write(folder.path().join("broken.ron"), "(").expect("written");
        let librarian = Librarian::start(saves).expect("a thread");
        let readings = librarian.wait();
        assert!(matches!(&readings[0], Reading::Listed(entries) if entries.len() > 4));
        assert_eq!(read(&readings), ["a", "b", "broken", "c"]);
        let problems = readings.iter().filter(|of| matches!(of, Reading::Read(_, Err(_))));
        assert_eq!(problems.count(), 1);
        std::fs::write(folder.path().join("b.ron"), "now broken too").expect("written");
        champion(folder.path(), "d");
        librarian.look_again();
        assert_eq!(read(&librarian.wait()), ["b", "d"]);
    }

    #[test]
    fn who_is_looked_at_is_read_before_the_others() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        let names: Vec<String> = (100..300).map(|number| number.to_string()).collect();
        champion(folder.path(), "100");
        for name in &names[1..] {
            std::fs::copy(folder.path().join("100.ron"), folder.path().join(format!("{name}.ron")))
                .expect("copied");
        }
        let librarian = Librarian::start(saves).expect("a thread");
        let last = Place::Champion(folder.path().join("299.ron"));
        librarian.hurry(vec![last]);
        let read = read(&librarian.wait());
        let place = read.iter().position(|name| name == "299").expect("read");
        // By the time of the wish some may have been read.
        assert!(place < 150, "read as number {place}");
        assert_eq!(read.len(), 200);
    }

    #[test]
    fn who_is_dropped_reads_no_further() {
        let folder = tempfile::tempdir().expect("a folder");
        let librarian = Librarian::start(SavesFolder::find(Some(folder.path()))).expect("a thread");
        let desk = Arc::clone(&librarian.desk);
        drop(librarian);
        let started = Instant::now();
        // Its thread lets go of the desk when it ends.
        while Arc::strong_count(&desk) > 1 {
            assert!(started.elapsed() < Duration::from_secs(60), "it goes on and on");
            thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn a_folder_that_cannot_be_read_is_said() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        std::fs::write(&file, "").expect("written");
        let librarian = Librarian::start(SavesFolder::find(Some(&file))).expect("a thread");
        let readings = librarian.wait();
        assert!(matches!(&readings[0], Reading::NotListed(why) if why.contains("cannot be read")));
    }
}
