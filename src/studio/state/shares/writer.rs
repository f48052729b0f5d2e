//! The process that writes a file: this program as `snakes export`.

use std::ffi::OsString;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{ChildStdin, Command, Stdio};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use snakes_core::evolve::Champion;
use snakes_core::save::ChampionCopies;
use snakes_lab::run::BackgroundTask;

/// Holds the standard input of the process. Closing the input cancels the process.
#[derive(Debug, Default)]
pub struct Leash(Mutex<LeashState>);

#[derive(Debug, Default)]
struct LeashState {
    input: Option<ChildStdin>,
    is_cut: bool,
    /// Expected size of the file, in bytes.
    expected: Option<u64>,
    /// Time at which the first part of the file was finished, and the finished share then.
    first: Option<(Instant, f64)>,
}

impl Leash {
    /// Cancels the process, even if it has not started yet.
    pub fn cut(&self) {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        (state.input, state.is_cut) = (None, true);
    }

    /// Returns whether the process was cancelled.
    pub fn is_cut(&self) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).is_cut
    }

    /// Returns the expected size of the file, in bytes, if it is known.
    pub fn expected_bytes(&self) -> Option<u64> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).expected
    }

    /// Estimates the time until the file is finished, of which this share is finished now.
    pub fn time_left(&self, share: f64) -> Option<Duration> {
        let state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (begun, before) = state.first.filter(|(_, before)| share > before + 0.02)?;
        Some(begun.elapsed().mul_f64((1.0 - share).max(0.0) / (share - before)))
    }

    /// Notes what the process says about its work.
    fn note(&self, said: &Said) {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match said {
            Said::Progress(share) if *share > 0.0 => {
                state.first.get_or_insert((Instant::now(), *share));
            }
            // If a smaller file is written instead, the time begins anew.
            Said::Progress(_) => state.first = None,
            Said::Expected(bytes) => state.expected = Some(*bytes),
            Said::Saved(_) => {}
        }
    }

    fn hold(&self, input: Option<ChildStdin>) {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !state.is_cut {
            state.input = input;
        }
    }
}

/// Writes champions to a file. `arguments` are those of `snakes export`, apart from the champions. Passes the finished
/// share, from 0 to 1, to `show`. Returns the path of the written file or folder.
pub fn written(
    (leash, arguments): (&Leash, &[OsString]),
    champions: &[(String, Champion)],
    show: impl Fn(f64),
) -> Result<PathBuf, String> {
    let copies = ChampionCopies::of(champions)?;
    let failed = |error: std::io::Error| format!("The file could not be written: {error}.");
    let program = std::env::current_exe().map_err(failed)?;
    let mut process = Command::new(program)
        .arg("export")
        .args(copies.paths())
        .args(arguments)
        .args(["--json", "--until-input-ends"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(failed)?;
    leash.hold(process.stdin.take());
    // Errors are read at the same time as the output. A process whose errors fill the pipe, such as those of a driver,
    // would otherwise block for ever.
    let errors = process.stderr.take().map(BackgroundTask::start_reading).transpose();
    let mut saved = None;
    let lines = process.stdout.take().into_iter().flat_map(|out| BufReader::new(out).lines());
    for line in lines.map_while(Result::ok) {
        let said = said(&line);
        said.iter().for_each(|said| leash.note(said));
        match said {
            Some(Said::Progress(share)) => show(share),
            Some(Said::Saved(path)) => saved = Some(path),
            Some(Said::Expected(_)) | None => {}
        }
    }
    let ended = process.wait().map_err(failed)?;
    let errors = errors.map_err(failed)?.map(|errors| errors.wait().unwrap_or_default());
    saved.filter(|_| ended.success()).ok_or_else(|| problem(&errors.unwrap_or_default()))
}

/// A line of the process's output.
#[derive(Debug, PartialEq)]
enum Said {
    /// Finished share of the file, from 0 to 1.
    Progress(f64),
    /// Expected size of the file, in bytes.
    Expected(u64),
    /// Path of the written file or folder.
    Saved(PathBuf),
}

fn said(line: &str) -> Option<Said> {
    let value: serde_json::Value = serde_json::from_str(line).ok()?;
    let progress = value["progress"].as_f64().map(Said::Progress);
    let said = progress.or_else(|| value["bytes"].as_u64().map(Said::Expected));
    said.or_else(|| Some(Said::Saved(value["saved"].as_str()?.into())))
}

/// Returns the error in the last line of the process's error output, as a sentence.
fn problem(errors: &str) -> String {
    let last = errors.lines().rev().find_map(|line| line.strip_prefix("error: "));
    let reason = last.unwrap_or("the program that writes it ended early");
    let mut letters = reason.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string());
    format!("Not shared. {}{}.", first.unwrap_or_default(), letters.as_str().trim_end_matches('.'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_progress_and_of_the_result_are_understood_and_others_are_not() {
        assert_eq!(said(r#"{"progress":0.25}"#), Some(Said::Progress(0.25)));
        assert_eq!(said(r#"{"type":"expected","bytes":7}"#), Some(Said::Expected(7)));
        assert_eq!(said(r#"{"saved":"/a/b.gif"}"#), Some(Said::Saved("/a/b.gif".into())));
        for line in ["", "saved to b.gif", r#"{"saved":3}"#, "[1]"] {
            assert_eq!(said(line), None, "{line}");
        }
    }

    #[test]
    fn the_last_error_is_shown_as_a_sentence() {
        let errors = "a warning\nerror: b.mp4: cannot be written\n";
        assert_eq!(problem(errors), "Not shared. B.mp4: cannot be written.");
        assert!(problem("").ends_with("ended early."));
    }

    #[test]
    fn a3_the_expected_size_and_the_time_left_are_known_while_the_file_is_written() {
        let leash = Leash::default();
        leash.note(&Said::Progress(0.0));
        leash.note(&Said::Expected(6_100_000));
        assert_eq!((leash.expected_bytes(), leash.time_left(0.5)), (Some(6_100_000), None));
        leash.note(&Said::Progress(0.2));
        std::thread::sleep(Duration::from_millis(30));
        let left = leash.time_left(0.6).expect("known");
        // As long as the second third, of which at least 30 ms have passed.
        assert!(left >= Duration::from_millis(30) && left < Duration::from_secs(20), "{left:?}");
        assert!(leash.time_left(0.9).expect("known") < left);
    }
}
