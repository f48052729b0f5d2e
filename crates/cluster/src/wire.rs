//! Messages with batches of tasks or of results: a head as a line of JSON, then a line for each task or result.

use std::sync::Arc;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::names::check_name;
use super::packing::{pack, unpack};
use snakes_core::check::{Invalid, hash_of, within};

/// Version of the message format. A worker with another format has another proof, so it receives no such messages: see
/// [`super::proof`].
pub const WIRE_FORMAT: u32 = 1;
/// Maximum number of tasks in a batch.
pub const MOST_TASKS: usize = 256;

/// Why a message cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum WireError {
    /// The message is longer than the format allows.
    #[error("the message is too large")]
    TooLarge,
    /// The message is damaged or of another kind. Holds the reason.
    #[error("the message is damaged: {0}")]
    Damaged(String),
    /// A value is not allowed.
    #[error(transparent)]
    Invalid(#[from] Invalid),
}

/// Kind of the tasks in a batch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TaskKind {
    /// Scoring: each task is a genome, and the batch shares a trial.
    Score,
    /// Exam: each task is a condition, and the batch shares a genome.
    Examine,
}

/// A task, or the outcome of a task, as text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TaskText {
    /// Hash of everything that decides the task's result: see [`task_key`].
    pub key: u64,
    /// The genome, the condition or the outcome as JSON, on one line.
    pub text: Arc<str>,
}

/// A batch of tasks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WorkBatch {
    /// Name of the run.
    pub run: String,
    /// Number of the batch in its run. Checks have the number 0.
    pub batch: u64,
    /// Kind of the tasks.
    pub kind: TaskKind,
    /// Hash of the trial or the genome that the tasks share. A worker requests it from the coordinator.
    pub shared: u64,
    /// Tasks of the batch, at most `MOST_TASKS`.
    pub tasks: Vec<TaskText>,
}

