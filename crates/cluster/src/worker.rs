//! A worker: pulls batches, computes them, stores the results, and only then acknowledges the batches.

mod activity;
mod notices;
mod shared_cache;

use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;
use std::thread;
use std::time::{Duration, Instant};

use async_nats::jetstream::{AckKind, Message};

use super::broker::{Broker, PullSource};
use super::compute::Compute;
use super::error::ClusterError;
use super::names::{PROGRESS_INTERVAL, result_subject};
use super::outcome::Outcome;
use super::puller::{Pulled, Puller};
use super::store::{RETRY_PAUSE, publish_until_stored};
use super::wire::{ResultBatch, TaskText, WorkBatch};
use activity::WorkerActivity;
use notices::{answer_audits, tell_and_listen};
use shared_cache::SharedCache;
use snakes_lab::run::RunControl;
use snakes_lab::run::headless::say;

/// Options of a worker.
#[derive(Debug, Clone)]
pub struct WorkerOptions {
    /// Name of the worker, which no other worker has: letters, digits and hyphens.
    pub name: String,
    /// Number of threads that compute.
    pub threads: usize,
    /// Proof of the worker's engine: see [`super::proof`].
    pub proof: String,
    /// Computes the outcomes of tasks.
    pub compute: Arc<dyn Compute>,
}

/// State that the threads of a worker share.
#[derive(Debug)]
struct Workplace {
    broker: Arc<Broker>,
    options: WorkerOptions,
    control: Arc<RunControl>,
    cache: SharedCache,
    evaluations: AtomicU64,
    redelivered: AtomicU64,
    activity: WorkerActivity,
}

/// Maximum number of shared trials and genomes that are kept.
const MOST_SHARED: usize = 64;
/// Longest time that a stopped worker waits for its threads. After it, the server delivers their batches to other
/// workers.
const LONGEST_END: Duration = Duration::from_millis(1200);
/// Longest time that a stopped worker tries to send something to the server.
const LAST_WORDS: Duration = Duration::from_millis(300);
/// Interval at which a thread checks whether the worker was stopped.
const STOP_INTERVAL: Duration = Duration::from_millis(30);

/// Works until `control` is cancelled. The batch in progress then returns to the queue after its current evaluation. A
/// stopped worker ends within two seconds, even if its server does not answer. Returns the number of its evaluations.
///
/// # Errors
/// The first request for work is refused, the server refuses for good what the worker needs, or all coordinators on the
/// server compute with another engine.
pub fn work(
    broker: &Arc<Broker>,
    options: WorkerOptions,
    control: &Arc<RunControl>,
) -> Result<u64, ClusterError> {
    super::names::check_name("worker", &options.name)?;
    let threads = options.threads;
    let place = Arc::new(Workplace {
        cache: SharedCache::new(MOST_SHARED),
        broker: Arc::clone(broker),
        options,
        control: Arc::clone(control),
        evaluations: AtomicU64::new(0),
        redelivered: AtomicU64::new(0),
        activity: WorkerActivity::default(),
    });
    let runtime = &place.broker.runtime;
    let source = PullSource::Work(place.options.proof.clone());
    let consumer = place.broker.connection.answer(place.broker.consumer(&source));
    let Some(consumer) = place.unless_stopped(Duration::ZERO, consumer) else { return Ok(0) };
    consumer.map_err(|trouble| place.broker.refused("asking for work", trouble))?;
    let notices = runtime.spawn(tell_and_listen(Arc::clone(&place)));
    let audits = runtime.spawn(answer_audits(Arc::clone(&place)));
    let mut workers = Vec::new();
    for number in 0..threads {
        let place = Arc::clone(&place);
        let name = format!("worker-{number}");
        workers.push(thread::Builder::new().name(name).spawn(move || work_loop(&place))?);
    }
    let ended = joined(workers, control);
    audits.abort();
    // The task of the notices ends after its last notice, which says that this worker leaves.
    let error = runtime.block_on(async {
        let error = tokio::time::timeout(LAST_WORDS, notices).await;
        let _ = tokio::time::timeout(LAST_WORDS, place.broker.client.flush()).await;
        error
    });
    match error {
        Ok(Ok(Some(error))) => Err(error),
        _ if ended > 0 => Err(ClusterError::ThreadEnded),
        _ => Ok(place.evaluations.load(Relaxed)),
    }
}

/// Waits until all threads have ended, but after the worker was stopped at most `LONGEST_END`. Returns how many
/// panicked.
fn joined(mut threads: Vec<thread::JoinHandle<()>>, control: &RunControl) -> usize {
    let (mut panicked, mut stopped) = (0, None);
    while !threads.is_empty() {
        if control.is_cancelled() {
            let stopped = *stopped.get_or_insert_with(Instant::now);
            if stopped.elapsed() > LONGEST_END {
                break;
            }
        }
        let (ended, running) = threads.into_iter().partition(|thread| thread.is_finished());
        threads = running;
        let ended: Vec<thread::JoinHandle<()>> = ended;
        panicked += ended.into_iter().map(thread::JoinHandle::join).filter(Result::is_err).count();
        thread::sleep(STOP_INTERVAL);
    }
    panicked
}

