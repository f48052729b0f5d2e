//! Reads the library in the background, because it may have ten thousand saves on a slow disk.
//!
//! All names are listed first. Then the entries are read, requested entries before the others. Unchanged entries are not read
//! again.

use std::collections::BTreeMap;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use crossbeam_channel::{Receiver, Sender, unbounded};

use super::panics::caught;
use snakes_core::save::SavesFolder;
use snakes_core::save::library::{
    EntryDetails, EntryProblem, LibraryEntry, SavePlace, list, read_entry,
};

/// News about the library.
#[derive(Debug, Clone, PartialEq)]
pub enum LibraryEvent {
    /// All entries, by name.
    Listed(Vec<LibraryEntry>),
    /// The folder cannot be read. Holds the reason.
    NotListed(String),
    /// The contents of an entry, or why it cannot be read.
    Read(SavePlace, Result<EntryDetails, EntryProblem>),
    /// All entries are read. Holds the number of listings that were requested since the start.
    Done(u64),
}

/// A background thread that reads the library, and reads it again on request. Dropping the reader ends the thread.
#[derive(Debug)]
pub struct LibraryReader {
    queue: Arc<RequestQueue>,
    events: Receiver<LibraryEvent>,
}

#[derive(Debug, Default)]
struct RequestQueue {
    requests: Mutex<Requests>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Requests {
    /// Whether the folder is to be listed again.
    list: bool,
    /// Number of times that a listing was requested.
    listings: u64,
    /// Entries to read before all others. The next entry is the last in the list.
    urgent: Vec<SavePlace>,
    is_closed: bool,
}

impl Requests {
    fn list(&mut self) {
        self.list = true;
        self.listings += 1;
    }
}

impl RequestQueue {
    fn lock(&self) -> MutexGuard<'_, Requests> {
        self.requests.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl LibraryReader {
    /// Starts to read a folder of saves.
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn start(saves: SavesFolder) -> std::io::Result<Self> {
        let queue = Arc::new(RequestQueue::default());
        queue.lock().list();
        let (sender, events) = unbounded();
        let worker = LibraryWorker {
            queue: Arc::clone(&queue),
            saves,
            sender,
            known: BTreeMap::new(),
            unread: Vec::new(),
            listings: 0,
        };
        thread::Builder::new().name("library reader".to_owned()).spawn(move || worker.work())?;
        Ok(Self { queue, events })
    }

    /// Requests these entries to be read before all others, in this order. Replaces earlier requests.
    pub fn read_first(&self, mut places: Vec<SavePlace>) {
        places.reverse();
        self.queue.lock().urgent = places;
        self.queue.changed.notify_one();
    }

    /// Requests another listing of the folder.
    pub fn list_again(&self) {
        self.queue.lock().list();
        self.queue.changed.notify_one();
    }

    /// Returns at most `limit` new events, in order.
    pub fn poll(&self, limit: usize) -> Vec<LibraryEvent> {
        self.events.try_iter().take(limit).collect()
    }

    /// Blocks until all entries are read. Returns the events until then.
    pub fn wait(&self) -> Vec<LibraryEvent> {
        let mut events = Vec::new();
        while let Ok(event) = self.events.recv() {
            // If another listing was requested meanwhile, the loop waits for its end.
            let is_last = event == LibraryEvent::Done(self.queue.lock().listings);
            events.push(event);
            if is_last {
                break;
            }
        }
        events
    }
}

impl Drop for LibraryReader {
    fn drop(&mut self) {
        self.queue.lock().is_closed = true;
        self.queue.changed.notify_one();
    }
}

/// State of the reader's thread.
struct LibraryWorker {
    queue: Arc<RequestQueue>,
    saves: SavesFolder,
    sender: Sender<LibraryEvent>,
    /// The listed entries, each with whether its current version has been read.
    known: BTreeMap<SavePlace, (LibraryEntry, bool)>,
    /// Entries that are still to be read. The next entry is the last in the list.
    unread: Vec<SavePlace>,
    /// Number of listing requests that were served.
    listings: u64,
}

/// The next action of the reader's thread.
enum ReaderStep {
    List,
    Read(SavePlace),
    Rest,
    Close,
}

impl LibraryWorker {
    fn work(mut self) {
        let mut has_sent_done = false;
        loop {
            let event = match self.next() {
                ReaderStep::Close => return,
                ReaderStep::List => {
                    has_sent_done = false;
                    self.list()
                }
                ReaderStep::Read(place) => self.read(&place),
                ReaderStep::Rest if has_sent_done => {
                    let is_idle = |requests: &mut Requests| {
                        !requests.list && requests.urgent.is_empty() && !requests.is_closed
                    };
                    drop(self.queue.changed.wait_while(self.queue.lock(), is_idle));
                    continue;
                }
                ReaderStep::Rest => {
                    has_sent_done = true;
                    LibraryEvent::Done(self.listings)
                }
            };
            if self.sender.send(event).is_err() {
                // Sending failed because the reader was dropped.
                return;
            }
        }
    }

