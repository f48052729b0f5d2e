//! Messages of runs and workers: one line for each event, without errors of the client library.

use std::thread::sleep;
use std::time::Duration;

use super::server::{Run, Server, TellingWorker, wait_for_workers, worker, worker_that_tells};
use crate::program::{folder, run};

/// A run that takes longer than these tests.
const LONG: &str = "--no-render --preset climb --seed 7 --population 200 --generations 500";

/// Stops a worker with the interrupt key, and returns its messages. The worker must end within two seconds.
fn stopped(mut worker: TellingWorker, when: &str) -> String {
    worker.process.signal("-INT");
    let status = worker.process.end_within(Duration::from_secs(2), &format!("{when}: the worker"));
    let said = worker.said();
    assert!(status.success(), "{when}: {said}");
    let last = said.lines().last().expect("a line");
    assert!(last.starts_with("worker ") && last.contains(": stopped; "), "{when}: {said}");
    said
}

/// Returns the lines about the server.
fn of_server<'a>(said: &'a str, server: &Server) -> Vec<&'a str> {
    let start = format!("{}: ", server.url());
    said.lines().filter_map(|line| line.strip_prefix(start.as_str())).collect()
}

#[test]
fn a_worker_could_not_be_stopped_while_its_server_was_gone() {
    let Some(mut server) = Server::start() else { return };
    let mut workers: Vec<TellingWorker> =
        (0..7).map(|_| worker_that_tells(&server.url())).collect();
    let mut next = || workers.pop().expect("another one");
    wait_for_workers(&server, 7);
    stopped(next(), "idle");
    let place = folder();
    let mut run = Run::start(place.path(), LONG, &server.url());
    let at_work = next();
    at_work.wait_for("computing for climb-seed7-");
    run.wait_for_generations(2);
    let said = stopped(at_work, "at work");
    let host = snakes_cluster::host_name();
    let begins = said.lines().filter(|line| line.starts_with("computing for climb-seed7-"));
    let begins: Vec<&str> = begins.collect();
    assert!(matches!(begins[..], [line] if line.ends_with(&format!(" on {host}"))), "{said}");
    assert!(!said.ends_with("stopped; 0 evaluations\n"), "{said}");
    server.kill();
    sleep(Duration::from_millis(300));
    stopped(next(), "the server has just been killed");
    sleep(Duration::from_secs(7));
    stopped(next(), "the server has been away for some seconds");
    server.restart();
    sleep(Duration::from_millis(200));
    stopped(next(), "the server is back");
    sleep(Duration::from_secs(2));
    server.freeze(true);
    sleep(Duration::from_secs(1));
    stopped(next(), "the server does not answer");
    sleep(Duration::from_secs(7));
    stopped(next(), "the server has not answered for some seconds");
    drop(run);
}

#[test]
fn a_worker_that_dies_is_told_once() {
    let Some(server) = Server::start() else { return };
    let stays = worker_that_tells(&server.url());
    let dies = worker_that_tells(&server.url());
    let place = folder();
    let run = Run::start(place.path(), &format!("{LONG} --expect-workers 2"), &server.url());
    dies.wait_for("computing for climb-seed7-");
    drop(dies);
    run.wait_for(" lost");
    // A second message would follow when the worker is listed again without a sign of it.
    sleep(Duration::from_secs(4));
    stopped(stays, "at the end");
    run.wait_for(" left");
    let said = run.stopped();
    assert_eq!(said.lines().filter(|line| line.ends_with(" left")).count(), 1, "{said}");
    let lost: Vec<&str> = said.lines().filter(|line| line.contains(" lost")).collect();
    let words = " lost: no sign of it for 5 s; others compute what it had";
    assert!(
        matches!(lost[..], [line] if line.starts_with("worker ") && line.ends_with(words)),
        "{said}"
    );
}

#[test]
fn a_server_that_is_away_is_told_in_two_lines() {
    let Some(mut server) = Server::start() else { return };
    for is_killed in [true, false] {
        let worker = worker_that_tells(&server.url());
        let place = folder();
        let run = Run::start(place.path(), LONG, &server.url());
        worker.wait_for("computing for climb-seed7-");
        if is_killed {
            server.kill()
        } else {
            server.stop()
        }
        // The pause is longer than a worker may be silent.
        sleep(Duration::from_secs(7));
        server.restart();
        worker.wait_for("connected again");
        run.wait_for("connected again");
        let by_worker = stopped(worker, "after the fault");
        run.wait_for(" left");
        let by_run = run.stopped();
        for said in [&by_worker, &by_run] {
            let lines = of_server(said, &server);
            assert_eq!(
                lines,
                ["connection lost; waiting for the server", "connected again"],
                "killed: {is_killed}\n{said}"
            );
            assert!(!said.contains("no sign of it"), "{said}");
        }
        let of_worker = by_run.lines().filter(|line| line.starts_with("worker ")).count();
        assert_eq!(of_worker, 2, "it came and left: {by_run}");
    }
}

#[test]
fn a_run_that_waits_says_how_many_workers_there_are_and_how_to_start_and_to_continue() {
    let Some(server) = Server::start() else { return };
    let place = folder();
    let run = Run::start(place.path(), &format!("{LONG} --expect-workers 3"), &server.url());
    run.wait_for("0 of 3 workers; waiting");
    let _workers = [worker(&server.url()), worker(&server.url())];
    run.wait_for("2 of 3 workers; waiting");
    let said = run.stopped();
    let url = server.url();
    for words in [
        format!("0 of 3 workers; waiting (start one with: snakes worker --nats {url})"),
        "2 of 3 workers; waiting".to_owned(),
        "continue it with: snakes --no-render --resume ".to_owned(),
    ] {
        assert!(said.contains(&words), "{words}\n{said}");
    }
    assert!(said.trim_end().ends_with(&format!(" --nats {url}")), "{said}");
}

#[test]
fn only_a_run_that_is_there_can_be_removed() {
    let Some(server) = Server::start() else { return };
    let place = folder();
    let url = server.url();
    let purge = |name: &str| run(place.path(), &format!("machines --nats {url} --purge {name}"));
    let refused = |name: &str| {
        let output = purge(name);
        assert_eq!(output.status.code(), Some(2), "{output:?}");
        String::from_utf8(output.stderr).expect("UTF-8")
    };
    let none =
        "error: --purge is \"climb\"; allowed: the name of a run on the server, which has none\n";
    assert_eq!(refused("climb"), none);
    let killed = Run::start(place.path(), LONG, &url);
    sleep(Duration::from_secs(5));
    drop(killed);
    let line = refused("climb");
    let start = "error: --purge is \"climb\"; allowed: a run on the server: ";
    let name = line.strip_prefix(start).expect("its name").trim();
    let output = purge(name);
    assert!(output.status.success(), "{output:?}");
    assert_eq!(refused(name), none.replace("climb", name));
}

#[test]
fn a_wrong_address_is_wrong_usage() {
    let place = folder();
    for (address, offer) in
        [("127.0.0.1:24222", "nats://127.0.0.1:24222"), ("http://a", "nats://a:4222")]
    {
        for command in ["worker", "machines", "--no-render"] {
            let output = run(place.path(), &format!("{command} --nats {address}"));
            let line = String::from_utf8(output.stderr).expect("UTF-8");
            assert_eq!(output.status.code(), Some(2), "{line}");
            let start = format!("error: --nats is {address:?}; allowed: ");
            assert!(line.starts_with(&start) && line.trim().ends_with(offer), "{line}");
        }
    }
}
