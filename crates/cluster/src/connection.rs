//! The state of a connection, and the messages about it: a line when the connection is lost, a line when it is made
//! again, and a line for a request that keeps failing.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use async_nats::{ClientError, Event, Server, ServerError};
use tokio::sync::watch;

use super::hello::LONGEST_TROUBLE;
use super::trouble::Trouble;
use snakes_lab::run::headless::say;

/// The state of a connection to a server.
#[derive(Debug)]
pub struct ServerConnection {
    url: String,
    /// Number of times that the connection was made again after a loss.
    renewals: watch::Sender<u64>,
    /// Why the server refuses for good what this program needs; `None` while it does not.
    refusal: watch::Sender<Option<String>>,
    state: Mutex<ConnectionState>,
}

#[derive(Debug, Default)]
struct ConnectionState {
    is_lost: bool,
    /// The latest message about the whole connection since it was made, which is not repeated.
    told: Option<String>,
    /// The server's latest error message, which often says why the connection ends next.
    said: Option<String>,
    /// Requests that currently fail, by the name of their task.
    failing: BTreeMap<&'static str, Failing>,
}

#[derive(Debug)]
struct Failing {
    since: Instant,
    /// The failure in words, once the user was told of it.
    told: Option<String>,
}

/// The user is told of a request that has been refused for this long. A shorter refusal often ends by itself.
const PATIENCE_WITH_REFUSALS: Duration = Duration::from_secs(3);
/// The user is told of a request that has had no answer for this long, unless the connection is known to be lost by
/// then.
const PATIENCE_WITH_SILENCE: Duration = Duration::from_secs(20);
/// Message about a subscription whose messages this computer takes in too slowly.
const SLOW: &str = "messages arrive faster than this computer takes them in, and some are lost; that costs time, and \
                    changes no result";

impl ServerConnection {
    /// Creates the state of a connection before it is made for the first time.
    pub fn new(url: &str) -> Self {
        Self {
            url: url.to_owned(),
            renewals: watch::Sender::new(0),
            refusal: watch::Sender::new(None),
            state: Mutex::default(),
        }
    }

    /// Returns whether the connection is known to be lost.
    pub fn is_lost(&self) -> bool {
        self.state().is_lost
    }

    /// Returns a receiver that is notified each time the connection is made again.
    pub fn renewals(&self) -> watch::Receiver<u64> {
        self.renewals.subscribe()
    }

    /// Waits until the server refuses for good what this program needs, and returns why.
    pub async fn refusal(&self) -> Trouble {
        let mut refusal = self.refusal.subscribe();
        let words = refusal.wait_for(Option::is_some).await.ok().and_then(|words| words.clone());
        match words {
            Some(words) => Trouble::Never(words),
            // The sender lives as long as this connection.
            None => std::future::pending().await,
        }
    }

    /// Returns the answer to a request. If the server refuses the request by a message about the whole connection, such
    /// as one about rights, no answer would come.
    ///
    /// # Errors
    /// The request failed, or the server refuses it for good.
    pub async fn answer<T>(
        &self,
        request: impl Future<Output = Result<T, Trouble>>,
    ) -> Result<T, Trouble> {
        tokio::select! {
            answer = request => answer,
            refusal = self.refusal() => Err(refusal),
        }
    }

