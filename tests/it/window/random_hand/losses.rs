//! Checks that a random hand has lost nothing: every save and run is readable, and still in its place or among the deleted ones.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, SystemTime};

use snakes_core::save::{
    PreferencesFile, SavedProgress, load_champion, load_plan, load_preset, parse_champion,
};
use xxhash_rust::xxh3::xxh3_64;

use crate::program::snakes;

/// Beginning of the names of files that are not complete yet.
const UNFINISHED: &str = ".unfinished-";
/// Time within which a resumed run must report a generation; after it, the run is interrupted.
const RESUMED_FOR: Duration = Duration::from_secs(4);

/// Contents of a folder of saves.
#[derive(Debug)]
pub struct Inventory {
    taken: SystemTime,
    /// Identities of the files outside runs, except notes, which may change: see [`identity`].
    files: BTreeMap<u64, PathBuf>,
    /// Folders of each run, by the hash of its plan. A run may have been copied.
    runs: BTreeMap<u64, Vec<RunContents>>,
}

#[derive(Debug, Clone)]
struct RunContents {
    folder: PathBuf,
    /// Time at which the run began, or began again.
    begun: SystemTime,
    generations: usize,
    /// Hashes of the champions of the run's generations.
    champions: BTreeSet<u64>,
}

impl Inventory {
    /// Lists a folder of saves, in which the program may be working. Files that vanish meanwhile are left out.
    pub fn of(saves: &Path) -> Self {
        let (taken, files, runs) = (SystemTime::now(), BTreeMap::new(), BTreeMap::new());
        let mut inventory = Self { taken, files, runs };
        inventory.add(saves);
        inventory
    }

    fn add(&mut self, folder: &Path) {
        if let Ok(plan) = fs::read(folder.join("run.ron")) {
            if let Some(contents) = RunContents::of(folder) {
                self.runs.entry(xxh3_64(&plan)).or_default().push(contents);
            }
            return;
        }
        for path in entries(folder).into_iter().filter(|path| !has_prefix(path, UNFINISHED)) {
            if path.is_dir() {
                self.add(&path);
            } else if path.extension().is_none_or(|ending| ending != "about")
                && let Ok(bytes) = fs::read(&path)
                // An empty file reserves a name while another one is moved there.
                && !bytes.is_empty()
            {
                self.files.insert(identity(&path, &bytes), path);
            }
        }
    }

    /// Returns the number of files outside runs, and the number of runs.
    pub fn counts(&self) -> (usize, usize) {
        (self.files.len(), self.runs.len())
    }

    /// Fails if something of an earlier inventory is missing. A run may have fewer generations only if it has begun again
    /// meanwhile, which writes its plan again.
    pub fn assert_keeps(&self, earlier: &Self) {
        for (hash, path) in &earlier.files {
            assert!(self.files.contains_key(hash), "lost: {}", path.display());
        }
        for (plan, before) in &earlier.runs {
            let now = self.runs.get(plan).map_or(&[][..], Vec::as_slice);
            for before in before {
                let is_kept = |now: &RunContents| {
                    let has_all = now.generations >= before.generations
                        && now.champions.is_superset(&before.champions);
                    has_all || now.begun > earlier.taken
                };
                assert!(now.iter().any(is_kept), "lost of a run: {before:?}, now {now:?}");
            }
        }
    }

