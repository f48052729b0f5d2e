//! A worker: pulls batches, computes them, stores the results, and only then acknowledges the batches.

mod notices;
mod shared_cache;

use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;
use std::thread;
use std::time::{Duration, Instant};

use async_nats::jetstream::consumer::PullConsumer;
use async_nats::jetstream::context::PublishErrorKind;
use async_nats::jetstream::message::PublishMessage;
use async_nats::jetstream::{AckKind, Message};
use futures_util::StreamExt;

use super::broker::{Broker, one_line, result_stream, work_consumer};
use super::compute::Compute;
use super::error::ClusterError;
use super::names::{PROGRESS_INTERVAL, PULL_WAIT, result_subject};
use super::outcome::Outcome;
use super::wire::{ResultBatch, TaskText, WorkBatch};
use crate::run::RunControl;
use crate::run::headless::say;
use notices::answer_audits;
use notices::tell_and_listen;
use shared_cache::SharedCache;

/// How a worker works.
#[derive(Debug, Clone)]
pub struct WorkerOptions {
    /// Its name, which no other worker has: letters, digits and hyphens.
    pub name: String,
    /// Number of its threads.
    pub threads: usize,
    /// The proof of its engine: see [`super::proof`].
    pub proof: String,
    /// What computes the outcomes.
    pub compute: Arc<dyn Compute>,
}

/// What the threads of a worker share.
#[derive(Debug)]
struct Workplace {
    broker: Arc<Broker>,
    options: WorkerOptions,
    control: Arc<RunControl>,
    cache: SharedCache,
    evaluations: AtomicU64,
    redelivered: AtomicU64,
}

/// Pause before the server is asked again after it refused a request.
const RETRY_PAUSE: Duration = Duration::from_millis(500);

/// Works until `control` is cancelled. A batch in progress is then returned to the queue after its current evaluation.
///
/// # Errors
/// The first request for work is refused, or all coordinators on the server compute with another engine.
pub fn work(
    broker: Broker,
    options: WorkerOptions,
    control: &Arc<RunControl>,
) -> Result<(), ClusterError> {
    super::names::check_name("worker", &options.name)?;
    let broker = Arc::new(broker);
    let consumer = broker.runtime().block_on(work_consumer(broker.jetstream(), &options.proof));
    consumer.map_err(|problem| broker.refused("the request for work", problem))?;
    let threads = options.threads;
    let place = Arc::new(Workplace {
        cache: SharedCache::default(),
        broker,
        options,
        control: Arc::clone(control),
        evaluations: AtomicU64::new(0),
        redelivered: AtomicU64::new(0),
    });
    let runtime = place.broker.runtime();
    let notices = runtime.spawn(tell_and_listen(Arc::clone(&place)));
    let audits = runtime.spawn(answer_audits(Arc::clone(&place)));
    let mut workers = Vec::new();
    for number in 0..threads {
        let place = Arc::clone(&place);
        let name = format!("worker-{number}");
        workers.push(thread::Builder::new().name(name).spawn(move || work_loop(&place))?);
    }
    let ended = workers.into_iter().map(thread::JoinHandle::join).filter(Result::is_err).count();
    audits.abort();
    // The notices end with the last one, which says that this worker leaves.
    let foreign = runtime.block_on(notices);
    let _ = runtime.block_on(place.broker.client().flush());
    match foreign {
        Ok(Some(error)) => Err(error),
        _ if ended > 0 => Err(ClusterError::ThreadEnded),
        _ => Ok(()),
    }
}

/// One thread of a worker.
fn work_loop(place: &Workplace) {
    let runtime = place.broker.runtime();
    let mut complaint = String::new();
    let mut consumer: Option<PullConsumer> = None;
    while !place.control.is_cancelled() {
        let pulled = runtime.block_on(async {
            if consumer.is_none() {
                let found = work_consumer(place.broker.jetstream(), &place.options.proof).await;
                consumer = Some(found?);
            }
            match &consumer {
                Some(consumer) => pull_one(consumer).await,
                None => Ok(None),
            }
        });
        match pulled {
            Ok(Some(message)) => do_batch(place, &message),
            Ok(None) => complaint.clear(),
            Err(problem) => {
                // A server that lost its files has no consumer any more.
                consumer = None;
                if problem != complaint {
                    say(&format!("{}: no work: {problem}; asking again", place.broker.url()));
                    complaint = problem;
                }
                thread::sleep(RETRY_PAUSE);
            }
        }
    }
}

