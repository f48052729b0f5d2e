//! Handles the events of the background run.

use bevy::prelude::*;

use super::live_changes::{news_of, refusal_in_words};
use super::{CurrentRun, RunStatus};
use crate::studio::ui::notifications::Notices;
use snakes_core::save::ExistingRun;
use snakes_lab::run::{OpenedRun, RunEvent};

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(FixedUpdate, take_in);
}

fn take_in(mut run: ResMut<CurrentRun>, mut notices: ResMut<Notices>) {
    run.others.take_in();
    let Some(background) = &run.background else { return };
    let events: Vec<RunEvent> = std::iter::from_fn(|| background.poll()).collect();
    for event in events {
        match event {
            RunEvent::Opened(opened) => {
                let OpenedRun { plan_now, reports: behind, .. } = *opened;
                run.take_in_opened_plan(plan_now);
                // The next start must not discard the run again.
                run.source.earlier = ExistingRun::Keep;
                run.discarded = None;
                let has_ended = run.plan_now.has_ended(behind.iter().map(|report| &report.record));
                let is_running = run.status() == RunStatus::Running;
                if let Some(last) = behind.last().filter(|_| is_running && !has_ended) {
                    notices
                        .info(format!("The run continues after generation {}.", last.generation));
                }
                // A finished run that continues has noted its milestones before, some with all their snakes.
                let known = run.reports.len();
                behind.iter().skip(known).for_each(|report| run.note_milestone(report));
                run.reports = behind;
            }
            RunEvent::Refused(problem) => {
                notices.problem(format!("The run cannot start: {problem}"));
                run.background = None;
                run.context.set_run_folder(None);
            }
            RunEvent::SettingChanged { change, plan_now } => {
                notices.info(news_of(&change));
                run.settle_change(&change.field);
                run.plan_now = *plan_now;
            }
            RunEvent::SettingNotChanged { field, reason } => {
                run.settle_change(&field);
                notices.refusal(Some(refusal_in_words(&field, &reason)));
            }
            RunEvent::Explored(exploration) => run.explore(exploration),
            RunEvent::Generation(report) => {
                run.note_milestone(&report);
                run.reports.push(*report);
            }
            RunEvent::Finished { run_hash } => {
                run.run_hash = Some(run_hash);
                // Changes that were requested too late apply only to the next run.
                run.pending.clear();
                run.context.set_run_folder(None);
                let mut listed = run.others.runs.iter().flatten();
                let listed = listed.find(|of| of.run.folder == run.source.folder);
                notices.important(format!(
                    "{} is finished: \"{}\" goes on with it, \"New run\" starts another.",
                    listed.map_or("The run", |of| &of.name),
                    run.extension_in_words()
                ));
            }
            RunEvent::Untrusted(reason) => {
                notices.problem(format!(
                    "Evolution stopped: {reason}. Earlier results may be wrong too, so the run begins again: press E."
                ));
                notices.problems(run.end_untrusted(reason).err());
                return;
            }
            RunEvent::Failed => {
                let problem = "The run stopped because of a program error. Press E to resume from what was saved.";
                notices.problem(problem.to_owned());
                run.open_again();
                return;
            }
            RunEvent::NotSaved(problem) => {
                notices.problem(format!(
                    "Not saved, so evolution is paused: {problem}. Press E to try again."
                ));
            }
            RunEvent::Crashed(problem) => notices.problem(problem),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::schedule::RESULTS_HZ;
    use crate::studio::state::current_run::{prepared_run, run_in, small_run};
    use bevy::time::TimeUpdateStrategy;
    use snakes_core::save::SavesFolder;
    use snakes_core::schema::SettingValue;
    use std::path::Path;
    use std::time::{Duration, Instant};
    use tempfile::TempDir;

    /// Creates a studio without a window, whose run is saved in this folder.
    fn studio(folder: &Path) -> App {
        let saves = SavesFolder::find(Some(folder));
        let mut app = App::new();
        app.insert_resource(run_in(&saves, small_run(&saves, 1, 3)))
            .init_resource::<Notices>()
            .add_systems(Update, take_in);
        app
    }

    /// Updates the app until a condition holds. Returns the run.
    fn wait_until(app: &mut App, is_so: impl Fn(&CurrentRun) -> bool) -> &CurrentRun {
        let began = Instant::now();
        while began.elapsed() < Duration::from_secs(60) {
            app.update();
            if is_so(app.world().resource()) {
                return app.world().resource();
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        panic!("the condition never held");
    }

    /// Updates the app until the run is finished. Returns the run.
    fn finished(app: &mut App) -> &CurrentRun {
        wait_until(app, |run| run.status() == RunStatus::Finished)
    }

    /// Calls a method of the run that must succeed.
    fn act<T>(app: &mut App, act: impl FnOnce(&mut CurrentRun) -> Result<T, String>) -> T {
        act(&mut app.world_mut().resource_mut::<CurrentRun>()).expect("allowed")
    }

    /// Creates a studio whose run is paused after its first generation.
    fn paused_studio() -> (TempDir, App) {
        let folder = tempfile::tempdir().expect("a folder");
        let mut app = studio(folder.path());
        act(&mut app, |run| run.single_generation());
        wait_until(&mut app, |run| run.reports.len() == 1 && run.status() == RunStatus::Paused);
        (folder, app)
    }

    #[test]
    fn results_are_taken_in_at_a_fixed_rate_at_any_frame_rate() {
        let frame = |length_ms| {
            let mut app = App::new();
            app.add_plugins(bevy::time::TimePlugin)
                .insert_resource(Time::<Fixed>::from_hz(RESULTS_HZ))
                .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(
                    length_ms,
                )))
                .insert_resource(prepared_run())
                .init_resource::<Notices>()
                .add_plugins(plugin);
            // The first update only starts the clock.
            (0..=600 / length_ms).for_each(|_| app.update());
            let time = app.world().resource::<Time<Fixed>>();
            (time.elapsed().as_millis() / time.timestep().as_millis(), time.timestep())
        };
        let twenty_per_s = (12, Duration::from_millis(50));
        assert_eq!([10, 60, 200].map(frame), [twenty_per_s; 3], "20 times a second for 0.6 s");
    }

    #[test]
    fn settings_of_another_preset_or_run_do_not_change_the_run_under_way() {
        let (_folder, mut app) = paused_studio();
        let before = act(&mut app, |run| {
            let before = run.plan_next.clone();
            run.set_preset("report")?;
            run.set_field("evolution.population", "9")?;
            assert!(run.takes_changes().is_err());
            assert_eq!(run.requested_settings().evolution.population, 6);
            // Undo makes the same change.
            run.set_next_plan(before.clone())?;
            assert_eq!(run.takes_changes(), Ok(()));
            Ok(before)
        });
        act(&mut app, |run| {
            // Undo of a resumption makes the same change: another plan was set before.
            let mut other = before;
            other.settings.evolution.population = 5;
            run.replace_next(other, false)?;
            run.set_field("halving.parents", "3")?;
            let requested = run.requested_settings().into_owned().evolution;
            assert_eq!((requested.population, requested.halving.parents), (6, 4));
            assert!(run.next_run_differs());
            Ok(())
        });
    }

    #[test]
    fn a_reset_run_starts_again_even_after_other_settings_were_set() {
        let (_folder, mut app) = paused_studio();
        act(&mut app, |run| {
            run.reset();
            run.set_field("evolution.population", "5")?;
            run.set_field("evolution.population", "6")?;
            run.single_generation()
        });
        let run = wait_until(&mut app, |run| !run.reports.is_empty());
        assert_eq!(run.reports.iter().map(|report| report.generation).collect::<Vec<_>>(), [1]);
        // A reset does not discard later progress again.
        act(&mut app, |run| {
            run.set_seed(2);
            run.begin_next()?;
            run.pause()?;
            run.set_seed(1);
            run.begin_next()
        });
        let run = finished(&mut app);
        assert_eq!((run.plan_now.seed, run.reports.len()), (1, 3));
    }

    #[test]
    fn a_finished_run_continues_for_as_many_generations_as_it_began_with() {
        let (_folder, mut app) = paused_studio();
        act(&mut app, |run| {
            assert!(run.extend().is_err(), "it is not finished");
            run.start()
        });
        for generations in [6, 9] {
            let hash = finished(&mut app).run_hash;
            act(&mut app, |run| {
                run.extend()?;
                assert_eq!((run.status(), run.run_hash), (RunStatus::Running, None));
                Ok(())
            });
            let run = finished(&mut app);
            assert_eq!((run.reports.len(), run.number), (generations, 0));
            assert_ne!(run.run_hash, hash);
            assert!(!run.next_run_differs(), "the next run has as many");
            assert!(run.milestones.is_sorted_by(|a, b| a.generation < b.generation));
        }
    }

    #[test]
    fn a_refused_change_does_not_affect_others() {
        let (_folder, mut app) = paused_studio();
        act(&mut app, |run| {
            // The strategy cannot change during a run. This change is refused; those before and after it are made.
            run.change_running("evolution.population", SettingValue::Whole(5))?;
            run.background()?
                .request_changes([("evolution.strategy".to_owned(), SettingValue::Name("ga"))]);
            run.change_running("evolution.halving.parents", SettingValue::Whole(2))
        });
        let run = wait_until(&mut app, |run| run.plan_now.changes.made().len() == 2);
        assert_eq!(run.pending, []);
    }

    #[test]
    fn a_run_that_failed_can_be_resumed() {
        let (_folder, mut app) = paused_studio();
        act(&mut app, |run| {
            run.change_running("evolution.halving.parents", SettingValue::Whole(2))
        });
        wait_until(&mut app, |run| run.plan_now.changes.made().len() == 1);
        act(&mut app, |run| {
            run.open_again();
            assert_eq!((run.status(), run.plan_now.changes.made().len()), (RunStatus::Ready, 0));
            run.start()
        });
        let run = finished(&mut app);
        assert_eq!((run.reports.len(), run.plan_now.changes.made().len()), (3, 1));
    }

    #[test]
    fn live_settings_change_in_both_runs_and_others_only_in_the_next() {
        let (folder, mut app) = paused_studio();
        act(&mut app, |run| {
            run.set_field("halving.parents", "2")?;
            run.set_field("evolution.population", "4")?;
            run.set_field("surface.friction", "0.5")?;
            assert!(run.next_run_differs(), "in its friction");
            run.set_field("surface.friction", "1")?;
            assert!(!run.next_run_differs(), "the run will soon be like the next");
            run.change_running("evolution.generations", SettingValue::Whole(4))
        });
        wait_until(&mut app, |run| run.plan_now.changes.made().len() == 3);
        act(&mut app, |run| {
            let (now, next) = (&run.settings().evolution, &run.next_settings().evolution);
            assert_eq!((now.halving.parents, now.population, now.generations), (2, 4, 4));
            assert_eq!((next.halving.parents, next.population, next.generations), (2, 4, 3));
            assert!(run.plan_now.changes.made().iter().all(|change| change.generation == 2));
            assert!(run.run_allows("trial.surface.friction").is_err());
            run.start()
        });
        let run = finished(&mut app);
        let sizes: Vec<u32> = run.reports.iter().map(|report| report.evaluations).collect();
        assert_eq!(sizes, [6, 4, 4, 4]);
        // When the run is resumed after a restart of the program, it has the same hash and changes.
        let (hash, run_folder) = (run.run_hash, run.source.folder.clone());
        drop(app);
        let mut app = studio(folder.path());
        act(&mut app, |run| run.go_on_with(&run_folder));
        let run = finished(&mut app);
        assert_eq!((run.run_hash, run.plan_now.changes.made().len()), (hash, 3));
        assert_eq!(run.settings().evolution.generations, 4);
        assert!(!run.next_run_differs(), "the next run is like this one");
    }
}
