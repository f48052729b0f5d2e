//! Many workers, which sleep instead of evaluating.

use std::sync::Arc;
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering::SeqCst;
use std::time::{Duration, Instant};

use snakes_cluster::{
    Broker, BrokerOptions, Compute, Coordinator, CoordinatorOptions, Outcome, Shared, proof,
};
use snakes_core::evolve::Settings;
use snakes_core::genome::Genome;
use snakes_core::rng::{Purpose, stream};
use snakes_core::save::shipped_champion;
use snakes_core::score::Scored;
use snakes_lab::run::{Evaluator, RunControl};

use super::liars::worker_with;
use super::server::Server;

/// Sleeps instead of evaluating, and returns the same evaluation for each genome.
#[derive(Debug)]
struct Sleeper {
    scored: Scored,
}

impl Compute for Sleeper {
    fn outcome(&self, _: &Shared, _: &str) -> Outcome {
        std::thread::sleep(Duration::from_millis(20));
        Outcome::Scored(Ok(self.scored.clone()))
    }
}

/// Returns the resident memory of this process, in MiB.
fn resident_mib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux");
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).expect("a line");
    line.split_whitespace().nth(1).expect("a number").parse::<u64>().expect("kB") / 1024
}

#[test]
#[ignore = "takes about three minutes: cargo test --release --test it scale -- --ignored --nocapture"]
fn two_hundred_workers_are_kept_busy_and_memory_stays_flat() {
    const WORKERS: usize = 200;
    const CALLS: u64 = 50;
    const GENOMES: u32 = 10_000;
    let Some(server) = Server::start() else { return };
    let evaluation = shipped_champion().expect("well formed").champion.evaluation;
    let compute: Arc<dyn Compute> =
        Arc::new(Sleeper { scored: Scored { evaluation, episode: None } });
    let workers: Vec<_> = (0..WORKERS)
        .map(|number| worker_with(&server.url(), &format!("w{number}"), 1, Arc::clone(&compute)))
        .collect();
    let options = BrokerOptions { url: server.url(), ..BrokerOptions::default() };
    let broker = Broker::connect(&options, "scale").expect("connected");
    let options = CoordinatorOptions {
        ends_if_refused: true,
        run: "scale".to_owned(),
        proof: proof().expect("the reference's bits"),
        expect_workers: WORKERS,
        local_threads: 0,
        compute,
    };
    let coordinator = Coordinator::start(broker, options).expect("started");
    let settings = Settings::default();
    let (control, shape) = (RunControl::default(), settings.trial.genome_shape());
    let mut memory_mib = Vec::new();
    let began = Instant::now();
    let mut first_s = 0.0;
    for call in 0..CALLS {
        let genome = |number| {
            let mut rng = stream(call, 1, number, Purpose::Birth);
            settings.genome.random_genome(shape, &mut rng)
        };
        let genomes: Vec<Genome> = (0..GENOMES).map(genome).collect();
        let genomes: Vec<&Genome> = genomes.iter().collect();
        let reported = AtomicUsize::new(0);
        let count = |_, _| {
            reported.fetch_add(1, SeqCst);
        };
        let done = coordinator.evaluate_batch(&settings.trial, &genomes, &control, &count);
        done.expect("not cancelled");
        assert_eq!(reported.into_inner(), GENOMES as usize);
        memory_mib.push(resident_mib());
        if call == 0 {
            // The first call waits for the workers and checks each of them, so its time is subtracted.
            first_s = began.elapsed().as_secs_f64();
        }
    }
    let rate = f64::from(GENOMES) * (CALLS - 1) as f64 / (began.elapsed().as_secs_f64() - first_s);
    eprintln!("{rate:.0} evaluations per second; memory in MiB after each call: {memory_mib:?}");
    let (early, late) = (memory_mib[4], memory_mib[memory_mib.len() - 1]);
    assert!(late <= early + 30, "{early} MiB, then {late} MiB");
    drop(coordinator);
    workers.iter().for_each(|(control, _)| control.cancel());
    workers.into_iter().for_each(|(_, thread)| thread.join().expect("it ends"));
}
