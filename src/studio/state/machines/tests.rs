//! The states of the connection, and their effect on the run.

use super::*;
use crate::studio::state::current_run::{run_in, small_run};
use snakes_cluster::RunQueue;
use snakes_core::save::SavesFolder;
use snakes_lab::run::LocalPool;
use std::sync::Arc;

/// Creates a run that is held before its first generation, and the folder of its saves.
fn held_run() -> (tempfile::TempDir, CurrentRun) {
    let folder = tempfile::tempdir().expect("a folder");
    let saves = SavesFolder::find(Some(folder.path()));
    let mut run = run_in(&saves, small_run(&saves, 1, 3));
    run.start().and_then(|()| run.pause()).expect("started");
    (folder, run)
}

/// Creates a link that is waiting for a server.
fn connecting() -> MachinesLink {
    let mut link = MachinesLink::of_test("nats://127.0.0.1:1", LinkState::Connecting(None));
    // No server listens at this address; the failure is never processed.
    let server = BrokerOptions { url: "nats://127.0.0.1:1".to_owned(), ..Default::default() };
    link.watch = Some(ServerWatch::start(server).expect("a thread"));
    link
}

fn known(link: &MachinesLink) -> &KnownServer {
    let LinkState::Connected(known) = &link.state else { panic!("{:?}", link.state) };
    known
}

#[test]
fn a_connected_server_gets_the_run_in_progress_and_loses_it_on_disconnection() {
    let (_folder, mut run) = held_run();
    let (mut link, mut notices) = (connecting(), Notices::default());
    link.follow(&mut run);
    assert_eq!(link.asked, None, "not before it is connected");
    link.take_in_news(WatchNews::Connected { proof: "p".to_owned() }, &mut run, &mut notices);
    link.follow(&mut run);
    let (number, asked) = link.asked.clone().expect("asked");
    assert_eq!((number, asked.local_threads), (run.number, 1));
    assert!(asked.name.starts_with("test-seed1-") && run.shared.is_none());

    let coordinates = |run: &WatchedRun| WatchNews::Coordinates {
        run: run.clone(),
        name: "n".to_owned(),
        evaluator: Arc::new(LocalPool::new(2).expect("threads")),
    };
    let other = WatchedRun { name: "other".to_owned(), local_threads: 1 };
    link.take_in_news(coordinates(&other), &mut run, &mut notices);
    assert!(run.shared.is_none(), "another run was asked for");
    link.take_in_news(coordinates(&asked), &mut run, &mut notices);
    assert!(run.shared.is_some());
    assert_eq!(known(&link).own_run.as_deref(), Some("n"));

    // Another number of threads needs another coordinator. Until it is ready, only this computer evaluates.
    run.set_threads(2).expect("allowed");
    link.follow(&mut run);
    assert!(run.shared.is_none());
    assert_eq!(link.asked.as_ref().map(|(_, run)| run.local_threads), Some(2));
    link.take_in_news(coordinates(&link.asked.clone().expect("asked").1), &mut run, &mut notices);
    assert!(run.shared.is_some());

    // Another run needs another coordinator as well.
    run.reset();
    assert!(run.shared.is_none());
    link.follow(&mut run);
    assert_eq!(link.asked, None, "it has not begun");

    link.apply(&MachinesCommand::Disconnect, &mut run).expect("allowed");
    assert_eq!((&link.state, link.address.as_str()), (&LinkState::Off, "nats://127.0.0.1:1"));
    assert_eq!(notices.len(), 0);
}

#[test]
fn f3_the_latest_problem_is_kept_until_the_next_list_and_a_server_without_room_is_tried_again() {
    let (_folder, mut run) = held_run();
    let (mut link, mut notices) = (connecting(), Notices::default());
    let mut hear = |link: &mut MachinesLink, news| link.take_in_news(news, &mut run, &mut notices);
    hear(&mut link, WatchNews::Trouble("full".to_owned()));
    assert_eq!(link.state, LinkState::Connecting(Some("full".to_owned())));
    hear(&mut link, WatchNews::Connected { proof: "p".to_owned() });
    assert_eq!(known(&link).problem, None);
    let mut machines = Machines::default();
    machines.queues.insert("run".to_owned(), RunQueue { batches: 2, results: 1 });
    hear(&mut link, WatchNews::Listed(machines.clone()));
    hear(&mut link, WatchNews::Trouble("lost".to_owned()));
    assert_eq!(known(&link).machines.as_ref(), Some(&machines));
    assert_eq!(known(&link).problem.as_deref(), Some("lost"));
    hear(&mut link, WatchNews::Listed(machines));
    assert_eq!(known(&link).problem, None);
}

#[test]
fn a_server_that_cannot_be_used_is_reported_and_its_address_stays() {
    let (_folder, mut run) = held_run();
    let (mut link, mut notices) = (connecting(), Notices::default());
    link.take_in_news(WatchNews::Failed("no server".to_owned()), &mut run, &mut notices);
    assert_eq!(link.state, LinkState::Failed("no server".to_owned()));
    assert_eq!(notices.last(), Some("Other computers are not connected: no server"));
    assert_eq!(link.address, "nats://127.0.0.1:1");
    assert!(link.watch.is_none());
}

#[test]
fn wrong_results_end_the_connection() {
    let (_folder, mut run) = held_run();
    run.share(Some(Arc::new(LocalPool::new(1).expect("threads"))));
    run.end_untrusted("w lies".to_owned()).expect("held again");
    let mut app = App::new();
    app.insert_resource(connecting())
        .insert_resource(run)
        .init_resource::<Notices>()
        .add_systems(Update, take_in);
    app.update();
    let link = app.world().resource::<MachinesLink>();
    assert_eq!(link.state, LinkState::Failed("w lies".to_owned()));
    assert!(app.world().resource::<CurrentRun>().shared.is_none());
}

#[test]
fn an_address_is_completed_and_one_with_a_password_is_refused_without_repeating_it() {
    for (typed, used) in [
        (" 192.168.1.5:4222 ", "nats://192.168.1.5:4222"),
        ("nats://a:4222, tls://b", "nats://a:4222,tls://b"),
    ] {
        assert_eq!(checked(typed).as_deref(), Ok(used));
    }
    let long = "a".repeat(2000);
    for typed in ["", "ann:secret@a", "nats://ann:secret@a:4222", "http://a", "a b", &long] {
        let problem = checked(typed).expect_err("refused");
        assert!(!problem.contains("secret") && problem.contains("nats://HOST:PORT"), "{problem}");
    }
    let mut link = MachinesLink::default();
    link.remember("nats://ann:secret@a:4222");
    assert_eq!(link.address, "");
}
