//! What a person has chosen for the window survives a restart.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::window::PrimaryWindow;

use super::camera::StageCamera;
use super::desk::Desk;
use super::look::Theme;
use super::notice::Notices;
use super::overlay::{Overlay, Overlays};
use super::panels::Layout;
use super::playback::Playback;
use crate::save::{Preferences, PreferencesFile};

/// What was read when the window opened, and where it is kept.
#[derive(Resource, Debug, Clone)]
pub(super) struct Remembered {
    file: PreferencesFile,
    /// What is in the file, as far as is known.
    stored: Preferences,
    /// What was chosen when it was looked at last: a change is written when it rests.
    seen: Preferences,
    /// Why the file could not be read or written, until that is said.
    problem: Option<String>,
    /// When it was looked at last, in seconds.
    looked_s: f32,
    /// Whether edges were smoothed before anybody chose.
    was_smooth: Option<bool>,
}

/// How often it is looked whether something was changed, in seconds.
const LOOK_S: f32 = 0.5;

impl Remembered {
    /// Reads what was chosen before. A file that cannot be read is put aside.
    pub fn read(file: &PreferencesFile) -> Self {
        let (stored, problem) = match file.load() {
            Ok(stored) => (stored.unwrap_or_default(), None),
            Err(error) => {
                let aside = file.put_aside().map(|path| format!(" It is {} now.", path.display()));
                let problem = format!(
                    "Your settings of the window are as new: {error}.{}",
                    aside.unwrap_or_default()
                );
                (Preferences::default(), Some(problem))
            }
        };
        let file = file.clone();
        Self { file, seen: stored.clone(), stored, problem, looked_s: 0.0, was_smooth: None }
    }

    /// Writes nothing from now on.
    pub fn only_read(mut self) -> Self {
        self.file = PreferencesFile::nowhere();
        self
    }

    /// What was chosen before.
    pub fn chosen(&self) -> &Preferences {
        &self.stored
    }
}

pub(super) fn plugin(app: &mut App) {
    app.add_systems(PostStartup, restore).add_systems(Last, remember);
}

/// What a person chooses, as it is now.
#[derive(SystemParam)]
struct Chosen<'w, 's> {
    desk: ResMut<'w, Desk>,
    theme: Res<'w, Theme>,
    overlays: ResMut<'w, Overlays>,
    playback: ResMut<'w, Playback>,
    smoothing: Query<'w, 's, &'static mut Msaa, With<StageCamera>>,
    window: Query<'w, 's, &'static Window, With<PrimaryWindow>>,
}

impl Chosen<'_, '_> {
    fn is_smooth(&self) -> Option<bool> {
        self.smoothing.iter().next().map(|msaa| *msaa != Msaa::Off)
    }
}

/// Gives the window back what was chosen before.
fn restore(mut remembered: ResMut<Remembered>, mut chosen: Chosen, mut notices: ResMut<Notices>) {
    notices.problems(remembered.problem.take());
    remembered.was_smooth = chosen.is_smooth();
    let Preferences { ui_scale, layout, overlays, speed, loops, smooth_edges, .. } =
        remembered.stored.clone();
    chosen.desk.scale = ui_scale;
    chosen.desk.layout = Layout::from_text(&layout);
    for name in overlays {
        let known = Overlay::ALL.into_iter().find(|overlay| overlay.words().0 == name);
        if let Some(overlay) = known.filter(|overlay| !chosen.overlays.shows(*overlay)) {
            chosen.overlays.toggle(overlay);
        }
    }
    chosen.playback.set_speed(speed);
    if chosen.playback.loops() != loops {
        chosen.playback.toggle_loop();
    }
    if let Some(is_smooth) = smooth_edges {
        for mut msaa in &mut chosen.smoothing {
            *msaa = if is_smooth { Msaa::Sample4 } else { Msaa::Off };
        }
    }
}

