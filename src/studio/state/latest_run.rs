//! Opens, at the start of the program, the latest run, stopped or finished, or offers it beside a run with other settings.

use bevy::prelude::*;

use super::current_run::{CurrentRun, RunStatus, UnreadableRun};
use super::options::Options;
use crate::studio::commands::{Command, RunCommand};
use crate::studio::ui::notifications::Notices;
use snakes_core::evolve::RunPlan;
use snakes_core::save::{DEFAULT_PRESET, RunSummary};

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Startup, begin).add_systems(FixedUpdate, open);
}

/// Lists the runs or, if the user has named a run, starts evolution at once.
fn begin(mut run: ResMut<CurrentRun>, options: Res<Options>, mut notices: ResMut<Notices>) {
    let begun = if options.offers_stopped_run { run.list_runs() } else { run.start() };
    notices.problems(begun.err());
}

/// Opens the latest run, paused or finished, once the runs are listed. If the program was started with settings that the run does not
/// have, starts its own run and offers the latest one.
fn open(
    mut run: ResMut<CurrentRun>,
    options: Res<Options>,
    mut notices: ResMut<Notices>,
    mut is_done: Local<bool>,
) {
    if *is_done || !options.offers_stopped_run {
        return;
    }
    // A list that cannot be read is reported, and the own run starts.
    let Some(listed) = run.listed() else { return };
    *is_done = true;
    let latest = listed.filter(|of| of.run.finished > 0).max_by_key(|of| of.run.saved_at);
    let later = |of: &&UnreadableRun| latest.is_none_or(|latest| of.saved_at > latest.run.saved_at);
    let damaged = run.others.unreadable.iter().filter(later).max_by_key(|of| of.saved_at);
    notices.problems(damaged.map(|of| format!("The latest run cannot be opened: {}", of.problem)));
    let latest = latest.map(|of| (of.run.clone(), offer(&of.run, &of.name)));
    if run.status() != RunStatus::Ready {
        return;
    }
    let own = &run.plan_next;
    let is_plain = run.context.presets.settings_of(&own.preset) == Some(&own.settings);
    // Without flags for settings, the user wants none in particular.
    let is_any_wanted = is_plain && own.preset == DEFAULT_PRESET && !options.names_preset;
    let is_wanted = |of: &RunPlan| {
        let is_alike = of.preset == own.preset && (is_plain || of.settings == own.settings);
        is_any_wanted || is_alike
    };
    let opened = match latest {
        Some((latest, (text, _))) if is_wanted(&latest.plan) => {
            if latest.is_stopped() {
                notices.important(format!("{text} \"Continue evolution\" goes on with it."));
            }
            run.open_earlier(&latest.folder)
        }
        Some((latest, (text, label))) => {
            let go_on = Command::Run(RunCommand::Continue(latest.folder));
            notices.lasting_offer(text, label, go_on);
            run.start()
        }
        None => run.start(),
    };
    notices.problems(opened.err());
}

