//! The window's title: the state of the run and the stage, for taskbars, screen readers and scripts.

use bevy::prelude::*;
use bevy::window::PrimaryWindow;

use crate::studio::schedule::FrameSet;
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::playback::Playback;
use crate::studio::stage::staged_champion::ChampionSource;
use crate::studio::state::current_run::CurrentRun;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Update, update.in_set(FrameSet::Draw));
}

fn update(
    run: Res<CurrentRun>,
    lanes: Query<&Lane>,
    (mode, playback): (Res<StageMode>, Res<Playback>),
    mut window: Single<&mut Window, With<PrimaryWindow>>,
) {
    let first = lanes.iter().min_by_key(|lane| lane.number);
    let shown = match (&*mode, first) {
        (_, None) => "nothing".to_owned(),
        (StageMode::Race, _) => format!("a race of {} snakes", lanes.iter().len()),
        (StageMode::Generation { number, .. }, _) => {
            format!("generation {number}, {} snakes", lanes.iter().len())
        }
        (mode, Some(lane)) => {
            let generation = lane.staged.champion().origin.generation;
            let what = match lane.staged.source() {
                ChampionSource::Opened(_) | ChampionSource::Library(_) => {
                    lane.staged.name().to_owned()
                }
                ChampionSource::Lesson => "a lesson".to_owned(),
                ChampionSource::Edited => "an edited body".to_owned(),
                ChampionSource::Run(number) if number == run.number => {
                    format!("generation {generation}")
                }
                ChampionSource::Run(_) => format!("generation {generation} of an earlier run"),
            };
            let is_what_if = matches!(mode, StageMode::WhatIf { .. });
            let manner = match (lane.staged.is_changed(), lane.staged.recording()) {
                _ if is_what_if => copies_in_words(&lanes),
                (true, _) if lane.staged.is_on_stairs_of_exam() => " on other stairs".to_owned(),
                (true, _) => " in another world".to_owned(),
                (false, Some(_)) => " as recorded".to_owned(),
                (false, None) => String::new(),
            };
            let disturbed = if lane.replay.is_disturbed() { ", pulled" } else { "" };
            format!("{what}{manner}{disturbed}")
        }
    };
    let stopped = match playback.is_playing {
        true => String::new(),
        false => format!(", stopped at {:.2} s", playback.time_s()),
    };
    let from = run.founder().map(|name| format!(", from {name}")).unwrap_or_default();
    let title = format!(
        "Snakes & Stairs - {}, seed {}{from} - {}, {} - showing {shown}{stopped}",
        run.preset_in_words(),
        run.plan_now.seed,
        run.generations_in_words(),
        run.status().name(),
    );
    if window.title != title {
        window.title = title;
    }
}

/// Describes the copies of a what-if: " with a what-if copy, from 5.20 s on".
fn copies_in_words(lanes: &Query<&Lane>) -> String {
    let copies = match lanes.iter().len() {
        ..=2 => "a what-if copy".to_owned(),
        lanes => format!("{} what-if copies", lanes - 1),
    };
    let latest = lanes.iter().max_by_key(|lane| lane.number);
    let beginning = latest.and_then(|lane| lane.staged.beginning_in_words());
    format!(" with {copies}{}", beginning.map(|words| format!(", {words}")).unwrap_or_default())
}
