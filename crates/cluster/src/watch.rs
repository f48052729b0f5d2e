//! Watches a server on a separate thread, for a window that must not wait: connects, lists the machines repeatedly, and
//! starts the coordinator of the run that the window evolves.

use std::sync::Arc;
use std::thread;
use std::time::Duration;

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded, unbounded};

use super::address::BrokerOptions;
use super::broker::Broker;
use super::compute::Simulator;
use super::coordinator::{Coordinator, CoordinatorOptions};
use super::error::{ClusterError, patiently};
use super::hello::random_number;
use super::machines::{Machines, machines};
use super::proof::proof;
use snakes_lab::run::Evaluator;

/// Handle of a watched server. Dropping it ends the connection in the background.
#[derive(Debug)]
pub struct ServerWatch {
    wanted: Sender<Option<WatchedRun>>,
    news: Receiver<WatchNews>,
    /// Becomes disconnected when the thread has ended.
    end: Receiver<()>,
}

/// A run that is to be evaluated on the workers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WatchedRun {
    /// Name of the run: letters, digits and hyphens. The server sees it with a random suffix, so that two windows never
    /// share a queue.
    pub name: String,
    /// Number of threads of this computer that compute as well.
    pub local_threads: usize,
}

/// News from a watched server.
#[derive(Debug, Clone)]
pub enum WatchNews {
    /// The server is connected.
    Connected {
        /// Proof of this program's engine.
        proof: String,
    },
    /// The machines on the server.
    Listed(Machines),
    /// A request to the server failed, or the server has no room for the connection. Holds the reason as one line. The
    /// attempt is repeated.
    Trouble(String),
    /// A coordinator was started.
    Coordinates {
        /// The requested run.
        run: WatchedRun,
        /// Name of the run on the server.
        name: String,
        /// Evaluator that uses the workers.
        evaluator: Arc<dyn Evaluator>,
    },
    /// The server cannot be used. Holds the reason as one line. No further news follow.
    Failed(String),
}

/// Pause between two lists of machines. Making a list takes two seconds.
const PAUSE: Duration = Duration::from_millis(50);
/// Pause after a failed request.
const RETRY_PAUSE: Duration = Duration::from_secs(1);

impl ServerWatch {
    /// Starts the thread, which connects to the server.
    ///
    /// # Errors
    /// The operating system could not start the thread.
    pub fn start(server: BrokerOptions) -> std::io::Result<Self> {
        let (wanted, asked) = unbounded();
        let (sender, news) = unbounded();
        let (ends, end) = bounded(0);
        thread::Builder::new().name("server watch".to_owned()).spawn(move || {
            let mut watcher =
                Watcher { server, asked, news: sender, current: None, replaced: Vec::new() };
            if let Err(error) = watcher.watch() {
                // Sending fails only after the watch was dropped.
                let _ = watcher.news.send(WatchNews::Failed(error.to_string()));
            }
            watcher.end();
            drop(ends);
        })?;
        Ok(Self { wanted, news, end })
    }

    /// Requests a coordinator for this run, which replaces the one before; `None` only removes it.
    /// [`WatchNews::Coordinates`] is the answer.
    pub fn coordinate(&self, run: Option<WatchedRun>) {
        // Sending fails only after the thread has failed, which was reported as `WatchNews::Failed`.
        let _ = self.wanted.send(run);
    }

    /// Returns the next news, or `None` if there are none.
    pub fn poll(&self) -> Option<WatchNews> {
        self.news.try_recv().ok()
    }

    /// Ends the connection, and waits for this at most as long as `wait`.
    pub fn end_within(self, wait: Duration) {
        let Self { wanted, news, end } = self;
        drop((wanted, news));
        let _ = end.recv_timeout(wait);
    }
}

/// State of the thread that watches a server.
struct Watcher {
    server: BrokerOptions,
    asked: Receiver<Option<WatchedRun>>,
    news: Sender<WatchNews>,
    /// The requested run, with its coordinator once that has started.
    current: Option<(WatchedRun, Option<Arc<Coordinator>>)>,
    /// Earlier coordinators that a run may still use. Their last references are dropped on this thread, because that
    /// takes time.
    replaced: Vec<Arc<Coordinator>>,
}

