//! Workers that compute other bits are detected, and their tasks are computed again.

use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::SeqCst;
use std::thread::JoinHandle;

use snakes_cluster::{
    Broker, BrokerOptions, Compute, Outcome, Shared, Simulator, WorkerOptions, proof, work,
};
use snakes_lab::run::RunControl;

use super::server::{Run, Server, run_hash, worker};
use crate::program::{folder, json_lines};

const RUN: &str =
    "--no-render --preset climb --seed 5 --population 60 --generations 3 --duration 4";

/// Computes honestly for this number of results, then flips a bit of each trace.
#[derive(Debug)]
struct Liar {
    honest: AtomicU64,
}

impl Compute for Liar {
    fn outcome(&self, shared: &Shared, task: &str) -> Outcome {
        let mut outcome = Simulator.outcome(shared, task);
        let is_honest =
            self.honest.fetch_update(SeqCst, SeqCst, |left| left.checked_sub(1)).is_ok();
        if let (Outcome::Scored(Ok(scored)), false) = (&mut outcome, is_honest) {
            scored.evaluation.trace_hash ^= 1;
        }
        outcome
    }
}

/// Starts a worker within this process.
pub fn worker_with(
    url: &str,
    name: &str,
    threads: usize,
    compute: Arc<dyn Compute>,
) -> (Arc<RunControl>, JoinHandle<()>) {
    let control = Arc::new(RunControl::default());
    let options = BrokerOptions { url: url.to_owned(), ..BrokerOptions::default() };
    let (name, stopped) = (name.to_owned(), Arc::clone(&control));
    let thread = std::thread::spawn(move || {
        let broker = Broker::connect(&options, &name).expect("connected");
        let proof = proof().expect("the reference's bits");
        let options = WorkerOptions { name, threads, proof, compute };
        work(&Arc::new(broker), options, &stopped).expect("no fault");
    });
    (control, thread)
}

/// Runs with two honest workers and a liar. Returns the hash, and the coordinator's messages.
fn with_liar(honest: u64) -> Option<(String, String)> {
    let server = Server::start()?;
    let _workers = [worker(&server.url()), worker(&server.url())];
    let liar = Arc::new(Liar { honest: AtomicU64::new(honest) });
    let (control, thread) = worker_with(&server.url(), "liar", 1, liar);
    let folder = folder();
    let run = Run::start(folder.path(), &format!("{RUN} --expect-workers 3"), &server.url());
    let (lines, said) = run.finished();
    control.cancel();
    thread.join().expect("it ends");
    Some((run_hash(&lines), said))
}

fn local_hash() -> String {
    run_hash(&json_lines(folder().path(), &format!("{RUN} --json")))
}

#[test]
fn a_worker_that_flips_a_bit_is_found_before_any_of_its_results_counts() {
    let Some((hash, said)) = with_liar(0) else { return };
    assert!(said.contains("worker liar on") && said.contains("computes other bits"), "{said}");
    assert!(!said.contains("begins again"), "{said}");
    assert_eq!(hash, local_hash());
}

#[test]
fn a_worker_that_begins_to_flip_bits_later_is_found_and_everything_begins_again() {
    let run = "--no-render --preset climb --seed 5 --population 200 --generations 6 --duration 4";
    let Some(server) = Server::start() else { return };
    let _worker = worker(&server.url());
    let (_control, _thread) =
        worker_with(&server.url(), "liar", 1, Arc::new(Liar { honest: AtomicU64::new(150) }));
    let place = folder();
    let under_way = Run::start(place.path(), &format!("{run} --expect-workers 2"), &server.url());
    let (lines, said) = under_way.finished();
    assert!(said.contains("worker liar on") && said.contains("begins again"), "{said}");
    let local = json_lines(folder().path(), &format!("{run} --json"));
    assert_eq!(run_hash(&lines), run_hash(&local));
}
