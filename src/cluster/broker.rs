//! The connection to a NATS server, and the streams on it.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::SeqCst;
use std::time::Duration;

use async_nats::jetstream::consumer::{AckPolicy, PullConsumer, pull};
use async_nats::jetstream::stream::{Config, DiscardPolicy, RetentionPolicy, StorageType, Stream};
use async_nats::jetstream::{self, Context};
use async_nats::{Client, ConnectOptions, Event};
use tokio::runtime::{Builder, Handle, Runtime};

use super::error::ClusterError;
use super::names::{
    ACKNOWLEDGEMENT_WAIT, MESSAGE_AGE, RESULT_STREAM, RESULT_SUBJECTS, WORK_STREAM, WORK_SUBJECTS,
    result_subject, worker_consumer,
};
use crate::check::Invalid;
use crate::run::headless::say;
use crate::save::load_text;

/// How to reach a server.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct BrokerOptions {
    /// Its addresses, such as `nats://192.168.1.5:4222`; of a cluster several, separated by commas.
    pub url: String,
    /// A file with credentials: what `nsc` writes (`.creds`), or the seed of an NKey.
    pub creds: Option<PathBuf>,
    /// A file with the certificate of the authority that signed the server's.
    pub tls_ca: Option<PathBuf>,
}

/// A connection. It is made again whenever it is lost.
#[derive(Debug)]
pub struct Broker {
    url: String,
    runtime: Handle,
    /// Present until this is dropped.
    owned_runtime: Option<Runtime>,
    client: Client,
    jetstream: Context,
}

/// How long a server may take to answer.
const ANSWER_WAIT: Duration = Duration::from_secs(5);
/// Maximum number of waiting requests for work: one for each thread in the room.
const MOST_WAITING: i64 = 20_000;
/// Maximum number of batches that workers have at the same time.
const MOST_OUTSTANDING: i64 = 20_000;

impl BrokerOptions {
    /// Refuses an address with a password: others can read the command line.
    ///
    /// # Errors
    /// The address is none, or has a password.
    pub fn check(&self) -> Result<(), Invalid> {
        let allowed =
            "nats://HOST:PORT or tls://HOST:PORT, without user and password (use --creds FILE)";
        for address in self.url.split(',') {
            let refused = |shown: &str| Invalid::new("--nats", format!("{shown:?}"), allowed);
            let host = address.strip_prefix("nats://").or(address.strip_prefix("tls://"));
            let Some(host) = host.filter(|host| !host.is_empty()) else {
                return Err(refused(without_user(address).as_str()));
            };
            if host.contains('@') {
                // The password stands in no message.
                return Err(refused(&without_user(address)));
            }
        }
        Ok(())
    }
}

/// The address without what stands before its @.
fn without_user(address: &str) -> String {
    match address.rsplit_once('@') {
        Some((_, host)) => format!("…@{host}"),
        None => address.to_owned(),
    }
}

impl Broker {
    /// Connects, and makes the streams that are not there yet.
    ///
    /// # Errors
    /// The server cannot be reached, refuses the credentials, or has no JetStream.
    pub fn connect(options: &BrokerOptions, name: &str) -> Result<Self, ClusterError> {
        options.check()?;
        let runtime = Builder::new_multi_thread()
            .worker_threads(1)
            .thread_name("cluster")
            .enable_all()
            .build()?;
        let (client, jetstream) = runtime.block_on(connect(options, name))?;
        let handle = runtime.handle().clone();
        let broker = Self {
            url: options.url.clone(),
            runtime: handle,
            owned_runtime: Some(runtime),
            client,
            jetstream,
        };
        broker.check_jetstream()?;
        broker.runtime.block_on(broker.make_streams())?;
        Ok(broker)
    }

    /// The address.
    pub fn url(&self) -> &str {
        &self.url
    }

    /// What the connection runs on.
    pub(super) fn runtime(&self) -> &Handle {
        &self.runtime
    }

    pub(super) fn client(&self) -> &Client {
        &self.client
    }

    pub(super) fn jetstream(&self) -> &Context {
        &self.jetstream
    }

    /// The largest message that the server takes, in bytes.
    pub(super) fn largest_message(&self) -> usize {
        // The rest is for headers.
        self.client.server_info().max_payload.saturating_sub(4096)
    }

    fn check_jetstream(&self) -> Result<(), ClusterError> {
        match self.client.server_info().jetstream {
            true => Ok(()),
            false => Err(ClusterError::NoJetStream { url: self.url.clone() }),
        }
    }

    /// Makes the streams that are not there.
    async fn make_streams(&self) -> Result<(), ClusterError> {
        work_stream(&self.jetstream).await.map_err(|problem| self.refused("a stream", problem))?;
        let results = result_stream(&self.jetstream).await;
        results.map(drop).map_err(|problem| self.refused("a stream", problem))
    }

    pub(super) fn refused(&self, task: &'static str, problem: String) -> ClusterError {
        ClusterError::Refused { url: self.url.clone(), task, problem }
    }
}

impl Drop for Broker {
    /// A task on the runtime may hold the broker last, and must not wait for its own end.
    fn drop(&mut self) {
        if let Some(runtime) = self.owned_runtime.take() {
            runtime.shutdown_background();
        }
    }
}

