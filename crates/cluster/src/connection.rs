//! The state of a connection, and the messages about it: a line when the connection is lost, a line when it is made
//! again, and a line for a request that keeps failing.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use async_nats::{ClientError, Event, ServerError};
use tokio::sync::watch;

use snakes_lab::run::headless::say;

/// Why a request to the server failed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Trouble {
    /// No answer came. A connection that is lost without notice looks the same.
    NoAnswer,
    /// The server refused the request. Holds the server's message.
    Refused(String),
}

/// The state of a connection to a server.
#[derive(Debug)]
pub struct ServerConnection {
    url: String,
    /// Number of times that the connection was made again after a loss.
    renewals: watch::Sender<u64>,
    state: Mutex<ConnectionState>,
}

#[derive(Debug, Default)]
struct ConnectionState {
    is_lost: bool,
    /// The latest message about rights since the connection was made, which is not repeated.
    told: Option<String>,
    /// Requests that currently fail, by the name of their task.
    failing: BTreeMap<&'static str, Failing>,
}

#[derive(Debug)]
struct Failing {
    since: Instant,
    is_told: bool,
}

/// The user is told of a request that has been refused for this long. A shorter refusal often ends by itself.
const PATIENCE_WITH_REFUSALS: Duration = Duration::from_secs(3);
/// The user is told of a request that has had no answer for this long, unless the connection is known to be lost by
/// then.
const PATIENCE_WITH_SILENCE: Duration = Duration::from_secs(20);
/// Parts of error messages which show that no answer came because the server stops, starts, or cannot be reached.
const NO_ANSWER: [&str; 7] = [
    "timed out",
    "broken pipe",
    "no responders",
    "Server Shutdown",
    "channel closed",
    "503",
    "EOF",
];

impl Trouble {
    /// Classifies an error of the NATS client.
    pub fn of(error: &dyn std::error::Error) -> Self {
        let words = one_line(error);
        match NO_ANSWER.iter().any(|part| words.contains(part)) {
            true => Self::NoAnswer,
            false => Self::Refused(words),
        }
    }
}

impl<E: std::error::Error> From<E> for Trouble {
    fn from(error: E) -> Self {
        Self::of(&error)
    }
}

impl fmt::Display for Trouble {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoAnswer => formatter.write_str("the server does not answer"),
            Self::Refused(words) => formatter.write_str(words),
        }
    }
}

impl ServerConnection {
    /// Creates the state of a connection before it is made for the first time.
    pub fn new(url: &str) -> Self {
        Self { url: url.to_owned(), renewals: watch::Sender::new(0), state: Mutex::default() }
    }

    /// Returns whether the connection is known to be lost.
    pub fn is_lost(&self) -> bool {
        self.state().is_lost
    }

    /// Returns a receiver that is notified each time the connection is made again.
    pub fn renewals(&self) -> watch::Receiver<u64> {
        self.renewals.subscribe()
    }

    /// Handles an event of the NATS client, and prints a line if the event is new to the user.
    pub fn on_event(&self, event: &Event) {
        if let Some(line) = self.line(event) {
            say(&format!("{}: {line}", self.url));
        }
    }

    fn line(&self, event: &Event) -> Option<String> {
        let mut state = self.state();
        match event {
            Event::Disconnected => {
                // Requests fail while the connection is lost; they need no lines of their own.
                state.failing.clear();
                let is_news = !std::mem::replace(&mut state.is_lost, true);
                is_news.then(|| "connection lost; waiting for the server".to_owned())
            }
            Event::Connected => {
                state.told = None;
                if !std::mem::replace(&mut state.is_lost, false) {
                    return None;
                }
                self.renewals.send_modify(|number| *number += 1);
                Some("connected again".to_owned())
            }
            Event::ServerError(ServerError::AuthorizationViolation) => {
                state.tell_once(NO_RIGHT.to_owned())
            }
            // Other errors of the server end the connection, which causes a separate event.
            Event::ServerError(ServerError::Other(words)) if words.contains("ermissions") => {
                state.tell_once(format!("the server says: {words}"))
            }
            Event::ClientError(ClientError::Other(words)) if words.contains("authorization") => {
                state.tell_once(NO_RIGHT.to_owned())
            }
            _ => None,
        }
    }

