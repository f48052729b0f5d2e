//! Time that saved champions take to open: to be read, checked, and ready for their first step.
//!
//!     cargo test --release --test it opening -- --ignored --nocapture
//!
//! `SNAKES_OPENING=FOLDER` measures the champions in another folder, including its subfolders.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use snakes_core::save::load_champion;
use snakes_core::score::Rollout;

/// Number of times that each file is opened. The median counts.
const OPENINGS: usize = 20;
/// Maximum median time. A user does not notice a wait this short.
const LONGEST: Duration = Duration::from_millis(100);
/// Maximum size of a file, in bytes.
const LARGEST: u64 = 1024 * 1024;

/// Returns the files ending in `.ron` in a folder and its subfolders, in order.
fn saves_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    let below = |path: PathBuf| match path.is_dir() {
        true => saves_in(&path),
        false => vec![path],
    };
    let is_save = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "ron");
    paths.into_iter().flat_map(below).filter(is_save).collect()
}

/// Returns the median time from the path of a champion to the first step of its trial; `None` for a file of another kind.
fn median_opening(path: &Path) -> Option<Duration> {
    let text = fs::read_to_string(path).expect("a text");
    if !text.contains("kind: \"snakes-and-stairs champion\"") {
        return None;
    }
    let open = |_| {
        let start = Instant::now();
        let champion = load_champion(path).expect("a champion").champion;
        let rollout = Rollout::new(&champion.genome, &champion.trial);
        assert_eq!(rollout.step(), 0);
        start.elapsed()
    };
    let mut times: Vec<Duration> = (0..OPENINGS).map(open).collect();
    times.sort();
    Some(times[OPENINGS / 2])
}

#[test]
#[ignore = "measures time: run it in a release build"]
fn every_save_is_small_and_opens_at_once() {
    let shipped = || Path::new(env!("CARGO_MANIFEST_DIR")).join("saves");
    let folder = std::env::var_os("SNAKES_OPENING").map_or_else(shipped, PathBuf::from);
    let mut slow = Vec::new();
    for path in saves_in(&folder) {
        let Some(median) = median_opening(&path) else { continue };
        let bytes = fs::metadata(&path).expect("a file").len();
        let name = path.strip_prefix(&folder).unwrap_or(&path).display().to_string();
        println!("{name:60} {bytes:8} bytes {:7.2} ms", median.as_secs_f64() * 1e3);
        if median >= LONGEST || bytes > LARGEST {
            slow.push(name);
        }
    }
    assert!(slow.is_empty(), "{LONGEST:?} or more, or larger than {LARGEST} bytes: {slow:?}");
}
