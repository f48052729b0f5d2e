//! What happens to the library by itself: it is read, follows the run, and takes files that are dropped.

use bevy::prelude::*;
use bevy::window::FileDragAndDrop;

use super::{Ask, Library};
use crate::studio::Frame;
use crate::studio::command::Command;
use crate::studio::evolution::{Evolution, Status};
use crate::studio::notice::Notices;

pub(in crate::studio) fn plugin(app: &mut App) {
    app.init_resource::<Library>()
        .add_systems(Update, (take_drops, follow, take_in).chain().in_set(Frame::TakeIn));
}

/// A folder that changes with every generation is looked at again after so many seconds at the earliest.
const EARLIEST_LOOK_S: f32 = 2.0;

fn take_in(mut library: ResMut<Library>, mut notices: ResMut<Notices>) {
    library.take_in(&mut notices);
}

/// Files that are dropped into the window are imported, all of a frame at once.
fn take_drops(
    mut drops: MessageReader<FileDragAndDrop>,
    mut library: ResMut<Library>,
    mut send: MessageWriter<Command>,
) {
    let mut dropped = Vec::new();
    for drop in drops.read() {
        library.is_drop_near = matches!(drop, FileDragAndDrop::HoveredFile { .. });
        if let FileDragAndDrop::DroppedFile { path_buf, .. } = drop {
            dropped.push(path_buf.clone());
        }
    }
    if !dropped.is_empty() {
        send.write(Command::Library(Ask::Import(dropped)));
    }
}

/// Looks again when the run has another generation, and knows which run goes on.
fn follow(
    mut library: ResMut<Library>,
    evolution: Res<Evolution>,
    time: Res<Time<Real>>,
    mut seen: Local<(u32, usize)>,
    mut looked_s: Local<f32>,
) {
    let goes_on = matches!(evolution.status(), Status::Running | Status::Paused);
    let current = goes_on.then(|| evolution.folder());
    if library.current.as_deref() != current {
        library.current = current.map(ToOwned::to_owned);
        library.revision += 1;
    }
    let now = (evolution.number(), evolution.reports().len());
    let now_s = time.elapsed_secs();
    if *seen != now && library.is_open() && now_s - *looked_s > EARLIEST_LOOK_S {
        (*seen, *looked_s) = (now, now_s);
        library.look_again();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::SavesFolder;
    use crate::studio::evolution::prepared_run;

    #[test]
    fn files_that_are_dropped_are_imported_together() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut app = App::new();
        app.add_message::<Command>()
            .add_message::<FileDragAndDrop>()
            .insert_resource(prepared_run())
            .insert_resource(Library::new(SavesFolder::find(Some(folder.path()))))
            .add_systems(Update, take_drops);
        let window = Entity::PLACEHOLDER;
        let path = |name: &str| folder.path().join(name);
        app.world_mut()
            .write_message(FileDragAndDrop::HoveredFile { window, path_buf: path("a.ron") });
        app.update();
        assert!(app.world().resource::<Library>().is_drop_near());
        for name in ["a.ron", "b.ron"] {
            let drop = FileDragAndDrop::DroppedFile { window, path_buf: path(name) };
            app.world_mut().write_message(drop);
        }
        app.update();
        assert!(!app.world().resource::<Library>().is_drop_near());
        let sent: Vec<Command> =
            app.world_mut().resource_mut::<Messages<Command>>().drain().collect();
        let both = vec![path("a.ron"), path("b.ron")];
        assert_eq!(sent, [Command::Library(Ask::Import(both))]);
    }
}
