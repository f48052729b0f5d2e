//! Why a request to the server failed, whether repeating it can help, and what a person can do about it.

use std::error::Error;
use std::fmt;

use async_nats::jetstream::ErrorCode;
use async_nats::jetstream::context::{
    ConsumerInfoError, ConsumerInfoErrorKind, CreateStreamError, CreateStreamErrorKind,
    PublishError, PublishErrorKind,
};
use async_nats::jetstream::stream::{ConsumerError, ConsumerErrorKind, PurgeError, PurgeErrorKind};
use async_nats::{ServerError, jetstream};

/// Why a request to the server failed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Trouble {
    /// No answer came. A connection that is lost without notice looks the same.
    NoAnswer,
    /// The server has no room at present. The request succeeds once there is some. Holds the server's answer, and what
    /// makes room.
    Full(String),
    /// The request failed for another reason, which may pass. Holds the reason.
    Refused(String),
    /// The server refuses the request until a person changes its settings or this program's credentials. Holds the
    /// server's answer, and what to change.
    Never(String),
}

/// Remedy for credentials that the server refuses.
pub const NO_RIGHT: &str = "the server refuses the credentials (--creds FILE)";
/// Remedy for a full store of the server.
const MORE_STORE: &str = "make room in its store (snakes machines --purge RUN removes what a stopped run left), or raise \
                          max_file_store (max_mem_store, if its streams are in memory)";
/// Remedy for a full memory store of the server. Only streams that were created in memory use this store.
const MORE_MEMORY: &str = "raise max_mem_store, or remove the streams SNAKES_WORK and SNAKES_RESULTS, which are made again as files";
/// Remedy for too many connections.
const MORE_CONNECTIONS: &str = "end other programs that use it, or raise max_connections";
/// The rights that every user of the server needs.
const RIGHTS: &str = "let this user publish and subscribe to snakes.>, $JS.> and _INBOX.>";
/// Parts of error messages which show that no answer came because the server stops, starts, or cannot be reached.
const NO_ANSWER: [&str; 7] = [
    "timed out",
    "broken pipe",
    "no responders",
    "Server Shutdown",
    "channel closed",
    // The status of a request for messages that nobody receives.
    "stream: 503",
    "EOF",
];

