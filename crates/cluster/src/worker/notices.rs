//! Messages of a worker besides its batches: a notice once a second, and answers to requests to check a result.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::time::{Duration, Instant};

use futures_util::StreamExt;

use super::{Workplace, compute, stopped};
use crate::error::ClusterError;
use crate::hello::{RunNotice, WorkerNotice, host_name, own_engine};
use crate::names::{NOTICE_INTERVAL, RUN_NOTICES, SILENCE, WORKER_NOTICES, audit_subject};
use crate::wire::{WIRE_FORMAT, WorkBatch, line_of};
use snakes_core::{ENGINE_VERSION, Processors};
use snakes_lab::run::headless::say;
use snakes_lab::run::with_threads;

/// Sends a notice of this worker once a second, and listens to coordinators. Returns when the worker is stopped, with
/// an error if it stops because all coordinators compute with another engine, or because the server refuses for good
/// what the worker needs.
pub async fn tell_and_listen(place: Arc<Workplace>) -> Option<ClusterError> {
    let client = &place.broker.client;
    let mut heard = client.subscribe(RUN_NOTICES).await.ok();
    let mut ticks = tokio::time::interval(NOTICE_INTERVAL);
    let mut rate = RecentRate::default();
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
            () = stopped(&place.control, Duration::ZERO) => {
                tell(&place, rate.update(Instant::now(), place.evaluations.load(Relaxed)), true).await;
                return None;
            }
            refusal = place.broker.connection.refusal() => {
                place.control.cancel();
                return Some(place.broker.refused("the work", refusal));
            }
            _ = ticks.tick() => {
                let evaluations = place.evaluations.load(Relaxed);
                // A lost connection is reported elsewhere and needs no further lines.
                let news = (!place.broker.connection.is_lost())
                    .then(|| place.activity.news(Instant::now(), evaluations));
                if let Some(line) = news.flatten() {
                    say(&line);
                }
                tell(&place, rate.update(Instant::now(), evaluations), false).await;
            }
            message = notice => {
                let Some(message) = message else { heard = None; continue };
                let Ok(notice) = RunNotice::read(&message.payload) else { continue };
                place.activity.hear(&notice).iter().for_each(|line| say(line));
                if latest_run.as_ref() != Some(&notice.run) {
                    // A notice is sent at once, so that a new coordinator learns early of this worker.
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

async fn tell(place: &Workplace, per_s: f32, leaves: bool) {
    let notice = own_notice(place, per_s, leaves);
    let _ = place.broker.client.publish(WORKER_NOTICES, line_of(&notice).into()).await;
}

fn own_notice(place: &Workplace, per_s: f32, leaves: bool) -> WorkerNotice {
    WorkerNotice {
        format: WIRE_FORMAT,
        worker: place.options.name.clone(),
        host: host_name(),
        engine: ENGINE_VERSION,
        processors: Processors::THIS,
        proof: place.options.proof.clone(),
        threads: u32::try_from(place.options.threads).unwrap_or(u32::MAX),
        evaluations: place.evaluations.load(Relaxed),
        per_s,
        redelivered: place.redelivered.load(Relaxed),
        trouble: place.broker.connection.trouble(),
        leaves,
    }
}

/// Times and numbers of evaluations within the last seconds, from which the rate is computed.
#[derive(Debug, Default)]
struct RecentRate(VecDeque<(Instant, u64)>);

/// Time span over which the rate is averaged.
const RATE_WINDOW: Duration = Duration::from_secs(5);

impl RecentRate {
    /// Adds the number of evaluations since the start. Returns the evaluations per second over the last five seconds.
    fn update(&mut self, now: Instant, evaluations: u64) -> f32 {
        self.0.push_back((now, evaluations));
        // The latest entry before the window marks its beginning.
        while self.0.get(1).is_some_and(|(at, _)| now.duration_since(*at) >= RATE_WINDOW) {
            self.0.pop_front();
        }
        let (since, before) = self.0[0];
        let elapsed_s = now.duration_since(since).as_secs_f32();
        if elapsed_s > 0.0 { (evaluations - before) as f32 / elapsed_s } else { 0.0 }
    }
}

/// Answers requests to check a result of another worker.
pub async fn answer_audits(place: Arc<Workplace>) {
    let subject = audit_subject(&place.options.name);
    let Ok(mut requests) = place.broker.client.subscribe(subject).await else { return };
    while let Some(request) = requests.next().await {
        let (Some(reply), Ok(work)) = (request.reply, WorkBatch::decode(&request.payload)) else {
            continue;
        };
        let at_work = Arc::clone(&place);
        let check = || tokio::task::spawn_blocking(move || compute(&at_work, &work));
        // If a request has no answer, the coordinator's machine makes the check.
        let Ok(check) = with_threads(check) else { continue };
        if let Ok(Some(results)) = check.await {
            let _ = place.broker.client.publish(reply, results.encode().into()).await;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_is_that_of_the_last_five_seconds_and_falls_to_zero_after_the_work() {
        let mut rate = RecentRate::default();
        let began = Instant::now();
        let mut at = |second: u64, evaluations| {
            rate.update(began + Duration::from_secs(second), evaluations)
        };
        let working: Vec<f32> = (0..=10).map(|second| at(second, 20 * second)).collect();
        assert_eq!((working[0], working[1], working[10]), (0.0, 20.0, 20.0));
        let idle: Vec<f32> = (11..=15).map(|second| at(second, 200)).collect();
        assert_eq!(idle, [16.0, 12.0, 8.0, 4.0, 0.0]);
    }
}
