//! The window's title says where things stand, for a taskbar, a screen reader or a script.

use bevy::prelude::*;
use bevy::window::PrimaryWindow;

use super::Frame;
use super::evolution::{Evolution, Status};
use super::exhibit::Source;
use super::lane::Lane;
use super::playback::Playback;
use super::stage::Programme;

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Update, update.in_set(Frame::Draw));
}

fn update(
    evolution: Res<Evolution>,
    lanes: Query<&Lane>,
    (programme, playback): (Res<Programme>, Res<Playback>),
    mut window: Single<&mut Window, With<PrimaryWindow>>,
) {
    let status = match evolution.status() {
        Status::Ready => "ready",
        Status::Running => "running",
        Status::Paused => "paused",
        Status::Finished => "finished",
    };
    let first = lanes.iter().min_by_key(|lane| lane.number());
    let shown = match (&*programme, first) {
        (_, None) => "nothing".to_owned(),
        (Programme::Race, _) => format!("a race of {}", lanes.iter().len()),
        (programme, Some(lane)) => {
            let generation = lane.exhibit().generation();
            let what = match lane.exhibit().source() {
                Source::Opening(_) | Source::Library(_) => "saved champion".to_owned(),
                Source::Lesson => "a lesson".to_owned(),
                Source::Run(run) if run == evolution.number() => format!("generation {generation}"),
                Source::Run(_) => format!("generation {generation} of an earlier run"),
            };
            let is_what_if = matches!(programme, Programme::WhatIf { .. });
            let manner = match (lane.exhibit().is_changed(), lane.exhibit().recording()) {
                _ if is_what_if => " and what if",
                (true, _) => " in another world",
                (false, Some(_)) => " as recorded",
                (false, None) => "",
            };
            let disturbed = if lane.is_disturbed() { ", disturbed" } else { "" };
            format!("{what}{manner}{disturbed}")
        }
    };
    let held = match playback.is_playing() {
        true => String::new(),
        false => format!(", held at {:.2} s", playback.time_s()),
    };
    let from = evolution.founder().map(|name| format!(", from {name}")).unwrap_or_default();
    let title = format!(
        "Snakes & Stairs - {}, seed {}{from} - {} of {} generations, {status} - showing {shown}{held}",
        evolution.preset(),
        evolution.seed(),
        evolution.reports().len(),
        evolution.settings().evolution.generations,
    );
    if window.title != title {
        window.title = title;
    }
}
