//! The ledger without a server: what it publishes, holds, delivers and repeats.

use rand::SeedableRng;

use super::*;
use crate::hello::tests::notice;
use crate::names::SILENCE;
use snakes_lab::run::EvaluationResult;
use std::time::Duration;

const PROOF: &str = "0123456789abcdef";

fn ledger() -> Ledger {
    Ledger::new("run", PROOF, 100_000, 1, ChaCha8Rng::seed_from_u64(1))
}

/// Returns the right outcome of a task: a panic whose message is the task's text.
fn right(task: &TaskText) -> Outcome {
    let result: EvaluationResult = Err(task.text.to_string());
    Outcome::Scored(result)
}

fn wrong(_: &TaskText) -> Outcome {
    Outcome::Scored(Err("wrong".to_owned()))
}

fn results(worker: &str, batch: &WorkBatch, outcome: fn(&TaskText) -> Outcome) -> ResultBatch {
    let line = |task: &TaskText| TaskText { key: task.key, text: outcome(task).line().into() };
    ResultBatch {
        run: "run".to_owned(),
        batch: batch.batch,
        worker: worker.to_owned(),
        elapsed_s: 0.01 * batch.tasks.len() as f64,
        outcomes: batch.tasks.iter().map(line).collect(),
    }
}

fn tasks(count: usize) -> Vec<Arc<str>> {
    (0..count).map(|number| format!("task {number}").into()).collect()
}

/// A ledger and the actions that it returned. The coordinator answers its own checks rightly.
struct Room {
    ledger: Ledger,
    now: Instant,
    published: Vec<WorkBatch>,
    delivered: Vec<(CallId, usize, Outcome)>,
    said: Vec<String>,
    taints: Vec<String>,
    audits: usize,
}

impl Room {
    fn new() -> Self {
        Self {
            ledger: ledger(),
            now: Instant::now(),
            published: Vec::new(),
            delivered: Vec::new(),
            said: Vec::new(),
            taints: Vec::new(),
            audits: 0,
        }
    }

    /// A room in which one call has this number of tasks, and then a worker named `a` with these threads is heard.
    fn at_work(count: usize, threads: u32) -> Self {
        let mut room = Self::new();
        room.open(1, count);
        room.hear("a", threads);
        room
    }

    fn act(&mut self, actions: Vec<LedgerAction>) {
        let mut actions: VecDeque<LedgerAction> = actions.into();
        while let Some(action) = actions.pop_front() {
            match action {
                LedgerAction::Publish(batch) => self.published.push(batch),
                LedgerAction::Deliver(call, index, outcome) => {
                    self.delivered.push((call, index, outcome))
                }
                LedgerAction::Withdraw => self.published.clear(),
                LedgerAction::Say(line) => self.said.push(line),
                LedgerAction::Taint(line) => self.taints.push(line),
                LedgerAction::Audit(audit) => {
                    self.audits += 1;
                    let line = right(&audit.task).line();
                    let then = self.ledger.on_audit(audit.task.key, Some(line.into()), self.now);
                    actions.extend(then);
                }
            }
        }
    }

    /// Tells the ledger something, and does what it answers.
    fn tell(&mut self, news: impl FnOnce(&mut Ledger, Instant) -> Vec<LedgerAction>) {
        let actions = news(&mut self.ledger, self.now);
        self.act(actions);
    }

    fn hear(&mut self, worker: &str, threads: u32) {
        self.tell(|ledger, now| ledger.on_notice(notice(worker, threads, PROOF), now));
    }

    fn open(&mut self, call: CallId, count: usize) {
        self.tell(|ledger, now| ledger.open(call, TaskKind::Score, 7, tasks(count), now));
    }

    fn answer(&mut self, results: ResultBatch) {
        self.tell(|ledger, now| ledger.on_results(results, now));
    }

    /// Answers all batches as this worker until nothing is left to publish.
    fn work(&mut self, worker: &str, outcome: fn(&TaskText) -> Outcome) {
        while let Some(batch) = self.published.pop() {
            self.answer(results(worker, &batch, outcome));
        }
    }

    fn pass(&mut self, time: Duration) {
        self.now += time;
        self.tell(Ledger::on_tick);
    }

