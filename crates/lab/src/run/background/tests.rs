//! Events of a run in the background, and their order.

use super::*;
use crate::run::LocalPool;
use crate::run::experiment::tests::finish;
use snakes_core::evolve::{RunPlan, Settings, with_field};
use snakes_core::save::{ExistingRun, SavesFolder};
use snakes_core::schema::SettingValue;

fn plan() -> RunPlan {
    let mut settings = Settings::default();
    settings.evolution.population = 8;
    settings.evolution.generations = 3;
    settings.trial.duration_s = 0.5;
    RunPlan::new("test", 1, settings)
}

fn start(folder: &tempfile::TempDir) -> BackgroundRun {
    let background = start_after(folder, None);
    let opened = opened(&background);
    assert_eq!((opened.plan_at_start, opened.reports), (plan(), Vec::new()));
    background
}

fn start_after(folder: &tempfile::TempDir, before: Option<BackgroundRun>) -> BackgroundRun {
    start_changed(folder, plan(), [], before)
}

fn start_changed(
    folder: &tempfile::TempDir,
    plan: RunPlan,
    changes: impl IntoIterator<Item = (String, SettingValue)>,
    before: Option<BackgroundRun>,
) -> BackgroundRun {
    let evaluator = Arc::new(LocalPool::new(2).expect("threads"));
    let saves = SavesFolder::find(Some(folder.path()));
    let source = RunSource::in_saves(&saves, plan, ExistingRun::Keep);
    BackgroundRun::start(source, evaluator, changes, before).expect("a thread")
}

/// Waits for the next event of any kind.
fn next_of_all(background: &BackgroundRun) -> RunEvent {
    background.events.recv_timeout(Duration::from_secs(60)).expect("an event in time")
}

/// Waits for the next event, which must say that the run was opened.
fn opened(background: &BackgroundRun) -> OpenedRun {
    let RunEvent::Opened(opened) = next_of_all(background) else { panic!("not opened") };
    *opened
}

/// Waits for the next event other than [`RunEvent::Explored`].
fn next(background: &BackgroundRun) -> RunEvent {
    loop {
        match next_of_all(background) {
            RunEvent::Explored(_) => {}
            event => return event,
        }
    }
}

#[test]
fn it_is_held_until_resumed_and_pauses_after_a_single_generation() {
    let folder = tempfile::tempdir().expect("a folder");
    let background = start(&folder);
    thread::sleep(Duration::from_millis(30));
    assert_eq!((background.poll(), background.progress()), (None, (0, 8)));
    background.run_single_generation();
    assert!(matches!(next(&background), RunEvent::Generation(report) if report.generation == 1));
    assert!(background.is_paused());
    thread::sleep(Duration::from_millis(30));
    assert_eq!(background.poll(), None, "nothing more until it is resumed");
}

#[test]
fn a_run_whose_thread_is_gone_reports_it_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let background = start(&folder);
    background.shared.control.cancel();
    let event = std::iter::from_fn(|| {
        thread::sleep(Duration::from_millis(5));
        Some(background.poll())
    });
    assert_eq!(event.take(2000).flatten().next(), Some(RunEvent::Failed));
    assert_eq!(background.poll(), None);
}

#[test]
fn a_stopped_run_continues_once_the_one_before_has_released_its_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = start(&folder);
    first.run_single_generation();
    let RunEvent::Generation(report) = next(&first) else { panic!("no generation") };
    let refused = next(&start_after(&folder, None));
    let owner = format!("in use by process {} (the studio)", std::process::id());
    assert!(matches!(refused, RunEvent::Refused(text) if text.contains(&owner)));
    let second = start_after(&folder, Some(first));
    let behind = opened(&second).reports;
    assert_eq!((behind.len(), &behind[0].champion), (1, &report.champion));
}

#[test]
fn a_generation_that_cannot_be_saved_holds_the_run_and_is_saved_on_resume() {
    let folder = tempfile::tempdir().expect("a folder");
    let background = start(&folder);
    let saves = SavesFolder::find(Some(folder.path()));
    let in_the_way = saves.of_run(&plan()).join("generation-1.ron");
    std::fs::create_dir(&in_the_way).expect("created");
    background.resume();
    assert!(
        matches!(next(&background), RunEvent::NotSaved(text) if text.contains("cannot be written"))
    );
    assert!(background.is_paused());
    std::fs::remove_dir(&in_the_way).expect("removed");
    background.resume();
    assert!(matches!(next(&background), RunEvent::Generation(report) if report.generation == 1));
    assert!(in_the_way.is_file());
}

/// Evaluates on threads, but can report a fault.
#[derive(Debug)]
struct Faulty {
    pool: LocalPool,
    fault: Option<&'static str>,
    /// Whether the evaluator cancels its batches.
    cancels: bool,
}

