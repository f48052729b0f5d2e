//! A server that refuses something: both sides name its answer. What lacks room waits and goes on by itself, and what can never get
//! better ends at once.

use std::sync::OnceLock;
use std::time::{Duration, Instant};

use super::refusals::refusals;
use super::server::{
    Run, Server, TellingWorker, empty, fill, run_hash, wait_for_list, wait_for_workers,
    worker_that_tells,
};
use crate::program::{folder, json_lines, run};

const RUN: &str =
    "--no-render --preset climb --seed 7 --population 40 --generations 4 --duration 4";
/// The server's answer when its store is full.
const FULL: &str =
    "the server says: insufficient resources (code 503, error code 10023); make room in its store";

/// Returns the hash of the run on this machine alone.
fn local_hash() -> &'static str {
    static HASH: OnceLock<String> = OnceLock::new();
    HASH.get_or_init(|| run_hash(&json_lines(folder().path(), &format!("{RUN} --json"))))
}

/// Waits for the success of a run, compares its hash, and returns its standard error.
fn finished(mut run: Run) -> String {
    run.wait_for_end(Duration::from_mins(2));
    let (lines, said) = run.finished();
    assert_eq!(run_hash(&lines), local_hash());
    said
}

/// Stops a worker with the interrupt key, and returns its messages.
fn stopped(worker: TellingWorker) -> String {
    worker.process.signal("-INT");
    worker.said()
}

#[test]
fn f3_a_store_that_one_queue_fills_delays_a_run_and_changes_no_bit() {
    let Some(server) = Server::start_as("jetstream { max_file_store: 20KB }") else { return };
    let _worker = worker_that_tells(&server.url());
    let place = folder();
    finished(Run::start(place.path(), RUN, &server.url()));
}

#[test]
fn f3_a_full_store_is_named_by_both_sides_and_the_run_goes_on_once_there_is_room() {
    let Some(server) = Server::start_small() else { return };
    let (place, url) = (folder(), server.url());
    let worker = worker_that_tells(&url);
    // The worker makes the streams, for which a full store has no room either.
    wait_for_workers(&server, 1);
    fill(&server);
    let under_way = Run::start(place.path(), RUN, &url);
    let of_run = format!("{url}: work cannot be stored: {FULL}");
    under_way.wait_for(&of_run);
    let listed = format!("    work cannot be stored: {FULL}");
    wait_for_list(&server, "", |list| list.contains(&listed));
    worker.wait_for(FULL);
    empty(&server);
    let by_run = finished(under_way);
    worker.wait_for(": over: work cannot be stored");
    let by_worker = stopped(worker);
    assert_eq!(by_run.lines().filter(|line| line.starts_with(&of_run)).count(), 1, "{by_run}");
    assert!(by_run.contains(&format!("{url}: work cannot be stored: over")), "{by_run}");
    let of_run = |line: &&str| line.starts_with("run ") && line.contains(FULL);
    let lines: Vec<&str> = by_worker.lines().filter(of_run).collect();
    assert!(
        matches!(lines[..], [_, over] if over.contains(": over: work cannot be stored")),
        "{by_worker}"
    );
    for said in [&by_run, &by_worker] {
        assert!(!said.contains("does not answer"), "{said}");
    }
}

#[test]
fn f3_limits_of_connections_streams_and_consumers_are_waited_for() {
    let limited = |streams: u32, consumers: u32, connections: u32| {
        format!(
            "max_connections: {connections}\nauthorization {{ timeout: 60 }}\njetstream {{ }}\nno_auth_user: a\naccounts {{ A {{ users = [ {{ user: a, \
             password: b }} ], jetstream {{ max_streams: {streams}, max_consumers: {consumers} }} }} }}\n"
        )
    };
    let Some(mut server) = Server::start_as(&limited(2, 2, 1)) else { return };
    let (place, url) = (folder(), server.url());
    // Without an own limit, the server would close a connection that says nothing after two seconds.
    let taken = server.take_only_connection();
    let listed = run(place.path(), &format!("machines --nats {url}"));
    assert_eq!(listed.status.code(), Some(1));
    let line = String::from_utf8(listed.stderr).expect("UTF-8");
    let connections = "cannot connect: the server says: maximum connections exceeded; end other programs that use it";
    assert!(line.starts_with(&format!("error: {url}: {connections}")), "{line}");

    let worker = worker_that_tells(&url);
    worker.wait_for(connections);
    // The limits change while the connection is taken, so that the worker finds them as soon as there is room for it.
    server.change(&limited(1, 1, 100));
    drop(taken);
    let streams = "the server says: maximum number of streams reached (code 400, error code 10027); remove a stream";
    worker.wait_for(streams);
    server.change(&limited(2, 1, 100));
    let mut one = Run::start(place.path(), &RUN.replace("generations 4", "generations 400"), &url);
    one.wait_for_generations(1);
    let other = folder();
    let two = Run::start(other.path(), RUN, &url);
    two.wait_for(
        "the server says: maximum consumers limit reached (code 400, error code 10026); wait for another",
    );
    one.stopped();
    finished(two);
    let by_worker = stopped(worker);
    for words in [connections, streams] {
        assert_eq!(by_worker.lines().filter(|line| line.contains(words)).count(), 1, "{by_worker}");
    }
}

