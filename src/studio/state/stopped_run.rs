//! Opens, at the start of the program, the run that was stopped last, or offers it beside a run with other settings.

use bevy::prelude::*;

use super::current_run::{CurrentRun, RunStatus};
use crate::studio::commands::{Command, RunCommand};
use crate::studio::ui::notifications::Notices;
use snakes_core::save::RunSummary;

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Startup, list).add_systems(FixedUpdate, open);
}

/// Lists the runs, unless the user has named a run.
fn list(mut run: ResMut<CurrentRun>, mut notices: ResMut<Notices>) {
    if run.context.offers_stopped_run {
        notices.problems(run.list_runs().err());
    }
}

/// Opens the run that was stopped last, paused, once the runs are listed. If the program was started with other settings,
/// starts its own run and offers the stopped one.
fn open(mut run: ResMut<CurrentRun>, mut notices: ResMut<Notices>, mut is_done: Local<bool>) {
    if *is_done || !run.context.offers_stopped_run {
        return;
    }
    // A list that cannot be read is reported, and the own run starts.
    let Some(stopped) = run.stopped() else { return };
    *is_done = true;
    let latest = stopped
        .filter(|of| of.run.finished > 0)
        .max_by_key(|of| of.run.saved_at)
        .map(|of| (of.run.clone(), offer_text(&of.run, &of.name)));
    if run.status() != RunStatus::Ready {
        return;
    }
    let own = run.next_plan();
    let is_plain = run.context.presets.settings_of(&own.preset) == Some(&own.settings);
    let is_alike = |of: &RunSummary| {
        of.plan.preset == own.preset && (is_plain || of.plan.settings == own.settings)
    };
    let opened = match latest {
        Some((latest, _)) if is_alike(&latest) => run.open_stopped(&latest.folder),
        Some((latest, offer)) => {
            let go_on = Command::Run(RunCommand::Continue(latest.folder));
            notices.lasting_offer(offer, "Continue", go_on);
            run.start()
        }
        None => run.start(),
    };
    notices.problems(opened.err());
}

/// Describes a stopped run in a sentence: "Climb 1, 27 Nov, 26 m: stopped after generation 41 of 200."
fn offer_text(run: &RunSummary, name: &str) -> String {
    let generations = run.plan.most_generations_in_words();
    format!("{name}: stopped after generation {} of {generations}.", run.finished)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::{evolve, small_run};
    use crate::studio::state::options::Options;
    use snakes_core::save::SavesFolder;
    use std::path::Path;

    /// Keeps a stopped run of seed 1 in this folder, starts the studio with another run, and waits until `is_ready`.
    fn started(folder: &Path, own: (u64, u32), is_ready: impl Fn(&World) -> bool) -> App {
        let saves = SavesFolder::find(Some(folder));
        evolve(small_run(&saves, 1, 10_000), 1);
        let run = small_run(&saves, own.0, own.1);
        let options = Options { offers_stopped_run: true, ..Options::of_test(run, saves) };
        let mut app = App::new();
        app.insert_resource(CurrentRun::new(&options))
            .init_resource::<Notices>()
            .add_plugins(bevy::time::TimePlugin)
            .add_plugins((crate::studio::state::current_run::events::plugin, plugin));
        let began = std::time::Instant::now();
        while !is_ready(app.world()) && began.elapsed().as_secs() < 30 {
            app.update();
        }
        app
    }

    #[test]
    fn a_stopped_run_with_other_settings_is_offered_by_name_and_place() {
        let folder = tempfile::tempdir().expect("a folder");
        // The run is too long to finish during the test, which would cause a message.
        let is_told = |world: &World| world.resource::<Notices>().len() > 0;
        let app = started(folder.path(), (2, 9_000), is_told);
        let notices = app.world().resource::<Notices>();
        let said = notices.last().unwrap_or_default();
        assert!(said.starts_with("test 1, "), "{said}");
        assert!(said.ends_with(" m: stopped after generation 1 of 10000."), "{said}");
        assert_eq!(notices.len(), 1);
        let run = app.world().resource::<CurrentRun>();
        assert_eq!((run.plan_now.seed, run.status()), (2, RunStatus::Running));
    }

    #[test]
    fn a15_the_run_that_was_stopped_last_is_opened_paused_and_can_continue() {
        let folder = tempfile::tempdir().expect("a folder");
        let is_open = |world: &World| world.resource::<CurrentRun>().reports().len() == 1;
        let mut app = started(folder.path(), (2, 10_000), is_open);
        let mut run = app.world_mut().resource_mut::<CurrentRun>();
        assert_eq!((run.plan_now.seed, run.number(), run.reports().len()), (1, 0, 1));
        assert_eq!(run.status(), RunStatus::Paused);
        assert!(!run.milestones.is_empty(), "its best snake can be shown");
        let mut notices = Notices::default();
        run.apply(&RunCommand::New, &mut notices).expect("allowed");
        assert_eq!(
            (run.plan_now.seed, run.status()),
            (2, RunStatus::Running),
            "the next unused seed"
        );
    }
}