/// Describes a run in a sentence, "Climb 1, 27 Nov, 26 m: stopped after generation 41 of 200.", with the label of the button that opens it.
fn offer(run: &RunSummary, name: &str) -> (String, &'static str) {
    let (finished, all) = (run.finished, run.plan.most_generations_in_words());
    match run.is_stopped() {
        true => (format!("{name}: stopped after generation {finished} of {all}."), "Continue"),
        false => (format!("{name}: finished after generation {finished}."), "Show it"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::{evolve, small_run};
    use snakes_core::save::{ExistingRun, SavesFolder, load_preset};
    use snakes_lab::run::RunSource;
    use tempfile::TempDir;

    /// Evolves one generation of a run of seed 1 with this number of generations, starts the studio, and waits until `is_ready`. The
    /// studio's own run has the seed 2 and `own` generations, or the default preset and the seed 1. If `is_damaged`, the plan of the first
    /// run cannot be read.
    fn started(
        (generations, is_damaged): (u32, bool),
        own: Option<u32>,
        names_preset: bool,
        is_ready: impl Fn(&World) -> bool,
    ) -> (TempDir, App) {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        let earlier = small_run(&saves, 1, generations);
        evolve(earlier.clone(), 1);
        if is_damaged {
            std::fs::write(earlier.folder.join("run.ron"), "(").expect("written");
        }
        let settings = load_preset(DEFAULT_PRESET).expect("shipped").settings;
        let plan = RunPlan::new(DEFAULT_PRESET, 1, settings);
        let run = match own {
            Some(generations) => small_run(&saves, 2, generations),
            None => RunSource::in_saves(&saves, plan, ExistingRun::Keep),
        };
        let options =
            Options { offers_stopped_run: true, names_preset, ..Options::of_test(run, saves) };
        let mut app = App::new();
        app.insert_resource(CurrentRun::new(&options))
            .insert_resource(options)
            .init_resource::<Notices>()
            .add_plugins(bevy::time::TimePlugin)
            .add_plugins((crate::studio::state::current_run::events::plugin, plugin));
        let began = std::time::Instant::now();
        while !is_ready(app.world()) && began.elapsed().as_secs() < 30 {
            app.update();
        }
        (folder, app)
    }

    #[test]
    fn a_run_with_other_settings_is_offered_by_name_and_place() {
        // The own runs are too long to finish during the test, which would cause a message.
        for (generations, own, ending, label) in [
            (10_000, Some(9_000), " m: stopped after generation 1 of 10000.", "Continue"),
            (1, Some(9_000), ": finished after generation 1.", "Show it"),
            (1, None, ": finished after generation 1.", "Show it"),
        ] {
            let names_preset = own.is_none();
            let is_told = |world: &World| world.resource::<Notices>().len() > 0;
            let (_folder, app) = started((generations, false), own, names_preset, is_told);
            let notices = app.world().resource::<Notices>();
            let said = notices.last().unwrap_or_default();
            assert!(said.starts_with("test 1, ") && said.ends_with(ending), "{said}");
            assert_eq!((notices.len(), notices.last_offers()[0].0.as_str()), (1, label));
            let run = app.world().resource::<CurrentRun>();
            let seed = if names_preset { 1 } else { 2 };
            assert_eq!((run.plan_now.seed, run.status()), (seed, RunStatus::Running));
        }
    }

    #[test]
    fn f5_a_damaged_latest_run_is_told_with_its_file() {
        let is_told = |world: &World| world.resource::<Notices>().len() > 0;
        let (folder, app) = started((10_000, true), Some(9_000), false, is_told);
        let said = app.world().resource::<Notices>().last().unwrap_or_default();
        let file = folder.path().display();
        assert!(said.starts_with(&format!("The latest run cannot be opened: {file}")), "{said}");
        assert!(said.contains("run.ron: damaged or incomplete at line 1"), "{said}");
    }

    #[test]
    fn a15_the_latest_run_is_opened_stopped_or_finished_and_can_continue_or_make_place() {
        for (generations, status, go_on) in [
            (10_000, RunStatus::Paused, RunCommand::Start),
            (1, RunStatus::Finished, RunCommand::Extend),
        ] {
            let is_open = |world: &World| {
                let run = world.resource::<CurrentRun>();
                (run.reports.len(), run.status()) == (1, status)
            };
            for (own, command, seed) in [(Some(generations), go_on, 1), (None, RunCommand::New, 2)]
            {
                let (_folder, mut app) = started((generations, false), own, false, is_open);
                let said = app.world().resource::<Notices>().last().unwrap_or_default();
                let is_told = said.starts_with("test 1, ") && said.contains(" is finished: ");
                assert_eq!(is_told, status == RunStatus::Finished, "{said}");
                let mut run = app.world_mut().resource_mut::<CurrentRun>();
                let now = (run.plan_now.seed, run.number, run.reports.len());
                assert_eq!((now, run.status()), ((1, 0, 1), status));
                assert!(!run.milestones.is_empty(), "its best snake can be shown");
                run.apply(&command, &mut Notices::default()).expect("allowed");
                let now = (run.plan_now.seed, run.status());
                assert_eq!(now, (seed, RunStatus::Running), "{command:?}");
            }
        }
    }
}
