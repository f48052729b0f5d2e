//! The connection to a NATS server, and the streams on it.

use std::sync::Arc;
use std::time::Duration;

use async_nats::jetstream::consumer::{AckPolicy, PullConsumer, pull};
use async_nats::jetstream::context::ConsumerInfoErrorKind;
use async_nats::jetstream::stream::{Config, DiscardPolicy, RetentionPolicy, StorageType, Stream};
use async_nats::jetstream::{self, Context};
use async_nats::{Client, ConnectOptions, Subscriber};
use tokio::runtime::{Builder, Handle, Runtime};

use super::address::BrokerOptions;
use super::connection::ServerConnection;
use super::error::ClusterError;
use super::names::{
    ACKNOWLEDGEMENT_WAIT, MESSAGE_AGE, RESULT_STREAM, RESULT_SUBJECTS, RUN_NOTICES, WORK_STREAM,
    WORK_SUBJECTS, WORKER_NOTICES, result_subject, work_subject, worker_consumer,
};
use super::trouble::Trouble;
use snakes_core::save::load_text;
use snakes_lab::run::with_threads;

/// A connection to a NATS server. It reconnects whenever it is lost.
#[derive(Debug)]
pub struct Broker {
    options: BrokerOptions,
    /// The state of the connection.
    pub(super) connection: Arc<ServerConnection>,
    /// The handle of the connection's runtime.
    pub(super) runtime: Handle,
    /// The runtime of the connection. It is `None` only while the broker is dropped.
    owned_runtime: Option<Runtime>,
    pub(super) client: Client,
    pub(super) jetstream: Context,
}

/// Which messages a consumer fetches.
#[derive(Debug, Clone)]
pub enum PullSource {
    /// Batches for workers whose engine has this proof.
    Work(String),
    /// Results of the run with this name.
    Results(String),
}

/// Bytes of a message that are reserved for its headers.
const HEADERS: usize = 4 * 1024;
/// Smallest payload of a message, in bytes, with which requests, notices and batches of a few snakes fit.
const LEAST_PAYLOAD: usize = 16 * 1024;
/// Longest time that a server may take to answer.
const ANSWER_WAIT: Duration = Duration::from_secs(5);
/// Maximum number of requests for work that wait on the server at the same time.
const MOST_WAITING: i64 = 20_000;
/// Maximum number of batches that workers have fetched but not yet acknowledged.
const MOST_OUTSTANDING: i64 = 20_000;

impl Broker {
    /// Connects to the server, and creates the streams that do not exist yet.
    ///
    /// # Errors
    /// The server cannot be reached, refuses the connection or the streams, or has no JetStream.
    pub fn connect(options: &BrokerOptions, name: &str) -> Result<Self, ClusterError> {
        options.check()?;
        let connection = Arc::new(ServerConnection::new(&options.url));
        let mut runtime = Builder::new_multi_thread();
        runtime.worker_threads(1).thread_name("cluster").enable_all();
        let begin = || -> Result<_, ClusterError> {
            let runtime = runtime.build()?;
            let (client, jetstream) = runtime.block_on(connect(options, name, &connection))?;
            Ok((runtime, client, jetstream))
        };
        let (runtime, client, jetstream) = with_threads(begin)??;
        let handle = runtime.handle().clone();
        let broker = Self {
            options: options.clone(),
            connection,
            runtime: handle,
            owned_runtime: Some(runtime),
            client,
            jetstream,
        };
        if !broker.client.server_info().jetstream {
            return Err(ClusterError::NoJetStream { url: broker.url().to_owned() });
        }
        let most = broker.client.server_info().max_payload;
        if most < LEAST_PAYLOAD {
            let url = broker.url().to_owned();
            return Err(ClusterError::SmallMessages { url, most, least: LEAST_PAYLOAD });
        }
        broker.ask("making a stream", broker.make_streams())?;
        Ok(broker)
    }

    /// Returns the answer to a request. `task` names the request in a few words.
    ///
    /// # Errors
    /// The request failed. It is not repeated.
    pub(super) fn ask<T>(
        &self,
        task: &'static str,
        request: impl Future<Output = Result<T, Trouble>>,
    ) -> Result<T, ClusterError> {
        let answer = self.runtime.block_on(self.connection.answer(request));
        answer.map_err(|trouble| self.refused(task, trouble))
    }

    /// Returns the address of the server.
    pub fn url(&self) -> &str {
        &self.options.url
    }

    /// Returns the flags that name this server on a command line.
    pub(super) fn flags(&self) -> String {
        self.options.flags()
    }

    /// Returns the largest payload of a message that the server accepts, in bytes.
    pub(super) fn largest_message(&self) -> usize {
        self.client.server_info().max_payload.max(LEAST_PAYLOAD) - HEADERS
    }

    /// Creates the streams of batches and of results if they do not exist.
    pub(super) async fn make_streams(&self) -> Result<(), Trouble> {
        self.work_stream().await?;
        self.result_stream().await.map(drop)
    }

