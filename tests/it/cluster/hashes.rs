//! Every command with workers ends with the results of one machine.

use serde_json::Value;

use super::server::{Process, Run, Server, run_hash, worker};
use crate::program::{CLIMBER, folder, json_lines};

/// Starts a server with four workers.
fn room() -> Option<(Server, Vec<Process>)> {
    let server = Server::start()?;
    let workers = (0..4).map(|_| worker(&server.url())).collect();
    Some((server, workers))
}

/// Returns the lines of a command on this machine alone, and on the workers, in separate folders.
fn both(server: &Server, arguments: &str) -> (Vec<Value>, Vec<Value>) {
    let (here, there) = (folder(), folder());
    let local = json_lines(here.path(), &format!("{arguments} --json"));
    let distributed = Run::start(there.path(), arguments, &server.url()).finished().0;
    (local, distributed)
}

#[test]
fn runs_of_every_strategy_and_of_learners_have_the_hash_of_one_machine() {
    let Some((server, _workers)) = room() else { return };
    for arguments in [
        "--preset report --population 30 --generations 2 --set evolution.strategy=halving",
        "--preset climb --population 20 --generations 2 --set evolution.strategy=ga",
        "--preset climb --population 20 --generations 2 --set evolution.strategy=cma_es",
        "--preset climb --population 20 --generations 2 --set evolution.strategy=map_elites",
        "--preset climb --population 20 --generations 2 --set evolution.strategy=random",
        "--preset neat --population 20 --generations 2",
        "--preset senses --population 12 --generations 2",
        "--preset q-learning --generations 2",
        "--preset xcs --generations 2",
        "--preset zcs --generations 2",
        "--preset waves-by-rules --population 12 --generations 2",
        "--preset poet --population 200 --generations 24 --set pairs=3 --set pair_candidates=4 \
         --set learn_generations=1 --set transfers=1 --set reproduces_from=0 --set too_hard_below=0 \
         --set too_easy_above=1.1",
    ] {
        let arguments = format!("--no-render {arguments} --duration 2 --seed 3");
        let (local, distributed) = both(&server, &arguments);
        assert_eq!(run_hash(&distributed), run_hash(&local), "{arguments}");
        let hashes =
            |lines: &[Value]| lines.iter().map(|line| line["hash"].clone()).collect::<Vec<_>>();
        assert_eq!(hashes(&distributed), hashes(&local), "{arguments}");
    }
}

#[test]
fn comparisons_tables_and_exams_have_the_results_of_one_machine() {
    let Some((server, _workers)) = room() else { return };
    for arguments in [
        "study table1 --seeds 2 --population 20 --generations 2 --duration 2".to_owned(),
        format!("exam {CLIMBER} --suite step-rate"),
        format!("exam {CLIMBER} --trials 8"),
    ] {
        let (local, distributed) = both(&server, &arguments);
        // The last line names files, whose folders differ.
        let results = |lines: &[Value]| lines[..lines.len() - 1].to_vec();
        assert!(!results(&local).is_empty(), "{arguments}");
        assert_eq!(results(&distributed), results(&local), "{arguments}");
    }
    let (here, there) = (folder(), folder());
    let compare = "study methods --strategies ga,cma_es --controllers gait --baseline ga-gait --seeds 2 --evaluations 40 \
                   --population 20 --duration 2 --out";
    json_lines(here.path(), &format!("{compare} . --json"));
    Run::start(there.path(), &format!("{compare} ."), &server.url()).finished();
    let csv = |folder: &std::path::Path| {
        std::fs::read_to_string(folder.join("methods-runs.csv")).expect("read")
    };
    assert_eq!(csv(there.path()), csv(here.path()));
}

#[test]
fn the_coordinator_can_compute_alone_and_beside_a_worker() {
    let Some(server) = Server::start() else { return };
    let arguments =
        "--no-render --preset climb --seed 2 --population 12 --generations 2 --duration 2";
    let local = json_lines(folder().path(), &format!("{arguments} --json"));
    let alone = folder();
    let run = Run::start(alone.path(), &format!("{arguments} --local-threads 2"), &server.url());
    assert_eq!(run.hash(), run_hash(&local));
    let _worker = worker(&server.url());
    let beside = folder();
    let both = format!("{arguments} --local-threads 1 --expect-workers 1");
    assert_eq!(Run::start(beside.path(), &both, &server.url()).hash(), run_hash(&local));
}
