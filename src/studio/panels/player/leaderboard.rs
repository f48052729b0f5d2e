//! The leaderboard: a ranking of several lanes, and buttons below the ranking.

use bevy_egui::egui;

use super::presented_caption::PresentedCaption;
use super::strip_marks::{FLAG_WIDTH, landing_flag};
use crate::studio::commands::{Command, PlanCommand, StageCommand};
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::ranking::{RankedLane, ranking};
use crate::studio::state::knock_outs::answer_in_words;
use crate::studio::ui::accessible::named;
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::decimals::decimals;
use crate::studio::ui::lane_dot::lane_dot;
use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;
use snakes_core::score::KeyframeHistory;
use snakes_core::world::Stairs;

/// Returns the time at which the middle block first passed each riser, in simulated seconds, for the risers passed by
/// `time_s`. The last riser leads to the landing.
fn splits_s(stairs: &Stairs, history: &KeyframeHistory, step_s: f64, time_s: f64) -> Vec<f64> {
    let sample_s = step_s * f64::from(history.sample_steps());
    let shown = (time_s / sample_s) as usize + 1;
    let way = &history.middles_m()[..shown.min(history.middles_m().len())];
    let reached = |step: u32| {
        let riser_m = stairs.riser_y_m(step);
        way.iter().position(|at| at.y >= riser_m).map(|sample| sample as f64 * sample_s)
    };
    (0..stairs.steps).map_while(reached).collect()
}

/// Draws the tooltip of a snake's result: the time of each step that the snake has climbed.
fn split_times(ui: &mut egui::Ui, lane: &Lane, time_s: f64) {
    let stairs = &lane.trial().stairs;
    let history = lane.history().filter(|_| !lane.replay.is_disturbed());
    let splits_s =
        history.map(|history| splits_s(stairs, history, lane.step_s, time_s)).unwrap_or_default();
    if splits_s.is_empty() {
        ui.label("No step climbed so far.");
        return;
    }
    ui.label("Time at which the middle block passed each riser:");
    egui::Grid::new("splits").num_columns(2).spacing([theme::GAP, 0.0]).show(ui, |ui| {
        for (step, split_s) in splits_s.iter().enumerate() {
            let number = step as u32 + 1;
            let landing = if number == stairs.steps { ", the landing" } else { "" };
            ui.label(format!("Step {number}{landing}"));
            ui.label(egui::RichText::new(format!("{split_s:6.2} s")).monospace());
            ui.end_row();
        }
    });
}

/// Explanation of the leaderboard's numbers.
const MIDDLE: &str =
    "Place of the middle block now, towards the stairs. The fitness may count something else";

/// Draws the leaderboard, and sends the user's commands. `focus` is the lane whose numbers are shown. On a narrow
/// stage (`is_narrow`) the texts are shorter. `can_leave` tells whether an earlier scene can come back.
pub(crate) fn leaderboard(
    ui: &mut egui::Ui,
    lanes: &[&Lane],
    mode: &StageMode,
    focus: usize,
    time_s: f64,
    (is_narrow, can_leave): (bool, bool),
) {
    let palette = theme::of(ui);
    let beginning = common_beginning(lanes).filter(|_| *mode != StageMode::Race);
    if let Some(beginning) = beginning {
        explain(ui, &beginning);
    }
    // If there is only one copy, a button below the lanes keeps it.
    let keeps_each = matches!(mode, StageMode::WhatIf { .. }) && lanes.len() > 2;
    let ranking = ranking(lanes.iter().copied().filter(|lane| !lane.is_ghost), time_s);
    egui::Grid::new("board")
        .num_columns(4)
        .min_col_width(0.0)
        .spacing([theme::GAP, theme::GAP / 4.0])
        .show(ui, |ui| {
            ui.label("");
            ui.label("");
            ui.label("");
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let head = egui::RichText::new("middle block at").small();
                ui.label(head.color(palette.text_weak)).on_hover_text(MIDDLE);
            });
            ui.end_row();
            // A row that changed places with its rank could not be followed, and would slip away from under the pointer.
            for lane in lanes {
                let of_lane = |ranked: &RankedLane| ranked.lane == lane.number;
                let Some(place) = ranking.iter().position(of_lane) else { continue };
                let ranked = &ranking[place];
                let is_winner = place == 0 && ranked.counts() && ranked.landed_s.is_some();
                if is_winner {
                    // A coloured background would look like that of the selected row.
                    landing_flag(ui, WINNER).on_hover_text(format!("{WINNER}. {ORDER}"));
                } else {
                    let rank = egui::RichText::new(format!("{}", place + 1)).monospace();
                    let rank = egui::Label::new(rank.color(palette.text_weak));
                    let size = egui::vec2(FLAG_WIDTH, ui.spacing().interact_size.y);
                    ui.add_sized(size, rank).on_hover_text(ORDER);
                }
                lane_dot(ui, ranked.lane, theme::LANE_DOT);
                let beginning = lane.staged.beginning_in_words();
                let beginning = beginning.map(|words| format!("\n{}: {words}", ranked.name));
                let hint = "Show the numbers and torques of this snake below".to_owned();
                let name = ui.selectable_label(ranked.lane == focus, &ranked.name);
                if name.on_hover_text(hint + &beginning.unwrap_or_default()).clicked() {
                    Command::Stage(StageCommand::Focus(ranked.lane)).send(ui);
                }
                // The fixed width prevents the layout from moving while the values change.
                let text = match (ranked.is_disqualified, ranked.landed_s) {
                    _ if ranked.is_disturbed => "pulled".to_owned(),
                    (true, _) if is_narrow => "out".to_owned(),
                    (true, _) => "disqualified".to_owned(),
                    (false, Some(landed_s)) if is_narrow => format!("{landed_s:.2} s"),
                    (false, Some(landed_s)) => format!("top {landed_s:.2} s"),
                    (false, None) => format!("{} m", decimals(ranked.y_m, 2)),
                };
                let color = match (ranked.counts(), ranked.landed_s) {
                    (false, _) => palette.problem,
                    (true, Some(_)) => palette.accent,
                    (true, None) => palette.text,
                };
                let width = if is_narrow { 8 } else { 14 };
                let text = egui::RichText::new(format!("{text:>width$}")).monospace().color(color);
                ui.label(text).on_hover_ui(|ui| split_times(ui, lane, time_s));
                if keeps_each && ranked.lane > 0 {
                    keep_button(ui, ranked);
                }
                ui.end_row();
            }
        });
    if *mode == StageMode::Race {
        // The rows above determine the width of the card.
        let width = ui.min_rect().width();
        ui.scope(|ui| {
            ui.set_max_width(width);
            latest_seen(ui, &ranking, time_s);
            if let Some(answer) = answer_in_words(lanes) {
                explain(ui, &answer);
            }
        });
    }
    if let StageMode::WhatIf { beside, current, .. } = mode
        && *current <= beside.len()
    {
        explain(ui, NEXT_LANE);
    }
    let selected = lanes.iter().find(|lane| lane.number == focus);
    ui.horizontal(|ui| {
        buttons(ui, mode, (keeps_each, can_leave));
        if *mode == StageMode::Race && selected.is_some_and(|lane| lane.staged.is_changed()) {
            let hint = "Use the changed settings of the selected snake's world for the next run";
            let use_it = Command::Plan(PlanCommand::UseWorldOfLane);
            CommandButton::new("Use this world", hint, use_it).show(ui);
        }
    });
}

