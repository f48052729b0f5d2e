//! Input and output of a coordinator: one thread that passes events to the ledger and carries out the actions it
//! returns.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crossbeam_channel::Sender;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use tokio::sync::mpsc::{Receiver, UnboundedReceiver, UnboundedSender, channel};
use tokio::task::{JoinHandle, JoinSet};

use super::common::{Common, CoordinatorOptions};
use super::ledger::{AuditTask, CallId, Checker, LOST_AFTER, Ledger, LedgerAction};
use super::traffic::{News, answer_shared, fetch_results, hear_notices};
use crate::broker::{Broker, PullSource};
use crate::compute::{Compute, outcome_of_texts};
use crate::error::ClusterError;
use crate::hello::{RunNotice, host_name, random_number};
use crate::names::{
    NOTICE_INTERVAL, RUN_NOTICES, SILENCE, audit_subject, result_subject, work_subject,
};
use crate::outcome::Outcome;
use crate::packing::pack;
use crate::store::{publish_until_stored, remove};
use crate::wire::{ResultBatch, TaskKind, WIRE_FORMAT, WorkBatch, line_of};
use snakes_core::{ENGINE_VERSION, Processors};
use snakes_lab::run::headless::say;

/// A message to the coordinator's thread.
#[derive(Debug)]
pub enum CoordinatorCommand {
    /// A call of the evaluator begins.
    Open {
        /// Number of the call.
        call: CallId,
        /// Kind of its tasks.
        kind: TaskKind,
        /// Hash of the trial or the genome that its tasks share.
        shared: u64,
        /// Texts of its tasks, by index.
        tasks: Vec<Arc<str>>,
        /// Receives the index and the outcome of each task.
        sender: Sender<(usize, Outcome)>,
    },
    /// A call is paused (`true`) or continues (`false`).
    Pause(CallId, bool),
    /// A call ends.
    Close(CallId),
    /// A computing thread of the coordinator requests a task.
    TakeLocal(Sender<Option<LocalTask>>),
    /// A computing thread of the coordinator has computed the task with this key.
    Local(u64, Outcome),
    /// The checker of a task answered with this outcome, or did not answer (`None`).
    Audited(u64, Option<Arc<str>>),
    /// The coordinator ends.
    End,
}

/// A task for a thread of the coordinator: its key, its kind, the hash of what it shares with others, and its text.
pub type LocalTask = (u64, TaskKind, u64, Arc<str>);

/// The input and output of a coordinator: see the module.
pub struct Actor {
    broker: Arc<Broker>,
    options: CoordinatorOptions,
    ledger: Ledger,
    calls: BTreeMap<CallId, Sender<(usize, Outcome)>>,
    common: Arc<Common>,
    commands: UnboundedSender<CoordinatorCommand>,
    news: Receiver<News>,
    /// Time of the last message from the server.
    heard: Instant,
    /// Whether the user was told that something is larger than the server's messages.
    has_said_too_large: bool,
    /// Reason for which the run waits, as its last notice said it.
    told_trouble: Option<String>,
    tasks: Vec<JoinHandle<()>>,
    /// Tasks that publish batches.
    publishing: JoinSet<()>,
}

/// Interval at which the coordinator looks for late batches and silent workers.
const TICK: Duration = Duration::from_millis(250);
/// If nothing at all arrived from the server for this long, silent workers are not blamed: even this run's own notices,
/// sent each second, did not come back.
const DEAFNESS: Duration = NOTICE_INTERVAL.saturating_mul(3);
/// Longest time that a worker may take to answer a check, including its evaluation.
const AUDIT_WAIT: Duration = Duration::from_secs(20);
/// Pause before work is stored again that found the server's store full, besides the usual one.
const PAUSE_FOR_RESULTS: Duration = Duration::from_secs(1);
/// Maximum number of messages from the server that wait for the ledger.
const MOST_WAITING: usize = 1024;

impl Actor {
    /// Creates the run's consumer, and removes the batches of an earlier coordinator of the same run.
    ///
    /// # Errors
    /// The server refuses the run.
    pub fn start(
        broker: Arc<Broker>,
        options: &CoordinatorOptions,
        common: Arc<Common>,
        commands: UnboundedSender<CoordinatorCommand>,
    ) -> Result<Self, ClusterError> {
        let (workers, runs) = broker.ask("preparing the run", async {
            let stream = broker.work_stream().await?;
            remove(&stream, &work_subject(&options.proof, &options.run)).await?;
            broker.consumer(&PullSource::Results(options.run.clone())).await?;
            // Subscribes before this run sends its first notice, because workers answer to it.
            broker.notices().await
        })?;
        // Batch numbers start at random, far from those of an earlier coordinator. Neither they nor the generator can
        // change a result.
        let seed = random_number();
        let rng = ChaCha8Rng::seed_from_u64(seed);
        let ledger = Ledger::new(
            &options.run,
            &options.proof,
            broker.largest_message(),
            (seed >> 24) << 20,
            rng,
        );
        let (sender, news) = channel(MOST_WAITING);
        let runtime = &broker.runtime;
        let tasks = vec![
            runtime.spawn(fetch_results(Arc::clone(&broker), options.run.clone(), sender.clone())),
            runtime.spawn(hear_notices(workers, runs, sender)),
            runtime.spawn(answer_shared(
                Arc::clone(&broker),
                options.run.clone(),
                Arc::clone(&common),
            )),
        ];
        let calls = BTreeMap::new();
        let options = options.clone();
        let heard = Instant::now();
        Ok(Self {
            broker,
            options,
            ledger,
            calls,
            common,
            commands,
            news,
            heard,
            has_said_too_large: false,
            told_trouble: None,
            tasks,
            publishing: JoinSet::new(),
        })
    }