impl Trouble {
    /// Classifies an error of the NATS client.
    pub fn of(error: &(dyn Error + 'static)) -> Self {
        if let Some(answer) = answer(error) {
            return Self::of_answer(&answer);
        }
        if let Some(words) = said(error) {
            return Self::of_server(words);
        }
        let words = one_line(error);
        let is_publish = |of: &PublishError| of.kind() == PublishErrorKind::MaxPayloadExceeded;
        let is_off =
            |of: &CreateStreamError| of.kind() == CreateStreamErrorKind::JetStreamUnavailable;
        if error.downcast_ref().is_some_and(is_publish) {
            return Self::Never(format!("{words}; raise max_payload of the server"));
        }
        if error.downcast_ref().is_some_and(is_off) {
            let advice = "start it with: nats-server -js";
            return Self::Refused(format!("JetStream does not answer on this server; {advice}"));
        }
        match NO_ANSWER.iter().any(|part| words.contains(part)) {
            true => Self::NoAnswer,
            false => Self::Refused(words),
        }
    }

    /// Classifies an answer of JetStream.
    fn of_answer(answer: &jetstream::Error) -> Self {
        type Code = ErrorCode;
        let said = format!("the server says: {answer}");
        let (kind, advice): (fn(String) -> Self, &str) = match answer.error_code() {
            Code::INSUFFICIENT_RESOURCES
            | Code::ACCOUNT_RESOURCES_EXCEEDED
            | Code::STORAGE_RESOURCES_EXCEEDED
            | Code::STREAM_STORE_FAILED => (Self::Full, MORE_STORE),
            Code::MEMORY_RESOURCES_EXCEEDED => (Self::Full, MORE_MEMORY),
            Code::MAXIMUM_STREAMS_LIMIT => {
                (Self::Full, "remove a stream, or raise max_streams of the account")
            }
            Code::MAXIMUM_CONSUMERS_LIMIT => {
                (Self::Full, "wait for another run to end, or raise max_consumers of the account")
            }
            Code::JETSTREAM_NOT_ENABLED_FOR_ACCOUNT => {
                (Self::Never, "add \"jetstream: enabled\" to the account in the server's settings")
            }
            Code::STREAM_SUBJECT_OVERLAP => (
                Self::Never,
                "another stream takes the subjects snakes.work.> or snakes.result.>: remove it, or use another account",
            ),
            Code::STREAM_MESSAGE_EXCEEDS_MAXIMUM => {
                (Self::Never, "raise max_msg_size of the streams SNAKES_WORK and SNAKES_RESULTS")
            }
            _ => return Self::Refused(said),
        };
        kind(format!("{said}; {advice}"))
    }

    /// Classifies an error message of the server that is about the whole connection.
    pub fn of_server(error: &ServerError) -> Self {
        let words = match error {
            ServerError::AuthorizationViolation => return Self::Never(NO_RIGHT.to_owned()),
            ServerError::Other(words) => words.replace(char::is_control, " "),
            other => other.to_string(),
        };
        let has = |parts: &[&str]| parts.iter().any(|part| words.contains(part));
        let said = format!("the server says: {words}");
        if has(&["ermissions Violation"]) {
            Self::Never(format!("{said}; {RIGHTS}"))
        } else if has(&["Expired", "expired", "Revoked", "revoked"]) {
            Self::Never(format!("{said}; new credentials are needed (--creds FILE)"))
        } else if has(&["connections exceeded", "Connections Exceeded", "throttling"]) {
            Self::Full(format!("{said}; {MORE_CONNECTIONS}"))
        } else if has(&["ubscriptions"]) {
            Self::Full(format!("{said}; raise max_subscriptions"))
        } else {
            Self::Refused(said)
        }
    }
}

/// Returns JetStream's answer within an error of the client, which keeps it in the kind of the error or as its cause.
fn answer(error: &(dyn Error + 'static)) -> Option<jetstream::Error> {
    let in_kind = None
        .or_else(|| match error.downcast_ref::<CreateStreamError>()?.kind() {
            CreateStreamErrorKind::JetStream(answer) => Some(answer),
            _ => None,
        })
        .or_else(|| match error.downcast_ref::<ConsumerInfoError>()?.kind() {
            ConsumerInfoErrorKind::JetStream(answer) => Some(answer),
            _ => None,
        })
        .or_else(|| match error.downcast_ref::<ConsumerError>()?.kind() {
            ConsumerErrorKind::JetStream(answer) => Some(answer),
            _ => None,
        })
        .or_else(|| match error.downcast_ref::<PurgeError>()?.kind() {
            PurgeErrorKind::JetStream(answer) => Some(answer),
            _ => None,
        });
    in_kind.or_else(|| error.downcast_ref().cloned()).or_else(|| error.source().and_then(answer))
}

/// Returns the server's error message within an error of the client.
pub fn said<'e>(error: &'e (dyn Error + 'static)) -> Option<&'e ServerError> {
    error.downcast_ref().or_else(|| error.source().and_then(said))
}

impl<E: Error + 'static> From<E> for Trouble {
    fn from(error: E) -> Self {
        Self::of(&error)
    }
}

impl fmt::Display for Trouble {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoAnswer => formatter.write_str("the server does not answer"),
            Self::Full(words) | Self::Refused(words) | Self::Never(words) => {
                formatter.write_str(words)
            }
        }
    }
}

