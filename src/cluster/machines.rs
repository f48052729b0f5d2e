//! Who is there: the workers and runs on a server, and what waits in its queues.

use std::collections::BTreeMap;
use std::time::Duration;

use futures_util::{StreamExt, TryStreamExt};
use serde::Serialize;

use super::broker::{Broker, one_line, result_stream, work_stream};
use super::error::ClusterError;
use super::hello::{RunNotice, WorkerNotice};
use super::names::{
    NOTICE_INTERVAL, RUN_NOTICES, WORKER_NOTICES, check_name, result_subject, worker_consumer,
};

/// How long notices are listened to: each machine sends two in this time.
const LISTENING: Duration = Duration::from_millis(2 * NOTICE_INTERVAL.as_millis() as u64 + 200);

/// What waits on the server for one run.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct RunQueue {
    /// Batches that no worker has finished.
    pub batches: u64,
    /// Results that no coordinator has fetched.
    pub results: u64,
}

/// The machines on a server.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Machines {
    /// The workers, by name.
    pub workers: BTreeMap<String, WorkerNotice>,
    /// The runs with a coordinator, by name.
    pub runs: BTreeMap<String, RunNotice>,
    /// What waits, by the name of the run.
    pub queues: BTreeMap<String, RunQueue>,
    /// Number of batches that workers have, by the proof of their engine.
    pub in_work: BTreeMap<String, u64>,
}

/// Listens for two seconds, and asks for the queues.
///
/// # Errors
/// The server refuses a request.
pub fn machines(broker: &Broker) -> Result<Machines, ClusterError> {
    broker.runtime().block_on(async {
        let mut machines = heard(broker).await?;
        let queues = queues(broker, &mut machines).await;
        queues.map_err(|problem| broker.refused("the list of queues", problem))?;
        Ok(machines)
    })
}

async fn heard(broker: &Broker) -> Result<Machines, ClusterError> {
    let subscribed = async {
        let workers = broker.client().subscribe(WORKER_NOTICES).await?;
        Ok::<_, async_nats::SubscribeError>((
            workers,
            broker.client().subscribe(RUN_NOTICES).await?,
        ))
    };
    let (mut workers, mut runs) =
        subscribed.await.map_err(|error| broker.refused("listening", one_line(&error)))?;
    let mut machines = Machines::default();
    let end = tokio::time::sleep(LISTENING);
    tokio::pin!(end);
    loop {
        tokio::select! {
            () = &mut end => return Ok(machines),
            Some(message) = workers.next() => {
                if let Ok(notice) = WorkerNotice::read(&message.payload) {
                    match notice.leaves {
                        true => machines.workers.remove(&notice.worker),
                        false => machines.workers.insert(notice.worker.clone(), notice),
                    };
                }
            }
            Some(message) = runs.next() => {
                if let Ok(notice) = RunNotice::read(&message.payload) {
                    machines.runs.insert(notice.run.clone(), notice);
                }
            }
        }
    }
}

async fn queues(broker: &Broker, machines: &mut Machines) -> Result<(), String> {
    let jetstream = broker.jetstream();
    let streams = [work_stream(jetstream).await?, result_stream(jetstream).await?];
    for (stream, is_work) in streams.iter().zip([true, false]) {
        let info = stream.info_with_subjects(">").await.map_err(|error| one_line(&error))?;
        let subjects: Vec<(String, usize)> =
            info.try_collect().await.map_err(|error| one_line(&error))?;
        for (subject, messages) in subjects {
            // A subject ends with the name of the run.
            let run = subject.rsplit('.').next().unwrap_or_default().to_owned();
            let queue = machines.queues.entry(run).or_default();
            let count = if is_work { &mut queue.batches } else { &mut queue.results };
            *count += messages as u64;
        }
    }
    let proofs = machines.workers.values().map(|worker| worker.proof.clone());
    for proof in proofs.collect::<std::collections::BTreeSet<String>>() {
        if let Ok(info) = streams[0].consumer_info(worker_consumer(&proof)).await {
            machines.in_work.insert(proof, info.num_ack_pending as u64);
        }
    }
    Ok(())
}

/// Removes what waits for a run. Returns the numbers of batches and results that were removed.
///
/// # Errors
/// The name is not allowed, or the server refuses the request.
pub fn purge(broker: &Broker, run: &str) -> Result<RunQueue, ClusterError> {
    check_name("--purge", run)?;
    let purged = broker.runtime().block_on(async {
        let (work, results) =
            (work_stream(broker.jetstream()).await?, result_stream(broker.jetstream()).await?);
        let batches = work.purge().filter(format!("snakes.work.*.{run}")).await;
        let found = results.purge().filter(result_subject(run)).await;
        let _ = results.delete_consumer(run).await;
        Ok::<_, String>(RunQueue {
            batches: batches.map_err(|error| one_line(&error))?.purged,
            results: found.map_err(|error| one_line(&error))?.purged,
        })
    });
    purged.map_err(|problem| broker.refused("the removal", problem))
}