    /// Reads every champion, preset and run, and resumes each run without a window. `damaged` are the hashes of files that were
    /// damaged from the start.
    pub fn assert_readable(&self, saves: &Path, damaged: &[u64]) {
        for (hash, path) in &self.files {
            let is_champion = path.extension().is_some_and(|ending| ending == "ron");
            if !is_champion || damaged.contains(hash) {
                continue;
            }
            if path.parent().is_some_and(|folder| folder.ends_with("presets")) {
                load_preset(&path.to_string_lossy()).expect("a readable preset");
                continue;
            }
            let champion = load_champion(path).expect("a readable champion");
            if champion.is_of_this_engine() {
                let replay = snakes(saves, "replay --no-render").arg(path).output();
                let replay = replay.expect("the program starts");
                let said = String::from_utf8_lossy(&replay.stderr);
                assert!(replay.status.success(), "{}: {said}", path.display());
            }
        }
        for contents in self.runs.values().flatten() {
            let plan = load_plan(&contents.folder).expect("a readable plan");
            let progress = SavedProgress::read(&contents.folder, &plan);
            let read = progress.unwrap_or_else(|error| panic!("{error}")).records.len();
            assert_eq!(read, contents.generations, "{}", contents.folder.display());
            resume(&contents.folder);
        }
    }
}

impl RunContents {
    fn of(folder: &Path) -> Option<Self> {
        let begun = fs::metadata(folder.join("run.ron")).ok()?.modified().ok()?;
        let log = fs::read_to_string(folder.join("log.jsonl")).unwrap_or_default();
        // The last line may be half written while the program runs.
        let generations = log.split_inclusive('\n').filter(|line| line.ends_with("\"}\n")).count();
        let champions = entries(folder).into_iter().filter(|path| has_prefix(path, "generation-"));
        let champions = champions.filter_map(|path| Some(xxh3_64(&fs::read(path).ok()?)));
        let champions = champions.collect();
        Some(Self { folder: folder.to_owned(), begun, generations, champions })
    }
}

/// Resumes a run without a window until it has reported a line, and interrupts it.
fn resume(folder: &Path) {
    let mut command = snakes(folder, "--no-render --json --threads 2 --resume .");
    let mut child =
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
    let lines = BufReader::new(child.stdout.take().expect("piped")).lines();
    let (sender, reported) = mpsc::channel();
    let reader = thread::spawn(move || {
        for line in lines.map_while(Result::ok) {
            // Only the first line is awaited, so a later line may fail to be sent.
            let _ = sender.send(line);
        }
    });
    // A generation of a slow run may take longer; the run is then interrupted within it.
    let _ = reported.recv_timeout(RESUMED_FOR);
    let process = child.id().to_string();
    // The process may have ended by itself.
    let _ = Command::new("kill").args(["-INT", &process]).stderr(Stdio::null()).status();
    let mut said = String::new();
    child.stderr.take().expect("piped").read_to_string(&mut said).expect("text");
    let status = child.wait().expect("ended");
    reader.join().expect("read");
    let is_well = status.success() || said.contains("error: cancelled");
    assert!(is_well, "{} resumed: {status}\n{said}", folder.display());
}

/// Fails if an incomplete file or the record of a crash is left, or if the preferences cannot be read.
pub fn assert_tidy(folder: &Path, preferences: &Path) {
    for path in entries(folder) {
        for wrong in [UNFINISHED, "crashed-", ".tmp"] {
            assert!(!has_prefix(&path, wrong), "left behind: {}", path.display());
        }
        let is_unreadable = path.extension().is_some_and(|ending| ending == "unreadable");
        assert!(!is_unreadable, "put aside: {}", path.display());
        if path.is_dir() {
            assert_tidy(&path, preferences);
        }
    }
    PreferencesFile::at(preferences).load().expect("readable").expect("written");
}

/// Returns a hash of what a file must keep: of a champion the champion itself, because an exam adds results to its file; of any other
/// file all bytes.
fn identity(path: &Path, bytes: &[u8]) -> u64 {
    let is_champion = path.extension().is_some_and(|ending| ending == "ron");
    let text = std::str::from_utf8(bytes).ok().filter(|_| is_champion);
    match text.and_then(|text| parse_champion(path, text).ok()) {
        Some(loaded) => xxh3_64(format!("{:?}", loaded.champion).as_bytes()),
        None => xxh3_64(bytes),
    }
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}

fn has_prefix(path: &Path, prefix: &str) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(prefix))
}