/// Returns an error and its causes as one line.
pub fn one_line(error: &dyn Error) -> String {
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

    /// Returns how an answer of JetStream is classified that has this code, error code and description.
    fn of_answer(code: u64, error_code: u64, description: &str) -> Trouble {
        let answer = format!(
            "{{\"code\":{code},\"err_code\":{error_code},\"description\":\"{description}\"}}"
        );
        let answer: jetstream::Error = serde_json::from_str(&answer).expect("an answer");
        // The client keeps the answer in the kind of the error or as its cause.
        let in_kind = CreateStreamError::new(CreateStreamErrorKind::JetStream(answer.clone()));
        let as_cause = PublishError::with_source(PublishErrorKind::Other, answer);
        let trouble = Trouble::of(&in_kind);
        assert_eq!(trouble, Trouble::of(&as_cause));
        trouble
    }

    #[test]
    fn f3_an_answer_of_the_server_is_named_with_its_code_and_never_taken_for_silence() {
        let full = of_answer(503, 10023, "insufficient resources");
        let words = "the server says: insufficient resources (code 503, error code 10023); make room in its store";
        assert!(matches!(&full, Trouble::Full(said) if said.starts_with(words)), "{full:?}");
        for (code, error_code, description) in [
            (400, 10002, "resource limits exceeded for account"),
            (500, 10047, "insufficient storage resources available"),
            (500, 10028, "insufficient memory resources available"),
            (503, 10077, "maximum bytes exceeded"),
            (400, 10026, "maximum consumers limit reached"),
            (400, 10027, "maximum number of streams reached"),
        ] {
            let trouble = of_answer(code, error_code, description);
            let said =
                format!("the server says: {description} (code {code}, error code {error_code}); ");
            assert!(matches!(&trouble, Trouble::Full(of) if of.starts_with(&said)), "{trouble:?}");
        }
        for (code, error_code, description) in [
            (503, 10039, "JetStream not enabled for account"),
            (400, 10065, "subjects overlap with an existing stream"),
            (400, 10054, "message size exceeds maximum allowed"),
        ] {
            let trouble = of_answer(code, error_code, description);
            assert!(matches!(trouble, Trouble::Never(_)), "{trouble:?}");
        }
        for (error_code, remedy) in
            [(10028, "; raise max_mem_store, "), (10023, " (max_mem_store, ")]
        {
            let told = of_answer(500, error_code, "insufficient").to_string();
            assert!(told.contains(remedy), "{told}");
        }
        let other = of_answer(500, 10049, "it broke");
        let words = "the server says: it broke (code 500, error code 10049)";
        assert_eq!(other, Trouble::Refused(words.to_owned()));
    }

    #[test]
    fn f3_a_message_of_the_server_about_the_connection_says_whether_it_can_pass() {
        let of = |words: &str| Trouble::of_server(&ServerError::Other(words.to_owned()));
        let rights = of("Permissions Violation for Publish to \"snakes.run\"");
        let words = "the server says: Permissions Violation for Publish to \"snakes.run\"; let this user publish";
        assert!(matches!(&rights, Trouble::Never(said) if said.starts_with(words)), "{rights:?}");
        assert!(matches!(of("User Authentication Expired"), Trouble::Never(_)));
        let refused = Trouble::of_server(&ServerError::AuthorizationViolation);
        assert_eq!(refused, Trouble::Never(NO_RIGHT.to_owned()));
        for words in [
            "maximum connections exceeded",
            "maximum account active connections exceeded",
            "maximum subscriptions exceeded",
        ] {
            assert!(matches!(of(words), Trouble::Full(said) if said.contains(words)));
        }
        let stale = "the server says: Stale Connection".to_owned();
        assert_eq!(of("Stale Connection"), Trouble::Refused(stale));
    }

    #[test]
    fn a_server_that_ends_does_not_refuse() {
        let of = |text: &str| Trouble::of(&std::io::Error::other(text.to_owned()));
        let ends =
            "error while processing messages from the stream: 409, Some(\"Server Shutdown\")";
        assert_eq!(of(ends), Trouble::NoAnswer);
        assert_eq!(
            of("error while processing messages from the stream: 503, None"),
            Trouble::NoAnswer
        );
        assert_eq!(of("jetstream request timed out"), Trouble::NoAnswer);
        assert_eq!(of("disk full"), Trouble::Refused("disk full".to_owned()));
    }
}
