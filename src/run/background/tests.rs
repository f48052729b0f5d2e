//! What a window is told of a run, and when.

use super::*;
use crate::evolve::{RunPlan, Settings, with_field};
use crate::run::pool;
use crate::save::{Earlier, SavesFolder};

fn plan() -> RunPlan {
    let mut settings = Settings::default();
    settings.evolution.population = 8;
    settings.evolution.generations = 3;
    settings.trial.duration_s = 0.5;
    RunPlan::new("test", 1, settings)
}

fn start(folder: &tempfile::TempDir) -> Background {
    let background = start_after(folder, None);
    assert_eq!(next(&background), Event::Opened(Vec::new()));
    background
}

fn start_after(folder: &tempfile::TempDir, before: Option<Background>) -> Background {
    let pool = Arc::new(pool(2).expect("a pool"));
    let saves = SavesFolder::find(Some(folder.path()));
    let source = RunSource::in_saves(&saves, plan(), Earlier::Keep);
    Background::start(source, pool, before).expect("a thread")
}

/// The next event of any kind.
fn next_of_all(background: &Background) -> Event {
    let events = background.events.lock().expect("no panic");
    events.recv_timeout(Duration::from_secs(60)).expect("an event in time")
}

/// The next event that is not about what was explored.
fn next(background: &Background) -> Event {
    loop {
        match next_of_all(background) {
            Event::Explored(_) => {}
            event => return event,
        }
    }
}

#[test]
fn it_waits_until_it_is_told_to_go_and_pauses_after_a_single_generation() {
    let folder = tempfile::tempdir().expect("a folder");
    let background = start(&folder);
    thread::sleep(Duration::from_millis(30));
    assert_eq!((background.poll(), background.progress()), (None, (0, 8)));
    background.run_single_generation();
    assert!(matches!(next(&background), Event::Generation(report) if report.generation == 1));
    assert!(background.is_paused());
    thread::sleep(Duration::from_millis(30));
    assert_eq!(background.poll(), None, "nothing more until it is told");
}

#[test]
fn a_run_whose_thread_is_gone_says_so_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let background = start(&folder);
    background.control.cancel();
    let event = std::iter::from_fn(|| {
        thread::sleep(Duration::from_millis(5));
        Some(background.poll())
    });
    assert_eq!(event.take(2000).flatten().next(), Some(Event::BrokeOff));
    assert_eq!(background.poll(), None);
}

#[test]
fn a_run_that_was_stopped_goes_on_once_the_one_before_has_let_go_of_its_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = start(&folder);
    first.run_single_generation();
    let Event::Generation(report) = next(&first) else { panic!("no generation") };
    let refused = next(&start_after(&folder, None));
    let owner = format!("in use by process {} (the studio)", std::process::id());
    assert!(matches!(refused, Event::Refused(text) if text.contains(&owner)));
    let second = start_after(&folder, Some(first));
    let Event::Opened(behind) = next(&second) else { panic!("not opened") };
    assert_eq!((behind.len(), &behind[0].champion), (1, &report.champion));
}

#[test]
fn a_generation_that_cannot_be_saved_holds_the_run_and_is_saved_when_it_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let background = start(&folder);
    let saves = SavesFolder::find(Some(folder.path()));
    let in_the_way = saves.of_run(&plan()).join("generation-1.ron");
    std::fs::create_dir(&in_the_way).expect("created");
    background.resume();
    assert!(
        matches!(next(&background), Event::NotSaved(text) if text.contains("cannot be written"))
    );
    assert!(background.is_paused());
    std::fs::remove_dir(&in_the_way).expect("removed");
    background.resume();
    assert!(matches!(next(&background), Event::Generation(report) if report.generation == 1));
    assert!(in_the_way.is_file());
}

#[test]
fn before_each_generation_it_tells_what_was_explored_and_of_a_run_that_goes_on_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = start(&folder);
    first.run_single_generation();
    let Event::Explored(explored) = next_of_all(&first) else { panic!("not explored") };
    assert_eq!(explored.archive, None, "the report's method keeps none");
    assert!(matches!(next_of_all(&first), Event::Generation(_)));
    let second = start_after(&folder, Some(first));
    assert!(matches!(next_of_all(&second), Event::Opened(behind) if behind.len() == 1));
    // Who else was in the generation is not kept.
    assert_eq!(explored.leaders.len(), 8);
    assert_eq!(explored.generation.as_ref().map(|of| of.genomes.len()), Some(8));
    let Event::Explored(known) = next_of_all(&second) else { panic!("not explored") };
    assert_eq!((known.leaders.len(), &known.generation), (0, &None));
    assert_eq!((&known.front, &known.archive), (&explored.front, &explored.archive));
    let places = |explored: &Exploration| -> Vec<_> {
        let parents = explored.parents.iter().map(|(parent, _)| parent.place);
        parents.chain(explored.descent.line.iter().map(|ancestor| ancestor.place)).collect()
    };
    assert_eq!(places(&known), places(&explored));
    assert_eq!(places(&known).len(), 4 + 1, "four parents, and the best");
}