    fn act(&mut self, actions: Vec<LedgerAction>) {
        for action in actions {
            match action {
                LedgerAction::Publish(batch) => self.publish(batch),
                LedgerAction::Withdraw => self.withdraw(),
                LedgerAction::Deliver(call, index, outcome) => {
                    // A call that was cancelled receives nothing.
                    if let Some(sender) = self.calls.get(&call) {
                        let _ = sender.send((index, outcome));
                    }
                }
                LedgerAction::Audit(task) => self.audit(task),
                LedgerAction::Say(line) => say(&line),
                LedgerAction::Taint(line) => {
                    self.common.status().taint.get_or_insert(line);
                }
            }
        }
        let staff = &self.ledger.staff;
        let mut status = self.common.status();
        (status.workers, status.threads) = (staff.workers(), staff.threads());
        status.audits = self.ledger.audits();
    }

    fn publish(&mut self, batch: WorkBatch) {
        let bytes = batch.encode();
        if self.is_too_large(&bytes) {
            let actions = self.ledger.on_too_large(&batch);
            return self.act(actions);
        }
        let id = format!("{}.{}", batch.run, batch.batch);
        let subject = work_subject(&self.options.proof, &batch.run);
        let broker = Arc::clone(&self.broker);
        while self.publishing.try_join_next().is_some() {}
        let publish = async move {
            // Results come first in a store that is full, because they make room for work.
            let wait = async || {
                tokio::time::sleep(PAUSE_FOR_RESULTS).await;
                false
            };
            let task = "work cannot be stored";
            let stored = publish_until_stored(&broker, task, &subject, &id, &bytes, wait);
            // The ledger gives the batch up by then, and publishes its tasks again.
            let _ = tokio::time::timeout(LOST_AFTER, stored).await;
        };
        self.publishing.spawn_on(publish, &self.broker.runtime);
    }

    /// Removes all batches of this run from the server, also those that are still being published.
    fn withdraw(&mut self) {
        self.publishing.abort_all();
        let broker = Arc::clone(&self.broker);
        let subject = work_subject(&self.options.proof, &self.options.run);
        self.tasks.retain(|task| !task.is_finished());
        self.tasks.push(self.broker.runtime.spawn(async move {
            // Batches that cannot be removed stay until a worker takes them.
            if let Ok(stream) = broker.work_stream().await {
                let _ = remove(&stream, &subject).await;
            }
        }));
    }

    /// Returns whether a message is larger than the server accepts. This computer then computes what it would ask for,
    /// which the user is told once.
    fn is_too_large(&mut self, bytes: &[u8]) -> bool {
        let (size, most) = (bytes.len(), self.broker.largest_message());
        if size > most && !std::mem::replace(&mut self.has_said_too_large, true) {
            say(&format!(
                "{}: a message of {size} bytes is larger than the {most} bytes that the server takes; this computer \
                 computes what needs such messages (a larger max_payload in the server's settings avoids this)",
                self.broker.url()
            ));
        }
        size > most
    }

    /// Opens a call. If the workers could not fetch what its tasks share, refuses the tasks.
    fn open(
        &mut self,
        call: CallId,
        kind: TaskKind,
        shared: u64,
        tasks: Vec<Arc<str>>,
    ) -> Vec<LedgerAction> {
        let text = self.common.texts.get(shared).unwrap_or_default();
        if self.is_too_large(&pack(text.to_string())) {
            let refused = || Outcome::Refused("what the tasks share is too large".to_owned());
            return (0..tasks.len())
                .map(|index| LedgerAction::Deliver(call, index, refused()))
                .collect();
        }
        self.ledger.open(call, kind, shared, tasks, Instant::now())
    }

    fn audit(&mut self, audit: AuditTask) {
        let commands = self.commands.clone();
        let key = audit.task.key;
        let answer = move |line| {
            let _ = commands.send(CoordinatorCommand::Audited(key, line));
        };
        let runtime = &self.broker.runtime;
        match audit.checker {
            Checker::Coordinator => {
                let compute: Arc<dyn Compute> = Arc::clone(&self.options.compute);
                let text = self.common.texts.get(audit.shared).unwrap_or_default();
                runtime.spawn_blocking(move || {
                    let outcome = outcome_of_texts(&compute, audit.kind, &text, &audit.task.text);
                    answer(Some(outcome.line().into()));
                });
            }
            Checker::Worker(worker) => {
                let work = WorkBatch {
                    run: self.options.run.clone(),
                    batch: 0,
                    kind: audit.kind,
                    shared: audit.shared,
                    tasks: vec![audit.task],
                };
                let client = self.broker.client.clone();
                runtime.spawn(async move {
                    let request = async_nats::Request::new()
                        .payload(work.encode().into())
                        .timeout(Some(AUDIT_WAIT));
                    let reply = client.send_request(audit_subject(&worker), request).await;
                    let results = reply.ok().and_then(|of| ResultBatch::decode(&of.payload).ok());
                    let outcome = results.and_then(|results| results.outcomes.into_iter().next());
                    answer(outcome.filter(|of| of.key == key).map(|outcome| outcome.text));
                });
            }
        }
    }

