//! The window's title says where things stand, for a taskbar, a screen reader or a script.

use bevy::prelude::*;
use bevy::window::PrimaryWindow;

use super::Frame;
use super::evolution::{Evolution, Status};
use super::exhibit::Source;
use super::stage::Stage;

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Update, update.in_set(Frame::Draw));
}

fn update(
    evolution: Res<Evolution>,
    stages: Query<&Stage>,
    mut window: Single<&mut Window, With<PrimaryWindow>>,
) {
    let status = match evolution.status() {
        Status::Ready => "ready",
        Status::Running => "running",
        Status::Paused => "paused",
        Status::Finished => "finished",
    };
    let shown = match stages.iter().next() {
        None => "nothing".to_owned(),
        Some(stage) => {
            let generation = stage.exhibit().generation();
            let what = match stage.exhibit().source() {
                Source::Opening => "saved champion".to_owned(),
                Source::Run(run) if run == evolution.number() => format!("generation {generation}"),
                Source::Run(_) => format!("generation {generation} of an earlier run"),
            };
            let manner = match (stage.exhibit().is_changed(), stage.exhibit().recording()) {
                (true, _) => " in another world",
                (false, Some(_)) => " as recorded",
                (false, None) => "",
            };
            let held = if stage.is_playing() { "" } else { ", held" };
            format!("{what}{manner}{held}")
        }
    };
    let title = format!(
        "Snakes & Stairs - {}, seed {} - {} of {} generations, {status} - showing {shown}",
        evolution.preset(),
        evolution.seed(),
        evolution.reports().len(),
        evolution.settings().evolution.generations,
    );
    if window.title != title {
        window.title = title;
    }
}