/// Writes down what was changed once it rests, and when the window closes.
fn remember(
    mut remembered: ResMut<Remembered>,
    chosen: Chosen,
    mut notices: ResMut<Notices>,
    mut exits: MessageReader<AppExit>,
    time: Res<Time<Real>>,
) {
    let ends = exits.read().next().is_some();
    if !ends && time.elapsed_secs() - remembered.looked_s < LOOK_S {
        return;
    }
    remembered.looked_s = time.elapsed_secs();
    let now = now(&remembered, &chosen);
    let rests = now == remembered.seen;
    remembered.seen = now.clone();
    if (rests || ends) && now != remembered.stored {
        // Said once: what cannot be written now could not be a moment later.
        if let Err(error) = remembered.file.store(&now) {
            notices.problem(format!("What you chose for the window is not kept: {error}"));
        }
        remembered.stored = now;
    }
}

fn now(remembered: &Remembered, chosen: &Chosen) -> Preferences {
    let before = &remembered.stored;
    // A window is asked for in logical pixels. Physical ones would be taken for those, and on a display with more than
    // one to the other it would grow at every start.
    let logical = |length: f32| length.round() as u32;
    let window_size = chosen
        .window
        .iter()
        .next()
        .map(|window| (logical(window.width()), logical(window.height())));
    let is_smooth = chosen.is_smooth();
    let has_chosen = before.smooth_edges.is_some() || is_smooth != remembered.was_smooth;
    let shown = Overlay::ALL.into_iter().filter(|overlay| chosen.overlays.shows(*overlay));
    let now = Preferences {
        theme: chosen.theme.name().to_owned(),
        ui_scale: chosen.desk.scale,
        window_size: window_size.or(before.window_size),
        layout: chosen.desk.layout.to_text(),
        overlays: shown.map(|overlay| overlay.words().0.to_owned()).collect(),
        speed: chosen.playback.speed(),
        loops: chosen.playback.loops(),
        smooth_edges: is_smooth.filter(|_| has_chosen),
        tour_is_over: chosen.desk.tour_is_over,
    };
    // A window of no size, which is being closed, is nobody's choice.
    if now.check().is_ok() { now } else { before.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::window::WindowResolution;

    fn app(file: &PreferencesFile) -> App {
        let mut app = App::new();
        app.add_message::<AppExit>()
            .insert_resource(Remembered::read(file))
            .init_resource::<Desk>()
            .init_resource::<Theme>()
            .init_resource::<Overlays>()
            .init_resource::<Playback>()
            .init_resource::<Notices>()
            .init_resource::<Time<Real>>()
            .add_plugins(plugin);
        app.update();
        app
    }

    #[test]
    fn what_was_chosen_is_there_again_in_the_next_window() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = PreferencesFile::at(&folder.path().join("studio.ron"));
        let mut first = app(&file);
        first.world_mut().resource_mut::<Desk>().scale = 1.5;
        first.world_mut().resource_mut::<Desk>().tour_is_over = true;
        first.world_mut().resource_mut::<Overlays>().toggle(Overlay::Trail);
        first.world_mut().resource_mut::<Playback>().set_speed(0.5);
        *first.world_mut().resource_mut::<Theme>() = Theme::Dark;
        first.world_mut().write_message(AppExit::Success);
        first.update();
        let second = app(&file);
        assert_eq!(second.world().resource::<Desk>().scale, 1.5);
        assert!(second.world().resource::<Overlays>().shows(Overlay::Trail));
        assert_eq!(second.world().resource::<Playback>().speed(), 0.5);
        let chosen = second.world().resource::<Remembered>().chosen().clone();
        assert!(chosen.theme == "dark" && chosen.tour_is_over);
    }

    #[test]
    fn settings_that_cannot_be_read_are_said_so_and_put_aside() {
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
    fn a_window_does_not_grow_at_every_start_where_several_pixels_make_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = PreferencesFile::at(&folder.path().join("studio.ron"));
        let mut app = app(&file);
        let mut resolution = WindowResolution::new(2560, 1440);
        resolution.set_scale_factor(2.0);
        app.world_mut().spawn((Window { resolution, ..default() }, PrimaryWindow));
        app.world_mut().write_message(AppExit::Success);
        app.update();
        let chosen = Remembered::read(&file).chosen().clone();
        assert_eq!(chosen.window_size, Some((1280, 720)));
    }
}
