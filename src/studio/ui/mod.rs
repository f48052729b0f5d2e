//! Widgets, theme and fonts that all panels share.

pub mod accessible;
pub mod buttons;
pub mod check_box;
pub mod decimals;
pub mod icons;
pub mod lane_dot;
pub mod notifications;
pub mod number_field;
mod outbox;
pub mod plot_axes;
pub mod scripts;
pub mod text_prompt;
pub mod text_rows;
pub mod theme;
pub mod viewport;

use bevy::prelude::*;

pub(super) fn plugin(app: &mut App) {
    app.add_plugins((notifications::plugin, scripts::plugin));
}