async fn connect(options: &BrokerOptions, name: &str) -> Result<(Client, Context), ClusterError> {
    let mut connect = ConnectOptions::new();
    if let Some(path) = &options.creds {
        let text = load_text(path)?;
        let seed = text.trim();
        connect = match seed.starts_with('S') && !seed.contains('\n') {
            true => connect.nkey(seed.to_owned()),
            false => connect.credentials(&text).map_err(|error| ClusterError::Credentials {
                path: path.clone(),
                problem: error.to_string(),
            })?,
        };
    }
    if let Some(path) = &options.tls_ca {
        // The client's own error does not name the file.
        if !load_text(path)?.contains("-----BEGIN CERTIFICATE-----") {
            return Err(ClusterError::NoCertificate(path.clone()));
        }
        connect = connect.add_root_certificates(path.clone()).require_tls(true);
    }
    let lost = Arc::new(AtomicBool::new(false));
    let url = options.url.clone();
    let connect = connect
        .name(name)
        .connection_timeout(ANSWER_WAIT)
        .request_timeout(Some(ANSWER_WAIT))
        .ping_interval(Duration::from_secs(5))
        .reconnect_delay_callback(|attempts| {
            Duration::from_millis(100 * attempts.clamp(1, 10) as u64)
        })
        .event_callback(move |event| {
            let line = connection_line(&event, &lost, &url);
            async move {
                if let Some(line) = line {
                    say(&line);
                }
            }
        });
    let addresses: Vec<&str> = options.url.split(',').collect();
    let client = connect.connect(addresses).await.map_err(|error| ClusterError::Unreachable {
        url: options.url.clone(),
        problem: with_advice(one_line(&error)),
    })?;
    let jetstream = jetstream::new(client.clone());
    Ok((client, jetstream))
}

/// A problem of a connection with advice, where the client's words do not say what to do.
fn with_advice(problem: String) -> String {
    let advice = [
        ("UnknownIssuer", "--tls-ca FILE names the authority that signed the server's certificate"),
        ("InvalidContentType", "the server does not use TLS"),
    ];
    let fitting = advice.into_iter().find(|(word, _)| problem.contains(word));
    fitting.map_or(problem.clone(), |(_, advice)| format!("{problem}; {advice}"))
}

/// A line about the connection, when it is lost and when it is there again.
fn connection_line(event: &Event, lost: &AtomicBool, url: &str) -> Option<String> {
    match event {
        Event::Disconnected => (!lost.swap(true, SeqCst))
            .then(|| format!("{url}: connection lost; waiting for the server")),
        Event::Connected => lost.swap(false, SeqCst).then(|| format!("{url}: connected again")),
        Event::ServerError(error) => Some(format!("{url}: {error}")),
        _ => None,
    }
}

/// An error with its causes, on one line.
pub(super) fn one_line(error: &dyn std::error::Error) -> String {
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

fn stream_config(name: &str, subjects: &str) -> Config {
    Config {
        name: name.to_owned(),
        subjects: vec![subjects.to_owned()],
        retention: RetentionPolicy::WorkQueue,
        storage: StorageType::File,
        discard: DiscardPolicy::New,
        max_age: MESSAGE_AGE,
        duplicate_window: Duration::from_secs(120),
        ..Config::default()
    }
}

/// The stream of batches, which is made if it is not there.
pub(super) async fn work_stream(jetstream: &Context) -> Result<Stream, String> {
    let config = stream_config(WORK_STREAM, WORK_SUBJECTS);
    jetstream.get_or_create_stream(config).await.map_err(|error| one_line(&error))
}

/// The stream of results, which is made if it is not there.
pub(super) async fn result_stream(jetstream: &Context) -> Result<Stream, String> {
    let config = stream_config(RESULT_STREAM, RESULT_SUBJECTS);
    jetstream.get_or_create_stream(config).await.map_err(|error| one_line(&error))
}

/// The consumer of batches that all workers with this proof share.
pub(super) async fn work_consumer(
    jetstream: &Context,
    proof: &str,
) -> Result<PullConsumer, String> {
    let name = worker_consumer(proof);
    let config = pull::Config {
        durable_name: Some(name.clone()),
        filter_subject: format!("snakes.work.{proof}.>"),
        ack_policy: AckPolicy::Explicit,
        ack_wait: ACKNOWLEDGEMENT_WAIT,
        max_ack_pending: MOST_OUTSTANDING,
        max_waiting: MOST_WAITING,
        ..pull::Config::default()
    };
    let stream = work_stream(jetstream).await?;
    stream.get_or_create_consumer(&name, config).await.map_err(|error| one_line(&error))
}

/// The consumer of a run's results.
pub(super) async fn result_consumer(
    jetstream: &Context,
    run: &str,
) -> Result<PullConsumer, String> {
    let config = pull::Config {
        durable_name: Some(run.to_owned()),
        filter_subject: result_subject(run),
        ack_policy: AckPolicy::Explicit,
        ack_wait: Duration::from_secs(30),
        max_ack_pending: MOST_OUTSTANDING,
        ..pull::Config::default()
    };
    let stream = result_stream(jetstream).await?;
    stream.get_or_create_consumer(run, config).await.map_err(|error| one_line(&error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_with_a_password_is_refused_without_repeating_it() {
        let check = |url: &str| BrokerOptions { url: url.to_owned(), ..Default::default() }.check();
        assert_eq!(check("nats://127.0.0.1:4222"), Ok(()));
        assert_eq!(check("tls://a:4222,nats://b"), Ok(()));
        for url in ["nats://ann:secret@a:4222", "ann:secret@a", "http://a", "nats://", ""] {
            let error = check(url).expect_err("refused").to_string();
            assert!(error.starts_with("--nats is \"") && !error.contains("secret"), "{error}");
        }
    }
}
