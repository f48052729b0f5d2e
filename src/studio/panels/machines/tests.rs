//! Tests of the machines panel in each state of the connection.

use super::*;
use crate::studio::panels::testing::{assert_shows, click, press, shows, type_into};
use crate::studio::state::current_run::prepared_run;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use snakes_cluster::{Machines, RunNotice, RunQueue, WorkerNotice};
use snakes_core::{ENGINE_VERSION, Processors};

const URL: &str = "nats://192.168.1.5:4222";
const PROOF: &str = "0123456789abcdef";

fn panel(link: MachinesLink, width: f32) -> Harness<'static> {
    let (run, mut panel) = (prepared_run(), MachinesPanel::default());
    let builder = Harness::builder().with_size(egui::vec2(width, 1200.0));
    let mut harness = builder.build_ui(move |ui| panel.ui(ui, &link, &run));
    // A spinner is animated without end, so only a few frames are run.
    harness.run_steps(3);
    harness
}

fn narrow(link: MachinesLink) -> Harness<'static> {
    panel(link, theme::PANEL_WIDTH)
}

/// Creates the notice of a worker with this name and this proof.
fn worker(name: &str, proof: &str) -> (String, WorkerNotice) {
    let notice = WorkerNotice {
        format: 1,
        worker: name.to_owned(),
        host: "desk".to_owned(),
        engine: ENGINE_VERSION,
        processors: Processors::THIS,
        proof: proof.to_owned(),
        threads: 2,
        evaluations: 345,
        per_s: 6.25,
        redelivered: 7,
        trouble: None,
        leaves: false,
    };
    (name.to_owned(), notice)
}

/// The run of the window.
fn own_run() -> RunNotice {
    RunNotice {
        format: 1,
        run: "own-1".to_owned(),
        host: "desk".to_owned(),
        engine: ENGINE_VERSION,
        processors: Processors::THIS,
        proof: PROOF.to_owned(),
        pending: 40,
        results: 100,
        set_aside: vec!["liar-1".to_owned()],
        trouble: None,
    }
}

fn connected_to(machines: Option<Machines>, problem: Option<&str>) -> MachinesLink {
    MachinesLink::of_test(
        URL,
        LinkState::Connected(Box::new(KnownServer {
            proof: PROOF.to_owned(),
            machines,
            problem: problem.map(str::to_owned),
            own_run: Some("own-1".to_owned()),
        })),
    )
}

#[test]
fn without_a_connection_it_explains_the_first_steps_and_connects() {
    let mut panel = narrow(MachinesLink::default());
    assert_shows(&panel, &["Not connected", "1. Start a NATS server", SERVER, "3. Start workers"]);
    click(&mut panel, "Connect");
    assert_eq!(Command::take_sent(&panel.ctx), [], "there is no address yet");
    type_into(&mut panel, "Server", "192.168.1.5:4222");
    click(&mut panel, "Connect");
    let connect = MachinesCommand::Connect(URL.to_owned());
    assert_eq!(Command::take_sent(&panel.ctx), [Command::Machines(connect)]);
}

#[test]
fn the_last_address_is_offered_and_enter_connects() {
    let mut panel = narrow(MachinesLink::of_test(URL, LinkState::Off));
    click(&mut panel, "Server");
    press(&mut panel, egui::Key::Enter);
    let connect = MachinesCommand::Connect(URL.to_owned());
    assert_eq!(Command::take_sent(&panel.ctx), [Command::Machines(connect)]);
}

#[test]
fn an_address_with_a_password_is_refused_and_the_password_is_in_no_message() {
    let mut panel = narrow(MachinesLink::default());
    type_into(&mut panel, "Server", "nats://ann:secret@a");
    click(&mut panel, "Connect");
    assert_eq!(Command::take_sent(&panel.ctx), []);
    assert!(shows(&panel, "without user name and password"));
    assert!(!shows(&panel, "secret"));
}

