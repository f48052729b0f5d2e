//! Offers, once after the start of the program, to resume the run that was stopped last.

use bevy::prelude::*;

use super::current_run::CurrentRun;
use crate::studio::commands::{Command, RunCommand};
use crate::studio::state::run_context::RunContext;
use crate::studio::ui::notifications::Notices;
use snakes_core::save::RunSummary;

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Startup, list).add_systems(FixedUpdate, offer);
}

/// Lists the runs, unless the user has named a run.
fn list(mut run: ResMut<CurrentRun>, context: Res<RunContext>, mut notices: ResMut<Notices>) {
    if context.offers_stopped_run {
        notices.problems(run.list_runs().err());
    }
}

/// Offers to resume the run that was stopped last, once the runs are listed.
fn offer(
    run: Res<CurrentRun>,
    context: Res<RunContext>,
    mut notices: ResMut<Notices>,
    mut is_done: Local<bool>,
) {
    if *is_done || !context.offers_stopped_run {
        return;
    }
    let Some(stopped) = run.stopped() else { return };
    *is_done = true;
    let begun = stopped.filter(|run| run.finished > 0);
    if let Some(latest) = begun.max_by_key(|run| run.saved_at) {
        let resume = Command::Run(RunCommand::Continue(latest.folder.clone()));
        notices.lasting_offer(offer_text(latest), "Resume", resume);
    }
}

/// Describes a stopped run in a sentence: "climb, seed 1 stopped after generation 41 of 200."
fn offer_text(run: &RunSummary) -> String {
    let (plan, generations) = (&run.plan, run.plan.most_generations_in_words());
    format!(
        "{}, seed {} stopped after generation {} of {generations}.",
        plan.preset, plan.seed, run.finished
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::small_run;
    use crate::studio::state::options::Options;
    use snakes_core::save::SavesFolder;
    use snakes_lab::run::{LocalPool, RunControl};

    #[test]
    fn a_stopped_run_is_offered_by_name_and_place_after_the_start() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        let mut earlier = small_run(&saves, 1, 3).open("a test").expect("opened");
        let pool = LocalPool::new(1).expect("threads");
        let report = earlier.experiment.run_generation(&pool, &RunControl::default());
        let report = report.expect("not cancelled");
        earlier.recorder.record_generation(&earlier.experiment, &report).expect("kept");
        drop(earlier);
        let next = small_run(&saves, 1, 3).with_unused_seed(&saves);
        assert_eq!(next.plan.seed, 2, "its own seed is used");

        // The current run is too long to finish during the test, which would cause a message.
        let run = small_run(&saves, 2, 10_000);
        let options = Options { offers_stopped_run: true, ..Options::of_test(run, saves) };
        let context = RunContext::new(&options);
        let mut app = App::new();
        app.insert_resource(CurrentRun::new(context.clone()))
            .insert_resource(context)
            .init_resource::<Notices>()
            .add_plugins(bevy::time::TimePlugin)
            .add_plugins((crate::studio::state::current_run::events::plugin, plugin));
        let began = std::time::Instant::now();
        while app.world().resource::<Notices>().len() == 0 && began.elapsed().as_secs() < 30 {
            app.update();
        }
        let notices = app.world().resource::<Notices>();
        assert_eq!(notices.last(), Some("test, seed 1 stopped after generation 1 of 3."));
        assert_eq!(notices.len(), 1);
    }
}