#[test]
fn f3_what_a_server_refuses_for_good_is_an_error_at_once() {
    let account = |settings: &str| {
        format!(
            "jetstream {{ }}\nno_auth_user: a\naccounts {{ A {{ users = [ {{ user: a, password: b }} ] {settings} }} }}\n"
        )
    };
    let of_user = |rights: &str| {
        format!(
            "jetstream {{ }}\nno_auth_user: a\nauthorization {{ users = [ {{ user: a, password: b, permissions: {{ \
             {rights} }} }} ] }}\n"
        )
    };
    let Some(mut server) = Server::start() else { return };
    let place = folder();
    let flags = format!("--nats {}", server.url());
    for (settings, words) in [
        (account(""), "making a stream failed: "),
        (account(""), "(code 503, error code 10039); add \"jetstream: enabled\" to the account"),
        (
            "jetstream { }\nmax_payload: 1KB\n".to_owned(),
            "at most 1024 bytes; set max_payload in its settings to 16384",
        ),
        (
            of_user("publish: \"x\""),
            "making a stream failed: the server says: Permissions Violation for Publish to \"$JS.API.STREAM.INFO.SNAKES_WORK\"; \
             let this user publish and subscribe to snakes.>, $JS.> and _INBOX.>",
        ),
        (
            of_user("subscribe: \"x\""),
            "the server says: Permissions Violation for Subscription to \"_INBOX.",
        ),
    ] {
        server.change(&settings);
        let began = Instant::now();
        for line in refusals(place.path(), &flags) {
            assert!(line.contains(words), "{settings}: {line}");
        }
        assert!(began.elapsed() < Duration::from_secs(8), "{settings}: {:?}", began.elapsed());
    }
}

#[test]
fn f3_rights_that_are_missing_only_later_end_a_run_and_a_worker_with_an_error() {
    let denied = |subject: &str| {
        format!(
            "jetstream {{ }}\nno_auth_user: a\nauthorization {{ users = [ {{ user: a, password: b, permissions: {{ publish: {{ \
             deny: \"{subject}\" }} }} }} ] }}\n"
        )
    };
    let Some(mut server) = Server::start_as(&denied("snakes.result.>")) else { return };
    let (place, url) = (folder(), server.url());
    let mut worker = worker_that_tells(&url);
    let mut under_way = Run::start(place.path(), RUN, &url);
    let status = worker.process.end_within(Duration::from_secs(10), "the worker");
    assert_eq!(status.code(), Some(1));
    let said = worker.said();
    let last = said.lines().last().expect("a line");
    let words = "the work failed: the server says: Permissions Violation for Publish to \"snakes.result.climb-seed7-";
    assert!(last.starts_with(&format!("error: {url}: {words}")), "{said}");

    let _worker = worker_that_tells(&url);
    server.change(&denied("snakes.work.>"));
    let _worker = worker_that_tells(&url);
    under_way.wait_for_end(Duration::from_secs(30));
    let output = under_way.output();
    let said = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(1), "{said}");
    let last = said.lines().last().expect("a line");
    let words =
        "the run failed: the server says: Permissions Violation for Publish to \"snakes.work.";
    assert!(last.starts_with(&format!("error: {url}: {words}")), "{said}");
    assert!(last.contains("continue it with: snakes --no-render --resume "), "{said}");
}

#[test]
fn f3_small_messages_make_small_batches_and_change_no_bit() {
    let Some(server) = Server::start_as("jetstream { }\nmax_payload: 16KB\n") else { return };
    let _worker = worker_that_tells(&server.url());
    let place = folder();
    let said = finished(Run::start(place.path(), RUN, &server.url()));
    assert!(!said.contains("larger than"), "{said}");
}
