//! A server as a window watches it: the machines that are listed, and the coordinator that is started.

use std::thread::sleep;
use std::time::{Duration, Instant};

use snakes_cluster::{Broker, BrokerOptions, ServerWatch, WatchNews, WatchedRun, machines, proof};
use snakes_core::evolve::{RunPlan, Settings};
use snakes_lab::run::{Evaluator, Experiment, LocalPool, RunControl};

use super::server::{Server, worker};

#[test]
fn f3_a_window_waits_for_room_on_its_server_and_ends_what_the_server_refuses_for_good() {
    let Some(mut server) = Server::start_as("max_connections: 1\njetstream { }\n") else { return };
    let taken = server.take_only_connection();
    let options = BrokerOptions { url: server.url(), ..BrokerOptions::default() };
    let watch = ServerWatch::start(options).expect("a thread");
    let next = || {
        let began = Instant::now();
        loop {
            assert!(began.elapsed() < Duration::from_secs(30), "news in time");
            match watch.poll() {
                Some(WatchNews::Listed(_)) | None => sleep(Duration::from_millis(20)),
                Some(news) => return news,
            }
        }
    };
    let news = next();
    let WatchNews::Trouble(line) = &news else { panic!("{news:?}") };
    assert!(line.contains("the server says: maximum connections exceeded"), "{line}");
    drop(taken);
    while !matches!(next(), WatchNews::Connected { .. }) {}
    server.change(
        "jetstream { }\nno_auth_user: a\nauthorization { users = [ { user: a, password: b, permissions: { publish: \
         \"x\" } } ] }\n",
    );
    let line = loop {
        if let WatchNews::Failed(line) = next() {
            break line;
        }
    };
    assert!(line.contains("the server says: Permissions Violation for Publish to "), "{line}");
}

/// Returns the hash of a short run with this evaluator.
fn hash_with(evaluator: &dyn Evaluator) -> u64 {
    let mut settings = Settings::default();
    settings.evolution.population = 40;
    settings.evolution.generations = 3;
    settings.trial.duration_s = 2.0;
    let mut experiment = Experiment::new(RunPlan::new("window", 3, settings));
    while !experiment.is_over() {
        experiment.run_generation(evaluator, &RunControl::default()).expect("not cancelled");
    }
    assert_eq!(evaluator.fault(), None);
    experiment.run_hash()
}

#[test]
fn a_watched_server_lists_its_machines_and_gives_the_run_of_a_window_the_local_hash() {
    let Some(server) = Server::start() else { return };
    let _worker = worker(&server.url());
    let options = BrokerOptions { url: server.url(), ..BrokerOptions::default() };
    let watch = ServerWatch::start(options.clone()).expect("a thread");
    let asked = WatchedRun { name: "window".to_owned(), local_threads: 1 };
    watch.coordinate(Some(asked.clone()));
    let (mut connected, mut listed, mut coordinates) = (None, None, None);
    let began = Instant::now();
    while listed.is_none() || coordinates.is_none() {
        assert!(began.elapsed() < Duration::from_secs(120), "{connected:?} {listed:?}");
        match watch.poll() {
            Some(WatchNews::Connected { proof }) => connected = Some(proof),
            Some(WatchNews::Listed(machines)) => {
                let is_there = !machines.workers.is_empty() && !machines.runs.is_empty();
                listed = is_there.then_some(machines).or(listed);
            }
            Some(WatchNews::Coordinates { run, name, evaluator }) => {
                assert!(run == asked && name.starts_with("window-"), "{name}");
                coordinates = Some((name, evaluator));
            }
            Some(other) => panic!("{other:?}"),
            None => sleep(Duration::from_millis(20)),
        }
    }
    let own = proof().expect("the reference's bits");
    assert_eq!(connected.as_ref(), Some(&own));
    let (name, evaluator) = coordinates.expect("there");
    let listed = listed.expect("there");
    assert_eq!(listed.runs.keys().collect::<Vec<_>>(), [&name]);
    assert!(listed.workers.values().all(|worker| worker.proof == own));

    assert_eq!(hash_with(&*evaluator), hash_with(&LocalPool::new(2).expect("threads")));
    drop(evaluator);
    watch.end_within(Duration::from_secs(20));
    let left = machines(&Broker::connect(&options, "test").expect("connected")).expect("a list");
    assert!(left.runs.is_empty() && left.queues.is_empty(), "{left:?}");
}