    fn next(&mut self) -> ReaderStep {
        let mut requests = self.queue.lock();
        if requests.is_closed {
            return ReaderStep::Close;
        }
        if std::mem::take(&mut requests.list) {
            self.listings = requests.listings;
            return ReaderStep::List;
        }
        let is_unread =
            |place: &SavePlace| self.known.get(place).is_some_and(|(_, is_read)| !is_read);
        let urgent = std::iter::from_fn(|| requests.urgent.pop()).find(is_unread);
        let next = urgent.or_else(|| std::iter::from_fn(|| self.unread.pop()).find(is_unread));
        next.map_or(ReaderStep::Rest, ReaderStep::Read)
    }

    fn list(&mut self) -> LibraryEvent {
        let entries = match list(&self.saves) {
            Ok(entries) => entries,
            Err(error) => return LibraryEvent::NotListed(error.to_string()),
        };
        let before = std::mem::take(&mut self.known);
        for entry in &entries {
            let is_same = |(known, is_read): &(LibraryEntry, bool)| *is_read && known == entry;
            let is_read = before.get(&entry.place).is_some_and(is_same);
            self.known.insert(entry.place.clone(), (entry.clone(), is_read));
        }
        let unread = self.known.iter().rev().filter(|(_, (_, is_read))| !is_read);
        self.unread = unread.map(|(place, _)| place.clone()).collect();
        LibraryEvent::Listed(entries)
    }

    fn read(&mut self, place: &SavePlace) -> LibraryEvent {
        if let Some((_, is_read)) = self.known.get_mut(place) {
            *is_read = true;
        }
        let read = caught(|| read_entry(place).map_err(EntryProblem::from));
        let read = read.unwrap_or_else(|panic| Err(EntryProblem::damaged(&panic)));
        LibraryEvent::Read(place.clone(), read)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::save::{shipped_champion, store_champion};
    use std::path::Path;
    use std::time::{Duration, Instant};

    fn champion(folder: &Path, name: &str) -> SavePlace {
        let path = folder.join(format!("{name}.ron"));
        let loaded = shipped_champion().expect("well formed");
        store_champion(&path, &loaded.champion, loaded.recording.as_ref()).expect("written");
        SavePlace::Champion(path)
    }

    /// Returns the names of the files that were read.
    fn read(events: &[LibraryEvent]) -> Vec<String> {
        let names = events.iter().filter_map(|event| match event {
            LibraryEvent::Read(place, _) if place.path().is_some() => Some(place.name()),
            _ => None,
        });
        names.collect()
    }

    #[test]
    fn names_come_first_then_entries_and_only_changed_entries_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        for name in ["a", "b", "c"] {
            champion(folder.path(), name);
        }
        std::fs::write(folder.path().join("broken.ron"), "(").expect("written");
        let reader = LibraryReader::start(saves).expect("a thread");
        let events = reader.wait();
        assert!(matches!(&events[0], LibraryEvent::Listed(entries) if entries.len() > 4));
        assert_eq!(read(&events), ["a", "b", "broken", "c"]);
        let problems = events.iter().filter(|event| matches!(event, LibraryEvent::Read(_, Err(_))));
        assert_eq!(problems.count(), 1);
        std::fs::write(folder.path().join("b.ron"), "now broken too").expect("written");
        champion(folder.path(), "d");
        reader.list_again();
        assert_eq!(read(&reader.wait()), ["b", "d"]);
    }

    #[test]
    fn requested_entries_are_read_before_the_others() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        let names: Vec<String> = (100..300).map(|number| number.to_string()).collect();
        champion(folder.path(), "100");
        for name in &names[1..] {
            std::fs::copy(folder.path().join("100.ron"), folder.path().join(format!("{name}.ron")))
                .expect("copied");
        }
        let reader = LibraryReader::start(saves).expect("a thread");
        let last = SavePlace::Champion(folder.path().join("299.ron"));
        reader.read_first(vec![last]);
        let read = read(&reader.wait());
        let place = read.iter().position(|name| name == "299").expect("read");
        // Some entries may have been read before the request.
        assert!(place < 150, "read as number {place}");
        assert_eq!(read.len(), 200);
    }

    #[test]
    fn dropping_the_reader_ends_its_thread() {
        let folder = tempfile::tempdir().expect("a folder");
        let reader =
            LibraryReader::start(SavesFolder::find(Some(folder.path()))).expect("a thread");
        let queue = Arc::clone(&reader.queue);
        drop(reader);
        let started = Instant::now();
        // The thread releases its handle when it ends.
        while Arc::strong_count(&queue) > 1 {
            assert!(started.elapsed() < Duration::from_secs(60), "the thread goes on");
            thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn an_unreadable_folder_is_reported() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        std::fs::write(&file, "").expect("written");
        let reader = LibraryReader::start(SavesFolder::find(Some(&file))).expect("a thread");
        let events = reader.wait();
        assert!(
            matches!(&events[0], LibraryEvent::NotListed(why) if why.contains("cannot be read"))
        );
    }
}
