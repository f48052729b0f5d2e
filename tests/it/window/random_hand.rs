//! A random hand: clicks, drags, keys, texts, scrolls and resizes from a seed, in the real window, while a run evolves.
//!
//!     cargo test --release --test it random_hand -- --ignored --nocapture
//!
//! `SNAKES_HAND_SEED` changes the seed, `SNAKES_HAND_ACTIONS` the number of actions. The choices depend on the controls that the
//! window shows at each moment, so a seed repeats a session only as far as the machine is equally fast. A failure therefore reports
//! its last actions.

mod actions;
mod losses;

use std::collections::{BTreeSet, VecDeque};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Child;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use super::display::Studio;
use super::{folder, json_lines};
use actions::{Action, RandomHand, SCREEN, USUAL_SIZE};
use losses::{Inventory, assert_tidy};

/// Arguments of a run that lasts for the whole session and is slow enough to leave the processor to the window.
const ARGUMENTS: &str = "--preset quick --population 20 --generations 1000 --duration 5 --threads 1 \
                         --saves saves --preferences preferences/studio.ron";
/// Number of latest actions that a failure reports.
const TOLD: usize = 30;
/// Number of actions between two inventories.
const BETWEEN_INVENTORIES: u32 = 250;
/// Time after which a window without a new frame counts as hung. Ten snakes in software rendering take a second.
const HUNG: Duration = Duration::from_secs(60);
/// Pause after an action of a hurried hand.
const HURRY: Duration = Duration::from_millis(25);

/// Parts of log lines that are no faults, each with the reason.
const HARMLESS: [(&str, &str); 8] = [
    ("error setting XSETTINGS", "a bare display has no daemon for settings"),
    ("only supports software rendering", "the driver of the tests does"),
    (
        "TEXTURE_BINDING_ARRAY is not supported",
        "nor has it this feature, for which the panels have a substitute",
    ),
    (
        "to the clipboard manager",
        "a bare display has none; what was copied is lost with the window",
    ),
    ("notifications: not done: ", "the answer to a command that cannot be followed at that moment"),
    ("No such file or directory", "a typed path leads nowhere, or its save was just deleted"),
    (": in use by process", "the run that evolves can be neither deleted nor exported"),
    ("certifiably insane", "a display without a screen has no size in millimetres"),
];

#[test]
fn a_short_random_hand_breaks_and_loses_nothing() {
    play("random-hand", 1, 220);
}

#[test]
#[ignore = "ten thousand actions take half an hour; run it by hand"]
fn a_long_random_hand_breaks_and_loses_nothing() {
    let number = |name: &str, default: u32| {
        std::env::var(name).map_or(default, |text| text.parse().expect("a whole number"))
    };
    play(
        "random-hand-long",
        number("SNAKES_HAND_SEED", 1).into(),
        number("SNAKES_HAND_ACTIONS", 10_000),
    );
}

/// Performs `count` random actions in the window, and checks the results.
fn play(test: &str, seed: u64, count: u32) {
    let folder = Arc::new(folder());
    let saves = folder.path().join("saves");
    let damaged = furnish(folder.path(), &saves);
    let open = || Studio::open_in(&folder, test, ARGUMENTS, USUAL_SIZE, SCREEN);
    let Some(mut studio) = open() else { return };
    let mut session = Session::new(seed, folder.path());
    let mut hand = RandomHand::new(seed);
    let mut tool = studio.xdotool_reader();
    let mut size = USUAL_SIZE;
    let mut inventories = vec![Inventory::of(&saves)];
    for number in 1..=count {
        let action = hand.act(&studio.places(), size);
        size = action.resized.unwrap_or(size);
        session.note(number, &action);
        if !send(&mut tool, &action, &studio.window) || !session.wait(&studio, action.frames) {
            session.end(&studio);
            // The old display ends before the new one begins, because only one window is open at a time.
            drop((studio, tool.wait()));
            inventories.push(Inventory::of(&saves));
            studio = open().expect("it opened before");
            (tool, size) = (studio.xdotool_reader(), USUAL_SIZE);
        }
        if number % BETWEEN_INVENTORIES == 0 {
            assert_no_fault(&studio.log());
            inventories.push(Inventory::of(&saves));
            session.tell_progress(number);
        }
    }
    // xdotool ends after its last commands, or with the window that the last action closed.
    tool.wait().expect("xdotool");
    // The first request asks if the random hand has left unfinished work, and then the second one quits.
    studio.xdotool(&["key", "ctrl+q"]);
    assert_eq!(studio.end(), Some(0), "{}", studio.log());
    assert_no_fault(&studio.log());
    drop(studio);
    let at_the_end = Inventory::of(&saves);
    inventories.iter().for_each(|earlier| at_the_end.assert_keeps(earlier));
    assert_tidy(folder.path(), &folder.path().join("preferences/studio.ron"));
    at_the_end.assert_readable(&saves, &damaged);
    session.tell(count, at_the_end.counts());
}