#[test]
fn progress_counts_the_generation_under_way_whatever_its_size() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut plan = plan();
    let changes = [("cma_es.newborns", "20"), ("strategy", "cma_es"), ("generations", "20")];
    for (field, value) in changes {
        let field = format!("evolution.{field}");
        plan.settings = with_field(&plan.settings, &field, value).expect("allowed");
    }
    let pool = Arc::new(pool(2).expect("a pool"));
    let saves = SavesFolder::find(Some(folder.path()));
    let source = RunSource::in_saves(&saves, plan, Earlier::Keep);
    let background = Background::start(source, pool, None).expect("a thread");
    assert!(matches!(next(&background), Event::Opened(_)));
    assert_eq!(background.progress(), (0, 20));
    // The newborns, then generations of the population.
    background.resume();
    while !matches!(next(&background), Event::Finished { .. }) {}
    assert_eq!(background.progress(), (8, 8));
}

#[test]
fn a_change_counts_from_the_next_generation_on_and_at_once_while_the_run_is_held_between_two() {
    let folder = tempfile::tempdir().expect("a folder");
    let background = start(&folder);
    let wish = |field: &str, value: &str| (format!("evolution.{field}"), value.to_owned());
    background.run_single_generation();
    assert!(matches!(next(&background), Event::Generation(_)));
    background.amend([
        wish("halving.parents", "2"),
        wish("halving.parents", "2"),
        wish("halving.parents", "0"),
        wish("strategy", "ga"),
        wish("population", "5"),
        wish("generations", "4"),
    ]);
    let change = |generation, field: &str, value: &str| {
        let (field, value) = wish(field, value);
        Event::Changed(SettingChange { generation, field, value })
    };
    let is_refused = |event: Event, of: &str, why: &str| matches!(event, Event::NotChanged { field, reason } if field.ends_with(of) && reason.contains(why));
    assert_eq!(next(&background), change(2, "halving.parents", "2"));
    assert!(is_refused(next(&background), "parents", "is 0; allowed: 1 to"));
    assert!(is_refused(next(&background), "strategy", "means nothing to another method"));
    assert_eq!(next(&background), change(2, "population", "5"));
    assert_eq!(next(&background), change(2, "generations", "4"));
    assert_eq!(background.poll(), None, "and nothing more");
    assert!(background.is_paused());
    assert_eq!(background.progress(), (0, 5));
    background.set_pool(Arc::new(pool(1).expect("a pool")));
    background.resume();
    let mut reports = Vec::new();
    let run_hash = loop {
        match next(&background) {
            Event::Finished { run_hash } => break run_hash,
            Event::Generation(report) => reports.push(report.evaluations),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(reports, [5, 5, 5]);
    // Opened again, it tells what was changed, and has the same end.
    let again = start_after(&folder, Some(background));
    assert!(matches!(next(&again), Event::WasChanged(changes) if changes.len() == 3));
    assert!(matches!(next(&again), Event::Opened(behind) if behind.len() == 4));
    assert_eq!(next(&again), Event::Finished { run_hash });
}

#[test]
fn a_run_in_its_last_generation_can_be_made_longer() {
    let folder = tempfile::tempdir().expect("a folder");
    let background = start(&folder);
    for _ in 1..=2 {
        background.run_single_generation();
        assert!(matches!(next(&background), Event::Generation(_)));
    }
    background.amend([("evolution.generations".to_owned(), "5".to_owned())]);
    background.resume();
    let mut events = 0;
    while !matches!(next(&background), Event::Finished { .. }) {
        events += 1;
    }
    // The change, and generations 3 to 5.
    assert_eq!(events, 1 + 3);
}

#[test]
fn in_the_background_a_run_has_the_same_hash() {
    let folder = tempfile::tempdir().expect("a folder");
    let background = start(&folder);
    background.resume();
    let run_hash = loop {
        if let Event::Finished { run_hash } = next(&background) {
            break run_hash;
        }
    };
    let mut experiment = Experiment::new(plan());
    let pool = pool(1).expect("a pool");
    while !experiment.is_over() {
        experiment.run_generation(&pool, &Control::default()).expect("not cancelled");
    }
    assert_eq!(run_hash, experiment.run_hash());
    let saved = std::fs::read_dir(folder.path()).expect("a folder").count();
    assert!(saved > 0, "the best was saved");
}
