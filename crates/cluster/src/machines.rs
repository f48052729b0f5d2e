//! The workers and runs on a server, and the batches and results that wait in its queues.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use futures_util::{StreamExt, TryStreamExt};
use serde::Serialize;

use super::broker::Broker;
use super::error::ClusterError;
use super::hello::{RunNotice, WorkerNotice};
use super::names::{NOTICE_INTERVAL, check_name, result_subject, work_subject, worker_consumer};
use super::store::remove;
use super::trouble::Trouble;
use snakes_core::check::{Invalid, quoted};

/// Time during which notices are collected. Each machine sends two notices in this time.
const LISTENING: Duration = Duration::from_millis(2 * NOTICE_INTERVAL.as_millis() as u64 + 200);

/// Numbers of batches and results that wait on the server for one run.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct RunQueue {
    /// Number of batches that no worker has finished.
    pub batches: u64,
    /// Number of results that no coordinator has fetched.
    pub results: u64,
}

/// The machines on a server, and their queues.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Machines {
    /// Latest notices of the workers, by name.
    pub workers: BTreeMap<String, WorkerNotice>,
    /// Latest notices of the runs that have a coordinator, by name.
    pub runs: BTreeMap<String, RunNotice>,
    /// Queues, by the name of the run.
    pub queues: BTreeMap<String, RunQueue>,
    /// Number of batches that workers have fetched but not acknowledged, by the proof of their engine.
    pub in_work: BTreeMap<String, u64>,
}

/// Listens to notices for two seconds, then reads the queues from the server.
///
/// # Errors
/// The server refuses a request.
pub fn machines(broker: &Broker) -> Result<Machines, ClusterError> {
    broker.ask("listing the machines", async {
        let mut machines = heard(broker).await?;
        queues(broker, &mut machines).await?;
        Ok(machines)
    })
}

async fn heard(broker: &Broker) -> Result<Machines, Trouble> {
    let (mut workers, mut runs) = broker.notices().await?;
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

async fn queues(broker: &Broker, machines: &mut Machines) -> Result<(), Trouble> {
    let streams = [broker.work_stream().await?, broker.result_stream().await?];
    for (stream, is_work) in streams.iter().zip([true, false]) {
        let info = stream.info_with_subjects(">").await?;
        let subjects: Vec<(String, usize)> = info.try_collect().await?;
        for (subject, messages) in subjects {
            // A subject ends with the name of the run.
            let run = subject.rsplit('.').next().unwrap_or_default().to_owned();
            let queue = machines.queues.entry(run).or_default();
            let count = if is_work { &mut queue.batches } else { &mut queue.results };
            *count += messages as u64;
        }
    }
    // A run that was killed leaves a consumer, even if no message waits.
    let consumers: Vec<String> = streams[1].consumer_names().try_collect().await?;
    let abandoned = consumers.into_iter().filter(|run| !machines.runs.contains_key(run));
    for run in abandoned.collect::<Vec<String>>() {
        machines.queues.entry(run).or_default();
    }
    let proofs = machines.workers.values().map(|worker| worker.proof.clone());
    for proof in proofs.collect::<BTreeSet<String>>() {
        if let Ok(info) = streams[0].consumer_info(worker_consumer(&proof)).await {
            machines.in_work.insert(proof, info.num_ack_pending as u64);
        }
    }
    Ok(())
}

/// Removes the batches and results that wait for a run. Returns how many were removed.
///
/// # Errors
/// The server has no such run, or refuses the request.
pub fn purge(broker: &Broker, run: &str) -> Result<RunQueue, ClusterError> {
    check_name("--purge", run)?;
    let Machines { runs, queues, .. } = machines(broker)?;
    let known: BTreeSet<&str> = runs.keys().chain(queues.keys()).map(String::as_str).collect();
    if !known.contains(run) {
        let names = known.into_iter().collect::<Vec<&str>>().join(", ");
        let allowed = match names.is_empty() {
            true => "the name of a run on the server, which has none".to_owned(),
            false => format!("a run on the server: {names}"),
        };
        return Err(Invalid::new("--purge", quoted(run), allowed).into());
    }
    broker.ask("the removal", async {
        let (work, results) = (broker.work_stream().await?, broker.result_stream().await?);
        let batches = remove(&work, &work_subject("*", run)).await?;
        let found = remove(&results, &result_subject(run)).await?;
        let _ = results.delete_consumer(run).await;
        Ok(RunQueue { batches, results: found })
    })
}