impl Workplace {
    /// Returns the output of a future, or `None` if the worker was stopped and the future does not end within `grace`
    /// after that.
    fn unless_stopped<T>(&self, grace: Duration, future: impl Future<Output = T>) -> Option<T> {
        self.broker.runtime.block_on(async {
            tokio::select! {
                biased;
                value = future => Some(value),
                () = stopped(&self.control, grace) => None,
            }
        })
    }
}

/// Completes when the worker was stopped and `grace` has passed since.
async fn stopped(control: &RunControl, grace: Duration) {
    while !control.is_cancelled() {
        tokio::time::sleep(STOP_INTERVAL).await;
    }
    tokio::time::sleep(grace).await;
}

/// Runs one thread of a worker: fetches and computes batches until the worker is stopped.
fn work_loop(place: &Workplace) {
    const TASK: &str = "no work can be fetched";
    let connection = &place.broker.connection;
    let source = PullSource::Work(place.options.proof.clone());
    let mut puller = Puller::new(&place.broker, source, 1);
    while !place.control.is_cancelled() {
        match place.unless_stopped(Duration::ZERO, puller.next()) {
            Some(Ok(Pulled::Message(message))) => {
                connection.succeeded(TASK);
                do_batch(place, &message);
            }
            Some(Ok(Pulled::Nothing | Pulled::StoreLost)) => connection.succeeded(TASK),
            Some(Err(trouble)) => {
                connection.failed(TASK, &trouble);
                place.unless_stopped(Duration::ZERO, async {
                    tokio::time::sleep(RETRY_PAUSE).await
                });
            }
            None => {}
        }
    }
}

/// Computes a batch, stores its results, and acknowledges it.
fn do_batch(place: &Workplace, message: &Message) {
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
        place.broker.runtime.spawn(async move {
            loop {
                tokio::time::sleep(PROGRESS_INTERVAL).await;
                // A lost report is harmless: the next one follows.
                let _ = message.ack_with(AckKind::Progress).await;
            }
        })
    };
    place.activity.begin(&work.run);
    let stored = compute(place, &work).is_some_and(|results| store(place, message, &results));
    place.activity.end();
    reporter.abort();
    // The pause lets a batch that cannot be computed wait; a stopped worker returns its batch without delay.
    let pause = (!place.control.is_cancelled()).then_some(RETRY_PAUSE);
    acknowledge(place, message, if stored { AckKind::Ack } else { AckKind::Nak(pause) });
}

fn acknowledge(place: &Workplace, message: &Message, kind: AckKind) {
    // Without an acknowledgement the batch is delivered again, which costs time but changes no result.
    let _ = place.unless_stopped(LAST_WORDS, message.ack_with(kind));
}

/// Computes the results of a batch. Returns `None` if the worker was stopped, or the coordinator cannot be reached.
fn compute(place: &Workplace, work: &WorkBatch) -> Option<ResultBatch> {
    let shared = match place.cache.get(work.shared) {
        Some(known) => known,
        None => place.unless_stopped(Duration::ZERO, place.cache.fetch(&place.broker, work))??,
    };
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

/// Stores results that exceed the largest message, in parts. A single result that is too large is reported as refused;
/// the coordinator's process then computes it.
fn store_in_parts(place: &Workplace, batch: &Message, results: &ResultBatch) -> bool {
    let part =
        |outcomes: &[TaskText]| ResultBatch { outcomes: outcomes.to_vec(), ..results.clone() };
    match &results.outcomes[..] {
        [] => true,
        [only] => {
            let problem = "the result is larger than the server takes".to_owned();
            let text = Outcome::Refused(problem).line().into();
            store(place, batch, &part(&[TaskText { key: only.key, text }]))
        }
        many => {
            let (first, second) = many.split_at(many.len() / 2);
            store(place, batch, &part(first)) && store(place, batch, &part(second))
        }
    }
}

/// Stores results on the server, however long this takes. Returns `false` if the worker was stopped before.
///
/// If the server's store is full, the results take the room of their batch, which is acknowledged early. Otherwise a
/// store that is full of batches would stay so. Should the results be lost then, the coordinator sends their tasks again.
fn store(place: &Workplace, batch: &Message, results: &ResultBatch) -> bool {
    let (subject, bytes) = (result_subject(&results.run), results.encode());
    if bytes.len() > place.broker.largest_message() {
        return store_in_parts(place, batch, results);
    }
    let first = results.outcomes.first().map_or(0, |outcome| outcome.key);
    let id = format!("{}.{}.{first:x}.{}", results.run, results.batch, results.worker);
    let task = "a result cannot be stored";
    let has_room = Cell::new(false);
    let make_room = async || !has_room.replace(true) && batch.double_ack().await.is_ok();
    let stored = publish_until_stored(&place.broker, task, &subject, &id, &bytes, make_room);
    place.unless_stopped(LAST_WORDS, stored).is_some()
}
