//! What a worker tells and hears beside its batches: notices once a second, and requests to check a result.

use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::time::Instant;

use futures_util::StreamExt;

use super::{Workplace, compute};
use crate::cluster::error::ClusterError;
use crate::cluster::hello::{NOTICE_FORMAT, RunNotice, WorkerNotice, host_name, own_engine};
use crate::cluster::names::{NOTICE_INTERVAL, RUN_NOTICES, SILENCE, WORKER_NOTICES, audit_subject};
use crate::cluster::wire::{WorkBatch, line_of};
use crate::engine::{ENGINE_VERSION, Processors};

/// Tells of this worker once a second, and listens to coordinators. Ends when the worker is stopped, or with an error when
/// all coordinators compute with another engine.
pub async fn tell_and_listen(place: Arc<Workplace>) -> Option<ClusterError> {
    let client = place.broker.client();
    let mut heard = client.subscribe(RUN_NOTICES).await.ok();
    let mut ticks = tokio::time::interval(NOTICE_INTERVAL);
    let mut rate = Rate::new();
    let mut latest_run: Option<String> = None;
    let mut own_run: Option<Instant> = None;
    let mut foreign: Option<(Instant, RunNotice)> = None;
    loop {
        let notice = async {
            match &mut heard {
                Some(heard) => heard.next().await,
                None => std::future::pending().await,
            }
        };
        tokio::select! {
            _ = ticks.tick() => {
                let leaves = place.control.is_cancelled();
                let evaluations = place.evaluations.load(Relaxed);
                let notice = own_notice(&place, rate.update(evaluations), leaves);
                let _ = client.publish(WORKER_NOTICES, line_of(&notice).into()).await;
                if leaves {
                    return None;
                }
            }
            message = notice => {
                let Some(message) = message else { heard = None; continue };
                let Ok(notice) = RunNotice::read(&message.payload) else { continue };
                if latest_run.as_ref() != Some(&notice.run) {
                    // A coordinator that has just begun learns at once that this worker is there.
                    latest_run = Some(notice.run.clone());
                    ticks.reset_immediately();
                }
                match notice.proof == place.options.proof {
                    true => own_run = Some(Instant::now()),
                    false => {
                        let since = foreign.take().map_or_else(Instant::now, |(since, _)| since);
                        foreign = Some((since, notice));
                    }
                }
            }
        }
        let has_own = own_run.is_some_and(|at| at.elapsed() < SILENCE);
        let is_over = |since: &Instant| since.elapsed() > 2 * NOTICE_INTERVAL;
        if let Some((_, notice)) = foreign.take_if(|(since, _)| !has_own && is_over(since)) {
            place.control.cancel();
            return Some(ClusterError::OtherEngine {
                wanted: notice.engine_words(),
                run: notice.run,
                host: notice.host,
                own: own_engine(&place.options.proof),
            });
        }
    }
}

fn own_notice(place: &Workplace, per_s: f32, leaves: bool) -> WorkerNotice {
    WorkerNotice {
        format: NOTICE_FORMAT,
        worker: place.options.name.clone(),
        host: host_name(),
        engine: ENGINE_VERSION,
        processors: Processors::THIS,
        proof: place.options.proof.clone(),
        threads: u32::try_from(place.options.threads).unwrap_or(u32::MAX),
        evaluations: place.evaluations.load(Relaxed),
        per_s,
        redelivered: place.redelivered.load(Relaxed),
        leaves,
    }
}

/// Evaluations per second.
#[derive(Debug)]
struct Rate {
    at: Instant,
    evaluations: u64,
    per_s: f32,
}

impl Rate {
    fn new() -> Self {
        Self { at: Instant::now(), evaluations: 0, per_s: 0.0 }
    }

    /// The rate over the last ten seconds or so: later seconds weigh more.
    fn update(&mut self, evaluations: u64) -> f32 {
        let elapsed_s = self.at.elapsed().as_secs_f32();
        if elapsed_s > 0.0 {
            let now = (evaluations - self.evaluations) as f32 / elapsed_s;
            let weight = (elapsed_s / 5.0).min(1.0);
            self.per_s += (now - self.per_s) * weight;
            (self.at, self.evaluations) = (Instant::now(), evaluations);
        }
        self.per_s
    }
}

/// Answers requests to check a result of another worker.
pub async fn answer_audits(place: Arc<Workplace>) {
    let subject = audit_subject(&place.options.name);
    let Ok(mut requests) = place.broker.client().subscribe(subject).await else { return };
    while let Some(request) = requests.next().await {
        let (Some(reply), Ok(work)) = (request.reply, WorkBatch::decode(&request.payload)) else {
            continue;
        };
        let at_work = Arc::clone(&place);
        let results = tokio::task::spawn_blocking(move || compute(&at_work, &work)).await;
        // A request without an answer goes to another worker.
        if let Ok(Some(results)) = results {
            let _ = place.broker.client().publish(reply, results.encode().into()).await;
        }
    }
}
