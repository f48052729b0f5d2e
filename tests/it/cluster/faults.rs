//! Faults at random times: the run continues or waits, loses nothing, and ends with the hash of a run on one machine.

use std::sync::OnceLock;
use std::thread::sleep;
use std::time::{Duration, Instant};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::proxy::Proxy;
use super::server::{Process, Run, Server, empty, fill, run_hash, say, worker};
use crate::program::{folder, json_lines};

/// A run with enough work left after the latest fault.
const RUN: &str = if cfg!(debug_assertions) {
    "--no-render --preset climb --seed 7 --population 40 --generations 16 --duration 8"
} else {
    "--no-render --preset climb --seed 7 --population 200 --generations 16 --duration 8"
};

/// Returns the hash of the run on this machine alone.
fn local_hash() -> &'static str {
    static HASH: OnceLock<String> = OnceLock::new();
    HASH.get_or_init(|| run_hash(&json_lines(folder().path(), &format!("{RUN} --json"))))
}

/// Returns how many times each fault is tried.
pub fn rounds() -> u64 {
    let wanted = std::env::var("SNAKES_FAULT_ROUNDS").ok().and_then(|text| text.parse().ok());
    wanted.unwrap_or(1)
}

/// The processes and connections of a test run that a fault can affect.
struct Room {
    server: Server,
    workers: Vec<Process>,
    run: Run,
    /// Connection of the coordinator, which can be cut.
    coordinator_proxy: Proxy,
    /// Connection of the first worker, which can be cut.
    worker_proxy: Proxy,
}

/// Runs with three workers, causes `fault` at a random time in the first half of the run, however fast the machine is, and compares
/// the hash.
fn with_fault(name: &str, mut fault: impl FnMut(&mut Room, &mut ChaCha8Rng)) {
    for round in 0..rounds() {
        let mut rng = ChaCha8Rng::seed_from_u64(round);
        let Some(server) = Server::start_small() else { return };
        let (coordinator_proxy, worker_proxy) = (Proxy::to(server.port), Proxy::to(server.port));
        let workers =
            vec![worker(&worker_proxy.url()), worker(&server.url()), worker(&server.url())];
        let folder = folder();
        let run = Run::start(folder.path(), RUN, &coordinator_proxy.url());
        let mut room = Room { server, workers, run, coordinator_proxy, worker_proxy };
        room.run.wait_for_generations(rng.random_range(1..9));
        sleep(Duration::from_millis(rng.random_range(0..300)));
        assert!(room.run.is_running(), "{name}, round {round}: the run is too short");
        let began = Instant::now();
        fault(&mut room, &mut rng);
        let hash = room.run.hash();
        assert_eq!(hash, local_hash(), "{name}, round {round}");
        let elapsed_s = began.elapsed().as_secs_f32();
        say(&format!("{name}, round {round}: {elapsed_s:.0} s after the fault"));
    }
}

/// Cuts connections for a while: a minute if faults are repeated.
fn cut(connections: &[&Proxy]) {
    connections.iter().for_each(|proxy| proxy.cut(true));
    sleep(Duration::from_secs(if rounds() > 1 { 60 } else { 12 }));
    connections.iter().for_each(|proxy| proxy.cut(false));
}

#[test]
fn a_worker_is_killed() {
    with_fault("worker killed", |room, _| drop(room.workers.remove(1)));
}

#[test]
fn a_worker_freezes_and_goes_on_later() {
    with_fault("worker frozen", |room, rng| {
        room.workers[1].signal("-STOP");
        sleep(Duration::from_millis(rng.random_range(3_000..12_000)));
        room.workers[1].signal("-CONT");
    });
}

#[test]
fn a_worker_is_ten_times_slower_than_the_others() {
    with_fault("slow worker", |room, _| {
        for _ in 0..10 {
            room.workers[1].signal("-STOP");
            sleep(Duration::from_millis(900));
            room.workers[1].signal("-CONT");
            sleep(Duration::from_millis(100));
        }
    });
}

#[test]
fn a_worker_arrives_late_and_the_others_leave() {
    with_fault("late worker", |room, _| {
        let url = room.server.url();
        // A stopped worker returns its batch to the queue.
        room.workers.iter().for_each(|worker| worker.signal("-INT"));
        sleep(Duration::from_secs(2));
        room.workers = vec![worker(&url)];
    });
}

#[test]
fn the_server_is_killed_and_started_again() {
    with_fault("server killed", |room, rng| {
        room.server.kill();
        sleep(Duration::from_millis(rng.random_range(100..5_000)));
        room.server.restart();
    });
}

#[test]
fn the_server_loses_its_store() {
    with_fault("store lost", |room, rng| {
        for _ in 0..2 {
            room.server.lose_store();
            sleep(Duration::from_millis(rng.random_range(100..5_000)));
            room.server.restart();
            sleep(Duration::from_millis(rng.random_range(100..3_000)));
        }
    });
}

#[test]
fn the_network_between_a_worker_and_the_server_is_cut() {
    with_fault("worker cut off", |room, _| cut(&[&room.worker_proxy]));
}

#[test]
fn the_network_between_the_coordinator_and_the_server_is_cut() {
    with_fault("coordinator cut off", |room, _| cut(&[&room.coordinator_proxy]));
}

#[test]
fn the_network_is_cut_around_the_server() {
    with_fault("server cut off", |room, _| cut(&[&room.coordinator_proxy, &room.worker_proxy]));
}

#[test]
fn the_coordinator_is_killed_and_continued() {
    with_fault("coordinator killed", |room, rng| {
        for _ in 0..2 {
            room.run.restart();
            sleep(Duration::from_millis(rng.random_range(500..3_000)));
        }
    });
}

#[test]
fn the_disk_of_the_server_is_full_for_a_while() {
    with_fault("disk full", |room, rng| {
        fill(&room.server);
        sleep(Duration::from_millis(rng.random_range(3_000..8_000)));
        empty(&room.server);
    });
}
