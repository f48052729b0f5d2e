//! The application: maps keys to commands and applies commands to all other parts of the studio.

pub mod accessibility;
pub mod apply;
pub mod frame_times;
pub mod keys;
pub mod preferences;
pub mod presenting;
pub mod quit;
pub mod title;
pub mod ui_dump;

use bevy::prelude::*;

pub(super) fn plugin(app: &mut App) {
    app.add_plugins((
        apply::plugin,
        keys::plugin,
        preferences::plugin,
        presenting::plugin,
        quit::plugin,
        accessibility::plugin,
        ui_dump::plugin,
        title::plugin,
    ));
}