    /// Records that a request failed and will be repeated. `task` describes the failure in a few words.
    pub fn failed(&self, task: &'static str, trouble: &Trouble) {
        if self.is_to_be_told(task, trouble, Instant::now()) {
            say(&format!("{}: {task}: {trouble}; trying again", self.url));
        }
    }

    fn is_to_be_told(&self, task: &'static str, trouble: &Trouble, now: Instant) -> bool {
        let mut state = self.state();
        if state.is_lost {
            return false;
        }
        let failing = state.failing.entry(task).or_insert(Failing { since: now, is_told: false });
        let patience = match trouble {
            Trouble::NoAnswer => PATIENCE_WITH_SILENCE,
            Trouble::Refused(_) => PATIENCE_WITH_REFUSALS,
        };
        let is_due = now.duration_since(failing.since) >= patience;
        is_due && !std::mem::replace(&mut failing.is_told, true)
    }

    /// Records that a request succeeded.
    pub fn succeeded(&self, task: &'static str) {
        let failing = self.state().failing.remove(task);
        if failing.is_some_and(|failing| failing.is_told) {
            say(&format!("{}: {task}: over", self.url));
        }
    }

    fn state(&self) -> MutexGuard<'_, ConnectionState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Error message for credentials that the server refuses.
pub const NO_RIGHT: &str = "the server refuses the credentials (--creds FILE)";

impl ConnectionState {
    /// Returns the line, or `None` if it equals the line before.
    fn tell_once(&mut self, line: String) -> Option<String> {
        let is_news = self.told.as_ref() != Some(&line);
        self.told = Some(line.clone());
        is_news.then_some(line)
    }
}

/// Returns an error and its causes as one line.
pub fn one_line(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        let cause_text = cause.to_string();
        if !text.contains(&cause_text) {
            text = format!("{text}: {cause_text}");
        }
        source = cause.source();
    }
    text.replace(char::is_control, " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lost_connection_is_one_line_and_its_return_is_another() {
        let connection = ServerConnection::new("nats://a");
        let renewals = connection.renewals();
        assert_eq!(connection.line(&Event::Connected), None, "the first time");
        let lines = [
            Event::Disconnected,
            Event::Disconnected,
            Event::ClientError(ClientError::Other("nats: IO error".to_owned())),
            Event::ServerError(ServerError::Other("stale connection".to_owned())),
            Event::Connected,
            Event::Connected,
        ];
        let lines: Vec<String> = lines.iter().filter_map(|event| connection.line(event)).collect();
        assert_eq!(lines, ["connection lost; waiting for the server", "connected again"]);
        assert_eq!(*renewals.borrow(), 1);
        let refused = Event::ServerError(ServerError::AuthorizationViolation);
        assert_eq!(connection.line(&refused), Some(NO_RIGHT.to_owned()));
        assert_eq!(connection.line(&refused), None);
    }

    #[test]
    fn a_request_is_told_once_after_it_failed_for_long_and_never_while_the_connection_is_lost() {
        let connection = ServerConnection::new("nats://a");
        let began = Instant::now();
        let refused = Trouble::Refused("maximum bytes exceeded".to_owned());
        let told = |seconds: u64, trouble: &Trouble| {
            connection.is_to_be_told("no work", trouble, began + Duration::from_secs(seconds))
        };
        assert_eq!(
            [0, 2, 3, 4].map(|seconds| told(seconds, &refused)),
            [false, false, true, false]
        );
        connection.succeeded("no work");
        let silence = [10, 20, 29, 30, 40].map(|seconds| told(seconds, &Trouble::NoAnswer));
        assert_eq!(silence, [false, false, false, true, false]);
        connection.line(&Event::Disconnected);
        assert_eq!([50, 90].map(|seconds| told(seconds, &refused)), [false, false]);
    }

    #[test]
    fn a_server_that_ends_does_not_refuse() {
        let of = |text: &str| Trouble::of(&std::io::Error::other(text.to_owned()));
        let ends =
            "error while processing messages from the stream: 409, Some(\"Server Shutdown\")";
        assert_eq!(of(ends), Trouble::NoAnswer);
        assert_eq!(of("jetstream request timed out"), Trouble::NoAnswer);
        assert_eq!(of("disk full"), Trouble::Refused("disk full".to_owned()));
    }
}
