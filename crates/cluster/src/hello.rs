//! Notices that workers and coordinators send once a second about themselves.

use serde::{Deserialize, Serialize};

use super::names::check_name;
use super::wire::{WireError, parse_line};
use snakes_core::check::{Invalid, hash_of, quoted, within};
use snakes_core::schema::Choices;
use snakes_core::{ENGINE_VERSION, Processors};

/// Maximum size of a notice, in bytes.
const LARGEST_NOTICE: usize = 4096;

/// Maximum size of the line about a trouble, in bytes.
pub const LONGEST_TROUBLE: usize = 500;

/// Notice of a worker, sent once a second.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WorkerNotice {
    /// Format of the messages.
    pub format: u32,
    /// Name of the worker, which no other worker has.
    pub worker: String,
    /// Name of the worker's computer.
    pub host: String,
    /// Version of the worker's engine.
    pub engine: u32,
    /// Kind of the worker's processors.
    pub processors: Processors,
    /// Proof of the worker's engine: a hash of the bits that it computes in some short cases.
    pub proof: String,
    /// Number of the worker's threads, from 1 to 1024.
    pub threads: u32,
    /// Number of the worker's evaluations since it started.
    pub evaluations: u64,
    /// Evaluations per second over the last five seconds.
    pub per_s: f32,
    /// Number of batches that the worker received after the server had delivered them before.
    pub redelivered: u64,
    /// Why the worker waits for the server, as one line of at most 500 bytes; `None` if it does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trouble: Option<String>,
    /// Whether the worker was stopped, so that this notice is its last.
    pub leaves: bool,
}

/// Notice of a coordinator about its run, sent once a second.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunNotice {
    /// Format of the messages.
    pub format: u32,
    /// Name of the run.
    pub run: String,
    /// Name of the coordinator's computer.
    pub host: String,
    /// Version of the coordinator's engine.
    pub engine: u32,
    /// Kind of the coordinator's processors.
    pub processors: Processors,
    /// Proof of the coordinator's engine: a hash of the bits that it computes in some short cases.
    pub proof: String,
    /// Number of tasks without a result.
    pub pending: u64,
    /// Number of results so far.
    pub results: u64,
    /// Names of the workers that were set aside because they sent other bits.
    pub set_aside: Vec<String>,
    /// Why the run waits for the server, as one line of at most 500 bytes; `None` if it does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trouble: Option<String>,
}

/// Describes an engine and its proof in words.
fn engine_words(engine: u32, processors: Processors, proof: &str) -> String {
    format!("engine {engine} on {} ({proof})", processors.choice().name)
}

/// Describes the engine of this program in words.
pub fn own_engine(proof: &str) -> String {
    engine_words(ENGINE_VERSION, Processors::THIS, proof)
}

/// Returns the name of this computer, at most 40 characters; all but letters and digits become hyphens.
pub fn host_name() -> String {
    let name = gethostname::gethostname();
    let plain = name.to_string_lossy();
    let plain: String =
        plain.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).take(40).collect();
    if plain.is_empty() { "computer".to_owned() } else { plain }
}

/// Returns a random name for a worker of this computer, which no other worker has.
pub fn unique_name() -> String {
    format!("{}-{:08x}", host_name(), random_number() as u32)
}

/// Returns a number that differs between processes, from the random keys of the standard library's hashes. It is used
/// only where it cannot change a result.
pub fn random_number() -> u64 {
    use std::hash::{BuildHasher, RandomState};
    RandomState::new().hash_one(std::process::id())
}

impl WorkerNotice {
    /// Reads a notice and checks every value.
    ///
    /// # Errors
    /// The notice is damaged, too large, or a value is not allowed.
    pub fn read(bytes: &[u8]) -> Result<Self, WireError> {
        let notice: Self = parse_line(text_of(bytes)?)?;
        check_name("worker", &notice.worker)?;
        check_name("host", &notice.host)?;
        hash_of("proof", &notice.proof)?;
        within("threads", notice.threads, 1..=1024)?;
        within("per_s", notice.per_s, 0.0..=1.0e9)?;
        check_trouble(notice.trouble.as_deref())?;
        Ok(notice)
    }