impl Watcher {
    /// Connects and lists the machines until the [`ServerWatch`] is dropped.
    fn watch(&mut self) -> Result<(), ClusterError> {
        let server = self.server.clone();
        let waits = |error: &ClusterError| {
            let _ = self.news.send(WatchNews::Trouble(error.to_string()));
            self.take_orders(RETRY_PAUSE)
        };
        let broker = patiently(waits, || Broker::connect(&server, "studio"))?;
        let proof = proof()?;
        let _ = self.news.send(WatchNews::Connected { proof: proof.clone() });
        let mut pause = Duration::ZERO;
        while self.take_orders(pause) {
            pause = PAUSE;
            let listed = self.coordinate(&proof).and_then(|()| machines(&broker));
            let news = match listed {
                Ok(machines) => WatchNews::Listed(machines),
                Err(error) if error.is_final() => return Err(error),
                Err(error) => {
                    pause = RETRY_PAUSE;
                    WatchNews::Trouble(error.to_string())
                }
            };
            if self.news.send(news).is_err() {
                break;
            }
            self.drop_unused();
        }
        Ok(())
    }

    /// Takes over the latest requested run, waiting for at most `pause`. Returns `false` if the [`ServerWatch`] was
    /// dropped.
    fn take_orders(&mut self, pause: Duration) -> bool {
        let mut wait = pause;
        loop {
            match self.asked.recv_timeout(wait) {
                Ok(wanted) => {
                    wait = Duration::ZERO;
                    if self.current.as_ref().map(|(run, _)| run) != wanted.as_ref() {
                        let before = self.current.take().and_then(|(_, coordinator)| coordinator);
                        self.replaced.extend(before);
                        self.current = wanted.map(|run| (run, None));
                    }
                }
                Err(RecvTimeoutError::Timeout) => return true,
                Err(RecvTimeoutError::Disconnected) => return false,
            }
        }
    }

    /// Starts the coordinator of the requested run, if it has not started yet.
    ///
    /// # Errors
    /// The coordinator cannot start, or the server refuses for good what it needs.
    fn coordinate(&mut self, proof: &str) -> Result<(), ClusterError> {
        if let Some((_, Some(coordinator))) = &self.current {
            return coordinator.refusal().map_or(Ok(()), |reason| Err(ClusterError::Ended(reason)));
        }
        let Some((run, coordinator @ None)) = &mut self.current else { return Ok(()) };
        let name = format!("{}-{:08x}", run.name, random_number() as u32);
        let broker = Broker::connect(&self.server, &name)?;
        let options = CoordinatorOptions {
            run: name.clone(),
            proof: proof.to_owned(),
            expect_workers: 0,
            local_threads: run.local_threads,
            ends_if_refused: false,
            compute: Arc::new(Simulator),
        };
        let started = Arc::new(Coordinator::start(broker, options)?);
        *coordinator = Some(Arc::clone(&started));
        let run = run.clone();
        let _ = self.news.send(WatchNews::Coordinates { run, name, evaluator: started });
        Ok(())
    }

    fn drop_unused(&mut self) {
        self.replaced.retain(|coordinator| Arc::strong_count(coordinator) > 1);
    }

    /// Waits until no run uses a coordinator.
    fn end(mut self) {
        self.replaced.extend(self.current.take().and_then(|(_, coordinator)| coordinator));
        // News that nobody received refer to coordinators, too.
        drop((self.news, self.asked));
        while !self.replaced.is_empty() {
            self.replaced.retain(|coordinator| Arc::strong_count(coordinator) > 1);
            thread::sleep(PAUSE);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_server_that_is_not_there_fails_with_one_line_and_the_thread_ends() {
        for (url, problem) in [
            ("nats://127.0.0.1:1", "nats://127.0.0.1:1: cannot connect"),
            ("nats://ann:secret@a", "nats is \"…@a\""),
        ] {
            let server = BrokerOptions { url: url.to_owned(), ..Default::default() };
            let watch = ServerWatch::start(server).expect("a thread");
            let news = watch.news.recv_timeout(Duration::from_secs(20)).expect("news in time");
            let WatchNews::Failed(line) = news else { panic!("{news:?}") };
            assert!(line.contains(problem) && !line.contains('\n'), "{line}");
            let ended = watch.end.recv_timeout(Duration::from_secs(5));
            assert_eq!(ended, Err(RecvTimeoutError::Disconnected));
        }
    }
}
