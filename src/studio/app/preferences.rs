//! Preferences of the user, kept across restarts.

use std::time::Duration;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::time::common_conditions::on_real_timer;
use bevy::window::PrimaryWindow;

use crate::studio::commands::overlay::Overlay;
use crate::studio::commands::quality::Quality;
use crate::studio::scene::overlays::Overlays;
use crate::studio::scene::quality::StageQuality;
use crate::studio::stage::playback::Playback;
use crate::studio::state::files::{Files, RecentFiles};
use crate::studio::state::lessons::Lessons;
use crate::studio::state::machines::MachinesLink;
use crate::studio::ui::notifications::Notices;
use crate::studio::ui::theme::Theme;
use crate::studio::workspace::Workspace;
use crate::studio::workspace::layout::Layout;
use snakes_core::save::{Preferences, PreferencesFile};

/// The stored preferences and the file in which they are stored.
#[derive(Resource, Debug, Clone)]
pub(crate) struct StoredPreferences {
    /// File in which the preferences are stored.
    pub file: PreferencesFile,
    /// Last known contents of the preferences file.
    pub stored: Preferences,
    /// Preferences at the last check. A change is written when it has not changed further until the next check.
    seen: Preferences,
    /// Error message from reading the file, until it is displayed.
    problem: Option<String>,
}

/// Interval between checks for changed preferences.
const POLL: Duration = Duration::from_millis(500);

impl StoredPreferences {
    /// Reads the preferences. If the file is unreadable, uses the defaults and renames the file as a backup.
    pub fn read(file: &PreferencesFile) -> Self {
        let (stored, problem) = match file.load() {
            Ok(stored) => (stored.unwrap_or_default(), None),
            Err(error) => {
                let mut problem = format!("The window preferences were reset: {error}.");
                if let Some(path) = file.put_aside() {
                    problem += &format!(" The old file is kept as {}.", path.display());
                }
                (Preferences::default(), Some(problem))
            }
        };
        let file = file.clone();
        Self { file, seen: stored.clone(), stored, problem }
    }
}

pub(crate) fn plugin(app: &mut App) {
    let is_time = on_real_timer(POLL).or_else(on_message::<AppExit>);
    app.add_systems(PostStartup, restore).add_systems(Last, remember.run_if(is_time));
}

/// Current state of everything that preferences cover.
#[derive(SystemParam)]
struct Chosen<'w, 's> {
    workspace: ResMut<'w, Workspace>,
    theme: Res<'w, Theme>,
    overlays: ResMut<'w, Overlays>,
    playback: ResMut<'w, Playback>,
    files: ResMut<'w, Files>,
    machines: ResMut<'w, MachinesLink>,
    lessons: ResMut<'w, Lessons>,
    quality: ResMut<'w, StageQuality>,
    window: Query<'w, 's, &'static Window, With<PrimaryWindow>>,
}

/// Applies the stored preferences to the window.
fn restore(
    mut remembered: ResMut<StoredPreferences>,
    mut chosen: Chosen,
    mut notices: ResMut<Notices>,
) {
    notices.problems(remembered.problem.take());
    let stored = remembered.stored.clone();
    chosen.files.recent = RecentFiles::from_texts(&stored.recent);
    chosen.machines.remember(&stored.server);
    chosen.workspace.unfolded = stored.unfolded.into_iter().collect();
    chosen.lessons.finished = stored.finished_lessons.into_iter().collect();
    chosen.workspace.scale.chosen = stored.ui_scale;
    chosen.workspace.layout = Layout::from_text(&stored.layout);
    let is_shown = |of: &Overlay| stored.overlays.iter().any(|name| name == of.name());
    chosen.overlays.extend(Overlay::ALL.into_iter().filter(is_shown));
    chosen.playback.set_speed(stored.speed);
    chosen.playback.loops = stored.loops;
    let is_chosen = |of: &Quality| stored.quality.as_deref() == Some(of.name());
    chosen.quality.chosen = Quality::ALL.into_iter().find(is_chosen);
}

/// Writes changed preferences when they have settled, and when the window closes.
fn remember(
    mut remembered: ResMut<StoredPreferences>,
    chosen: Chosen,
    mut notices: ResMut<Notices>,
    mut exits: MessageReader<AppExit>,
) {
    let ends = exits.read().next().is_some();
    let now = now(&remembered, &chosen);
    let rests = now == remembered.seen;
    remembered.seen = now.clone();
    if (rests || ends) && now != remembered.stored {
        // A failure is reported only once, because the next attempt would probably fail too.
        if let Err(error) = remembered.file.store(&now) {
            notices.problem(format!("The window preferences could not be saved: {error}"));
        }
        remembered.stored = now;
    }
}

