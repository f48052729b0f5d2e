//! Ends the program when the pictures that the user requested are saved. The window's own close button sends the command to quit.

use std::time::Duration;

use bevy::prelude::*;
use bevy::window::WindowCloseRequested;

use crate::studio::commands::Command;
use crate::studio::pictures::screenshot::AwaitedPictures;
use crate::studio::schedule::FrameSet;

/// Whether the user has requested the end of the program.
#[derive(Resource, Debug, Default)]
pub(crate) struct QuitRequest(pub bool);

/// Time after which the program ends without an unsaved picture, provided that more than [`FRAMES`] frames have passed.
/// A window that is not drawn, for example because it is minimised, yields no picture.
const PATIENCE: Duration = Duration::from_secs(5);
/// Minimum number of frames to wait for a picture. With software rendering, each can take seconds.
const FRAMES: u32 = 10;
/// Time after which the program ends without an unsaved picture, however few frames have passed.
const LAST_PATIENCE: Duration = Duration::from_secs(30);

pub(crate) fn plugin(app: &mut App) {
    // The program ends before the preferences are stored for the last time.
    app.init_resource::<QuitRequest>()
        .add_systems(Update, close.in_set(FrameSet::TakeIn))
        .add_systems(PostUpdate, end);
}

/// Sends the command to quit for the window's close button, because quitting may ask first.
fn close(mut closing: MessageReader<WindowCloseRequested>, mut send: MessageWriter<Command>) {
    send.write_batch(closing.read().map(|_| Command::Quit));
}

fn end(
    request: Res<QuitRequest>,
    pictures: AwaitedPictures,
    time: Res<Time<Real>>,
    (mut waited, mut frames): (Local<Duration>, Local<u32>),
    mut exit: MessageWriter<AppExit>,
) {
    if !request.0 {
        return;
    }
    *waited += time.delta();
    *frames += 1;
    let is_given_up = (*waited > PATIENCE && *frames > FRAMES) || *waited > LAST_PATIENCE;
    if pictures.is_empty() || is_given_up {
        exit.write(AppExit::Success);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::render::view::screenshot::Screenshot;

    /// Creates a program with a picture that is not saved yet.
    fn app() -> (App, Entity) {
        let mut app = App::new();
        app.init_resource::<Time<Real>>()
            .add_message::<Command>()
            .add_message::<WindowCloseRequested>()
            .add_plugins(plugin);
        let picture = app.world_mut().spawn(Screenshot::primary_window()).id();
        (app, picture)
    }

    #[test]
    fn a_picture_that_was_asked_for_is_saved_before_the_program_ends() {
        let (mut app, picture) = app();
        app.update();
        app.world_mut().resource_mut::<QuitRequest>().0 = true;
        app.update();
        assert_eq!(app.should_exit(), None, "the picture is not saved yet");
        app.world_mut().despawn(picture);
        app.update();
        assert_eq!(app.should_exit(), Some(AppExit::Success));
    }

    #[test]
    fn the_close_button_of_the_window_sends_the_command_to_quit() {
        let (mut app, window) = app();
        app.world_mut().write_message(WindowCloseRequested { window });
        app.update();
        let sent: Vec<Command> =
            app.world_mut().resource_mut::<Messages<Command>>().drain().collect();
        assert_eq!(sent, [Command::Quit]);
    }

    /// Counts the frames of this length until a program that waits for a picture ends.
    fn frames_to_the_end(frame: Duration) -> usize {
        let (mut app, _) = app();
        app.world_mut().resource_mut::<QuitRequest>().0 = true;
        let has_ended = |_: &usize| {
            app.world_mut().resource_mut::<Time<Real>>().advance_by(frame);
            app.update();
            app.should_exit() == Some(AppExit::Success)
        };
        (1..1000).find(has_ended).expect("it ends")
    }

    #[test]
    fn a_picture_that_never_comes_keeps_no_program_open_and_slow_frames_have_time_for_one() {
        assert_eq!(frames_to_the_end(Duration::from_millis(100)), 51, "more than 5 s");
        assert_eq!(frames_to_the_end(Duration::from_secs(60)), 1, "not drawn");
        assert_eq!(frames_to_the_end(Duration::from_secs(2)), 11, "slow frames");
    }
}