    fn on_command(&mut self, command: CoordinatorCommand) -> bool {
        let now = Instant::now();
        let actions = match command {
            CoordinatorCommand::Open { call, kind, shared, tasks, sender } => {
                self.calls.insert(call, sender);
                self.open(call, kind, shared, tasks)
            }
            CoordinatorCommand::Pause(call, is_paused) => self.ledger.pause(call, is_paused, now),
            CoordinatorCommand::Close(call) => {
                self.calls.remove(&call);
                self.ledger.close(call);
                Vec::new()
            }
            CoordinatorCommand::TakeLocal(sender) => {
                let _ = sender.send(self.ledger.take_for_local());
                Vec::new()
            }
            CoordinatorCommand::Local(key, outcome) => self.ledger.deliver(key, outcome),
            CoordinatorCommand::Audited(key, line) => self.ledger.on_audit(key, line, now),
            CoordinatorCommand::End => return false,
        };
        self.act(actions);
        true
    }

    fn on_news(&mut self, news: News) {
        let now = Instant::now();
        self.heard = now;
        let actions = match news {
            News::Results(results) => self.ledger.on_results(results, now),
            News::Notice(notice) => self.ledger.on_notice(notice, now),
            News::ServerIsHeard => Vec::new(),
            News::StoreLost => self.ledger.on_store_lost(now),
        };
        self.act(actions);
    }

    fn on_tick(&mut self) {
        let now = Instant::now();
        if now.duration_since(self.heard) > DEAFNESS {
            self.ledger.excuse_silence(now);
        }
        let actions = self.ledger.on_tick(now);
        self.act(actions);
    }

    /// Sends a notice at once if the reason for which the run waits has changed since the last notice: a run may end before the
    /// next notice is due.
    async fn tell_of_trouble(&mut self) {
        if self.told_trouble != self.broker.connection.trouble() {
            self.tell().await;
        }
    }

    async fn tell(&mut self) {
        self.told_trouble = self.broker.connection.trouble();
        let notice = RunNotice {
            format: WIRE_FORMAT,
            run: self.options.run.clone(),
            host: host_name(),
            engine: ENGINE_VERSION,
            processors: Processors::THIS,
            proof: self.options.proof.clone(),
            pending: self.ledger.pending() as u64,
            results: self.ledger.results,
            set_aside: self.ledger.staff.set_aside_names(),
            trouble: self.told_trouble.clone(),
        };
        let _ = self.broker.client.publish(RUN_NOTICES, line_of(&notice).into()).await;
    }
}

/// Runs a coordinator until the command to end arrives. Then removes its batches, results and consumer from the server.
/// Ends without this if the server refuses for good what the coordinator needs.
pub fn run_actor(
    broker: &Broker,
    mut actor: Actor,
    mut commands: UnboundedReceiver<CoordinatorCommand>,
) {
    broker.runtime.block_on(async {
        let mut ticks = tokio::time::interval(TICK);
        let mut notices = tokio::time::interval(NOTICE_INTERVAL);
        loop {
            tokio::select! {
                command = commands.recv() => {
                    let Some(command) = command else { break };
                    if !actor.on_command(command) {
                        break;
                    }
                }
                news = actor.news.recv() => if let Some(news) = news { actor.on_news(news) },
                _ = ticks.tick() => {
                    actor.on_tick();
                    actor.tell_of_trouble().await;
                }
                _ = notices.tick() => actor.tell().await,
                refusal = broker.connection.refusal() => {
                    let refusal = broker.refused("the run", refusal).to_string();
                    actor.common.status().refusal = Some(refusal);
                    break;
                }
            }
        }
        actor.tasks.iter().for_each(JoinHandle::abort);
        let is_refused = actor.common.status().refusal.is_some();
        if !is_refused && !actor.broker.connection.is_lost() {
            let end = async {
                actor.tell_of_trouble().await;
                clean_up(&actor).await;
            };
            let _ = tokio::time::timeout(SILENCE, end).await;
        }
    });
}

/// Removes the batches, results and consumer of the run from the server.
async fn clean_up(actor: &Actor) {
    if let Ok(stream) = actor.broker.work_stream().await {
        let subject = work_subject(&actor.options.proof, &actor.options.run);
        let _ = remove(&stream, &subject).await;
    }
    if let Ok(stream) = actor.broker.result_stream().await {
        let _ = remove(&stream, &result_subject(&actor.options.run)).await;
        let _ = stream.delete_consumer(&actor.options.run).await;
    }
}