fn now(remembered: &StoredPreferences, chosen: &Chosen) -> Preferences {
    let before = &remembered.stored;
    // The window's size is stored in logical pixels, in which it is also requested. Physical pixels would enlarge the
    // window at every start on a display with a scale factor above one.
    let logical = |length: f32| length.round() as u32;
    let size = |window: &Window| (logical(window.width()), logical(window.height()));
    let window_size = chosen.window.iter().next().map(size);
    // In the presenting mode, the window's size and the loop are not the user's choice.
    let presents = chosen.workspace.is_presenting;
    let now = Preferences {
        theme: chosen.theme.name().to_owned(),
        ui_scale: chosen.workspace.scale.chosen,
        window_size: window_size.filter(|_| !presents).or(before.window_size),
        layout: chosen.workspace.layout.to_text(),
        overlays: chosen.overlays.iter().map(|overlay| overlay.name().to_owned()).collect(),
        speed: chosen.playback.speed(),
        loops: if presents { before.loops } else { chosen.playback.loops },
        quality: chosen.quality.chosen.map(|quality| quality.name().to_owned()),
        tour_is_over: !chosen.workspace.awaits_tour,
        recent: chosen.files.recent.to_texts(),
        unfolded: chosen.workspace.unfolded.iter().cloned().collect(),
        finished_lessons: chosen.lessons.finished.iter().cloned().collect(),
        server: chosen.machines.address.clone(),
    };
    // A closing window can have size zero, which is ignored.
    if now.check().is_ok() { now } else { before.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::app::apply::tests;
    use crate::studio::commands::WindowCommand;
    use bevy::window::WindowResolution;

    fn app(file: &PreferencesFile) -> App {
        let mut app = tests::app();
        app.insert_resource(StoredPreferences::read(file))
            .init_resource::<Time<Real>>()
            .add_plugins(plugin);
        app.update();
        app
    }

    #[test]
    fn preferences_survive_a_restart() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = PreferencesFile::at(&folder.path().join("studio.ron"));
        let mut first = app(&file);
        let world = first.world_mut();
        world.resource_mut::<Workspace>().scale.chosen = 1.5;
        world.resource_mut::<Workspace>().awaits_tour = false;
        world.resource_mut::<Workspace>().unfolded.insert("Surface".to_owned());
        world.resource_mut::<Lessons>().finished.insert("Friction: how much?".to_owned());
        world.resource_mut::<Overlays>().insert(Overlay::Trail);
        world.resource_mut::<StageQuality>().chosen = Some(Quality::Beautiful);
        world.resource_mut::<Playback>().set_speed(0.5);
        *world.resource_mut::<Theme>() = Theme::Dark;
        let recent = RecentFiles::from_texts(&["/saves/mine.ron".to_owned()]);
        world.resource_mut::<Files>().recent = recent.clone();
        world.resource_mut::<MachinesLink>().remember("nats://desk:4222");
        world.write_message(AppExit::Success);
        first.update();
        let second = app(&file);
        assert_eq!(second.world().resource::<Workspace>().scale.chosen, 1.5);
        assert!(second.world().resource::<Workspace>().unfolded.contains("Surface"));
        assert_eq!(second.world().resource::<Lessons>().finished.len(), 1);
        assert!(second.world().resource::<Overlays>().contains(&Overlay::Trail));
        assert_eq!(second.world().resource::<StageQuality>().chosen, Some(Quality::Beautiful));
        assert_eq!(second.world().resource::<Playback>().speed(), 0.5);
        assert_eq!(second.world().resource::<Files>().recent, recent);
        assert_eq!(second.world().resource::<MachinesLink>().address, "nats://desk:4222");
        let chosen = second.world().resource::<StoredPreferences>().stored.clone();
        assert!(chosen.theme == "dark" && chosen.tour_is_over);
    }

    #[test]
    fn an_unreadable_file_is_reported_and_backed_up() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("studio.ron");
        let long = format!("(kind: \"{}\")", "x".repeat(300));
        let file = PreferencesFile::at(&path);
        std::fs::write(&path, &long).expect("written");
        let app = app(&file);
        assert_eq!(app.world().resource::<Notices>().len(), 1);
        assert!(folder.path().join("studio.ron.unreadable").exists());
    }

    #[test]
    fn the_window_size_is_stable_on_scaled_displays_and_that_of_a_presentation_is_not_remembered() {
        for (physical, scale, presents, remembered) in
            [([2560, 1440], 2.0, false, Some((1280, 720))), ([3840, 2160], 1.0, true, None)]
        {
            let folder = tempfile::tempdir().expect("a folder");
            let file = PreferencesFile::at(&folder.path().join("studio.ron"));
            let mut app = app(&file);
            let mut resolution = WindowResolution::new(physical[0], physical[1]);
            resolution.set_scale_factor(scale);
            app.world_mut().spawn((Window { resolution, ..default() }, PrimaryWindow));
            if presents {
                let mut workspace = app.world_mut().resource_mut::<Workspace>();
                workspace.apply(&WindowCommand::TogglePresenting);
            }
            app.world_mut().write_message(AppExit::Success);
            app.update();
            let size = StoredPreferences::read(&file).stored.window_size;
            assert_eq!(size, remembered, "{physical:?}");
        }
    }
}