/// The results of a batch.
#[derive(Debug, Clone, PartialEq)]
pub struct ResultBatch {
    /// Name of the run.
    pub run: String,
    /// Number of the batch in the run.
    pub batch: u64,
    /// Name of the worker that computed the batch.
    pub worker: String,
    /// Time that the computation took, in s.
    pub elapsed_s: f64,
    /// Key and outcome of each task. The outcome is JSON on one line.
    pub outcomes: Vec<TaskText>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WorkHead {
    format: u32,
    run: String,
    batch: u64,
    kind: TaskKind,
    shared: String,
    keys: Vec<String>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ResultHead {
    format: u32,
    run: String,
    batch: u64,
    worker: String,
    elapsed_s: f64,
    keys: Vec<String>,
}

/// Returns the hash of the trial or the genome that the tasks of a batch share.
pub fn shared_hash(kind: TaskKind, text: &str) -> u64 {
    let mut hash = Xxh3Default::new();
    hash.update(&[kind as u8]);
    hash.update(text.as_bytes());
    hash.digest()
}

/// Returns the hash of everything that decides the result of a task: its text, and the hash of what it shares.
pub fn task_key(shared: u64, text: &str) -> u64 {
    let mut hash = Xxh3Default::new();
    hash.update(&shared.to_le_bytes());
    hash.update(text.as_bytes());
    hash.digest()
}

/// Formats a hash as 16 hexadecimal digits.
pub fn hex(hash: u64) -> String {
    format!("{hash:016x}")
}

/// Writes a value as a line of JSON. Only a map whose keys are not text would fail, and no message contains such a map.
pub fn line_of<T: Serialize>(value: &T) -> String {
    serde_json::to_string(value).unwrap_or_default()
}

/// Reads a value from a line of JSON.
pub fn parse_line<T: DeserializeOwned>(line: &str) -> Result<T, WireError> {
    // The error's text quotes names from the message, which may contain control characters.
    let damaged = |error: serde_json::Error| error.to_string().replace(char::is_control, " ");
    serde_json::from_str(line).map_err(|error| WireError::Damaged(damaged(error)))
}

impl WorkBatch {
    /// Encodes the batch as the bytes of a message.
    pub fn encode(&self) -> Vec<u8> {
        let head = WorkHead {
            format: WIRE_FORMAT,
            run: self.run.clone(),
            batch: self.batch,
            kind: self.kind,
            shared: hex(self.shared),
            keys: keys_of(&self.tasks),
        };
        pack(joined(line_of(&head), &self.tasks))
    }

    /// Reads a batch from the bytes of a message.
    ///
    /// # Errors
    /// The message is damaged, too large, or of another format.
    pub fn decode(bytes: &[u8]) -> Result<Self, WireError> {
        let text = unpack(bytes)?;
        let (head, lines) = split(&text)?;
        let WorkHead { format, run, batch, kind, shared, keys } = parse_line(head)?;
        within("format", format, WIRE_FORMAT..=WIRE_FORMAT)?;
        check_name("run", &run)?;
        let shared = hash_of("shared", &shared)?;
        let tasks = tasks_of(&keys, lines)?;
        for task in &tasks {
            let key = task_key(shared, &task.text);
            within("key", task.key, key..=key)?;
        }
        Ok(Self { run, batch, kind, shared, tasks })
    }
}

impl ResultBatch {
    /// Encodes the results as the bytes of a message.
    pub fn encode(&self) -> Vec<u8> {
        let head = ResultHead {
            format: WIRE_FORMAT,
            run: self.run.clone(),
            batch: self.batch,
            worker: self.worker.clone(),
            elapsed_s: self.elapsed_s,
            keys: keys_of(&self.outcomes),
        };
        pack(joined(line_of(&head), &self.outcomes))
    }

    /// Reads results from the bytes of a message. Their outcomes stay text, which is read when the kind of the tasks is
    /// known.
    ///
    /// # Errors
    /// The message is damaged, too large, or of another format.
    pub fn decode(bytes: &[u8]) -> Result<Self, WireError> {
        let text = unpack(bytes)?;
        let (head, lines) = split(&text)?;
        let ResultHead { format, run, batch, worker, elapsed_s, keys } = parse_line(head)?;
        within("format", format, WIRE_FORMAT..=WIRE_FORMAT)?;
        check_name("run", &run)?;
        check_name("worker", &worker)?;
        within("elapsed_s", elapsed_s, 0.0..=1.0e6)?;
        let outcomes = tasks_of(&keys, lines)?;
        Ok(Self { run, batch, worker, elapsed_s, outcomes })
    }
}

fn keys_of(tasks: &[TaskText]) -> Vec<String> {
    tasks.iter().map(|task| hex(task.key)).collect()
}

fn joined(head: String, tasks: &[TaskText]) -> String {
    let mut text = head;
    for task in tasks {
        text.push('\n');
        text.push_str(&task.text);
    }
    text
}

/// Splits a message into its head and the lines of its tasks.
fn split(text: &str) -> Result<(&str, Vec<&str>), WireError> {
    let mut lines = text.split('\n');
    let head = lines.next().unwrap_or_default();
    let lines: Vec<&str> = lines.take(MOST_TASKS + 1).collect();
    within("number of tasks", lines.len(), 1..=MOST_TASKS)?;
    Ok((head, lines))
}

fn tasks_of(keys: &[String], lines: Vec<&str>) -> Result<Vec<TaskText>, WireError> {
    within("number of keys", keys.len(), lines.len()..=lines.len())?;
    let task = |(key, line): (&String, &str)| {
        Ok(TaskText { key: hash_of("key", key)?, text: line.into() })
    };
    keys.iter().zip(lines).map(task).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn work() -> WorkBatch {
        let task = |text: &str| TaskText { key: task_key(7, text), text: text.into() };
        WorkBatch {
            run: "climb-seed1".to_owned(),
            batch: 3,
            kind: TaskKind::Score,
            shared: 7,
            tasks: vec![task("{\"a\":1}"), task("{\"b\":2.5}")],
        }
    }

    #[test]
    fn a_batch_is_read_as_it_was_written() {
        assert_eq!(WorkBatch::decode(&work().encode()), Ok(work()));
        let results = ResultBatch {
            run: "climb-seed1".to_owned(),
            batch: 3,
            worker: "w1".to_owned(),
            elapsed_s: 0.1,
            outcomes: work().tasks,
        };
        assert_eq!(ResultBatch::decode(&results.encode()), Ok(results));
    }

    #[test]
    fn a_damaged_batch_is_refused_with_field_value_and_range() {
        let text = String::from_utf8(work().encode()).expect("text");
        for (from, to, problem) in [
            ("\"format\":1", "\"format\":2", "format is 2; allowed: 1"),
            ("climb-seed1", "climb.>", "run is \"climb.>\"; allowed: 1 to 100"),
            ("\"batch\":3", "\"batch\":-3", "damaged: invalid value: integer `-3`"),
            ("score", "scores", "unknown variant `scores`"),
            ("\"b\":2.5", "\"b\":2.6", "key is "),
            ("0000000000000007", "7", "shared is \"7\"; allowed: 16 hexadecimal digits"),
            ("\n{\"b\":2.5}", "", "number of keys is 2; allowed: 1"),
            ("{\"format\"", "{\"more\":1,\"format\"", "unknown field `more`"),
        ] {
            let changed = text.replace(from, to);
            assert_ne!(changed, text, "{from}");
            let error = WorkBatch::decode(changed.as_bytes()).expect_err("refused").to_string();
            assert!(error.contains(problem), "{error}");
        }
        let many = format!("{text}{}", "\n{}".repeat(MOST_TASKS));
        assert!(WorkBatch::decode(many.as_bytes()).is_err());
        assert!(WorkBatch::decode(b"").is_err());
    }
}