    /// Returns the indices of the tasks that were delivered with the right outcome, in ascending order.
    fn right_indices(&self, call: CallId) -> Vec<usize> {
        let is_right = |(of, index, outcome): &&(CallId, usize, Outcome)| {
            let text = format!("task {index}");
            *of == call && *outcome == Outcome::Scored(Err(text))
        };
        let mut indices: Vec<usize> =
            self.delivered.iter().filter(is_right).map(|(_, index, _)| *index).collect();
        indices.sort_unstable();
        indices
    }
}

#[test]
fn every_task_is_delivered_once_and_nothing_is_published_without_workers() {
    let mut room = Room::new();
    room.open(1, 50);
    assert!(room.published.is_empty());
    room.hear("a", 2);
    assert_eq!(room.published.len(), 4, "two for each thread");
    let first = room.published[0].clone();
    room.work("a", right);
    assert_eq!(room.right_indices(1), (0..50).collect::<Vec<usize>>());
    room.answer(results("a", &first, right));
    assert_eq!(room.delivered.len(), 50, "results that come twice count once");
    assert_eq!(room.ledger.pending(), 0);
}

#[test]
fn equal_tasks_are_computed_once_for_all_who_wait() {
    let mut room = Room::new();
    room.open(1, 3);
    room.open(2, 3);
    room.hear("a", 8);
    assert_eq!(room.published.iter().map(|batch| batch.tasks.len()).sum::<usize>(), 3);
    room.work("a", right);
    assert_eq!((room.right_indices(1), room.right_indices(2)), (vec![0, 1, 2], vec![0, 1, 2]));
}

#[test]
fn batches_take_half_a_second_and_become_small_towards_the_end() {
    let mut room = Room::at_work(1000, 2);
    assert_eq!(room.published[0].tasks.len(), 1, "the time is not known yet");
    let mut sizes = Vec::new();
    while let Some(batch) = room.published.pop() {
        sizes.push(batch.tasks.len());
        room.answer(results("a", &batch, right));
    }
    // Each task takes 10 ms.
    assert_eq!(*sizes.iter().max().expect("some"), 50);
    assert_eq!(sizes[sizes.len() - 1], 1);
    assert_eq!(room.right_indices(1).len(), 1000);
}

#[test]
fn results_count_after_one_of_them_was_checked_and_one_in_a_hundred_later() {
    let mut room = Room::at_work(2000, 1);
    let batch = room.published.remove(0);
    room.answer(results("a", &batch, right));
    assert_eq!((room.audits, room.delivered.len()), (1, 1));
    room.work("a", right);
    assert!((10..40).contains(&room.audits), "{}", room.audits);
}

#[test]
fn a_liar_is_set_aside_before_its_results_count_and_they_are_computed_again() {
    let mut room = Room::new();
    room.open(1, 20);
    room.hear("liar", 1);
    let batch = room.published.remove(0);
    room.answer(results("liar", &batch, wrong));
    assert!(room.delivered.is_empty() && room.taints.is_empty());
    assert!(
        room.said[1].starts_with("worker liar on computer computes other bits"),
        "{:?}",
        room.said
    );
    room.work("liar", wrong);
    assert!(room.delivered.is_empty());
    room.hear("a", 1);
    room.work("a", right);
    assert_eq!(room.right_indices(1), (0..20).collect::<Vec<usize>>());
}

#[test]
fn a_worker_that_lies_later_is_found_and_taints_the_run() {
    let mut room = Room::at_work(2000, 1);
    let batch = room.published.remove(0);
    room.answer(results("a", &batch, right));
    room.work("a", wrong);
    assert_eq!(room.taints.len(), 1);
    assert!(room.taints[0].contains("worker a on computer"), "{:?}", room.taints);
}

#[test]
fn a_wrong_checker_is_found_as_well() {
    let mut room = Room::at_work(4000, 1);
    room.hear("b", 1);
    for worker in ["a", "b"] {
        let batch = room.published.remove(0);
        room.answer(results(worker, &batch, right));
    }
    // The other worker answers the checks wrongly. Then the coordinator's machine repeats them.
    while let Some(batch) = room.published.pop() {
        let actions = room.ledger.on_results(results("a", &batch, right), room.now);
        for action in actions {
            let LedgerAction::Audit(audit) = action else {
                room.act(vec![action]);
                continue;
            };
            assert_eq!(audit.checker, Checker::Worker("b".to_owned()));
            let line = wrong(&audit.task).line();
            let then = room.ledger.on_audit(audit.task.key, Some(line.into()), room.now);
            room.act(then);
            assert_eq!(room.taints.len(), 1);
            assert!(room.taints[0].starts_with("worker b"), "{:?}", room.taints);
            return;
        }
    }
    unreachable!("one in a hundred is checked");
}

