//! `snakes worker`, `snakes machines`, and the flag `--nats`.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use serde_json::{Value, json};
use xxhash_rust::xxh3::xxh3_64;

use super::args::{Args, CredentialFlags};
use super::error::CliError;
use super::output::{cancel_on_interrupt, is_interrupted, print, print_json};
use snakes_cluster::{
    Broker, BrokerOptions, Coordinator, CoordinatorOptions, Machines, RunNotice, RunQueue,
    Simulator, WorkerOptions, host_name, machines, proof, purge, unique_name, when_there_is_room,
    work,
};
use snakes_lab::run::Evaluator;
use snakes_lab::run::headless::say;

fn server(args: &Args) -> BrokerOptions {
    let CredentialFlags { creds, tls_ca } = args.workers.credentials.clone();
    BrokerOptions { url: args.workers.nats.clone().unwrap_or_default(), creds, tls_ca }
}

/// Starts an evaluator on the workers of a server. Waits while the server lacks room.
pub fn coordinator(args: &Args, words: &str, place: &Path) -> Result<Arc<dyn Evaluator>, CliError> {
    let (expect_workers, local_threads) = (args.expect_workers()?, args.local_threads()?);
    let server = server(args);
    server.check()?;
    // The place is part of the run's name: equal plans of two users, or in two folders, are different runs on the server.
    let place = format!("{} {}", host_name(), place.display());
    let run = format!("{words}-{:08x}", xxh3_64(place.as_bytes()) as u32);
    let options = CoordinatorOptions {
        run: run.clone(),
        proof: proof()?,
        expect_workers,
        local_threads,
        ends_if_refused: true,
        compute: Arc::new(Simulator),
    };
    let coordinator = when_there_is_room(is_interrupted, || {
        Coordinator::start(Broker::connect(&server, &run)?, options.clone())
    })?;
    say(&format!("computing on the workers of {}, as run {run}", server.url));
    Ok(Arc::new(coordinator))
}

/// Works for the runs on a server until the interrupt key is pressed.
pub fn worker(args: &Args) -> Result<(), CliError> {
    let (threads, server) = (args.threads()?, server(args));
    let name = unique_name();
    let broker =
        when_there_is_room(is_interrupted, || Broker::connect(&server, &name).map(Arc::new))?;
    let options = WorkerOptions {
        name: name.clone(),
        threads,
        proof: proof()?,
        compute: Arc::new(Simulator),
    };
    let plural = if threads == 1 { "" } else { "s" };
    say(&format!(
        "worker {name}: {threads} thread{plural} for the runs on {}; Ctrl-C stops it",
        broker.url()
    ));
    let control = cancel_on_interrupt()?;
    let evaluations =
        when_there_is_room(is_interrupted, || work(&broker, options.clone(), &control))?;
    say(&format!("worker {name}: stopped; {evaluations} evaluations"));
    Ok(())
}

/// Lists the workers and runs on a server, or removes what waits for a run.
pub fn list(args: &Args, purged: Option<&str>) -> Result<(), CliError> {
    let broker = Broker::connect(&server(args), "machines")?;
    if let Some(run) = purged {
        let RunQueue { batches, results } = purge(&broker, run)?;
        if args.json {
            return print_json(
                &json!({"type": "removed", "run": run, "batches": batches, "results": results}),
            );
        }
        return print(&format!("{run}: removed {batches} batches and {results} results\n"));
    }
    let machines = machines(&broker)?;
    if args.json {
        return as_json(&machines).try_for_each(|line| print_json(&line));
    }
    print(&as_text(&machines))
}

fn as_json(machines: &Machines) -> impl Iterator<Item = Value> {
    let workers =
        machines.workers.values().map(|worker| json!({"type": "worker", "worker": worker}));
    let runs = machines.runs.values().map(|run| json!({"type": "run", "run": run}));
    let queues = machines
        .queues
        .iter()
        .map(|(run, queue)| json!({"type": "queue", "queue": run, "waiting": queue}));
    workers.chain(runs).chain(queues)
}

/// The legend below the table of [`as_text`].
const LEGEND: &str = "\
per s: evaluations per second over the last five seconds
redelivered: batches that another worker had before and did not finish
engine: version, processors and a hash of test results, which must be the same on all computers
done, to do: evaluations with a result, and those that wait for one
queued: batches that no worker has finished; unread: results that the run has not fetched yet
";

/// Returns the line below a worker or a run that waits for the server; empty if it does not.
fn trouble_line(trouble: Option<&str>) -> String {
    trouble.map_or_else(String::new, |trouble| format!("    {trouble}\n"))
}

fn as_text(machines: &Machines) -> String {
    let mut text = format!(
        "{:<28} {:<16} {:>7} {:>12} {:>7} {:>11}  engine\n",
        "worker", "computer", "threads", "evaluations", "per s", "redelivered"
    );
    for worker in machines.workers.values() {
        text += &format!(
            "{:<28} {:<16} {:>7} {:>12} {:>7.1} {:>11}  {}\n",
            worker.worker,
            worker.host,
            worker.threads,
            worker.evaluations,
            worker.per_s,
            worker.redelivered,
            worker.engine_words()
        );
        text += &trouble_line(worker.trouble.as_deref());
    }
    if machines.workers.is_empty() {
        text += "none\n";
    }
    text += &format!(
        "\n{:<50} {:>9} {:>7} {:>7} {:>7}  computer\n",
        "run", "done", "to do", "queued", "unread"
    );
    let names: BTreeSet<&String> = machines.runs.keys().chain(machines.queues.keys()).collect();
    for name in &names {
        let queue = machines.queues.get(*name).cloned().unwrap_or_default();
        let run = machines.runs.get(*name);
        let count = |of: fn(&RunNotice) -> u64| {
            run.map_or("–".to_owned(), |notice| of(notice).to_string())
        };
        let (done, to_do) = (count(|run| run.results), count(|run| run.pending));
        let host = run.map_or("stopped; --purge RUN removes what is left of it", |run| &run.host);
        text += &format!(
            "{name:<50} {done:>9} {to_do:>7} {:>7} {:>7}  {host}\n",
            queue.batches, queue.results
        );
        for worker in run.iter().flat_map(|run| &run.set_aside) {
            text += &format!("    set aside: {worker}\n");
        }
        text += &trouble_line(run.and_then(|run| run.trouble.as_deref()));
    }
    if names.is_empty() {
        text += "none\n";
    }
    text + "\n" + LEGEND
}