/// Tooltip of the ranks.
const ORDER: &str =
    "Of the snakes that reach the top, the earlier one is ahead; of the others, the further one";
/// Label of the flag that replaces the first rank.
const WINNER: &str = "First at the top";
/// Text that is shown while the next change of a what-if adds a lane.
const NEXT_LANE: &str = "The next change gets a lane of its own.";

/// Draws the first places at the latest moment of the race that was shown, also after playback has gone back to an earlier one.
/// The text takes two lines at all times, so that the card keeps its size.
fn latest_seen(ui: &mut egui::Ui, ranking: &[RankedLane], time_s: f64) {
    let mut names: Vec<&str> = ranking.iter().map(|ranked| ranked.name.as_str()).collect();
    names.sort_unstable();
    let id = egui::Id::new(("latest of a race", names));
    let latest: Option<(f64, String)> = ui.data(|data| data.get_temp(id));
    let (at_s, places) = latest.filter(|(at_s, _)| *at_s > time_s).unwrap_or_else(|| {
        let latest = (time_s, PresentedCaption::of_race(ranking).title.text);
        ui.data_mut(|data| data.insert_temp(id, latest.clone()));
        latest
    });
    let text = format!("At {at_s:.1} s: {places}");
    ui.set_min_height(2.0 * ui.text_style_height(&egui::TextStyle::Body));
    explain(ui, &text);
}

/// Describes the time from which all copies differ from the original, if it is the same for all.
fn common_beginning(lanes: &[&Lane]) -> Option<String> {
    let copies = || lanes.iter().filter(|lane| lane.number > 0);
    let mut beginnings = copies().map(|lane| lane.staged.beginning_in_words());
    let first = beginnings.next().flatten()?;
    beginnings.all(|other| other.as_ref() == Some(&first)).then_some(first)
}

/// Draws the button that keeps only one of several copies.
fn keep_button(ui: &mut egui::Ui, ranked: &RankedLane) {
    let said = format!("Keep {}", ranked.name);
    let hint = format!("{said}: only this lane stays, and the next run gets its world");
    let button = ui.small_button("Keep").on_hover_text(hint);
    if named(button, egui::WidgetType::Button, &said).clicked() {
        Command::Plan(PlanCommand::KeepLane(ranked.lane)).send(ui);
    }
}

/// Draws the buttons below the ranking.
fn buttons(ui: &mut egui::Ui, mode: &StageMode, (keeps_each, can_leave): (bool, bool)) {
    let StageMode::WhatIf { .. } = mode else {
        if can_leave {
            let hint = "Return to the scene from before the race";
            CommandButton::new("Leave race", hint, Command::Stage(StageCommand::Leave)).show(ui);
        }
        let (hint, single) = ("Show only the selected snake", Command::Stage(StageCommand::Single));
        CommandButton::new("Only this one", hint, single).show(ui);
        return;
    };
    if !keeps_each {
        let hint = "Keep this change, also for the next run";
        CommandButton::new("Keep", hint, Command::Stage(StageCommand::KeepChange)).show(ui);
    }
    let hint = match keeps_each {
        true => "Discard the latest copy. The next run gets the world of the lane before it",
        false => "Discard this change, also for the next run",
    };
    CommandButton::new("Discard", hint, Command::Plan(PlanCommand::DropChange)).show(ui);
    if mode.can_try_another() {
        let hint = "Leave this copy as it is: the next change makes another one beside it";
        CommandButton::new("Try another", hint, Command::Stage(StageCommand::TryAnother)).show(ui);
    }
}

#[cfg(test)]
mod tests;