#[test]
fn a_result_that_cannot_be_read_sets_its_worker_aside() {
    let mut room = Room::at_work(3, 1);
    room.work("a", |_| Outcome::Examined(snakes_core::score::ExamEnd::CRASHED));
    assert!(room.delivered.is_empty());
    assert_eq!(room.ledger.staff.set_aside_names(), ["a"]);
}

#[test]
fn a_worker_with_another_engine_gets_no_work_and_one_line() {
    let mut room = Room::new();
    room.open(1, 3);
    for _ in 0..2 {
        let other = notice("old", 4, "ffffffffffffffff");
        room.tell(|ledger, now| ledger.on_notice(other, now));
    }
    assert!(room.published.is_empty());
    assert_eq!(room.said.len(), 1);
    assert!(room.said[0].contains("it gets no work"), "{:?}", room.said);
}

#[test]
fn a_late_batch_is_repeated_when_workers_are_idle_and_a_lost_one_returns_to_the_queue() {
    let mut room = Room::at_work(4, 4);
    let lost = room.published.remove(0);
    room.work("a", right);
    assert_eq!(room.right_indices(1).len(), 3);
    room.pass(Duration::from_secs(1));
    assert!(room.published.is_empty(), "not late yet");
    room.hear("a", 4);
    room.pass(Duration::from_secs(2));
    assert_eq!(room.published.len(), 1);
    assert_eq!(room.published[0].tasks, lost.tasks);
    room.published.clear();
    for _ in 0..40 {
        room.hear("a", 4);
        room.pass(Duration::from_secs(1));
    }
    room.work("a", right);
    assert_eq!(room.right_indices(1), [0, 1, 2, 3]);
}

#[test]
fn batches_that_the_server_has_lost_are_sent_again_at_once() {
    let mut room = Room::at_work(20, 2);
    let lost: Vec<WorkBatch> = room.published.drain(..).collect();
    room.tell(Ledger::on_store_lost);
    assert_eq!(
        room.said.last().expect("a line"),
        "the server has lost what it stored: 4 batches are sent again"
    );
    let texts = |batches: &[WorkBatch]| {
        let tasks = batches.iter().flat_map(|batch| &batch.tasks);
        tasks.map(|task| task.text.to_string()).collect::<Vec<String>>()
    };
    assert_eq!(texts(&room.published), texts(&lost), "the same tasks in the same order");
    assert!(lost.iter().all(|batch| room.published.iter().all(|new| new.batch != batch.batch)));
    // A worker may still have one of the lost batches.
    room.answer(results("a", &lost[0], right));
    room.work("a", right);
    assert_eq!(room.right_indices(1), (0..20).collect::<Vec<usize>>());
}

#[test]
fn a_worker_that_falls_silent_is_told_once_unless_the_server_is_silent_too() {
    let mut room = Room::new();
    room.hear("stays", 1);
    room.hear("dies", 1);
    for _ in 0..4 {
        room.pass(SILENCE / 2);
        room.ledger.excuse_silence(room.now);
    }
    assert_eq!(room.ledger.staff.workers(), 2);
    for _ in 0..8 {
        room.pass(SILENCE / 2);
        room.hear("stays", 1);
    }
    let lost: Vec<&String> = room.said.iter().filter(|line| line.contains("lost")).collect();
    let words = "worker dies on computer lost: no sign of it for 5 s; others compute what it had";
    assert_eq!(lost, [words]);
    room.hear("dies", 1);
    assert_eq!(room.said.last().expect("a line"), "worker dies on computer: 1 thread");
    // A worker that leaves is not reported as lost.
    let leaving = WorkerNotice { leaves: true, ..notice("dies", 1, PROOF) };
    room.tell(|ledger, now| ledger.on_notice(leaving, now));
    let told = room.said.len();
    room.pass(2 * SILENCE);
    assert_eq!(room.said.len(), told + 1, "only the other one: {:?}", room.said);
}