#[test]
fn f3_connecting_can_be_cancelled_and_a_server_without_room_for_the_window_is_named_meanwhile() {
    let problem = "nats://a: cannot connect: the server says: maximum connections exceeded";
    for reason in [None, Some(problem.to_owned())] {
        let waits = LinkState::Connecting(reason.clone());
        let mut panel = narrow(MachinesLink::of_test(URL, waits));
        assert_shows(&panel, &["Connecting to nats://192.168.1.5:4222"]);
        assert_eq!(shows(&panel, problem), reason.is_some());
        panel.get_by_label("Cancel").click();
        panel.run_steps(3);
        let cancel = Command::Machines(MachinesCommand::Disconnect);
        assert_eq!(Command::take_sent(&panel.ctx), [cancel]);
    }
}

#[test]
fn f3_what_a_run_and_a_worker_wait_for_is_shown_beside_them() {
    let run = "work cannot be stored: the server says: insufficient resources (code 503, error code 10023)";
    let of_worker = "a result cannot be stored: the server says: maximum bytes exceeded";
    let mut machines = Machines::default();
    let (name, notice) = worker("desk-1", PROOF);
    machines.workers.insert(name, WorkerNotice { trouble: Some(of_worker.to_owned()), ..notice });
    let notice = RunNotice { trouble: Some(run.to_owned()), ..own_run() };
    machines.runs.insert("own-1".to_owned(), notice);
    for width in [theme::PANEL_WIDTH, 900.0] {
        let panel = panel(connected_to(Some(machines.clone()), None), width);
        assert_shows(&panel, &[run, of_worker]);
    }
}

#[test]
fn an_error_is_shown_with_the_first_steps() {
    let problem = "nats://a: cannot connect: connection refused";
    let panel = narrow(MachinesLink::of_test(URL, LinkState::Failed(problem.to_owned())));
    assert_shows(&panel, &["Not connected", problem, "1. Start a NATS server", "Connect"]);
}

#[test]
fn without_workers_it_shows_the_command_to_type_and_copies_it() {
    let mut panel = narrow(connected_to(Some(Machines::default()), None));
    let command = format!("snakes worker --nats {URL}");
    assert_shows(
        &panel,
        &["Connected: no workers", "No worker is there yet", &command, "Disconnect"],
    );
    click(&mut panel, &format!("Copy: {command}"));
    assert_eq!(Command::take_sent(&panel.ctx), [Command::Notify("Command copied.".to_owned())]);
    assert!(!shows(&panel, "works on this computer only"));
}

#[test]
fn an_address_of_this_computer_is_explained() {
    let known = KnownServer { machines: Some(Machines::default()), ..KnownServer::default() };
    let link =
        MachinesLink::of_test("nats://127.0.0.1:4222", LinkState::Connected(Box::new(known)));
    assert!(shows(&narrow(link), "works on this computer only"));
}

#[test]
fn workers_and_queues_are_listed_and_one_with_another_proof_is_marked() {
    let mut machines = Machines::default();
    machines.workers.extend([worker("desk-1", PROOF), worker("old-2", "fedcba9876543210")]);
    machines.runs.insert("own-1".to_owned(), own_run());
    machines.queues.insert("own-1".to_owned(), RunQueue { batches: 3, results: 2 });
    machines.queues.insert("left-2".to_owned(), RunQueue { batches: 5, results: 0 });
    for width in [theme::PANEL_WIDTH, 900.0] {
        let panel = panel(connected_to(Some(machines.clone()), None), width);
        assert_shows(
            &panel,
            &[
                "Connected: 1 worker, 2 threads, 6.2 per second",
                "desk-1",
                "345",
                "fedcba9876543210",
                "Not used: it computes other bits",
                "this window",
                "40 evaluations pending, 3 batches and 2 results waiting",
                "Set aside, because their results were wrong: liar-1",
                "left-2",
                "--purge left-2",
            ],
        );
    }
}

#[test]
fn a_request_that_failed_is_shown_above_what_was_known() {
    let mut machines = Machines::default();
    machines.workers.extend([worker("desk-1", PROOF)]);
    let panel = narrow(connected_to(Some(machines), Some("the list of queues failed: timed out")));
    assert_shows(&panel, &["A request to the server failed; asking again", "timed out", "desk-1"]);
}
