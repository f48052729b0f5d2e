//! Ends the program once the pictures that the user asked for are saved.

use std::time::Duration;

use bevy::prelude::*;

use crate::studio::pictures::screenshot::AwaitedPictures;

/// Whether the user asked for the end of the program.
#[derive(Resource, Debug, Default)]
pub(crate) struct QuitRequest(pub bool);

/// Maximum time to wait for a picture. A window that is not drawn, for example because it is minimised, gives none.
const PATIENCE: Duration = Duration::from_secs(5);

pub(crate) fn plugin(app: &mut App) {
    // Before the preferences are saved for the last time.
    app.init_resource::<QuitRequest>().add_systems(PostUpdate, end);
}

fn end(
    request: Res<QuitRequest>,
    pictures: AwaitedPictures,
    time: Res<Time<Real>>,
    mut waited: Local<Duration>,
    mut exit: MessageWriter<AppExit>,
) {
    if !request.0 {
        return;
    }
    *waited += time.delta();
    if pictures.is_empty() || *waited > PATIENCE {
        exit.write(AppExit::Success);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::render::view::screenshot::Screenshot;

    #[test]
    fn a_picture_that_was_asked_for_is_saved_before_the_program_ends() {
        let mut app = App::new();
        app.init_resource::<Time<Real>>().add_message::<AppExit>().add_plugins(plugin);
        let picture = app.world_mut().spawn(Screenshot::primary_window()).id();
        app.update();
        app.world_mut().resource_mut::<QuitRequest>().0 = true;
        app.update();
        assert_eq!(app.should_exit(), None, "the picture is not saved yet");
        app.world_mut().despawn(picture);
        app.update();
        assert_eq!(app.should_exit(), Some(AppExit::Success));
    }

    #[test]
    fn a_picture_that_never_comes_does_not_keep_the_program_open() {
        let mut app = App::new();
        app.init_resource::<Time<Real>>().add_message::<AppExit>().add_plugins(plugin);
        app.world_mut().spawn(Screenshot::primary_window());
        app.world_mut().resource_mut::<QuitRequest>().0 = true;
        app.world_mut().resource_mut::<Time<Real>>().advance_by(PATIENCE * 2);
        app.update();
        assert_eq!(app.should_exit(), Some(AppExit::Success));
    }
}
