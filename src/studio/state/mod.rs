//! The state of the studio that is not drawn: the current run, the library, presets, undo, lessons.

pub mod body_editor;
pub mod chart_export;
pub mod current_run;
pub mod files;
pub mod following;
pub mod knock_outs;
mod latest_run;
pub mod lessons;
pub mod library;
pub mod lineup;
pub mod machines;
pub mod milestones;
pub mod new_file;
pub mod options;
pub mod plan_commands;
pub mod run_context;
pub mod shares;
pub mod stairs_exams;
pub mod stairs_race;
pub mod sweep;
pub mod turns;
pub mod undo;
pub mod what_if;

use bevy::prelude::*;

use super::schedule::RESULTS_HZ;

pub(super) fn plugin(app: &mut App) {
    app.insert_resource(Time::<Fixed>::from_hz(RESULTS_HZ));
    app.add_plugins((
        undo::plugin,
        current_run::events::plugin,
        following::plugin,
        latest_run::plugin,
        library::poll::plugin,
        files::plugin,
        lessons::plugin,
        shares::plugin,
        stairs_exams::plugin,
        body_editor::plugin,
        machines::plugin,
        turns::plugin,
    ));
}