#[test]
fn a_silent_worker_is_forgotten_and_what_is_held_of_it_is_computed_again() {
    let mut room = Room::at_work(1, 1);
    let batch = room.published.remove(0);
    // The result of this worker arrives, but the check is never answered.
    let actions = room.ledger.on_results(results("a", &batch, right), room.now);
    let [LedgerAction::Audit(audit)] = &actions[..] else { unreachable!("{actions:?}") };
    room.now += Duration::from_secs(6);
    room.hear("b", 1);
    room.pass(Duration::ZERO);
    assert_eq!(room.published.len(), 1);
    room.work("b", right);
    assert!(room.delivered.is_empty(), "the same task is still being checked");
    let line = right(&audit.task).line();
    let then = room.ledger.on_audit(audit.task.key, Some(line.into()), room.now);
    room.act(then);
    assert_eq!(room.right_indices(1), [0]);
}

#[test]
fn a_call_that_holds_publishes_nothing_and_one_that_ends_is_forgotten() {
    let mut room = Room::new();
    room.tell(|ledger, now| ledger.pause(1, true, now));
    room.hear("a", 1);
    room.open(1, 5);
    assert!(room.published.is_empty());
    assert_eq!(room.ledger.take_for_local(), None);
    room.tell(|ledger, now| ledger.pause(1, false, now));
    assert_eq!(room.published.len(), 2);
    room.ledger.close(1);
    assert_eq!(room.ledger.pending(), 0);
    room.work("a", right);
    assert!(room.delivered.is_empty());
}

#[test]
fn results_for_a_predecessor_count_when_they_are_asked_for() {
    let mut room = Room::new();
    let task = |number: usize| {
        let text: Arc<str> = format!("task {number}").into();
        TaskText { key: task_key(7, &text), text }
    };
    let old = WorkBatch {
        run: "run".to_owned(),
        batch: 99,
        kind: TaskKind::Score,
        shared: 7,
        tasks: vec![task(0), task(1)],
    };
    room.hear("a", 1);
    room.answer(results("a", &old, right));
    assert!(room.delivered.is_empty());
    room.open(1, 3);
    assert_eq!(room.right_indices(1), [0, 1]);
    assert_eq!(room.published.iter().map(|batch| batch.tasks.len()).sum::<usize>(), 1);
}

#[test]
fn the_coordinator_s_own_threads_take_tasks_from_the_end() {
    let mut room = Room::new();
    room.open(1, 3);
    let (key, kind, shared, text) = room.ledger.take_for_local().expect("a task");
    assert_eq!((kind, shared, &*text), (TaskKind::Score, 7, "task 2"));
    let outcome = right(&TaskText { key, text });
    room.tell(|ledger, _| ledger.deliver(key, outcome));
    assert_eq!(room.right_indices(1), [2]);
}

#[test]
fn a_batch_that_is_too_large_stays_for_the_caller() {
    let mut room = Room::at_work(2, 1);
    let batch = room.published.remove(0);
    room.tell(|ledger, _| ledger.on_too_large(&batch));
    assert!(matches!(room.delivered[..], [(1, 0, Outcome::Refused(_))]), "{:?}", room.delivered);
}

#[test]
fn f3_batches_give_way_while_a_worker_waits_to_store_its_results() {
    let mut room = Room::at_work(4, 1);
    let published = std::mem::take(&mut room.published);
    assert!(!published.is_empty());
    let tell = |room: &mut Room, trouble: Option<&str>| {
        let trouble = trouble.map(str::to_owned);
        let notice = crate::hello::WorkerNotice { trouble, ..notice("a", 1, PROOF) };
        let actions = room.ledger.on_notice(notice, room.now);
        let withdraws = actions.contains(&LedgerAction::Withdraw);
        room.act(actions);
        withdraws
    };
    assert!(tell(&mut room, Some("full")), "once");
    assert!(!tell(&mut room, Some("full")) && room.published.is_empty());
    room.answer(results("a", &published[0], right));
    assert!(room.published.is_empty(), "results count, and batches are held back");
    assert!(!tell(&mut room, None));
    assert!(!room.published.is_empty());
    room.work("a", right);
    assert_eq!(room.right_indices(1), [0, 1, 2, 3]);
}