    /// Handles the outcomes of the latest attempts to connect again, and prints a line if the server refused one.
    pub fn on_attempts(&self, servers: &[Server]) {
        // The client tells its event callback neither the server's words nor that it refused.
        let words =
            servers.iter().find_map(|server| server.last_error.as_ref()?.split_once("nats: "));
        if let Some((_, words)) = words {
            self.on_event(&Event::ServerError(ServerError::Other(words.to_owned())));
        }
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
                let said = state.said.take().map_or_else(String::new, |said| format!("; {said}"));
                is_news.then(|| format!("connection lost{said}; waiting for the server"))
            }
            Event::Connected => {
                (state.told, state.said) = (None, None);
                if !std::mem::replace(&mut state.is_lost, false) {
                    return None;
                }
                self.renewals.send_modify(|number| *number += 1);
                Some("connected again".to_owned())
            }
            Event::LameDuckMode => {
                state.tell_once("the server says that it ends soon (lame duck mode)".to_owned())
            }
            Event::SlowConsumer(_) => state.tell_once(SLOW.to_owned()),
            Event::ServerError(error) => self.line_of(error, &mut state),
            Event::ClientError(ClientError::Other(words)) if words.contains("authorization") => {
                self.line_of(&ServerError::AuthorizationViolation, &mut state)
            }
            _ => None,
        }
    }

    /// Returns the line about an error message of the server, if it is new to the user.
    fn line_of(&self, error: &ServerError, state: &mut ConnectionState) -> Option<String> {
        match Trouble::of_server(error) {
            // The error that ends the program is the message.
            Trouble::Never(words) => {
                self.refuse(words);
                None
            }
            Trouble::Full(words) => state.tell_once(format!("{words}; trying again")),
            // Such a message ends the connection, which causes a separate event.
            other => {
                state.said = Some(other.to_string());
                None
            }
        }
    }

    fn refuse(&self, words: String) {
        self.refusal.send_if_modified(|refusal| {
            refusal.is_none().then(|| *refusal = Some(words)).is_some()
        });
    }

    /// Records that a request failed and will be repeated. `task` describes the failure in a few words.
    pub fn failed(&self, task: &'static str, trouble: &Trouble) {
        if let Trouble::Never(words) = trouble {
            self.refuse(words.clone());
        } else if let Some(words) = self.news(task, trouble, Instant::now()) {
            say(&format!("{}: {words}; trying again", self.url));
        }
    }

    /// Returns the failure in words if the user must be told of it now.
    fn news(&self, task: &'static str, trouble: &Trouble, now: Instant) -> Option<String> {
        let mut state = self.state();
        if state.is_lost {
            return None;
        }
        let failing = state.failing.entry(task).or_insert(Failing { since: now, told: None });
        let patience = match trouble {
            Trouble::NoAnswer => PATIENCE_WITH_SILENCE,
            _ => PATIENCE_WITH_REFUSALS,
        };
        let is_due = now.duration_since(failing.since) >= patience && failing.told.is_none();
        is_due.then(|| failing.told.insert(format!("{task}: {trouble}")).clone())
    }

    /// Returns what currently fails, in words for a notice, if the user was told of it.
    pub fn trouble(&self) -> Option<String> {
        let state = self.state();
        let told = state.failing.values().find_map(|failing| failing.told.as_deref())?;
        Some(told[..told.floor_char_boundary(LONGEST_TROUBLE)].to_owned())
    }

    /// Records that a request succeeded.
    pub fn succeeded(&self, task: &'static str) {
        let failing = self.state().failing.remove(task);
        if failing.is_some_and(|failing| failing.told.is_some()) {
            say(&format!("{}: {task}: over", self.url));
        }
    }

    fn state(&self) -> MutexGuard<'_, ConnectionState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl ConnectionState {
    /// Returns the line, or `None` if it equals the line before.
    fn tell_once(&mut self, line: String) -> Option<String> {
        let is_news = self.told.as_ref() != Some(&line);
        self.told = Some(line.clone());
        is_news.then_some(line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trouble::NO_RIGHT;

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
    }

    #[test]
    fn a_request_is_told_once_after_it_failed_for_long_and_never_while_the_connection_is_lost() {
        let connection = ServerConnection::new("nats://a");
        let began = Instant::now();
        let refused = Trouble::Refused("maximum bytes exceeded".to_owned());
        let told = |seconds: u64, trouble: &Trouble| {
            let news = connection.news("no work", trouble, began + Duration::from_secs(seconds));
            news.is_some()
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
    fn f3_the_reason_of_a_loss_and_of_a_refused_attempt_are_told_once() {
        let connection = ServerConnection::new("nats://a");
        let said = |words: &str| Event::ServerError(ServerError::Other(words.to_owned()));
        let lines = [
            Event::LameDuckMode,
            Event::LameDuckMode,
            said("Slow Consumer"),
            Event::Disconnected,
            said("maximum connections exceeded"),
            said("maximum connections exceeded"),
            Event::Connected,
        ];
        let lines: Vec<String> = lines.iter().filter_map(|event| connection.line(event)).collect();
        let expected = [
            "the server says that it ends soon (lame duck mode)",
            "connection lost; the server says: Slow Consumer; waiting for the server",
            "the server says: maximum connections exceeded; end other programs that use it, or raise max_connections; \
             trying again",
            "connected again",
        ];
        assert_eq!(lines, expected);
    }

    #[tokio::test]
    async fn f3_a_refusal_for_good_ends_requests_at_once_and_is_remembered() {
        let connection = ServerConnection::new("nats://a");
        connection.on_event(&Event::ServerError(ServerError::AuthorizationViolation));
        let silent = std::future::pending::<Result<(), Trouble>>();
        let refusal = Trouble::Never(NO_RIGHT.to_owned());
        assert_eq!(connection.answer(silent).await, Err(refusal.clone()));
        connection.failed("no work", &Trouble::Never("other".to_owned()));
        assert_eq!(connection.refusal().await, refusal, "the first one counts");
    }

    #[test]
    fn f3_what_fails_is_told_in_notices_as_long_as_it_fails() {
        let connection = ServerConnection::new("nats://a");
        let full = Trouble::Full("ä".repeat(400));
        assert_eq!(connection.news("no work", &full, Instant::now()), None);
        assert_eq!(connection.trouble(), None, "nobody was told yet");
        connection.news("no work", &full, Instant::now() + PATIENCE_WITH_REFUSALS);
        let trouble = connection.trouble().expect("told");
        assert!(trouble.starts_with("no work: ä") && trouble.len() <= LONGEST_TROUBLE, "{trouble}");
        connection.succeeded("no work");
        assert_eq!(connection.trouble(), None);
    }
}
