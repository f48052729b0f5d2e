//! Watches a server from a thread of its own, for a window that must not wait: connects, lists the machines again and
//! again, and starts the coordinator of the run that the window evolves.

use std::sync::Arc;
use std::thread;
use std::time::Duration;

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded, unbounded};

use super::address::BrokerOptions;
use super::broker::Broker;
use super::compute::Simulator;
use super::coordinator::{Coordinator, CoordinatorOptions};
use super::error::ClusterError;
use super::hello::random_number;
use super::machines::{Machines, machines};
use super::proof::proof;
use snakes_lab::run::Evaluator;

/// A server that is watched. Dropping this ends the connection in the background.
#[derive(Debug)]
pub struct ServerWatch {
    wanted: Sender<Option<WatchedRun>>,
    news: Receiver<WatchNews>,
    /// Disconnected when the thread has ended.
    end: Receiver<()>,
}

/// A run that is to be computed on the workers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WatchedRun {
    /// Its name: letters, digits and hyphens. On the server it gets a suffix, so that two windows never share a queue.
    pub name: String,
    /// Number of threads of this computer that compute, too.
    pub local_threads: usize,
}

/// News from a watch.
#[derive(Debug, Clone)]
pub enum WatchNews {
    /// The server is connected.
    Connected {
        /// The proof of the engine of this program.
        proof: String,
    },
    /// The machines on the server.
    Listed(Machines),
    /// The server did not answer, and why, in a line. It is asked again.
    NoAnswer(String),
    /// A coordinator was started.
    Coordinates {
        /// The run that was asked for.
        run: WatchedRun,
        /// The run's name on the server.
        name: String,
        /// Evaluates on the workers.
        evaluator: Arc<dyn Evaluator>,
    },
    /// The server cannot be used, and why, in a line. No more news follow.
    Failed(String),
}

/// Pause between two lists; a list takes two seconds.
const PAUSE: Duration = Duration::from_millis(50);
/// Pause after a request that failed.
const RETRY_PAUSE: Duration = Duration::from_secs(1);

impl ServerWatch {
    /// Begins to connect.
    ///
    /// # Errors
    /// The thread could not be started.
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

    /// Asks for a coordinator of this run in place of the one before, or for none. [`WatchNews::Coordinates`] answers.
    pub fn coordinate(&self, run: Option<WatchedRun>) {
        // Sending fails only after the thread has failed, which is in the news.
        let _ = self.wanted.send(run);
    }

    /// The next news, if there are any.
    pub fn poll(&self) -> Option<WatchNews> {
        self.news.try_recv().ok()
    }

    /// Ends the connection, and waits at most this long until that is done.
    pub fn end_within(self, wait: Duration) {
        let Self { wanted, news, end } = self;
        drop((wanted, news));
        let _ = end.recv_timeout(wait);
    }
}

/// The state of the thread.
struct Watcher {
    server: BrokerOptions,
    asked: Receiver<Option<WatchedRun>>,
    news: Sender<WatchNews>,
    /// The run that is asked for, and its coordinator once that is started.
    current: Option<(WatchedRun, Option<Arc<Coordinator>>)>,
    /// Earlier coordinators that a run may still use. The last reference is dropped here, because that takes time.
    replaced: Vec<Arc<Coordinator>>,
}

impl Watcher {
    /// Watches until the [`ServerWatch`] is dropped.
    fn watch(&mut self) -> Result<(), ClusterError> {
        let broker = Broker::connect(&self.server, "studio")?;
        let proof = proof()?;
        let _ = self.news.send(WatchNews::Connected { proof: proof.clone() });
        let mut pause = Duration::ZERO;
        while self.take_orders(pause) {
            pause = PAUSE;
            let listed = self.coordinate(&proof).and_then(|()| machines(&broker));
            let news = listed.map_or_else(
                |error| {
                    pause = RETRY_PAUSE;
                    WatchNews::NoAnswer(error.to_string())
                },
                WatchNews::Listed,
            );
            if self.news.send(news).is_err() {
                break;
            }
            self.drop_unused();
        }
        Ok(())
    }

    /// Takes over what was asked for. False if the [`ServerWatch`] was dropped.
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

    /// Starts the coordinator that is asked for, if it is not there yet.
    fn coordinate(&mut self, proof: &str) -> Result<(), ClusterError> {
        let Some((run, coordinator @ None)) = &mut self.current else { return Ok(()) };
        let name = format!("{}-{:08x}", run.name, random_number() as u32);
        let broker = Broker::connect(&self.server, &name)?;
        let options = CoordinatorOptions {
            run: name.clone(),
            proof: proof.to_owned(),
            expect_workers: 0,
            local_threads: run.local_threads,
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

    /// Waits until no run uses a coordinator any more.
    fn end(mut self) {
        self.replaced.extend(self.current.take().and_then(|(_, coordinator)| coordinator));
        // News that nobody has received refer to them, too.
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
