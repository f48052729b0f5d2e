//! Reading a message of any kind, for the fuzz target and its test.

use super::compute::Shared;
use super::hello::{RunNotice, WorkerNotice};
use super::outcome::Outcome;
use super::wire::{ResultBatch, TaskKind, WireError, WorkBatch, parse_line};
use snakes_core::genome::Genome;
use snakes_core::score::ExamCondition;

/// Tries to read bytes as a message of each kind, and their lines as tasks, outcomes, trials or genomes. Returns the
/// names of the kinds that could be read.
///
/// # Errors
/// The bytes could be read as no kind of message. The error is that of the last attempt.
pub fn kinds_of_message(bytes: &[u8]) -> Result<Vec<&'static str>, WireError> {
    let mut kinds = Vec::new();
    let mut last = Ok(());
    let mut try_kind = |kind: &'static str, result: Result<(), WireError>| match result {
        Ok(()) => kinds.push(kind),
        error => last = error,
    };
    try_kind("work", WorkBatch::decode(bytes).map(drop));
    try_kind("results", ResultBatch::decode(bytes).map(drop));
    try_kind("worker", WorkerNotice::read(bytes).map(drop));
    try_kind("run", RunNotice::read(bytes).map(drop));
    let text = String::from_utf8_lossy(bytes);
    for line in text.lines().take(16) {
        try_kind("outcome", Outcome::read(line).map(drop));
        try_kind("genome", parse_line::<Genome>(line).map(drop));
        try_kind("trial", Shared::read(TaskKind::Score, line).map(drop));
        let condition = parse_line::<ExamCondition>(line);
        try_kind("condition", condition.and_then(|condition| Ok(condition.check()?)));
    }
    if kinds.is_empty() {
        last?;
    }
    Ok(kinds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hello::tests::run_notice;
    use crate::wire::{TaskText, line_of, shared_hash, task_key};
    use snakes_core::rng::{Purpose, stream};
    use snakes_core::save::load_preset;
    use snakes_core::score::ExamSuite;
    use snakes_lab::run::evaluate_caught;

    /// Returns messages of every kind, each with the name of its kind.
    fn examples() -> Vec<(String, Vec<u8>)> {
        let mut examples = Vec::new();
        for preset in ["climb", "senses", "q-learning", "xcs"] {
            let mut settings = load_preset(preset).expect("shipped").settings;
            settings.trial.duration_s = 1.0;
            let mut rng = stream(1, 1, 3, Purpose::Birth);
            let genome = settings.genome.random_genome(settings.trial.genome_shape(), &mut rng);
            let (trial, text) = (line_of(&settings.trial), line_of(&genome));
            let shared = shared_hash(TaskKind::Score, &trial);
            let task = TaskText { key: task_key(shared, &text), text: text.into() };
            let (key, run) = (task.key, "climb-seed1".to_owned());
            let outcome = Outcome::Scored(evaluate_caught(&genome, &settings.trial)).line();
            let kind = TaskKind::Score;
            let work = WorkBatch { run: run.clone(), batch: 1, kind, shared, tasks: vec![task] };
            let results = ResultBatch {
                run,
                batch: 1,
                worker: "w-1".to_owned(),
                elapsed_s: 0.25,
                outcomes: vec![TaskText { key, text: outcome.into() }],
            };
            examples.push((format!("work-{preset}"), work.encode()));
            examples.push((format!("results-{preset}"), results.encode()));
            examples.push((format!("trial-{preset}"), trial.into_bytes()));
            let condition = ExamSuite::Shove.conditions(&settings.trial).remove(0);
            examples.push((format!("condition-{preset}"), line_of(&condition).into_bytes()));
        }
        let set_aside = vec!["w-1".to_owned()];
        let notice = run_notice("climb-seed1", "computer");
        let run = RunNotice { pending: 3, results: 4, set_aside, ..notice };
        examples.push(("run".to_owned(), line_of(&run).into_bytes()));
        examples
    }

    #[test]
    fn an_example_of_each_kind_is_read() {
        for (name, bytes) in examples() {
            let kinds = kinds_of_message(&bytes).expect("a message");
            let kind = name.split('-').next().unwrap_or_default();
            assert!(kinds.contains(&kind), "{name}: {kinds:?}");
        }
        assert!(kinds_of_message(b"{}").is_err());
    }

    #[test]
    #[ignore = "writes fuzz/corpus/wire: cargo test --release -p snakes-cluster write_the_corpus_of_messages -- --ignored"]
    fn write_the_corpus_of_messages() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/wire");
        std::fs::create_dir_all(folder).expect("a folder");
        for (name, bytes) in examples() {
            std::fs::write(format!("{folder}/{name}.json"), bytes).expect("written");
        }
    }
}