/// The next batch, if one comes soon.
async fn pull_one(consumer: &PullConsumer) -> Result<Option<Message>, String> {
    let request = consumer.batch().max_messages(1).expires(PULL_WAIT).messages();
    let mut messages = request.await.map_err(|error| one_line(&error))?;
    match messages.next().await {
        None => Ok(None),
        Some(Ok(message)) => Ok(Some(message)),
        Some(Err(error)) => Err(error.to_string()),
    }
}

/// Computes a batch, stores its results, and acknowledges it.
fn do_batch(place: &Workplace, message: &Message) {
    let runtime = place.broker.runtime();
    let work = match WorkBatch::decode(&message.payload) {
        Ok(work) => work,
        Err(error) => {
            say(&format!("a batch is ignored: {error}"));
            acknowledge(place, message, AckKind::Term);
            return;
        }
    };
    if message.info().is_ok_and(|info| info.delivered > 1) {
        place.redelivered.fetch_add(1, Relaxed);
    }
    let reporter = {
        let message = message.clone();
        runtime.spawn(async move {
            loop {
                tokio::time::sleep(PROGRESS_INTERVAL).await;
                // A lost report is followed by another one.
                let _ = message.ack_with(AckKind::Progress).await;
            }
        })
    };
    let results = compute(place, &work);
    let stored = match results {
        Some(results) => store(place, &results),
        None => false,
    };
    reporter.abort();
    // A batch that is returned soon reaches another worker.
    let pause = (!place.control.is_cancelled()).then_some(RETRY_PAUSE);
    acknowledge(place, message, if stored { AckKind::Ack } else { AckKind::Nak(pause) });
}

fn acknowledge(place: &Workplace, message: &Message, kind: AckKind) {
    // Without an acknowledgement the batch is delivered again, which costs time but changes nothing.
    let _ = place.broker.runtime().block_on(message.ack_with(kind));
}

/// The results of a batch; none if the worker was stopped, or the coordinator cannot be reached.
fn compute(place: &Workplace, work: &WorkBatch) -> Option<ResultBatch> {
    let shared = place.cache.get(&place.broker, work)?;
    let began = Instant::now();
    let mut outcomes = Vec::with_capacity(work.tasks.len());
    for task in &work.tasks {
        if place.control.is_cancelled() {
            return None;
        }
        let line = place.options.compute.outcome(&shared, &task.text).line();
        outcomes.push(TaskText { key: task.key, text: line.into() });
        place.evaluations.fetch_add(1, Relaxed);
    }
    Some(ResultBatch {
        run: work.run.clone(),
        batch: work.batch,
        worker: place.options.name.clone(),
        elapsed_s: began.elapsed().as_secs_f64(),
        outcomes,
    })
}

/// Stores results that are larger than a message may be. The coordinator computes what is too large by itself.
fn store_in_parts(place: &Workplace, results: &ResultBatch) -> bool {
    let part =
        |outcomes: &[TaskText]| ResultBatch { outcomes: outcomes.to_vec(), ..results.clone() };
    match &results.outcomes[..] {
        [] => true,
        [only] => {
            let problem = "the result is larger than the server takes".to_owned();
            let text = Outcome::Refused(problem).line().into();
            store(place, &part(&[TaskText { key: only.key, text }]))
        }
        many => {
            let (first, second) = many.split_at(many.len() / 2);
            store(place, &part(first)) && store(place, &part(second))
        }
    }
}

/// Stores results on the server, however long that takes. False if the worker was stopped before it could.
fn store(place: &Workplace, results: &ResultBatch) -> bool {
    let (subject, bytes) = (result_subject(&results.run), results.encode());
    if bytes.len() > place.broker.largest_message() {
        return store_in_parts(place, results);
    }
    let first = results.outcomes.first().map_or(0, |outcome| outcome.key);
    let id = format!("{}.{}.{first:x}.{}", results.run, results.batch, results.worker);
    let mut complaint = String::new();
    loop {
        let message = PublishMessage::build().payload(bytes.clone().into()).message_id(&id);
        let jetstream = place.broker.jetstream();
        let published = place.broker.runtime().block_on(async {
            let sent = jetstream.send_publish(subject.clone(), message).await?;
            sent.await
        });
        let Err(error) = published else { return true };
        if error.kind() == PublishErrorKind::StreamNotFound {
            let _ = place.broker.runtime().block_on(result_stream(jetstream));
        }
        let problem = one_line(&error);
        if problem != complaint {
            let url = place.broker.url();
            say(&format!("{url}: a result cannot be stored: {problem}; trying again"));
            complaint = problem;
        }
        if place.control.is_cancelled() {
            return false;
        }
        thread::sleep(RETRY_PAUSE);
    }
}