impl Evaluator for Faulty {
    fn evaluate_jobs(
        &self,
        trials: &[snakes_core::score::Trial],
        jobs: &[crate::run::Job<'_>],
        control: &RunControl,
        report: &(dyn Fn(usize, crate::run::EvaluationResult) + Sync),
    ) -> Result<(), Cancelled> {
        if self.cancels {
            Err(Cancelled)
        } else {
            self.pool.evaluate_jobs(trials, jobs, control, report)
        }
    }

    fn examine_batch(
        &self,
        genome: &snakes_core::genome::Genome,
        conditions: &[snakes_core::score::ExamCondition],
        control: &RunControl,
        report: &(dyn Fn(usize, snakes_core::score::ExamEnd) + Sync),
    ) -> Result<(), Cancelled> {
        self.pool.examine_batch(genome, conditions, control, report)
    }

    fn workers(&self) -> usize {
        self.pool.workers()
    }

    fn with_workers(&self, workers: usize) -> Result<Arc<dyn Evaluator>, crate::run::WorkersError> {
        self.pool.with_workers(workers)
    }

    fn fault(&self) -> Option<String> {
        self.fault.map(str::to_owned)
    }
}

#[test]
fn a_fault_of_an_evaluator_ends_the_run_whenever_it_is_found() {
    let faulty = |fault: Option<&'static str>, cancels| -> Arc<dyn Evaluator> {
        Arc::new(Faulty { pool: LocalPool::new(1).expect("threads"), fault, cancels })
    };
    let (good, found, late) =
        (faulty(None, false), faulty(Some("w lies"), true), faulty(Some("w lies"), false));
    // The fault appears: during a generation; after the evaluator was replaced; in the last generation.
    for (evaluators, generations) in
        [(vec![&good, &found], 1), (vec![&good, &late, &good], 2), (vec![&good, &good, &late], 3)]
    {
        let folder = tempfile::tempdir().expect("a folder");
        let background = start(&folder);
        let polled = || {
            let events = std::iter::from_fn(|| {
                thread::sleep(Duration::from_millis(5));
                Some(background.poll())
            });
            let told = |event: &RunEvent| !matches!(event, RunEvent::Explored(_));
            events.take(4000).flatten().find(told).expect("an event in time")
        };
        let mut finished = 0;
        let end = 'run: {
            for evaluator in evaluators {
                background.set_evaluator(Arc::clone(evaluator));
                background.run_single_generation();
                match polled() {
                    RunEvent::Generation(_) => finished += 1,
                    other => break 'run other,
                }
            }
            background.resume();
            polled()
        };
        assert_eq!((end, finished), (RunEvent::Untrusted("w lies".to_owned()), generations));
        thread::sleep(Duration::from_millis(50));
        assert_eq!(background.poll(), None, "no other end");
    }
}

#[test]
fn exploration_is_sent_before_each_generation_and_after_reopening() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = start(&folder);
    first.run_single_generation();
    let RunEvent::Explored(explored) = next_of_all(&first) else { panic!("not explored") };
    assert_eq!(explored.archive, None, "the report's method keeps none");
    assert!(matches!(next_of_all(&first), RunEvent::Generation(_)));
    let second = start_after(&folder, Some(first));
    assert_eq!(opened(&second).reports.len(), 1);
    // Only the leaders of a generation are saved, so its other individuals are unknown after reopening.
    assert_eq!(explored.leaders.len(), 8);
    assert_eq!(explored.generation.as_ref().map(|of| of.genomes.len()), Some(8));
    let RunEvent::Explored(known) = next_of_all(&second) else { panic!("not explored") };
    assert_eq!((known.leaders.len(), &known.generation), (0, &None));
    assert_eq!((&known.front, &known.archive), (&explored.front, &explored.archive));
    let places = |explored: &Exploration| -> Vec<_> {
        let parents = explored.parents.iter().map(|(parent, _)| parent.place);
        parents.chain(explored.ancestry.line.iter().map(|ancestor| ancestor.place)).collect()
    };
    assert_eq!(places(&known), places(&explored));
    assert_eq!(places(&known).len(), 4 + 1, "four parents, and the best");
}

#[test]
fn progress_counts_the_current_generation_of_any_size() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut plan = plan();
    let changes = [("cma_es.newborns", "20"), ("strategy", "cma_es"), ("generations", "20")];
    for (field, value) in changes {
        let field = format!("evolution.{field}");
        plan.settings = with_field(&plan.settings, &field, value).expect("allowed");
    }
    let background = start_changed(&folder, plan, [], None);
    assert!(matches!(next(&background), RunEvent::Opened(_)));
    assert_eq!(background.progress(), (0, 20));
    // The first generation has only newborns; later generations have the size of the population.
    background.resume();
    while !matches!(next(&background), RunEvent::Finished { .. }) {}
    assert_eq!(background.progress(), (8, 8));
}

