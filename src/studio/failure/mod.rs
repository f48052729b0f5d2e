//! Failures that would otherwise end the program without a message: a missing display, a panic, a lost graphics device.

pub mod gpu_loss;
pub mod panic_guard;
pub mod variables;

use bevy::prelude::*;

pub(super) fn plugin(app: &mut App) {
    app.add_plugins((gpu_loss::plugin, panic_guard::plugin));
}