    /// Returns the stream of batches. Creates it if it does not exist.
    pub(super) async fn work_stream(&self) -> Result<Stream, Trouble> {
        self.stream(WORK_STREAM, WORK_SUBJECTS).await
    }

    /// Returns the stream of results. Creates it if it does not exist.
    pub(super) async fn result_stream(&self) -> Result<Stream, Trouble> {
        self.stream(RESULT_STREAM, RESULT_SUBJECTS).await
    }

    async fn stream(&self, name: &str, subjects: &str) -> Result<Stream, Trouble> {
        let config = Config {
            name: name.to_owned(),
            subjects: vec![subjects.to_owned()],
            retention: RetentionPolicy::WorkQueue,
            storage: StorageType::File,
            discard: DiscardPolicy::New,
            max_age: MESSAGE_AGE,
            duplicate_window: Duration::from_secs(120),
            ..Config::default()
        };
        Ok(self.jetstream.get_or_create_stream(config).await?)
    }

    /// Subscribes to the notices of workers (first) and of runs (second).
    pub(super) async fn notices(&self) -> Result<(Subscriber, Subscriber), Trouble> {
        let workers = self.client.subscribe(WORKER_NOTICES).await?;
        Ok((workers, self.client.subscribe(RUN_NOTICES).await?))
    }

    /// Returns the consumer for these messages, and whether it was missing and had to be created. All workers with the
    /// same proof share a consumer. Each run has a consumer for its results.
    pub(super) async fn consumer(
        &self,
        source: &PullSource,
    ) -> Result<(PullConsumer, bool), Trouble> {
        let (stream, name) = match source {
            PullSource::Work(proof) => (self.work_stream().await?, worker_consumer(proof)),
            PullSource::Results(run) => (self.result_stream().await?, run.clone()),
        };
        let is_missing = match stream.consumer_info(&name).await {
            Ok(_) => false,
            Err(error) if error.kind() == ConsumerInfoErrorKind::NotFound => true,
            Err(error) => return Err(error.into()),
        };
        let consumer = stream.get_or_create_consumer(&name, source.config(&name)).await?;
        Ok((consumer, is_missing))
    }

    pub(super) fn refused(&self, task: &'static str, trouble: Trouble) -> ClusterError {
        ClusterError::Refused { url: self.url().to_owned(), task, trouble }
    }
}

impl Drop for Broker {
    /// Shuts the runtime down without waiting: the broker may be dropped by a task on this same runtime.
    fn drop(&mut self) {
        if let Some(runtime) = self.owned_runtime.take() {
            runtime.shutdown_background();
        }
    }
}

async fn connect(
    options: &BrokerOptions,
    name: &str,
    connection: &Arc<ServerConnection>,
) -> Result<(Client, Context), ClusterError> {
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
        // The client's own error would not name the file.
        if !load_text(path)?.contains("-----BEGIN CERTIFICATE-----") {
            return Err(ClusterError::NoCertificate(path.clone()));
        }
        connect = connect.add_root_certificates(path.clone()).require_tls(true);
    }
    let (of_events, of_attempts) = (Arc::clone(connection), Arc::clone(connection));
    let connect = connect
        .name(name)
        .connection_timeout(ANSWER_WAIT)
        .request_timeout(Some(ANSWER_WAIT))
        .ping_interval(Duration::from_secs(5))
        .reconnect_delay_callback(|attempts| {
            Duration::from_millis(100 * attempts.clamp(1, 10) as u64)
        })
        .event_callback(move |event| {
            of_events.on_event(&event);
            std::future::ready(())
        })
        .reconnect_to_server_callback(move |servers, _| {
            of_attempts.on_attempts(&servers);
            // The client chooses the server.
            std::future::ready(None)
        });
    let addresses: Vec<&str> = options.url.split(',').collect();
    let client = connect.connect(addresses).await.map_err(|error| ClusterError::Unreachable {
        url: options.url.clone(),
        trouble: options.why_unreachable(&error),
    })?;
    let jetstream = jetstream::new(client.clone());
    Ok((client, jetstream))
}

impl PullSource {
    /// Returns the settings of the consumer with this name.
    fn config(&self, name: &str) -> pull::Config {
        let config = pull::Config {
            durable_name: Some(name.to_owned()),
            ack_policy: AckPolicy::Explicit,
            max_ack_pending: MOST_OUTSTANDING,
            ..pull::Config::default()
        };
        match self {
            Self::Work(proof) => pull::Config {
                filter_subject: work_subject(proof, ">"),
                ack_wait: ACKNOWLEDGEMENT_WAIT,
                max_waiting: MOST_WAITING,
                ..config
            },
            Self::Results(run) => pull::Config {
                filter_subject: result_subject(run),
                ack_wait: Duration::from_secs(30),
                ..config
            },
        }
    }
}