#[test]
fn a_change_takes_effect_with_the_next_generation_and_at_once_while_held() {
    let folder = tempfile::tempdir().expect("a folder");
    let background = start(&folder);
    let whole = SettingValue::Whole;
    let setting = |field: &str, value| (format!("evolution.{field}"), value);
    background.run_single_generation();
    assert!(matches!(next(&background), RunEvent::Generation(_)));
    background.request_changes([
        setting("halving.parents", whole(2)),
        setting("halving.parents", whole(2)),
        setting("halving.parents", whole(0)),
        setting("strategy", SettingValue::Name("ga")),
        setting("population", whole(5)),
        setting("generations", whole(4)),
    ]);
    let mut plan_now = plan();
    let mut assert_changed = |field: &str, value| {
        let (field, value) = setting(field, value);
        let expected = SettingChange { generation: 2, field, value };
        let RunEvent::SettingChanged { change, plan_now: changed } = next(&background) else {
            panic!("not changed");
        };
        assert_eq!(change, expected);
        plan_now.change(&change).expect("allowed");
        assert_eq!(*changed, plan_now);
    };
    let assert_refused = |of: &str, why: &str| {
        let RunEvent::SettingNotChanged { field, reason } = next(&background) else {
            panic!("not refused");
        };
        assert!(field.ends_with(of) && reason.contains(why), "{field}: {reason}");
    };
    assert_changed("halving.parents", whole(2));
    assert_refused("parents", "is 0; allowed: 1 to");
    assert_refused("strategy", "another strategy cannot use");
    assert_changed("population", whole(5));
    assert_changed("generations", whole(4));
    assert_eq!(background.poll(), None, "and nothing more");
    assert!(background.is_paused());
    assert_eq!(background.progress(), (0, 5));
    background.set_evaluator(Arc::new(LocalPool::new(1).expect("threads")));
    background.resume();
    let mut reports = Vec::new();
    let run_hash = loop {
        match next(&background) {
            RunEvent::Finished { run_hash } => break run_hash,
            RunEvent::Generation(report) => reports.push(report.evaluations),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(reports, [5, 5, 5]);
    // The reopened run has the same changes and the same hash.
    let again = start_after(&folder, Some(background));
    let reopened = opened(&again);
    assert_eq!(reopened.reports.len(), 4);
    assert_eq!(reopened.plan_at_start, plan());
    assert_eq!(reopened.plan_now, plan_now);
    assert_eq!(plan_now.changes.made().len(), 3);
    assert_eq!(next(&again), RunEvent::Finished { run_hash });
}

#[test]
fn a_run_in_its_last_generation_can_be_made_longer() {
    let folder = tempfile::tempdir().expect("a folder");
    let background = start(&folder);
    for _ in 1..=2 {
        background.run_single_generation();
        assert!(matches!(next(&background), RunEvent::Generation(_)));
    }
    background.request_changes([("evolution.generations".to_owned(), SettingValue::Whole(5))]);
    background.resume();
    let mut events = 0;
    while !matches!(next(&background), RunEvent::Finished { .. }) {
        events += 1;
    }
    // One event for the change, and one for each of the generations 3 to 5.
    assert_eq!(events, 1 + 3);
}

/// Resumes a run, and returns its hash when it is finished.
fn hash_at_end(background: &BackgroundRun) -> u64 {
    background.resume();
    loop {
        if let RunEvent::Finished { run_hash } = next(background) {
            return run_hash;
        }
    }
}

#[test]
fn a_finished_run_that_is_opened_with_more_generations_has_the_bits_of_one_made_longer_in_time() {
    let longer = || [("evolution.generations".to_owned(), SettingValue::Whole(5))];
    let folders = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    let in_time = start(&folders[0]);
    for _ in 1..=2 {
        in_time.run_single_generation();
        assert!(matches!(next(&in_time), RunEvent::Generation(_)));
    }
    in_time.request_changes(longer());
    let expected = hash_at_end(&in_time);
    let finished = start(&folders[1]);
    let short = hash_at_end(&finished);
    let again = start_changed(&folders[1], plan(), longer(), Some(finished));
    assert_eq!(opened(&again).reports.len(), 3);
    let found = hash_at_end(&again);
    assert_eq!(found, expected);
    assert_ne!(found, short);
}

#[test]
fn in_the_background_a_run_has_the_same_hash() {
    let folder = tempfile::tempdir().expect("a folder");
    let run_hash = hash_at_end(&start(&folder));
    assert_eq!(run_hash, finish(Experiment::new(plan()), 1).run_hash());
    let saved = std::fs::read_dir(folder.path()).expect("a folder").count();
    assert!(saved > 0, "the best was saved");
}