    /// Describes the worker's engine in words.
    pub fn engine_words(&self) -> String {
        engine_words(self.engine, self.processors, &self.proof)
    }
}

impl RunNotice {
    /// Reads a notice and checks every value.
    ///
    /// # Errors
    /// The notice is damaged, too large, or a value is not allowed.
    pub fn read(bytes: &[u8]) -> Result<Self, WireError> {
        let notice: Self = parse_line(text_of(bytes)?)?;
        check_name("run", &notice.run)?;
        check_name("host", &notice.host)?;
        hash_of("proof", &notice.proof)?;
        notice.set_aside.iter().try_for_each(|worker| check_name("set_aside", worker))?;
        check_trouble(notice.trouble.as_deref())?;
        Ok(notice)
    }

    /// Describes the coordinator's engine in words.
    pub fn engine_words(&self) -> String {
        engine_words(self.engine, self.processors, &self.proof)
    }
}

/// Checks the line about a trouble, which is shown to people.
fn check_trouble(line: Option<&str>) -> Result<(), Invalid> {
    let line = line.unwrap_or_default();
    within("length of trouble", line.len(), 0..=LONGEST_TROUBLE)?;
    match line.contains(char::is_control) {
        true => Err(Invalid::new("trouble", quoted(line), "a line without control characters")),
        false => Ok(()),
    }
}

fn text_of(bytes: &[u8]) -> Result<&str, WireError> {
    if bytes.len() > LARGEST_NOTICE {
        return Err(WireError::TooLarge);
    }
    std::str::from_utf8(bytes).map_err(|error| WireError::Damaged(error.to_string()))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::wire::{WIRE_FORMAT, line_of};

    /// Returns a notice of a worker with the engine of this program.
    pub fn notice(worker: &str, threads: u32, proof: &str) -> WorkerNotice {
        WorkerNotice {
            format: WIRE_FORMAT,
            worker: worker.to_owned(),
            host: "computer".to_owned(),
            engine: ENGINE_VERSION,
            processors: Processors::THIS,
            proof: proof.to_owned(),
            threads,
            evaluations: 10,
            per_s: 2.5,
            redelivered: 0,
            trouble: None,
            leaves: false,
        }
    }

    /// Returns a notice of a run with the engine of this program.
    pub fn run_notice(run: &str, host: &str) -> RunNotice {
        RunNotice {
            format: WIRE_FORMAT,
            run: run.to_owned(),
            host: host.to_owned(),
            engine: ENGINE_VERSION,
            processors: Processors::THIS,
            proof: "0123456789abcdef".to_owned(),
            pending: 1,
            results: 0,
            set_aside: Vec::new(),
            trouble: None,
        }
    }

    #[test]
    fn a_notice_is_read_as_it_was_written_and_a_hostile_one_is_refused() {
        let notice = notice("w-1", 4, "0123456789abcdef");
        let text = line_of(&notice);
        assert_eq!(WorkerNotice::read(text.as_bytes()), Ok(notice));
        for (from, to, problem) in [
            ("w-1", "w.>", "worker is \"w.>\""),
            ("\"threads\":4", "\"threads\":0", "threads is 0; allowed: 1 to 1024"),
            ("2.5", "-1.0", "per_s is -1; allowed"),
            ("0123456789abcdef", "x", "proof is \"x\""),
            ("\"leaves\"", "\"trouble\":\"\\u001b[31m\",\"leaves\"", "trouble is "),
            (
                "\"leaves\"",
                &format!("\"trouble\":\"{}\",\"leaves\"", "x".repeat(501)),
                "length of trouble is 501",
            ),
        ] {
            let error = WorkerNotice::read(text.replace(from, to).as_bytes()).expect_err("refused");
            assert!(error.to_string().contains(problem), "{error}");
        }
        assert_eq!(WorkerNotice::read(&[b' '; LARGEST_NOTICE + 1]), Err(WireError::TooLarge));
    }
}