/// Fills a folder of saves: champions, one of them of another engine; a damaged file; a finished run and a stopped one. Returns the
/// hashes of the damaged files.
fn furnish(folder: &Path, saves: &Path) -> Vec<u64> {
    let run = "--no-render --json --preset quick --population 6 --generations 3 --duration 1 --saves saves";
    fs::create_dir(saves).expect("created");
    let finished = [7, 8].map(|seed| json_lines(folder, &format!("{run} --seed {seed}")));
    let champion = finished[1].last().and_then(|last| last["champion"].as_str());
    let log = folder.join(champion.expect("a path")).with_file_name("log.jsonl");
    let text = fs::read_to_string(&log).expect("a log");
    fs::write(&log, text.split_inclusive('\n').take(2).collect::<String>()).expect("written");
    let shipped = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/saves"));
    for name in ["climber", "robust"] {
        fs::copy(shipped.join(format!("{name}.ron")), saves.join(format!("my {name}.ron")))
            .expect("copied");
    }
    let elsewhere =
        include_str!("../../../saves/first-climber.ron").replace("engine: 3", "engine: 1");
    fs::write(saves.join("elsewhere.ron"), elsewhere).expect("written");
    let broken = "(kind: \"nothing\"";
    fs::write(saves.join("broken.ron"), broken).expect("written");
    vec![xxhash_rust::xxh3::xxh3_64(broken.as_bytes())]
}

/// Sends an action to xdotool. Returns false if xdotool has ended, as it does when the window is closed.
fn send(tool: &mut Child, action: &Action, window: &str) -> bool {
    let script = action.script.join("\n").replace("WINDOW", window) + "\n";
    tool.stdin.as_mut().expect("piped").write_all(script.as_bytes()).is_ok()
}

/// Fails on every line of the log that is not known to be harmless.
fn assert_no_fault(log: &str) {
    let is_harmless = |line: &&str| {
        HARMLESS.iter().any(|(part, _)| line.contains(part)) && !line.contains("cannot start")
    };
    let faults: Vec<&str> = log.lines().filter(|line| !is_harmless(line)).collect();
    assert!(faults.is_empty(), "the log has faults:\n{}", faults.join("\n"));
}

/// A record of the session, for the report and for a failure.
struct Session {
    seed: u64,
    folder: PathBuf,
    started: Instant,
    latest: VecDeque<String>,
    controls: BTreeSet<String>,
    restarts: u32,
    longest_wait: Duration,
}

impl Session {
    fn new(seed: u64, folder: &Path) -> Self {
        Self {
            seed,
            folder: folder.to_owned(),
            started: Instant::now(),
            latest: VecDeque::new(),
            controls: BTreeSet::new(),
            restarts: 0,
            longest_wait: Duration::ZERO,
        }
    }

    fn note(&mut self, number: u32, action: &Action) {
        let at = self.started.elapsed().as_secs_f64();
        self.latest.push_back(format!("{number} at {at:.1} s: {}", action.words));
        if self.latest.len() > TOLD {
            self.latest.pop_front();
        }
        self.controls.extend(action.control.clone());
    }

    /// Waits for frames. Returns false if the program has ended instead.
    fn wait(&mut self, studio: &Studio, frames: u64) -> bool {
        thread::sleep(HURRY);
        let (before, started) = (studio.frame(), Instant::now());
        while frames > 0 && studio.frame() < before + frames {
            if studio.ended().is_some() {
                return false;
            }
            assert!(started.elapsed() < HUNG, "no frame for {HUNG:?}: {:?}", studio.title());
            thread::sleep(HURRY);
        }
        self.longest_wait = self.longest_wait.max(started.elapsed());
        studio.ended().is_none()
    }

    /// Records an end of the program, which must be an orderly one.
    fn end(&mut self, studio: &Studio) {
        studio.wait(|| studio.ended().is_some(), || "the end of the program".to_owned());
        let (status, log) = (studio.ended(), studio.log());
        assert!(status.is_some_and(|status| status.success()), "it ended with {status:?}:\n{log}");
        assert_no_fault(&log);
        self.restarts += 1;
        self.latest.push_back("the program was quit and starts again".to_owned());
    }

    fn tell_progress(&self, number: u32) {
        report(&format!("{number} actions in {:.0} s", self.started.elapsed().as_secs_f64()));
    }

    fn tell(&self, count: u32, (files, runs): (usize, usize)) {
        report(&format!(
            "seed {}: {count} actions on {} controls in {:.0} s, {} restarts, {runs} runs and {files} other files \
             kept, longest wait for a frame {:.1} s",
            self.seed,
            self.controls.len(),
            self.started.elapsed().as_secs_f64(),
            self.restarts,
            self.longest_wait.as_secs_f64(),
        ));
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        if thread::panicking() {
            let latest: Vec<&str> = self.latest.iter().map(String::as_str).collect();
            report(&format!("seed {}, the last actions:\n{}", self.seed, latest.join("\n")));
            // Under another name the folder is not removed with the test.
            let kept = self.folder.with_extension("failed");
            if fs::rename(&self.folder, &kept).is_ok() {
                report(&format!("its files: {}", kept.display()));
            }
        }
    }
}

#[expect(
    clippy::print_stdout,
    reason = "the test runner shows it if the test fails or with --nocapture"
)]
fn report(text: &str) {
    println!("{text}");
}
